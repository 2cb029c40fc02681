//! The hydrogen bonds that a refit is to keep, and how their energies change with torsions.

use crate::model::protein::equations::{Kind, Screw, Sites, distance_gradient};
use crate::structure::Point;
use crate::structure::measure::{HYDROGEN_BOND_COUPLING, HydrogenBond, hydrogen_bond_energy};

/// The four sites of a hydrogen bond N–H···O=C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bond {
    /// N of the donor.
    pub nitrogen: usize,
    /// H of the donor.
    pub hydrogen: usize,
    /// O of the acceptor.
    pub oxygen: usize,
    /// C of the acceptor.
    pub carbon: usize,
}

impl Bond {
    /// The sites of a bond of the target; `None` where the linkage has no hydrogen: where a proline is in its place.
    pub fn of(bond: &HydrogenBond, sites: &Sites) -> Option<Bond> {
        Some(Bond {
            nitrogen: sites.number(bond.donor, Kind::Nitrogen)?,
            hydrogen: sites.number(bond.donor, Kind::Hydrogen)?,
            oxygen: sites.number(bond.acceptor, Kind::Oxygen)?,
            carbon: sites.number(bond.acceptor, Kind::Carbon)?,
        })
    }

    /// The energy in kcal/mol (Kabsch & Sander 1983).
    pub fn energy(&self, positions: &[Point]) -> f64 {
        hydrogen_bond_energy(
            &positions[self.nitrogen],
            &positions[self.hydrogen],
            &positions[self.carbon],
            &positions[self.oxygen],
        )
    }

    /// H···O, in Å.
    pub fn length(&self, positions: &[Point]) -> f64 {
        (positions[self.oxygen] - positions[self.hydrogen]).norm()
    }

    /// The least body and the greatest of the four sites.
    pub fn bodies(&self, sites: &Sites) -> (usize, usize) {
        let bodies = [self.nitrogen, self.hydrogen, self.oxygen, self.carbon]
            .map(|number| sites.body(number));
        bodies.iter().fold((usize::MAX, 0), |(least, greatest), body| {
            (least.min(*body), greatest.max(*body))
        })
    }

    /// The derivatives of the energy with the torsions between the bodies of [`Bond::bodies`], kcal/mol per radian.
    pub fn energy_gradient(
        &self,
        sites: &Sites,
        screws: &[Screw],
        positions: &[Point],
    ) -> Vec<f64> {
        let (least, greatest) = self.bodies(sites);
        let mut gradient = vec![0.0; greatest - least];
        let pairs = [
            (self.oxygen, self.nitrogen, 1.0),
            (self.carbon, self.hydrogen, 1.0),
            (self.oxygen, self.hydrogen, -1.0),
            (self.carbon, self.nitrogen, -1.0),
        ];
        for (a, b, sign) in pairs {
            let (a, b) = if sites.body(a) <= sites.body(b) { (a, b) } else { (b, a) };
            let squared = (positions[b] - positions[a]).norm_squared();
            let bodies = (sites.body(a), sites.body(b));
            let slopes = distance_gradient(screws, bodies, &positions[a], &positions[b]);
            for (entry, slope) in gradient[bodies.0 - least..].iter_mut().zip(slopes) {
                *entry -= sign * HYDROGEN_BOND_COUPLING / squared * slope;
            }
        }
        gradient
    }
}
