//! The folder of a run: made, taken, or put into the place of another.
//!
//! A run that replaces another is put together beside it and then given its place in one step, in which the two
//! change names. So there is a whole run at the path at every moment, whenever a process is killed. What such a
//! process leaves beside the path, under a name with its process id, the next build there tidies up.

use super::ledger::{LEDGER, LedgerWriter, is_ledger};
use super::lock::{Holder, RunLock, held, started};
use crate::exit::Failure;
use crate::files::{cannot_write, folder_of, rename_to_free};
use roadmill_workers::Reserve;
use rustix::fs::{CWD, RenameFlags, renameat_with};
use rustix::io::Errno;
use std::fs;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// What there may be in a run folder before its ledger is.
const BEFORE_LEDGER: [&str; 3] = [super::lock::LOCK, super::ledger::BEGUN, super::ledger::DURABLE];

/// The path of the problem's query, if one was found.
pub const PATH_CSV: &str = "path.csv";
/// The summary that the build printed.
pub const SUMMARY_JSON: &str = "summary.json";
/// What each machine does, while agents of several work on the run.
pub const MACHINES_JSON: &str = "machines.json";
/// What names are made of that stand beside a run: of a run being put together, and of one set aside where two
/// cannot change names.
const NEW: &str = "new";
const REPLACED: &str = "replaced";
/// Files that are open at a time while a run folder is removed, which has no folders in it.
const OPEN_TO_REMOVE: usize = 1;

/// Whether a folder is that of a run and a file of this name, be it there or not, one of its own, as `run/mod.rs` lists them.
pub fn is_of_run(folder: &Path, name: &str) -> bool {
    let rest = name.strip_prefix(LEDGER);
    let is_ledger = rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    let is_its =
        is_ledger || [super::lock::LOCK, PATH_CSV, SUMMARY_JSON, MACHINES_JSON].contains(&name);
    is_its && folder.join(LEDGER).is_file()
}

/// Refuses a run folder that is to be made within another run's: it would go with that run, wherever `--force` replaces it.
///
/// # Errors
/// Exit code 2: `path` lies in the folder of a run. What is at `path` itself plays no part.
pub fn outside_of_runs(path: &Path) -> Result<(), Failure> {
    match run_around(path) {
        None => Ok(()),
        Some(run) => Err(Failure::usage(format!(
            "{}: in the folder of the run {}, and would go with it; a folder outside of any run expected",
            path.display(),
            run.display()
        ))),
    }
}

/// The nearest folder of a run in which `path` lies, be anything there or not.
fn run_around(path: &Path) -> Option<PathBuf> {
    // What of its folders is there already, with links followed.
    let mut folder = folder_of(path);
    let there = loop {
        match fs::canonicalize(folder) {
            Ok(there) => break there,
            Err(_) if folder == folder_of(folder) => return None,
            Err(_) => folder = folder_of(folder),
        }
    };
    let is_run = |folder: &&Path| is_ledger(&folder.join(LEDGER));
    there.ancestors().find(is_run).map(Path::to_owned)
}

/// A run folder made for a build.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Where the run is put together before it is given its place.
    staged: Option<PathBuf>,
    /// The run whose place it takes, held so that nobody goes on with it.
    replaces: Option<RunLock>,
    /// Where the run that it has replaced waits until the new one has begun.
    replaced: Option<(PathBuf, RunLock)>,
    /// What it takes to remove a folder, however many files this process has come to open.
    reserve: Option<Reserve>,
}

impl RunFolder {
    /// Makes the folder that `--out` names, or a free one under `runs`. With `force` the folder is made beside it
    /// and takes the place of a run that is there, of nothing else, with [`RunFolder::settle`].
    ///
    /// # Errors
    /// Exit code 2: the folder exists, is no run, lies in that of another run, or cannot be made; another process works on the run.
    pub fn make(out: Option<&Path>, name: &str, force: bool) -> Result<RunFolder, Failure> {
        let Some(path) = out else { return Self::make_numbered(name) };
        outside_of_runs(path)?;
        let reserve = reserve(path)?;
        make_parents(path)?;
        tidy(path);
        if force {
            return Ok(RunFolder { reserve, ..Self::stage(path)? });
        }
        match fs::create_dir(path) {
            Ok(()) => Ok(RunFolder { reserve, ..RunFolder::of(path) }),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(exists(path)),
            Err(error) => Err(cannot_make(path, &error)),
        }
    }

