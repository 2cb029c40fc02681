//! Agents that are broken, of another program, or harmful: each is given up or refused alone, and the build goes on by
//! the others to the same roadmap. Wrong bits are found by comparison, and end the build.
//!
//! The bad agents are threads of the tests: what carries them leads their streams to two named pipes.

mod support;

use roadmill::img::{Setup, canaries};
use roadmill::internal::wire;
use roadmill::roadmap::Digest;
use roadmill_coordinator::agent::link::{
    Frame, HEADER_BYTES, Kind, Link, OPENING, PIECE_BYTES, WINDOW_BYTES,
};
use roadmill_coordinator::agent::{FromAgent, Identity, ToAgent};
use roadmill_workers::message::Done;
use rustix::fs::{CWD, Mode, mkfifoat};
use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use support::{Scratch, wait_until};

const SETS: u64 = 60;
/// The pipe to a bad agent.
const TO_BAD: &str = "to-bad";
/// The pipe from it.
const FROM_BAD: &str = "from-bad";
/// What it leaves once it has done what it does.
const MARK: &str = "bad-was-here";

/// Builds with a bad agent of this kind and a good one, which comes once the bad one has done what it does.
fn build(scratch: &Scratch, kind: &'static str, names: &str, rest: &[&str]) -> support::Done {
    for pipe in [TO_BAD, FROM_BAD] {
        mkfifoat(CWD, scratch.path(pipe), Mode::RUSR | Mode::WUSR).expect("a pipe can be made");
    }
    // A command in the background reads nothing of a shell's own standard input.
    scratch.write(
        "carrier.sh",
        &format!(
            "if [ $1 = bad ]; then exec 3<&0; cat <&3 >{TO_BAD} & exec cat {FROM_BAD}; fi\n\
             while ! [ -e {MARK} ]; do sleep 0.01; done\n\
             exec {} agent\n",
            env!("CARGO_BIN_EXE_roadmill"),
        ),
    );
    let folder = scratch.path(".");
    let bad = std::thread::spawn(move || be_bad(kind, &folder));
    let sets = SETS.to_string();
    let build = ["build", "endless.toml", "--out", "run", "--force", "--max-sets", &sets];
    let agents = ["--workers", "1", "--agents", names, "--agent-command", "sh carrier.sh {}"];
    let done = scratch.run(&[&build[..], &agents, rest].concat());
    wait_until("the end of the bad agent", || bad.is_finished());
    bad.join().expect("the bad agent does what it is to do");
    for name in [TO_BAD, FROM_BAD, MARK] {
        std::fs::remove_file(scratch.path(name)).expect("it was there");
    }
    done
}

#[test]
fn each_bad_agent_is_given_up_alone() {
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(SETS);
    for (kind, expected) in [
        ("rubbish", "where a frame should begin"),
        ("noise", "did not open the link"),
        ("replayed-frame", "frame 0 where frame 1 should be"),
        ("huge", "at most 65495 expected"),
        ("flood", "refused: it sent undecodable bytes"),
        ("greedy-credit", "it took in"),
        ("other-source", "refused: it is another program"),
        ("other-protocol", "speaks version 77 of the agents' messages"),
        ("other-bits", "makes bits of version"),
        ("many-cores", "has 1000000 workers"),
        ("other-arithmetic", "the digest of its canaries differs"),
        ("out-of-turn", "sent a message out of turn"),
        ("nonsense", "refused: it sent undecodable bytes"),
        ("foreign-job", "the outcome of a job that it did not have"),
        ("replayed-job", "refused: it sent"),
        ("broken-outcome", "refused: it sent undecodable bytes"),
        ("vanishes", "its stream ended"),
    ] {
        let done = build(&scratch, kind, "bad,good", &[]);
        assert_eq!(done.status.code(), Some(0), "{kind}: {}", done.stderr);
        assert!(done.stderr.contains(expected), "{kind}: no `{expected}` in\n{}", done.stderr);
        assert_eq!(scratch.summary("run").digest, digest, "{kind}");
    }
}

#[test]
fn a_build_whose_agents_are_all_refused_ends() {
    let scratch = Scratch::new();
    scratch.undisturbed_digest(1);
    let done = build(&scratch, "other-source", "bad", &[]);
    done.assert_code(5);
    done.assert_stderr(&["no agent can be used", "was built from other sources"]);
}

#[test]
fn wrong_bits_are_found_by_an_audit() {
    let scratch = Scratch::new();
    scratch.undisturbed_digest(1);
    let done = build(&scratch, "wrong-bits", "bad,good", &["--audit", "100%"]);
    done.assert_code(4);
    done.assert_stderr(&["gave two different outcomes", "bad", "good"]);
    assert_eq!(scratch.summary("run").stop, "contradiction");
}

