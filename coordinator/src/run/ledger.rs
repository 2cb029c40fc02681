//! The ledger: an append-only file of records from which a build can be read again.
//!
//! After 16 bytes of heading each record is `length u64 LE ‖ the first 8 bytes of the BLAKE3 of these
//! 8 ‖ BLAKE3 of the payload ‖ payload`; the payload is a [`Record`] by [`roadmill::wire`]. The length
//! has a checksum of its own, or a damaged one would pass for a record that was being written when
//! the build was killed, and all that follows would be lost in silence. `docs/architecture.md` says what is promised.

use super::folder::LEDGER;
use crate::exit::{Code, Failure};
use bincode::{Decode, Encode};
use roadmill::BITS_VERSION;
use roadmill::evaluate::Verdict;
use roadmill::img::{Cut, Job, Joined, Judgement, Round, Stop};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Increment, Roadmap};
use roadmill::wire;
use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes of a record before its payload.
const HEAD_BYTES: usize = 8 + 8 + 32;
const HEADING: &[u8; 16] = b"roadmill ledger\x01";
/// A record longer than this is damage: what one message can carry, and a round of them.
const RECORD_BYTES_MAX: u64 = 1 << 30;

#[derive(Debug, Encode, Decode)]
enum Record {
    Begin { program: String, bits_version: u32, problem: Box<Problem> },
    Set { place: u64, strategy: u32, ordinal: u64, increment: Arc<Increment>, joined: Joined },
    RoundEnd { round: u64, roadmap: Digest },
    Judged { round: u64, verdicts: Vec<Verdict> },
    Stopped(Stopped),
}

/// How a build ended, as the ledger keeps it.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Stopped {
    /// One word for programs: `satisfied`, `node-limit`, …
    pub word: String,
    /// The same for people.
    pub reason: String,
}

impl Stopped {
    /// Puts a stop into words; `labels` are those of the problem's strategies.
    pub fn new(stop: &Stop, problem: &Problem) -> Stopped {
        let label = |strategy: u32| &problem.strategies[strategy as usize].label;
        let (word, reason) = match stop {
            Stop::Satisfied => ("satisfied", "all criteria are met".to_owned()),
            Stop::NodeLimit => {
                ("node-limit", format!("the limit of {} nodes is reached", problem.limits.nodes))
            }
            Stop::SetLimit => {
                ("set-limit", format!("the limit of {} sets is reached", problem.limits.sets))
            }
            Stop::GaveUp { strategy, ordinal, gave_up } => {
                ("gave-up", format!("set {}:{ordinal}: {gave_up}", label(*strategy)))
            }
            Stop::Deadly(job) => {
                ("deadly-job", format!("{} killed its workers", name(*job, problem)))
            }
            Stop::Contradiction(job) => {
                ("contradiction", format!("{} gave two different outcomes", name(*job, problem)))
            }
            Stop::Nonsense(job) => {
                ("nonsense", format!("{} gave an outcome that it cannot have", name(*job, problem)))
            }
            Stop::Cut(Cut::Time) => ("time-limit", "the limit of time is reached".to_owned()),
            Stop::Cut(Cut::Interrupted) => ("interrupted", "a signal came".to_owned()),
            Stop::Cut(Cut::WorkersLost(why)) => ("workers-lost", why.clone()),
        };
        Stopped { word: word.to_owned(), reason }
    }
}

/// A job as people name it: by its set's label and ordinal.
fn name(job: Job, problem: &Problem) -> String {
    let set = |place: u64| {
        let (strategy, ordinal) = roadmill::img::Plan::new(problem).set_at(place);
        format!("{}:{ordinal}", problem.strategies[strategy as usize].label)
    };
    match job {
        Job::Generate { place } => format!("generating set {}", set(place)),
        Job::Join { place } => format!("joining set {}", set(place)),
        Job::Evaluate { round, evaluator } => {
            let evaluator = problem.evaluators[evaluator as usize].method().name();
            format!("the {evaluator} evaluation after round {round}")
        }
    }
}

/// A ledger being written.
pub struct LedgerWriter {
    path: PathBuf,
    file: File,
}

impl LedgerWriter {
    /// Begins the ledger of a run folder.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn begin(folder: &Path, problem: &Problem) -> Result<LedgerWriter, Failure> {
        let path = folder.join(LEDGER);
        let file = File::options().write(true).create_new(true).open(&path);
        let file = file.map_err(|error| cannot_write(&path, &error))?;
        let mut writer = LedgerWriter { path, file };
        let begin = Record::Begin {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            bits_version: BITS_VERSION,
            problem: Box::new(problem.clone()),
        };
        let mut bytes = HEADING.to_vec();
        frame(&mut bytes, &begin);
        writer.write(&bytes)?;
        Ok(writer)
    }

    /// Appends a folded round.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn round(&mut self, round: &Round, roadmap: Digest) -> Result<(), Failure> {
        let mut bytes = Vec::new();
        for set in &round.sets {
            let record = Record::Set {
                place: set.place,
                strategy: set.strategy,
                ordinal: set.ordinal,
                increment: set.increment.clone(),
                joined: set.joined.clone(),
            };
            frame(&mut bytes, &record);
        }
        frame(&mut bytes, &Record::RoundEnd { round: round.index, roadmap });
        self.write(&bytes)
    }

    /// Appends what the evaluators said.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        let verdicts = judgement.verdicts.clone();
        let mut bytes = Vec::new();
        frame(&mut bytes, &Record::Judged { round: judgement.round, verdicts });
        self.write(&bytes)
    }

    /// Appends why the build stopped and makes the file durable.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn stopped(&mut self, stopped: &Stopped) -> Result<(), Failure> {
        let mut bytes = Vec::new();
        frame(&mut bytes, &Record::Stopped(stopped.clone()));
        self.write(&bytes)?;
        self.file.sync_all().map_err(|error| cannot_write(&self.path, &error))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.file.write_all(bytes).map_err(|error| cannot_write(&self.path, &error))
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::system(format!("{}: cannot write the ledger: {error}", path.display()))
}

