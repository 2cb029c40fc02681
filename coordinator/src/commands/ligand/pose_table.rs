//! The table of poses, and what is said below it.

use super::descents::Descents;
use crate::output::line;
use roadmill::binding::{Candidate, Candidates, Comparison, Found, Reference, SAME_POSE};
use roadmill::model::EnergyParts;
use roadmill::model::docking::Docking;
use roadmill::model::docking::energy::Own;
use roadmill::structure::Point;
use serde::Serialize;
use std::fmt::Write;

/// What there is to say of the poses of a run.
#[derive(Serialize)]
pub(super) struct PoseTable {
    pub rows: Vec<Row>,
    /// The known pose, if there is one.
    pub reference: Option<ReferenceRow>,
    /// How many nodes were descended once more, and how many clusters they make.
    pub improved: usize,
    pub clusters: usize,
    /// The least RMSD to the descended reference among all of these, and among the poses of the table: as they stand, and rotated, Å.
    pub best_of_improved: Option<[f64; 2]>,
    pub best_of_poses: Option<[f64; 2]>,
    /// The rank of the first pose within 2 Å of the descended reference.
    pub rank_of_reference: Option<usize>,
    /// What that comes to: `hit`, `sampling` or `scoring`.
    pub outcome: Option<&'static str>,
    /// How many configurations were descended while the roadmap grew, and their median energies before and after, kJ/mol.
    pub descents: usize,
    pub median_before: Option<f64>,
    pub median_after: Option<f64>,
    /// Whether RMSDs account for symmetries.
    pub symmetries: bool,
}

/// A pose.
#[derive(Serialize)]
pub(super) struct Row {
    pub rank: usize,
    pub node: u32,
    pub energy: f64,
    #[serde(flatten)]
    pub parts: Parts,
    pub score: f64,
    pub population: usize,
    /// How far the way out rises above the pose, and its highest energy; `None` if the roadmap has no way out.
    pub barrier: Option<f64>,
    pub peak: Option<f64>,
    pub rmsd: Option<f64>,
    pub rmsd_rotated: Option<f64>,
    /// To the known pose as it is given.
    pub rmsd_given: Option<f64>,
    pub configuration: Vec<f64>,
}

/// An energy part by part, kJ/mol.
#[derive(Serialize)]
pub(super) struct Parts {
    pub van_der_waals: f64,
    pub coulomb: f64,
    pub hydrophobic: f64,
    pub own: f64,
}

impl From<EnergyParts> for Parts {
    fn from(parts: EnergyParts) -> Parts {
        let EnergyParts { van_der_waals, coulomb, hydrophobic, own } = parts;
        Parts { van_der_waals, coulomb, hydrophobic, own }
    }
}

/// A known pose.
#[derive(Serialize)]
pub(super) struct ReferenceRow {
    /// Where it comes from.
    pub source: String,
    pub energy: f64,
    pub descended_energy: f64,
    /// How far the descent moved it, and its shape alone, Å.
    pub moved: f64,
    pub moved_rotated: f64,
    /// How far the configuration from which it was descended is from its positions, Å.
    pub misfit: f64,
}

