//! The table of poses.

use super::super::markup::escaped;
use super::{PosesPage, colour};
use std::fmt::Write;

/// The table; a row's `data-pose` is the number of its pose, counted from 0. A column that no pose has is left out.
pub(super) fn html(page: &PosesPage) -> String {
    let has = |of: fn(&super::ShownPose) -> bool| page.poses.iter().any(of);
    let (has_peak, has_barrier, has_rmsd) =
        (has(|p| p.peak.is_some()), has(|p| p.barrier.is_some()), has(|p| p.rmsd.is_some()));
    let mut out = String::from("<table><thead><tr><th>pose</th>");
    let mut head = |name: &str, unit: &str, title: &str| {
        write!(out, "<th title=\"{title}\">{name}<small>{unit}</small></th>")
            .expect("writing to memory cannot fail");
    };
    head("energy", "kJ/mol", "the energy of the pose");
    head("score", "kJ/mol", "the mean energy of configurations near the pose");
    head("cluster", "", "poses that are alike have one cluster");
    head("minima", "in it", "how many minima the cluster has");
    if has_peak {
        head("peak", "kJ/mol", "the highest energy on the way out of the pocket");
    }
    if has_barrier {
        head("barrier", "kJ/mol", "how far the way out of the pocket rises above the pose");
    }
    if has_rmsd {
        head(
            "RMSD",
            "Å",
            "of heavy atoms from the reference, symmetry-corrected, without moving the ligand",
        );
    }
    out += "</tr></thead>\n<tbody>\n";
    for (number, pose) in page.poses.iter().enumerate() {
        let mut row = format!(
            "<tr data-pose=\"{number}\" tabindex=\"0\"><td title=\"{0}\"><span class=\"swatch\" style=\"background:{1}\"></span>{0}</td>",
            escaped(&pose.label),
            colour(pose.cluster)
        );
        let mut cell = |text: String| {
            write!(row, "<td>{text}</td>").expect("writing to memory cannot fail");
        };
        cell(fixed(Some(pose.energy), 1));
        cell(fixed(Some(pose.score), 1));
        cell((pose.cluster + 1).to_string());
        cell(pose.population.to_string());
        if has_peak {
            cell(fixed(pose.peak, 1));
        }
        if has_barrier {
            cell(fixed(pose.barrier, 1));
        }
        if has_rmsd {
            cell(fixed(pose.rmsd, 2));
        }
        out += &row;
        out += "</tr>\n";
    }
    out + "</tbody></table>"
}

/// A number with so many decimals, or a dash; a true minus sign is as wide as a plus.
fn fixed(value: Option<f64>, decimals: usize) -> String {
    let value = value.filter(|value| value.is_finite());
    let text = value.map(|value| match value.abs() < 1e7 {
        true => format!("{value:.decimals$}"),
        false => format!("{value:.2e}"),
    });
    text.map_or_else(|| "–".to_owned(), |text| text.replace('-', "\u{2212}"))
}