/// A bad agent's end of the link.
struct Bad {
    link: Link,
    input: File,
    output: File,
    folder: PathBuf,
}

impl Bad {
    /// Waits until something carries it.
    fn new(folder: &Path) -> Bad {
        let input = File::open(folder.join(TO_BAD)).expect("it can be opened");
        let output = File::options().write(true).open(folder.join(FROM_BAD));
        let output = output.expect("it can be opened");
        Bad { link: Link::far(), input, output, folder: folder.to_owned() }
    }

    /// Lets the good agents come.
    fn mark(&self) {
        File::create(self.folder.join(MARK)).expect("a file can be made");
    }

    fn hear(&mut self) -> ToAgent {
        loop {
            if let Some(message) = self.link.receive() {
                return wire::decode(&message).expect("the coordinator speaks well");
            }
            let mut bytes = vec![0; 1 << 16];
            let read = self.input.read(&mut bytes).expect("it can be read");
            assert!(read > 0, "the coordinator has closed the link");
            self.link.take_in(&bytes[..read], 0).expect("the coordinator speaks well");
        }
    }

    /// Writes all that there is to be said.
    fn flush(&mut self) {
        loop {
            let output = self.link.output().to_vec();
            if output.is_empty() {
                return;
            }
            self.output.write_all(&output).expect("it can be written");
            self.link.written(output.len());
        }
    }

    fn say(&mut self, message: &FromAgent<'_>) {
        self.link.send(Arc::new(wire::encode(message)));
        self.flush();
    }

    /// Writes bytes as they are; whoever reads them may have gone.
    fn raw(&mut self, bytes: &[u8]) {
        let _ = self.output.write_all(bytes);
    }

    /// Writes a frame as it is.
    fn frame(&mut self, kind: Kind, session: u64, number: u64, bytes: &[u8]) {
        let mut output = Vec::new();
        Frame { kind, session, number, bytes }.write(&mut output);
        self.raw(&output);
    }

    fn hello(&mut self, who: Identity, cores: u32) {
        self.flush();
        assert!(matches!(self.hear(), ToAgent::Greeting { .. }));
        self.say(&FromAgent::Hello { who, cores, host: "bad".to_owned() });
    }

    /// Up to the point where it is given jobs, which it returns.
    fn be_given_jobs(&mut self) -> Vec<roadmill::img::Job> {
        self.hello(Identity::own(), 1);
        let ToAgent::Problem(problem) = self.hear() else { panic!("a problem comes next") };
        self.say(&FromAgent::Ready { canaries: canaries(&Setup::new(*problem)) });
        loop {
            if let ToAgent::Work { jobs, .. } = self.hear()
                && !jobs.is_empty()
            {
                return jobs;
            }
        }
    }

    /// Until the coordinator has closed the link.
    fn wait(mut self) {
        self.mark();
        let _ = std::io::copy(&mut self.input, &mut std::io::sink());
    }
}

