//! Motions against samples of them, by a judge that knows nothing of bounds.

use super::chain::{Chain, Pairs};
use super::cubic::{self, Verdict};
use super::curves::{self, Part, TURN_MAX, Ways};
use super::sample::{Sample, Stage};
use super::straight::Straight;
use super::*;
use crate::lanes::Lanes;
use crate::math;
use crate::model::protein::validity::Rules;
use crate::structure::{AminoAcid, Atom, ResidueNumber};

/// Numbers that look random (SplitMix64; G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
struct Numbers(u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Between −1 and 1.
    fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self, size: f64) -> Point {
        Point::new(self.signed(), self.signed(), self.signed()) * size
    }
}

/// The atom at this distance from `c`, at this angle with `b`, and with this torsion about `b`–`c`, in degrees.
fn beyond([a, b, c]: [Point; 3], distance: f64, angle: f64, torsion: f64) -> Point {
    let (angle, torsion) = (angle.to_radians(), torsion.to_radians());
    let along = (c - b).normalize();
    let normal = (b - a).cross(&along).normalize();
    let side = normal.cross(&along);
    let (sine, cosine) = (math::sin(angle), math::cos(angle));
    c + (side * (math::cos(torsion) * sine) + normal * (math::sin(torsion) * sine) - along * cosine)
        * distance
}

/// A chain of alanines with ideal bonds (R. A. Engh, R. Huber, 1991) and these phi, psi and omega, in degrees. Omega of a
/// residue is that of the bond to the next.
fn alanines(torsions: &[[f64; 3]]) -> Vec<Residue> {
    let mut n = Point::new(0.0, 0.0, 0.0);
    let mut alpha = Point::new(1.458, 0.0, 0.0);
    let mut before = beyond([Point::new(0.0, 1.0, 0.0), alpha, n], 1.329, 121.7, 60.0);
    let mut residues = Vec::new();
    for (number, [phi, psi, omega]) in torsions.iter().enumerate() {
        let c = beyond([before, n, alpha], 1.525, 111.0, *phi);
        let (back, forth) = (alpha - n, c - alpha);
        let beta = alpha - back.cross(&forth) * 0.58273 + back * 0.56803 - forth * 0.54067;
        let atom =
            |name: &str, position| Atom { name: name.into(), element: name[..1].into(), position };
        residues.push(Residue {
            number: ResidueNumber { number: number as i32 + 1, insertion: None },
            name: "ALA".into(),
            amino_acid: Some(AminoAcid::Alanine),
            atoms: vec![
                atom("N", n),
                atom("CA", alpha),
                atom("C", c),
                atom("O", beyond([n, alpha, c], 1.231, 120.1, psi + 180.0)),
                atom("CB", beta),
            ],
        });
        let next = beyond([n, alpha, c], 1.329, 117.2, *psi);
        let next_alpha = beyond([alpha, c, next], 1.458, 121.7, *omega);
        (before, n, alpha) = (c, next, next_alpha);
    }
    residues
}

/// A judge by all pairs of points, placed by the linkage itself.
struct Judge {
    linkage: Linkage,
    points: Vec<(bool, usize, Point, usize)>,
    obstacles: Vec<Point>,
    limits: Limits,
}

impl Judge {
    fn of(residues: &[Residue], obstacles: &[Point], limits: Limits) -> Judge {
        let linkage = Linkage::of(residues).expect("a whole chain");
        let mut points = Vec::new();
        for (number, residue) in residues.iter().enumerate() {
            let alpha = residue.position("CA").expect("every residue has a Cα");
            points.push((true, number, alpha, linkage.body(number, "CA")));
            if let Some(centroid) = residue.side_chain_centroid() {
                points.push((false, number, centroid, linkage.body(number, "CB")));
            }
        }
        Judge { linkage, points, obstacles: obstacles.to_vec(), limits }
    }

