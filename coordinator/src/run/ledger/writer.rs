use super::durable::{DURABLE, DurableFile};
use super::frame::{self, HEADING, Mark};
use super::record::{Chapter, Judged, Record, RoundEnd, WrittenFullSet, WrittenSet};
use super::scan::Scan;
use super::stopped::Stopped;
use super::{LEDGER, sync_folder};
use crate::cpu::Meter;
use crate::exit::Failure;
use crate::files::{folder_of, open_in_run};
use crate::run::RunLock;
use roadmill::img::{Judgement, Round};
use roadmill::numbers::RoundNumber;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Tally};
use rustix::fs::OFlags;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rounds that end within this time of one another are made durable together. They are written at
/// once: only the failure of the whole machine can lose them, never that of a process.
const SYNC_PAUSE_MIN: Duration = Duration::from_secs(1);
/// On a slow disk the pause is this many times what a sync takes.
const SYNC_PAUSE_TIMES: u32 = 100;
/// Where a ledger is written before it has its beginning.
pub const BEGUN: &str = "ledger.begun";

/// A ledger being written, by the one process that holds the run.
#[derive(Debug)]
pub struct LedgerWriter {
    path: PathBuf,
    file: File,
    durable: DurableFile,
    lock: RunLock,
    /// Where records are put together.
    bytes: Vec<u8>,
    /// What has been written.
    at: Mark,
    /// What is durable of it.
    durable_offset: u64,
    /// Digest of the roadmap after the last round.
    roadmap: Digest,
    next_sync: Instant,
    spent: Duration,
    cpu: Meter,
}

