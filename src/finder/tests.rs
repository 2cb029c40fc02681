//! The laws that every neighbour finder keeps: what it gives is in order, and is what it would be by looking at all.

use super::*;
use crate::neighbor::Ranked;
use crate::numbers::{NodeId, Ordinal};
use crate::problem::{Problem, ProblemError};
use crate::roadmap::{Edge, Increment, Roadmap};
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{BaseJoint, rigid_space};
use crate::structure::{Point, measure};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use std::collections::BTreeSet;
use std::path::Path;

/// Every finder once.
fn finders(neighbors: u32) -> Vec<FinderKind> {
    let radius = 0.1 * f64::from(neighbors);
    let count = neighbors.into();
    vec![
        FinderKind::KNearest(KNearest { neighbors: count }),
        FinderKind::KNearest(KNearest { neighbors: NeighborCount::Auto }),
        FinderKind::Radius(Radius { radius, most: None }),
        FinderKind::Radius(Radius { radius, most: Some(neighbors) }),
        FinderKind::CaRmsd(CaRmsd { neighbors }),
        FinderKind::BruteForce(BruteForce { neighbors: count }),
        FinderKind::MetricTree(MetricTree { neighbors: count }),
        FinderKind::MetricTree(MetricTree { neighbors: NeighborCount::Auto }),
        // What may be no farther than the nearest is the nearest.
        FinderKind::Approximate(Approximate { neighbors: count, epsilon: 0.0 }),
        // Of as many as are drawn all are drawn.
        FinderKind::Randomised(Randomised { neighbors: count, nearest: Some(neighbors) }),
    ]
}

fn stream(ordinal: u64) -> Stream {
    Seed::of_set(1, "finders", Ordinal(ordinal)).stream(Purpose::Sampling)
}

fn parse(text: &str) -> Result<Problem, ProblemError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    Problem::parse(&folder.join("p.toml"), text)
}

/// A model of bodies, whose shape has no Cα; the finders see of it no more than its space.
fn plane() -> Context {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems/slide.toml");
    let mut cx = Problem::load(&path).unwrap().context();
    cx.space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [3.0; 3], 0.5);
    cx
}

const PEPTIDE: &str = "[protein]\nsource = { file = \"structures/1UAO.pdb\" }\n";

fn peptide() -> Context {
    parse(PEPTIDE).unwrap().context()
}

/// Conformations near the native one and far from it; every eighth is drawn twice, so that distances are equal.
fn conformations(cx: &Context, count: usize, stream: &mut Stream) -> Configs {
    let mut configs = Configs::new(cx.space.len());
    while configs.len() < count {
        let mut q = cx.model.native().unwrap().to_vec();
        let width = [0.05, 0.3, 3.0][configs.len() % 3];
        q.iter_mut().for_each(|angle| *angle += width * (2.0 * stream.unit() - 1.0));
        cx.space.canonicalize(&mut q).unwrap();
        configs.push(&q);
        if configs.len() % 8 == 1 && configs.len() < count {
            configs.push(&q);
        }
    }
    configs
}

