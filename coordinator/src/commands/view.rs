use super::live;
use super::place::check_page;
use super::solved::run_in;
use crate::cli::ViewArguments;
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::output::note;
use crate::work::{Recorded, Run};
use roadmill::export::{Live, NamedPath, Viewer};
use roadmill::model::Scratch;
use roadmill::query::shorten;
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// How often a shortcut is tried on the path.
pub(super) const SHORTEN_TRIES: u32 = 200;

/// Writes a page in which a run can be walked around in, and opens it where there is a display.
pub fn view(arguments: &ViewArguments) -> Result<Code, Failure> {
    if arguments.live {
        return live::follow(arguments);
    }
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => usual_place(arguments)?,
    };
    check_page("--out", &out)?;
    let run = Run::at(run_in(&arguments.run)?).read()?;
    if arguments.clearance {
        run.expect_clearances_of_nodes()?;
    }
    let page = seen(&run, arguments.clearance, None, |viewer| viewer.page());
    let page = page.ok_or_else(|| cannot_be_drawn(&arguments.run, &run))?;
    write_whole(&out, &page)?;
    let (found, megabytes) = (out.display(), page.len() as f64 / 1e6);
    if !arguments.no_open && open(&out) {
        note(format_args!("{found}: {megabytes:.1} MB, opened in a browser"));
    } else {
        note(format_args!("{found}: {megabytes:.1} MB, to be opened in a browser"));
    }
    Ok(Code::Done)
}

/// `NAME-view.html` in the current folder, after the run folder's name.
fn usual_place(arguments: &ViewArguments) -> Result<PathBuf, Failure> {
    // The name of `.` or of `runs/..` stands only in the whole path.
    let name = match arguments.run.file_name() {
        Some(name) => Some(name.to_owned()),
        None => arguments.run.canonicalize().ok().and_then(|run| Some(run.file_name()?.to_owned())),
    };
    let mut name = name.ok_or_else(|| {
        Failure::usage(format!(
            "{}: found, a folder without a name; --out FILE.html expected beside it",
            arguments.run.display()
        ))
    })?;
    name.push("-view.html");
    Ok(PathBuf::from(name))
}

/// What a page shows of a run: its roadmap, the path of its own query made shorter, and as it was found.
pub(super) fn seen<T>(
    run: &Recorded,
    clearance: bool,
    live: Option<Live>,
    with: impl Fn(Viewer) -> T,
) -> T {
    let found = run.path();
    let short = found.map(|path| shorten(run.context(), path, SHORTEN_TRIES, &mut Scratch::new()));
    let mut paths = Vec::new();
    if let Some(path) = &short {
        paths.push(NamedPath { name: "path shortened", path });
    }
    if let Some(path) = found {
        paths.push(NamedPath { name: "path as found", path });
    }
    with(Viewer { problem: run.problem(), roadmap: run.roadmap(), paths: &paths, live, clearance })
}

pub(super) fn cannot_be_drawn(folder: &Path, run: &Recorded) -> Failure {
    let folder = folder.display();
    Failure::usage(match run.problem().model().description().molecule() {
        Some(_) => format!(
            "{folder}: a run about a protein found, which is no scene; `roadmill report {folder} --out report.html` shows it"
        ),
        None => format!("{folder}: this model cannot be drawn"),
    })
}

/// Opens a page in the browser that the desktop has chosen; whether that was done.
pub(super) fn open(page: &Path) -> bool {
    let has_display = ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|name| env::var_os(name).is_some_and(|value| !value.is_empty()));
    // A whole path, since one that begins with a dash would be an option.
    let page = page.canonicalize().ok().filter(|_| has_display);
    page.is_some_and(|page| {
        let null = Stdio::null;
        let opening =
            Command::new("xdg-open").arg(page).stdin(null()).stdout(null()).stderr(null()).spawn();
        // Some browsers stay until they are closed, and are not waited for.
        opening.is_ok()
    })
}
