//! A problem written out as files, in one step.

use crate::exit::{Code, Failure};
use crate::files::{cannot_write, folder_of, open_in_run, read_regular_text, rename_to_free};
use crate::output::{Plain, note, told};
use crate::run::{Ledgers, started};
use crate::signals::Signals;
use roadmill::model::{ModelKind, SceneOptions};
use roadmill::problem::{Problem, Written};
use rustix::fs::OFlags;
use std::fs;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Writes a problem as the problem file `out`, led by a comment, with its other files in a folder beside it, and prints its
/// notes and its digest; with `is_json` all of it on standard error, as standard output is for objects alone.
///
/// All is first written into a folder of its own beside the place where it is to be, and read from
/// there again, so that what comes to stand there is whole and the same problem. The other files then get a place that nothing
/// has, and the problem file, which names it, takes its own in one step: whenever the process is killed, the problem
/// that is there has its files. Folders that no problem uses any more go at the end, or with the next problem written there.
pub(super) fn write_problem(
    problem: &Problem,
    comment: &str,
    out: &Path,
    (force, is_json): (bool, bool),
) -> Result<(), Failure> {
    let mut place = Destination::of(out, Companions::of(problem))?;
    place.tidy();
    place.check(force)?;
    place.choose();
    // Listened to, so that a signal leaves no half of anything.
    let signals = Signals::listen().map_err(Failure::system)?;
    let mut written = problem.to_toml(&place.chosen);
    written.text = format!("{comment}{}", written.text);
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
    place.remove_unused(&place.folders);
    let _ = fs::remove_dir_all(&place.staged);
    result?;
    let name = Plain(problem.name());
    problem.notes().iter().for_each(|text| note(format_args!("{name}: {text}")));
    told(format_args!("problem digest   {}", problem.digest()), is_json);
    Ok(())
}

/// Removes a problem file that [`write_problem`] has written where nothing was, with the folder of its other files.
pub(super) fn remove_problem(problem: &Problem, out: &Path) {
    let Ok(place) = Destination::of(out, Companions::of(problem)) else { return };
    let text = read_regular_text(out).unwrap_or_default();
    let entries = fs::read_dir(folder_of(out)).into_iter().flatten().flatten();
    let folders = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_its = |name: &String| place.companions_in(name).is_some() && names(&text, name);
    let folders: Vec<String> = folders.filter(is_its).collect();
    // What cannot be removed does no harm.
    let _ = fs::remove_file(out);
    place.remove_unused(&folders);
}

/// The files beside a problem file.
#[derive(Clone, Copy)]
struct Companions {
    /// What follows the name of the problem file in the name of their folder.
    suffix: &'static str,
    /// The extension of each.
    extension: &'static str,
}

const MESHES: Companions = Companions { suffix: "meshes", extension: "obj" };
const STRUCTURES: Companions = Companions { suffix: "structures", extension: "cif" };

impl Companions {
    fn of(problem: &Problem) -> Companions {
        match problem.model() {
            ModelKind::Protein(_) | ModelKind::Docking(_) => STRUCTURES,
            _ => MESHES,
        }
    }
}

/// Where the files go.
struct Destination {
    folder: PathBuf,
    file_name: String,
    /// The name of the problem file without its extension, with which the names of folders of companions begin.
    stem: String,
    /// The plain name of a folder of the companions.
    plain_name: String,
    /// The name of the folder of the companions.
    chosen: String,
    /// The names of folders that have no use any more once the import is over, unless the problem file that is then
    /// there names them: first the new one, then those that imports before have used.
    folders: Vec<String>,
    staged: PathBuf,
}

/// The file in the staged folder that has the names of [`Destination::folders`], each ended by a zero.
const FOLDERS: &str = "folders";

impl Destination {
    fn of(out: &Path, companions: Companions) -> Result<Destination, Failure> {
        let name = out.file_name().and_then(|name| name.to_str());
        let stem = name.and_then(|name| name.strip_suffix(".toml")).filter(|stem| !stem.is_empty());
        let (Some(name), Some(stem)) = (name, stem) else {
            let message = format!("--out: {} found; a NAME.toml expected", out.display());
            return Err(Failure::usage(message));
        };
        let folder = out.parent().unwrap_or(Path::new("")).to_owned();
        let staged = folder.join(format!(".{name}.import-{}", std::process::id()));
        let plain_name = format!("{stem}-{}", companions.suffix);
        Ok(Destination {
            folder,
            file_name: name.to_owned(),
            stem: stem.to_owned(),
            chosen: plain_name.clone(),
            plain_name,
            folders: Vec::new(),
            staged,
        })
    }

    fn file(&self) -> PathBuf {
        self.folder.join(&self.file_name)
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
                let folders = open_in_run(&entry.path().join(FOLDERS), OFlags::RDONLY);
                let folders = folders.and_then(io::read_to_string).unwrap_or_default();
                // Where the new problem file has not come to its place, nothing that was there has lost its use.
                let is_done = !entry.path().join(&self.file_name).exists();
                let folders =
                    folders.split_terminator('\0').take(if is_done { usize::MAX } else { 1 });
                let folders = folders.filter(|name| self.companions_in(name).is_some());
                let folders = folders.map(str::to_owned);
                self.remove_unused(&folders.collect::<Vec<_>>());
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }

