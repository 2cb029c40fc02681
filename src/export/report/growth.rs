//! What the build came to from round to round.

use super::super::markup::escaped;
use super::super::palette::COLOURS;
use super::chart::{Chart, Series};
use super::{Report, RoundOutcome};
use std::fmt::Write;

/// The section of charts over the number of nodes.
pub(super) fn section(report: &Report) -> String {
    let rounds = report.rounds;
    let mut html = String::from("<section id=\"growth\"><h2>The build, round by round</h2>\n");
    html += "<p>Over the number of nodes at the end of each round, as the ledger has it: nothing is computed anew. A level line \
        is what a criterion asks for. Where the ends are not connected yet there is no line.</p>\n";
    let Some(last) = rounds.last() else {
        return html + "<p>No round is complete.</p></section>\n";
    };
    html += "<div class=\"charts\">\n";
    let axes = |of: &str| ["nodes", of].map(str::to_owned);
    let points = |of: &dyn Fn(&RoundOutcome) -> Option<f64>| -> Vec<[f64; 2]> {
        let points = rounds.iter().filter_map(|round| Some([round.nodes as f64, of(round)?]));
        points.collect()
    };
    let components = Chart {
        title: "Connected components".to_owned(),
        axes: axes("components"),
        series: vec![Series {
            name: "components".to_owned(),
            colour: COLOURS[0],
            dashed: false,
            points: points(&|round| Some(round.components as f64)),
        }],
        levels: Vec::new(),
    };
    html += &components.html();
    // In the order in which criteria came, those of earlier chapters first.
    let mut names: Vec<&str> = Vec::new();
    for number in rounds.iter().flat_map(|round| &round.numbers) {
        if !names.contains(&&*number.name) {
            names.push(&number.name);
        }
    }
    let mut never = Vec::new();
    for name in names {
        let of =
            |round: &RoundOutcome| round.numbers.iter().find(|number| number.name == name).cloned();
        let points = points(&|round| of(round).map(|number| number.value));
        if !points.iter().any(|[_, value]| value.is_finite()) {
            never.push(name);
            continue;
        }
        let threshold = rounds.iter().rev().find_map(|round| of(round)?.threshold);
        let chart = Chart {
            title: name.to_owned(),
            axes: axes(name),
            series: vec![Series {
                name: name.to_owned(),
                colour: COLOURS[0],
                dashed: false,
                points,
            }],
            levels: threshold
                .map(|value| (value, format!("asked for: {value}")))
                .into_iter()
                .collect(),
        };
        html += &chart.html();
    }
    html += "</div>\n";
    if !never.is_empty() {
        let names = never.join(", ");
        writeln!(html, "<p>Never finite in any round: {}.</p>", escaped(&names)).expect("memory");
    }
    if last.numbers.is_empty() {
        html += "<p>The problem has no evaluators, so the ledger has neither barriers nor flows of its rounds.</p>\n";
    }
    html + "</section>\n"
}
