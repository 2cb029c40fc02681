use super::pairs::Flow;
use super::*;
use crate::lanes::Lanes;
use crate::model::protein::chains::{Numbers, crooked, read};
use crate::model::protein::kinematics::Conformer;
use crate::model::protein::linkage::Linkage;
use crate::model::protein::placed::{Placed, Site};
use crate::structure::{Point, Residue};

fn conformer(residues: &[Residue]) -> (Conformer, Linkage) {
    let linkage = Linkage::of(residues).expect("it is whole");
    (Conformer::of(residues, &linkage).expect("it is whole"), linkage)
}

/// What every pair says, without a screen.
fn plain(limits: &Limits, placed: &Placed, obstacles: &Obstacles) -> Counts {
    let mut counts = Counts::default();
    let _ = limits.of_all(placed, obstacles, &mut |violation| {
        counts.add(violation.rule);
        Flow::Continue(())
    });
    counts
}

/// A straight chain of this many residues, 10 Å apart, in which nothing is close to anything.
fn apart(len: usize) -> Placed {
    let (conformer, _) = conformer(&crooked(len, 1));
    let mut placed = conformer.placed();
    for i in 0..len {
        let x = 10.0 * i as f64;
        placed.put(Site::N, i, &Point::new(x - 1.4, 0.0, 0.0));
        placed.put(Site::CA, i, &Point::new(x, 0.0, 0.0));
        placed.put(Site::C, i, &Point::new(x + 1.4, 0.0, 0.0));
        placed.put(Site::O, i, &Point::new(x + 1.4, 1.2, 0.0));
        placed.put(Site::CB, i, &Point::new(x, 0.0, 1.5));
        placed.put(Site::Centroid, i, &Point::new(x, 0.0, 3.0));
        placed.put(Site::H, i, &Point::new(x - 1.4, -1.0, 0.0));
    }
    placed.has_cb.fill(true);
    placed.has_centroid.fill(true);
    placed
}

/// Whether exactly this rule is violated, by these atoms, and by nobody once it is switched off.
fn violates(placed: &Placed, rule: Rule, pair: [(usize, Atom); 2], off: impl Fn(&mut Rules)) {
    let rules = Rules::default();
    let found = rules.first_violation(placed).expect("two atoms are too close");
    assert_eq!((found.rule, found.first, found.second), (rule, pair[0], pair[1]));
    let counts = rules.at_nodes().count(placed, &Obstacles::default(), &mut Screen::default());
    assert_eq!(counts.total(), 1, "{counts:?}");
    let mut without = rules;
    off(&mut without);
    assert_eq!(without.first_violation(placed), None);
}

