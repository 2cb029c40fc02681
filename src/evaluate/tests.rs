use super::*;
use crate::img::{Setup, build};
use crate::numbers::NodeId;
use crate::problem::Problem;
use crate::roadmap::{Configs, Edge, Increment};
use crate::space::{BaseJoint, Space, rigid_space};
use std::path::Path;
use std::sync::Arc;

/// Two rooms, of which the left one is three times as large, and no way from one to the other.
const ROOMS: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [8.2, 4.0]
bounds = "reference"
[robot]
bodies = [{ shape = { point = {} } }]
[[obstacles]]
shape = { box = { size = [0.2, 4.0, 1.0] } }
position = [6.1, 2.0, 0.0]
[query]
start = [1.0, 1.0]
goal = [8.0, 1.0]
[img]
sets_per_round = 1
[[strategies]]
label = "all"
nodes = 200
sampler = { uniform = {} }
[limits]
sets = 1
"#;

/// A plane 30 by 40, and an empty roadmap of it.
pub(super) fn hand_made() -> (Space, Roadmap) {
    let space = rigid_space(BaseJoint::Translation2d, [0.0; 3], [30.0, 40.0, 0.0], 0.0);
    let roadmap = Roadmap::new(&space);
    (space, roadmap)
}

/// Folds a round of one set with these nodes and joining edges.
pub(super) fn grow(space: &Space, roadmap: &mut Roadmap, nodes: &[[f64; 2]], joins: &[(u32, u32)]) {
    let mut configs = Configs::new(2);
    nodes.iter().for_each(|q| configs.push(q));
    let increment = Increment { configs, ..Increment::empty(2) };
    let edge = |(low, high): &(u32, u32)| Edge::metric(NodeId(*low), NodeId(*high), 0, 1.0);
    let joins: Vec<Edge> = joins.iter().map(edge).collect();
    roadmap.fold_round(space, [(&increment, &joins[..])]);
}

fn verdict(evaluators: &str) -> Verdict {
    let text = format!("evaluators = [{evaluators}]\n{ROOMS}");
    let problem = Problem::parse(Path::new("rooms.toml"), &text).unwrap();
    let built = build(&Arc::new(Setup::new(problem)));
    built.judgement.expect("one round is judged").verdicts.remove(0)
}

#[test]
fn coverage_counts_samples_and_connectivity_pairs() {
    let covered = verdict("{ coverage = {} }");
    assert!(covered.satisfied && covered.value == 1.0 && covered.threshold == 0.95);
    // Of 100 samples some 75 lie in the left room: p² + q² of the pairs, about 0.62, are connected.
    let connected = verdict("{ connectivity = {} }");
    assert!(!connected.satisfied && connected.threshold == 0.75);
    let left = (0..=100u32)
        .map(f64::from)
        .find(|left| {
            let right = 100.0 - left;
            (connected.value - (left * (left - 1.0) + right * (right - 1.0)) / 9900.0).abs() < 1e-12
        })
        .expect("the pairs of two groups that make a hundred");
    assert!((10.0..40.0).contains(&left.min(100.0 - left)), "{left}");
    // Listed: two in the left room, one in the right: one of three pairs.
    let listed = verdict(
        "{ connectivity = { samples = { listed = [[1, 1], [5, 3], [8, 2]] }, percent = 33 } }",
    );
    assert!(listed.satisfied && (listed.value - 1.0 / 3.0).abs() < 1e-12);
}

#[test]
fn samples_of_several_samplers_are_judged_together() {
    // Ten everywhere, ten within 0.01 of the wall, which are all in reach.
    let near = "{ sampler = { gaussian = { deviation = 0.01 } }, count = 10 }";
    let all = "{ sampler = { uniform = {} }, count = 10 }";
    let drawn = verdict(&format!("{{ coverage = {{ samples = {{ drawn = [{near}, {all}] }} }} }}"));
    assert!(drawn.satisfied && drawn.value == 1.0);
    // A sampler that finds nothing leaves its share missing.
    let never = "{ sampler = { gaussian = { deviation = 1e-9, attempts = 1 } }, count = 30 }";
    let drawn =
        verdict(&format!("{{ coverage = {{ samples = {{ drawn = [{never}, {all}] }} }} }}"));
    assert!(!drawn.satisfied && drawn.value == 0.25, "{}", drawn.value);
}

