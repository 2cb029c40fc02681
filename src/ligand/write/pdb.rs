//! HETATM and CONECT records: "Protein Data Bank Contents Guide", version 3.3, 2012.

use super::super::error::{LigandError, LigandFault};
use super::super::{Atom, BondOrder, Ligand};
use super::names::atom_names;
use super::{check_positions, cut, too_wide};
use crate::internal::plain::plain;
use crate::structure::{Point, is_water};
use std::fmt::Write;

/// What the residue is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PdbResidue {
    /// Its name: one to three ASCII letters or digits; anything else is written as `UNL`, as the PDB calls unknown ligands.
    pub name: String,
    /// Its chain: one ASCII letter or digit.
    pub chain: char,
    /// Its number, −999 to 9999.
    pub number: i32,
}

impl PdbResidue {
    /// Number 1 of chain A, with the ligand's name if that can be a residue's.
    pub fn of(ligand: &Ligand) -> PdbResidue {
        PdbResidue { name: ligand.name().to_owned(), chain: 'A', number: 1 }
    }
}

/// A pose of a PDB file.
#[derive(Clone, Debug, PartialEq)]
pub struct PdbPose {
    /// Where the atoms are, in Å, in the ligand's order.
    pub positions: Vec<Point>,
    /// What is written in REMARK records before the atoms, one each, of at most 69 characters; other characters than ASCII are
    /// written as `?`.
    pub remarks: Vec<String>,
}

/// The columns hold no more.
const MODELS_MAX: usize = 9_999;
const NUMBERS: std::ops::RangeInclusive<i32> = -999..=9_999;
const COORDINATES: std::ops::RangeInclusive<f64> = -999.999_4..=9_999.999_4;
const REMARK_MAX: usize = 69;

/// The poses of a ligand as a PDB file: each one residue of HETATM records, several as models, and the bonds as CONECT records at
/// the end. Positions have three decimals; atoms have the serial numbers from 1 on in every model.
///
/// A CONECT record lists a double bond twice and a triple one three times, as many programs do, if all orders are single, double or triple; otherwise
/// each bond once, as there is no other way to say aromatic or unknown. Names of atoms are the file's if they can be; otherwise
/// the element's symbol and a number.
///
/// # Errors
/// No pose, more than 9999; not as many positions as atoms; a position, a number of a residue or a chain that has no columns.
pub fn pdb(
    ligand: &Ligand,
    residue: &PdbResidue,
    poses: &[PdbPose],
) -> Result<String, LigandError> {
    if poses.is_empty() {
        return Err(LigandError::pathless(LigandFault::Empty));
    }
    if poses.len() > MODELS_MAX {
        let fault = LigandFault::TooMany { found: poses.len(), what: "models", most: MODELS_MAX };
        return Err(LigandError::pathless(fault));
    }
    if !NUMBERS.contains(&residue.number) {
        return Err(too_wide(f64::from(residue.number), "a number of a residue", "a PDB file"));
    }
    if !residue.chain.is_ascii_alphanumeric() {
        return Err(LigandError::pathless(LigandFault::Syntax {
            found: format!("`{}` as a chain", residue.chain),
            expected: "one ASCII letter or digit".to_owned(),
        }));
    }
    let names = atom_names(ligand);
    let mut out = String::new();
    for (index, pose) in poses.iter().enumerate() {
        check_positions(ligand, &pose.positions)?;
        if poses.len() > 1 {
            put(&mut out, format_args!("MODEL     {:>4}", index + 1));
        }
        for remark in &pose.remarks {
            let remark = plain(remark).replace(|c: char| !c.is_ascii(), "?");
            let line = format!("REMARK   6 {}", cut(&remark, REMARK_MAX));
            put(&mut out, format_args!("{}", line.trim_end()));
        }
        for (number, (atom, position)) in ligand.atoms().iter().zip(&pose.positions).enumerate() {
            let line = record(number + 1, atom, &names[number], residue, position)?;
            put(&mut out, format_args!("{line}"));
        }
        if poses.len() > 1 {
            put(&mut out, format_args!("ENDMDL"));
        }
    }
    conect(ligand, &mut out);
    Ok(out + "END\n")
}

fn put(out: &mut String, line: std::fmt::Arguments) {
    out.write_fmt(line).expect("writing to memory cannot fail");
    out.push('\n');
}

/// The record of an atom.
fn record(
    serial: usize,
    atom: &Atom,
    name: &str,
    residue: &PdbResidue,
    position: &Point,
) -> Result<String, LigandError> {
    if let Some(found) = position.iter().find(|x| !COORDINATES.contains(*x)) {
        return Err(too_wide(*found, "a coordinate", "a PDB file"));
    }
    let [x, y, z] = [position.x, position.y, position.z].map(|x| x + 0.0);
    let is_name = (1..=3).contains(&residue.name.len())
        && residue.name.bytes().all(|byte| byte.is_ascii_alphanumeric())
        && !is_water(&residue.name);
    let residue_name = if is_name { &residue.name } else { "UNL" };
    let symbol = atom.element.symbol();
    // Symbols of one letter begin in the second column of the name.
    let name = match symbol.len() == 1 && name.len() < 4 {
        true => format!(" {name:<3}"),
        false => format!("{name:<4}"),
    };
    let charge = match atom.formal_charge {
        Some(charge @ 1..=9) => format!("{charge}+"),
        Some(charge @ -9..=-1) => format!("{}-", charge.unsigned_abs()),
        _ => String::new(),
    };
    let (chain, number) = (residue.chain, residue.number);
    let line = format!(
        "HETATM{serial:>5} {name} {residue_name:>3} {chain}{number:>4}    {x:>8.3}{y:>8.3}{z:>8.3}  1.00  0.00          {:>2}{charge}",
        symbol.to_ascii_uppercase()
    );
    Ok(line)
}

/// Writes the bonds, those of every atom from its own side.
fn conect(ligand: &Ligand, out: &mut String) {
    let times = |order| match order {
        BondOrder::Single => Some(1),
        BondOrder::Double => Some(2),
        BondOrder::Triple => Some(3),
        BondOrder::Aromatic | BondOrder::Unknown => None,
    };
    let tells_orders = ligand.bonds().iter().all(|bond| times(bond.order).is_some());
    let mut near: Vec<Vec<usize>> = vec![Vec::new(); ligand.atoms().len()];
    for bond in ligand.bonds() {
        let [a, b] = bond.atoms;
        for _ in 0..times(bond.order).filter(|_| tells_orders).unwrap_or(1) {
            near[a].push(b + 1);
            near[b].push(a + 1);
        }
    }
    for (number, near) in near.iter_mut().enumerate() {
        near.sort_unstable();
        for four in near.chunks(4) {
            let serials: String = four.iter().map(|serial| format!("{serial:>5}")).collect();
            put(out, format_args!("CONECT{:>5}{serials}", number + 1));
        }
    }
}