impl LedgerWriter {
    /// Begins the ledger of a run folder.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn begin(folder: &Path, problem: &Problem, lock: RunLock) -> Result<LedgerWriter, Failure> {
        let begun = folder.join(BEGUN);
        let begin = || -> io::Result<LedgerWriter> {
            let file = open_in_run(&begun, OFlags::WRONLY | OFlags::CREATE | OFlags::TRUNC)?;
            let durable = DurableFile::create(folder)?;
            let roadmap = Tally::new(&problem.space()).digest();
            Ok(LedgerWriter::new(folder, file, durable, lock, Mark::first(), roadmap))
        };
        let mut writer = begin().map_err(|error| cannot_write(&begun, &error))?;
        writer.file.write_all(HEADING).map_err(|error| cannot_write(&begun, &error))?;
        writer.chapter(RoundNumber(0), problem)?;
        // Under its name the ledger has its beginning from the first moment, whatever fails when.
        fs::rename(&begun, &writer.path)
            .and_then(|()| sync_folder(folder))
            .and_then(|()| sync_folder(folder.parent().unwrap_or(folder)))
            .map_err(|error| cannot_write(&writer.path, &error))?;
        Ok(writer)
    }

    /// The run folder has been moved here, with the ledger and the lock in it. That the system may forget after
    /// a failure of the machine: then both runs are where they were.
    pub(in crate::run) fn moved(&mut self, folder: &Path) {
        self.path = folder.join(LEDGER);
        self.lock.moved(folder);
        let _ = sync_folder(folder_of(folder));
    }

    /// Goes on with the ledger that was scanned; a torn tail is saved beside it and cut. The name of
    /// what was saved, if anything was.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn resume(
        scan: &Scan,
        problem: &Problem,
        lock: RunLock,
    ) -> Result<(LedgerWriter, Option<PathBuf>), Failure> {
        let folder = scan.folder();
        let path = folder.join(LEDGER);
        let open = || -> io::Result<(LedgerWriter, Option<PathBuf>)> {
            let mut file = open_in_run(&path, OFlags::RDWR)?;
            let saved = cut_tail(folder, &mut file, scan.end.offset)?;
            let durable = DurableFile::open(folder)?;
            let empty = || Tally::new(&problem.space()).digest();
            let roadmap = scan.last_round.as_ref().map_or_else(empty, |end| end.roadmap);
            Ok((LedgerWriter::new(folder, file, durable, lock, scan.end, roadmap), saved))
        };
        let (mut writer, saved) = open().map_err(|error| cannot_write(&path, &error))?;
        writer.sync_all()?;
        Ok((writer, saved))
    }

    fn new(
        folder: &Path,
        file: File,
        durable: DurableFile,
        lock: RunLock,
        at: Mark,
        roadmap: Digest,
    ) -> Self {
        let path = folder.join(LEDGER);
        let (next_sync, spent, cpu) = (Instant::now(), Duration::ZERO, Meter::default());
        let (bytes, durable_offset) = (Vec::new(), 0);
        LedgerWriter {
            path,
            file,
            durable,
            lock,
            bytes,
            at,
            durable_offset,
            roadmap,
            next_sync,
            spent,
            cpu,
        }
    }

    /// Appends the beginning of a chapter and makes it durable.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn chapter(&mut self, first_round: RoundNumber, problem: &Problem) -> Result<(), Failure> {
        let chapter = Chapter::new(first_round, problem);
        self.append_one(&chapter.into_record())?;
        self.sync_all()
    }

    /// Appends a folded round; `tally` includes it.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn round(
        &mut self,
        round: &Round,
        problem: &Problem,
        tally: &Tally,
    ) -> Result<(), Failure> {
        let end = RoundEnd {
            round: round.number,
            sets: tally.sets(),
            nodes: tally.nodes() as u64,
            edges: tally.edges() as u64,
            components: tally.components() as u64,
            roadmap: tally.digest(),
        };
        let before = std::mem::replace(&mut self.roadmap, end.roadmap);
        self.append(|bytes, mut at| {
            for set in &round.sets {
                at = match WrittenFullSet::new(set, problem, before) {
                    Some(full) => frame::append(bytes, &at, &full),
                    None => frame::append(bytes, &at, &WrittenSet::new(set, problem)),
                };
            }
            frame::append(bytes, &at, &Record::RoundEnd(end))
        })?;
        self.sync_if_due()
    }

    /// Appends what the evaluators said.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        let verdicts = judgement.verdicts.clone();
        self.append_one(&Record::Judged(Judged { round: judgement.round, verdicts }))?;
        self.sync_if_due()
    }

    /// Appends why the build stopped and makes all durable.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn stopped(&mut self, stopped: &Stopped) -> Result<(), Failure> {
        self.append_one(&Record::Stopped(stopped.clone()))?;
        self.sync_all()
    }

    /// Makes durable what is not, if it is time; shows that the run is held.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written, or another process has taken the run over.
    pub fn sync_if_due(&mut self) -> Result<(), Failure> {
        self.lock.beat()?;
        if self.durable_offset < self.at.offset && Instant::now() >= self.next_sync {
            self.sync()?;
        }
        Ok(())
    }

    /// Seconds that went into the ledger: encoding, hashing, writing and syncing.
    pub fn seconds(&self) -> f64 {
        self.spent.as_secs_f64()
    }

    /// CPU seconds of these.
    pub fn cpu_seconds(&self) -> f64 {
        self.cpu.seconds()
    }

    fn append_one(&mut self, record: &Record) -> Result<(), Failure> {
        self.append(|bytes, at| frame::append(bytes, &at, record))
    }

    /// Writes records, all of them or, where that fails, a part that no reader takes for whole.
    fn append(&mut self, records: impl FnOnce(&mut Vec<u8>, Mark) -> Mark) -> Result<(), Failure> {
        let (begun, cpu) = (Instant::now(), Meter::begin());
        self.lock.beat()?;
        let mut bytes = std::mem::take(&mut self.bytes);
        bytes.clear();
        let at = records(&mut bytes, self.at);
        let written = self.file.write_all(&bytes);
        self.bytes = bytes;
        written.map_err(|error| cannot_write(&self.path, &error))?;
        self.at = at;
        self.spent += begun.elapsed();
        self.cpu.end(cpu);
        Ok(())
    }

    /// Makes all that was written durable, then says so in the side file. `fdatasync` suffices: it
    /// writes the data and what is needed to read them again, the file's length included, and leaves
    /// only times for later.
    fn sync(&mut self) -> Result<(), Failure> {
        let (begun, cpu) = (Instant::now(), Meter::begin());
        self.file.sync_data().map_err(|error| cannot_write(&self.path, &error))?;
        self.durable.set(&self.at).map_err(|error| self.cannot_mark(&error))?;
        self.durable_offset = self.at.offset;
        let took = begun.elapsed();
        self.spent += took;
        self.cpu.end(cpu);
        self.next_sync = Instant::now() + SYNC_PAUSE_MIN.max(took * SYNC_PAUSE_TIMES);
        Ok(())
    }

    /// The same, and makes the mark durable too. Between times the mark may lag: it costs another sync.
    fn sync_all(&mut self) -> Result<(), Failure> {
        self.sync()?;
        let begun = Instant::now();
        self.durable.sync().map_err(|error| self.cannot_mark(&error))?;
        self.spent += begun.elapsed();
        Ok(())
    }

    fn cannot_mark(&self, error: &io::Error) -> Failure {
        cannot_write(&self.path.with_file_name(DURABLE), error)
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::system(format!("{}: cannot write the ledger: {error}", path.display()))
}

/// Moves what stands behind `end` into a new file `ledger.torn-N`; its name, if there was anything.
fn cut_tail(folder: &Path, file: &mut File, end: u64) -> io::Result<Option<PathBuf>> {
    let torn = file.metadata()?.len() > end;
    file.seek(SeekFrom::Start(end))?;
    if !torn {
        return Ok(None);
    }
    let mut number = 1u64;
    let (mut beside, path) = loop {
        let path = folder.join(format!("{LEDGER}.torn-{number}"));
        match File::create_new(&path) {
            Ok(beside) => break (beside, path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
            Err(error) => return Err(error),
        }
    };
    let saved = io::copy(file, &mut beside).and_then(|_| beside.sync_data());
    if let Err(error) = saved.and_then(|()| sync_folder(folder)) {
        // The tail still stands where it was.
        let _ = fs::remove_file(&path);
        return Err(error);
    }
    file.set_len(end)?;
    file.seek(SeekFrom::Start(end))?;
    Ok(Some(path))
}
