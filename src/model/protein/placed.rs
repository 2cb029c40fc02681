//! A conformation: where the atoms of every residue are.
//!
//! Positions stand residue by residue: a residue has eight [`Site`]s, and a row has the eight x, the eight y and the eight z of
//! these. Four residues are placed at once, each of which writes a row of its own; the rules and the energy
//! look at many sites of few residues, so that what is needed at one time stands in one place.

use crate::structure::Point;
use std::sync::Arc;

/// A point of a residue that rules and energies know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Site {
    /// The amide nitrogen.
    N,
    /// The alpha carbon.
    CA,
    /// The carbonyl carbon.
    C,
    /// The carbonyl oxygen.
    O,
    /// The beta carbon; glycine's is its CA.
    CB,
    /// The amide hydrogen.
    H,
    /// The centroid of the side chain.
    Centroid,
    /// A point between CA and C near which all backbone atoms are.
    Middle,
}

/// How many sites a residue has.
pub(super) const SITES: usize = 8;

/// Where the middle of a residue is on the way from its CA to its C: about as far from N and CB as from O, so that all
/// backbone atoms lie within 1.9 Å of it.
pub(super) const MIDDLE: f64 = 0.42;

/// The sites of a residue, in the order of [`Site`]: x, y and z, Å, in the source's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Row(pub [[f64; SITES]; 3]);

impl Row {
    /// Puts a site somewhere.
    pub(super) fn put(&mut self, site: Site, position: &Point) {
        for (axis, value) in self.0.iter_mut().zip(position.iter()) {
            axis[site as usize] = *value;
        }
    }
}

/// Into how many parts a chain is cut, which are placed at once.
pub(super) const SEGMENTS: usize = 4;

/// Angles of turns with their sines and cosines: phi and then psi of one residue in each segment of the chain.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Turn {
    /// Radians.
    pub angles: [f64; 2 * SEGMENTS],
    /// Of `angles`.
    pub sines: [f64; 2 * SEGMENTS],
    /// Of `angles`.
    pub cosines: [f64; 2 * SEGMENTS],
}

impl Turn {
    /// Of angles that no turn has.
    pub const UNKNOWN: Turn = Turn {
        angles: [f64::INFINITY; 2 * SEGMENTS],
        sines: [f64::NAN; 2 * SEGMENTS],
        cosines: [f64::NAN; 2 * SEGMENTS],
    };
}

/// The atoms of a conformation. What a residue lacks stands where its CA is, so that coordinates are always numbers:
/// `has_cb`, `has_centroid` and `has_hydrogen` say what there is.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    /// By residue.
    pub(super) rows: Vec<Row>,
    /// Which residues have a CB.
    pub(super) has_cb: Vec<bool>,
    /// Which residues have a side chain.
    pub(super) has_centroid: Vec<bool>,
    /// Which residues have an amide hydrogen.
    pub(super) has_hydrogen: Vec<bool>,
    /// The turns about its bonds when it was placed last. They are kept because the next conformation may differ in few.
    pub(super) turns: Vec<Turn>,
    /// The chain whose atoms stand where `turns` put them; `None` if some were put elsewhere.
    pub(super) chain: Option<Arc<()>>,
}

impl Placed {
    /// The number of residues.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no residue.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The position of a residue's site, Å.
    #[inline(always)]
    pub fn at(&self, site: Site, residue: usize) -> Point {
        let [x, y, z] = &self.rows[residue].0;
        let site = site as usize;
        Point::new(x[site], y[site], z[site])
    }

    /// Puts a residue's site somewhere, and with CA or C the middle between them.
    pub fn put(&mut self, site: Site, residue: usize, position: &Point) {
        self.chain = None;
        let row = &mut self.rows[residue];
        row.put(site, position);
        for axis in &mut row.0 {
            let (ca, c) = (axis[Site::CA as usize], axis[Site::C as usize]);
            axis[Site::Middle as usize] = ca + MIDDLE * (c - ca);
        }
    }

    /// Whether the residues of both lack the same atoms, so that one can be placed where the other was.
    pub fn lacks_what(&self, other: &Placed) -> bool {
        (&self.has_cb, &self.has_centroid, &self.has_hydrogen)
            == (&other.has_cb, &other.has_centroid, &other.has_hydrogen)
    }

    /// Fills it with what could mislead, and forgets what it knows.
    pub fn poison(&mut self) {
        self.rows.fill(Row([[f64::NAN; SITES]; 3]));
        self.turns.fill(Turn::UNKNOWN);
        self.chain = None;
    }
}
