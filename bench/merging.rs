//! What ways of merging sets ask for and what they join (TR05-007 §5).
//!
//! ```text
//! cargo bench --bench merging [-- SETS [PROBLEM …]]
//! ```
//!
//! Every problem (default: maze, cage and walls) is built up to SETS sets (default 60) of 50 uniform nodes,
//! 5 to a round, once per way of merging and seed (1, 2, 3), without evaluators but the query, which
//! is only noted. Ways of merging get the same increments, since a set does not depend on what it is
//! merged with. Motions asked for are counted where they are asked for; a component is joined when it is
//! one less after a round than the roadmap's and the increments' were before. One local planner, so a
//! motion is an edge tried.

use roadmill::connect::{AmongKind, ComponentPairs, NearestNodes, NodesAndComponents, UntilJoined};
use roadmill::evaluate::{EvaluatorKind, Not, Query};
use roadmill::img::{Core, Judgement, Observer, Round, Serial, Setup, drive};
use roadmill::local::Planner;
use roadmill::problem::Problem;
use roadmill::roadmap::{Components, Roadmap, Tally};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const SEEDS: [u64; 3] = [1, 2, 3];

fn main() {
    let words: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let sets = words.first().map_or(60, |word| word.parse().expect("a number of sets"));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    let mut problems: Vec<PathBuf> = words.iter().skip(1).map(PathBuf::from).collect();
    if problems.is_empty() {
        problems =
            ["maze", "cage", "walls"].map(|name| folder.join(name).with_extension("toml")).into();
    }
    let planners = vec![Planner::StraightLine];
    let ways = [
        ("component-pairs", AmongKind::ComponentPairs(ComponentPairs::default())),
        ("nodes-and-components", AmongKind::NodesAndComponents(NodesAndComponents::default())),
        ("nearest-nodes 1", nearest(1, &planners)),
        ("nearest-nodes 3", nearest(3, &planners)),
        ("nearest-nodes 10", nearest(10, &planners)),
        ("until-joined 3", until(3, &planners)),
        ("until-joined 10", until(10, &planners)),
        ("until-joined 30", until(30, &planners)),
    ];
    println!(
        "| scene | merging | edges tried | free | components joined | tried per joined | components left | in the largest | solved |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for path in problems {
        for (name, way) in &ways {
            let mut sum = Watch::default();
            for seed in SEEDS {
                let problem = Problem::load(&path).unwrap_or_else(|error| panic!("{error}"));
                // Never satisfied, so that the build goes on to its limit.
                let query = EvaluatorKind::Query(Query::default());
                let not = EvaluatorKind::Not(Not(Box::new(query.clone())));
                let problem = problem
                    .to_builder()
                    .seed(seed)
                    .most_sets(sets)
                    .most_nodes(u64::from(u32::MAX / 2))
                    .change_strategies(|strategy| strategy.among(way.clone()))
                    .evaluators([query, not])
                    .build();
                let problem = problem.unwrap_or_else(|error| panic!("{error}"));
                let setup = Arc::new(Setup::new(problem));
                let build = Some((setup.clone(), Roadmap::new(setup.context().space())));
                let mut watch = Watch { build, ..sum };
                let mut serial = Serial::new(setup.clone());
                let Ok(_) = drive(&mut Core::new(&setup, 0), &mut serial, &mut watch);
                watch.end();
                sum = watch;
            }
            println!(
                "| {} | {name} | {} | {} | {} | {:.2} | {} | {:.1} % | {} of {} |",
                path.file_stem().unwrap_or_default().display(),
                sum.tried,
                sum.free,
                sum.joined,
                sum.tried as f64 / sum.joined as f64,
                sum.left,
                100.0 * sum.largest / SEEDS.len() as f64,
                sum.solved,
                SEEDS.len(),
            );
        }
    }
}

fn nearest(neighbors: u32, planners: &[Planner]) -> AmongKind {
    AmongKind::NearestNodes(NearestNodes { neighbors, planners: planners.to_vec() })
}

fn until(neighbors: u32, planners: &[Planner]) -> AmongKind {
    AmongKind::UntilJoined(UntilJoined { neighbors, planners: planners.to_vec() })
}

/// What builds came to, one after the other.
#[derive(Default)]
struct Watch {
    /// The problem at work, and its roadmap so far.
    build: Option<(Arc<Setup>, Roadmap)>,
    tried: u64,
    free: usize,
    joined: usize,
    left: usize,
    largest: f64,
    solved: u32,
    /// Of the build at work: components, share of nodes in the largest, whether the query was solved.
    now: (usize, f64, bool),
}

impl Watch {
    fn end(&mut self) {
        let (components, largest, solved) = std::mem::take(&mut self.now);
        self.left += components;
        self.largest += largest;
        self.solved += u32::from(solved);
    }
}

impl Observer for Watch {
    type Error = std::convert::Infallible;

    fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Self::Error> {
        let (setup, roadmap) = self.build.as_mut().expect("a build");
        let space = setup.context().space();
        let mut before = self.now.0;
        for set in &round.sets {
            self.tried += set.joined.asked.motions;
            self.free += set.joined.edges.len();
            before += Components::of(space, &set.increment.configs, &set.increment.edges).count();
        }
        roadmap.fold_round(space, round.parts());
        self.now.0 = roadmap.components().count();
        self.joined += before - self.now.0;
        let sizes = roadmap.components().iter().map(|component| component.members.len());
        self.now.1 = sizes.max().unwrap_or(0) as f64 / roadmap.configs().len() as f64;
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Self::Error> {
        self.now.2 = judgement.verdicts[0].satisfied;
        Ok(())
    }
}