    /// By how much, at the worst, distances are more than their limits, Å.
    fn spare(&self, q: &[f64]) -> f64 {
        let motions = self.linkage.motions(q);
        let placed: Vec<Point> =
            self.points.iter().map(|(_, _, point, body)| motions[*body].apply(point)).collect();
        let mut spare = f64::INFINITY;
        for (j, (is_alpha, late, ..)) in self.points.iter().enumerate() {
            for (i, (other, early, ..)) in self.points[..j].iter().enumerate() {
                let limit = if *is_alpha { self.limits.alpha } else { self.limits.side_chain };
                if is_alpha == other && (!is_alpha || late - early > 2) && limit > 0.0 {
                    spare = spare.min((placed[j] - placed[i]).norm() - limit);
                }
            }
            for obstacle in &self.obstacles {
                let limit = if *is_alpha {
                    self.limits.alpha_obstacle
                } else {
                    self.limits.side_chain_obstacle
                };
                if limit > 0.0 {
                    spare = spare.min((placed[j] - obstacle).norm() - limit);
                }
            }
        }
        spare
    }

    /// The least of that at the ends of equal steps.
    fn spare_along(&self, a: &[f64], b: &[f64], steps: usize) -> f64 {
        (0..=steps)
            .map(|step| self.spare(&at(a, b, step as f64 / steps as f64)))
            .fold(f64::INFINITY, f64::min)
    }

    fn validity(&self, residues: &[Residue]) -> MotionValidity {
        MotionValidity::new(&self.linkage, residues, &self.obstacles, self.limits)
            .expect("a whole chain")
    }
}

/// The configuration at a time of the motion from `a` to `b`.
fn at(a: &[f64], b: &[f64], time: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| math::wrap_angle(a + time * math::wrap_angle(b - a))).collect()
}

/// What the default rules ask of a chain without gaps.
fn limits_of(residues: &[Residue]) -> Limits {
    Limits::of(&Rules::default(), residues, &[])
}

/// A helix, a bend, a strand and another helix: something that can meet itself.
fn mixed(length: usize) -> Vec<Residue> {
    let torsions = |number: usize| match number % 24 {
        0..9 => [-60.0, -45.0, 180.0],
        9..12 => [-80.0 + 70.0 * (number % 3) as f64, 60.0, 180.0],
        12..18 => [-120.0, 130.0, 180.0],
        _ => [60.0, 40.0, 178.0],
    };
    alanines(&(0..length).map(torsions).collect::<Vec<_>>())
}