    /// Refuses what is at `path` as [`RunFolder::make`] would, or [`RunFolder::make_or_take`] where a run is to go on if
    /// there is one: for work that takes its time before the folder is made. Nothing is made, and nothing stays held.
    ///
    /// # Errors
    /// Exit code 2: as these two.
    pub fn check(path: &Path, force: bool, or_resume: bool) -> Result<(), Failure> {
        outside_of_runs(path)?;
        tidy(path);
        if force {
            return hold(path).map(drop);
        }
        let is_there = fs::symlink_metadata(path).is_ok();
        match or_resume {
            _ if !is_there => Ok(()),
            true if path.join(LEDGER).is_file() => Ok(()),
            true => expect_beginning(path),
            false => Err(exists(path)),
        }
    }

    /// Makes the folder `path`, or takes one in which there is nothing, or only what a build leaves that
    /// was killed before it began its ledger.
    ///
    /// # Errors
    /// Exit code 2: it holds something else, lies in the folder of another run, or cannot be made.
    pub fn make_or_take(path: &Path) -> Result<RunFolder, Failure> {
        outside_of_runs(path)?;
        let reserve = reserve(path)?;
        make_parents(path)?;
        match fs::create_dir(path) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::AlreadyExists => expect_beginning(path)?,
            Err(error) => return Err(cannot_make(path, &error)),
        }
        Ok(RunFolder { reserve, ..RunFolder::of(path) })
    }

    /// The folder of a run that goes on.
    pub fn of(path: &Path) -> RunFolder {
        let path = path.to_owned();
        RunFolder { path, staged: None, replaces: None, replaced: None, reserve: None }
    }

    fn make_numbered(name: &str) -> Result<RunFolder, Failure> {
        let mut number = 1u64;
        loop {
            let path = match number {
                1 => Path::new("runs").join(name),
                _ => Path::new("runs").join(format!("{name}-{number}")),
            };
            let reserve = reserve(&path)?;
            make_parents(&path)?;
            match fs::create_dir(&path) {
                Ok(()) => return Ok(RunFolder { reserve, ..RunFolder::of(&path) }),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(cannot_make(&path, &error)),
            }
        }
    }

    fn stage(path: &Path) -> Result<RunFolder, Failure> {
        if path.file_name().is_none() {
            return Err(Failure::usage(format!(
                "{}: cannot be replaced; a path that ends in a name expected",
                path.display()
            )));
        }
        let replaces = hold(path)?;
        let mut number = 1u64;
        loop {
            let staged = aside(path, NEW, number);
            match fs::create_dir(&staged) {
                Ok(()) => {
                    let staged = Some(staged);
                    return Ok(RunFolder { staged, replaces, ..RunFolder::of(path) });
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(cannot_make(path, &error)),
            }
        }
    }

    /// Where it is now.
    pub fn path(&self) -> &Path {
        self.staged.as_ref().unwrap_or(&self.path)
    }

    /// Path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    /// The run has its ledger: it is given its place, if it has not been there from the start.
    ///
    /// # Errors
    /// Exit code 2: another build has come to stand there; 1: the system refuses. The folder is then removed.
    pub fn settle(mut self, ledger: &mut LedgerWriter) -> Result<RunFolder, Failure> {
        let Some(staged) = self.staged.take() else { return Ok(self) };
        let moved = match self.replaces.take() {
            Some(lock) => {
                change_places(&staged, &self.path).map(|old| self.replaced = Some((old, lock)))
            }
            None => rename_to_free(&staged, &self.path),
        };
        if let Err(error) = moved {
            drop(self.reserve.take());
            // What cannot be removed now the next build tidies up.
            let _ = fs::remove_dir_all(&staged);
            return Err(match error.kind() {
                ErrorKind::AlreadyExists | ErrorKind::DirectoryNotEmpty => taken(&self.path),
                _ => cannot_write(&self.path, &error),
            });
        }
        ledger.moved(&self.path);
        if let Some((old, lock)) = &mut self.replaced {
            lock.moved(old);
        }
        Ok(self)
    }

    /// The build has begun: what it replaces is removed.
    ///
    /// # Errors
    /// Exit code 1: it cannot be removed.
    pub fn begun(&mut self) -> Result<(), Failure> {
        drop(self.reserve.take());
        let Some((old, lock)) = self.replaced.take() else { return Ok(()) };
        let removed = fs::remove_dir_all(&old).map_err(|error| {
            Failure::system(format!("{}: cannot remove it: {error}", old.display()))
        });
        drop(lock);
        removed
    }

    /// The build could not begin: all is as it was before.
    pub fn discard(mut self) {
        drop(self.reserve.take());
        // What cannot be put right is no worse than the failure that led here.
        let _ = match (&self.staged, &mut self.replaced) {
            (Some(staged), _) => fs::remove_dir_all(staged),
            (None, Some((old, lock))) => change_places(old, &self.path).and_then(|new| {
                lock.moved(&self.path);
                fs::remove_dir_all(new)
            }),
            (None, None) => fs::remove_dir_all(&self.path),
        };
    }
}

