//! What generators promise: laws that all of them keep, and what each method says of itself.

use super::{GeneratorKind, ParentRun, Reads, Runs};
use crate::digest::Digest;
use crate::img::{Setup, build};
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::roadmap::{Edge, Increment, Roadmap, SetForm};
use crate::sampler::tests::statistics::fits;
use std::path::Path;
use std::sync::Arc;

/// A bar in the plane beside a pillar at `x`.
fn scene(x: f64) -> String {
    format!(
        "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [8, 8]\nbounds = \"body\"\n\
         [robot]\nbodies = [{{ shape = {{ box = {{ size = [1.2, 0.2, 1.0] }} }} }}]\n\
         [[obstacles]]\nshape = {{ cylinder = {{ radius = 1.5, height = 2 }} }}\n\
         position = [{x}, 4, 0]\n[limits]\nsets = 4\n"
    )
}

fn parse(text: &str, runs: &dyn Runs) -> Problem {
    let file = tempfile::Builder::new().prefix("scene").suffix(".toml").tempfile();
    let file = file.expect("a file can be made");
    std::fs::write(file.path(), text).expect("it can be written");
    Problem::load_with(file.path(), &Default::default(), runs).unwrap_or_else(|e| panic!("{e}"))
}

fn grown(text: &str) -> Roadmap {
    build(&Arc::new(Setup::new(parse(text, &super::NoRuns)))).roadmap
}

/// One run, whatever its folder.
struct One(Roadmap);

const LEDGER: Digest = Digest([7; 32]);

impl Runs for One {
    fn read(&self, _folder: &Path) -> Result<ParentRun, String> {
        let space = parse(&scene(4.0), &super::NoRuns).space();
        Ok(ParentRun { ledger: LEDGER, space, roadmap: self.0.clone() })
    }
}

/// The scene with one strategy, whose sets the generator makes.
fn with(scene: &str, generator: &str, parent: &Roadmap) -> Problem {
    let strategy = format!("[[strategies]]\nlabel = \"it\"\nnodes = 30\ngenerator = {generator}\n");
    parse(&(scene.to_owned() + &strategy), &One(parent.clone()))
}

fn make(problem: &Problem, ordinal: u64, frozen: &Roadmap) -> Increment {
    let cx = problem.context();
    let strategy = &problem.strategies[0];
    let made = strategy.generate(&cx, Ordinal(ordinal), Some(frozen), &mut Scratch::new());
    made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"))
}

const GENERATORS: [&str; 5] = [
    "{ sample = { sampler = { uniform = {} } } }",
    "{ expansion-step = { step = 0.2 } }",
    "{ expansion-step = { step = 0.2, bounces = 1, steps = 3, halvings = 0 } }",
    "{ reuse = { parent = { run = \"parent\" }, spread = 2.0 } }",
    "{ tree = { step = 0.4 } }",
];

/// Another scene than that of the roadmaps, where a method repairs what is invalid in them.
fn own_scene(generator: &str) -> String {
    scene(if generator.contains("reuse") { 5.0 } else { 4.0 })
}

#[test]
fn every_set_has_as_many_valid_milestones_as_it_should_and_valid_edges() {
    let frozen = grown(&scene(4.0));
    for generator in GENERATORS {
        let problem = with(&own_scene(generator), generator, &frozen);
        let cx = problem.context();
        for ordinal in 0..9 {
            let made = make(&problem, ordinal, &frozen);
            assert_eq!(made.configs.len(), 30, "{generator}");
            let scratch = &mut Scratch::new();
            assert!(made.configs.iter().all(|q| cx.model.is_valid(q, scratch)), "{generator}");
            let grows = problem.strategies[0].generator.grows();
            let form = SetForm::of(problem.model.description());
            let nodes = if grows { frozen.configs().len() as u64 } else { 0 };
            assert!(made.is_sound(form, nodes), "{generator}");
            for (edges, from) in
                [(&made.edges, &made.configs), (&made.root_edges, frozen.configs())]
            {
                for Edge { low, high, .. } in edges {
                    let (a, b) = (from.get(low.index()), made.configs.get(high.index()));
                    assert!(cx.model.motion(a, b, 1, scratch).is_some(), "{generator}");
                }
            }
            assert_eq!(make(&problem, ordinal, &frozen), made, "{generator} is a function");
            assert_ne!(make(&problem, ordinal + 1, &frozen).configs, made.configs, "{generator}");
        }
    }
}

