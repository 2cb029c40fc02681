//! Hydrogen bonds between the peptide groups of a chain.
//!
//! W. Kabsch & C. Sander, *Dictionary of protein secondary structure*, Biopolymers 22 (1983) 2577: the electrostatic
//! energy of the charges +q₁, −q₁ on C, O and −q₂, +q₂ on N, H,
//! E = q₁ q₂ f (1/r(ON) + 1/r(CH) − 1/r(OH) − 1/r(CN)), with q₁ = 0.42 e, q₂ = 0.20 e, f = 332 Å kcal/mol; a bond is what
//! is below −0.5 kcal/mol.
//!
//! **Hydrogens** are always placed by rule, also where the file has some: X-ray files have none, and rules of programs
//! that add them differ. As in the paper, H stands opposite to the C=O of the peptide group that N belongs to,
//! H = N + r · (C − O)/|C − O|: a peptide group is planar and its C=O and N–H are antiparallel to about 5°, and no
//! atom of the residue's own is needed. r is 1.01 Å, the length of the bond in force fields; the paper's program, DSSP, has
//! 1.00 Å, which makes the energies of bonds up to 0.08 kcal/mol weaker or stronger. Secondary structure is assigned with
//! 1.00 Å, so that it is DSSP's.

use super::cells::Cells;
use super::segments::segments;
use crate::structure::{AminoAcid, Point, Residue};

/// The length of the bond N–H, in Å.
const N_H: f64 = 1.01;

/// Its length in the paper's program, in Å.
const N_H_OF_DSSP: f64 = 1.00;

/// q₁ q₂ f, in Å kcal/mol.
pub const COUPLING: f64 = 0.42 * 0.20 * 332.0;

/// What is below this is a bond, in kcal/mol.
pub const WEAKEST: f64 = -0.5;

/// The lowest energy, in kcal/mol, which is also that of groups that overlap: as in the paper's program.
const STRONGEST: f64 = -9.9;

/// Atoms of two groups that are nearer than this overlap, in Å.
const OVERLAP: f64 = 0.5;

/// The farthest N and O that are looked at, in Å. In a row at usual bond lengths, the most favourable way, N–H and O=C
/// 5.2 Å apart still have −0.485 kcal/mol.
const FARTHEST: f64 = 6.0;

/// A hydrogen bond N–H···O=C. The residues are named by their indices in the list that was looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HydrogenBond {
    /// The residue of N and H.
    pub donor: usize,
    /// The residue of C and O.
    pub acceptor: usize,
    /// Its energy in kcal/mol, from −9.9 to −0.5.
    pub energy_kcal: f64,
}

/// The hydrogen on each residue's N, in Å. There is none on proline, on the first residue of a chain or after a break
/// (see [`segments`]), nor where C or O of the residue before were not seen.
pub fn amide_hydrogens(residues: &[Residue]) -> Vec<Option<Point>> {
    hydrogens(residues, N_H)
}

/// The hydrogens at this distance from N, in Å.
fn hydrogens(residues: &[Residue], n_h: f64) -> Vec<Option<Point>> {
    let segments = segments(residues);
    let hydrogen = |i: usize| {
        let before = i.checked_sub(1).filter(|before| segments[*before] == segments[i])?;
        if residues[i].amino_acid == Some(AminoAcid::Proline) {
            return None;
        }
        let (c, o) = (residues[before].position("C")?, residues[before].position("O")?);
        let direction = (c - o).try_normalize(0.0)?;
        Some(residues[i].position("N")? + direction * n_h)
    };
    (0..residues.len()).map(hydrogen).collect()
}

/// All hydrogen bonds between the peptide groups of residues at least two apart, by donor, then acceptor. A donor may
/// have several; [`strongest_two`] leaves at most two.
pub fn hydrogen_bonds(residues: &[Residue]) -> Vec<HydrogenBond> {
    bonds(residues, N_H)
}

/// Of each donor the two strongest bonds, with hydrogens 1.00 Å from N: what DSSP reads the secondary structure from.
pub(super) fn bonds_of_dssp(residues: &[Residue]) -> Vec<HydrogenBond> {
    strongest_two(&bonds(residues, N_H_OF_DSSP))
}

fn bonds(residues: &[Residue], n_h: f64) -> Vec<HydrogenBond> {
    let acceptors: Vec<(usize, Point, Point)> = residues
        .iter()
        .enumerate()
        .filter_map(|(i, residue)| Some((i, residue.position("C")?, residue.position("O")?)))
        .collect();
    let cells = Cells::new(acceptors.iter().map(|(.., o)| *o), FARTHEST);
    let mut bonds = Vec::new();
    for (donor, h) in hydrogens(residues, n_h).into_iter().enumerate() {
        let (Some(h), Some(n)) = (h, residues[donor].position("N")) else { continue };
        let first = bonds.len();
        cells.near(&n, |index| {
            let (acceptor, c, o) = acceptors[index];
            if donor.abs_diff(acceptor) < 2 || (n - o).norm() > FARTHEST {
                return;
            }
            let energy_kcal = energy(&n, &h, &c, &o);
            if energy_kcal < WEAKEST {
                bonds.push(HydrogenBond { donor, acceptor, energy_kcal });
            }
        });
        bonds[first..].sort_by_key(|bond| bond.acceptor);
    }
    bonds
}

