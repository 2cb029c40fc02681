//! In which order the parts of a native structure form.

use super::super::markup::escaped;
use super::Report;
use crate::folding::{Formation, Native, Order, Settings};
use std::fmt::Write;

/// So many orders are listed.
const LISTED: usize = 12;

/// Side of a contact map, the room for numbers at its left and below it, and that at its other sides, in pixels.
const MAP: f64 = 190.0;
const ROOM: f64 = 34.0;
const EDGE: f64 = 10.0;

/// What is known of the folding of a protein.
#[derive(Clone, Copy, Debug)]
pub struct Folding<'a> {
    /// The native structure.
    pub native: &'a Native,
    /// What counts as formed, and what as unstructured.
    pub settings: &'a Settings,
    /// How its parts form; `None` where the time was up before all pathways were followed.
    pub formation: Option<&'a Formation>,
}

/// The section of orders and contact maps; empty where nothing is known of folding.
pub(super) fn section(report: &Report) -> String {
    let Some(Folding { native, settings, formation }) = report.folding else {
        return String::new();
    };
    let mut html =
        String::from("<section id=\"folding\"><h2>In which order the structure forms</h2>\n");
    let count = match formation {
        Some(formation) => format!("{} pathways", formation.pathways),
        None => "how many there are was not found in time".to_owned(),
    };
    writeln!(
        html,
        "<p>A pathway leads from every conformation with at most {} of the {} native contacts, if any route joins it to the native one, by the \
         least cost: {count}. A helix, a strand or a pairing of two is formed from where on {} of its native contacts are there and stay until the end; \
         parts in brackets form at the same frame of a pathway. Contacts: Cα at most 7 Å apart, of residues at least four places apart along the chain.</p>",
        settings.unstructured,
        native.contacts.len(),
        settings.formed_percent(),
    )
    .expect("memory");
    let Some(formation) = formation else {
        html += "<p class=\"warning\">The time was up before all pathways were followed, and some of them would not stand for all: \
                 <code>roadmill orders</code> follows all, without a limit of time.</p>\n";
        return html + "</section>\n";
    };
    if formation.pathways == 0 {
        html += "<p class=\"warning\">No pathway: no route joins an unstructured conformation to the native one.</p>\n";
        return html + "</section>\n";
    }
    html += "<div class=\"charts\">\n";
    html += &orders(native, formation, "Helices and strands", &formation.elements);
    html += &orders(native, formation, "Pairings", &formation.pairings);
    html += "</div>\n";
    html += &precedence(native, formation);
    html += &maps(native, formation);
    html + "</section>\n"
}

/// The most frequent orders with their shares.
fn orders(native: &Native, formation: &Formation, title: &str, orders: &[Order]) -> String {
    if orders.first().is_none_or(|order| order.groups.is_empty()) {
        return String::new();
    }
    let mut html = format!(
        "<figure><figcaption>{title}</figcaption><table><thead><tr><th>share</th><th>order</th></tr></thead><tbody>\n"
    );
    for order in orders.iter().take(LISTED) {
        let share = 100.0 * order.pathways as f64 / formation.pathways as f64;
        let order = escaped(&order.in_words(native));
        writeln!(html, "<tr><td>{share:.1} %</td><td>{order}</td></tr>").expect("memory");
    }
    let rest: u64 = orders.iter().skip(LISTED).map(|order| order.pathways).sum();
    if rest > 0 {
        let share = 100.0 * rest as f64 / formation.pathways as f64;
        let others = orders.len() - LISTED;
        writeln!(html, "<tr><td>{share:.1} %</td><td>{others} others</td></tr>").expect("memory");
    }
    html + "</tbody></table></figure>\n"
}

/// Which part forms before which.
fn precedence(native: &Native, formation: &Formation) -> String {
    let mut html = String::from(
        "<h3>Which forms before which</h3>\n<p>Per cent of the pathways on which the part of the row forms earlier than that of the \
         column; and at which share of all native contacts a part forms, the mean over all pathways.</p>\n<div class=\"scroll\"><table><thead><tr>\
         <th></th><th>contacts</th><th>forms at</th>",
    );
    for part in &native.parts {
        write!(html, "<th>{}</th>", escaped(&part.name)).expect("memory");
    }
    html += "</tr></thead><tbody>\n";
    for (row, part) in native.parts.iter().enumerate() {
        write!(
            html,
            "<tr><th>{}</th><td>{}</td><td>{:.2}</td>",
            escaped(&part.name),
            part.contacts.len(),
            formation.at[row]
        )
        .expect("memory");
        for column in 0..native.parts.len() {
            match row == column {
                true => html += "<td></td>",
                false => {
                    let share = 100.0 * formation.precedence.share(row, column);
                    write!(html, "<td>{share:.0}</td>").expect("memory");
                }
            }
        }
        html += "</tr>\n";
    }
    html + "</tbody></table></div>\n"
}

/// Contact maps while the structure forms: one for each fifth of the native contacts.
fn maps(native: &Native, formation: &Formation) -> String {
    let residues = native.contacts.iter().map(|(_, b)| b + 1).max().unwrap_or(1);
    let mut html = String::from(
        "<h3>Contact maps while it forms</h3>\n<p>Each square is a native contact, at the places of its two residues along the chain. The darker, the \
         larger the share of pathways on which it is there for good by the time that so many of all native contacts are there.</p>\n<div class=\"charts\">\n",
    );
    for fifth in 0..4 {
        let at = |place: f64| place / residues as f64 * MAP;
        let [width, height] = [ROOM + MAP + EDGE, EDGE + MAP + ROOM];
        let percent = 20 * (fifth + 1);
        write!(
            html,
            "<figure><figcaption>{percent} % of the contacts</figcaption><svg viewBox=\"0 -{EDGE} {width} {height}\" role=\"img\" \
             aria-label=\"Contacts that are there for good at {percent} %\"><rect x=\"{ROOM}\" y=\"0\" width=\"{MAP}\" height=\"{MAP}\" fill=\"none\" stroke=\"#8b8b86\"/>"
        )
        .expect("memory");
        for (contact, fifths) in native.contacts.iter().zip(&formation.by_fifths) {
            let side = (MAP / residues as f64).max(2.0);
            for (a, b) in [(contact.0, contact.1), (contact.1, contact.0)] {
                let (x, y) = (ROOM + at(a as f64), MAP - at(b as f64 + 1.0));
                write!(
                    html,
                    "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" fill=\"#1b4f9c\" fill-opacity=\"{:.2}\" stroke=\"#8b8b86\" stroke-width=\"0.2\"/>",
                    fifths[fifth]
                )
                .expect("memory");
            }
        }
        for place in [1, residues] {
            let [x, y] = [ROOM + at(place as f64 - 0.5), MAP - at(place as f64 - 0.5)];
            write!(
                html,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{place}</text><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{place}</text>",
                MAP + 16.0,
                ROOM - 4.0,
                y + 4.0
            )
            .expect("memory");
        }
        html += "</svg></figure>\n";
    }
    html + "</div>\n"
}
