//! The state machine on its own: what it asks for, and how it ends when answers go wrong.

use super::*;
use crate::model::Scratch;
use crate::numbers::{NodeId, Ordinal, SetName, SetNumber};
use crate::problem::Problem;
use crate::roadmap::Tally;
use crate::sampler::GaveUp;
use std::path::Path;

const PROBLEM: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [4.0, 4.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [0.2, 4.0, 1.0] } }
position = [2.0, 2.0, 0.0]
[query]
start = [1.0, 1.0]
goal = [3.0, 1.0]
[img]
sets_per_round = 2
[[strategies]]
label = "only"
nodes = 4
sampler = { uniform = {} }
[limits]
sets = 4
"#;

fn setup() -> Arc<Setup> {
    Arc::new(Setup::new(Problem::parse(Path::new("p.toml"), PROBLEM).unwrap()))
}

/// Of the only strategy.
fn generate(number: u64) -> Job {
    Job::Generate {
        number: SetNumber(number),
        strategy: StrategyIndex(0),
        ordinal: Ordinal(number),
    }
}

fn join(number: u64) -> Job {
    Job::Join { number: SetNumber(number), strategy: StrategyIndex(0), ordinal: Ordinal(number) }
}

fn jobs(commands: &[Command]) -> Vec<Job> {
    let job = |command: &Command| match command {
        Command::Submit(job) => Some(*job),
        _ => None,
    };
    commands.iter().filter_map(job).collect()
}

fn stop(commands: &[Command]) -> Option<&Stop> {
    commands.iter().find_map(|command| match command {
        Command::Stop(stop) => Some(stop),
        _ => None,
    })
}

fn done(setup: &Setup, replica: &Replica, job: Job) -> Event {
    let task = replica.task(setup, job).unwrap();
    Event::Done(job, Finished::new(task.run(setup, &mut Scratch::new())))
}

#[test]
fn joins_wait_for_the_increments_before_them_and_nothing_else() {
    let setup = setup();
    let replica = Replica::new(&setup);
    let mut core = Core::new(&setup, 0);
    assert_eq!(jobs(&core.start()), [generate(0), generate(1)]);
    // The second increment comes first and waits for the first.
    assert!(core.on_event(done(&setup, &replica, generate(1))).is_empty());
    let commands = core.on_event(done(&setup, &replica, generate(0)));
    assert_eq!(jobs(&commands), [join(0), join(1)]);
    let published = |command: &&Command| matches!(command, Command::Publish(_));
    assert_eq!(commands.iter().filter(published).count(), 2);
}

#[test]
fn no_set_is_generated_beyond_the_round_that_reaches_a_limit() {
    for (sets, nodes, expected) in [(4, 1000, 4), (3, 1000, 4), (1000, 8, 2), (1000, 9, 4)] {
        let mut problem = setup().problem.clone();
        problem.limits.sets = sets;
        problem.limits.nodes = nodes;
        let setup = Arc::new(Setup::new(problem));
        assert_eq!(jobs(&Core::new(&setup, 100).start()).len(), expected);
        let built = build(&setup);
        assert_eq!(built.roadmap.sets(), expected as u64);
        let limit = if sets < 1000 { Stop::SetLimit } else { Stop::NodeLimit };
        assert_eq!(built.stop, limit);
    }
}

#[test]
fn an_answer_that_differs_from_the_first_ends_the_build() {
    let setup = setup();
    let replica = Replica::new(&setup);
    let mut core = Core::new(&setup, 0);
    core.start();
    let job = generate(0);
    core.on_event(done(&setup, &replica, job));
    assert!(core.on_event(done(&setup, &replica, job)).is_empty());
    let other = Outcome::Increment(Err(GaveUp { attempts: 1 }));
    let commands = core.on_event(Event::Done(job, Finished::new(other)));
    assert_eq!(stop(&commands), Some(&Stop::Contradiction(job, String::new())));
}

#[test]
fn impossible_answers_end_the_build() {
    let setup = setup();
    let replica = Replica::new(&setup);
    let first = generate(0);
    let task = replica.task(&setup, first).unwrap();
    let Outcome::Increment(Ok(mut increment)) = task.run(&setup, &mut Scratch::new()) else {
        panic!("the sampler finds milestones");
    };
    increment.edges.push(crate::roadmap::Edge::metric(NodeId(0), NodeId(4), 0, 1.0));
    let no_such_node = Outcome::Increment(Ok(increment));
    let joined = Outcome::Joined(Joined { edges: Vec::new(), asked: Default::default() });
    let gave_up = Outcome::Increment(Err(GaveUp { attempts: 1 }));
    for (job, outcome) in [(first, no_such_node), (first, joined), (generate(99), gave_up)] {
        let mut core = Core::new(&setup, 0);
        core.start();
        let commands = core.on_event(Event::Done(job, Finished::new(outcome)));
        assert_eq!(stop(&commands), Some(&Stop::Nonsense(job)));
    }
}