#[test]
fn flow_is_what_the_query_attaches_with_and_none_goes_through_the_wall() {
    let across = verdict("{ max-flow = { flow = 1 } }");
    assert!(!across.satisfied && across.value == 0.0);
    assert_eq!(across.cut, Some(Vec::new()));
    let within = verdict("{ max-flow = { flow = 1, to = [[5, 3], [5, 1]] } }");
    assert!(within.satisfied && within.value > 1.0);
    // From the start at node 200 ten edges lead away; a cut is no more than what they carry.
    let cut = within.cut.expect("a cut");
    let severed: f64 = cut.iter().map(|edge| edge.capacity).sum();
    assert!((severed - within.value).abs() < 1e-9 * severed);
    // The least weight bounds what any edge carries.
    let bounded = verdict("{ max-flow = { flow = 1, to = [[5, 3]], least_weight = 2 } }");
    assert_eq!(bounded.value, 5.0, "ten edges of 1/2 each");
}

#[test]
fn rounds_that_tell_nothing_new_and_move_nothing_suffice() {
    let rounds = |evaluators: &str, rounds: u32| {
        let limits = format!("sets = {rounds}");
        let text = ROOMS.replace("sets = 1", &limits).replace("nodes = 200", "nodes = 20");
        let text = format!("evaluators = [{{ all = [{evaluators}, {{ query = {{}} }}] }}]\n{text}");
        let problem = Problem::parse(Path::new("rooms.toml"), &text).unwrap();
        let built = build(&Arc::new(Setup::new(problem)));
        built.judgement.expect("it is judged").verdicts.remove(0).parts.remove(0)
    };
    let first = rounds("{ information-gain = {} }", 1);
    assert!(!first.satisfied && first.value == 1.0 && first.bound == Bound::AtMost);
    let later = rounds("{ information-gain = { rounds = 2 } }", 12);
    assert!(later.satisfied && later.value == 0.0 && later.measures == [0.0, 0.0]);
    let later = rounds("{ expansion = {} }", 3);
    assert!(!later.satisfied && later.value == 1.0, "three rounds before the last are needed");
    // Two rooms, 6.1 and 2 wide: what is measured at the end is near what there is to measure.
    let later = rounds("{ expansion = { percent = 5 } }", 30);
    let [width, separation, ..] = later.measures[..] else { panic!("four measures") };
    let (left, right) = (52.0f64.sqrt(), 20.0f64.sqrt());
    assert!(later.satisfied && (right..left).contains(&width), "{later:?}");
    // The centres are 4 apart, and 3/8 of the pairs of nodes are in different rooms.
    assert!((separation - 1.5).abs() < 0.3, "{separation}");
}

#[test]
fn trees_of_criteria_say_what_logic_says_and_judge_every_part() {
    let (yes, no) = ("{ coverage = {} }", "{ query = {} }");
    for (criterion, satisfied, parts) in [
        (format!("{{ all = [{yes}, {yes}] }}"), true, 2),
        (format!("{{ all = [{no}, {yes}] }}"), false, 2),
        (format!("{{ any = [{yes}, {no}] }}"), true, 2),
        (format!("{{ any = [{no}, {no}] }}"), false, 2),
        (format!("{{ not = {no} }}"), true, 1),
        (format!("{{ not = {{ any = [{yes}, {no}] }} }}"), false, 1),
    ] {
        let verdict = verdict(&criterion);
        assert_eq!((verdict.satisfied, verdict.parts.len()), (satisfied, parts), "{criterion}");
        assert!(verdict.asked.motions >= verdict.parts.iter().map(|p| p.asked.motions).sum());
    }
}

#[test]
fn samples_are_the_same_every_time_and_other_ones_elsewhere_in_the_tree() {
    let one = "{ coverage = { samples = { random = 3 } } }";
    let both = verdict(&format!("{{ all = [{one}, {one}] }}"));
    assert_eq!(both, verdict(&format!("{{ all = [{one}, {one}] }}")));
    let first = verdict(one);
    assert_eq!(first, verdict(one));
}

