//! SDF: "CTfile formats", Dassault Systèmes BIOVIA, 2020.

use super::super::error::{LigandError, LigandFault};
use super::super::{BondOrder, Ligand};
use super::{check_positions, cut};
use crate::internal::plain::plain;
use crate::structure::Point;
use std::fmt::Write;

/// What is written as one record of an SDF file.
#[derive(Clone, Copy, Debug)]
pub struct SdfRecord<'a> {
    /// The molecule.
    pub ligand: &'a Ligand,
    /// Where its atoms are, in Å, in their order.
    pub positions: &'a [Point],
    /// The first line; at most 80 characters are kept.
    pub name: &'a str,
    /// The third line; at most 80 characters are kept.
    pub comment: &'a str,
    /// Names and values of data items, in the order in which they are written. In names, all but ASCII letters, digits and `_` is
    /// replaced by `_`.
    pub data: &'a [(&'a str, String)],
}

/// A table of V2000 has columns for so many atoms, and so many bonds.
const V2000_MAX: usize = 999;

/// Coordinates between these have ten columns with four decimals.
const V2000_COORDINATES: std::ops::RangeInclusive<f64> = -9_999.999_94..=99_999.999_94;

/// Formal charges of the format reach so far.
const CHARGE_MAX: u8 = 15;

/// Lines of the header, and of data.
const HEADER_MAX: usize = 80;
const DATA_MAX: usize = 200;

/// The item that says that orders are not known.
const UNKNOWN: &str = "bonds_of_unknown_order";

/// A record of an SDF file, with `$$$$` at its end: V2000, or V3000 where V2000 has no columns for what there is. Positions
/// have four decimals.
///
/// Bonds of unknown order are written as single, and a data item `bonds_of_unknown_order` lists them by their numbers from
/// 1 on. The format's query type `any`, 8, would be more honest, but few programs take it: RDKit 2026.09 makes a query of the
/// bond, Open Babel 3.1 leaves open valences at its atoms, and PyMOL 3.2 takes it for a bond of order 8.
///
/// # Errors
/// Not as many positions as atoms, one that is not finite or too far away, a charge that the format does not have.
pub fn sdf(record: &SdfRecord) -> Result<String, LigandError> {
    let SdfRecord { ligand, positions, name, comment, data } = *record;
    check_positions(ligand, positions)?;
    for atom in ligand.atoms() {
        if let Some(found) = atom.formal_charge.filter(|c| c.unsigned_abs() > CHARGE_MAX) {
            return Err(LigandError::pathless(LigandFault::BadNumber {
                found: format!("`{found}`"),
                expected: "a charge of -15 to 15".to_owned(),
            }));
        }
    }
    // The second line has two columns for the user, eight for the program, ten for the time, and two for the dimension.
    let mut out = format!("{}\n  roadmill          3D\n{}\n", header(name), header(comment));
    let fits = ligand.atoms().len() <= V2000_MAX
        && ligand.bonds().len() <= V2000_MAX
        && positions.iter().flatten().all(|x| V2000_COORDINATES.contains(x));
    match fits {
        true => v2000(ligand, positions, &mut out),
        false => v3000(ligand, positions, &mut out),
    }
    out += "M  END\n";
    for (name, value) in data {
        item(name, value, &mut out);
    }
    let unknown: Vec<String> = (ligand.bonds().iter().enumerate())
        .filter(|(_, bond)| bond.order == BondOrder::Unknown)
        .map(|(number, _)| (number + 1).to_string())
        .collect();
    if !unknown.is_empty() {
        item(UNKNOWN, &unknown.join(" "), &mut out);
    }
    Ok(out + "$$$$\n")
}