#[test]
fn what_a_generator_reads_alone_changes_its_sets() {
    let (one, other) = (grown(&scene(4.0)), grown(&(scene(4.0) + "[img]\nsets_per_round = 1\n")));
    let empty = Roadmap::new(&parse(&scene(4.0), &super::NoRuns).space());
    assert_ne!(one.digest(), empty.digest());
    for generator in GENERATORS {
        let problem = with(&own_scene(generator), generator, &other);
        let reads = problem.strategies[0].generator.method().reads();
        let same = make(&problem, 3, &one) == make(&problem, 3, &empty);
        assert_eq!(same, reads != Reads::Roadmap, "{generator}");
        let is_parent = matches!(problem.strategies[0].generator, GeneratorKind::Reuse(_));
        assert_eq!(reads == Reads::Parent(LEDGER), is_parent, "{generator}");
    }
}

/// In walks of one leg every chosen node is a link's lower end.
#[test]
fn expansion_chooses_nodes_by_one_over_one_and_their_degree() {
    let frozen = grown(
        &(scene(4.0)
            + "[[strategies]]\nlabel = \"u\"\nsampler = { uniform = {} }\nnodes = 5\nwithin = { nearest = { neighbors = 2 } }\n"),
    );
    let mut degrees = vec![0u32; frozen.configs().len()];
    for edge in frozen.edges().iter() {
        degrees[edge.low.index()] += 1;
        degrees[edge.high.index()] += 1;
    }
    assert!(degrees.iter().max() > degrees.iter().min(), "{degrees:?}");
    let problem = with(&scene(4.0), "{ expansion-step = { step = 0.2, bounces = 1 } }", &frozen);
    let mut chosen = vec![0; degrees.len()];
    for ordinal in 0..200 {
        make(&problem, ordinal, &frozen)
            .root_edges
            .iter()
            .for_each(|link| chosen[link.low.index()] += 1);
    }
    let weights: Vec<f64> = degrees.iter().map(|degree| 1.0 / (1.0 + f64::from(*degree))).collect();
    fits(&chosen, &weights);
}

#[test]
fn reuse_takes_what_is_valid_as_it_is_and_repairs_the_rest_nearby() {
    let parent = grown(&scene(4.0));
    let nodes = parent.configs().len();
    let reuse = "{ reuse = { parent = { run = \"parent\" }, spread = 2.0 } }";
    // In the parent's own scene a set as large as its roadmap is that roadmap.
    let mut same = with(&scene(4.0), reuse, &parent);
    same.strategies[0].nodes = nodes as u32;
    let made = make(&same, 0, &parent);
    assert_eq!(made.configs, *parent.configs());
    let ends =
        |edges: Vec<Edge>| edges.iter().map(|edge| (edge.low, edge.high)).collect::<Vec<_>>();
    assert_eq!(ends(made.edges), ends(parent.edges().iter().collect()));
    // In another scene what is invalid moves, no further than said.
    let mut other = with(&scene(5.0), reuse, &parent);
    other.strategies[0].nodes = nodes as u32;
    let cx = other.context();
    let (made, mut moved) = (make(&other, 0, &parent), 0);
    for (q, before) in made.configs.iter().zip(parent.configs().iter()) {
        let valid = cx.model.is_valid(before, &mut Scratch::new());
        assert_eq!(q == before, valid);
        assert!(cx.space.distance(q, before) <= 2.0 + 1e-9);
        moved += usize::from(!valid);
    }
    assert!(moved > 0 && moved < nodes, "{moved} of {nodes}");
    // Taken again, every node moves.
    let again = make(&other, 1, &parent);
    assert!(again.configs.iter().zip(parent.configs().iter()).all(|(q, before)| q != before));
}
