//! A problem whose build begins with approximate paths.

use super::{Problem, ProblemError, StrategySpec};
use crate::connect::{AmongKind, UntilJoined};
use crate::generator::{GeneratorKind, HintPath, Hints};
use std::path::{Path, PathBuf};

/// The label of the strategy that goes by the paths.
const LABEL: &str = "hints";

impl Problem {
    /// This problem with one more strategy, `hints`, that goes by the approximate paths in these files (see [`Hints`]), the one that is trusted most first. It makes
    /// the first set, and its sets take turns with those of the problem's schedule. Without files it is the same problem.
    ///
    /// # Errors
    /// The first thing that is wrong with a file; a strategy `hints` that the problem has already; a validity function.
    pub fn with_hints(&self, files: &[PathBuf]) -> Result<Problem, ProblemError> {
        let [first, more @ ..] = files else { return Ok(self.clone()) };
        let refuse = |message: &str| Err(ProblemError::pathless(message.to_owned()));
        if self.strategies.iter().any(|strategy| strategy.label == LABEL) {
            return refuse("a strategy `hints` found beside hints; another label expected");
        }
        if self.function.is_some() {
            return refuse(
                "a validity function found; hints as a strategy of the problem expected",
            );
        }
        let paths = more.iter().map(|file| path_of(file)).collect();
        let hints = GeneratorKind::Hints(Hints { paths, ..Hints::new(path_of(first)) });
        let spec = StrategySpec::generated(LABEL, hints)
            .among(AmongKind::UntilJoined(UntilJoined::default()));
        let builder = self.to_builder();
        let labels = self.schedule.iter().map(|index| &self.strategies[index.index()].label);
        let builder = match self.adaptive {
            // Of strategies that are not known yet the first comes first.
            Some(_) => {
                let own = self.strategies.iter().map(StrategySpec::from);
                builder.strategies(std::iter::once(spec).chain(own))
            }
            None => builder
                .strategy(spec)
                .schedule(std::iter::once(LABEL).chain(labels.map(String::as_str))),
        };
        let problem = builder.build()?;
        let sources = [&self.sources[..], &problem.sources].concat();
        Ok(Problem { notes: self.notes.clone(), sources, ..problem })
    }
}

/// The path in a file that is named from the process's own folder.
fn path_of(file: &Path) -> HintPath {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    HintPath::of_file(absolute.to_string_lossy())
}