#[test]
fn wrong_settings_are_named() {
    for (evaluator, expected) in [
        ("{ coverage = { percent = 0 } }", "percent = 0 found"),
        ("{ coverage = { samples = { random = 1 } } }", "samples.random = 1 found"),
        ("{ all = [] }", "all = [] found"),
        ("{ expansion = { rounds = 0 } }", "rounds = 0 found"),
        ("{ expansion = { percent = 0 } }", "percent = 0 found"),
        ("{ expansion = { components = 1001 } }", "components = 1001 found"),
        ("{ information-gain = { percent = 100 } }", "percent = 100 found"),
        ("{ max-flow = {} }", "missing field `flow`"),
        ("{ max-flow = { flow = 0 } }", "flow = 0 found"),
        ("{ max-flow = { flow = 1, least_weight = 0 } }", "least_weight = 0 found"),
        ("{ max-flow = { flow = 1, from = [[1, 9]] } }", "from[0]: [1.0, 9.0] found"),
        ("{ coverage = { samples = { drawn = [] } } }", "samples.drawn = 0 found"),
        (
            "{ coverage = { samples = { drawn = [{ sampler = { uniform = {} }, count = 0 }] } } }",
            "samples.drawn: count = 0 found",
        ),
        ("{ not = { connectivity = { neighbors = 0 } } }", "neighbors = 0 found"),
        ("{ connectivity = { planners = [{ rotate-at = { percent = 101 } }] } }", "percent = 101"),
        (
            "{ all = [{ coverage = { samples = { listed = [[1, 1], [6.1, 1]] } } }] }",
            "samples.listed[1]: [6.1, 1.0] found",
        ),
        ("{ coverage = { sample = { random = 5 } } }", "unknown field `sample`"),
        ("{ lowest-barrier = { energy = 5 } }", "a model with energies expected"),
        ("{ lowest-barrier = { energy = inf } }", "energy = inf found"),
    ] {
        let text = format!("evaluators = [{evaluator}]\n{ROOMS}");
        let error = Problem::parse(Path::new("rooms.toml"), &text).unwrap_err().to_string();
        assert!(error.starts_with("rooms.toml:1: ") && error.contains(expected), "{error}");
    }
}

#[test]
fn problems_of_models_with_energies_may_ask_for_a_lowest_barrier() {
    let text = "evaluators = [{ all = [{ lowest-barrier = { energy = -40.6 } }] }]\n\
                [landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2.0]\nenergy = { muller-brown = {} }\n\
                [query]\nstart = [-0.558, 1.442]\ngoal = [0.623, 0.028]\n";
    let problem = Problem::parse(Path::new("p.toml"), text);
    assert!(matches!(problem.map(|problem| problem.evaluators.len()), Ok(1)));
}

/// A round hill in the middle of a plane, and two points on either side of it.
const HILL: &str = "[landscape]\nmin = [-2, -2]\nmax = [2, 2]\ntolerance = 0.01\n\
    energy = { terms = [{ height = 50, centre = [0, 0], xx = -2, yy = -2 }] }\n\
    [query]\nstart = [-1.5, 0.1]\ngoal = [1.6, 0]\n[img]\nsets_per_round = 1\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 30\nsampler = { uniform = {} }\n";

fn on_the_hill(evaluators: &str, sets: u32) -> Vec<Verdict> {
    let text = format!("evaluators = [{evaluators}]\n{HILL}[limits]\nsets = {sets}\n");
    let problem = Problem::parse(Path::new("hill.toml"), &text).unwrap();
    let built = build(&Arc::new(Setup::new(problem)));
    built.judgement.expect("its rounds are judged").verdicts
}

