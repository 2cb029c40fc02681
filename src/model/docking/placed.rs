//! From positions of the ligand's atoms to configurations, and back.

use super::Docking;
use super::kinematics::BASE;
use crate::ligand::{Bond, Ligand, LinkRule, RigidTree, Symmetries, matching};
use crate::math;
use crate::model::Description;
use crate::space::canonical;
use crate::structure::measure::{Superposition, rmsd_in_place, superpose};
use crate::structure::{Point, torsion};
use nalgebra::Matrix3;

/// Atoms with more heavy neighbours than this are in no molecule; to look through all orders of hundreds of neighbours for every pair of poses would take
/// hours.
const NEIGHBOURS_MAX: usize = 16;

/// A symmetry counts as nearer from this difference on, Å: less is rounding.
const SAME: f64 = 1e-9;

/// So many atoms, not in a line, have one orientation; fewer can turn about an axis.
const RIGID_MIN: usize = 3;

impl Docking {
    /// The positions of the ligand's atoms at a configuration, Å.
    pub fn positions_at(&self, q: &[f64]) -> Vec<Point> {
        let mut positions = Vec::new();
        self.linkage().place(q, &mut Vec::new(), &mut positions);
        positions
    }

    /// Where the ligand's atoms are in a pose of the same molecule that another file has, in the order of this ligand's atoms, Å. Where
    /// hydrogens do not count here, those of the pose do not either. Atoms that are alike, as the oxygens of a carboxylate are, may change places.
    ///
    /// # Errors
    /// Another molecule, or one without positions: what was found, what is expected.
    pub fn positions_in(&self, pose: &Ligand) -> Result<Vec<Point>, String> {
        let has_hydrogens = self.ligand.atoms().iter().any(|atom| !atom.element.is_heavy());
        let heavy = if has_hydrogens { None } else { pose.without_hydrogens() };
        let pose = heavy.as_ref().unwrap_or(pose);
        let same = matching(&self.ligand, pose).ok_or_else(|| {
            format!(
                "{} atoms with {} bonds found, which are not the ligand's; the same molecule as the ligand, of {} atoms and {} bonds, \
                 expected",
                pose.atoms().len(),
                pose.bonds().len(),
                self.ligand.atoms().len(),
                self.ligand.bonds().len()
            )
        })?;
        let positions = pose.positions().ok_or_else(|| {
            "no positions found; a molecule with positions in space expected".to_owned()
        })?;
        Ok(same.into_iter().map(|atom| positions[atom]).collect())
    }

    /// The symmetries of the ligand; `None` where there are too many to be found in bounded time, as no molecule has.
    pub(crate) fn symmetries(&self) -> Option<Symmetries> {
        let atoms = self.ligand.atoms();
        let mut neighbours = vec![0; atoms.len()];
        for Bond { atoms: ends, .. } in self.ligand.bonds() {
            if ends.iter().all(|end| atoms[*end].element.is_heavy()) {
                ends.iter().for_each(|end| neighbours[*end] += 1);
            }
        }
        let is_molecule = neighbours.iter().all(|count| *count <= NEIGHBOURS_MAX);
        is_molecule.then(|| Symmetries::of(&self.ligand).ok()).flatten()
    }

    /// The configuration of the given shape, its torsions unturned, whose heavy atoms are as near as possible to these positions of all atoms: by
    /// the least sum of squares, over all symmetries of the ligand. A ring that another file numbers the other way around is not turned over.
    /// `None` if there are not as many positions as atoms.
    pub fn placed(&self, positions: &[Point]) -> Option<Vec<f64>> {
        let q = self.given();
        let from = self.positions_at(&q);
        if from.len() != positions.len() {
            return None;
        }
        let same = self.symmetries().and_then(|of| of.nearest_shape(&from, positions));
        let same = same.unwrap_or_else(|| (0..from.len()).collect());
        let mut compared: Vec<usize> = (0..from.len()).collect();
        compared.retain(|atom| self.ligand.atoms()[*atom].element.is_heavy());
        if compared.len() < RIGID_MIN {
            compared = (0..from.len()).collect();
        }
        let of = |atom: usize| (from[atom], positions[same[atom]]);
        let (from, to): (Vec<Point>, Vec<Point>) = compared.into_iter().map(of).unzip();
        self.moved(q, &superpose(&from, &to))
    }

