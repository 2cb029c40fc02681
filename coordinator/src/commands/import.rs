use super::load::load;
use super::say;
use crate::cli::ImportArguments;
use crate::exit::{Code, Failure};
use crate::run::Ledgers;
use roadmill::model::SceneOptions;
use roadmill::problem::{Problem, Written};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes a problem as a problem file, with its meshes in a folder beside it.
///
/// All is first written into a folder of its own beside the place where it is to be, and read from
/// there again, so that what comes to stand there is whole and the same problem.
pub fn import(arguments: &ImportArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let place = Place::of(&arguments.out)?;
    place.check(arguments.force)?;
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
        place.move_in(!written.files.is_empty())
    });
    // Also what was replaced.
    let _ = fs::remove_dir_all(&place.staged);
    result?;
    problem.notes().iter().for_each(|note| eprintln!("{}: {note}", problem.name()));
    say(format_args!("problem digest   {}", problem.digest()));
    Ok(Code::Done)
}

/// Where the files go.
struct Place {
    folder: PathBuf,
    file_name: String,
    meshes_name: String,
    staged: PathBuf,
}

impl Place {
    fn of(out: &Path) -> Result<Place, Failure> {
        let name = out.file_name().and_then(|name| name.to_str());
        let stem = name.and_then(|name| name.strip_suffix(".toml")).filter(|stem| !stem.is_empty());
        let (Some(name), Some(stem)) = (name, stem) else {
            let message = format!("--out: {} found; a NAME.toml expected", out.display());
            return Err(Failure::usage(message));
        };
        let folder = out.parent().unwrap_or(Path::new("")).to_owned();
        let staged = folder.join(format!(".{name}.{}", std::process::id()));
        let meshes_name = format!("{stem}-meshes");
        Ok(Place { folder, file_name: name.to_owned(), meshes_name, staged })
    }

    fn file(&self) -> PathBuf {
        self.folder.join(&self.file_name)
    }

    fn meshes(&self) -> PathBuf {
        self.folder.join(&self.meshes_name)
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

    /// Moves what is there out of the way, into the staged folder, and what was written into its place;
    /// or, where that fails, back.
    fn move_in(&self, with_meshes: bool) -> Result<(), Failure> {
        let moves = || {
            for (path, name) in [(self.file(), "old.toml"), (self.meshes(), "old-meshes")] {
                match fs::rename(path, self.staged.join(name)) {
                    Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                    _ => {}
                }
            }
            if with_meshes {
                fs::rename(self.staged.join(&self.meshes_name), self.meshes())?;
            }
            fs::rename(self.staged.join(&self.file_name), self.file())
        };
        moves().map_err(|error| {
            if with_meshes {
                let _ = fs::rename(self.meshes(), self.staged.join(&self.meshes_name));
            }
            let _ = fs::rename(self.staged.join("old-meshes"), self.meshes());
            let _ = fs::rename(self.staged.join("old.toml"), self.file());
            self.cannot(&error)
        })
    }

    fn cannot(&self, error: &io::Error) -> Failure {
        Failure::usage(format!("{}: cannot write: {error}", self.file().display()))
    }
}
