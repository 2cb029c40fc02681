//! What the page is about: the run, and what its energies are.

use super::super::markup::escaped;
use super::Report;
use std::fmt::Write;

/// The title, a list of what identifies the run, and what its numbers mean.
pub(super) fn section(report: &Report) -> String {
    let Report { problem, roadmap, .. } = *report;
    let mut html = format!("<header><h1>{}</h1>\n<dl>\n", escaped(problem.name()));
    let mut entry = |term: &str, text: &str| {
        writeln!(html, "<div><dt>{term}</dt><dd>{}</dd></div>", escaped(text)).expect("memory");
    };
    entry("the build ended", report.end);
    let (sets, components) = (roadmap.sets() as usize, roadmap.components().count());
    let counts = [
        (sets, "set"),
        (roadmap.configs().len(), "node"),
        (roadmap.edges().len(), "edge"),
        (components, "component"),
    ];
    let counts = counts.map(|(count, what)| match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    });
    let size = counts.join(", ");
    entry("roadmap", &size);
    entry("seed", &problem.seed().to_string());
    entry("degrees of freedom", &report.cx.space.len().to_string());
    entry("program", report.program);
    entry("digest of the problem", &problem.digest().to_string());
    entry("digest of the roadmap", &roadmap.digest().to_string());
    html += "</dl>\n";
    if let Some(molecule) = problem.model.description().molecule() {
        let meaning = escaped(molecule.about_energies());
        writeln!(html, "<p class=\"meaning\">{meaning}</p>").expect("memory");
    } else if problem.model.description().node_values().iter().any(|value| value.name == "energy") {
        let unit = escaped(report.energy_unit());
        writeln!(
            html,
            "<p class=\"meaning\">Energies and costs are in the problem's own unit, {unit}; lengths and distances in its space's metric.</p>"
        )
        .expect("memory");
    } else {
        html += "<p class=\"meaning\">The model has no energies. Lengths, distances and costs are in its space's metric.</p>\n";
    }
    html + "</header>\n"
}
