//! Files of sets: increments that were generated apart from a build, for a build to take in.
//! `docs/ledger.md` describes their bytes, which are framed and chained as a ledger's.

use super::ledger::frame::{self, Fault, Frames, Mark};
use super::ledger::soundness::SetCheck;
use super::ledger::sync_folder;
use crate::exit::{Code, Failure};
use crate::files::{beside, cannot_write, folder_of, open_regular};
use bincode::{Decode, Encode};
use roadmill::BITS_VERSION;
use roadmill::img::Outcome;
use roadmill::internal::wire;
use roadmill::numbers::{Ordinal, SetName, StrategyIndex};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Full, Increment};
use roadmill::sampler::GaveUp;
use rustix::fs::OFlags;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::ops::Range;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Name and, as the last byte, version of the format.
const HEADING: &[u8; 16] = b"roadmill sets  \x01";

/// A record.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
enum Record {
    Beginning(Beginning),
    Set(Set),
    End(End),
    FullSet(FullSet),
}

/// What a file holds, and what it was made from.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
struct Beginning {
    program: String,
    bits_version: u32,
    problem_digest: Digest,
    label: String,
    /// Ordinals, the end excluded.
    first: Ordinal,
    end: Ordinal,
}

#[derive(Clone, Debug, PartialEq, Encode, Decode)]
struct Set {
    ordinal: Ordinal,
    made: Result<Increment, GaveUp>,
}

/// A set that a [`Set`] cannot say.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
struct FullSet {
    ordinal: Ordinal,
    made: Full<Increment>,
}

#[derive(Clone, Debug, PartialEq, Encode, Decode)]
struct End {
    sets: u64,
}

/// A file being written, which has its name once it is whole.
#[derive(Debug)]
pub struct SetsWriter {
    path: PathBuf,
    force: bool,
    file: BufWriter<NamedTempFile>,
    at: Mark,
    sets: u64,
}

impl SetsWriter {
    /// Begins a file of these ordinals of a strategy. With `force` it replaces another at its end.
    ///
    /// # Errors
    /// Exit code 2: the file exists, or cannot be made; 1: it cannot be written.
    pub fn begin(
        path: &Path,
        force: bool,
        problem: &Problem,
        label: &str,
        ordinals: Range<Ordinal>,
    ) -> Result<SetsWriter, Failure> {
        if !force && path.symlink_metadata().is_ok() {
            return Err(exists(path));
        }
        let file = beside(path).map_err(|error| cannot_write(path, &error))?;
        let mut writer = SetsWriter {
            path: path.to_owned(),
            force,
            file: BufWriter::new(file),
            at: Mark::behind_heading(HEADING),
            sets: 0,
        };
        writer.file.write_all(HEADING).map_err(|error| writer.cannot(&error))?;
        writer.append(&Record::Beginning(Beginning {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            bits_version: BITS_VERSION,
            problem_digest: problem.digest(),
            label: label.to_owned(),
            first: ordinals.start,
            end: ordinals.end,
        }))?;
        Ok(writer)
    }

    /// Appends the next set.
    ///
    /// # Errors
    /// Exit code 1: the file cannot be written.
    pub fn set(
        &mut self,
        ordinal: Ordinal,
        made: Result<Increment, GaveUp>,
    ) -> Result<(), Failure> {
        self.sets += 1;
        self.append(&match made {
            Ok(made) if !made.is_plain() => Record::FullSet(FullSet { ordinal, made: Full(made) }),
            made => Record::Set(Set { ordinal, made }),
        })
    }

    /// Ends the file, makes it durable and gives it its name.
    ///
    /// # Errors
    /// Exit code 2: the file exists by now; 1: it cannot be written.
    pub fn end(mut self) -> Result<(), Failure> {
        self.append(&Record::End(End { sets: self.sets }))?;
        let cannot = |error: io::Error| cannot_write(&self.path, &error);
        let file = self.file.into_inner().map_err(|error| cannot(error.into_error()))?;
        file.as_file().sync_all().map_err(cannot)?;
        if self.force {
            file.persist(&self.path).map_err(|error| cannot(error.error))?;
        } else if let Err(error) = file.persist_noclobber(&self.path) {
            return Err(match error.error.kind() {
                io::ErrorKind::AlreadyExists => exists(&self.path),
                _ => cannot(error.error),
            });
        }
        sync_folder(folder_of(&self.path)).map_err(cannot)
    }

    fn append(&mut self, record: &Record) -> Result<(), Failure> {
        let mut bytes = Vec::new();
        self.at = frame::append(&mut bytes, &self.at, record);
        self.file.write_all(&bytes).map_err(|error| self.cannot(&error))
    }

    fn cannot(&self, error: &io::Error) -> Failure {
        cannot_write(&self.path, error)
    }
}

fn exists(path: &Path) -> Failure {
    let path = path.display();
    Failure::usage(format!("{path}: exists already; a new file expected, or --force to replace it"))
}

/// Where a set is.
#[derive(Clone, Copy, Debug)]
struct SetLocation {
    file: usize,
    /// Of the payload.
    offset: u64,
    length: u64,
    hash: Digest,
}