/// How often chance is tried: `ROADMILL_TRIALS`, or this.
fn trials(usual: usize) -> usize {
    std::env::var("ROADMILL_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Configurations with a distance to spare, `size` radians about the source at most.
fn some_valid(judge: &Judge, numbers: &mut Numbers, size: f64, spare: f64) -> Vec<f64> {
    let source = judge.linkage.source();
    loop {
        let noise = |value: &f64| math::wrap_angle(value + size * numbers.signed());
        let q: Vec<f64> = source.iter().map(noise).collect();
        if judge.spare(&q) >= spare {
            return q;
        }
    }
}

#[test]
fn bonds_that_cross_have_ends_that_are_near() {
    let numbers = &mut Numbers(1);
    for _ in 0..10_000 {
        let meeting = numbers.point(1.0);
        let [one, other] = [(); 2].map(|()| {
            let along = numbers.point(1.0).normalize() * 3.8;
            let share = 0.5 + 0.5 * numbers.signed();
            [meeting - along * share, meeting + along * (1.0 - share)]
        });
        let nearest = one
            .iter()
            .flat_map(|p| other.iter().map(move |q| (p - q).norm()))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest <= 3.8 * std::f64::consts::FRAC_1_SQRT_2 + 1e-9);
    }
}

/// A hairpin whose turn swings one strand through the other: both ends keep the rules of nodes, Cα atoms 3.0 Å and side
/// chains 2.4 Å apart, and half way a bond of one strand goes through a bond of the other.
#[test]
fn strands_are_not_pulled_through_one_another() {
    let mut torsions = vec![[-120.0, 130.0, 180.0]; 21];
    torsions[9] = [160.0, 70.0, 180.0];
    torsions[10] = [100.0, 5.0, 180.0];
    torsions[11] = [125.0, 15.0, 180.0];
    let residues = alanines(&torsions);
    let limits = limits_of(&residues);
    let nodes = Limits { alpha: 3.0, side_chain: 2.4, ..limits };
    let judge = Judge::of(&residues, &[], nodes);
    // Psi of the turn's middle residue.
    let source = judge.linkage.source();
    let ends = [-40.0f64, 40.0].map(|swing| {
        let mut q = source.clone();
        q[20] = math::wrap_angle(q[20] + swing.to_radians());
        q
    });
    // On which side of the bond from residue 6 that from residue 13 passes, as a volume, and how near.
    let passes = |q: &[f64]| {
        let motions = judge.linkage.motions(q);
        let at = |residue: usize| {
            let (_, _, point, body) = judge
                .points
                .iter()
                .find(|(is_alpha, number, ..)| *is_alpha && *number == residue)
                .unwrap();
            motions[*body].apply(point)
        };
        let (one, other) = (at(7) - at(6), at(14) - at(13));
        let normal = one.cross(&other);
        (at(13) - at(6)).dot(&normal) / normal.norm()
    };
    let [a, b] = &ends;
    assert!(judge.spare(a) > 0.0 && judge.spare(b) > 0.0);
    assert!(passes(a) * passes(b) < 0.0 && passes(&source).abs() < 0.1);
    let scratch = &mut MotionScratch::default();
    // Also where side chains do not count.
    for limits in [limits, Limits { side_chain: 0.0, ..limits }] {
        let judge = Judge::of(&residues, &[], limits);
        let validity = judge.validity(&residues);
        assert!(validity.is_valid_at((a, b), 1, scratch), "both ends are valid");
        assert!(!validity.is_valid(a, b, scratch) && !validity.is_valid(b, a, scratch));
    }
}

#[test]
fn cubics_are_held_against_distances() {
    let numbers = &mut Numbers(2);
    let mut found = [0; 3];
    for _ in 0..3000 {
        let curve = [(); 4].map(|()| numbers.point(3.0));
        let point = |s: f64| {
            let r = 1.0 - s;
            curve[0] * (r * r * r)
                + curve[1] * (3.0 * r * r * s)
                + curve[2] * (3.0 * r * s * s)
                + curve[3] * (s * s * s)
        };
        let least =
            (0..=1000).map(|k| point(k as f64 / 1000.0).norm()).fold(f64::INFINITY, f64::min);
        let verdict = cubic::verdict(&curve, 1.2, 1.0);
        found[verdict as usize] += 1;
        match verdict {
            Verdict::Apart => assert!(least >= 1.2 - 1e-9),
            Verdict::Close => assert!(least < 1.0 + 1e-2),
            Verdict::Between => assert!(least < 1.2 + 1e-9),
        }
        if least > 1.2 + 1e-2 {
            assert_eq!(verdict, Verdict::Apart);
        }
    }
    assert!(found.iter().all(|count| *count > 50), "{found:?}");
}

#[test]
fn ways_keep_to_their_cubics_as_bounded_and_bounds_are_not_idle() {
    let residues = mixed(45);
    let judge = Judge::of(&residues, &[Point::new(9.0, 9.0, 9.0)], limits_of(&residues));
    let chain = Chain::of(&judge.linkage, &residues, &judge.obstacles, judge.limits).unwrap();
    let numbers = &mut Numbers(3);
    let mut nearest_to_bound: f64 = 0.0;
    for trial in 0..20 {
        let size = [0.01, 0.05, 0.2][trial % 3];
        // Turns of one sign bend ways the most.
        let sign = if trial % 2 == 0 { 1.0 } else { numbers.signed() };
        let a = judge.linkage.source();
        let b: Vec<f64> =
            a.iter().map(|q| q + size * (0.3 + sign * numbers.signed().abs())).collect();
        let mut motion = Straight::default();
        assert!(motion.set(&a, &b));
        let mut samples = [(); 3].map(|()| Sample::default());
        let stage = &mut Stage::default();
        for segment in &chain.segments {
            let length = (TURN_MAX / curves::turn(&chain, segment, &motion)).min(1.0);
            let start = 0.5 * (1.0 - length) * (1.0 + numbers.signed());
            let [from, to, between] = &mut samples;
            from.place(&chain, &motion, start, stage);
            to.place(&chain, &motion, start + length, stage);
            let part = Part { length, from, to };
            let mut ways = Ways::default();
            ways.resize(chain.points());
            curves::find(Lanes::widest(), &chain, segment, &motion, &part, &mut ways);
            for lanes in Lanes::all() {
                let mut same = Ways::default();
                same.resize(chain.points());
                curves::find(lanes, &chain, segment, &motion, &part, &mut same);
                for point in segment.residues.clone() {
                    assert_eq!(same.cubic(point), ways.cubic(point), "{lanes:?}");
                    assert_eq!(same.fourth(point), ways.fourth(point), "{lanes:?}");
                    assert_eq!(same.radii[point], ways.radii[point], "{lanes:?}");
                }
            }
            for k in 1..4 {
                let s = k as f64 / 4.0;
                between.place(&chain, &motion, start + s * length, stage);
                let frame = between.frame(segment.frame);
                let points = segment.residues.clone().flat_map(|residue| {
                    [Some(residue), chain.side_chain(residue)].into_iter().flatten()
                });
                for point in points {
                    let seen = frame.sees(&between.points.at(point));
                    let (c, fourth) = (ways.cubic(point), ways.fourth(point));
                    let r = 1.0 - s;
                    let expected = c[0] * (r * r * r)
                        + c[1] * (3.0 * r * r * s)
                        + c[2] * (3.0 * r * s * s)
                        + c[3] * (s * s * s);
                    let (off, bound) =
                        ((seen - expected).norm(), curves::leaves_cubic(fourth, length));
                    assert!(off <= bound + 1e-10, "{off} {bound} {segment:?}");
                    if bound > 1e-6 {
                        nearest_to_bound = nearest_to_bound.max(off / bound);
                    }
                }
            }
        }
    }
    assert!(nearest_to_bound > 0.1, "{nearest_to_bound}");
}

#[test]
fn what_is_accepted_has_no_sample_too_near_and_what_is_refused_has() {
    let count = trials(120);
    let mut verdicts = [0; 2];
    for (length, seed) in [(12, 4), (30, 5)] {
        let residues = mixed(length);
        let numbers = &mut Numbers(seed);
        let obstacles: Vec<Point> = (0..20).map(|_| numbers.point(25.0)).collect();
        for obstacles in [&[][..], &obstacles] {
            let mut limits = limits_of(&residues);
            // Obstacles may stand anywhere: those that the source touches would leave nothing.
            let judge = Judge::of(&residues, obstacles, limits);
            if judge.spare(&judge.linkage.source()) < 0.5 {
                limits = Limits { alpha_obstacle: 0.5, side_chain_obstacle: 0.5, ..limits };
            }
            let judge = Judge::of(&residues, obstacles, limits);
            let validity = judge.validity(&residues);
            let scratch = &mut MotionScratch::default();
            for _ in 0..count {
                let a = some_valid(&judge, numbers, 1.5, 0.0);
                let b = some_valid(&judge, numbers, 1.5, 0.0);
                let is_valid = validity.is_valid(&a, &b, scratch);
                verdicts[usize::from(is_valid)] += 1;
                let spare = judge.spare_along(&a, &b, 400);
                if is_valid {
                    assert!(spare >= -1e-9, "accepted, but {spare} Å too near");
                } else {
                    // Between samples of 1/400 nothing comes nearer than this.
                    assert!(spare < 0.05, "refused, but {spare} Å to spare");
                }
                assert_eq!(validity.is_valid_at((&a, &b), 400, scratch), spare >= 0.0);
            }
        }
    }
    assert!(verdicts.iter().all(|verdict| *verdict > count / 20), "{verdicts:?}");
}

/// With the limit as it is kept by a motion, to a hundred-thousandth of an ångström, verdicts change.
#[test]
fn verdicts_are_sharp() {
    let residues = mixed(30);
    let limits = Limits { side_chain: 0.0, ..limits_of(&residues) };
    let judge = Judge::of(&residues, &[], limits);
    let numbers = &mut Numbers(6);
    let scratch = &mut MotionScratch::default();
    for _ in 0..12 {
        let a = some_valid(&judge, numbers, 0.6, 0.0);
        let b = some_valid(&judge, numbers, 0.6, 0.0);
        // The least distance, by sections about the best of some samples.
        let spare = |time: f64| judge.spare(&at(&a, &b, time));
        let coarse = |k: usize| spare(k as f64 / 400.0);
        let best = (0..=400).min_by(|a, b| coarse(*a).total_cmp(&coarse(*b))).unwrap() as f64;
        let (mut low, mut high) = ((best - 1.0).max(0.0) / 400.0, (best + 1.0).min(400.0) / 400.0);
        for _ in 0..60 {
            let (one, other) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
            if spare(one) < spare(other) { high = other } else { low = one }
        }
        let least = limits.alpha + spare(low);
        let verdict = |alpha: f64, scratch: &mut MotionScratch| {
            let judge = Judge::of(&residues, &[], Limits { alpha, ..limits });
            judge.validity(&residues).is_valid(&a, &b, scratch)
        };
        assert!(verdict(least - 1e-5, scratch) && !verdict(least + 1e-9, scratch), "{least}");
    }
}

#[test]
fn verdicts_depend_on_nothing_else() {
    let residues = mixed(40);
    let judge = Judge::of(&residues, &[], limits_of(&residues));
    let validity = judge.validity(&residues);
    let numbers = &mut Numbers(7);
    let warm = &mut MotionScratch::default();
    let mut verdicts = [0; 2];
    for trial in 0..200 {
        let size = [0.1, 0.4, 1.0][trial % 3];
        let [a, b] = [(); 2].map(|()| some_valid(&judge, numbers, size, 0.0));
        let verdict = validity.is_valid(&a, &b, warm);
        verdicts[usize::from(verdict)] += 1;
        assert_eq!(validity.is_valid(&a, &b, &mut MotionScratch::default()), verdict);
        assert_eq!(validity.is_valid(&b, &a, warm), verdict);
        warm.poison(trial as u64);
        assert_eq!(validity.is_valid(&a, &b, warm), verdict);
    }
    assert!(verdicts.iter().all(|verdict| *verdict > 20), "{verdicts:?}");
}

#[test]
fn nonsense_is_refused() {
    let residues = mixed(20);
    let judge = Judge::of(&residues, &[], limits_of(&residues));
    let validity = judge.validity(&residues);
    let scratch = &mut MotionScratch::default();
    let q = judge.linkage.source();
    assert!(validity.is_valid(&q, &q, scratch));
    for nonsense in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut other = q.clone();
        other[3] = nonsense;
        assert!(!validity.is_valid(&q, &other, scratch));
        assert!(!validity.is_valid(&other, &q, scratch));
        assert!(!validity.is_valid_at((&q, &other), 4, scratch));
    }
    assert!(!validity.is_valid(&q, &q[1..], scratch));
    assert!(!validity.is_valid(&[], &[], scratch));
    let one = alanines(&[[0.0, 0.0, 180.0]]);
    let judge = Judge::of(&one, &[], limits_of(&one));
    assert!(judge.validity(&one).is_valid(&[], &[], scratch));
    assert!(MotionValidity::new(&judge.linkage, &[], &[], judge.limits).is_none());
    let mut bent = residues;
    let [c, ca] = [bent[7].position("C").unwrap(), bent[8].position("CA").unwrap()];
    let n = bent[8].atoms.iter_mut().find(|atom| atom.name == "N").unwrap();
    n.position = (c + ca) / 2.0;
    let linkage = Linkage::of(&bent).unwrap();
    assert!(MotionValidity::new(&linkage, &bent, &[], judge.limits).is_none());
}

