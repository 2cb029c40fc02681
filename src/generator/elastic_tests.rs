//! Elastic growth and interpolation, on chignolin between its native hairpin and a stretched chain.

use super::{ElasticGrowth, GeneratorKind};
use crate::img::{Setup, Stop, build};
use crate::model::protein::{ChainSpec, ProteinSpec};
use crate::model::{ModelKind, Scratch};
use crate::numbers::Ordinal;
use crate::problem::{Problem, StrategySpec};
use crate::roadmap::{EdgeCost, Increment, Roadmap};
use std::path::Path;
use std::sync::Arc;

/// Chignolin with one strategy, `nodes` to a set.
fn chignolin(generator: &str, nodes: usize, rest: &str) -> Problem {
    let whole = include_str!("../../problems/chignolin.toml");
    let (before, _) = whole.split_once("[img]").expect("it has the table");
    let text = format!(
        "{before}[[strategies]]\nlabel = \"it\"\nnodes = {nodes}\ngenerator = {generator}\n{rest}"
    );
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/it.toml");
    Problem::parse(&file, &text).unwrap_or_else(|error| panic!("{error}"))
}

fn grown(sets: u32) -> Roadmap {
    let rest =
        format!("[[evaluators]]\nlowest-barrier = {{ energy = -1e6 }}\n[limits]\nsets = {sets}\n");
    let problem = chignolin("{ elastic-growth = { kt = 500.0 } }", 12, &rest);
    build(&Arc::new(Setup::new(problem))).roadmap
}

fn make(problem: &Problem, ordinal: u64, frozen: &Roadmap, scratch: &mut Scratch) -> Increment {
    let made =
        problem.strategies[0].generate(&problem.context(), Ordinal(ordinal), Some(frozen), scratch);
    made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"))
}

const GENERATORS: [&str; 5] = [
    "{ elastic-growth = { kt = 500.0 } }",
    "{ elastic-growth = { aim = \"anywhere\", kt = 500.0, lengths = [0.3], steps = 2 } }",
    "{ elastic-growth = { aim = \"barrier\" } }",
    "{ interpolation = { kt = 500.0 } }",
    "{ interpolation = { length = 0.2 } }",
];

#[test]
fn sets_have_as_many_valid_milestones_as_they_should_and_valid_edges() {
    let frozen = grown(3);
    for generator in GENERATORS {
        let problem = chignolin(generator, 15, "");
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        for ordinal in 0..4 {
            let made = make(&problem, ordinal, &frozen, scratch);
            assert_eq!(made.configs.len(), 15, "{generator}");
            assert!(made.configs.iter().all(|q| cx.model.is_valid(q, scratch)), "{generator}");
            assert!(made.edges.len() + made.root_edges.len() > 5, "{generator}");
            let old = |edge: &crate::roadmap::Edge| frozen.configs().get(edge.low.index());
            let new = |node: crate::numbers::NodeId| made.configs.get(node.index());
            let own = made.edges.iter().map(|edge| (new(edge.low), edge));
            for (low, edge) in own.chain(made.root_edges.iter().map(|edge| (old(edge), edge))) {
                let cost = cx.model.motion(low, new(edge.high), 1, scratch).expect("it is valid");
                assert_eq!(EdgeCost::of(cost, cx.space.distance(low, new(edge.high))), edge.cost);
            }
            // Whatever the scratch was used for.
            let mut poisoned = Scratch::new();
            cx.model.is_valid(made.configs.get(0), &mut poisoned);
            poisoned.poison(0x7ff0_dead_beef_0001);
            assert_eq!(made, make(&problem, ordinal, &frozen, &mut poisoned), "{generator}");
        }
    }
}

#[test]
fn what_grows_hangs_at_the_roadmap_and_what_interpolates_does_not() {
    let frozen = grown(3);
    for (generator, grows) in GENERATORS.iter().zip([true, true, true, false, false]) {
        let problem = chignolin(generator, 15, "");
        assert_eq!(problem.strategies[0].generator.grows(), grows, "{generator}");
        let made = make(&problem, 1, &frozen, &mut Scratch::new());
        assert_eq!(!made.root_edges.is_empty(), grows, "{generator}");
    }
}

