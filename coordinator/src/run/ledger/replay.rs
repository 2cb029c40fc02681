use super::reader::LedgerReader;
use super::record::{FullSet, Judged, Record, Set, read_by};
use super::scan::Scan;
use crate::exit::Failure;
use roadmill::img::{Plan, Round, RoundSet};
use roadmill::numbers::{RoundNumber, SetName, SetNumber};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, SetForm, Tally};
use std::sync::Arc;

/// What a ledger tells of a build, in order.
pub enum Told {
    /// A round was folded, and the roadmap then had this digest.
    Round(Round, Digest),
    /// The last round was judged.
    Judged(Judged),
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
    form: SetForm,
    chapters: usize,
    /// Digest and nodes of the roadmap at the start of the round.
    roadmap: Digest,
    folded: u64,
}

impl<'a> Replay<'a> {
    /// Begins at the first round. `problem` is the scan's own.
    ///
    /// # Errors
    /// As [`Scan::read`].
    pub fn new(scan: &'a Scan, problem: &'a Problem) -> Result<Replay<'a>, Failure> {
        let reader = LedgerReader::open(scan.folder())?;
        let plan = Plan::new(problem);
        let roadmap = Tally::new(&problem.space()).digest();
        Ok(Replay {
            reader,
            scan,
            plan,
            problem,
            number: SetNumber(0),
            nodes: 0,
            round: RoundNumber(0),
            form: SetForm::of(problem.model().description()),
            chapters: 0,
            roadmap,
            folded: 0,
        })
    }

    /// The next round or judgement, up to the scan's end.
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
                    (self.roadmap, self.folded) = (end.roadmap, end.nodes);
                    let round = Round { number, sets };
                    self.plan.observe(&round);
                    return Ok(Some(Told::Round(round, end.roadmap)));
                }
                Some(Record::Judged(judged)) => return Ok(Some(Told::Judged(judged))),
                Some(Record::Chapter(_) | Record::SecondChapter(_)) => self.chapters += 1,
                Some(Record::Stopped(_)) => {}
                None => break,
            }
        }
        Ok(None)
    }

    /// Index of the chapter to which belongs what was told last.
    pub fn chapter(&self) -> usize {
        self.chapters.saturating_sub(1)
    }

    /// Checks that the last round has given the roadmap that comes to this.
    ///
    /// # Errors
    /// Exit code 4: it has not.
    pub fn check(&self, tally: &Tally, told: Digest) -> Result<(), Failure> {
        if tally.digest() == told {
            Ok(())
        } else {
            Err(self.reader.wrong("the roadmap's digest differs"))
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
            let found = format!("set {}:{} with number {}", set.label, set.ordinal, set.number);
            let expected = format!("{label}:{ordinal} with number {}", self.number);
            return Err(self.reader.wrong(&format!("{found} found, {expected} expected")));
        }
        let grows = strategy_of.generator().grows();
        if read != read_by(strategy_of.generator(), self.roadmap) {
            return Err(self.reader.wrong("not the roadmap that the set was made from"));
        }
        self.nodes += set.increment.configs.len() as u64;
        let joins = &set.joined.edges;
        let sound = self.nodes < u64::from(u32::MAX)
            && set.increment.is_sound(self.form, if grows { self.folded } else { 0 })
            && joins.iter().all(|edge| {
                edge.low < edge.high
                    && u64::from(edge.high.0) < self.nodes
                    && self.form.has_cost(edge)
            });
        if !sound {
            return Err(self.reader.wrong("a set that cannot be"));
        }
        self.number = set.number.next();
        let Set { number, increment, joined, .. } = set;
        Ok(RoundSet { number, strategy, ordinal, increment, joined })
    }
}
