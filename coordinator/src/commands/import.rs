use super::load::load;
use crate::cli::ImportArguments;
use crate::exit::{Code, Failure};
use crate::files::{cannot_write, folder_of};
use crate::output::{Plain, line, note};
use crate::run::{Ledgers, started};
use crate::signals::Signals;
use roadmill::model::SceneOptions;
use roadmill::problem::{Problem, Written};
use rustix::fs::{CWD, RenameFlags, renameat_with};
use rustix::io::Errno;
use std::fs;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Writes a problem as a problem file, with its meshes in a folder beside it.
///
/// All is first written into a folder of its own beside the place where it is to be, and read from
/// there again, so that what comes to stand there is whole and the same problem.
pub fn import(arguments: &ImportArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let place = Destination::of(&arguments.out)?;
    place.tidy();
    place.check(arguments.force)?;
    // Listened to, so that a signal leaves no half of anything.
    let signals = Signals::listen().map_err(Failure::system)?;
    let mut written = problem.to_toml(&place.meshes_name);
    let from = arguments.problem.file.file_name().unwrap_or_default();
    // Quoted, for names may hold line breaks.
    written.text = format!("# Imported from {from:?}.\n{}", written.text);
    let result = place.fill(&written).and_then(|()| {
        let file = place.staged.join(&place.file_name);
        let again = Problem::load_with(&file, &SceneOptions::default(), &Ledgers);
        let again = again.map_err(Failure::system)?;
        if again.digest() != problem.digest() {
            return Err(Failure::system("what was written loads to another problem; not kept"));
        }
        if signals.came() {
            return Err(Failure::new(Code::Interrupted, "a signal came; nothing is written"));
        }
        place.move_in(!written.files.is_empty())
    });
    // Also what was replaced.
    let _ = fs::remove_dir_all(&place.staged);
    result?;
    let name = Plain(problem.name());
    problem.notes().iter().for_each(|text| note(format_args!("{name}: {text}")));
    line(format_args!("problem digest   {}", problem.digest()));
    Ok(Code::Done)
}

/// Where the files go.
struct Destination {
    folder: PathBuf,
    file_name: String,
    meshes_name: String,
    staged: PathBuf,
}

impl Destination {
    fn of(out: &Path) -> Result<Destination, Failure> {
        let name = out.file_name().and_then(|name| name.to_str());
        let stem = name.and_then(|name| name.strip_suffix(".toml")).filter(|stem| !stem.is_empty());
        let (Some(name), Some(stem)) = (name, stem) else {
            let message = format!("--out: {} found; a NAME.toml expected", out.display());
            return Err(Failure::usage(message));
        };
        let folder = out.parent().unwrap_or(Path::new("")).to_owned();
        let staged = folder.join(format!(".{name}.import-{}", std::process::id()));
        let meshes_name = format!("{stem}-meshes");
        Ok(Destination { folder, file_name: name.to_owned(), meshes_name, staged })
    }

    fn file(&self) -> PathBuf {
        self.folder.join(&self.file_name)
    }

    fn meshes(&self) -> PathBuf {
        self.folder.join(&self.meshes_name)
    }

    /// Removes what imports to this place have left that were killed.
    fn tidy(&self) {
        let file = self.file();
        let Ok(entries) = fs::read_dir(folder_of(&file)) else { return };
        let start = format!(".{}.import-", self.file_name);
        for entry in entries.flatten() {
            let name = entry.file_name();
            let pid = name.to_str().and_then(|name| name.strip_prefix(&start)?.parse().ok());
            let is_ours = entry.metadata().is_ok_and(|metadata| {
                metadata.is_dir() && metadata.uid() == rustix::process::geteuid().as_raw()
            });
            if is_ours && pid.is_some_and(|pid| started(pid).is_none()) {
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }

    /// Nothing is replaced without `force`, and with it only what an import may have written.
    fn check(&self, force: bool) -> Result<(), Failure> {
        for path in [self.file(), self.meshes()] {
            if !force && fs::symlink_metadata(&path).is_ok() {
                let message = format!("{}: exists already; --force replaces it", path.display());
                return Err(Failure::usage(message));
            }
        }
        let is_mesh = |entry: io::Result<fs::DirEntry>| {
            entry.is_ok_and(|entry| {
                let path = entry.path();
                path.is_file() && path.extension().is_some_and(|extension| extension == "obj")
            })
        };
        let meshes = self.meshes();
        let replaceable = match fs::read_dir(&meshes) {
            Ok(mut entries) => entries.all(is_mesh),
            Err(error) => error.kind() == io::ErrorKind::NotFound,
        };
        if replaceable && !self.file().is_dir() {
            return Ok(());
        }
        let path = if replaceable { self.file() } else { meshes };
        let message =
            format!("{}: holds other things than an import's; not replaced", path.display());
        Err(Failure::usage(message))
    }

    fn fill(&self, written: &Written) -> Result<(), Failure> {
        let meshes = self.staged.join(&self.meshes_name);
        let write = || {
            fs::create_dir(&self.staged)?;
            fs::write(self.staged.join(&self.file_name), &written.text)?;
            if !written.files.is_empty() {
                fs::create_dir(&meshes)?;
            }
            written.files.iter().try_for_each(|(name, text)| fs::write(meshes.join(name), text))
        };
        write().map_err(|error| self.cannot(&error))
    }

    /// Puts what was written into its place, and what was there into the staged folder. The problem file is last,
    /// in one step: it is there at every moment, and until then all can be put back.
    fn move_in(&self, with_meshes: bool) -> Result<(), Failure> {
        let (staged, meshes) = (self.staged.join(&self.meshes_name), self.meshes());
        let had_meshes = fs::symlink_metadata(&meshes).is_ok();
        if with_meshes {
            change_places(&staged, &meshes, had_meshes).map_err(|error| self.cannot(&error))?;
        }
        if let Err(error) = fs::rename(self.staged.join(&self.file_name), self.file()) {
            if with_meshes {
                let _ = change_places(&staged, &meshes, had_meshes);
            }
            return Err(self.cannot(&error));
        }
        if !with_meshes && had_meshes {
            // Of no use to the problem that is there now.
            let _ = fs::rename(&meshes, staged);
        }
        Ok(())
    }

    fn cannot(&self, error: &io::Error) -> Failure {
        cannot_write(&self.file(), error)
    }
}

/// Gives two folders each other's names, or one the other's name if there is only one.
fn change_places(one: &Path, other: &Path, are_two: bool) -> io::Result<()> {
    if !are_two {
        // Either way, so that doing it again undoes it.
        return match fs::rename(one, other) {
            Err(error) if error.kind() == ErrorKind::NotFound => fs::rename(other, one),
            renamed => renamed,
        };
    }
    match renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE) {
        Ok(()) => Ok(()),
        // Not every file system can do it in one step.
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => {
            let between = one.with_extension("between");
            fs::rename(other, &between)?;
            fs::rename(one, other)?;
            fs::rename(between, one)
        }
        Err(error) => Err(error.into()),
    }
}