impl PoseTable {
    pub fn of(
        found: &Candidates,
        reference: Option<(&Reference, String)>,
        comparison: &Comparison,
        descents: &Descents,
    ) -> PoseTable {
        let known = reference.as_ref().map(|(reference, _)| *reference);
        let both = |positions: &[Point], to: &[Point]| {
            [comparison.distance(positions, to), comparison.of_shapes(positions, to)]
        };
        let row = |(index, pose): (usize, &Candidate)| {
            let rmsd = known.map(|known| both(&pose.positions, &known.descended));
            Row {
                rank: index + 1,
                node: pose.node.0,
                energy: pose.energy.sum(),
                parts: pose.energy.into(),
                score: pose.score,
                population: pose.population,
                barrier: pose.way_out.as_ref().map(|way| way.depth()),
                peak: pose.way_out.as_ref().map(|way| way.barrier()),
                rmsd: rmsd.map(|[plain, _]| plain),
                rmsd_rotated: rmsd.map(|[_, rotated]| rotated),
                rmsd_given: known
                    .map(|known| comparison.distance(&pose.positions, &known.positions)),
                configuration: pose.q.clone(),
            }
        };
        let rows: Vec<Row> = found.candidates.iter().enumerate().map(row).collect();
        let least = |all: &mut dyn Iterator<Item = &Vec<Point>>| {
            let known = known?;
            all.map(|positions| both(positions, &known.descended))
                .reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1])])
        };
        let is_same = |row: &&Row| row.rmsd.is_some_and(|rmsd| rmsd <= SAME_POSE);
        let medians = descents.medians();
        PoseTable {
            improved: found.improved.len(),
            clusters: found.clusters.len(),
            best_of_improved: least(&mut found.improved.iter().map(|of| &of.positions)),
            best_of_poses: least(&mut found.candidates.iter().map(|of| &of.positions)),
            rank_of_reference: rows.iter().find(is_same).map(|row| row.rank),
            outcome: known.and_then(|known| Found::of(found, known, comparison)).map(|outcome| {
                match outcome {
                    Found::First => "hit",
                    Found::SamplingMiss => "sampling",
                    Found::ScoringMiss => "scoring",
                }
            }),
            reference: reference.map(|(reference, source)| {
                let [moved, moved_rotated] = both(&reference.positions, &reference.descended);
                ReferenceRow {
                    source,
                    energy: reference.energy.sum(),
                    descended_energy: reference.descended_energy.sum(),
                    moved,
                    moved_rotated,
                    misfit: reference.misfit,
                }
            }),
            descents: descents.before.len(),
            median_before: medians.map(|[before, _]| before),
            median_after: medians.map(|[_, after]| after),
            symmetries: comparison.is_corrected(),
            rows,
        }
    }

    /// Prints the table, without columns that are empty.
    pub fn print(&self, docking: &Docking) {
        let energy = docking.energy();
        let mut heading = format!("rank{:>10}{:>10}", "energy", "12-6");
        let parts: [(&str, bool); 3] = [
            ("coulomb", energy.dielectric.is_some()),
            ("hydrophobic", energy.hydrophobic),
            ("own", energy.own != Own::None),
        ];
        for (name, _) in parts.iter().filter(|(_, is_there)| *is_there) {
            write!(heading, "{name:>12}").expect("writing to memory cannot fail");
        }
        write!(heading, "{:>10}{:>12}{:>9}{:>9}", "score", "population", "barrier", "peak")
            .expect("writing to memory cannot fail");
        if self.reference.is_some() {
            heading += &format!("{:>8}{:>9}", "RMSD", "rotated");
        }
        line("energies in kJ/mol by exact sums; RMSD of heavy atoms in Å");
        line(heading);
        for row in &self.rows {
            line(row.text(&parts.map(|(_, is_there)| is_there)));
        }
        line(format_args!(
            "improved         {} nodes of the lowest energies, in {} clusters",
            self.improved, self.clusters
        ));
        if let (Some(before), Some(after)) = (self.median_before, self.median_after) {
            line(format_args!(
                "descents         {} while the roadmap grew; median energy {before:.1} before, {after:.1} after",
                self.descents
            ));
        }
        self.print_reference();
    }

    fn print_reference(&self) {
        let Some(reference) = &self.reference else {
            line(
                "reference        none: the given pose is outside of the box; --reference names another",
            );
            return;
        };
        let ReferenceRow { source, energy, descended_energy, moved, moved_rotated, misfit } =
            reference;
        line(format_args!(
            "reference        {source}: energy {energy:.1}, after its descent {descended_energy:.1}, moved by {moved:.2} Å ({moved_rotated:.2} rotated)"
        ));
        if *misfit > 0.005 {
            line(format_args!(
                "                 the ligand with its own bonds and angles comes as near as {misfit:.2} Å to it"
            ));
        }
        if let (Some([all, all_rotated]), Some([shown, shown_rotated])) =
            (self.best_of_improved, self.best_of_poses)
        {
            line(format_args!(
                "best RMSD        {all:.2} Å ({all_rotated:.2} rotated) of all improved nodes, {shown:.2} ({shown_rotated:.2}) of the poses above"
            ));
        }
        let rank = match self.rank_of_reference {
            Some(rank) => format!("rank {rank} is the first within {SAME_POSE} Å of the reference"),
            None => format!("no pose above is within {SAME_POSE} Å of the reference"),
        };
        line(format_args!("found            {rank}"));
        let outcome = match self.outcome {
            Some("hit") => "hit: the pose of lowest energy is the reference",
            Some("sampling") => {
                "sampling miss: the reference has a lower energy than every pose that was found"
            }
            Some(_) => "scoring miss: a pose elsewhere has a lower energy than the reference",
            None => return,
        };
        line(format_args!("outcome          {outcome}"));
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let mut csv = "rank,node,energy [kJ/mol],van_der_waals [kJ/mol],coulomb [kJ/mol],hydrophobic [kJ/mol],own [kJ/mol],\
                       score [kJ/mol],population,barrier [kJ/mol],peak [kJ/mol],rmsd [A],rmsd_rotated [A],rmsd_given [A]\n"
            .to_owned();
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        for row in &self.rows {
            let Parts { van_der_waals, coulomb, hydrophobic, own } = row.parts;
            writeln!(
                csv,
                "{},{},{},{van_der_waals},{coulomb},{hydrophobic},{own},{},{},{},{},{},{},{}",
                row.rank,
                row.node,
                row.energy,
                row.score,
                row.population,
                number(row.barrier),
                number(row.peak),
                number(row.rmsd),
                number(row.rmsd_rotated),
                number(row.rmsd_given),
            )
            .expect("writing to memory cannot fail");
        }
        csv
    }
}

impl Row {
    fn text(&self, parts: &[bool; 3]) -> String {
        let Parts { van_der_waals, coulomb, hydrophobic, own } = self.parts;
        let mut text = format!("{:>4}{:>10.2}{van_der_waals:>10.2}", self.rank, self.energy);
        for (value, is_there) in [coulomb, hydrophobic, own].iter().zip(parts) {
            if *is_there {
                write!(text, "{value:>12.2}").expect("writing to memory cannot fail");
            }
        }
        let number = |value: Option<f64>| match value {
            None => "-".to_owned(),
            Some(value) if value.abs() < 1e6 => format!("{value:.1}"),
            Some(value) => format!("{value:.1e}"),
        };
        write!(
            text,
            "{:>10.1}{:>12}{:>9}{:>9}",
            self.score,
            self.population,
            number(self.barrier),
            number(self.peak)
        )
        .expect("writing to memory cannot fail");
        if let (Some(plain), Some(rotated)) = (self.rmsd, self.rmsd_rotated) {
            write!(text, "{plain:>8.2}{rotated:>9.2}").expect("writing to memory cannot fail");
        }
        text
    }
}