fn frame(bytes: &mut Vec<u8>, record: &Record) {
    let payload = wire::encode(record);
    let length = (payload.len() as u64).to_le_bytes();
    bytes.extend(length);
    bytes.extend(length_check(&length));
    bytes.extend(Digest::of(&payload).0);
    bytes.extend(payload);
}

fn length_check(length: &[u8]) -> [u8; 8] {
    let [a, b, c, d, e, f, g, h, ..] = Digest::of(length).0;
    [a, b, c, d, e, f, g, h]
}

/// A ledger read back.
#[derive(Debug)]
pub struct Ledger {
    /// The problem as it was resolved when the build began.
    pub problem: Problem,
    /// The roadmap of the complete rounds.
    pub roadmap: Roadmap,
    /// The path that the last judgement found.
    pub path: Option<roadmill::query::Path>,
    /// Why the build stopped; `None` while it runs or where it was killed.
    pub stopped: Option<Stopped>,
}

impl Ledger {
    /// Reads a run folder's ledger up to the last complete round, and checks every record and
    /// the roadmap's digest after every round.
    ///
    /// # Errors
    /// Exit code 2 if there is no ledger, 4 if it is damaged or of another version.
    pub fn read(folder: &Path) -> Result<Ledger, Failure> {
        let path = folder.join(LEDGER);
        let mut bytes = Vec::new();
        File::open(&path)
            .and_then(|mut file| file.read_to_end(&mut bytes))
            .map_err(|error| Failure::usage(format!("{}: no run here: {error}", path.display())))?;
        let mut reader = Reader { path: &path, bytes: &bytes, at: HEADING.len(), number: 0 };
        if bytes.get(..HEADING.len()) != Some(HEADING) {
            return Err(reader.broken("not a ledger of this version of roadmill"));
        }
        let Some(Record::Begin { bits_version, problem, .. }) = reader.next()? else {
            return Err(reader.broken("the problem is missing"));
        };
        if bits_version != BITS_VERSION {
            let message = format!("bits of version {bits_version}, {BITS_VERSION} expected");
            return Err(reader.broken(&message));
        }
        let space = problem.space();
        let mut roadmap = Roadmap::new(&space);
        let mut sets: Vec<(Arc<Increment>, Joined)> = Vec::new();
        let (mut path, mut stopped) = (None, None);
        while let Some(record) = reader.next()? {
            match record {
                Record::Begin { .. } => return Err(reader.broken("a second beginning")),
                Record::Set { increment, joined, .. } => sets.push((increment, joined)),
                Record::RoundEnd { roadmap: digest, .. } => {
                    if !sound(&problem, &roadmap, &sets) {
                        return Err(reader.broken("a set that cannot be"));
                    }
                    let round =
                        sets.iter().map(|(increment, joined)| (&**increment, &joined.edges[..]));
                    roadmap.fold_round(&space, round);
                    sets.clear();
                    if roadmap.digest() != digest {
                        return Err(reader.broken("the roadmap's digest differs"));
                    }
                }
                Record::Judged { verdicts, .. } => {
                    let answers = verdicts.iter().filter_map(Verdict::answer);
                    path = answers.filter_map(|answer| answer.path.clone()).next();
                }
                Record::Stopped(stop) => stopped = Some(stop),
            }
        }
        Ok(Ledger { problem: *problem, roadmap, path, stopped })
    }
}

/// Whether folding the sets cannot go out of range.
fn sound(problem: &Problem, roadmap: &Roadmap, sets: &[(Arc<Increment>, Joined)]) -> bool {
    let dofs = problem.space().len();
    let nodes: usize = sets.iter().map(|(increment, _)| increment.configs.len()).sum();
    let nodes = (roadmap.configs().len() + nodes) as u64;
    sets.iter().all(|(increment, joined)| {
        increment.is_sound(dofs)
            && joined.edges.iter().all(|e| e.low < e.high && u64::from(e.high) < nodes)
    })
}

struct Reader<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
    number: u64,
}

impl Reader<'_> {
    /// The next record; `None` at the end, also where the last one is cut off.
    fn next(&mut self) -> Result<Option<Record>, Failure> {
        let rest = &self.bytes[self.at..];
        let Some((head, rest)) = rest.split_at_checked(HEAD_BYTES) else { return Ok(None) };
        let (length, head) = head.split_at(8);
        let (check, digest) = head.split_at(8);
        if check != length_check(length) {
            return Err(self.broken("the checksum of its length differs"));
        }
        let length = u64::from_le_bytes(length.try_into().unwrap_or_default());
        if length > RECORD_BYTES_MAX {
            return Err(self.broken("a length beyond any record's"));
        }
        let Some(payload) = rest.get(..length as usize) else {
            return Ok(None);
        };
        if Digest::of(payload).0 != digest {
            return Err(self.broken("the checksum differs"));
        }
        let record = wire::decode(payload).map_err(|error| self.broken(&error.to_string()))?;
        self.at += HEAD_BYTES + payload.len();
        self.number += 1;
        Ok(Some(record))
    }

    fn broken(&self, message: &str) -> Failure {
        let place = format!("record {} at byte {}", self.number, self.at);
        Failure::new(Code::BrokenRun, format!("{}: {place}: {message}", self.path.display()))
    }
}
