use super::LEDGER;
use super::durable;
use super::frame::{Fault, Frames, HEADING, Mark};
use super::levels::levels_in;
use super::record::Record;
use crate::exit::{Code, Failure};
use crate::files::open_in_run;
use roadmill::internal::wire;
use rustix::fs::OFlags;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

const BUFFER_BYTES: usize = 1 << 20;

/// Reads a ledger record by record, and checks each. Damage before the durable mark is an error; what
/// cannot be read beyond it was being written when the build was killed, and is the end.
#[derive(Debug)]
pub struct LedgerReader {
    path: PathBuf,
    frames: Frames<BufReader<File>>,
    /// Without a mark that can be read all bytes count as durable.
    durable: Option<Mark>,
    durable_offset: u64,
    /// Bytes in the file when it was opened.
    length: u64,
}

/// What is said where there is no ledger: of the folder of a relaxation which folders in it have one.
fn no_run(folder: &Path, path: &Path, error: &std::io::Error) -> Failure {
    let of_levels = levels_in(folder).map(|levels| levels.last().cloned());
    Failure::usage(match of_levels {
        None => format!("{}: no run here: {error}", path.display()),
        Some(None) => format!(
            "{}: a relaxation found, of which no level has begun; a run expected",
            folder.display()
        ),
        Some(Some(last)) => format!(
            "{}: a relaxation found; the run of one of its levels expected, as {}",
            folder.display(),
            folder.join(last).display()
        ),
    })
}

impl LedgerReader {
    /// Opens the ledger of a run folder.
    ///
    /// # Errors
    /// Exit code 2 if there is none, 4 if it is none of this format.
    pub fn open(folder: &Path) -> Result<LedgerReader, Failure> {
        let path = folder.join(LEDGER);
        // Before the ledger, which may be growing.
        let durable = durable::read(folder);
        let no_run = |error| no_run(folder, &path, &error);
        let file = open_in_run(&path, OFlags::RDONLY).map_err(no_run)?;
        let length = file.metadata().map_err(no_run)?.len();
        let mut source = BufReader::with_capacity(BUFFER_BYTES, file);
        let mut heading = [0; HEADING.len()];
        let is_whole = source.read_exact(&mut heading).is_ok();
        let frames = Frames::new(source, Mark::first());
        let durable_offset = durable.map_or(length, |mark| mark.offset);
        let reader = LedgerReader { path, frames, durable, durable_offset, length };
        let (name, version) = heading.split_at(HEADING.len() - 1);
        if !is_whole || !HEADING.starts_with(name) {
            return Err(broken(&reader.path, 0, "at byte 0: not a ledger of roadmill"));
        }
        if heading != *HEADING {
            let (found, known) = (version[0], HEADING[HEADING.len() - 1]);
            let message = format!(
                "at byte 0: a ledger of format {found}; this roadmill {} knows format {known}{}",
                env!("CARGO_PKG_VERSION"),
                if found > known { ", a newer one is needed" } else { "" }
            );
            return Err(broken(&reader.path, 0, &message));
        }
        Ok(reader)
    }

    /// Reads on from a place that an earlier reader has reached.
    ///
    /// # Errors
    /// As [`LedgerReader::open`].
    pub fn open_at(folder: &Path, at: Mark) -> Result<LedgerReader, Failure> {
        let mut reader = LedgerReader::open(folder)?;
        let file = open_in_run(&reader.path, OFlags::RDONLY).and_then(|mut file| {
            file.seek(SeekFrom::Start(at.offset))?;
            Ok(file)
        });
        let file = file.map_err(|error| reader.broken(&error.to_string()))?;
        reader.frames = Frames::new(BufReader::with_capacity(BUFFER_BYTES, file), at);
        Ok(reader)
    }

    /// The place behind the last record that was read.
    pub fn at(&self) -> &Mark {
        self.frames.at()
    }

    /// Bytes in the file when it was opened.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// The next record's payload; `None` at the end.
    ///
    /// # Errors
    /// Exit code 4: the record, or one before it, is damaged; 1: the file cannot be read.
    pub fn next_payload(&mut self) -> Result<Option<&[u8]>, Failure> {
        let at = *self.frames.at();
        let is_durable = at.offset < self.durable_offset;
        if let Some(durable) = &self.durable
            && (at.offset == durable.offset && at != *durable)
        {
            return Err(self.broken("not the ledger that was made durable up to here"));
        }
        let fault = match self.frames.next() {
            Err(fault) => fault,
            Ok(_) if is_durable && self.frames.at().offset > self.durable_offset => {
                return Err(self.broken("the durable mark lies within the record before"));
            }
            Ok(_) => return Ok(Some(self.frames.payload())),
        };
        let message = match fault {
            Fault::Unreadable(error) if error.kind() != ErrorKind::UnexpectedEof => {
                let path = self.path.display();
                return Err(Failure::system(format!("{path}: cannot read the ledger: {error}")));
            }
            _ if !is_durable => return Ok(None),
            Fault::End | Fault::CutOff | Fault::Unreadable(_) => {
                let missing = self.durable_offset.saturating_sub(self.length);
                format!("cut off, {missing} of {} durable bytes are missing", self.durable_offset)
            }
            Fault::Damaged(why) => why.to_owned(),
        };
        Err(self.broken(&message))
    }

    /// The next record; `None` at the end.
    ///
    /// # Errors
    /// As [`LedgerReader::next_payload`].
    pub fn next_record(&mut self) -> Result<Option<Record>, Failure> {
        let Some(payload) = self.next_payload()? else { return Ok(None) };
        match wire::decode(payload) {
            Ok(record) => Ok(Some(record)),
            Err(error) => Err(self.wrong(&error.to_string())),
        }
    }

    /// The next record is damaged, or cannot be read.
    fn broken(&self, message: &str) -> Failure {
        let Mark { records, offset, .. } = self.frames.at();
        broken(&self.path, *records, &format!("at byte {offset}: {message}"))
    }

    /// The last record that was read is whole but makes no sense.
    pub fn wrong(&self, message: &str) -> Failure {
        let Mark { records, offset, .. } = self.frames.at();
        let place = format!("at byte {}", offset - self.frames.last_bytes());
        broken(&self.path, records.saturating_sub(1), &format!("{place}: {message}"))
    }
}

fn broken(path: &Path, record: u64, message: &str) -> Failure {
    Failure::new(Code::BrokenRun, format!("{}: record {record} {message}", path.display()))
}
