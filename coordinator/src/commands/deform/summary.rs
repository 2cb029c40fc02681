//! What a query for a deformed path came to, in words.

use roadmill::deformation::{Between, DeformedPath, DeformingAnswer, RemovedEdge};

/// How many removed edges are listed one by one.
const LISTED: usize = 5;

/// The terms that a page has of its own, or must not have since they are not the same every time.
pub(super) const LEFT_OUT: [&str; 5] = [BETWEEN, MOVEMENT, ENERGY, VOLUME, CPU_TIME];

const BETWEEN: &str = "between frames";
const MOVEMENT: &str = "movement";
const ENERGY: &str = "energy";
const VOLUME: &str = "volume";
const CPU_TIME: &str = "CPU time";

/// CPU seconds of a query, and of these those of deforming.
#[derive(Clone, Copy)]
pub(super) struct Seconds {
    pub all: f64,
    pub deforming: f64,
}

/// What there is to say of an answer: terms, each with a text. `legs` says that the path was given, and its edges are legs of it.
pub(super) fn summary(
    answer: &DeformingAnswer,
    method: &str,
    (legs, seconds): (bool, Seconds),
) -> Vec<(&'static str, String)> {
    let mut facts = vec![("method", method.to_owned())];
    if let Ok(path) = &answer.path {
        facts.extend(of_path(path, answer, legs));
    }
    let took = answer.deformations;
    facts.push((
        "deformations",
        format!(
            "{} tried, {} failed; free at rest at {} more configurations; {} blends tested",
            took.tried, took.failed, took.at_rest, took.blends
        ),
    ));
    let (edges, removed) = (answer.deformed_edges, answer.removed.len());
    match legs {
        true => facts.push(("legs", format!("{edges} deformed, {removed} refused"))),
        false => {
            let searches = match answer.searches {
                1 => "one search".to_owned(),
                searches => format!("{searches} searches"),
            };
            let text = format!("{edges} deformed, {removed} removed, in {searches} for a path");
            facts.push(("edges", text));
        }
    }
    facts.extend(answer.removed.iter().take(LISTED).map(|edge| ("refused", refused(edge, legs))));
    if removed > LISTED {
        facts.push(("", format!("and {} more", removed - LISTED)));
    }
    let Seconds { all, deforming } = seconds;
    let share = if all > 0.0 { 100.0 * deforming / all } else { 0.0 };
    facts.push((CPU_TIME, format!("{all:.3} s, of which {share:.1} % went into deforming")));
    facts
}

fn of_path(
    path: &DeformedPath,
    answer: &DeformingAnswer,
    legs: bool,
) -> [(&'static str, String); 5] {
    let (frames, edges) = (path.frames.len(), path.edges);
    let blends = path.frames.iter().filter(|frame| frame.is_blend).count();
    let along = match legs {
        true => counted(edges, "leg"),
        false => format!("{} of weight {:.6} in all", counted(edges, "edge"), answer.weight),
    };
    let between = match path.between {
        Between::Proved { clearance } => {
            format!("proved free: no point comes nearer than {clearance:.3e} to an obstacle")
        }
        Between::Sampled => "sampled: nothing is known of the motion between frames".to_owned(),
    };
    let [least, greatest] = path.volumes().map(|share| 100.0 * share);
    [
        ("path", format!("{along}; {}, {blends} of them blends", counted(frames, "frame"))),
        (BETWEEN, between),
        (MOVEMENT, format!("a vertex moves at most {:.3e} at once", path.largest_movement())),
        (ENERGY, format!("{:.6} at most", path.highest_energy())),
        (VOLUME, format!("{least:.2} % to {greatest:.2} % of that at rest")),
    ]
}

/// `1 edge`, `2 edges`.
fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

fn refused(edge: &RemovedEdge, legs: bool) -> String {
    let RemovedEdge { ends: [from, to], weight, refusal } = edge;
    match legs {
        true => format!("from configuration {} to {}: {refusal}", from.0 + 1, to.0 + 1),
        false => format!("from node {from} to {to}, of weight {weight:.6}: {refusal}"),
    }
}