/// Holds a finder against looking at all milestones; `distance` is that of two of them by which it measures.
fn gives_what_looking_at_all_gives(
    kind: &FinderKind,
    cx: &Context,
    configs: &Configs,
    distance: impl Fn(usize, usize) -> f64,
) -> TestCaseResult {
    let (finder, count, scratch) = (kind.method(), configs.len(), &mut Scratch::new());
    let components = Components::of(&cx.space, configs, &[]);
    let all = Milestones::all(configs, &components);
    let mut pairs = BTreeSet::new();
    for (id, q) in configs.iter().enumerate() {
        let near = finder.near(cx, &all, q, scratch);
        // Few are looked at one by one, with the same result.
        prop_assert_eq!(&finder.near_of_few(cx, configs, count, q, scratch), &near);
        scratch.poison(f64::NAN.to_bits());
        let mut sorted = near.clone();
        sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
        prop_assert_eq!(&near, &sorted);
        prop_assert!(near.len() <= finder.most(count).unwrap_or(count));
        for other in &near {
            prop_assert_eq!(other.distance.to_bits(), distance(id, other.id as usize).to_bits());
        }
        // Nobody that is left out is nearer than the farthest that is given.
        if let (Some(last), Some(most)) = (near.last(), finder.most(count)) {
            let nearer = (0..count as u32).filter(|other| {
                (distance(id, *other as usize), *other) <= (last.distance, last.id)
            });
            prop_assert_eq!(nearer.count(), near.len());
            // Within a set a milestone is no neighbour of its own, and takes no other's place.
            let others = near.iter().filter(|near| near.id as usize != id).take(most);
            pairs.extend(others.map(|near| (near.id.min(id as u32), near.id.max(id as u32))));
        } else {
            let others = near.iter().filter(|near| near.id as usize != id);
            pairs.extend(others.map(|near| (near.id.min(id as u32), near.id.max(id as u32))));
        }
    }
    // With a limit, the search from a milestone's own place gives itself and one neighbour fewer.
    let found = finder.pairs(cx, configs, &mut stream(0), scratch);
    prop_assert!(found.windows(2).all(|two| two[0] < two[1]));
    prop_assert!(found.iter().all(|(low, high)| low < high));
    prop_assert!(pairs.iter().all(|pair| found.binary_search(pair).is_ok()));
    if finder.most(count).is_none() {
        prop_assert_eq!(found.len(), pairs.len());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn finders_give_what_looking_at_all_milestones_gives(
        ordinal in any::<u64>(), count in 1usize..300, neighbors in 1u32..20,
    ) {
        let (cx, mut stream) = (plane(), stream(ordinal));
        let (mut configs, mut q) = (Configs::new(cx.space.len()), vec![0.0; cx.space.len()]);
        for _ in 0..count {
            cx.space.sample_uniform(&mut stream, &mut q);
            configs.push(&q);
        }
        let distance = |a: usize, b: usize| cx.space.distance(configs.get(a), configs.get(b));
        for kind in finders(neighbors).iter().filter(|kind| kind.method().suits(&cx).is_ok()) {
            gives_what_looking_at_all_gives(kind, &cx, &configs, distance)?;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn finders_give_what_looking_at_all_conformations_gives(
        ordinal in any::<u64>(), count in 1usize..80, neighbors in 1u32..20,
    ) {
        let (cx, mut stream) = (peptide(), stream(ordinal));
        let configs = conformations(&cx, count, &mut stream);
        let shape = |q| cx.model.shape(q, &mut Scratch::new()).unwrap();
        let shapes: Vec<Vec<Point>> = configs.iter().map(shape).collect();
        let by_space = |a: usize, b: usize| cx.space.distance(configs.get(a), configs.get(b));
        let rmsds: Vec<Vec<f64>> = shapes
            .iter()
            .map(|a| shapes.iter().map(|b| measure::rmsd(a, b)).collect())
            .collect();
        let by_rmsd = |a: usize, b: usize| rmsds[a][b];
        for kind in finders(neighbors) {
            match &kind {
                FinderKind::CaRmsd(_) => {
                    gives_what_looking_at_all_gives(&kind, &cx, &configs, by_rmsd)?;
                    // Each with its nearest of the others.
                    let mut pairs = BTreeSet::new();
                    for id in 0..count {
                        let mut others: Vec<usize> = (0..count).filter(|other| *other != id).collect();
                        others.sort_by(|a, b| by_rmsd(id, *a).total_cmp(&by_rmsd(id, *b)).then(a.cmp(b)));
                        let nearest = others.into_iter().take(neighbors as usize);
                        pairs.extend(nearest.map(|other| (id.min(other) as u32, id.max(other) as u32)));
                    }
                    let found = kind.method().pairs(&cx, &configs, &mut stream.clone(), &mut Scratch::new());
                    prop_assert_eq!(found, pairs.into_iter().collect::<Vec<_>>());
                }
                _ => gives_what_looking_at_all_gives(&kind, &cx, &configs, by_space)?,
            }
        }
    }
}

/// Milestones in the plane, some of them at the same place, with components of every size.
fn scattered(cx: &Context, count: usize, stream: &mut Stream) -> (Configs, Components) {
    let (mut configs, mut q) = (Configs::new(cx.space.len()), vec![0.0; cx.space.len()]);
    for id in 0..count {
        if id % 7 != 6 {
            cx.space.sample_uniform(stream, &mut q);
        }
        configs.push(&q);
    }
    let edge = |id: u32| Edge::metric(NodeId(id / 3), NodeId(id), 0, 1.0);
    let edges: Vec<Edge> = (1..count as u32).filter(|id| id % 8 > 0).map(edge).collect();
    let components = Components::of(&cx.space, &configs, &edges);
    (configs, components)
}

/// Of one component, and without one milestone, a finder gives what it gives of these milestones alone.
#[test]
fn parts_of_a_graph_are_searched_as_if_there_were_no_more() {
    let (cx, mut stream, scratch) = (plane(), stream(3), &mut Scratch::new());
    let (configs, components) = scattered(&cx, 700, &mut stream);
    let largest = components.iter().max_by_key(|component| component.members.len()).unwrap();
    assert!(largest.members.len() > 200 && components.count() > 50);
    let mut members = largest.members.clone();
    members.sort_unstable();
    for kind in finders(8).iter().filter(|kind| kind.method().suits(&cx).is_ok()) {
        let finder = kind.method();
        for but in [None, Some(members[5])] {
            let component = Some(largest);
            let all = Milestones::all(&configs, &components);
            let milestones = Milestones { component, but, ..all };
            let ids: Vec<u32> = members.iter().copied().filter(|id| Some(*id) != but).collect();
            let mut few = Configs::new(cx.space.len());
            ids.iter().for_each(|id| few.push(configs.get(*id as usize)));
            for q in [configs.get(members[5] as usize), configs.get(600)] {
                let near = finder.near(&cx, &milestones, q, scratch);
                let expected = finder.near_of_few(&cx, &few, all.total, q, scratch).into_iter();
                let own = |near: Neighbor| Neighbor { id: ids[near.id as usize], ..near };
                assert_eq!(near, expected.map(own).collect::<Vec<_>>(), "{kind:?}");
                assert!(!near.is_empty(), "{kind:?}");
            }
        }
    }
}

#[test]
fn of_the_nearest_some_are_drawn_and_every_one_as_often() {
    let (cx, mut stream, scratch) = (plane(), stream(4), &mut Scratch::new());
    let (configs, components) = scattered(&cx, 300, &mut stream);
    let all = Milestones::all(&configs, &components);
    let drawn = Randomised { neighbors: 4.into(), nearest: Some(10) };
    let nearest = KNearest { neighbors: 10.into() };
    let (mut often, draws) = ([0; 10], 5000);
    for _ in 0..draws {
        let q = configs.get(17);
        let of = nearest.near(&cx, &all, q, scratch);
        let mut near = drawn.near(&cx, &all, q, scratch);
        assert_eq!(near, of);
        drawn.choose(&mut near, all.total, &mut stream);
        assert!(near.len() == 4 && near.is_sorted_by(|a, b| a.rank(b).is_lt()));
        for one in near {
            often[of.iter().position(|other| *other == one).expect("one of the nearest")] += 1;
        }
    }
    // Each count has mean 2000 and deviation √(5000 · 0.4 · 0.6) = 35.
    assert!(often.iter().all(|count| (1800..2200).contains(count)), "{often:?}");
    // The same numbers give the same pairs, other numbers others.
    let pairs = |ordinal| {
        let mut chance = self::stream(ordinal);
        drawn.pairs(&cx, &configs, &mut chance, &mut Scratch::new())
    };
    assert_eq!(pairs(1), pairs(1));
    assert_ne!(pairs(1), pairs(2));
    // Every milestone draws four of its ten nearest others; the more of the two draw the pair, the fewer there are.
    assert!((600..=1200).contains(&pairs(1).len()), "{}", pairs(1).len());
}

/// The number of neighbours that follows from how many milestones there are comes from all of them, also where a finder looks at
/// parts of them one after another.
#[test]
fn numbers_of_neighbours_follow_from_all_milestones() {
    let (cx, mut stream, scratch) = (plane(), stream(5), &mut Scratch::new());
    let (configs, components) = scattered(&cx, 200, &mut stream);
    let neighbors = NeighborCount::Auto;
    for finder in [
        &KNearest { neighbors } as &dyn Finder,
        &BruteForce { neighbors },
        &MetricTree { neighbors },
        &Approximate { neighbors, epsilon: 0.5 },
    ] {
        let all = Milestones::all(&configs, &components);
        assert_eq!(finder.near(&cx, &all, configs.get(0), scratch).len(), 28);
        let more = Milestones { total: 2000, ..all };
        assert_eq!(finder.near(&cx, &more, configs.get(0), scratch).len(), 41);
    }
    assert_eq!(Randomised { neighbors, nearest: None }.most(200), Some(56));
}

#[test]
fn settings_are_refused_with_what_is_expected() {
    let strategy = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [8, 6]\n\
        bounds = \"body\"\n[robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n\
        [[strategies]]\nlabel = \"a\"\nsampler = { uniform = {} }\n";
    for (finder, message) in [
        ("brute-force = { neighbors = 0 }", "neighbors = 0 found; \"auto\" or at least 1 expected"),
        (
            "metric-tree = { neighbors = \"all\" }",
            "metric-tree.neighbors: \"all\" found; \"auto\" or a whole number from 0",
        ),
        (
            "approximate = { epsilon = -0.1 }",
            "epsilon = -0.1 found; at least 0, at most 1000 expected",
        ),
        (
            "approximate = { epsilon = nan }",
            "epsilon = NaN found; at least 0, at most 1000 expected",
        ),
        ("approximate = { error = 1 }", "unknown field `error`"),
        (
            "randomised = { nearest = 5 }",
            "nearest = 5 found; at least as many as neighbors expected",
        ),
        ("randomised = { neighbors = \"auto\", nearest = 0 }", "nearest = 0 found"),
        ("hop-limit = { hops = 2 }", "unknown variant `hop-limit`"),
    ] {
        for key in ["within", "among"] {
            let text =
                format!("{strategy}{key} = {{ neighbors = {{ finder = {{ {finder} }} }} }}\n");
            let error = parse(&text).expect_err(finder).to_string();
            assert!(error.contains(message), "{error}");
            assert!(error.contains("p.toml:11:"), "{error}");
        }
    }
    for finder in [
        "k-nearest = { neighbors = \"auto\" }",
        "brute-force = {}",
        "approximate = { epsilon = 0 }",
        "metric-tree = { neighbors = 3 }",
        "randomised = { neighbors = \"auto\" }",
        "randomised = { neighbors = 3, nearest = 3 }",
    ] {
        let text = format!("{strategy}within = {{ neighbors = {{ finder = {{ {finder} }} }} }}\n");
        let problem = parse(&text).unwrap_or_else(|error| panic!("{error}"));
        let (layout, bytes) = problem.to_bytes();
        assert_eq!(Problem::from_bytes(layout, &bytes).expect("its own bytes"), problem);
    }
}

/// What ledgers have always had for numbers stays what it was.
#[test]
fn numbers_have_the_bytes_that_they_always_had() {
    let bytes = |neighbors| crate::wire::encode(&FinderKind::KNearest(KNearest { neighbors }));
    assert_eq!(bytes(10.into()), [0, 0, 0, 0, 10, 0, 0, 0]);
    assert_eq!(bytes(NeighborCount::Auto), [0; 8]);
}

/// Shapes that were kept when a roadmap was smaller are those that would be computed now.
#[test]
fn a_roadmap_that_grows_is_searched_as_one_that_is_given_whole() {
    let (cx, mut stream, scratch) = (peptide(), stream(7), &mut Scratch::new());
    let (finder, len) = (CaRmsd { neighbors: 9 }, cx.space.len());
    let mut roadmap = Roadmap::new(&cx.space);
    for count in [1, 30, 2, 70, 5] {
        let configs = conformations(&cx, count, &mut stream);
        let increment = Increment { configs, ..Increment::empty(len) };
        let before = roadmap.clone();
        roadmap.fold_round(&cx.space, [(&increment, &[][..])]);
        let whole = Components::of(&cx.space, roadmap.configs(), &[]);
        for q in increment.configs.iter() {
            let near = |components: &Components, configs: &Configs, scratch: &mut Scratch| {
                finder.near(&cx, &Milestones::all(configs, components), q, scratch)
            };
            let found = near(roadmap.components(), roadmap.configs(), scratch);
            assert_eq!(found, near(&whole, roadmap.configs(), scratch));
            assert_eq!(found.len(), roadmap.configs().len().min(9));
            // One that stayed as it was does not see what came later.
            let earlier = near(before.components(), before.configs(), scratch);
            assert!(earlier.iter().all(|near| (near.id as usize) < before.configs().len()));
        }
    }
    // Nothing that is counted as a question to the model.
    assert_eq!(scratch.take_asked(), Default::default());
}

#[test]
fn models_without_alpha_carbons_have_no_neighbours_by_them() {
    let finder = "{ neighbors = { finder = { ca-rmsd = { neighbors = 3 } } } }";
    let strategy = "[[strategies]]\nlabel = \"a\"\n";
    let landscape = "[landscape]\nmin = [0, -1]\nmax = [1, 1]\ntolerance = 1e-3\n\
        energy = { terms = [{ height = -100, centre = [0, 0], xx = 0, yy = -0.01 }] }\n";
    for (rest, key) in [
        (format!("sampler = {{ uniform = {{}} }}\nwithin = {finder}\n"), "within"),
        (format!("sampler = {{ uniform = {{}} }}\namong = {finder}\n"), "among"),
        (
            format!(
                "generator = {{ sample = {{ sampler = {{ uniform = {{}} }}, within = {finder} }} }}\n"
            ),
            "generator",
        ),
    ] {
        let error = parse(&format!("{landscape}{strategy}{rest}")).unwrap_err().to_string();
        let expected =
            format!("strategies[0].{key}: neighbours by Cα RMSD found, a model with Cα expected");
        assert!(error.contains(&expected), "{error}");
        parse(&format!("{PEPTIDE}{strategy}{rest}")).unwrap_or_else(|error| panic!("{error}"));
    }
    // From the bytes of a ledger it can come all the same.
    let (cx, mut configs) = (plane(), Configs::new(3));
    configs.push(&[0.0; 3]);
    configs.push(&[1.0; 3]);
    let components = Components::of(&cx.space, &configs, &[]);
    let (finder, scratch) = (CaRmsd::default(), &mut Scratch::new());
    let all = Milestones::all(&configs, &components);
    assert_eq!(finder.near(&cx, &all, &[0.0; 3], scratch), []);
    assert_eq!(finder.near_of_few(&cx, &configs, 2, &[0.0; 3], scratch), []);
    assert_eq!(finder.pairs(&cx, &configs, &mut stream(0), scratch), []);
}
