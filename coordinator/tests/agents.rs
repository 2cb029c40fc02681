//! Agents over plain pipes: however many there are, whatever they are, and whoever of them dies, the same roadmap in the
//! same ledger.
//!
//! `ROADMILL_AGENT_TRIALS` sets how many schedules of disturbances are run, `ROADMILL_AGENT_SEED` the one to run again.

mod support;

use rustix::process::Signal;
use serde_json::Value;
use std::fs;
use std::time::Duration;
use support::{
    ENDLESS, Random, Running, SMALL, Scratch, children, processes_naming, send, wait_until,
};

const ROADMILL: &str = env!("CARGO_BIN_EXE_roadmill");
const SETS: u64 = 120;

/// The options for agents of these names, which are started by this command.
fn with_agents<'a>(names: &'a str, command: &'a str) -> Vec<&'a str> {
    vec!["--agents", names, "--agent-command", command, "--workers", "1"]
}

fn agent() -> String {
    format!("{ROADMILL} agent")
}

/// Builds [`ENDLESS`] up to [`SETS`] sets.
fn build<'a>(run: &'a str, sets: &'a str, rest: &[&'a str]) -> Vec<&'a str> {
    [&["build", "endless.toml", "--out", run, "--max-sets", sets, "--or-resume"], rest].concat()
}

/// What a summary says of the machines.
fn machines(scratch: &Scratch, run: &str) -> Vec<Value> {
    let text = fs::read(scratch.path(run).join("summary.json")).expect("there is a summary");
    let json: Value = serde_json::from_slice(&text).expect("it is JSON");
    json["machines"].as_array().expect("machines are listed").clone()
}

/// The processes that are agents of a build: children, and children of carriers.
fn agents_of(running: &Running) -> Vec<u32> {
    let is_agent = |id: &u32| {
        let command = fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        command.split(|byte| *byte == 0).any(|word| word == b"agent")
    };
    running.workers().into_iter().filter(is_agent).collect()
}

/// The worker processes of an agent.
fn workers_of(agent: u32) -> Vec<u32> {
    let tasks = children(format!("/proc/{agent}/task").as_ref());
    let of_task =
        |task: std::path::PathBuf| fs::read_to_string(task.join("children")).unwrap_or_default();
    let all: String = tasks.into_iter().map(of_task).collect();
    all.split_whitespace().filter_map(|id| id.parse().ok()).collect()
}

#[test]
fn one_two_and_four_agents_give_the_ledger_of_threads() {
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(SETS);
    let whole = scratch.ledger(&format!("undisturbed-{SETS}"));
    let (sets, command) = (SETS.to_string(), agent());
    for (run, names, rest) in [
        ("one", "a", vec![]),
        ("two", "a,b", vec![]),
        ("four", "a,b,c,d", vec![]),
        ("audited", "a,b,c", vec!["--audit", "100%"]),
    ] {
        let options = [with_agents(names, &command), rest.clone()].concat();
        scratch.run(&build(run, &sets, &options)).assert_code(0);
        assert_eq!(scratch.summary(run).digest, digest, "{run}");
        assert!(scratch.ledger(run) == whole, "{run}: another ledger");
        let machines = machines(&scratch, run);
        assert_eq!(machines.len(), names.split(',').count());
        let done: u64 = machines.iter().filter_map(|machine| machine["done"].as_u64()).sum();
        assert!(done >= 2 * SETS, "{done} jobs were done");
        assert!(machines.iter().all(|machine| machine["bytes_sent"].as_u64() > Some(0)));
        if !rest.is_empty() {
            let text = fs::read_to_string(scratch.path(run).join("summary.json")).unwrap();
            let json: Value = serde_json::from_str(&text).unwrap();
            assert!(json["audited"]["compared"].as_u64() > Some(SETS), "{text}");
        }
    }
    assert!(processes_naming(&scratch.temporary()).is_empty());
}

#[test]
fn several_workers_of_one_agent_and_verify() {
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(SETS);
    let (sets, command) = (SETS.to_string(), agent());
    let mut options = with_agents("a", &command);
    *options.last_mut().unwrap() = "3";
    scratch.run(&build("run", &sets, &options)).assert_code(0);
    assert_eq!(scratch.summary("run").digest, digest);
    assert_eq!(machines(&scratch, "run")[0]["cores"], 3);
    scratch.run(&[&["verify", "run", "--all"], &options[..]].concat()).assert_code(0);
}

