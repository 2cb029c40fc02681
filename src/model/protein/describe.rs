//! What `check` says of a protein, and of a query's ends.

use super::KT;
use super::chain_in_energy::{ChainInEnergy, basins_of};
use super::energy::{ConstraintKind, Constraints};
use super::linkage::TorsionKind;
use super::motion::EnergySteps;
use super::{Gaps, Protein};
use crate::structure::measure::superpose;
use crate::structure::{AminoAcid, Point};
use std::fmt::{Result, Write};

/// Residues of a line of the sequence.
const SEQUENCE_LINE: usize = 60;

pub(super) fn describe(protein: &Protein, out: &mut String) -> Result {
    let Protein { source, target, gaps, obstacles, rules, energy, highest, step } = protein;
    let linkage = protein.linkage();
    let fixed =
        source.iter().filter(|residue| residue.amino_acid == Some(AminoAcid::Proline)).count();
    let (first, last) = (&source[0], &source[source.len() - 1]);
    writeln!(
        out,
        "                 phi and psi: {} torsions; radians, in [-pi, pi)",
        linkage.torsions.len()
    )?;
    writeln!(
        out,
        "chain            {} residues, {first} to {last}; phi of the first, psi of the last and phi of {fixed} prolines fixed",
        source.len()
    )?;
    let letters: Vec<char> =
        source.iter().map(|residue| residue.amino_acid.map_or('X', AminoAcid::letter)).collect();
    for line in letters.chunks(SEQUENCE_LINE) {
        writeln!(out, "                 {}", line.iter().collect::<String>())?;
    }
    if *gaps == Gaps::Rigid {
        writeln!(out, "gaps             {}: both sides of each move as one", linkage.gaps.len())?;
    }
    if !obstacles.is_empty() {
        let atoms = obstacles.iter().flatten().flat_map(|residue| &residue.atoms);
        let count = atoms.filter(|atom| atom.is_heavy()).count();
        writeln!(out, "obstacles        {} chains of {count} heavy atoms", obstacles.len())?;
    }
    let names = ["the source", "the target"];
    for (basin, name) in basins_of(protein).iter().zip(names) {
        writeln!(out, "constraints      {}: {}", name, counts_of(basin))?;
    }
    if let Some(target) = target {
        let count = target.matches.len();
        writeln!(
            out,
            "target           {} residues, {count} of them the source's",
            target.residues.len()
        )?;
        writeln!(out, "ends             {}", crate::source::value(&energy.ends))?;
    }
    if energy.hydrophobic {
        writeln!(
            out,
            "hydrophobic      -20 per pair of A V I L M F W C P Y within 6 Å, our choice"
        )?;
    }
    writeln!(
        out,
        "rules            least distances in Å, 0 for none: {}",
        crate::source::value(rules)
    )?;
    match highest {
        None => writeln!(out, "energy           model kJ/mol; any is valid")?,
        Some(highest) => writeln!(out, "energy           model kJ/mol; up to {highest} is valid")?,
    }
    let by = match *step {
        EnergySteps::Length(length) => format!("every {length} radians of a motion"),
        EnergySteps::Turn(turn) => {
            format!(
                "steps in which no torsion turns by more than {:.3}°",
                turn * (180.0 / std::f64::consts::PI)
            )
        }
    };
    writeln!(out, "costs            climbs in kT = {KT} kJ/mol, by the energy at {by}")?;
    describe_end(protein, "native", &linkage.source(), out)
}

/// "88 hydrogen bonds, 0 disulphides".
fn counts_of(constraints: &Constraints) -> String {
    let count =
        |kind| constraints.list().iter().filter(|constraint| constraint.kind == kind).count();
    let bonds = count(ConstraintKind::HydrogenBond);
    format!("{bonds} hydrogen bonds, {} disulphides", count(ConstraintKind::Disulphide))
}

/// What there is to say of one end of a transition, or of the native state: energies, how far it is from the structures, and
/// which rules it breaks.
pub(super) fn describe_end(protein: &Protein, name: &str, q: &[f64], out: &mut String) -> Result {
    let model = ChainInEnergy::of(protein);
    let energies: Vec<String> =
        model.basins(q).iter().map(|energy| format!("{energy:.1}")).collect();
    write!(out, "{name:<16} constraints {} model kJ/mol", energies.join(" and "))?;
    write!(out, ", hydrophobic {:.0}, together {:.1}", model.hydrophobic(q), model.energy_at(q))?;
    writeln!(out)?;
    let alphas = model.alphas(q);
    let to_source = all_alphas(protein.source());
    write!(
        out,
        "                 Cα RMSD {:.3} Å to the source",
        superpose(&alphas, &to_source).rmsd
    )?;
    if let Some(target) = &protein.target {
        let there = all_alphas(&target.residues);
        let pairs = target
            .matches
            .iter()
            .map(|[here, there_at]| (alphas[*here as usize], there[*there_at as usize]));
        let (here, there): (Vec<Point>, Vec<Point>) = pairs.unzip();
        if here.len() >= 3 {
            write!(out, ", {:.3} Å to the target", superpose(&here, &there).rmsd)?;
        }
    }
    let (positive, of) = positive_phis(protein, q);
    writeln!(out, "; phi > 0 in {positive} of {of} residues other than glycine")?;
    match model.first_violation(q) {
        None => writeln!(out, "                 keeps all rules"),
        Some(violation) => {
            let count = model.counts(q).total();
            writeln!(
                out,
                "                 breaks rules at {count} pairs, first {}",
                model.text_of(&violation)
            )
        }
    }
}

/// The positions of all Cα; sound descriptions have them.
fn all_alphas(residues: &[crate::structure::Residue]) -> Vec<Point> {
    residues.iter().map(|residue| residue.position("CA").unwrap_or_default()).collect()
}

/// How many residues other than glycine have phi above 0, and how many have a phi.
fn positive_phis(protein: &Protein, q: &[f64]) -> (usize, usize) {
    let torsions = protein.linkage().torsions;
    let of_others = torsions.iter().zip(q).filter(|(torsion, _)| {
        let amino_acid = protein.source[torsion.residue].amino_acid;
        torsion.kind == TorsionKind::Phi && amino_acid != Some(AminoAcid::Glycine)
    });
    of_others
        .fold((0, 0), |(positive, all), (_, phi)| (positive + usize::from(*phi > 0.0), all + 1))
}