#[test]
fn a_job_at_which_three_workers_die_ends_the_build_and_is_named() {
    let setup = setup();
    let mut core = Core::new(&setup, 0);
    core.start();
    let job = generate(1);
    // Members that leave, before and in between, are not held against the job.
    for loss in
        [[Loss::Departure; 5].as_slice(), &[Loss::Death, Loss::Departure, Loss::Death]].concat()
    {
        assert_eq!(jobs(&core.on_event(Event::Lost(job, loss))), [job]);
    }
    for _ in 0..20 {
        assert_eq!(jobs(&core.on_event(Event::Lost(job, Loss::Departure))), [job]);
    }
    let other = core.on_event(Event::Lost(generate(0), Loss::Death));
    assert_eq!(jobs(&other), [generate(0)], "deaths are counted job by job");
    assert_eq!(stop(&core.on_event(Event::Lost(job, Loss::Death))), Some(&Stop::Deadly(job)));
    assert!(core.on_event(Event::Lost(job, Loss::Death)).is_empty());
}

/// Whether a sampler's failure counts must not depend on how early it is known.
#[test]
fn a_set_that_gave_up_counts_only_if_the_rounds_before_it_do_not_suffice() {
    let mut problem = setup().problem.clone();
    problem.model.bodies_mut().expect("bodies").obstacles.clear();
    problem.sets_per_round = 1;
    let setup = Arc::new(Setup::new(problem));
    let mut core = Core::new(&setup, 1);
    let mut replica = Replica::new(&setup);
    let mut commands = core.start();
    let second = generate(1);
    let gave_up = Finished::new(Outcome::Increment(Err(GaveUp { attempts: 9 })));
    assert!(core.on_event(Event::Done(second, gave_up)).is_empty());
    loop {
        let mut next = Vec::new();
        for command in commands {
            match command {
                Command::Publish(increment) => replica.publish(&setup, increment),
                Command::Fold(round) => replica.fold(&setup, round.joins()),
                Command::Submit(job) if job != second => {
                    next.extend(core.on_event(done(&setup, &replica, job)));
                }
                Command::Submit(_) | Command::Judge(_) => {}
                Command::Stop(stop) => return assert_eq!(stop, Stop::Satisfied),
            }
        }
        assert!(!next.is_empty(), "the build goes on");
        commands = next;
    }
}

#[test]
fn a_sampler_that_gives_up_ends_the_build_with_its_name() {
    // Slits 0.02 wide on either side, which 50 attempts mostly miss.
    let mut text = PROBLEM.replace("uniform = {}", "uniform = { attempts = 50 }");
    for (width, x) in [(1.58, 0.0), (0.79, 1.605), (0.79, 2.395), (1.58, 4.0)] {
        let body =
            format!("shape = {{ box = {{ size = [{width}, 9, 9] }} }}\nposition = [{x}, 2, 0]");
        text = text.replace("[img]", &format!("[[obstacles]]\n{body}\n[img]"));
    }
    let problem = Problem::parse(Path::new("p.toml"), &text).unwrap();
    let setup = Arc::new(Setup::new(problem));
    for threads in [0, 1, 3] {
        let built = match threads {
            0 => build(&setup),
            _ => build_in_threads(&setup, threads),
        };
        let Stop::GaveUp { strategy: StrategyIndex(0), ordinal, gave_up } = built.stop else {
            panic!("{:?}", built.stop);
        };
        assert_eq!(gave_up, GaveUp { attempts: 50 });
        assert!(ordinal.0 >= built.roadmap.sets());
    }
}

#[test]
fn nothing_is_generated_whose_strategy_depends_on_rounds_to_come() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems/adaptive.toml");
    let setup = Arc::new(Setup::new(Problem::load(&path).unwrap()));
    let sets = setup.problem.sets_per_round as usize;
    assert_eq!(jobs(&Core::new(&setup, 100).start()).len(), sets);

    struct Keep(Vec<Round>);
    impl Observer for Keep {
        type Error = std::convert::Infallible;
        fn folded(&mut self, round: &Round, _: &Tally) -> Result<(), Self::Error> {
            self.0.push(round.clone());
            Ok(())
        }
    }
    let mut kept = Keep(Vec::new());
    let Ok(_) = drive(&mut Core::new(&setup, 100), &mut Serial::new(setup.clone()), &mut kept);
    // The plan alone, told of the rounds so far, knows the next round and no other.
    let mut plan = setup.plan.clone();
    let mut sets_of = vec![Ordinal(0); setup.problem.strategies.len()];
    for round in &kept.0 {
        assert_eq!(plan.known_until(), plan.sets_of(round.number).end);
        assert_eq!(plan.name_of(plan.known_until()), None);
        for set in &round.sets {
            let name = SetName { strategy: set.strategy, ordinal: set.ordinal };
            assert_eq!(plan.name_of(set.number), Some(name));
            assert_eq!(set.ordinal, sets_of[set.strategy.index()]);
            sets_of[set.strategy.index()] = set.ordinal.next();
        }
        plan.observe(round);
    }
    assert!(sets_of.iter().all(|sets| sets.0 > 0), "every one is tried: {sets_of:?}");
    let (least, most) = (sets_of.iter().min(), sets_of.iter().max());
    assert!(least < most, "and some more than others: {sets_of:?}");
}
