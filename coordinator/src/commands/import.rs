use super::load::load;
use crate::cli::ImportArguments;
use crate::exit::{Code, Failure};
use crate::files::{cannot_write, folder_of, open_in_run, rename_to_free};
use crate::output::{Plain, line, note};
use crate::run::{Ledgers, started};
use crate::signals::Signals;
use roadmill::model::SceneOptions;
use roadmill::problem::{Problem, Written};
use rustix::fs::OFlags;
use std::fs;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Writes a problem as a problem file, with its meshes in a folder beside it.
///
/// All is first written into a folder of its own beside the place where it is to be, and read from
/// there again, so that what comes to stand there is whole and the same problem. The meshes then get a place that nothing
/// has, and the problem file, which names it, takes its own in one step: whenever the process is killed, the problem
/// that is there has its meshes. Folders of meshes that no problem uses any more go at the end, or with the next import.
pub fn import(arguments: &ImportArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let mut place = Destination::of(&arguments.out)?;
    place.tidy();
    place.check(arguments.force)?;
    place.choose();
    // Listened to, so that a signal leaves no half of anything.
    let signals = Signals::listen().map_err(Failure::system)?;
    let mut written = problem.to_toml(&place.meshes);
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
    place.remove_unused(if result.is_ok() { &place.folders } else { &place.folders[..1] });
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
    /// What the names of folders of meshes begin with.
    meshes_name: String,
    /// The name of the folder of the meshes.
    meshes: String,
    /// The names of folders that have no use any more once the import is over, unless the problem file that is then
    /// there names them: first the new one, then those that imports before have used.
    folders: Vec<String>,
    staged: PathBuf,
}

/// The file in the staged folder that has the names of [`Destination::folders`], each ended by a zero.
const FOLDERS: &str = "folders";

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
        Ok(Destination {
            folder,
            file_name: name.to_owned(),
            meshes: meshes_name.clone(),
            meshes_name,
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
                let folders = folders.filter(|name| self.is_meshes(name)).map(str::to_owned);
                self.remove_unused(&folders.collect::<Vec<_>>());
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }

    /// Whether an import to this place may give a folder of meshes this name.
    fn is_meshes(&self, name: &str) -> bool {
        name.strip_prefix(&self.meshes_name).is_some_and(|rest| {
            let number = rest.strip_prefix('-').and_then(|number| number.parse::<u64>().ok());
            rest.is_empty() || number.is_some_and(|number| rest == format!("-{number}"))
        })
    }

    /// Nothing is replaced without `force`, and with it only what an import may have written.
    fn check(&self, force: bool) -> Result<(), Failure> {
        let meshes = self.folder.join(&self.meshes_name);
        for path in [&self.file(), &meshes] {
            if !force && fs::symlink_metadata(path).is_ok() {
                let message = format!("{}: exists already; --force replaces it", path.display());
                return Err(Failure::usage(message));
            }
        }
        let replaceable = fs::symlink_metadata(&meshes).is_err() || has_meshes_only(&meshes);
        if replaceable && !self.file().is_dir() {
            return Ok(());
        }
        let path = if replaceable { self.file() } else { meshes };
        let message =
            format!("{}: holds other things than an import's; not replaced", path.display());
        Err(Failure::usage(message))
    }

    /// Chooses a name for the folder of the meshes that nothing has yet, and finds those that imports before have used.
    fn choose(&mut self) {
        let name = |number: u64| match number {
            1 => self.meshes_name.clone(),
            _ => format!("{}-{number}", self.meshes_name),
        };
        let is_free = |name: &String| fs::symlink_metadata(self.folder.join(name)).is_err();
        let free = (1..).map(name).find(is_free).unwrap_or_default();
        let problem = fs::read_to_string(self.file()).unwrap_or_default();
        // Whatever has the plain name is replaced, as `check` allows; of others what the problem has used.
        let is_old = |name: &String| *name == self.meshes_name || names(&problem, name);
        let entries = fs::read_dir(folder_of(&self.file())).into_iter().flatten().flatten();
        let others = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let old = others.filter(|name| self.is_meshes(name)).filter(is_old);
        self.folders = std::iter::once(free.clone()).chain(old).collect();
        self.meshes = free;
    }

    /// Removes folders of meshes that the problem file does not name.
    fn remove_unused(&self, folders: &[String]) {
        let problem = match fs::read_to_string(self.file()) {
            Ok(problem) => problem,
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            Err(_) => return,
        };
        for name in folders.iter().filter(|name| !names(&problem, name)) {
            let folder = self.folder.join(name);
            if has_meshes_only(&folder) {
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(folder);
            }
        }
    }

    fn fill(&self, written: &Written) -> Result<(), Failure> {
        let meshes = self.staged.join(&self.meshes);
        let write = || {
            fs::create_dir(&self.staged)?;
            fs::write(self.staged.join(&self.file_name), &written.text)?;
            let folders: String = self.folders.iter().map(|name| format!("{name}\0")).collect();
            fs::write(self.staged.join(FOLDERS), folders)?;
            if !written.files.is_empty() {
                fs::create_dir(&meshes)?;
            }
            written.files.iter().try_for_each(|(name, text)| fs::write(meshes.join(name), text))
        };
        write().map_err(|error| self.cannot(&error))
    }

    /// Puts what was written into its place: the meshes where nothing is, then, in one step, the problem file.
    fn move_in(&self, with_meshes: bool) -> Result<(), Failure> {
        let move_all = || {
            if with_meshes {
                let meshes = self.folder.join(&self.meshes);
                rename_to_free(&self.staged.join(&self.meshes), &meshes)?;
            }
            fs::rename(self.staged.join(&self.file_name), self.file())
        };
        move_all().map_err(|error| self.cannot(&error))
    }

    fn cannot(&self, error: &io::Error) -> Failure {
        cannot_write(&self.file(), error)
    }
}

/// Whether a folder has Wavefront files only, as the folders of meshes have that imports make.
fn has_meshes_only(folder: &Path) -> bool {
    let is_mesh = |entry: io::Result<fs::DirEntry>| {
        entry.is_ok_and(|entry| {
            let path = entry.path();
            path.is_file() && path.extension().is_some_and(|extension| extension == "obj")
        })
    };
    let is_folder = fs::symlink_metadata(folder).is_ok_and(|metadata| metadata.is_dir());
    is_folder && fs::read_dir(folder).is_ok_and(|mut entries| entries.all(is_mesh))
}

/// Whether a problem file names files in the folder; where its name may be written in several ways it always may.
fn names(problem: &str, folder: &str) -> bool {
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\'' | '\\');
    !folder.chars().all(is_plain) || problem.contains(&format!("{folder}/"))
}