/// What is allowed for rounding covers side chains however long they are.
#[test]
fn rounding_grows_with_the_reach_of_side_chains() {
    let of = |residues: &[Residue]| {
        let linkage = Linkage::of(residues).unwrap();
        Chain::of(&linkage, residues, &[], limits_of(residues)).unwrap().rounding
    };
    let usual = mixed(20);
    let with_arm = |length: f64| {
        let mut residues = usual.clone();
        let alpha = residues[7].position("CA").unwrap();
        let beta = residues[7].atoms.iter_mut().find(|atom| atom.name == "CB").unwrap();
        beta.position = alpha + (beta.position - alpha).normalize() * length;
        of(&residues)
    };
    assert_eq!(with_arm(19.0).to_bits(), of(&usual).to_bits());
    // 80 Å more than the usual arm, for each of 38 torsions and ten more.
    let more = with_arm(100.0) - of(&usual);
    assert!((more - 80.0 * 48.0 * 1e-15).abs() < 1e-18, "{more}");
}

/// Of neighbours but one only those beside a cis peptide can come near; motions look at these.
#[test]
fn a_cis_peptide_lets_a_chain_fold_on_itself() {
    let mut torsions = vec![[-120.0, 130.0, 180.0]; 10];
    torsions[4][2] = 0.0;
    let residues = alanines(&torsions);
    let linkage = Linkage::of(&residues).unwrap();
    let limits = limits_of(&residues);
    let chain = Chain::of(&linkage, &residues, &[], limits).unwrap();
    let folds: Vec<usize> = (0..10).filter(|number| chain.links[*number].folds).collect();
    assert_eq!(folds, [3, 4]);
    let all_trans = mixed(30);
    let linkage = Linkage::of(&all_trans).unwrap();
    let chain = Chain::of(&linkage, &all_trans, &[], limits_of(&all_trans)).unwrap();
    assert!(chain.links.iter().all(|link| !link.folds));
    assert!(chain.segments.iter().all(|segment| segment.pairs != Pairs::Obstacles));
}

