//! Energies and order parameters along the paths.

use super::super::palette::{COLOURS, colour};
use super::Report;
use super::along::Along;
use super::chart::{Chart, Series};

/// The section of charts over the length of the paths.
pub(super) fn section(report: &Report, tables: &[Along]) -> String {
    let Some(first) = tables.first() else { return String::new() };
    let mut html = String::from("<section id=\"profiles\"><h2>Along the paths</h2>\n");
    html += "<p>Over the length of the path from the start, frame by frame. Between two frames the energy may step higher: the \
        peak that is written into the charts is that of the whole path, as looked at twenty times finer than when it was found.</p>\n";
    html += "<div class=\"charts\">\n";
    let length = if first.table.columns.iter().any(|name| name == "length [Å]") {
        "length of the path [Å of Cα RMSD]"
    } else {
        "length of the path"
    };
    let chart = |title: &str, beside: &str, series: Vec<Series>| Chart {
        title: title.to_owned(),
        axes: [length.to_owned(), beside.to_owned()],
        series,
        levels: Vec::new(),
    };
    if let Some(whole) = first.energies.clone().last() {
        let series = (tables.iter().enumerate())
            .map(|(index, table)| of_path(index, false, table.points(whole)))
            .collect();
        html += &chart("Energy of all paths", &first.table.columns[whole], series).html();
        if first.energies.len() > 1 {
            for (index, (table, pathway)) in
                tables.iter().zip(&report.pathways.pathways).enumerate()
            {
                let mut energies = energies_of(index, table, &chart);
                let peak = pathway.measured.peak;
                energies.levels =
                    peak.map(|peak| (peak, format!("peak {peak:.1}"))).into_iter().collect();
                html += &energies.html();
            }
        }
    }
    let pairs: [(&str, [&str; 2], &str); 3] = [
        (
            "Cα RMSD from the start (solid) and the goal (dashed)",
            ["rmsd_start", "rmsd_goal"],
            "Cα RMSD [Å]",
        ),
        (
            "Distance from the start (solid) and the goal (dashed)",
            ["distance_start", "distance_goal"],
            "distance",
        ),
        (
            "Contacts of the start (solid) and of the goal (dashed) that are there",
            ["contacts_start", "contacts_goal"],
            "share",
        ),
    ];
    for (title, names, beside) in pairs {
        let columns = names.map(|name| first.column(name));
        let [Some(from_start), Some(from_goal)] = columns else { continue };
        let mut series = Vec::new();
        for (index, table) in tables.iter().enumerate() {
            series.push(of_path(index, false, table.points(from_start)));
            series.push(Series {
                name: String::new(),
                ..of_path(index, true, table.points(from_goal))
            });
        }
        html += &chart(title, beside, series).html();
    }
    let mut single =
        vec![("Radius of gyration of all Cα".to_owned(), first.column("radius_of_gyration"))];
    for angle in report.angles {
        single.push((format!("Angle {}", angle.name), first.column(&angle.name)));
    }
    for (title, column) in single {
        let Some(column) = column else { continue };
        let series = (tables.iter().enumerate())
            .map(|(index, table)| of_path(index, false, table.points(column)))
            .collect();
        html += &chart(&title, &first.table.columns[column].replace('_', " "), series).html();
    }
    html + "</div></section>\n"
}

/// A line of one path.
fn of_path(index: usize, dashed: bool, points: Vec<[f64; 2]>) -> Series {
    let dashed = dashed || index >= COLOURS.len();
    Series { name: format!("path {}", index + 1), colour: colour(index), dashed, points }
}

/// The whole energy of one path, and its parts.
fn energies_of(
    index: usize,
    table: &Along,
    chart: &dyn Fn(&str, &str, Vec<Series>) -> Chart,
) -> Chart {
    let unit =
        |name: &str| name.split(" [").nth(1).map(|unit| unit.trim_end_matches(']').to_owned());
    let mut series = Vec::new();
    for (part, column) in table.energies.clone().enumerate() {
        let is_whole = column + 1 == table.energies.end;
        let name = table.table.columns[column].split(" [").next().unwrap_or_default();
        let name = match name.strip_prefix("energy_") {
            Some(part) => part.replace('_', " "),
            None => "whole".to_owned(),
        };
        let colour = if is_whole { "#1b1b1b" } else { colour(part) };
        series.push(Series { name, colour, dashed: !is_whole, points: table.points(column) });
    }
    let whole = &table.table.columns[table.energies.end - 1];
    let beside = unit(whole).map_or_else(|| "energy".to_owned(), |unit| format!("energy [{unit}]"));
    chart(&format!("Energies of path {}", index + 1), &beside, series)
}