/// Takes hold of the run whose place is to be taken; `None` if nothing is there. Refuses anything else.
fn hold(path: &Path) -> Result<Option<RunLock>, Failure> {
    let refuse = |what: &str| {
        Err(Failure::usage(format!("{}: {what}; --force replaces runs only", path.display())))
    };
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return refuse(&error.to_string()),
        Ok(metadata) if !metadata.is_dir() => return refuse("not a folder"),
        Ok(_) => {}
    }
    // A build may have been killed before it had a ledger.
    let is_run = || path.join(LEDGER).is_file() || matches!(beyond_a_beginning(path), Ok(None));
    if !is_run() {
        return refuse("holds no ledger");
    }
    // Nobody may work on it, now or before the new run has its place.
    let lock = RunLock::take(path, || false)?;
    if is_run() { Ok(Some(lock)) } else { refuse("holds no ledger") }
}

/// The first name in a folder that is none of what a build leaves that was killed before it began its ledger.
fn beyond_a_beginning(path: &Path) -> Result<Option<String>, Failure> {
    let entries = fs::read_dir(path).map_err(|error| cannot_make(path, &error))?;
    for entry in entries {
        let name = entry.map_err(|error| cannot_make(path, &error))?.file_name();
        if !BEFORE_LEDGER.iter().any(|known| name == *known) {
            return Ok(Some(name.to_string_lossy().into_owned()));
        }
    }
    Ok(None)
}

/// Refuses a folder that holds something else than what a build leaves that was killed before it began its ledger.
fn expect_beginning(path: &Path) -> Result<(), Failure> {
    match beyond_a_beginning(path)? {
        None => Ok(()),
        Some(name) => Err(Failure::usage(format!(
            "{}: holds `{name}` but no ledger; a run or a new folder expected",
            path.display(),
        ))),
    }
}

/// Gives the folder `new` the name of the folder at `path`; where that is then. In one step, if the file system can.
fn change_places(new: &Path, path: &Path) -> io::Result<PathBuf> {
    match renameat_with(CWD, new, CWD, path, RenameFlags::EXCHANGE) {
        Ok(()) => return Ok(new.to_owned()),
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => {}
        Err(error) => return Err(error.into()),
    }
    // Whoever is killed between the two steps leaves no run at the path: `tidy` brings the old one back.
    let old = (1..).map(|number| aside(path, REPLACED, number));
    let old = old.into_iter().find(|old| fs::symlink_metadata(old).is_err());
    let old = old.ok_or(ErrorKind::AlreadyExists)?;
    fs::rename(path, &old)?;
    if let Err(error) = fs::rename(new, path) {
        fs::rename(&old, path)?;
        return Err(error);
    }
    Ok(old)
}

