//! The frames in which a chain is rigid, piece by piece.
//!
//! Along the chain the axes of phi and psi alternate, N–CA and CA–C. Torsion number k has a frame in the source whose third
//! vector is its axis and whose first is perpendicular to this axis and to the next one. From it the next
//! frame is reached by a turn about the first vector, which brings one axis on to the next, and by a turn about that
//! axis, which is where the next torsion turns too. So a torsion costs two turns of two vectors each: 24 products. These are
//! the angles of J. Denavit and R. S. Hartenberg (J. Appl. Mech. 22, 1955); their lengths would grow without bound where
//! two axes are nearly parallel, as they are across a peptide bond, so that origins are not theirs: all are at a CA.

use super::super::atoms::ResidueAtoms;
use super::super::linkage::{Linkage, TorsionKind};
use crate::math;
use crate::structure::Point;

/// Below this the cross product of two unit vectors is rounding alone.
const PARALLEL: f64 = 1e-12;

/// How a torsion turns, and to the next one's axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    /// What is added to the torsion to get the angle of the turn about its axis, or that angle if the torsion is fixed; in
    /// radians.
    pub offset: f64,
    /// The sine and the cosine of the angle between its axis and the next.
    pub sin: f64,
    /// See `sin`.
    pub cos: f64,
}

/// A residue: its torsions, and its atoms in the frames that carry them, Å from its CA.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// Phi and psi.
    pub joints: [Joint; 2],
    /// How far N is before CA on phi's axis.
    pub n: f64,
    /// How far C is after CA on psi's axis.
    pub c: f64,
    /// In phi's frame, as it is after phi's turn.
    pub cb: Point,
    /// In phi's frame too.
    pub centroid: Point,
    /// In psi's frame, as it is after psi's turn.
    pub o: Point,
    /// The hydrogen of the next residue, in psi's frame.
    pub next_h: Point,
    /// The CA of the next residue, in psi's frame.
    pub next_ca: Point,
}

/// Three orthogonal unit vectors and a CA.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub axes: [Point; 3],
    pub ca: Point,
}

impl Frame {
    /// The source's own axes at its origin.
    pub fn identity() -> Frame {
        Frame { axes: [Point::x(), Point::y(), Point::z()], ca: Point::zeros() }
    }

    /// A direction of this frame, in the frame in which this one is given.
    fn turned(&self, v: &Point) -> Point {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    /// A frame given in this one, in the frame in which this one is given.
    pub fn then(&self, inner: &Frame) -> Frame {
        let [x, y, z] = &inner.axes;
        let axes = [self.turned(x), self.turned(y), self.turned(z)];
        Frame { axes, ca: self.ca + self.turned(&inner.ca) }
    }

    /// Where a position is as seen from here.
    fn local(&self, position: &Point) -> Point {
        let from = position - self.ca;
        let [x, y, z] = &self.axes;
        Point::new(x.dot(&from), y.dot(&from), z.dot(&from))
    }
}

/// A unit vector perpendicular to an axis, the nearest to the one that is wished for.
fn perpendicular(axis: &Point, wish: &Point) -> Option<Point> {
    (wish - axis * axis.dot(wish)).try_normalize(PARALLEL)
}

/// The links of a chain, and the frame with which it begins: that of the first phi before its turn. `None` where atoms of a
/// backbone stand on one another.
pub(super) fn links(atoms: &[ResidueAtoms], linkage: &Linkage) -> Option<(Frame, Vec<Link>)> {
    let mut axes = Vec::with_capacity(2 * atoms.len());
    for atoms in atoms {
        axes.push((atoms.ca - atoms.n).try_normalize(1e-3)?);
        axes.push((atoms.c - atoms.ca).try_normalize(1e-3)?);
    }
    let frame = |k: usize, before: &Point| {
        let z = axes[k];
        let common = axes.get(k + 1).map_or(Point::zeros(), |next| z.cross(next));
        let x = (common.norm() > PARALLEL)
            .then(|| perpendicular(&z, &common))
            .flatten()
            .or_else(|| perpendicular(&z, before))
            .or_else(|| perpendicular(&z, &Point::x()))
            .or_else(|| perpendicular(&z, &Point::y()))?;
        Some(Frame { axes: [x, z.cross(&x), z], ca: atoms[k / 2].ca })
    };
    let mut torsions = linkage.torsions.iter().peekable();
    let mut before: Option<Point> = None;
    let mut joint = |k: usize, frame: &Frame| {
        let [x, _, z] = &frame.axes;
        // From the first vector of the frame before; the first frame of all is where it is.
        let from = before.unwrap_or(*x);
        let mut offset = math::atan2(z.cross(&from).dot(x), from.dot(x));
        before = Some(*x);
        let kind = [TorsionKind::Phi, TorsionKind::Psi][k % 2];
        let is_this = |torsion: &&super::super::linkage::Torsion| {
            torsion.residue == k / 2 && torsion.kind == kind
        };
        if let Some(torsion) = torsions.next_if(is_this) {
            offset -= torsion.source;
        }
        let (sin, cos) =
            axes.get(k + 1).map_or((0.0, 1.0), |next| (x.dot(&z.cross(next)), z.dot(next)));
        Joint { offset, sin, cos }
    };
    let mut links = Vec::with_capacity(atoms.len());
    let mut first = None;
    let mut wish = Point::x();
    for (i, own) in atoms.iter().enumerate() {
        let phi = frame(2 * i, &wish)?;
        let psi = frame(2 * i + 1, &phi.axes[0])?;
        wish = psi.axes[0];
        first.get_or_insert(phi);
        let joints = [joint(2 * i, &phi), joint(2 * i + 1, &psi)];
        let next = atoms.get(i + 1);
        let next_ca = next.map_or(own.ca, |next| next.ca);
        links.push(Link {
            joints,
            n: (own.ca - own.n).norm(),
            c: (own.c - own.ca).norm(),
            cb: phi.local(&own.cb.unwrap_or(own.ca)),
            centroid: phi.local(&own.centroid.unwrap_or(own.ca)),
            o: psi.local(&own.o),
            next_h: psi.local(&next.and_then(|next| next.hydrogen).unwrap_or(next_ca)),
            next_ca: psi.local(&next_ca),
        });
    }
    Some((first.unwrap_or(Frame::identity()), links))
}