/// What is said before the link is opened, and agents that come late or never.
#[test]
fn greetings_are_skipped_and_late_agents_catch_up() {
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(SETS);
    scratch.write(
        "carrier.sh",
        &format!(
            "case $1 in\n\
             late) sleep 1;;\n\
             never) echo 'no such machine' >&2; exit 7;;\n\
             esac\n\
             echo \"Welcome to $1!\"\n\
             exec {ROADMILL} agent\n"
        ),
    );
    let sets = SETS.to_string();
    let options = with_agents("early,late,never", "sh carrier.sh {}");
    let done = scratch.run(&build("run", &sets, &options));
    done.assert_code(0);
    done.assert_stderr(&["agent never: no such machine", "exit status: 7"]);
    assert_eq!(scratch.summary("run").digest, digest);
    let never = &machines(&scratch, "run")[2];
    assert_eq!((&never["state"], &never["done"]), (&"waiting".into(), &0.into()));
}

#[test]
fn without_any_agent_a_build_ends_and_says_why() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let mut options = with_agents("a,b", "false {}");
    options.extend(["--agent-wait", "1.5"]);
    let done = scratch.run(&build("run", "8", &options));
    done.assert_code(5);
    done.assert_stderr(&[
        "no agent was at work for 1 s",
        "its stream ended before it opened the link",
    ]);
    // What cannot be started at all is tried again, too: a mount may come back.
    let mut options = with_agents("a", "/no/such/program {}");
    options.extend(["--agent-wait", "0.5"]);
    let done = scratch.run(&build("run", "8", &options));
    done.assert_code(5);
    done.assert_stderr(&["agent a: cannot be started", "/no/such/program"]);
    let digest = scratch.undisturbed_digest(8);
    scratch.run(&build("run", "8", &[])).assert_code(0);
    assert_eq!(scratch.summary("run").digest, digest);
}

#[test]
fn names_that_could_be_options_and_commands_without_end_are_refused() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    for (names, command, expected) in [
        ("-oProxyCommand=x", "ssh {} roadmill agent", "not beginning with -"),
        ("a b", "ssh {} roadmill agent", "without spaces"),
        ("a,,b", "ssh {} roadmill agent", "an empty name"),
        ("a", "ssh 'a", "a program and its arguments expected"),
        ("@missing.txt", "ssh {} roadmill agent", "missing.txt: cannot read"),
        ("@/dev/zero", "ssh {} roadmill agent", "/dev/zero"),
    ] {
        let names = format!("--agents={names}");
        let arguments = ["build", "endless.toml", &names, "--agent-command", command];
        let done = scratch.run(&arguments);
        done.assert_code(2);
        done.assert_stderr(&[expected]);
    }
    let done = scratch.run(&["agent", "--workers", "0"]);
    done.assert_code(2);
    let done = scratch.run(&["build", "endless.toml", "--agents", "a", "--audit", "1%"]);
    done.assert_code(2);
    done.assert_stderr(&["--audit: one machine found"]);
}

/// A worker that dies counts against its job; the agent stays.
#[test]
fn a_job_that_kills_workers_is_found_and_no_agent_blamed() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let (sets, command) = (SETS.to_string(), agent());
    let options = with_agents("a,b", &command);
    let done = scratch.start_with_faults(&build("run", &sets, &options), "die-at=a:20").finish();
    done.assert_code(5);
    done.assert_stderr(&["set a:20", "killed its workers"]);
    assert_eq!(scratch.summary("run").stop, "deadly-job");
    let machines = machines(&scratch, "run");
    let sum = |key: &str| machines.iter().filter_map(|machine| machine[key].as_u64()).sum::<u64>();
    assert!(sum("worker_deaths") >= 3, "{machines:?}");
    assert_eq!(sum("restarts"), 0, "{machines:?}");
    // Without the fault the build goes on to the same roadmap.
    let digest = scratch.undisturbed_digest(SETS);
    scratch.run(&build("run", &sets, &options)).assert_code(0);
    assert_eq!(scratch.summary("run").digest, digest);
}

/// A signal at an agent, as of a scheduler that wants the machine back: it hands back what it holds.
#[test]
fn an_agent_that_is_told_to_leave_does_so_and_comes_again() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let command = agent();
    let options = with_agents("a,b", &command);
    let running = scratch.start(&build("run", "1000000", &options));
    scratch.wait_for_rounds("run", 1);
    for _ in 0..3 {
        wait_until("two agents", || agents_of(&running).len() == 2);
        let agent = agents_of(&running)[0];
        wait_until("its workers", || !workers_of(agent).is_empty());
        send(agent, Signal::TERM);
        wait_until("its end", || !agents_of(&running).contains(&agent));
    }
    scratch.wait_for_rounds("run", 1);
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(6);
    done.assert_stderr(&["leaves: a signal came"]);
    let summary = scratch.summary("run");
    assert_eq!(summary.digest, scratch.undisturbed_digest(summary.sets));
}

