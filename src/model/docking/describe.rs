//! What `check` says of docking.

use super::energy::{EnergySpec, Own, ParameterSet};
use super::exposed::exposed;
use super::{Docking, EnergyLookup};
use crate::model::Description;
use std::fmt::{Result, Write};

pub(super) fn describe(docking: &Docking, out: &mut String) -> Result {
    let Docking { chains, ligand, rigid, amides, bounds, energy, grid, highest, step } = docking;
    let linkage = docking.linkage();
    let residues = || chains.iter().flat_map(|chain| &chain.residues);
    let names: Vec<&str> = chains.iter().map(|chain| chain.name.as_str()).collect();
    let atoms = residues().map(|residue| residue.atoms.len()).sum::<usize>();
    let others: Vec<String> = residues()
        .filter(|residue| residue.amino_acid.is_none())
        .map(|residue| residue.to_string())
        .collect();
    let hydrogens = residues().flat_map(|of| &of.atoms).filter(|atom| !atom.is_heavy()).count();
    writeln!(
        out,
        "                 x y z: the centre of the ligand's base, Å; qw qx qy qz: its orientation; {} torsions, radians",
        linkage.links()
    )?;
    writeln!(
        out,
        "protein          {} residues of chains {}, {atoms} atoms, {hydrogens} of them hydrogens",
        residues().count(),
        names.join(" "),
    )?;
    match &others[..] {
        [] => writeln!(out, "                 amino acids alone")?,
        some => writeln!(out, "                 with {}", some.join(", "))?,
    }
    writeln!(out, "                 {} residues are exposed", exposed(chains).len())?;
    let links = match (*rigid, *amides) {
        (true, _) => "rigid".to_owned(),
        (false, true) => format!("{} torsion links, amides among them", linkage.links()),
        (false, false) => format!("{} torsion links, without amides", linkage.links()),
    };
    writeln!(
        out,
        "ligand           {}: {} atoms, {} heavy; {links}; {} degrees of freedom; {:.1} Å long as given",
        crate::internal::plain::plain(ligand.name()),
        ligand.atoms().len(),
        ligand.heavy_atoms(),
        docking.degrees_of_freedom(),
        linkage.diameter(),
    )?;
    let [min, max] = bounds;
    writeln!(out, "box              {min:?} to {max:?} Å")?;
    let EnergySpec { parameters, cutoff, dielectric, hydrophobic, own } = energy;
    let set = match parameters {
        ParameterSet::Autodock4 => "AutoDock 4.1",
        ParameterSet::Uff => "UFF",
    };
    let mut terms = vec![format!("12-6 terms of {set} up to {cutoff} Å")];
    terms.extend(dielectric.map(|factor| format!("Coulomb terms with a dielectric of {factor} r")));
    terms.extend(hydrophobic.then(|| "hydrophobic terms of AutoDock Vina".to_owned()));
    terms.push(
        match own {
            Own::None => "none within the ligand",
            Own::Repulsion => "repulsion within the ligand",
            Own::Whole => "the same within the ligand",
        }
        .to_owned(),
    );
    writeln!(out, "energy           kJ/mol; {}; up to {highest} is valid", terms.join(", "))?;
    let lookup = match grid.lookup {
        EnergyLookup::Exact => "no grid: exact sums".to_owned(),
        EnergyLookup::Nearest => format!("the nearest point of a grid of {} Å", grid.spacing),
        EnergyLookup::Trilinear => format!("trilinear in a grid of {} Å", grid.spacing),
        EnergyLookup::Reciprocal => {
            format!("linear of reciprocals in a grid of {} Å", grid.spacing)
        }
        EnergyLookup::Tricubic => format!("splines of reciprocals in a grid of {} Å", grid.spacing),
    };
    writeln!(out, "looked up        {lookup}")?;
    writeln!(out, "motions          an energy wherever an atom has moved by {step} Å at most")?;
    let given = docking.given();
    let place = match docking.space().within_bounds(&given) {
        true => "within the box",
        false => "outside of the box: only the shape is used",
    };
    writeln!(out, "given pose       {place}")
}