    /// The configuration whose torsions are those of these positions of all atoms, and which is then as near to them as possible, and how far
    /// its atoms are from the positions, an RMSD in Å: lengths and angles of bonds stay as they are given. Of the ligand's symmetries it is the one
    /// that comes nearest, as another file may have both ends of an isopropyl group, which are mirror images, the other way around; where
    /// hydrogens count, atoms stay as they are numbered. `None` if there are not as many positions as atoms.
    pub fn shaped(&self, positions: &[Point]) -> Option<(Vec<f64>, f64)> {
        if positions.len() != self.ligand.atoms().len() {
            return None;
        }
        let mut best = self.turned(positions)?;
        let has_hydrogens = self.ligand.atoms().iter().any(|atom| !atom.element.is_heavy());
        let symmetries = if has_hydrogens { None } else { self.symmetries() };
        for to in symmetries.iter().flat_map(|symmetries| symmetries.listed()) {
            let exchanged: Vec<Point> = to.iter().map(|atom| positions[*atom]).collect();
            let next = self.turned(&exchanged)?;
            if next.1 < best.1 - SAME {
                best = next;
            }
        }
        Some(best)
    }

    /// As [`Docking::shaped`], atoms as they are numbered.
    fn turned(&self, positions: &[Point]) -> Option<(Vec<f64>, f64)> {
        let given = self.ligand.positions()?;
        let mut q = self.given();
        if !self.rigid {
            let tree = RigidTree::new(&self.ligand, LinkRule { amides: self.amides });
            for (link, angle) in tree.links.iter().zip(&mut q[BASE..]) {
                let [near, far] = link.axis;
                // A link has another atom at either end.
                let beside = |end: usize, other: usize| {
                    let joined = self.ligand.bonds().iter().find_map(|bond| match bond.atoms {
                        [a, b] if a == end && b != other => Some(b),
                        [a, b] if b == end && a != other => Some(a),
                        _ => None,
                    });
                    joined.unwrap_or(end)
                };
                let (before, behind) = (beside(near, far), beside(far, near));
                let turned = |at: &[Point]| torsion(&at[before], &at[near], &at[far], &at[behind]);
                *angle = math::wrap_angle(turned(positions) - turned(&given));
            }
        }
        let motion = superpose(&self.positions_at(&q), positions);
        let q = self.moved(q, &motion)?;
        let misfit = rmsd_in_place(positions, &self.positions_at(&q));
        Some((q, misfit))
    }

    /// The configuration moved as a whole by this motion, in stored form; its base must not be turned before.
    fn moved(&self, mut q: Vec<f64>, motion: &Superposition) -> Option<Vec<f64>> {
        let centre = motion.apply(&Point::new(q[0], q[1], q[2]));
        q[..3].copy_from_slice(centre.as_slice());
        q[3..BASE].copy_from_slice(&canonical(quaternion(&motion.rotation))?);
        self.space().canonicalize(&mut q).ok().map(|()| q)
    }
}

/// The unit quaternion w x y z of a rotation's matrix (S. W. Shepperd, *Quaternion from rotation matrix*, J. Guidance and Control 1 (1978)
/// 223): found from the largest of its four numbers, so that none is divided by a small one.
fn quaternion(m: &Matrix3<f64>) -> [f64; 4] {
    let trace = m[(0, 0)] + m[(1, 1)] + m[(2, 2)];
    let (mut largest, mut at) = (trace, 3);
    for axis in 0..3 {
        if m[(axis, axis)] > largest {
            (largest, at) = (m[(axis, axis)], axis);
        }
    }
    if at == 3 {
        return [1.0 + trace, m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]];
    }
    let (i, j, k) = (at, (at + 1) % 3, (at + 2) % 3);
    let mut out = [0.0; 4];
    out[0] = m[(k, j)] - m[(j, k)];
    out[1 + i] = 1.0 + m[(i, i)] - m[(j, j)] - m[(k, k)];
    out[1 + j] = m[(j, i)] + m[(i, j)];
    out[1 + k] = m[(k, i)] + m[(i, k)];
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_are_those_of_rotations_about_any_axis() {
        for q in [
            [1.0, 0.0, 0.0, 0.0],
            [0.1, 0.9, 0.2, -0.3],
            [0.0, 0.2, -0.9, 0.1],
            [0.05, 0.1, 0.2, 0.9],
        ] {
            let unit = canonical(q).unwrap();
            let [w, x, y, z] = unit;
            let matrix = Matrix3::new(
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            );
            let found = canonical(quaternion(&matrix)).unwrap();
            assert!(
                found.iter().zip(unit).all(|(a, b)| (a - b).abs() < 1e-14),
                "{found:?} {unit:?}"
            );
        }
    }
}