#[test]
fn every_rule_finds_its_pair_and_can_be_switched_off() {
    assert_eq!(Rules::default().first_violation(&apart(40)), None);
    let away = Point::new(-50.0, -50.0, -50.0);

    let mut placed = apart(40);
    placed.put(Site::CA, 21, &(placed.at(Site::CA, 3) + Point::new(0.0, -2.9, 0.0)));
    violates(&placed, Rule::AlphaCarbons, [(3, Atom::CA), (21, Atom::CA)], |rules| {
        rules.alpha_carbons = 0.0;
    });
    // Within two residues of one another two CA are as close as they like.
    placed.put(Site::CA, 21, &(placed.at(Site::CA, 23) + Point::new(0.0, -2.9, 0.0)));
    assert_eq!(Rules::default().first_violation(&placed), None);

    let mut placed = apart(40);
    placed.put(Site::Centroid, 9, &(placed.at(Site::Centroid, 8) + Point::new(0.0, 2.3, 0.0)));
    violates(&placed, Rule::SideChains, [(8, Atom::SideChain), (9, Atom::SideChain)], |rules| {
        rules.side_chains = 0.0;
    });
    placed.has_centroid[9] = false;
    assert_eq!(Rules::default().first_violation(&placed), None);

    let mut placed = apart(40);
    placed.put(Site::O, 12, &(placed.at(Site::N, 30) + Point::new(-2.35, 0.0, 0.0)));
    violates(&placed, Rule::NitrogenOxygen, [(12, Atom::O), (30, Atom::N)], |rules| {
        rules.nitrogen_oxygen = 0.0;
    });
    placed.put(Site::O, 12, &(placed.at(Site::N, 30) + Point::new(-2.45, 0.0, 0.0)));
    assert_eq!(Rules::default().first_violation(&placed), None);

    let mut placed = apart(40);
    placed.put(Site::CB, 39, &(placed.at(Site::CB, 0) + Point::new(0.0, -2.5, 0.0)));
    violates(&placed, Rule::Backbone, [(0, Atom::CB), (39, Atom::CB)], |rules| {
        rules.backbone = 0.0;
    });
    placed.has_cb[39] = false;
    assert_eq!(Rules::default().first_violation(&placed), None);

    // The rules of motions: side chains at 1 Å, CA at 2.7 Å or L/√2, and nothing else.
    let limits = Rules::default().along_motions(4.0);
    assert_eq!((limits.side_chains, limits.alpha_carbons), (1.0, 4.0 / 2.0f64.sqrt()));
    assert_eq!((limits.nitrogen_oxygen, limits.backbone), (0.0, 0.0));
    assert_eq!(Rules::default().along_motions(3.8).alpha_carbons, 2.7);

    let limits = Rules::default().at_nodes();
    let obstacle = |point: Point| Obstacles::new(vec![away, point]);
    let (placed, screen) = (apart(40), &mut Screen::default());
    let by_backbone = obstacle(placed.at(Site::O, 17) + Point::new(0.0, 2.5, 0.0));
    let found = limits.first_violation(&placed, &by_backbone, screen).expect("it is close");
    assert_eq!((found.rule, found.first), (Rule::ObstacleBackbone, (17, Atom::O)));
    assert_eq!(found.second, (1, Atom::Obstacle));
    let by_side = obstacle(placed.at(Site::Centroid, 5) + Point::new(0.0, 0.0, 2.3));
    let found = limits.first_violation(&placed, &by_side, screen).expect("it is close");
    assert_eq!((found.rule, found.first), (Rule::ObstacleSideChains, (5, Atom::SideChain)));
    let none = Rules::none().at_nodes();
    assert!(
        none.is_valid(&placed, &by_side, screen) && none.is_valid(&placed, &by_backbone, screen)
    );
}

/// Holds counts and verdicts against what every pair says, with all lanes, with a screen that has been used before, and
/// with one that misleads.
fn agrees(placed: &Placed, limits: &Limits) {
    let none = Obstacles::default();
    let expected = plain(limits, placed, &none);
    for lanes in Lanes::all() {
        let mut screen = Screen { lanes, ..Screen::default() };
        assert_eq!(limits.count(placed, &none, &mut screen), expected, "{lanes:?}");
        assert_eq!(limits.count(placed, &none, &mut screen), expected, "{lanes:?}, warm");
        screen.poison();
        assert_eq!(limits.count(placed, &none, &mut screen), expected, "{lanes:?}, poisoned");
        assert_eq!(limits.is_valid(placed, &none, &mut screen), expected.total() == 0);
    }
}

#[test]
fn single_precision_overlooks_no_violation() {
    let mut numbers = Numbers::new(3);
    let mut violations = 0;
    for len in [1, 3, 4, 8, 9, 23, 64, 65, 80] {
        let (conformer, linkage) = conformer(&crooked(len, len as u64));
        let mut placed = conformer.placed();
        for trial in 0..12 {
            let turned = |q: &f64| q + 0.5 * numbers.normal();
            conformer.place(&linkage.source().iter().map(turned).collect::<Vec<_>>(), &mut placed);
            let mut rules = Rules::default();
            match trial % 6 {
                1 => rules.alpha_carbons = 0.0,
                2 => rules.backbone = 4.5,
                3 => (rules.backbone, rules.nitrogen_oxygen) = (0.0, 3.3),
                4 => rules.side_chains = 0.0,
                5 => rules = Rules { side_chains: 5.0, ..Rules::none() },
                _ => {}
            }
            agrees(&placed, &rules.at_nodes());
            violations += plain(&rules.at_nodes(), &placed, &Obstacles::default()).total();
        }
    }
    assert!(violations > 1_500, "{violations} are few to try it on");
}

