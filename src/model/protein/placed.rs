//! A conformation: where the atoms of every residue are.

use crate::structure::Point;

/// The coordinates of one kind of atom, by residue, Å.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coordinates {
    /// Along the first axis of the source's frame.
    pub x: Vec<f64>,
    /// Along the second.
    pub y: Vec<f64>,
    /// Along the third.
    pub z: Vec<f64>,
}

impl Coordinates {
    /// Of this many residues, all at the origin.
    pub fn zeros(len: usize) -> Coordinates {
        Coordinates { x: vec![0.0; len], y: vec![0.0; len], z: vec![0.0; len] }
    }

    /// The number of residues.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is no residue.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// The position of a residue's atom.
    #[inline(always)]
    pub fn at(&self, residue: usize) -> Point {
        Point::new(self.x[residue], self.y[residue], self.z[residue])
    }

    /// Puts a residue's atom somewhere.
    pub fn put(&mut self, residue: usize, position: &Point) {
        self.x[residue] = position.x;
        self.y[residue] = position.y;
        self.z[residue] = position.z;
    }
}

/// The atoms of a conformation. What a residue lacks stands where its CA is, so that coordinates are always numbers:
/// `has_cb`, `has_centroid` and `has_hydrogen` say what there is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// The amide nitrogens.
    pub n: Coordinates,
    /// The alpha carbons.
    pub ca: Coordinates,
    /// The carbonyl carbons.
    pub c: Coordinates,
    /// The carbonyl oxygens.
    pub o: Coordinates,
    /// The beta carbons; glycine's is its CA.
    pub cb: Coordinates,
    /// The centroids of side chains.
    pub centroid: Coordinates,
    /// The amide hydrogens.
    pub h: Coordinates,
    /// Which residues have a CB.
    pub has_cb: Vec<bool>,
    /// Which residues have a side chain.
    pub has_centroid: Vec<bool>,
    /// Which residues have an amide hydrogen.
    pub has_hydrogen: Vec<bool>,
    /// What is computed on the way.
    pub(super) turns: Vec<[[f64; 4]; 2]>,
}

impl Placed {
    /// The number of residues.
    pub fn len(&self) -> usize {
        self.ca.len()
    }

    /// Whether there is no residue.
    pub fn is_empty(&self) -> bool {
        self.ca.is_empty()
    }

    /// Whether the residues of both lack the same atoms, so that one can be placed where the other was.
    pub fn lacks_what(&self, other: &Placed) -> bool {
        (&self.has_cb, &self.has_centroid, &self.has_hydrogen)
            == (&other.has_cb, &other.has_centroid, &other.has_hydrogen)
    }

    /// Fills it with what could mislead.
    pub fn poison(&mut self) {
        let Placed { n, ca, c, o, cb, centroid, h, .. } = self;
        for kind in [n, ca, c, o, cb, centroid, h] {
            [&mut kind.x, &mut kind.y, &mut kind.z]
                .into_iter()
                .for_each(|axis| axis.fill(f64::NAN));
        }
        self.turns.fill([[f64::NAN; 4]; 2]);
    }
}
