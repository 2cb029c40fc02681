//! What the samples of a ligand say of its affinity: two metrics, each by three statistics.

use super::candidates::Exact;
use super::low::Low;
use crate::model::docking::Docking;
use crate::roadmap::Roadmap;
use crate::structure::Point;
use crate::structure::measure::mass;

/// The metrics of H.-Y. Yeh's chapter 6: the smaller, the stronger is the ligand said to bind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affinity {
    /// The distance of the centres of mass of the protein and of the ligand, Å.
    pub distance: Low,
    /// The energy by exact sums, kJ/mol.
    pub energy: Low,
}

impl Affinity {
    /// The metrics over all milestones of a roadmap; `None` if it has none, or none with a finite energy. Centres of mass
    /// are those of the atoms that count in the energy; an element without a known mass counts as carbon.
    pub fn of(exact: &Exact, docking: &Docking, roadmap: &Roadmap) -> Option<Affinity> {
        let protein = docking.chains().iter().flat_map(|chain| &chain.residues);
        let protein = protein.flat_map(|residue| &residue.atoms);
        let protein = centre_of_mass(protein.map(|atom| (atom.element.as_str(), atom.position)));
        let symbols: Vec<&str> =
            docking.ligand().atoms().iter().map(|atom| atom.element.symbol()).collect();
        let (mut distances, mut energies) = (Vec::new(), Vec::new());
        for q in roadmap.configs().iter() {
            let positions = exact.positions(q);
            let centre = centre_of_mass(symbols.iter().copied().zip(positions));
            distances.push((centre - protein).norm());
            energies.push(exact.energy(q).sum());
        }
        Some(Affinity { distance: Low::of(&distances)?, energy: Low::of(&energies)? })
    }

    /// The six numbers, in the order of [`Affinity::NAMES`].
    pub fn numbers(&self) -> [f64; 6] {
        let of = |low: Low| [low.minimum, low.percent, low.tenth];
        let ([a, b, c], [d, e, f]) = (of(self.distance), of(self.energy));
        [a, b, c, d, e, f]
    }

    /// What the six numbers are called.
    pub const NAMES: [&str; 6] = [
        "distance minimum",
        "distance 1 %",
        "distance 10 %",
        "energy minimum",
        "energy 1 %",
        "energy 10 %",
    ];
}

/// The mass of carbon, daltons.
const CARBON: f64 = 12.011;

fn centre_of_mass<'a>(atoms: impl Iterator<Item = (&'a str, Point)>) -> Point {
    let (mut sum, mut total) = (Point::zeros(), 0.0);
    for (symbol, position) in atoms {
        let mass = mass(symbol).unwrap_or(CARBON);
        sum += position * mass;
        total += mass;
    }
    sum / total
}