/// Is a bad agent of this kind until the coordinator has closed the link.
fn be_bad(kind: &str, folder: &Path) {
    let mut bad = Bad::new(folder);
    let own = Identity::own();
    match kind {
        "rubbish" => {
            bad.flush();
            bad.raw(&[0xa5; 10_000]);
        }
        "noise" => {
            bad.mark();
            for _ in 0..400 {
                bad.raw(&[b'x'; 4096]);
            }
        }
        "replayed-frame" => {
            let session = session(&mut bad);
            bad.frame(Kind::Beat, session, 0, &[0; 8]);
            bad.frame(Kind::Beat, session, 0, &[0; 8]);
        }
        "huge" => {
            let session = session(&mut bad);
            let mut frame = Vec::new();
            Frame { kind: Kind::Last, session, number: 0, bytes: &[] }.write(&mut frame);
            frame[24..28].copy_from_slice(&u32::MAX.to_le_bytes());
            bad.raw(&frame);
        }
        "flood" => {
            let session = session(&mut bad);
            // More than there is credit for, if they are not taken in faster.
            let piece = vec![0; PIECE_BYTES];
            for number in 0..2 * WINDOW_BYTES / PIECE_BYTES as u64 {
                bad.frame(Kind::Last, session, number, &piece);
            }
        }
        "greedy-credit" => {
            let session = session(&mut bad);
            bad.frame(Kind::Credit, session, 0, &(1u64 << 40).to_le_bytes());
        }
        "other-source" => bad.hello(Identity { source: "0123".to_owned(), ..own }, 1),
        "other-protocol" => bad.hello(Identity { protocol: 77, ..own }, 1),
        "other-bits" => bad.hello(Identity { bits: 77, ..own }, 1),
        "many-cores" => bad.hello(own, 1_000_000),
        "other-arithmetic" => {
            bad.hello(own, 1);
            assert!(matches!(bad.hear(), ToAgent::Problem(_)));
            bad.say(&FromAgent::Ready { canaries: Digest::of(b"another") });
        }
        "out-of-turn" => {
            bad.flush();
            assert!(matches!(bad.hear(), ToAgent::Greeting { .. }));
            bad.say(&FromAgent::Done(Vec::new()));
        }
        "nonsense" => {
            bad.flush();
            assert!(matches!(bad.hear(), ToAgent::Greeting { .. }));
            bad.link.send(Arc::new(vec![0xff; 50]));
            bad.flush();
        }
        "foreign-job" => {
            let jobs = bad.be_given_jobs();
            let mut job = jobs[0];
            if let roadmill::img::Job::Generate { number, .. } = &mut job {
                *number = *number + 1_000_000;
            }
            bad.say(&FromAgent::Done(vec![Done { job, micros: 1, outcome: b"" }]));
        }
        "replayed-job" => {
            let died = bad.be_given_jobs();
            // Given back, and done all the same.
            bad.say(&FromAgent::Died { jobs: died.clone(), why: String::new() });
            bad.say(&FromAgent::Done(vec![Done { job: died[0], micros: 1, outcome: b"" }]));
        }
        "broken-outcome" => {
            let jobs = bad.be_given_jobs();
            bad.say(&FromAgent::Done(vec![Done { job: jobs[0], micros: 1, outcome: &[0xff; 30] }]));
        }
        "vanishes" => {
            bad.be_given_jobs();
            return bad.mark();
        }
        "wrong-bits" => return relay(bad),
        other => panic!("no kind of agent is called {other}"),
    }
    bad.wait();
}

/// Opens the link, and hears which conversation it is.
fn session(bad: &mut Bad) -> u64 {
    bad.output.write_all(OPENING).expect("it can be written");
    let mut bytes = vec![0; OPENING.len() + HEADER_BYTES];
    bad.input.read_exact(&mut bytes).expect("the coordinator greets");
    assert!(bytes.starts_with(OPENING));
    u64::from_le_bytes(bytes[OPENING.len() + 8..][..8].try_into().expect("8 bytes"))
}

/// A good agent behind one that changes a bit of every outcome.
fn relay(bad: Bad) {
    bad.mark();
    let Bad { mut input, mut output, .. } = bad;
    let program = Path::new(env!("CARGO_BIN_EXE_roadmill"));
    let mut good = Command::new(program)
        .arg("agent")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut to_good = good.stdin.take().expect("it has one");
    let mut from_good = good.stdout.take().expect("it has one");
    // What the coordinator says goes on as it is.
    std::thread::spawn(move || std::io::copy(&mut input, &mut to_good));
    pass_on(&mut from_good, &mut output);
    drop(from_good);
    let _ = good.kill().and_then(|()| good.wait());
}

/// Passes on what a good agent says, with a bit of every outcome changed, until one of the two ends.
fn pass_on(from_good: &mut impl Read, output: &mut impl Write) {
    let mut bytes = Vec::new();
    let mut is_open = false;
    let mut buffer = vec![0; 1 << 16];
    loop {
        let read = from_good.read(&mut buffer).expect("it can be read");
        if read == 0 {
            return;
        }
        bytes.extend(&buffer[..read]);
        if !is_open {
            if bytes.len() < OPENING.len() {
                continue;
            }
            let opening: Vec<u8> = bytes.drain(..OPENING.len()).collect();
            output.write_all(&opening).expect("it can be written");
            is_open = true;
        }
        while let Some((frame, length)) = Frame::read(&bytes).expect("it speaks well") {
            let mut body = frame.bytes.to_vec();
            if frame.kind == Kind::Last
                && wire::decode_borrowed::<FromAgent<'_>>(&body)
                    .is_ok_and(|message| matches!(message, FromAgent::Done(_)))
            {
                // Within the last outcome.
                let at = body.len() - 9;
                body[at] ^= 1;
            }
            let mut changed = Vec::new();
            Frame { bytes: &body, ..frame }.write(&mut changed);
            if output.write_all(&changed).is_err() {
                return;
            }
            bytes.drain(..length);
        }
    }
}