/// The sets of any number of files, each read when it is asked for: in memory is only where they are,
/// less than 100 bytes of each.
#[derive(Debug, Default)]
pub struct SetFiles {
    paths: Vec<PathBuf>,
    locations: BTreeMap<SetName, SetLocation>,
}

impl SetFiles {
    /// Looks through the files that these paths and patterns name; every record is checked.
    ///
    /// # Errors
    /// Exit code 2: no file, one of another problem, version or label, or two that differ in a set;
    /// 4: one that is damaged.
    pub fn open(names: &[String], problem: &Problem) -> Result<SetFiles, Failure> {
        let mut files = SetFiles::default();
        let sound = SetCheck::new(problem);
        for name in names {
            for path in expand(name)? {
                files.look_through(path, problem, &sound)?;
            }
        }
        Ok(files)
    }

    /// Sets in the files.
    pub fn count(&self) -> usize {
        self.locations.len()
    }

    /// Whether a set is in the files.
    pub fn has(&self, set: SetName) -> bool {
        self.locations.contains_key(&set)
    }

    /// What generating the set came to, if it is in the files.
    ///
    /// # Errors
    /// Exit code 1: the file can no longer be read; 4: it is no longer what it was.
    pub fn read(&self, set: SetName) -> Result<Option<Outcome>, Failure> {
        let SetName { ordinal, .. } = set;
        let Some(place) = self.locations.get(&set) else { return Ok(None) };
        let path = &self.paths[place.file];
        let read = || -> io::Result<Vec<u8>> {
            let file = open_regular(path, OFlags::RDONLY)?;
            let mut payload = vec![0; place.length as usize];
            file.read_exact_at(&mut payload, place.offset)?;
            Ok(payload)
        };
        let payload = read().map_err(|error| {
            Failure::system(format!("{}: cannot read set {ordinal}: {error}", path.display()))
        })?;
        match wire::decode(&payload) {
            Ok(Record::Set(set)) if Digest::of(&payload) == place.hash => {
                Ok(Some(Outcome::Increment(set.made)))
            }
            Ok(Record::FullSet(set)) if Digest::of(&payload) == place.hash => {
                Ok(Some(Outcome::Increment(Ok(set.made.0))))
            }
            _ => Err(Failure::new(
                Code::BrokenRun,
                format!(
                    "{}: set {ordinal} is not what it was: the file was changed",
                    path.display()
                ),
            )),
        }
    }

    fn look_through(
        &mut self,
        path: PathBuf,
        problem: &Problem,
        sound: &SetCheck,
    ) -> Result<(), Failure> {
        let refuse = |why: &str| Err(Failure::usage(format!("{}: {why}", path.display())));
        let file = match open_regular(&path, OFlags::RDONLY) {
            Ok(file) => file,
            Err(error) => return refuse(&format!("cannot be read: {error}")),
        };
        let mut source = BufReader::new(file);
        let mut heading = [0; HEADING.len()];
        if source.read_exact(&mut heading).is_err() || heading[..15] != HEADING[..15] {
            return refuse("no file of sets of roadmill");
        }
        if heading != *HEADING {
            let (found, known) = (heading[15], HEADING[15]);
            return refuse(&format!("version {found} of the format found, {known} expected"));
        }
        let mut frames = Frames::new(source, Mark::behind_heading(HEADING));
        let Record::Beginning(beginning) = next(&mut frames, &path)? else {
            return Err(damaged(&frames, &path, "the beginning is missing"));
        };
        let Beginning { program, bits_version, problem_digest, label, first, end } = beginning;
        if bits_version != BITS_VERSION {
            return refuse(&format!(
                "bits of version {bits_version} (roadmill {program}) found, {BITS_VERSION} expected"
            ));
        }
        if problem_digest != problem.digest() {
            let expected = problem.digest();
            return refuse(&format!(
                "sets of a problem with digest {problem_digest} found, {expected} expected (seed, \
                 strategies and schedule count too)"
            ));
        }
        let mut labels = problem.strategies().iter().map(|known| known.label());
        let Some(strategy) = labels.position(|known| known == label) else {
            return refuse(&format!("sets of `{label}` found, a strategy of the problem expected"));
        };
        let strategy = StrategyIndex(strategy as u32);
        let file = self.paths.len();
        if problem.strategies()[strategy.index()].generator().grows() {
            return refuse(&format!("the sets of `{label}` grow and cannot be made apart"));
        }
        for expected in Ordinal::each(first..end) {
            let (ordinal, made) = match next(&mut frames, &path)? {
                Record::Set(set) => (set.ordinal, set.made),
                Record::FullSet(set) => (set.ordinal, Ok(set.made.0)),
                Record::Beginning(_) | Record::End(_) => {
                    return Err(damaged(&frames, &path, &format!("set {expected} expected")));
                }
            };
            if ordinal != expected {
                let why = format!("set {expected} expected, {ordinal} found");
                return Err(damaged(&frames, &path, &why));
            }
            let increment = made.as_ref().ok();
            let complaint = increment.and_then(|made| sound.complaint(strategy, made, 0));
            if let Some(complaint) = complaint {
                return Err(damaged(&frames, &path, &format!("set {expected}: {complaint}")));
            }
            let payload = frames.payload();
            let length = payload.len() as u64;
            let (offset, hash) = (frames.at().offset - length, Digest::of(payload));
            let place = SetLocation { file, offset, length, hash };
            let known =
                self.locations.entry(SetName { strategy, ordinal: expected }).or_insert(place);
            if known.hash != hash {
                let other = self.paths[known.file].display();
                return refuse(&format!("set {label}:{expected} is another one than in {other}"));
            }
        }
        if next(&mut frames, &path)? != Record::End(End { sets: end.0.saturating_sub(first.0) }) {
            return Err(damaged(&frames, &path, "the end expected"));
        }
        match frames.next() {
            Err(Fault::End) => {}
            _ => return Err(damaged(&frames, &path, "something behind the end")),
        }
        self.paths.push(path);
        Ok(())
    }
}

