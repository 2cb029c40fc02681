//! What is measured of a molecule along a path, frame by frame.

use super::Frames;
use crate::internal::csv_field::csv_field;
use crate::model::Molecule;
use crate::structure::measure::{
    APART, CA, CA_REACH, ThreeStates, angle_of_centroids, ca_contacts, domain_angle,
    radius_of_gyration, rmsd, secondary_structure, share_of_ca_contacts,
};
use crate::structure::peptides::phi_psi;
use crate::structure::{AminoAcid, Point, Residue};
use std::ops::RangeInclusive;

/// The angle between three domains, see [`domain_angle`]: that of the centroids of the Cα of three ranges of residues.
#[derive(Clone, Debug, PartialEq)]
pub struct DomainAngle {
    /// Its name.
    pub name: String,
    /// The numbers of the residues of one domain, of the one at which the angle is, and of the other.
    pub ranges: [RangeInclusive<i32>; 3],
}

/// A table with a row for every frame of a path, and when the goal's contacts form.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTable {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// The rows, as many numbers each as there are columns; NaN where there is nothing to measure.
    pub rows: Vec<Vec<f64>>,
    /// The contacts of the last frame in the order in which they form.
    pub contacts: Vec<FormedContact>,
}

/// A contact of the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct FormedContact {
    /// The residue that comes first along the chain, as `ALA 12`.
    pub first: String,
    /// The other.
    pub second: String,
    /// At which share of the path's length the contact forms for good: that of the first frame from which on it is never
    /// broken again. 0 where it is never broken.
    pub share: f64,
}

/// What is measured once of every frame.
struct Conformation {
    residues: Vec<Residue>,
    alphas: Vec<Point>,
}

impl FrameTable {
    /// Measures the chain that moves in every frame of a path.
    ///
    /// The columns are `frame`, from 1 on; `own`, 1 for a configuration of the path and 0 for one between two; `length [Å]`
    /// from the start, the sum of the Cα RMSD of neighbouring frames, and its `share` of the whole; the molecule's
    /// energies; the Cα RMSD after superposition from the first frame and from the last; the radius of gyration of all
    /// Cα; the shares of the Cα contacts ([`ca_contacts`] with [`CA_REACH`] and [`APART`]) of the first frame and of the last
    /// that are kept; the number of residues other than glycine with phi > 0; the numbers of residues in helices,
    /// in strands and in neither ([`secondary_structure`]); and the angles in degrees.
    pub fn of(molecule: &dyn Molecule, frames: &Frames, angles: &[DomainAngle]) -> FrameTable {
        let energies = molecule.energies();
        let mut columns: Vec<String> =
            ["frame", "own", "length [Å]", "share"].map(str::to_owned).into();
        columns.extend(energies.columns.iter().map(|name| (*name).to_owned()));
        let fixed = [
            "rmsd_start [Å]",
            "rmsd_goal [Å]",
            "radius_of_gyration [Å]",
            "contacts_start",
            "contacts_goal",
            "positive_phi",
            "helix",
            "strand",
            "other",
        ];
        columns.extend(fixed.map(str::to_owned));
        columns.extend(angles.iter().map(|angle| format!("{} [deg]", angle.name)));

        let at = |index: usize| {
            let residues = molecule.chains_at(frames.configs.get(index)).swap_remove(0);
            let alphas = alphas(&residues);
            Conformation { residues, alphas }
        };
        let mut table = FrameTable { columns, rows: Vec::new(), contacts: Vec::new() };
        let Some(last) = frames.len().checked_sub(1) else { return table };
        let ends = [at(0), at(last)];
        let contacts = [0, 1].map(|end| ca_contacts(&ends[end].residues, CA_REACH, APART));
        let whole = frames.length();
        let share = |index: usize| if whole > 0.0 { frames.lengths[index] / whole } else { 0.0 };
        // From which frame on each of the goal's contacts holds.
        let mut since = vec![0; contacts[1].len()];
        for index in 0..frames.len() {
            let Conformation { residues, alphas } = &at(index);
            let own = f64::from(u8::from(frames.own.binary_search(&index).is_ok()));
            let mut row = vec![(index + 1) as f64, own, frames.lengths[index], share(index)];
            row.extend((energies.at)(frames.configs.get(index)));
            row.extend([0, 1].map(|end| rmsd(alphas, &ends[end].alphas)));
            row.push(radius_of_gyration(alphas));
            row.extend([0, 1].map(|end| share_of_ca_contacts(&contacts[end], alphas, CA_REACH)));
            row.push(positive_phis(residues) as f64);
            let kinds: Vec<_> =
                secondary_structure(residues).into_iter().map(|kind| kind.three_states()).collect();
            let count = |state| kinds.iter().filter(|kind| **kind == state).count() as f64;
            row.extend([ThreeStates::Helix, ThreeStates::Strand, ThreeStates::Coil].map(count));
            row.extend(angles.iter().map(|angle| angle.degrees(residues)));
            table.rows.push(row);
            for (since, (a, b)) in since.iter_mut().zip(&contacts[1]) {
                if (alphas[*a] - alphas[*b]).norm() > CA_REACH {
                    *since = index + 1;
                }
            }
        }
        let mut formed: Vec<_> = since.into_iter().zip(&contacts[1]).collect();
        formed.sort();
        let residues = &ends[1].residues;
        table.contacts = formed
            .into_iter()
            .map(|(since, (a, b))| FormedContact {
                first: residues[*a].to_string(),
                second: residues[*b].to_string(),
                share: share(since.min(last)),
            })
            .collect();
        table
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let columns: Vec<_> = self.columns.iter().map(|name| csv_field(name)).collect();
        let mut csv = columns.join(",") + "\n";
        for row in &self.rows {
            let numbers: Vec<String> = row.iter().map(f64::to_string).collect();
            csv += &(numbers.join(",") + "\n");
        }
        csv
    }