/// Copies of a configuration would count as ways around one another.
#[test]
fn in_an_empty_roadmap_no_configuration_comes_twice() {
    for generator in GENERATORS {
        let problem = chignolin(generator, 15, "");
        let (mut seen, scratch) = (std::collections::BTreeSet::new(), &mut Scratch::new());
        for ordinal in 0..4 {
            let cx = problem.context();
            let made = problem.strategies[0].generate(&cx, Ordinal(ordinal), None, scratch);
            let made = made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"));
            let bits = |q: &[f64]| q.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            seen.extend(made.configs.iter().map(bits));
        }
        assert_eq!(seen.len(), 4 * 15, "{generator}");
    }
}

#[test]
fn a_set_may_have_one_milestone() {
    for generator in GENERATORS {
        let problem = chignolin(generator, 1, "");
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        let made = problem.strategies[0].generate(&cx, Ordinal(0), None, scratch);
        assert_eq!(made.unwrap_or_else(|gave_up| panic!("{gave_up:?}")).configs.len(), 1);
    }
}

#[test]
fn the_ends_are_joined() {
    let rest = "[[evaluators]]\nquery = {}\n[limits]\nsets = 60\n";
    let problem = chignolin(GENERATORS[0], 25, rest);
    let built = build(&Arc::new(Setup::new(problem)));
    assert_eq!(built.stop, Stop::Satisfied);
}

#[test]
fn what_needs_two_ends_or_residues_says_so() {
    let whole = include_str!("../../problems/chignolin.toml");
    let (before, after) = whole.split_once("[query]").expect("it has the table");
    let (_, after) = after.split_once("[img]").expect("it has the table");
    let (after, _) = after.split_once("[[evaluators]]").expect("it has criteria");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/it.toml");
    let error = Problem::parse(&file, &format!("{before}[img]{after}")).unwrap_err().to_string();
    assert!(error.contains("no [query]"), "{error}");
    let maze = include_str!("../../problems/maze.toml");
    let text =
        format!("{maze}\n[[strategies]]\nlabel = \"it\"\ngenerator = {{ interpolation = {{}} }}\n");
    let error = Problem::parse(&file, &text).unwrap_err().to_string();
    assert!(error.contains("a chain of residues expected"), "{error}");
}

/// Two Cα cannot move against one another, so that no elastic step has a length.
#[test]
fn a_chain_of_two_residues_is_refused() {
    let whole = chignolin(GENERATORS[0], 5, "");
    let ModelKind::Protein(protein) = &whole.model else { panic!("a protein expected") };
    for (count, fits) in [(2, false), (3, true)] {
        let spec = ProteinSpec::new(ChainSpec::Residues(protein.source()[..count].to_vec()));
        let q = vec![-1.5; 2 * count - 2];
        let generator = GeneratorKind::ElasticGrowth(ElasticGrowth::default());
        let strategy = StrategySpec::generated("it", generator);
        match Problem::builder("few", spec).query(q.clone(), q).strategy(strategy).build() {
            Ok(_) => assert!(fits, "{count}"),
            Err(error) => {
                let error = error.to_string();
                assert!(
                    !fits && error.contains("2 residues, whose Cα no torsion moves so; at least 3"),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let generators = [
        ("{ elastic-growth = { lengths = [] } }", "lengths"),
        ("{ elastic-growth = { lengths = [0.5, 11.0] } }", "lengths"),
        ("{ elastic-growth = { lengths = [1e-300] } }", "lengths"),
        ("{ elastic-growth = { children = 0 } }", "children"),
        ("{ elastic-growth = { steps = 0 } }", "steps"),
        ("{ elastic-growth = { kt = 0.0 } }", "kt"),
        ("{ elastic-growth = { attempts = 0 } }", "attempts"),
        ("{ elastic-growth = { attempts = 1_000_001 } }", "attempts"),
        ("{ interpolation = { length = nan } }", "length"),
        ("{ interpolation = { length = 0.0009 } }", "length"),
        ("{ interpolation = { kt = -1.0 } }", "kt"),
    ];
    for (generator, key) in generators {
        let method: Result<GeneratorKind, _> =
            toml::from_str::<toml::Table>(&format!("it = {generator}"))
                .map(|table| table["it"].clone().try_into().expect("it is one"));
        let method = method.expect("it is TOML");
        let complaint = method.method().complaint().expect("it is wrong");
        assert_eq!(complaint.key, key, "{generator}");
        // Bytes that say the same make no set, and no panic.
        let (problem, scratch) = (chignolin(GENERATORS[0], 5, ""), &mut Scratch::new());
        let seed = crate::seed::Seed::of_set(1, "it", Ordinal(0));
        let made = method.method().generate(&problem.context(), &seed, 5, None, scratch);
        assert!(made.is_err(), "{generator}");
    }
}