/// These rules, all distances multiplied by the greatest factor with which a conformation keeps them: two atoms are then as close
/// as they may be.
fn just_kept(placed: &Placed, limits: &Limits) -> Limits {
    let times = |factor: f64| Limits {
        alpha_carbons: limits.alpha_carbons * factor,
        side_chains: limits.side_chains * factor,
        nitrogen_oxygen: limits.nitrogen_oxygen * factor,
        backbone: limits.backbone * factor,
        ..*limits
    };
    let (mut low, mut high) = (0.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let counts = plain(&times(middle), placed, &Obstacles::default());
        (low, high) = if counts.total() == 0 { (middle, high) } else { (low, middle) };
    }
    times(low)
}

/// Walks from a configuration by steps of few torsions, or of all, and holds each verdict against what every pair says. How many
/// steps a check knew to be of few torsions, and how many of these led to valid conformations.
fn walk(
    (conformer, limits): (&Conformer, &Limits),
    start: &[f64],
    steps: usize,
    numbers: &mut Numbers,
) -> (usize, usize) {
    let (mut short, mut valid) = (0, 0);
    let none = Obstacles::default();
    for lanes in Lanes::all() {
        let (mut placed, mut screen) = (conformer.placed(), Screen { lanes, ..Screen::default() });
        let mut q = start.to_vec();
        for step in 0..steps {
            let mut to = q.clone();
            let size = [1e-9, 1e-4, 1e-2, 0.5][(4.0 * numbers.next()) as usize];
            let first = (numbers.next() * q.len() as f64) as usize;
            let turned = [0, 1, 1, 1, 2, 3, q.len()][(7.0 * numbers.next()) as usize];
            for torsion in first..first + turned {
                to[torsion % q.len()] += size * numbers.normal();
            }
            match step % 16 {
                5 => screen.poison(),
                10 => placed.poison(),
                15 => {
                    limits.count(&apart(9), &none, &mut screen);
                }
                _ => {}
            }
            conformer.place(&to, &mut placed);
            let is_short = screen.shortcut(&placed, limits).window.last != usize::MAX;
            let expected = plain(limits, &placed, &none).total() == 0;
            let is_valid = limits.is_valid(&placed, &none, &mut screen);
            assert_eq!(
                is_valid, expected,
                "step {step}, {turned} torsions from {first}, {lanes:?}"
            );
            short += usize::from(is_short);
            valid += usize::from(is_short && is_valid);
            if is_valid {
                q = to;
            }
        }
    }
    (short, valid)
}

#[test]
fn what_is_known_of_the_last_valid_conformation_changes_no_verdict() {
    let mut numbers = Numbers::new(6);
    let (mut short, mut valid) = (0, 0);
    for len in [2, 3, 9, 24, 40, 67] {
        let (conformer, linkage) = conformer(&crooked(len, len as u64));
        let mut placed = conformer.placed();
        let start = linkage.source();
        conformer.place(&start, &mut placed);
        let limits = just_kept(&placed, &Rules::default().at_nodes());
        let walked = walk((&conformer, &limits), &start, 96, &mut numbers);
        (short, valid) = (short + walked.0, valid + walked.1);
    }
    assert!(valid > 200 && short - valid > 20, "{valid} of {short} are few to try it on");
}

