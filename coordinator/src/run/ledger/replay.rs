use super::reader::LedgerReader;
use super::record::{FullSet, Judged, Record, RoundEnd, Set, read_by};
use super::scan::Scan;
use super::soundness::{SetCheck, verdicts_complaint};
use super::stopped::Stopped;
use crate::exit::Failure;
use crate::output::Plain;
use roadmill::img::{Plan, Round, RoundSet};
use roadmill::numbers::{RoundNumber, SetName, SetNumber};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Tally};
use roadmill::space::Space;
use std::sync::Arc;

/// What a ledger tells of a build, in order.
pub enum Told {
    /// A round was folded, and the roadmap then had this digest.
    Round(Round, Digest),
    /// The last round was judged.
    Judged(Judged),
    /// The build stopped.
    Stopped(Stopped),
}

/// Reads the rounds of a scanned ledger again, with their sets.
pub struct Replay<'a> {
    reader: LedgerReader,
    scan: &'a Scan,
    plan: Plan,
    problem: &'a Problem,
    /// The set that comes next.
    number: SetNumber,
    /// Nodes of the sets before it.
    nodes: u64,
    round: RoundNumber,
    space: Space,
    sound: SetCheck,
    chapters: usize,
    /// So many chapters are read.
    chapters_wanted: usize,
    /// Digest and nodes of the roadmap at the start of the round.
    roadmap: Digest,
    folded: u64,
    /// The end of the last round, as it is recorded.
    end: Option<RoundEnd>,
}

impl<'a> Replay<'a> {
    /// Begins at the first round. `problem` is the scan's own.
    ///
    /// # Errors
    /// As [`Scan::read`].
    pub fn new(scan: &'a Scan, problem: &'a Problem) -> Result<Replay<'a>, Failure> {
        let reader = LedgerReader::open(scan.folder())?;
        let plan = Plan::new(problem);
        let space = problem.space();
        let roadmap = Tally::new(&space).digest();
        Ok(Replay {
            reader,
            scan,
            plan,
            problem,
            number: SetNumber(0),
            nodes: 0,
            round: RoundNumber(0),
            space,
            sound: SetCheck::new(problem),
            chapters: 0,
            chapters_wanted: scan.chapters.len(),
            roadmap,
            folded: 0,
            end: None,
        })
    }

    /// Ends with the last record of the first `chapters` chapters, of the last of which the problem may then be.
    pub fn to_end_of(self, chapters: usize) -> Replay<'a> {
        Replay { chapters_wanted: chapters, ..self }
    }

    /// The next round, judgement or stop, up to the scan's end.
    ///
    /// # Errors
    /// Exit code 4: a record is damaged, or a set that cannot be.
    pub fn read(&mut self) -> Result<Option<Told>, Failure> {
        let mut sets = Vec::new();
        while self.reader.at().offset < self.scan.end.offset {
            match self.reader.next_record()? {
                Some(Record::Set(set)) => sets.push(self.set(set, None)?),
                Some(Record::FullSet(full)) => {
                    let FullSet { number, label, ordinal, read, increment, joined } = full;
                    let (increment, joined) = (Arc::new(increment.0), joined.0);
                    sets.push(self.set(Set { number, label, ordinal, increment, joined }, read)?);
                }
                Some(Record::RoundEnd(end)) => {
                    let end_of_round = self.plan.sets_of(self.round).end;
                    if self.number != end_of_round || end.nodes != self.nodes {
                        return Err(self.reader.wrong("not the sets of its round"));
                    }
                    let number = self.round;
                    self.round = number.next();
                    let roadmap = end.roadmap;
                    (self.roadmap, self.folded) = (roadmap, end.nodes);
                    self.end = Some(end);
                    let round = Round { number, sets };
                    self.plan.observe(&round);
                    return Ok(Some(Told::Round(round, roadmap)));
                }
                Some(Record::Judged(judged)) => {
                    if let Some(complaint) = verdicts_complaint(&self.space, &judged.verdicts) {
                        return Err(self.reader.wrong(complaint));
                    }
                    return Ok(Some(Told::Judged(judged)));
                }
                Some(Record::Chapter(_) | Record::SecondChapter(_) | Record::ThirdChapter(_)) => {
                    if self.chapters == self.chapters_wanted {
                        break;
                    }
                    self.chapters += 1;
                }
                Some(Record::Stopped(stopped)) => return Ok(Some(Told::Stopped(stopped))),
                None => break,
            }
        }
        Ok(None)
    }

    /// Index of the chapter to which belongs what was told last.
    pub fn chapter(&self) -> usize {
        self.chapters.saturating_sub(1)
    }

    /// The end of the last round that was told, as it is recorded; `None` before the first.
    pub fn last_round(&self) -> Option<&RoundEnd> {
        self.end.as_ref()
    }

    /// Checks that the last round has given the roadmap that comes to this, in its digest and its counts.
    ///
    /// # Errors
    /// Exit code 4: it has not.
    pub fn check(&self, tally: &Tally, told: Digest) -> Result<(), Failure> {
        if tally.digest() != told {
            return Err(self.reader.wrong("the roadmap's digest differs"));
        }
        let Some(end) = &self.end else { return Ok(()) };
        let counts = [
            ("sets", end.sets, tally.sets()),
            ("nodes", end.nodes, tally.nodes() as u64),
            ("edges", end.edges, tally.edges() as u64),
            ("components", end.components, tally.components() as u64),
        ];
        match counts.iter().find(|(_, recorded, counted)| recorded != counted) {
            None => Ok(()),
            Some((what, recorded, counted)) => {
                Err(self.reader.wrong(&format!("{recorded} {what} recorded, {counted} counted")))
            }
        }
    }

    /// A set whose folding cannot go out of range, and which is the one that comes here.
    fn set(&mut self, set: Set, read: Option<Digest>) -> Result<RoundSet, Failure> {
        let Some(SetName { strategy, ordinal }) = self.plan.name_of(self.number) else {
            return Err(self.reader.wrong("more sets than its round has"));
        };
        let strategy_of = &self.problem.strategies()[strategy.index()];
        let label = strategy_of.label();
        if (set.number, &*set.label, set.ordinal) != (self.number, label, ordinal) {
            let found_label = Plain(&set.label);
            let found = format!("set {found_label}:{} with number {}", set.ordinal, set.number);
            let expected = format!("{}:{ordinal} with number {}", Plain(label), self.number);
            return Err(self.reader.wrong(&format!("{found} found, {expected} expected")));
        }
        let grows = strategy_of.generator().grows();
        if read != read_by(strategy_of.generator(), self.roadmap) {
            return Err(self.reader.wrong("not the roadmap that the set was made from"));
        }
        let (before, own) = (self.nodes, set.increment.configs.len() as u64);
        let roots = if grows { self.folded } else { 0 };
        let complaint = self.sound.complaint(strategy, &set.increment, roots);
        let complaint = complaint.or_else(|| self.sound.joins_complaint(&set.joined, before, own));
        self.nodes += own;
        if let Some(complaint) = complaint {
            return Err(self.reader.wrong(&format!("a set that cannot be: {complaint}")));
        }
        if self.nodes >= u64::from(u32::MAX) {
            return Err(self.reader.wrong("more nodes than there are ids"));
        }
        self.number = set.number.next();
        let Set { number, increment, joined, .. } = set;
        Ok(RoundSet { number, strategy, ordinal, increment, joined })
    }
}