/// The files that a path or a pattern names, in alphabetical order.
fn expand(name: &str) -> Result<Vec<PathBuf>, Failure> {
    // A name may look like a pattern.
    if Path::new(name).exists() {
        return Ok(vec![name.into()]);
    }
    let refuse = |why: String| Failure::usage(format!("--import: `{name}`: {why}"));
    let found = glob::glob(name).map_err(|error| refuse(error.to_string()))?;
    let found: Vec<PathBuf> =
        found.collect::<Result<_, _>>().map_err(|error| refuse(error.to_string()))?;
    if found.is_empty() {
        return Err(refuse("no such file, and none matches it as a pattern".to_owned()));
    }
    Ok(found)
}

fn next(frames: &mut Frames<BufReader<File>>, path: &Path) -> Result<Record, Failure> {
    let fault = match frames.next() {
        Ok(()) => {
            let record = wire::decode(frames.payload());
            return record.map_err(|error| damaged(frames, path, &error.to_string()));
        }
        Err(fault) => fault,
    };
    Err(match fault {
        Fault::Unreadable(error) => {
            Failure::system(format!("{}: cannot be read: {error}", path.display()))
        }
        Fault::End | Fault::CutOff => damaged(frames, path, "cut off"),
        Fault::Damaged(why) => damaged(frames, path, why),
    })
}

fn damaged(frames: &Frames<BufReader<File>>, path: &Path, why: &str) -> Failure {
    let Mark { offset, records, .. } = frames.at();
    let place = format!("after {records} records, {offset} bytes");
    Failure::new(Code::BrokenRun, format!("{}: damaged {place}: {why}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROBLEM: &str = "
[space]
motion = \"translation-3d\"
min = [0, 0, 0]
max = [1, 1, 1]
bounds = \"body\"
[robot]
bodies = [{ shape = { sphere = { radius = 0.1 } } }]
[[strategies]]
label = \"one\"
nodes = 3
sampler = { uniform = {} }
[limits]
sets = 4
";

    fn made(value: f64) -> Result<Increment, GaveUp> {
        let problem = Problem::parse(Path::new("p.toml"), PROBLEM).expect("it is sound");
        let setup = roadmill::img::Setup::new(problem);
        let mut scratch = roadmill::model::Scratch::new();
        let ordinal = Ordinal(value as u64);
        setup.problem().strategies()[0].generate(setup.context(), ordinal, None, &mut scratch)
    }

    /// The name of a set of the only strategy.
    fn name(ordinal: u64) -> SetName {
        SetName { strategy: StrategyIndex(0), ordinal: Ordinal(ordinal) }
    }

    #[test]
    fn sets_are_read_as_they_were_written_and_later_changes_are_noticed() {
        let problem = Problem::parse(Path::new("p.toml"), PROBLEM).expect("it is sound");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("[part].sets");
        let gave_up = Err(GaveUp { attempts: 7 });
        let sets = [made(0.0), gave_up, made(2.0)];
        let mut writer =
            SetsWriter::begin(&path, false, &problem, "one", Ordinal(5)..Ordinal(8)).expect("new");
        for (ordinal, set) in (5..).zip(&sets) {
            writer.set(Ordinal(ordinal), set.clone()).expect("there is space");
        }
        writer.end().expect("there is space");
        let names = [path.to_string_lossy().into_owned()];
        let files = SetFiles::open(&names, &problem).expect("whole");
        for (ordinal, set) in (5..).zip(sets) {
            assert!(files.has(name(ordinal)));
            assert_eq!(files.read(name(ordinal)).expect("there"), Some(Outcome::Increment(set)));
        }
        assert_eq!(files.read(name(8)).expect("not there"), None);

        let file = File::options().write(true).open(&path).expect("it is there");
        let place = files.locations[&name(7)];
        file.write_all_at(&[0xff], place.offset + place.length - 1).expect("it can be written");
        assert_eq!(files.read(name(7)).map_err(|failure| failure.code), Err(Code::BrokenRun));
        file.set_len(place.offset).expect("it can be cut");
        assert_eq!(files.read(name(7)).map_err(|failure| failure.code), Err(Code::System));
        assert!(files.read(name(5)).is_ok());
    }
}
