//! Where the files go, and what may be replaced there.

use crate::cli::DeformArguments;
use crate::commands::place::{check_page, check_place};
use crate::exit::Failure;
use crate::files::{cannot_write, folder_of, is_standard_output, make_empty};
use std::fs;
use std::path::Path;

/// The file of the obstacles beside those of the frames.
pub(super) const OBSTACLES: &str = "obstacles.obj";

/// The places of all files, looked at before any work is done.
pub(super) struct Places {
    force: bool,
}

impl Places {
    /// # Errors
    /// Exit code 2: something is there that is not to be replaced, or no file can be written there.
    pub fn of(arguments: &DeformArguments) -> Result<Places, Failure> {
        let DeformArguments { csv, obj, html, force, .. } = arguments;
        csv.as_deref().map_or(Ok(()), |file| check_place("--csv", file))?;
        html.as_deref().map_or(Ok(()), |file| check_page("--html", file))?;
        if csv.is_some() && csv == html {
            return Err(Failure::usage("--csv and --html name one file; two files expected"));
        }
        let files = [csv, html].into_iter().flatten().filter(|file| !is_standard_output(file));
        for file in files {
            let refused = |why: &str| Err(Failure::usage(format!("{}: {why}", file.display())));
            // Devices and pipes are written to, not replaced.
            if !force && file.is_file() {
                return refused("it is there already; --force replaces it");
            }
            let folder = folder_of(file);
            if obj.as_deref().is_some_and(|frames| is_same(frames, folder)) {
                return refused(
                    "the folder of --obj holds nothing but frames; another folder expected",
                );
            }
            if !folder.is_dir() {
                return refused("its folder is not there; a folder that is there expected");
            }
        }
        let places = Places { force: *force };
        obj.as_deref().map_or(Ok(()), |folder| places.check_folder(folder))?;
        Ok(places)
    }

    /// A folder for frames is not there, or is empty; with `--force` it may hold what an earlier call wrote.
    fn check_folder(&self, folder: &Path) -> Result<(), Failure> {
        if folder.exists() && !folder.is_dir() {
            let found = folder.display();
            return Err(Failure::usage(format!("--obj: {found} found, a file; a folder expected")));
        }
        let is_ours = |name: &String| is_ours(name) && folder.join(name).is_file();
        match names_in(folder).iter().find(|name| !(self.force && is_ours(name))) {
            None => Ok(()),
            Some(name) => Err(Failure::usage(format!(
                "{}: holds {name}; a new or an empty folder expected, or, with --force, one of frames",
                folder.display()
            ))),
        }
    }

    /// Makes a folder for frames, or empties one that was found fit before.
    pub fn empty_folder(&self, folder: &Path) -> Result<(), Failure> {
        self.check_folder(folder)?;
        for name in names_in(folder) {
            let file = folder.join(name);
            fs::remove_file(&file).map_err(|error| cannot_write(&file, &error))?;
        }
        make_empty(folder)
    }
}

/// Whether two names are of one folder, which need not be there.
fn is_same(one: &Path, other: &Path) -> bool {
    let absolute = |folder: &Path| {
        folder.canonicalize().or_else(|_| std::path::absolute(folder)).unwrap_or(folder.to_owned())
    };
    absolute(one) == absolute(other)
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

/// Whether a file has a name that this command gives.
fn is_ours(name: &str) -> bool {
    let number = name.strip_prefix("frame-").and_then(|rest| rest.strip_suffix(".obj"));
    let is_frame =
        |number: &str| number.len() >= 4 && number.bytes().all(|digit| digit.is_ascii_digit());
    name == OBSTACLES || number.is_some_and(is_frame)
}