    /// The contacts as CSV.
    pub fn contacts_csv(&self) -> String {
        let lines = self.contacts.iter();
        let lines = lines.map(|FormedContact { first, second, share }| {
            format!("{},{},{share}\n", csv_field(first), csv_field(second))
        });
        "first,second,share\n".to_owned() + &lines.collect::<String>()
    }
}

impl DomainAngle {
    /// The angle in degrees; NaN where a range has no Cα.
    fn degrees(&self, residues: &[Residue]) -> f64 {
        let [one, middle, other] = self.ranges.clone();
        domain_angle(residues, one, middle, other, CA).map_or(f64::NAN, f64::to_degrees)
    }

    /// The same of residues whose Cα are at `alphas`, Å, one for each residue.
    pub(crate) fn degrees_of_alphas(&self, residues: &[Residue], alphas: &[Point]) -> f64 {
        let of = |range: &RangeInclusive<i32>| -> Vec<Point> {
            let both = residues.iter().zip(alphas);
            let chosen = both.filter(|(residue, _)| range.contains(&residue.number.number));
            chosen.map(|(_, alpha)| *alpha).collect()
        };
        let [one, middle, other] = self.ranges.each_ref().map(of);
        angle_of_centroids(&one, &middle, &other).map_or(f64::NAN, f64::to_degrees)
    }
}

fn alphas(residues: &[Residue]) -> Vec<Point> {
    residues.iter().map(|residue| residue.position("CA").unwrap_or_default()).collect()
}

/// How many residues other than glycine have phi above 0.
fn positive_phis(residues: &[Residue]) -> usize {
    let phis = phi_psi(residues).into_iter().zip(residues);
    phis.filter(|([phi, _], residue)| {
        phi.is_some_and(|phi| phi > 0.0) && residue.amino_acid != Some(AminoAcid::Glycine)
    })
    .count()
}
