use super::frame::Mark;
use super::reader::LedgerReader;
use super::record::{Chapter, Judged, Record, RoundEnd, SecondChapter, ThirdChapter, is_set};
use super::soundness::{problem_complaint, verdicts_complaint};
use super::stopped::Stopped;
use crate::exit::{Code, Failure};
use crate::output::Plain;
use roadmill::BITS_VERSION;
use roadmill::evaluate::Verdict;
use roadmill::internal::wire;
use roadmill::numbers::RoundNumber;
use roadmill::problem::Problem;
use std::path::{Path, PathBuf};

/// What a ledger comes to, found without looking into its sets: every record's hash is checked, and
/// that rounds follow one another.
#[derive(Clone, Debug)]
pub struct Scan {
    folder: PathBuf,
    /// The chapters in order.
    pub chapters: Vec<Chapter>,
    /// The last round.
    pub last_round: Option<RoundEnd>,
    /// The verdicts on the last round by the last chapter's criteria.
    pub verdicts: Option<Vec<Verdict>>,
    /// The last verdicts on any round.
    pub last_verdicts: Vec<Verdict>,
    /// Why the build stopped; `None` while it runs or where it was killed.
    pub stopped: Option<Stopped>,
    /// Behind the last record that ends something: what follows is part of a round.
    pub end: Mark,
    /// Bytes beyond the end.
    pub torn_bytes: u64,
}

impl Scan {
    /// Reads a run folder's ledger.
    ///
    /// # Errors
    /// Exit code 2 if there is no ledger, 4 if it is damaged or of another format.
    pub fn read(folder: &Path) -> Result<Scan, Failure> {
        let mut scan = Scan {
            folder: folder.to_owned(),
            chapters: Vec::new(),
            last_round: None,
            verdicts: None,
            last_verdicts: Vec::new(),
            stopped: None,
            end: Mark::first(),
            torn_bytes: 0,
        };
        let mut reader = LedgerReader::open(folder)?;
        scan.advance(&mut reader)?;
        if scan.chapters.is_empty() {
            return Err(reader.wrong("the beginning is missing"));
        }
        Ok(scan)
    }

    /// Reads what has been written since.
    ///
    /// # Errors
    /// As [`Scan::read`].
    pub fn read_on(&mut self) -> Result<(), Failure> {
        self.advance(&mut LedgerReader::open_at(&self.folder, self.end)?)
    }

    fn advance(&mut self, reader: &mut LedgerReader) -> Result<(), Failure> {
        let mut sets = 0;
        loop {
            match reader.next_payload()? {
                None => break,
                Some(payload) if is_set(payload) => sets += 1,
                Some(payload) => {
                    let record = wire::decode(payload);
                    let taken = record
                        .map_err(|error| error.to_string())
                        .and_then(|record| self.take(record, std::mem::take(&mut sets)));
                    taken.map_err(|why| reader.wrong(&why))?;
                    self.end = *reader.at();
                }
            }
        }
        self.torn_bytes = reader.length().saturating_sub(self.end.offset);
        Ok(())
    }

    /// Takes in a record that is no set, after `sets` sets.
    fn take(&mut self, record: Record, sets: u64) -> Result<(), String> {
        let is_chapter = matches!(
            record,
            Record::Chapter(_) | Record::SecondChapter(_) | Record::ThirdChapter(_)
        );
        if self.chapters.is_empty() && !is_chapter {
            return Err("the beginning is missing".to_owned());
        }
        if sets > 0 && !matches!(record, Record::RoundEnd(_)) {
            return Err("sets outside of a round".to_owned());
        }
        self.stopped = None;
        match record {
            Record::Chapter(chapter)
            | Record::SecondChapter(SecondChapter(chapter))
            | Record::ThirdChapter(ThirdChapter(chapter))
                if chapter.first_round == self.next_round() =>
            {
                self.chapters.push(*chapter);
                self.verdicts = None;
            }
            Record::RoundEnd(end) if end.round == self.next_round() && sets > 0 => {
                let before = self.last_round.as_ref().map_or(0, |last| last.sets);
                if Some(end.sets) != before.checked_add(sets) {
                    return Err(format!("{} sets found, {sets} in this round", end.sets));
                }
                self.last_round = Some(end);
                self.verdicts = None;
            }
            Record::Judged(Judged { round, verdicts })
                if self.last_round.as_ref().is_some_and(|last| last.round == round) =>
            {
                self.last_verdicts.clone_from(&verdicts);
                self.verdicts = Some(verdicts);
            }
            Record::Stopped(stopped) => self.stopped = Some(stopped),
            Record::Chapter(_)
            | Record::SecondChapter(_)
            | Record::ThirdChapter(_)
            | Record::RoundEnd(_)
            | Record::Judged(_)
            | Record::Set(_)
            | Record::FullSet(_) => {
                return Err("a record out of turn".to_owned());
            }
        }
        Ok(())
    }

    /// The run folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Complete rounds.
    pub fn rounds(&self) -> u64 {
        self.next_round().0
    }

    /// The round after the complete ones.
    pub fn next_round(&self) -> RoundNumber {
        self.last_round.as_ref().map_or(RoundNumber(0), |end| end.round.next())
    }

    /// The chapter that the build is in.
    pub fn chapter(&self) -> &Chapter {
        &self.chapters[self.chapters.len() - 1]
    }

    /// The problem as it is now, all chapters taken together.
    ///
    /// # Errors
    /// Exit code 4: another version of the program wrote it, in another layout.
    pub fn problem(&self) -> Result<Problem, Failure> {
        let problem = self.problem_of(self.chapters.len() - 1)?;
        match verdicts_complaint(&problem.space(), &self.last_verdicts) {
            None => Ok(problem),
            Some(complaint) => {
                let run = self.folder.display();
                let message = format!("{run}: the last judgement has {complaint}");
                Err(Failure::new(Code::BrokenRun, message))
            }
        }
    }

    /// The problem as it was in a chapter.
    ///
    /// # Errors
    /// As [`Scan::problem`].
    pub fn problem_of(&self, chapter: usize) -> Result<Problem, Failure> {
        let chapter = &self.chapters[chapter];
        let unreadable = |why: &str| {
            let (run, known, wrote) =
                (self.folder.display(), env!("CARGO_PKG_VERSION"), Plain(&chapter.program));
            Failure::new(
                Code::BrokenRun,
                format!(
                    "{run}: roadmill {known} cannot read the problem, which roadmill {wrote} wrote: {why}"
                ),
            )
        };
        let problem = chapter.decode().map_err(|error| unreadable(&error.to_string()))?;
        if let Some(complaint) = problem_complaint(chapter, &problem) {
            return Err(unreadable(&complaint));
        }
        // Of other bits the digest may be another.
        if chapter.bits_version == BITS_VERSION && problem.digest() != chapter.problem_digest {
            return Err(unreadable("its digest differs"));
        }
        Ok(problem)
    }
}