/// What `status` says of the machines while they work.
#[test]
fn status_lists_machines() {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let command = agent();
    let running = scratch.start(&build("run", "1000000", &with_agents("a,b", &command)));
    wait_until("two machines at work", || {
        let status = scratch.run(&["status", "run"]);
        let ready = |name| status.stdout.contains(&format!("machine     {name} ("));
        status.status.code() == Some(0)
            && ready("a")
            && ready("b")
            && status.stdout.contains(": ready; 1 cores")
    });
    let status = scratch.run(&["status", "run", "--json"]);
    let json: Value = serde_json::from_str(&status.stdout).expect("it is JSON");
    assert_eq!(json["machines"].as_array().map(Vec::len), Some(2));
    running.signal(Signal::TERM);
    running.finish().assert_code(6);
    assert!(!scratch.path("run").join("machines.json").exists());
}

/// Schedules of disturbances: agents and workers killed, stopped for a while, told to leave, the coordinator killed and
/// the build gone on with, with another number of agents.
#[test]
fn whoever_is_killed_or_stopped_the_roadmap_is_the_same() {
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(SETS);
    let first = std::env::var("ROADMILL_AGENT_SEED").ok().map(|seed| seed.parse().expect("a seed"));
    let trials = std::env::var("ROADMILL_AGENT_TRIALS").ok();
    let trials: u64 = trials.map_or(6, |number| number.parse().expect("a number"));
    let seeds = first.map_or(0..trials, |seed| seed..seed + 1);
    for seed in seeds {
        let scratch = Scratch::new();
        scratch.write("endless.toml", ENDLESS);
        let story = disturbed(&scratch, seed);
        assert_eq!(scratch.summary("run").digest, digest, "seed {seed}: after {story:?}");
    }
}

/// Builds under disturbances that follow from a number; what they were.
fn disturbed(scratch: &Scratch, seed: u64) -> Vec<String> {
    let mut random = Random::new(seed);
    let mut story = Vec::new();
    let (sets, command) = (SETS.to_string(), agent());
    let lives = 1 + random.below(3);
    for life in 0..lives {
        let names = ["a", "a,b", "a,b,c"][random.below(3)];
        let mut options = with_agents(names, &command);
        *options.last_mut().unwrap() = ["1", "2"][random.below(2)];
        if random.below(3) == 0 && names != "a" {
            options.extend(["--audit", "30%"]);
        }
        story.push(format!("life {life}: {options:?}"));
        let running = scratch.start(&build("run", &sets, &options));
        for _ in 0..1 + random.below(4) {
            std::thread::sleep(Duration::from_millis(random.below(250) as u64));
            let agents = agents_of(&running);
            let Some(agent) = agents.get(random.below(agents.len().max(1))).copied() else {
                continue;
            };
            let what = random.below(5);
            story.push(format!("{what} at agent {agent}"));
            match what {
                0 => send(agent, Signal::KILL),
                1 => send(agent, Signal::TERM),
                2 => workers_of(agent).into_iter().for_each(|worker| send(worker, Signal::KILL)),
                3 => {
                    send(agent, Signal::STOP);
                    std::thread::sleep(Duration::from_millis(300));
                    send(agent, Signal::CONT);
                }
                _ => workers_of(agent)
                    .first()
                    .into_iter()
                    .for_each(|worker| send(*worker, Signal::KILL)),
            }
        }
        let signal = [None, Some(Signal::KILL), Some(Signal::TERM)][random.below(3)];
        if life + 1 < lives
            && let Some(signal) = signal
        {
            story.push(format!("{signal:?} at the coordinator"));
            running.signal(signal);
        }
        let done = running.end();
        let code = done.status.code();
        assert!(matches!(code, None | Some(0 | 6)), "seed {seed}: {story:?}\n{done:?}");
        wait_until("the end of all processes", || {
            processes_naming(&scratch.temporary()).is_empty()
        });
    }
    let done = scratch.run(&build("run", &sets, &[]));
    done.assert_code(0);
    // What killed agents have left is removed by the next build with workers.
    scratch.write("small.toml", SMALL);
    scratch.build("small", &["small.toml", "--workers", "1"], 0);
    story
}