/// A name beside `path` that nobody but this process uses.
fn aside(path: &Path, kind: &str, number: u64) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{kind}-{}-{number}", std::process::id()));
    path.with_file_name(name)
}

/// The kind and the process id in the name of something beside the run called `run`.
fn parse_aside(name: &str, run: &str) -> Option<(&'static str, u32)> {
    let rest = name.strip_prefix('.')?.strip_prefix(run)?.strip_prefix('.')?;
    let (kind, numbers) = rest.split_once('-')?;
    let kind = [NEW, REPLACED].into_iter().find(|known| *known == kind)?;
    let (pid, number) = numbers.split_once('-')?;
    number.parse::<u64>().ok()?;
    Some((kind, pid.parse().ok()?))
}

/// Tidies up what killed builds have left beside the run at `path`: a run that was set aside comes back if there is
/// none at the path; the rest is removed. What somebody may be at work on, and whatever cannot be put right, stays.
pub fn tidy(path: &Path) {
    let (folder, name) = (folder_of(path), path.file_name().and_then(|name| name.to_str()));
    let (Some(name), Ok(entries)) = (name, fs::read_dir(folder)) else { return };
    for entry in entries.flatten() {
        let aside = entry.file_name();
        let Some((kind, pid)) = aside.to_str().and_then(|aside| parse_aside(aside, name)) else {
            continue;
        };
        let aside = path.with_file_name(aside);
        let is_ours = |metadata: fs::Metadata| {
            metadata.is_dir() && metadata.uid() == rustix::process::geteuid().as_raw()
        };
        if started(pid).is_some() || !fs::symlink_metadata(&aside).is_ok_and(is_ours) {
            continue;
        }
        // Held until all is done, so that nobody else does the same.
        let Some(_lock) = RunLock::take_if_free(&aside) else { continue };
        let is_missing = fs::symlink_metadata(path).is_err();
        let _ = if kind == REPLACED && is_missing && aside.join(LEDGER).is_file() {
            rename_to_free(&aside, path)
        } else {
            fs::remove_dir_all(&aside)
        };
    }
}

/// Taken before a folder is made.
fn reserve(path: &Path) -> Result<Option<Reserve>, Failure> {
    Reserve::take(OPEN_TO_REMOVE).map(Some).map_err(|error| cannot_make(path, &error))
}

fn make_parents(path: &Path) -> Result<(), Failure> {
    match path.parent() {
        Some(parent) => fs::create_dir_all(parent).map_err(|error| cannot_make(path, &error)),
        None => Ok(()),
    }
}

fn exists(path: &Path) -> Failure {
    Failure::usage(format!(
        "{}: exists already; a new folder expected, or --force to replace a run, or --or-resume to go on with it",
        path.display()
    ))
}

/// Another build has come to stand at the path since nothing was there.
fn taken(path: &Path) -> Failure {
    match Holder::read(path) {
        Some(holder) if holder.lives() != Some(false) => held(path, Some(&holder)),
        _ => Failure::usage(format!(
            "{}: something has come to stand there meanwhile; the same command may replace it if it is a run",
            path.display()
        )),
    }
}