#[test]
fn what_is_known_is_about_one_chain_and_its_rules() {
    let none = Obstacles::default();
    let (one, linkage) = conformer(&crooked(40, 3));
    let (other, _) = conformer(&crooked(40, 4));
    let (mut placed, screen) = (one.placed(), &mut Screen::default());
    let q = linkage.source();
    one.place(&q, &mut placed);
    let limits = just_kept(&placed, &Rules::default().at_nodes());
    assert!(limits.is_valid(&placed, &none, screen));
    // Other rules.
    let wider = Limits { backbone: 10.0, ..limits };
    assert!(!wider.is_valid(&placed, &none, screen));
    // An atom that was put elsewhere, without a torsion that would say so.
    placed.put(Site::CA, 30, &placed.at(Site::CA, 2));
    assert!(!limits.is_valid(&placed, &none, screen));
    one.place(&q, &mut placed);
    assert!(limits.is_valid(&placed, &none, screen));
    // Another chain at the same torsions, in the same memory.
    other.place(&q, &mut placed);
    let expected = plain(&limits, &placed, &none).total() == 0;
    assert_eq!(limits.is_valid(&placed, &none, screen), expected);
    assert!(!expected, "the other chain has atoms elsewhere");
}

/// Pairs at the limit to the last bit, far from the origin and near it, in chains of any extent.
#[test]
fn limits_hold_to_the_last_bit() {
    let mut numbers = Numbers::new(4);
    for stretch in [1.0, 30.0, 1e4] {
        let limits = Rules::default().at_nodes();
        for _ in 0..200 {
            let mut placed = apart(40);
            for row in &mut placed.rows {
                row.0[0].iter_mut().for_each(|x| *x *= stretch);
            }
            let direction = Point::from_fn(|_, _| numbers.normal()).normalize();
            let by = if numbers.next() < 0.5 { 1.0 } else { 1.0 - 1e-15 };
            placed.put(Site::CA, 35, &(placed.at(Site::CA, 2) + direction * (3.0 * by)));
            placed.put(
                Site::Centroid,
                30,
                &(placed.at(Site::Centroid, 6) + direction * (2.4 * by)),
            );
            agrees(&placed, &limits);
        }
    }
}

#[test]
fn what_is_no_number_is_invalid() {
    let limits = Rules::default().at_nodes();
    for value in [f64::NAN, f64::INFINITY, 1e300, -1e18] {
        for what in 0..3 {
            let mut placed = apart(20);
            let site = [Site::CA, Site::O, Site::Centroid][what];
            let at = placed.at(site, 7);
            placed.put(site, 7, &Point::new(value, at.y, at.z));
            agrees(&placed, &limits);
            let is_valid = limits.is_valid(&placed, &Obstacles::default(), &mut Screen::default());
            assert_eq!(is_valid, !value.is_nan(), "{value}");
        }
    }
}

#[test]
fn native_chains_keep_the_rules_and_noise_is_judged_as_pair_by_pair() {
    let mut numbers = Numbers::new(5);
    for name in ["1CFD.pdb", "1PGA.pdb", "1BDD.pdb", "1CLL.pdb", "1MI0.pdb"] {
        let Some(residues) = read(name) else { return };
        let (conformer, linkage) = conformer(&residues);
        let mut placed = conformer.placed();
        conformer.place(&linkage.source(), &mut placed);
        let found = Rules::default().first_violation(&placed);
        assert_eq!(found, None, "{name}");
        for width in [0.002, 0.01, 0.05, 0.5] {
            let noisy = |q: &f64| q + width * numbers.normal();
            conformer.place(&linkage.source().iter().map(noisy).collect::<Vec<_>>(), &mut placed);
            agrees(&placed, &Rules::default().at_nodes());
            agrees(&placed, &Rules::default().along_motions(3.9));
        }
        let limits = Rules::default().at_nodes();
        let (short, valid) = walk((&conformer, &limits), &linkage.source(), 64, &mut numbers);
        assert!(valid > 20, "{name}: {valid} of {short} are few to try it on");
    }
}

/// Holds verdicts about obstacles against those of every residue with every obstacle.
fn agrees_about(placed: &Placed, limits: &Limits, obstacles: &Obstacles) -> Counts {
    let expected = plain(limits, placed, obstacles);
    let screen = &mut Screen::default();
    assert_eq!(limits.count(placed, obstacles, screen), expected);
    assert_eq!(limits.is_valid(placed, obstacles, screen), expected.total() == 0);
    let first = limits.of_all(placed, obstacles, &mut Flow::Break).break_value();
    // As text, in which a distance that is no number equals itself.
    let text = |violation: Option<Violation>| format!("{violation:?}");
    assert_eq!(text(limits.first_violation(placed, obstacles, screen)), text(first));
    expected
}

