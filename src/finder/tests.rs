//! The laws that every neighbour finder keeps: what it gives is in order, and is what it would be by looking at all.

use super::*;
use crate::numbers::Ordinal;
use crate::problem::{Problem, ProblemError};
use crate::roadmap::{Increment, Roadmap};
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
    vec![
        FinderKind::KNearest(KNearest { neighbors }),
        FinderKind::Radius(Radius { radius, most: None }),
        FinderKind::Radius(Radius { radius, most: Some(neighbors) }),
        FinderKind::CaRmsd(CaRmsd { neighbors }),
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
    let mut pairs = BTreeSet::new();
    for (id, q) in configs.iter().enumerate() {
        let near = finder.near(cx, configs, &components, q, scratch);
        scratch.poison(f64::NAN.to_bits());
        let mut sorted = near.clone();
        sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
        prop_assert_eq!(&near, &sorted);
        prop_assert!(near.len() <= finder.most().unwrap_or(count));
        for other in &near {
            prop_assert_eq!(other.distance.to_bits(), distance(id, other.id as usize).to_bits());
        }
        // Nobody that is left out is nearer than the farthest that is given.
        if let (Some(last), Some(most)) = (near.last(), finder.most()) {
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
    let found = finder.pairs(cx, configs, scratch);
    prop_assert!(found.windows(2).all(|two| two[0] < two[1]));
    prop_assert!(found.iter().all(|(low, high)| low < high));
    prop_assert!(pairs.iter().all(|pair| found.binary_search(pair).is_ok()));
    if finder.most().is_none() {
        prop_assert_eq!(found.len(), pairs.len());
    }
    Ok(())
}

proptest! {
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
                    let found = kind.method().pairs(&cx, &configs, &mut Scratch::new());
                    prop_assert_eq!(found, pairs.into_iter().collect::<Vec<_>>());
                }
                _ => gives_what_looking_at_all_gives(&kind, &cx, &configs, by_space)?,
            }
        }
    }
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
                finder.near(&cx, configs, components, q, scratch)
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
    assert_eq!(finder.near(&cx, &configs, &components, &[0.0; 3], scratch), []);
    assert_eq!(finder.pairs(&cx, &configs, scratch), []);
}
