use crate::model::protein::energy::{Constraint, ConstraintKind};
use crate::model::protein::equations::{Contacts, Exceptions, Kind, Sites};
use crate::model::protein::validity::Limits;
use crate::structure::Point;

/// A spring between two sites.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// One site.
    pub first: usize,
    /// The other.
    pub second: usize,
    /// The second derivative of its energy by its length, kT/Å².
    pub stiffness: f64,
    /// The first derivative, kT/Å.
    pub force: f64,
}

/// How far from its native length a constraint may be to be held, Å: what is farther is broken, and follows.
const HELD: f64 = 1.5;

/// The stiffness of pairs that are about as near as the rules allow, kT/Å², and how much farther than that they still have it, Å.
const OF_CONTACTS: f64 = 400.0;
const CONTACT_MARGIN: f64 = 0.4;
/// Pairs nearer than their limit and this are pushed apart, Å.
const CONTACT_REST: f64 = 0.15;

/// The stiffness of neighbouring Cα, kT/Å², how near they are, Å, and how many residues are between them at least.
const OF_NEIGHBOURS: f64 = 0.5;
const NEIGHBOURS: f64 = 7.5;
const NEIGHBOURS_APART: usize = 3;

/// What springs a chain can have.
#[derive(Clone, Debug)]
pub struct Springs {
    /// The constraints of all native structures, each by its two sites and its native length.
    constraints: Vec<(usize, usize, f64)>,
    limits: Limits,
}

impl Springs {
    /// Of these constraints, each only once, and what holds at nodes.
    pub fn new(constraints: &[Constraint], limits: Limits, sites: &Sites) -> Springs {
        let ends = |constraint: &Constraint| {
            let Constraint { kind, first, second, distance } = *constraint;
            let (a, b) = match kind {
                ConstraintKind::HydrogenBond => (Kind::Hydrogen, Kind::Oxygen),
                ConstraintKind::Disulphide => (Kind::SideChain, Kind::SideChain),
            };
            Some((sites.number(first, a)?, sites.number(second, b)?, distance))
        };
        let mut all: Vec<(usize, usize, f64)> = constraints.iter().filter_map(ends).collect();
        all.sort_by_key(|(a, b, _)| (*a, *b));
        all.dedup_by_key(|(a, b, _)| (*a, *b));
        Springs { constraints: all, limits }
    }

    /// The springs of a conformation: the constraints that hold there, with their own stiffness and force; pairs that are
    /// about as near as the rules allow; and neighbouring Cα, which hold what no hydrogen bond does.
    pub fn about(&self, sites: &Sites, positions: &[Point]) -> Vec<Spring> {
        let mut springs = Vec::new();
        for (first, second, native) in &self.constraints {
            let stretch = (positions[*second] - positions[*first]).norm() - native;
            if stretch.abs() <= HELD {
                let (force, stiffness) = Constraint::derivatives(stretch);
                springs.push(Spring { first: *first, second: *second, stiffness, force });
            }
        }
        let contacts = Contacts::of(self.limits, sites);
        for contact in contacts.find(positions, CONTACT_MARGIN, &Exceptions::new()) {
            let rest = contact.required - CONTACT_MARGIN + CONTACT_REST;
            let force = OF_CONTACTS * (contact.distance - rest).min(0.0);
            let (first, second) = (contact.first, contact.second);
            springs.push(Spring { first, second, stiffness: OF_CONTACTS, force });
        }
        let alphas: Vec<usize> = (0..sites.residues())
            .filter_map(|residue| sites.number(residue, Kind::AlphaCarbon))
            .collect();
        for (j, second) in alphas.iter().enumerate() {
            for first in alphas.iter().take((j + 1).saturating_sub(NEIGHBOURS_APART)) {
                let apart = (positions[*second] - positions[*first]).norm_squared();
                if apart <= NEIGHBOURS * NEIGHBOURS {
                    let (first, second) = (*first, *second);
                    springs.push(Spring { first, second, stiffness: OF_NEIGHBOURS, force: 0.0 });
                }
            }
        }
        springs
    }
}
