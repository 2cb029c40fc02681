//! The page of a ligand's poses at a protein: one page of HTML with everything in it, for any browser, without a network.
//!
//! `data.rs` makes the data of the viewer, `charts.rs` the pictures, `table.rs` the table of poses; `viewer.js` shows them by the
//! library 3Dmol.js, which the report of a run brings along.

mod charts;
mod data;
mod table;
#[cfg(test)]
mod tests;

use super::markup::escaped;
use super::palette;
use super::report::shell;
use crate::structure::Point;
use std::fmt::Write;

/// What shows the poses.
const VIEWER: &str = include_str!("viewer.js");

/// Styles beside those of all pages.
const STYLE: &str = include_str!("style.css");

/// The viewer with its controls, and the table's place beside it.
const STAGE: &str = include_str!("stage.html");

/// What the page of poses is made of. Positions are in Å in the frame of the protein's file, energies in kJ/mol.
#[derive(Clone, Copy, Debug)]
pub struct PosesPage<'a> {
    /// What the page is about: the complex.
    pub title: &'a str,
    /// What identifies the run and its numbers: terms, each with a text.
    pub facts: &'a [(&'a str, String)],
    /// What energies and scores are, in a sentence or two.
    pub meaning: &'a str,
    /// The protein as a PDB file.
    pub protein: &'a str,
    /// The poses, the best first.
    pub poses: &'a [ShownPose],
    /// The pose that the ligand has in a structure, as an SDF record, if there is one.
    pub reference: Option<&'a str>,
    /// The energy of the reference pose.
    pub reference_energy: Option<f64>,
    /// All minima that were found.
    pub minima: &'a [Minimum],
    /// The energies of all configurations before descent, in any order.
    pub before: &'a [f64],
    /// The energies after descent, in any order.
    pub after: &'a [f64],
}

/// A pose, as a page shows it.
#[derive(Clone, Debug)]
pub struct ShownPose {
    /// What it is called.
    pub label: String,
    /// The ligand as an SDF record.
    pub sdf: String,
    /// Its energy.
    pub energy: f64,
    /// The mean energy of configurations near it.
    pub score: f64,
    /// Its cluster, counted from 0.
    pub cluster: usize,
    /// How many minima the cluster has.
    pub population: usize,
    /// The highest energy on the way out, if there is one.
    pub peak: Option<f64>,
    /// How far the way out rises above its energy, if there is one.
    pub barrier: Option<f64>,
    /// Its symmetry-corrected RMSD from the reference as both stand, in Å.
    pub rmsd: Option<f64>,
    /// A way out of the pocket, from the pose on; may be empty.
    pub way_out: Vec<WayFrame>,
}

/// The ligand on its way out of a pocket.
#[derive(Clone, Debug)]
pub struct WayFrame {
    /// Where its atoms are, in the order of the pose's SDF record.
    pub positions: Vec<Point>,
    /// How far it is along the way, in Å.
    pub along: f64,
    /// Its energy.
    pub energy: f64,
}

/// A minimum, as a point of the funnel.
#[derive(Clone, Copy, Debug)]
pub struct Minimum {
    /// Its energy.
    pub energy: f64,
    /// Its RMSD from the reference, in Å, if there is one.
    pub rmsd: Option<f64>,
    /// The distance of the ligand's centre from that of the pose of lowest energy, in Å.
    pub distance: f64,
    /// Which of the shown poses it is, if any, counted from 0.
    pub pose: Option<usize>,
}

/// The page: HTML without references to other files; the structures want WebGL. The same bytes for the same arguments.
///
/// Numbers that are not finite are left out of the pictures and are a dash in the table. Ways out are kept to 0.01 Å where they fit.
pub fn poses_page(page: &PosesPage) -> String {
    let mut body = format!("<header><h1>{}</h1>\n<dl>\n", escaped(page.title));
    for (term, text) in page.facts {
        writeln!(body, "<div><dt>{}</dt><dd>{}</dd></div>", escaped(term), escaped(text))
            .expect("writing to memory cannot fail");
    }
    write!(body, "</dl>\n<p class=\"meaning\">{}</p></header>\n<main>\n", escaped(page.meaning))
        .expect("writing to memory cannot fail");
    if page.poses.is_empty() {
        body += "<p class=\"warning\">No pose was found.</p>\n";
    } else {
        let (before, after) = STAGE.split_once("ROADMILL_TABLE").expect("the stage has a table");
        for part in [before, &table::html(page), after, &charts::ways(page), "</section>\n"] {
            body += part;
        }
    }
    body += &charts::all(page);
    body += "</main>\n";
    if !page.poses.is_empty() {
        body += &shell::viewer(&data::json(page), VIEWER);
    }
    shell::page(page.title, STYLE, &body)
}

/// The colour of a cluster.
fn colour(cluster: usize) -> &'static str {
    palette::colour(cluster)
}
