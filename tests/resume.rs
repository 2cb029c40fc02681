//! A build that is cut anywhere and goes on comes to what an undisturbed one comes to.

use roadmill::img::{
    Core, Cut, Executor, Grown, Judgement, Memo, Observer, Past, Progress, Round, Serial, Setup,
    Simulated, Stop, build, drive, resume_with,
};
use roadmill::model::ModelSpec;
use roadmill::model::bodies::SpaceSpec;
use roadmill::model::bodies::validity::{BoundsMeaning, MotionChecking};
use roadmill::numbers::{Ordinal, RoundNumber, StrategyIndex};
use roadmill::problem::{Limits, Problem, ProblemBuilder, StrategySpec};
use roadmill::roadmap::Tally;
use roadmill::schedule::Adaptive;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

const PROBLEMS: [&str; 12] = [
    "judged",
    "settled",
    "meshes",
    "slide",
    "adaptive",
    "axis",
    "landscape",
    "expansion",
    "growth",
    "directions",
    "neighbors",
    "deformable",
];

fn load(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems");
    let path = folder.join(format!("{name}.toml"));
    let mut text = std::fs::read_to_string(&path).expect("it ships");
    if text.contains("[query]") {
        // Never met: judged after every round, up to the limit.
        text += "\n[[evaluators]]\nall = [{ query = {} }, { not = { query = {} } }]\n";
    }
    Problem::parse(&path, &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Everything that must not differ.
fn result(build: &Grown) -> (String, Stop, String) {
    let judgement = format!("{:?}", build.judgement);
    (build.roadmap.digest().to_string(), build.stop.clone(), judgement)
}

/// What a ledger would hold, and a cut after so many looks.
#[derive(Default)]
struct Keeper {
    looks: Option<u64>,
    rounds: Vec<Round>,
    /// On every round; the last may be missing.
    judgements: Vec<Judgement>,
}

impl Observer for Keeper {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Infallible> {
        assert_eq!(round.number, RoundNumber(self.rounds.len() as u64));
        self.rounds.push(round.clone());
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        assert_eq!(judgement.round, RoundNumber(self.judgements.len() as u64));
        self.judgements.push(judgement.clone());
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        match &mut self.looks {
            Some(0) => Ok(Some(Cut::Interrupted)),
            Some(looks) => {
                *looks -= 1;
                Ok(None)
            }
            None => Ok(None),
        }
    }
}

impl Keeper {
    /// The judgement of the last round.
    fn judgement(&self) -> Option<Judgement> {
        self.judgements.get(self.rounds.len().checked_sub(1)?).cloned()
    }

    /// Goes on from what is kept until the next cut.
    fn go_on(&mut self, setup: &Setup, executor: &mut impl Executor, lookahead: u64) -> Stop {
        let mut past = Past::new(setup);
        for round in &self.rounds {
            executor.restore(round);
            past.fold(round);
        }
        past.verdicts = self.judgement().map(|judgement| judgement.verdicts);
        let Ok(stop) = drive(&mut Core::resume(setup, lookahead, past), executor, self);
        stop
    }

    fn text(&self) -> String {
        format!("{:?} {:?}", self.rounds, self.judgements)
    }
}

#[test]
fn a_build_cut_after_any_round_goes_on_as_if_nothing_had_happened() {
    for name in PROBLEMS {
        let setup = Arc::new(Setup::new(load(name)));
        let expected = result(&build(&setup));
        let mut whole = Keeper::default();
        whole.go_on(&setup, &mut Serial::new(setup.clone()), 0);
        assert!(whole.rounds.len() >= 2, "{name} has rounds to be cut after");
        for rounds in 0..=whole.rounds.len() {
            // Judged already, or cut between the fold and the judgement.
            let judgements = [None, rounds.checked_sub(1).map(|last| &whole.judgements[last])];
            for judgement in judgements {
                let serial = Serial::new(setup.clone());
                let rounds = &whole.rounds[..rounds];
                let found = resume_with(&setup, serial, 3, rounds, judgement.cloned());
                assert_eq!(result(&found), expected, "{name} cut after {} rounds", rounds.len());
            }
        }
    }
}

/// Any number of cuts at any events, each followed by other workers with other mishaps.
/// `ROADMILL_SCHEDULES` sets how many per problem, `ROADMILL_SCHEDULE` the one to run again.
#[test]
fn no_schedule_of_cuts_and_mishaps_changes_a_bit() {
    let number = |name| std::env::var(name).ok().map(|text| text.parse::<u64>().expect("a number"));
    let schedules = match number("ROADMILL_SCHEDULE") {
        Some(only) => only..only + 1,
        None => 0..number("ROADMILL_SCHEDULES").unwrap_or(500),
    };
    for name in PROBLEMS {
        let setup = Arc::new(Setup::new(load(name)));
        let mut whole = Keeper::default();
        let stop = whole.go_on(&setup, &mut Serial::new(setup.clone()), 0);
        let (expected, mut memo) = (whole.text(), Memo::new());
        for seed in schedules.clone() {
            let mut kept = Keeper::default();
            // Cuts in this distance, so that even the closest come to an end.
            let mut looks = 5 + seed % 83;
            for life in 0.. {
                kept.looks = Some(looks);
                looks += 7;
                let workers = 1 + (seed + life) as usize % 9;
                let mut simulated =
                    Simulated::new(setup.clone(), workers, seed ^ life << 32, &mut memo);
                let found = kept.go_on(&setup, &mut simulated, (seed + life) % 17);
                if found != Stop::Cut(Cut::Interrupted) {
                    assert_eq!(found, stop, "{name}: ROADMILL_SCHEDULE={seed}");
                    break;
                }
            }
            assert!(kept.text() == expected, "{name}: run again with ROADMILL_SCHEDULE={seed}");
        }
    }
}

/// `slide` with another strategy, scheduled with what is there.
fn further() -> Problem {
    further_than("slide", None)
}

fn further_than(name: &str, adaptive: Option<Adaptive>) -> Problem {
    let known = load(name);
    let first = &known.strategies()[0];
    let further = StrategySpec::from(first).label("further").nodes(u64::from(first.nodes()) + 3);
    let limits = known.limits();
    let changed = known
        .to_builder()
        .sets_per_round(u64::from(known.sets_per_round()) + 1)
        .most_nodes(2 * limits.nodes)
        .most_sets(limits.sets.saturating_mul(2));
    let changed = match adaptive {
        Some(adaptive) => changed.strategy(further).adaptive(adaptive),
        // The strategies that are not named get no more sets.
        None => {
            let schedule = ["further", first.label()];
            changed.strategies([first.into(), further]).schedule(schedule)
        }
    };
    changed.build().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_chapter_adds_to_what_is_there_and_ordinals_count_on() {
    let adaptive = Some(Adaptive { rounds: 3 });
    // From one schedule to another, to one that adapts, from one that adapts, and to another such.
    for (name, then) in
        [("slide", None), ("slide", adaptive), ("adaptive", None), ("adaptive", adaptive)]
    {
        a_chapter_adds(name, &further_than(name, then));
    }
}

fn a_chapter_adds(name: &str, further: &Problem) {
    let begun = Arc::new(Setup::new(load(name)));
    let mut kept = Keeper::default();
    kept.go_on(&begun, &mut Serial::new(begun.clone()), 0);
    let before = kept.rounds.len();
    let problem = begun.problem().continued(further, before as u64).unwrap();
    let setup = Arc::new(Setup::new(problem));
    let whole = resume_with(&setup, Serial::new(setup.clone()), 0, &kept.rounds, None);

    let mut memo = Memo::new();
    for seed in 0..50 {
        // Cut once more inside the chapter; from then on it is one build like any other.
        let mut cut =
            Keeper { looks: Some(seed), rounds: kept.rounds.clone(), ..Keeper::default() };
        cut.judgements.clone_from(&kept.judgements);
        let mut simulated = Simulated::new(setup.clone(), 4, seed, &mut memo);
        cut.go_on(&setup, &mut simulated, 5);
        cut.looks = None;
        let mut simulated = Simulated::new(setup.clone(), 4, seed + 1000, &mut memo);
        cut.go_on(&setup, &mut simulated, 2);
        assert_eq!(simulated.tally().digest(), whole.roadmap.digest(), "{seed}");

        let mut next = vec![Ordinal(0); setup.problem().strategies().len()];
        for set in cut.rounds.iter().flat_map(|round| &round.sets) {
            assert_eq!(set.ordinal, next[set.strategy.index()]);
            next[set.strategy.index()] = set.ordinal.next();
        }
        assert!(next.iter().all(|sets| sets.0 > 0), "every strategy has sets: {next:?}");
        assert!(
            cut.rounds[before..].iter().all(|round| round.sets.len() > kept.rounds[0].sets.len())
        );
    }
}

#[test]
fn a_chapter_changes_nothing_that_sets_depend_on() {
    let problem = load("slide");
    let refused = |change: fn(ProblemBuilder) -> ProblemBuilder| {
        let changed =
            change(problem.to_builder()).build().unwrap_or_else(|error| panic!("{error}"));
        problem.continued(&changed, 3).unwrap_err()
    };
    let space = |change: fn(SpaceSpec) -> SpaceSpec| {
        let builder = problem
            .to_builder()
            .change_model(|model| model.change_bodies(|bodies| bodies.change_space(change)));
        let changed = builder.build().unwrap_or_else(|error| panic!("{error}"));
        problem.continued(&changed, 3).unwrap_err()
    };
    assert!(refused(|p| p.seed(2)).contains("the seed is"));
    assert!(space(|space| space.resolution(0.5)).contains("resolution"));
    assert!(
        space(|space| space.edges(MotionChecking::Sampled)).contains("what is promised of edges")
    );
    assert!(space(|space| space.bounds(BoundsMeaning::Reference)).contains("bounds"));
    let clear = |model: ModelSpec| model.change_bodies(|bodies| bodies.obstacles([]));
    let cleared = problem.to_builder().change_model(clear).build().expect("nothing in the way");
    assert!(problem.continued(&cleared, 3).unwrap_err().contains("obstacle"));
    let label = problem.strategies()[0].label();
    let larger = refused(|p| p.change_strategies(|strategy| strategy.nodes(21)));
    assert!(larger.contains(&format!("`{label}` is not what")));

    // The same schedule goes on where it was: nothing is to be remembered.
    let limits = Limits { nodes: problem.limits().nodes + 1, ..problem.limits() };
    let next = problem.continued(&problem.clone().with_limits(limits).unwrap(), 3).unwrap();
    assert_eq!((next.digest(), next.limits()), (problem.digest(), limits));
    // Another one before the first round replaces the first.
    let labels = |problem: &Problem| -> Vec<String> {
        let of =
            |strategy: &StrategyIndex| problem.strategies()[strategy.index()].label().to_owned();
        problem.schedule().iter().map(of).collect()
    };
    let next = problem.continued(&further(), 0).unwrap();
    assert_eq!((labels(&next), next.earlier()), (labels(&further()), &[][..]));
}