fn cannot_make(path: &Path, error: &io::Error) -> Failure {
    let Failure { code, .. } = cannot_write(path, error);
    Failure::new(code, format!("{}: cannot make the run folder: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The id of a process that has ended.
    fn dead() -> u32 {
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        child.id()
    }

    fn run(path: &Path, ledger: &str) {
        fs::create_dir(path).unwrap();
        fs::write(path.join(LEDGER), ledger).unwrap();
    }

    #[test]
    fn what_the_dead_have_set_aside_comes_back_or_goes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let names = || {
            let entries = fs::read_dir(folder.path()).unwrap();
            let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
            names.sort();
            names
        };
        let dead = dead();
        run(&folder.path().join(format!(".run.new-{dead}-1")), "new");
        run(&folder.path().join(format!(".run.replaced-{dead}-1")), "old");
        tidy(&path);
        assert_eq!(names(), ["run"]);
        assert_eq!(fs::read_to_string(path.join(LEDGER)).unwrap(), "old");

        // The place is taken.
        run(&folder.path().join(format!(".run.replaced-{dead}-2")), "older");
        fs::create_dir(folder.path().join(format!(".run.new-{dead}-1"))).unwrap();
        tidy(&path);
        assert_eq!(names(), ["run"]);
        assert_eq!(fs::read_to_string(path.join(LEDGER)).unwrap(), "old");

        // Of the living, of another run, and of nobody.
        let others = [
            aside(&path, NEW, 7),
            folder.path().join(format!(".run2.new-{dead}-1")),
            folder.path().join(".run.new-x-1"),
        ];
        others.iter().for_each(|other| run(other, "other"));
        tidy(&path);
        assert_eq!(names().len(), 4);
    }

    #[test]
    fn no_run_is_made_within_another() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("run")).unwrap();
        fs::write(at("run/ledger"), super::super::ledger::HEADING).unwrap();
        // A file that has the name of a ledger is none.
        run(&at("accounts"), "2013/10/18 * Coffee");
        std::os::unix::fs::symlink(at("run"), at("link")).unwrap();
        for inside in ["run/sub", "run/a/b", "link/sub", "accounts/../run/sub"] {
            let refused = outside_of_runs(&at(inside)).unwrap_err().to_string();
            assert!(refused.contains("in the folder of the run"), "{inside}: {refused}");
            let made = [
                RunFolder::make(Some(&at(inside)), "name", false),
                RunFolder::make_or_take(&at(inside)),
            ];
            assert!(made.iter().all(Result::is_err), "{inside}");
            assert_eq!(fs::read_dir(at("run")).unwrap().count(), 1, "{inside}: nothing is made");
        }
        for outside in ["run", "run-2", "accounts/sub", "none/sub"] {
            outside_of_runs(&at(outside)).unwrap();
        }
    }

    #[test]
    fn two_folders_change_places() {
        let folder = tempfile::tempdir().unwrap();
        let [new, path] = ["new", "run"].map(|name| folder.path().join(name));
        run(&new, "new");
        run(&path, "old");
        let old = change_places(&new, &path).unwrap();
        let ledger = |path: &Path| fs::read_to_string(path.join(LEDGER)).unwrap();
        assert_eq!((ledger(&path), ledger(&old)), ("new".to_owned(), "old".to_owned()));
        assert!(rename_to_free(&old, &path).is_err(), "it is taken");
        rename_to_free(&old, &folder.path().join("free")).unwrap();
    }

    /// Whoever was faster is named, or has ended already.
    #[test]
    fn a_place_that_was_taken_meanwhile_is_anothers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        run(&path, "faster");
        let lock = RunLock::take(&path, || false).unwrap();
        let message = taken(&path).message;
        assert!(message.contains("works on this run"), "{message}");
        drop(lock);
        let message = taken(&path).message;
        assert!(message.contains("has come to stand there meanwhile"), "{message}");
    }

    #[test]
    fn a_run_at_work_and_what_is_no_run_keep_their_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        assert!(hold(&path).unwrap().is_none());
        run(&path, "old");
        let lock = RunLock::take(&path, || false).unwrap();
        assert!(hold(&path).unwrap_err().message.contains("works on this run"));
        drop(lock);
        assert!(hold(&path).unwrap().is_some());
        fs::remove_file(path.join(LEDGER)).unwrap();
        assert!(hold(&path).unwrap().is_some(), "a beginning");
        fs::write(path.join("thesis.tex"), "").unwrap();
        assert!(hold(&path).unwrap_err().message.contains("holds no ledger"));
    }
}