    /// What is in the folders to which an import to this place may give this name; `None` if it gives it to none.
    fn companions_in(&self, name: &str) -> Option<Companions> {
        [MESHES, STRUCTURES].into_iter().find(|companions| {
            let plain_name = format!("{}-{}", self.stem, companions.suffix);
            name.strip_prefix(&plain_name).is_some_and(|rest| {
                let number = rest.strip_prefix('-').and_then(|number| number.parse::<u64>().ok());
                rest.is_empty() || number.is_some_and(|number| rest == format!("-{number}"))
            })
        })
    }

    /// Nothing is replaced without `force`, and with it only what an import may have written.
    fn check(&self, force: bool) -> Result<(), Failure> {
        let companions = self.folder.join(&self.plain_name);
        for path in [&self.file(), &companions] {
            if !force && fs::symlink_metadata(path).is_ok() {
                let message = format!("{}: exists already; --force replaces it", path.display());
                return Err(Failure::usage(message));
            }
        }
        let replaceable = fs::symlink_metadata(&companions).is_err()
            || self.has_companions_only(&self.plain_name);
        if replaceable && !self.file().is_dir() {
            return Ok(());
        }
        let path = if replaceable { self.file() } else { companions };
        let message =
            format!("{}: holds other things than an import's; not replaced", path.display());
        Err(Failure::usage(message))
    }

    /// Chooses a name for the folder of the companions that nothing has yet, and finds those that imports before have used.
    fn choose(&mut self) {
        let name = |number: u64| match number {
            1 => self.plain_name.clone(),
            _ => format!("{}-{number}", self.plain_name),
        };
        let is_free = |name: &String| fs::symlink_metadata(self.folder.join(name)).is_err();
        let free = (1..).map(name).find(is_free).unwrap_or_default();
        let problem = read_regular_text(&self.file()).unwrap_or_default();
        // Whatever has the plain name is replaced, as `check` allows; of others, those of another kind among them, what the
        // problem has used.
        let is_old = |name: &String| *name == self.plain_name || names(&problem, name);
        let entries = fs::read_dir(folder_of(&self.file())).into_iter().flatten().flatten();
        let others = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let old = others.filter(|name| self.companions_in(name).is_some()).filter(is_old);
        self.folders = std::iter::once(free.clone()).chain(old).collect();
        self.chosen = free;
    }

    /// Removes folders of companions that the problem file does not name.
    fn remove_unused(&self, folders: &[String]) {
        let problem = match read_regular_text(&self.file()) {
            Ok(problem) => problem,
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            Err(_) => return,
        };
        for name in folders.iter().filter(|name| !names(&problem, name)) {
            if self.has_companions_only(name) {
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(self.folder.join(name));
            }
        }
    }

    fn fill(&self, written: &Written) -> Result<(), Failure> {
        let companions = self.staged.join(&self.chosen);
        let write = || {
            fs::create_dir(&self.staged)?;
            fs::write(self.staged.join(&self.file_name), &written.text)?;
            let folders: String = self.folders.iter().map(|name| format!("{name}\0")).collect();
            fs::write(self.staged.join(FOLDERS), folders)?;
            if !written.files.is_empty() {
                fs::create_dir(&companions)?;
            }
            written.files.iter().try_for_each(|(name, text)| fs::write(companions.join(name), text))
        };
        write().map_err(|error| self.cannot(&error))
    }

    /// Puts what was written into its place: the companions where nothing is, then, in one step, the problem file.
    fn move_in(&self, with_companions: bool) -> Result<(), Failure> {
        let move_all = || {
            if with_companions {
                let companions = self.folder.join(&self.chosen);
                rename_to_free(&self.staged.join(&self.chosen), &companions)?;
            }
            fs::rename(self.staged.join(&self.file_name), self.file())
        };
        move_all().map_err(|error| self.cannot(&error))
    }

    /// Whether the folder of this name has only files of the kind that this command writes there.
    fn has_companions_only(&self, name: &str) -> bool {
        let Some(Companions { extension, .. }) = self.companions_in(name) else { return false };
        let is_companion = |entry: io::Result<fs::DirEntry>| {
            entry.is_ok_and(|entry| {
                let path = entry.path();
                path.is_file() && path.extension().is_some_and(|it| it == extension)
            })
        };
        let folder = self.folder.join(name);
        let is_folder = fs::symlink_metadata(&folder).is_ok_and(|metadata| metadata.is_dir());
        is_folder && fs::read_dir(&folder).is_ok_and(|mut entries| entries.all(is_companion))
    }

    fn cannot(&self, error: &io::Error) -> Failure {
        cannot_write(&self.file(), error)
    }
}

/// Whether a problem file names files in the folder; where its name may be written in several ways it always may.
fn names(problem: &str, folder: &str) -> bool {
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\'' | '\\');
    !folder.chars().all(is_plain) || problem.contains(&format!("{folder}/"))
}