#[test]
fn obstacles_in_cells_are_judged_as_one_by_one() {
    let mut numbers = Numbers::new(6);
    let (mut of_backbone, mut of_sides, mut valid) = (0, 0, 0);
    for trial in 0..240 {
        let placed = apart(12);
        let count = [1, 5, 40, 300][trial % 4];
        // Crowds and lone ones, and some within rounding of the limits.
        let size = [6.0, 40.0, 400.0, 4e4][trial / 4 % 4];
        let mut points: Vec<Point> = (0..count)
            .map(|_| {
                let place = Point::from_fn(|_, _| (numbers.next() - 0.5) * size);
                place + Point::new(55.0, 0.0, 0.0)
            })
            .collect();
        let direction = Point::from_fn(|_, _| numbers.normal()).normalize();
        let by = if numbers.next() < 0.5 { 1.0 } else { 1.0 - 1e-15 };
        let residue = (numbers.next() * 12.0) as usize;
        points.push(placed.at(Site::C, residue) + direction * (2.6 * by));
        points.push(placed.at(Site::Centroid, residue) + direction * (2.4 * by));
        let mut rules = Rules::default();
        match trial % 5 {
            1 => rules.obstacle_backbone = 0.0,
            2 => rules.obstacle_side_chains = 0.0,
            3 => (rules.obstacle_backbone, rules.obstacle_side_chains) = (10.0, 7.5),
            4 => rules = Rules { obstacle_side_chains: 0.3, ..Rules::none() },
            _ => {}
        }
        let counts = agrees_about(&placed, &rules.at_nodes(), &Obstacles::new(points));
        of_backbone += counts.obstacle_backbone;
        of_sides += counts.obstacle_side_chains;
        valid += usize::from(counts.total() == 0);
    }
    assert!(
        of_backbone > 1_000 && of_sides > 200 && valid > 20,
        "{of_backbone} {of_sides} {valid}"
    );
}

/// A coordinate that is no number violates the rules about obstacles, too, wherever these are.
#[test]
fn residues_that_are_nowhere_violate_the_rules_of_obstacles() {
    let obstacles = Obstacles::new(vec![Point::repeat(500.0), Point::repeat(-500.0)]);
    let none = Rules::none().at_nodes();
    let limits = Limits { obstacle_backbone: 2.6, obstacle_side_chains: 2.4, ..none };
    assert_eq!(agrees_about(&apart(9), &limits, &obstacles).total(), 0);
    for site in [Site::N, Site::CA, Site::C, Site::O, Site::CB, Site::Centroid] {
        let mut placed = apart(9);
        let at = placed.at(site, 4);
        placed.put(site, 4, &Point::new(at.x, f64::NAN, at.z));
        assert_eq!(agrees_about(&placed, &limits, &obstacles).total(), 2, "{site:?}");
    }
}

#[test]
fn a_real_chain_beside_another_is_judged_as_one_by_one() {
    let Some(residues) = read("1HVR.pdb") else { return };
    let (conformer, linkage) = conformer(&residues);
    // The chain itself, moved aside: it is close here and there.
    let atoms = residues.iter().flat_map(|residue| &residue.atoms);
    let aside = Point::new(9.0, 11.0, 0.0);
    let obstacles = Obstacles::new(atoms.map(|atom| atom.position + aside).collect());
    let (mut placed, mut numbers, mut violations) = (conformer.placed(), Numbers::new(7), 0);
    for width in [0.0, 0.002, 0.02, 0.2] {
        for _ in 0..5 {
            let noisy = |q: &f64| q + width * numbers.normal();
            conformer.place(&linkage.source().iter().map(noisy).collect::<Vec<_>>(), &mut placed);
            let counts = agrees_about(&placed, &Rules::default().at_nodes(), &obstacles);
            violations += counts.obstacle_backbone + counts.obstacle_side_chains;
        }
    }
    assert!(violations > 100, "{violations} are few to try it on");
}
