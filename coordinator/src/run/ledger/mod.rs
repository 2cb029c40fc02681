//! The ledger: an append-only file of records from which a build can be read again, continued and
//! verified. `docs/ledger.md` describes its bytes and what is promised of them.

mod durable;
pub(in crate::run) mod frame;
mod levels;
mod parents;
mod reader;
mod record;
mod replay;
mod scan;
pub(super) mod soundness;
mod stopped;
mod writer;

pub use durable::{DURABLE, DurableFile};
pub use frame::{HEADING, Mark, is_ledger};
pub use levels::{LEVEL, RELAXATION_JSON, levels_in};
pub use parents::Ledgers;
pub use reader::LedgerReader;
pub use record::{Chapter, FullSet, Judged, Record, RoundEnd, SecondChapter, Set, ThirdChapter};
pub use replay::{Replay, Told};
pub use scan::Scan;
pub use stopped::{Stopped, name as job_name};
pub use writer::{BEGUN, LedgerWriter};

use crate::exit::Failure;
use roadmill::evaluate::Verdict;
use roadmill::export::{RoundOutcome, RoundValue};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Roadmap};
use std::fs::File;
use std::path::Path;

/// The file that makes a folder a run folder.
pub const LEDGER: &str = "ledger";

/// A ledger read back.
#[derive(Debug)]
pub struct Ledger {
    /// The hash of the ledger up to the last complete round.
    pub hash: Digest,
    /// The problem, all chapters taken together.
    pub problem: Problem,
    /// The roadmap of the complete rounds.
    pub roadmap: Roadmap,
    /// The path that the last judgement found.
    pub path: Option<roadmill::query::Path>,
    /// Why the build stopped; `None` while it runs or where it was killed.
    pub stopped: Option<Stopped>,
    /// What the build came to at the end of every complete round.
    pub rounds: Vec<RoundOutcome>,
    /// The version of the program that wrote the last chapter, and of its bits.
    pub program: (String, u32),
}

impl Ledger {
    /// Reads a run folder's ledger up to the last complete round, and checks every record and
    /// the roadmap's digest after every round.
    ///
    /// # Errors
    /// Exit code 2 if there is no ledger, 4 if it is damaged or of another format.
    pub fn read(folder: &Path) -> Result<Ledger, Failure> {
        Ledger::of(Scan::read(folder)?)
    }

    /// Reads what was scanned, as [`Ledger::read`] does.
    ///
    /// # Errors
    /// Exit code 4 if it is damaged.
    pub fn of(scan: Scan) -> Result<Ledger, Failure> {
        let problem = scan.problem()?;
        let space = problem.space();
        let mut roadmap = Roadmap::new(&space);
        let mut replay = Replay::new(&scan, &problem)?;
        let mut rounds = Vec::new();
        // The problem of the chapter that the rounds are in, by whose criteria they were judged. What cannot be read of
        // an earlier chapter leaves its rounds without names of their verdicts, so without these.
        let mut criteria: Option<(usize, Option<Problem>)> = None;
        while let Some(told) = replay.read()? {
            match told {
                Told::Round(round, digest) => {
                    roadmap.fold_round(&space, round.parts());
                    replay.check(roadmap.tally(), digest)?;
                    let tally = roadmap.tally();
                    let (nodes, components) = (tally.nodes() as u64, tally.components() as u64);
                    rounds.push(RoundOutcome {
                        nodes,
                        components,
                        numbers: Vec::new(),
                        satisfied: Vec::new(),
                    });
                }
                Told::Judged(Judged { verdicts, .. }) => {
                    let chapter = replay.chapter();
                    if criteria.as_ref().is_none_or(|(of, _)| *of != chapter) {
                        criteria = Some((chapter, scan.problem_of(chapter).ok()));
                    }
                    if let (Some(last), Some((_, Some(problem)))) = (rounds.last_mut(), &criteria) {
                        last.satisfied = verdicts.iter().map(|verdict| verdict.satisfied).collect();
                        last.numbers = RoundValue::of(problem.evaluators(), &verdicts);
                    }
                }
                Told::Stopped(_) => (),
            }
        }
        let answers = scan.last_verdicts.iter().filter_map(Verdict::answer);
        let path = answers.filter_map(|answer| answer.path.clone()).next();
        let program = (scan.chapter().program.clone(), scan.chapter().bits_version);
        let hash = scan.end.chain;
        Ok(Ledger { hash, problem, roadmap, path, stopped: scan.stopped, rounds, program })
    }
}

/// Makes names in a folder durable.
pub(in crate::run) fn sync_folder(folder: &Path) -> std::io::Result<()> {
    // A relative path of one name has an empty parent.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    File::open(folder)?.sync_all()
}