#[test]
fn profiles_are_climbs() {
    // Three steps over a hill: 0, 5, 3, 4.
    let energies = |q: &[f64]| [0.0, 5.0, 3.0, 4.0][(q[0] * 3.0).round() as usize];
    let between = &mut Vec::new();
    let there =
        profile((&[0.0], &[1.0]), EnergySteps::Length(0.34), 2.0, between, energies).unwrap();
    assert_eq!(there, Profile { forward: 3.0, backward: 1.0, peak: 5.0 });
    let back =
        profile((&[1.0], &[0.0]), EnergySteps::Length(0.34), 2.0, between, energies).unwrap();
    assert_eq!(back, Profile { forward: 1.0, backward: 3.0, peak: 5.0 });
    assert_eq!(
        profile((&[0.0], &[1.0]), EnergySteps::Length(0.34), 2.0, between, |_| f64::NAN),
        None
    );
    // The short way round, and as many steps both ways.
    assert_eq!(steps(&[3.0, 0.0], &[-3.0, 0.0], EnergySteps::Length(0.1)), 3);
    // By the widest turn alone.
    assert_eq!(steps(&[0.0, 0.0, 0.0], &[0.3, -0.3, 0.1], EnergySteps::Turn(0.1001)), 3);
    let numbers = &mut Numbers(8);
    for _ in 0..1000 {
        let [a, b]: [Vec<f64>; 2] =
            [(); 2].map(|()| (0..5).map(|_| 3.1 * numbers.signed()).collect());
        assert_eq!(
            steps(&a, &b, EnergySteps::Length(0.01)),
            steps(&b, &a, EnergySteps::Length(0.01))
        );
        let wave = |q: &[f64]| q.iter().enumerate().map(|(k, x)| math::sin(x * k as f64)).sum();
        let there = profile((&a, &b), EnergySteps::Length(0.1), 0.3, between, wave).unwrap();
        let back = profile((&b, &a), EnergySteps::Length(0.1), 0.3, between, wave).unwrap();
        assert_eq!(
            (there.forward, there.backward, there.peak),
            (back.backward, back.forward, back.peak)
        );
        let rise = (wave(&b) - wave(&a)) / 0.3;
        assert!((there.forward - there.backward - rise).abs() < 1e-9);
    }
}
