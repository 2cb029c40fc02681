//! The paths in numbers: what each comes to, how far they are apart, in which order contacts form.

use super::super::markup::escaped;
use super::super::palette::colour;
use super::Report;
use super::along::Along;
use crate::pathways::{FormedContact, Pathway};
use std::fmt::Write;

/// Bounds of the shares of a path's length by which contacts are counted.
const FIFTHS: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// The section of the table of paths and of their distances.
pub(super) fn section(report: &Report) -> String {
    let found = report.pathways;
    let mut html = String::from("<section id=\"paths\"><h2>The paths</h2>\n");
    writeln!(html, "<p>{}</p>", escaped(report.asked)).expect("memory");
    if found.pathways.is_empty() {
        html += match found.connected {
            true => {
                "<p class=\"warning\">No path: every path between the ends that was tried has an edge that fails the finer check.</p>\n"
            }
            false => {
                "<p class=\"warning\">No path: nothing joins the start and the goal yet, neither the roadmap nor the direct motion.</p>\n"
            }
        };
        return html + "</section>\n";
    }
    let (energy, cost, length) = (report.energy_unit(), report.cost_unit(), report.length_unit());
    let heads = [
        "path".to_owned(),
        format!("barrier [{energy}]"),
        format!("cost [{cost}]"),
        format!("barrier back [{energy}]"),
        format!("cost back [{cost}]"),
        format!("peak [{energy}]"),
        format!("length [{length}]"),
        "configurations".to_owned(),
        "frames".to_owned(),
    ];
    html += "<div class=\"scroll\"><table><thead><tr>";
    for head in &heads {
        write!(html, "<th>{}</th>", escaped(head)).expect("memory");
    }
    html += "</tr></thead><tbody>\n";
    for (index, Pathway { path, measured, frames }) in found.pathways.iter().enumerate() {
        let number =
            |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
        writeln!(
            html,
            "<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td><td>{}</td><td>{:.2}</td><td>{}</td><td>{:.2}</td><td>{}</td><td>{:.2}</td><td>{}</td><td>{}</td></tr>",
            colour(index),
            index + 1,
            number(measured.there.barrier),
            measured.there.cost,
            number(measured.back.barrier),
            measured.back.cost,
            number(measured.peak),
            frames.length(),
            path.configs.len(),
            frames.len(),
        )
        .expect("memory");
    }
    html += "</tbody></table></div>\n<p>";
    if found.pathways[0].measured.peak.is_some() {
        html += "A barrier is the highest energy on the path above the energy at departure, a cost the sum of what its motions cost \
            in that direction. ";
    }
    writeln!(
        html,
        "{} candidates were looked at closely{}.</p>",
        found.tried,
        match found.dropped_edges {
            0 => String::new(),
            1 => "; 1 edge failed the finer check and was left out".to_owned(),
            dropped => format!("; {dropped} edges failed the finer check and were left out"),
        }
    )
    .expect("memory");
    html += &matrix(report);
    html + "</section>\n"
}

/// The Fréchet distances above the diagonal, the Hausdorff distances below.
fn matrix(report: &Report) -> String {
    let found = report.pathways;
    let count = found.pathways.len();
    if count < 2 {
        return String::new();
    }
    let mut html = format!(
        "<h3>How far they are apart [{}]</h3>\n<p>Above the diagonal the discrete Fréchet distance: the shortest leash with which two \
         can walk both paths from beginning to end. Below it the Hausdorff distance, which asks for no order. In brackets the two frames \
         whose distance it is, of the path of the row and of that of the column.</p>\n",
        escaped(report.length_unit())
    );
    html += "<div class=\"scroll\"><table><thead><tr><th></th>";
    for column in 0..count {
        write!(html, "<th>path {}</th>", column + 1).expect("memory");
    }
    html += "</tr></thead><tbody>\n";
    for row in 0..count {
        write!(html, "<tr><th>path {}</th>", row + 1).expect("memory");
        for column in 0..count {
            let [first, second] = [row.min(column), row.max(column)];
            let pair = found.pairs.iter().find(|pair| (pair.first, pair.second) == (first, second));
            let Some(pair) = pair else {
                html += "<td></td>";
                continue;
            };
            let (of, frames) = match row < column {
                true => (pair.frechet, [pair.frechet.first, pair.frechet.second]),
                false => (pair.hausdorff, [pair.hausdorff.second, pair.hausdorff.first]),
            };
            write!(
                html,
                "<td>{:.2} <small>({}, {})</small></td>",
                of.value,
                frames[0] + 1,
                frames[1] + 1
            )
            .expect("memory");
        }
        html += "</tr>\n";
    }
    html + "</tbody></table></div>\n"
}

/// The section of the contacts of the goal, of molecules.
pub(super) fn contacts(report: &Report, tables: &[Along]) -> String {
    if report.problem.model.description().molecule().is_none() || tables.is_empty() {
        return String::new();
    }
    let mut html = String::from("<section id=\"contacts\"><h2>In which order contacts form</h2>\n");
    html += "<p>Contacts of the goal: Cα at most 7 Å apart, of residues at least four places apart along the chain. Counted is the share of \
        the path's length from which on a contact is never broken again.</p>\n";
    html += "<div class=\"scroll\"><table><thead><tr><th>path</th><th>contacts</th><th>never broken</th>";
    for bounds in FIFTHS.windows(2) {
        write!(html, "<th>{:.0}–{:.0} %</th>", 100.0 * bounds[0], 100.0 * bounds[1])
            .expect("memory");
    }
    html += "</tr></thead><tbody>\n";
    for (index, table) in tables.iter().enumerate() {
        let contacts = &table.table.contacts;
        let never = contacts.iter().filter(|contact| contact.share == 0.0).count();
        write!(
            html,
            "<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td><td>{}</td><td>{never}</td>",
            colour(index),
            index + 1,
            contacts.len()
        )
        .expect("memory");
        for bounds in FIFTHS.windows(2) {
            let is_here =
                |contact: &&FormedContact| contact.share > bounds[0] && contact.share <= bounds[1];
            write!(html, "<td>{}</td>", contacts.iter().filter(is_here).count()).expect("memory");
        }
        html += "</tr>\n";
    }
    html += "</tbody></table></div>\n";
    for (index, table) in tables.iter().enumerate() {
        let forming: Vec<&FormedContact> =
            table.table.contacts.iter().filter(|contact| contact.share > 0.0).collect();
        if forming.is_empty() {
            continue;
        }
        write!(html, "<details><summary>path {}, one after the other</summary><p>", index + 1)
            .expect("memory");
        let listed: Vec<String> = (forming.iter())
            .map(|contact| {
                let [first, second] = [&contact.first, &contact.second].map(|name| escaped(name));
                format!("{first}–{second} ({:.0} %)", 100.0 * contact.share)
            })
            .collect();
        html += &listed.join(", ");
        html += "</p></details>\n";
    }
    html + "</section>\n"
}