#[test]
fn the_flow_is_compared_with_the_widest_path_in_both_directions() {
    let verdicts = on_the_hill(
        "{ flow-ratio = { ratio = 1e9 } }, { max-flow = { flow = 1e9, least_weight = 1 } }",
        4,
    );
    let [ratio, flow] = &verdicts[..] else { panic!("two verdicts") };
    let [there, widest, back, widest_back] = ratio.measures[..] else { panic!("four measures") };
    assert_eq!(there, flow.value);
    assert!(widest <= there && widest_back <= back && widest > 0.0 && widest_back > 0.0);
    assert_eq!(ratio.value, (there / widest).min(back / widest_back));
    assert!(ratio.value > 1.5 && !ratio.satisfied, "{}", ratio.value);
    // The cut is what bounds the flow of the direction with the smaller ratio.
    let severed: f64 = ratio.cut.iter().flatten().map(|edge| edge.capacity).sum();
    let worse = if ratio.value == there / widest { there } else { back };
    assert!((severed - worse).abs() < 1e-6 * worse, "{severed} {worse}");
    assert!(on_the_hill("{ flow-ratio = { ratio = 1.5 } }", 4)[0].satisfied);
    // A weight that no edge exceeds makes of the ratio the number of disjoint ways.
    let level = &on_the_hill("{ flow-ratio = { least_weight = 1e6 } }", 4)[0];
    assert!(
        (level.value - level.value.round()).abs() < 1e-9 && level.value >= 5.0,
        "{}",
        level.value
    );
    // Where the ends are apart there is no flow, and no ratio.
    let apart = verdict("{ flow-ratio = {} }");
    assert_eq!((apart.value, apart.satisfied, apart.threshold), (0.0, false, 5.0));
    let within = verdict("{ flow-ratio = {} }, { query = {} }");
    assert_eq!(within.measures, [0.0; 4]);
}

#[test]
fn the_barrier_is_compared_with_what_it_was_at_half_the_nodes() {
    let trend = |sets| {
        on_the_hill(
            "{ barrier-trend = { energy = 0.5 } }, { lowest-barrier = { energy = -1 } }",
            sets,
        )
    };
    let mut last = f64::INFINITY;
    for sets in [2, 5, 8] {
        let now = trend(sets);
        let then = trend(sets / 2);
        let [barrier, before, nodes] = now[0].measures[..] else { panic!("three measures") };
        assert_eq!((barrier, before), (now[1].value, then[1].value), "{sets} sets");
        assert_eq!(nodes, f64::from(sets / 2 * 30));
        assert_eq!(now[0].value, before - barrier);
        assert_eq!(now[0].satisfied, before - barrier <= 0.5);
        assert!(before >= barrier && barrier <= last);
        last = barrier;
    }
    // With one round there is no half, but the direct motion joins the ends, over the hill.
    let first = &trend(1)[0];
    assert!(first.measures[1] > 45.0 && first.measures[2] == 0.0, "{:?}", first.measures);
    let refused = |evaluator: &str| {
        let text = format!("evaluators = [{evaluator}]\n{ROOMS}");
        Problem::parse(Path::new("rooms.toml"), &text)
            .expect_err("a room has no energies")
            .to_string()
    };
    for evaluator in ["{ barrier-trend = { energy = 1 } }", "{ disjoint-paths = { above = 1 } }"] {
        assert!(refused(evaluator).contains("a model with energies expected"), "{evaluator}");
    }
    assert!(refused("{ disjoint-paths = {} }").contains("one of the two"));
    assert!(refused("{ disjoint-paths = { above = 1, energy = 2 } }").contains("one of the two"));
    assert!(refused("{ flow-ratio = { ratio = 0 } }").contains("a positive number"));
}

#[test]
fn disjoint_paths_are_counted_under_a_barrier() {
    // As many as are asked for there are not, so that every build goes on to its fourth round.
    let count = |settings: &str| {
        let settings = format!("{{ disjoint-paths = {{ count = 1000, {settings} }} }}");
        let verdict = on_the_hill(&settings, 4).remove(0);
        assert!(!verdict.satisfied && verdict.threshold == 1000.0);
        let [highest, lowest] = verdict.measures[..] else { panic!("two measures") };
        (verdict.value, highest, lowest)
    };
    let (lowest_only, highest, lowest) = count("above = 0");
    assert!(lowest_only >= 1.0 && highest == lowest);
    assert!(on_the_hill("{ disjoint-paths = { count = 1, above = 0 } }", 4)[0].satisfied);
    assert_eq!(count(&format!("energy = {}", lowest - 1e-6)).0, 0.0);
    let (mut last, mut grew) = (lowest_only, 0);
    for above in [0.1, 1.0, 10.0, 60.0] {
        let (value, highest, _) = count(&format!("above = {above}"));
        assert_eq!(highest, lowest + above);
        assert!(value >= last);
        grew += u32::from(value > last);
        last = value;
    }
    // Ten edges attach an end at the end of every round; all of them can be used where nothing is forbidden.
    assert!(grew > 1 && last >= 10.0, "{last}");
    assert_eq!(count("energy = 1e6").0, last);
}
