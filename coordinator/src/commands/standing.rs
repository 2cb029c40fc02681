//! What `status` says of a relaxation.

use crate::cli::StatusArguments;
use crate::exit::{Code, Failure};
use crate::output::{self, Plain};
use crate::work::relaxing::{AtWork, BookLevel, Standing};
use serde::Serialize;
use std::fmt;
use std::thread::sleep;
use std::time::Duration;

const PAUSE: Duration = Duration::from_millis(500);

/// How a relaxation stands.
#[derive(Serialize, PartialEq)]
struct Told {
    event: &'static str,
    folder: String,
    problem: String,
    seed: u64,
    /// What is relaxed, as the problem says it.
    kind: Option<&'static str>,
    levels: Vec<LevelTold>,
    /// `running`, `held` (on another host), `killed`, `stopped`, or how the loop ended.
    state: String,
    reason: String,
    /// How the loop goes on, where it does.
    #[serde(skip)]
    way_on: Option<String>,
}

/// A level that was tried, or is being tried.
#[derive(Serialize, PartialEq)]
struct LevelTold {
    number: u32,
    level: f64,
    /// By how much it is relaxed, for people.
    amount: String,
    guide: String,
    of: Option<u32>,
    /// `solved`, `unsolved`, `invalid-ends`; `null` while it is not done.
    outcome: Option<String>,
    nodes: Option<u64>,
    folder: Option<String>,
}

/// Says how far a relaxation is.
pub(super) fn status(arguments: &StatusArguments) -> Result<Code, Failure> {
    let mut standing = Standing::read(&arguments.run)?;
    let mut last: Option<Told> = None;
    loop {
        let told = Told::of(&standing);
        let is_over = !matches!(&*told.state, "running" | "held");
        if last.as_ref() != Some(&told) {
            let is_read = match (arguments.json, arguments.watch && !is_over) {
                (true, _) => output::json(&told),
                (false, true) => output::line(told.line()),
                (false, false) => output::lines(&told),
            };
            if !is_read {
                return Ok(Code::Done);
            }
        }
        last = Some(told);
        if !arguments.watch || is_over {
            return Ok(Code::Done);
        }
        sleep(PAUSE);
        standing.read_on()?;
    }
}

impl Told {
    fn of(standing: &Standing) -> Told {
        let tried = standing.book.levels.iter().map(|level| LevelTold::done(standing, level));
        let at_work = standing.at_work.as_ref().map(|level| LevelTold::at_work(standing, level));
        let (state, reason, goes_on) = state(standing);
        let folder = standing.folder().display().to_string();
        Told {
            event: "relaxation-status",
            problem: standing.problem().name().to_owned(),
            seed: standing.problem().seed(),
            kind: standing.kind().map(|kind| kind.name()),
            levels: tried.chain(at_work).collect(),
            state,
            reason,
            way_on: goes_on.then(|| format!("roadmill resume {folder}")),
            folder,
        }
    }

    /// In one line: the level that was tried last, or is being tried.
    fn line(&self) -> String {
        let state = Plain(&self.state);
        match self.levels.last() {
            Some(level) => format!("{state}: level {}: {level}", level.number),
            None => format!("{state}: no level"),
        }
    }
}

/// The state in a word, the same for people, and whether the loop can go on by a command.
fn state(standing: &Standing) -> (String, String, bool) {
    let holder = standing.holder.as_ref().map_or_else(String::new, ToString::to_string);
    let book = &standing.book;
    let count = book.levels.len();
    let plural = if count == 1 { "" } else { "s" };
    let stopped = standing.at_work.as_ref().and_then(|level| level.stopped.as_ref());
    match (standing.is_held(), &book.end, stopped) {
        (Some(true), ..) => ("running".to_owned(), holder, false),
        (None, ..) => ("held".to_owned(), holder, false),
        (_, Some(end), _) => {
            let path = match end == "solved" {
                true => "; the path is in path.csv of the folder",
                false => "",
            };
            (end.clone(), format!("{count} level{plural} tried{path}"), false)
        }
        (_, None, Some((word, reason))) => (word.clone(), reason.clone(), true),
        (_, None, None) if standing.holder.is_some() => {
            ("killed".to_owned(), "nobody works on it".to_owned(), true)
        }
        (_, None, None) => ("stopped".to_owned(), "nobody works on it".to_owned(), true),
    }
}

impl LevelTold {
    fn done(standing: &Standing, level: &BookLevel) -> LevelTold {
        LevelTold {
            number: level.number,
            level: level.level,
            amount: standing.amount_at(level.level),
            guide: level.guide.clone(),
            of: level.of,
            outcome: Some(level.outcome.clone()),
            nodes: level.built.as_ref().map(|built| built.nodes),
            folder: level.folder.clone(),
        }
    }

    fn at_work(standing: &Standing, level: &AtWork) -> LevelTold {
        LevelTold {
            number: level.number,
            level: level.level,
            amount: standing.amount_at(level.level),
            guide: level.guide.to_owned(),
            of: level.of,
            outcome: None,
            nodes: level.folder.as_ref().map(|_| level.nodes),
            folder: level.folder.clone(),
        }
    }
}

/// All but its number.
impl fmt::Display for LevelTold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {:.4}, {}", self.level, Plain(&self.amount))?;
        if let Some(of) = self.of {
            write!(f, ", helped by {} of level {of}", Plain(&self.guide))?;
        }
        match &self.outcome {
            Some(outcome) => write!(f, ": {}", Plain(outcome))?,
            None => f.write_str(": not done")?,
        }
        if let Some(nodes) = self.nodes {
            write!(f, ", {nodes} nodes")?;
        }
        match &self.folder {
            Some(folder) => write!(f, ", in {}", Plain(folder)),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = self.kind.unwrap_or("nothing");
        writeln!(f, "problem     {} (seed {})", Plain(&self.problem), self.seed)?;
        writeln!(f, "relaxation  {kind}, in {}", Plain(&self.folder))?;
        for level in &self.levels {
            writeln!(f, "level {:<5} {level}", level.number)?;
        }
        write!(f, "state       {}: {}", Plain(&self.state), Plain(&self.reason))?;
        match &self.way_on {
            Some(way) => write!(f, "\nto go on    {}", Plain(way)),
            None => Ok(()),
        }
    }
}