/// Of each donor's bonds the two with the lowest energies, which are all that Kabsch & Sander's program keeps; of equal
/// ones those with the first acceptors. The bonds stand by donor, then acceptor, as [`hydrogen_bonds`] gives them, and
/// still do.
pub fn strongest_two(bonds: &[HydrogenBond]) -> Vec<HydrogenBond> {
    let mut kept = Vec::with_capacity(bonds.len());
    for of_donor in bonds.chunk_by(|a, b| a.donor == b.donor) {
        let mut strongest = of_donor.to_vec();
        strongest.sort_by(|a, b| a.energy_kcal.total_cmp(&b.energy_kcal));
        strongest.truncate(2);
        strongest.sort_by_key(|bond| bond.acceptor);
        kept.extend(strongest);
    }
    kept
}

/// The energy of N–H···O=C in kcal/mol, not below −9.9; NaN if a coordinate is.
pub fn energy(n: &Point, h: &Point, c: &Point, o: &Point) -> f64 {
    let pairs = [(o, n), (c, h), (o, h), (c, n)];
    let [on, ch, oh, cn] = pairs.map(|(a, b)| (a - b).norm());
    if [on, ch, oh, cn].iter().any(|distance| *distance < OVERLAP) {
        return STRONGEST;
    }
    let energy = COUPLING * (1.0 / on + 1.0 / ch - 1.0 / oh - 1.0 / cn);
    if energy < STRONGEST { STRONGEST } else { energy }
}

#[cfg(test)]
mod tests {
    use super::super::tests::ideal_chain;
    use super::*;

    #[test]
    fn the_energy_is_the_papers() {
        // A straight bond: N at 0, H at 1, O at 2.9, C at 4.13.
        let at = |x: f64| Point::x() * x;
        let expected = 27.888 * (1.0 / 2.9 + 1.0 / 3.13 - 1.0 / 1.9 - 1.0 / 4.13);
        assert!((energy(&at(0.0), &at(1.0), &at(4.13), &at(2.9)) - expected).abs() < 1e-12);
        assert!(energy(&at(0.0), &at(1.0), &at(7.44), &at(6.0)) > WEAKEST);
        assert_eq!(energy(&at(0.0), &at(1.0), &at(2.0), &at(1.0)), STRONGEST);
        assert_eq!(energy(&at(0.0), &at(1.0), &at(1.0), &at(1.0)), STRONGEST);
    }

    #[test]
    fn an_ideal_helix_binds_every_fourth_residue() {
        let helix = ideal_chain(12, -57.0, -47.0);
        let pairs: Vec<_> = hydrogen_bonds(&helix).iter().map(|b| (b.donor, b.acceptor)).collect();
        assert_eq!(pairs, (4..12).map(|i| (i, i - 4)).collect::<Vec<_>>());
        assert_eq!(hydrogen_bonds(&ideal_chain(12, -139.0, 135.0)), []);
    }

    #[test]
    fn hydrogens_stand_in_the_peptide_planes() {
        let helix = ideal_chain(6, -57.0, -47.0);
        let hydrogens = amide_hydrogens(&helix);
        assert_eq!(hydrogens[0], None);
        for (i, hydrogen) in hydrogens.iter().enumerate().skip(1) {
            let at = |of: usize, name| helix[of].position(name).expect("it is there");
            let (n, h) = (at(i, "N"), hydrogen.expect("there is one"));
            assert!(((h - n).norm() - 1.01).abs() < 1e-12);
            let normal = (at(i - 1, "C") - n).cross(&(at(i, "CA") - n));
            assert!((h - n).dot(&normal).abs() < 1e-3);
            // Nearly on the line that halves the angle C–N–CA, away from both.
            let [to_c, to_ca] = [at(i - 1, "C") - n, at(i, "CA") - n].map(|d| d.normalize());
            assert!((h - n).normalize().dot(&-(to_c + to_ca).normalize()) > 0.99);
        }
    }

    #[test]
    fn prolines_breaks_and_missing_atoms_have_no_hydrogen() {
        let mut chain = ideal_chain(8, -57.0, -47.0);
        chain[2].amino_acid = Some(AminoAcid::Proline);
        for residue in &mut chain[4..] {
            residue.atoms.iter_mut().for_each(|atom| atom.position.x += 3.0);
        }
        chain[5].atoms.retain(|atom| atom.name != "O");
        let there: Vec<bool> = amide_hydrogens(&chain).iter().map(Option::is_some).collect();
        assert_eq!(there, [false, true, false, true, false, true, false, true]);
    }

    #[test]
    fn of_many_bonds_the_two_strongest_stay() {
        let bond = |donor, acceptor, energy_kcal| HydrogenBond { donor, acceptor, energy_kcal };
        let bonds = [bond(1, 4, -1.0), bond(1, 6, -3.0), bond(1, 8, -1.0), bond(2, 9, -0.6)];
        assert_eq!(strongest_two(&bonds), [bonds[0], bonds[1], bonds[3]]);
    }
}
