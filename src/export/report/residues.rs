//! How far each residue moves.

use super::super::palette::COLOURS;
use super::Report;
use super::chart::{Chart, Series};
use crate::model::Scratch;
use crate::pathways::Frames;
use crate::structure::Point;
use crate::structure::measure::superpose;

/// How far the Cα of each residue moves, Å.
pub(super) struct Motion {
    /// From the start to the goal, after superposition.
    pub ends: Vec<f64>,
    /// The farthest from the start on the best path, every frame superposed on the start.
    farthest: Vec<f64>,
    /// The way gone on the best path: the sum from frame to frame, each superposed on the one before.
    travelled: Vec<f64>,
}

impl Motion {
    /// The motion of a model that has Cα; `None` of any other.
    pub fn of(report: &Report, scratch: &mut Scratch) -> Option<Motion> {
        let model = &report.cx.model;
        let start = model.shape(&report.ends.start, scratch)?;
        let goal = model.shape(&report.ends.goal, scratch)?;
        let ends = displacements(&start, &goal);
        let [mut farthest, mut travelled] = [vec![0.0; start.len()], vec![0.0; start.len()]];
        let best: Option<&Frames> = report.pathways.pathways.first().map(|best| &best.frames);
        let mut before: Option<Vec<Point>> = None;
        for q in best.into_iter().flat_map(|frames| frames.configs.iter()) {
            let here = model.shape(q, scratch)?;
            for (farthest, moved) in farthest.iter_mut().zip(displacements(&start, &here)) {
                *farthest = moved.max(*farthest);
            }
            if let Some(before) = &before {
                let steps = displacements(before, &here);
                travelled.iter_mut().zip(steps).for_each(|(sum, step)| *sum += step);
            }
            before = Some(here);
        }
        Some(Motion { ends, farthest, travelled })
    }
}

/// How far points are from those of the same index after superposition.
fn displacements(fixed: &[Point], moved: &[Point]) -> Vec<f64> {
    let motion = superpose(moved, fixed);
    fixed.iter().zip(moved).map(|(a, b)| (motion.apply(b) - a).norm()).collect()
}

/// The section of the motion of residues.
pub(super) fn section(report: &Report, motion: &Motion) -> String {
    let Some(molecule) = report.problem.model.description().molecule() else {
        return String::new();
    };
    let residues = molecule.chains_at(&report.ends.start).swap_remove(0);
    let mut html = String::from("<section id=\"residues\"><h2>How far each residue moves</h2>\n");
    html += "<p>Distances of Cα in Å. <em>Between the ends</em>: the goal superposed on the start by all Cα. <em>Farthest</em>: the \
        largest distance from the start on path 1, every frame superposed on the start. <em>Way gone</em>: the sum of the distances \
        from frame to frame of path 1, each frame superposed on the one before; where it is far above the others, the residue goes \
        to and fro.</p>\n";
    let points = |values: &[f64]| -> Vec<[f64; 2]> {
        let both = residues.iter().zip(values);
        both.map(|(residue, value)| [f64::from(residue.number.number), *value]).collect()
    };
    let line = |name: &str, colour: usize, dashed: bool, values: &[f64]| Series {
        name: name.to_owned(),
        colour: COLOURS[colour],
        dashed,
        points: points(values),
    };
    let mut series = Vec::new();
    let has_path = !report.pathways.pathways.is_empty();
    if has_path {
        series.push(line("farthest on path 1", 0, false, &motion.farthest));
    }
    // Over the other line, which often hides it.
    series.push(line("between the ends", 7, has_path, &motion.ends));
    let chart = |title: &str, series| Chart {
        title: title.to_owned(),
        axes: ["number of the residue", "distance of Cα [Å]"].map(str::to_owned),
        series,
        levels: Vec::new(),
    };
    html += "<div class=\"charts\">\n";
    html += &chart("Displacement", series).html();
    if has_path {
        let series = vec![
            line("way gone on path 1", 1, false, &motion.travelled),
            line("farthest on path 1", 0, false, &motion.farthest),
        ];
        html += &chart("Way gone", series).html();
    }
    html + "</div></section>\n"
}
