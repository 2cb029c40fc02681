use super::ledger::LEDGER;
use super::lock::RunLock;
use crate::exit::Failure;
use std::fs::{self, DirBuilder};
use std::io::ErrorKind;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

/// What there may be in a run folder before its ledger is.
const BEFORE_LEDGER: [&str; 3] = [super::lock::LOCK, super::ledger::BEGUN, super::ledger::DURABLE];

/// A run folder made for a build. Only its owner may enter it.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Where the run that is being replaced waits until the new one has begun.
    replaced: Option<PathBuf>,
}

impl RunFolder {
    /// Makes the folder that `--out` names, or a free one under `runs`. With `force` a run that
    /// is there is removed first; nothing else ever is.
    ///
    /// # Errors
    /// Exit code 2: the folder exists, is no run, or cannot be made.
    pub fn make(out: Option<&Path>, name: &str, force: bool) -> Result<RunFolder, Failure> {
        let path = match out {
            Some(path) => path.to_owned(),
            None => return Self::make_numbered(name),
        };
        let replaced = if force { set_run_aside(&path)? } else { None };
        make_parents(&path)?;
        match DirBuilder::new().mode(0o700).create(&path) {
            Ok(()) => Ok(RunFolder { path, replaced }),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(Failure::usage(format!(
                "{}: exists already; a new folder expected, or --force to replace a run, or \
                 --or-resume to go on with it",
                path.display()
            ))),
            Err(error) => Err(cannot_make(&path, &error)),
        }
    }

    /// Makes the folder `path`, or takes one in which there is nothing, or only what a build leaves that
    /// was killed before it began its ledger.
    ///
    /// # Errors
    /// Exit code 2: it holds something else, or cannot be made.
    pub fn make_or_take(path: &Path) -> Result<RunFolder, Failure> {
        make_parents(path)?;
        match DirBuilder::new().mode(0o700).create(path) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                let entries = fs::read_dir(path).map_err(|error| cannot_make(path, &error))?;
                for entry in entries {
                    let name = entry.map_err(|error| cannot_make(path, &error))?.file_name();
                    if !BEFORE_LEDGER.iter().any(|known| name == *known) {
                        return Err(Failure::usage(format!(
                            "{}: holds `{}` but no ledger; a run or a new folder expected",
                            path.display(),
                            name.to_string_lossy()
                        )));
                    }
                }
            }
            Err(error) => return Err(cannot_make(path, &error)),
        }
        Ok(RunFolder { path: path.to_owned(), replaced: None })
    }

    /// The folder of a run that goes on.
    pub fn of(path: &Path) -> RunFolder {
        RunFolder { path: path.to_owned(), replaced: None }
    }

    fn make_numbered(name: &str) -> Result<RunFolder, Failure> {
        let mut number = 1u64;
        loop {
            let path = match number {
                1 => Path::new("runs").join(name),
                _ => Path::new("runs").join(format!("{name}-{number}")),
            };
            make_parents(&path)?;
            match DirBuilder::new().mode(0o700).create(&path) {
                Ok(()) => return Ok(RunFolder { path, replaced: None }),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(cannot_make(&path, &error)),
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The build has begun: what it replaces is removed.
    ///
    /// # Errors
    /// Exit code 1: it cannot be removed.
    pub fn begun(&mut self) -> Result<(), Failure> {
        match self.replaced.take() {
            None => Ok(()),
            Some(old) => fs::remove_dir_all(&old).map_err(|error| {
                Failure::system(format!("{}: cannot remove it: {error}", old.display()))
            }),
        }
    }

    /// The build could not begin: all is as it was before.
    pub fn discard(self) {
        // What cannot be put right is no worse than the failure that led here.
        let _ = fs::remove_dir_all(&self.path);
        if let Some(old) = &self.replaced {
            let _ = fs::rename(old, &self.path);
        }
    }
}

fn make_parents(path: &Path) -> Result<(), Failure> {
    match path.parent() {
        Some(parent) => fs::create_dir_all(parent).map_err(|error| cannot_make(path, &error)),
        None => Ok(()),
    }
}

fn cannot_make(path: &Path, error: &std::io::Error) -> Failure {
    Failure::usage(format!("{}: cannot make the run folder: {error}", path.display()))
}

/// Renames a run, if there is one, to a name beside it; refuses anything else.
fn set_run_aside(path: &Path) -> Result<Option<PathBuf>, Failure> {
    let refuse = |what: &str| {
        Err(Failure::usage(format!("{}: {what}; --force replaces runs only", path.display())))
    };
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return refuse(&error.to_string()),
        Ok(metadata) if !metadata.is_dir() => return refuse("not a folder"),
        Ok(_) => {}
    }
    if !path.join(LEDGER).is_file() {
        return refuse("holds no ledger");
    }
    // Not while somebody works on it.
    drop(RunLock::take(path, || false)?);
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".replaced-{}", std::process::id()));
    let aside = path.with_file_name(name);
    fs::rename(path, &aside)
        .map_err(|error| Failure::usage(format!("{}: cannot move it: {error}", path.display())))?;
    Ok(Some(aside))
}
