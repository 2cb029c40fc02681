//! The report of a run: one page of HTML with everything in it, for any browser, without a network.
//!
//! One file per section. `docs/report.md` says what each picture means. Sections that a model has nothing for are left out: a
//! landscape has no residues, a robot no energies.
//!
//! `3Dmol-min.js` is 3Dmol.js 2.5.5 (N. Rego & D. Koes, *3Dmol.js: molecular visualization with WebGL*, Bioinformatics 31 (2015)
//! 1322) as its package has it, 0.54 MB, under the BSD 3-clause licence in `3Dmol-LICENSE.txt`. It shows the structures.

mod along;
pub(super) mod chart;
mod comparison;
mod folding;
mod growth;
mod header;
mod map;
mod order;
mod profiles;
mod residues;
mod rounds;
pub(super) mod shell;
mod structures;
mod tables;

#[cfg(test)]
mod tests;

pub use comparison::{ComparedBuild, ComparedStrategy, Comparison};
pub use folding::Folding;
pub use rounds::{RoundOutcome, RoundValue};

use crate::context::{Context, Ends};
use crate::model::Scratch;
use crate::pathways::{DomainAngle, Pathways};
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use along::Along;
use residues::Motion;

/// What plays the structures.
const VIEWER: &str = include_str!("viewer.js");

/// What a report is made of.
pub struct Report<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The problem made ready for work.
    pub cx: &'a Context,
    /// The roadmap.
    pub roadmap: &'a Roadmap,
    /// Where the paths begin and end.
    pub ends: &'a Ends,
    /// The paths, the best first; there may be none.
    pub pathways: &'a Pathways,
    /// How paths were looked for, in a sentence.
    pub asked: &'a str,
    /// Angles between domains, of molecules: the first two are the axes of the map, all are shown along the paths.
    pub angles: &'a [DomainAngle],
    /// In which order the parts of a native structure form, of a protein about one.
    pub folding: Option<Folding<'a>>,
    /// What the build came to at the end of every round, in their order.
    pub rounds: &'a [RoundOutcome],
    /// Which program made the roadmap.
    pub program: &'a str,
    /// Why the build ended.
    pub end: &'a str,
}

impl Report<'_> {
    fn energy_unit(&self) -> &'static str {
        let values = self.problem.model.description().node_values();
        values.iter().find(|value| value.name == "energy").map_or("1", |value| value.unit)
    }

    fn cost_unit(&self) -> &'static str {
        self.problem.model.description().cost_unit()
    }

    /// Of lengths and distances of paths.
    fn length_unit(&self) -> &'static str {
        match self.problem.model.description().molecule() {
            Some(_) => "Å",
            None => "length",
        }
    }
}

/// The page: HTML without references to other files, for any browser; the structures want WebGL. The same bytes for the
/// same arguments.
///
/// Nothing in it is computed anew that the ledger says. Pictures are SVG with one decimal of a pixel; structures are kept to
/// 0.01 Å where they fit.
pub fn report(report: &Report, scratch: &mut Scratch) -> String {
    if report.folding.is_some() && report.pathways.pathways.is_empty() {
        // Without a pathway there are no ends to show anything between.
        let sections = [folding::section(report), growth::section(report)].concat();
        return page(
            report.problem.name(),
            &format!("{}<main>\n{sections}</main>\n", header::section(report)),
        );
    }
    let tables = Along::all(report, scratch);
    let motion = Motion::of(report, scratch);
    let mut body = header::section(report);
    body += "<main>\n";
    body += &folding::section(report);
    body += &tables::section(report);
    let mut scripts = String::new();
    if let Some(motion) = &motion
        && let Some((html, data)) = structures::section(report, &tables, motion)
    {
        body += &html;
        if let Some(data) = data {
            scripts = shell::viewer(&data, VIEWER);
        }
    }
    body += &map::section(report, scratch);
    body += &profiles::section(report, &tables);
    if let Some(motion) = &motion {
        body += &residues::section(report, motion);
    }
    body += &tables::contacts(report, &tables);
    body += &growth::section(report);
    body += "</main>\n";
    body += &scripts;
    page(report.problem.name(), &body)
}

/// The page about a problem of this name, with a body.
fn page(name: &str, body: &str) -> String {
    shell::page(name, "", body)
}
