use crate::cli::DiffArguments;
use crate::exit::{Code, Failure};
use crate::output::{Plain, line};
use crate::run::ledger::Chapter;
use crate::run::{Replay, Scan, Told};
use crate::work::difference;
use roadmill::evaluate::Verdict;
use roadmill::img::RoundSet;
use roadmill::numbers::RoundNumber;
use roadmill::problem::Problem;
use roadmill::scene::is_mesh_file;
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;

/// The most keys of the problems that are listed.
const KEYS_SHOWN: usize = 20;

/// Compares two runs.
pub fn diff(arguments: &DiffArguments) -> Result<Code, Failure> {
    let (left, right) = (Read::new(&arguments.left)?, Read::new(&arguments.right)?);
    for reason in reasons(&left.scan.chapters, &right.scan.chapters) {
        line(reason);
    }
    let changed = left.problem.changed_keys(&right.problem);
    for key in changed.iter().take(KEYS_SHOWN) {
        line(key);
    }
    if let Some(more @ 1..) = changed.len().checked_sub(KEYS_SHOWN) {
        line(format_args!("and {more} more keys"));
    }
    let [mut ours, mut theirs] = [Side::new(&left)?, Side::new(&right)?];
    let mut sets = 0u64;
    let differs = |what: String| Err(Failure::new(Code::Differs, what));
    loop {
        match (ours.next()?, theirs.next()?) {
            (None, None) => break,
            (Some((round, a)), Some((_, b))) => {
                let name = |set: &RoundSet, of: &Read| {
                    format!(
                        "{}:{}",
                        of.problem.strategies()[set.strategy.index()].label(),
                        set.ordinal
                    )
                };
                let (a_name, b_name) = (name(&a, &left), name(&b, &right));
                let found = if a_name == b_name {
                    let space = left.problem.space();
                    difference::of_increments(&space, &a.increment, &b.increment)
                        .or_else(|| difference::of_joins(&a.joined, &b.joined))
                } else {
                    Some(format!("it is {a_name} and {b_name}"))
                };
                if let Some(found) = found {
                    return differs(format!(
                        "first difference: set {a_name} (number {}, round {round}): {found}",
                        a.number
                    ));
                }
                sets += 1;
            }
            (one, _) => {
                let (longer, shorter) =
                    if one.is_some() { (&left, &right) } else { (&right, &left) };
                return differs(format!(
                    "the same {sets} sets, then {} ends and {} goes on",
                    shorter.scan.folder().display(),
                    longer.scan.folder().display()
                ));
            }
        }
    }
    for (round, verdicts) in &ours.verdicts {
        let other = theirs.verdicts.get(round);
        if let Some(found) = other.and_then(|other| difference::of_verdicts(verdicts, other)) {
            return differs(format!(
                "the same {sets} sets, but judged otherwise in round {round}: {found}"
            ));
        }
    }
    line(format_args!("the same {sets} sets and judgements"));
    Ok(Code::Done)
}

/// Why two runs may differ.
fn reasons(left: &[Chapter], right: &[Chapter]) -> Vec<String> {
    let mut reasons = Vec::new();
    for (number, (a, b)) in left.iter().zip(right).enumerate() {
        let mut note = |what: &str, a: String, b: String| {
            if a != b {
                let chapter =
                    if number > 0 { format!("chapter {number}: ") } else { String::new() };
                reasons.push(format!("{chapter}{what}: {a} and {b}"));
            }
        };
        note("first round", a.first_round.to_string(), b.first_round.to_string());
        note("seed", a.seed.to_string(), b.seed.to_string());
        note("program version", a.program.clone(), b.program.clone());
        note("version of the bits", a.bits_version.to_string(), b.bits_version.to_string());
        note("problem digest", a.problem_digest.to_string(), b.problem_digest.to_string());
        // The problem's own file may have any name.
        for (index, file) in a.sources.iter().enumerate() {
            let same = |other: &&roadmill::SourceFile| other.path == file.path;
            let is_own = index == 0 && !is_mesh_file(Path::new(&file.path));
            let other = if is_own { b.sources.first() } else { b.sources.iter().find(same) };
            let other = other.map_or("not used".to_owned(), |other| other.digest.to_string());
            note(&format!("file {}", Plain(&file.path)), file.digest.to_string(), other);
        }
    }
    if left.len() != right.len() {
        reasons.push(format!("chapters: {} and {}", left.len(), right.len()));
    }
    reasons
}

struct Read {
    scan: Scan,
    problem: Problem,
}

impl Read {
    fn new(folder: &Path) -> Result<Read, Failure> {
        let scan = Scan::read(folder)?;
        let problem = scan.problem()?;
        Ok(Read { scan, problem })
    }
}

/// One of the two, set by set.
struct Side<'a> {
    replay: Replay<'a>,
    /// Sets of the last round, with its number.
    sets: VecDeque<(RoundNumber, RoundSet)>,
    /// The last verdicts on each round so far.
    verdicts: BTreeMap<RoundNumber, Vec<Verdict>>,
}

impl<'a> Side<'a> {
    fn new(read: &'a Read) -> Result<Side<'a>, Failure> {
        let replay = Replay::new(&read.scan, &read.problem)?;
        Ok(Side { replay, sets: VecDeque::new(), verdicts: BTreeMap::new() })
    }

    fn next(&mut self) -> Result<Option<(RoundNumber, RoundSet)>, Failure> {
        while self.sets.is_empty() {
            match self.replay.read()? {
                None => return Ok(None),
                Some(Told::Judged(judged)) => {
                    self.verdicts.insert(judged.round, judged.verdicts);
                }
                Some(Told::Stopped(_)) => {}
                Some(Told::Round(round, _)) => {
                    self.sets.extend(round.sets.into_iter().map(|set| (round.number, set)));
                }
            }
        }
        Ok(self.sets.pop_front())
    }
}