fn v2000(ligand: &Ligand, positions: &[Point], out: &mut String) {
    let mut put = |text: std::fmt::Arguments| {
        out.write_fmt(text).expect("writing to memory cannot fail");
        out.push('\n');
    };
    let (atoms, bonds) = (ligand.atoms(), ligand.bonds());
    put(format_args!("{:>3}{:>3}  0  0  0  0  0  0  0  0999 V2000", atoms.len(), bonds.len()));
    for (atom, at) in atoms.iter().zip(positions) {
        let [x, y, z] = [at.x, at.y, at.z].map(|x| x + 0.0);
        let symbol = atom.element.symbol();
        put(format_args!(
            "{x:>10.4}{y:>10.4}{z:>10.4} {symbol:<3} 0  0  0  0  0  0  0  0  0  0  0  0"
        ));
    }
    for bond in bonds {
        let [a, b] = bond.atoms.map(|atom| atom + 1);
        put(format_args!("{a:>3}{b:>3}{:>3}  0", code(bond.order)));
    }
    let charges: Vec<(usize, i8)> = charges(ligand).collect();
    for charges in charges.chunks(8) {
        let pairs: String =
            charges.iter().map(|(atom, charge)| format!(" {:>3} {charge:>3}", atom + 1)).collect();
        put(format_args!("M  CHG{:>3}{pairs}", charges.len()));
    }
}

fn v3000(ligand: &Ligand, positions: &[Point], out: &mut String) {
    let mut put = |text: std::fmt::Arguments| {
        out.write_fmt(text).expect("writing to memory cannot fail");
        out.push('\n');
    };
    let (atoms, bonds) = (ligand.atoms(), ligand.bonds());
    put(format_args!("  0  0  0     0  0            999 V3000\nM  V30 BEGIN CTAB"));
    put(format_args!("M  V30 COUNTS {} {} 0 0 0\nM  V30 BEGIN ATOM", atoms.len(), bonds.len()));
    for (number, (atom, at)) in atoms.iter().zip(positions).enumerate() {
        let [x, y, z] = [at.x, at.y, at.z].map(|x| x + 0.0);
        let charge = atom.formal_charge.filter(|charge| *charge != 0);
        let charge = charge.map_or_else(String::new, |charge| format!(" CHG={charge}"));
        let symbol = atom.element.symbol();
        put(format_args!("M  V30 {} {symbol} {x:.4} {y:.4} {z:.4} 0{charge}", number + 1));
    }
    put(format_args!("M  V30 END ATOM\nM  V30 BEGIN BOND"));
    for (number, bond) in bonds.iter().enumerate() {
        let [a, b] = bond.atoms.map(|atom| atom + 1);
        put(format_args!("M  V30 {} {} {a} {b}", number + 1, code(bond.order)));
    }
    put(format_args!("M  V30 END BOND\nM  V30 END CTAB"));
}

/// The atoms with a charge.
fn charges(ligand: &Ligand) -> impl Iterator<Item = (usize, i8)> {
    let charge = |(number, atom): (usize, &super::super::Atom)| Some((number, atom.formal_charge?));
    ligand.atoms().iter().enumerate().filter_map(charge).filter(|(_, charge)| *charge != 0)
}

/// The format's number of a bond's order.
fn code(order: BondOrder) -> u8 {
    match order {
        BondOrder::Single | BondOrder::Unknown => 1,
        BondOrder::Double => 2,
        BondOrder::Triple => 3,
        BondOrder::Aromatic => 4,
    }
}

/// A line of the header.
fn header(text: &str) -> String {
    let line = guarded(plain(text.trim()).as_ref());
    cut(&line, HEADER_MAX).trim_end().to_owned()
}

/// A line behind a blank, if by its beginning it could be taken for one of the format's own.
fn guarded(line: &str) -> String {
    let is_taken = ["$", ">", "@", "M  "].iter().any(|begin| line.starts_with(begin));
    if is_taken { format!(" {line}") } else { line.to_owned() }
}

/// Writes a data item: its name, its value in lines of at most 200 characters, and the blank line that ends it.
fn item(name: &str, value: &str, out: &mut String) {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let name: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    writeln!(out, "> <{}>", cut(&name, HEADER_MAX)).expect("writing to memory cannot fail");
    let value = plain(value.trim());
    let mut rest: &str = &value;
    while !rest.is_empty() {
        let line = cut(rest, DATA_MAX - 1);
        rest = &rest[line.len()..];
        // A blank line would end the value.
        if !line.trim().is_empty() {
            *out += &guarded(line);
            out.push('\n');
        }
    }
    out.push('\n');
}
