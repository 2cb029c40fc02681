//! A chain in lanes: residue number r of each of four segments at once.

use super::super::atoms::ResidueAtoms;
use super::super::linkage::{Linkage, TorsionKind};
use super::super::placed::{Coordinates, Placed};
use super::frames::{Frame, Joint, Link, links};
use crate::math::{self, SIN_COS_WITHIN, sin_cos};
use crate::structure::Point;
use fearless_simd::f64x4;
use fearless_simd::prelude::*;

/// As many segments as there are lanes in a vector.
const SEGMENTS: usize = 4;

/// A number of each segment.
type Four = [f64; SEGMENTS];

/// A vector of each segment, by coordinate.
type FourPoints = [Four; 3];

/// Residue number r of each segment; see [`Link`].
#[derive(Clone, Copy, Debug)]
struct FourLinks {
    /// Sines and cosines from phi's axis to psi's, and from psi's to the next phi's.
    sin: [Four; 2],
    cos: [Four; 2],
    n: Four,
    c: Four,
    cb: FourPoints,
    centroid: FourPoints,
    o: FourPoints,
    next_h: FourPoints,
    next_ca: FourPoints,
}

/// The chain.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// The number of residues.
    len: usize,
    /// Before the first torsion.
    first: Frame,
    /// Where the first residue's hydrogen would be: at its CA, since it has none.
    first_h: Point,
    /// By the number of a residue in its segment.
    links: Vec<FourLinks>,
    /// For phi and then psi of each of `links`: what is added to torsions.
    offsets: Vec<Four>,
    /// For each degree of freedom: where its torsion is in `offsets`, number and lane.
    slots: Vec<(u32, u32)>,
}

/// Three orthogonal unit vectors and a CA, of each segment.
#[derive(Clone, Copy)]
struct Frames<S: Simd> {
    x: [f64x4<S>; 3],
    y: [f64x4<S>; 3],
    z: [f64x4<S>; 3],
    ca: [f64x4<S>; 3],
}

fn four<T>(links: [&Link; SEGMENTS], of: impl Fn(&Link) -> T) -> [T; SEGMENTS] {
    links.map(of)
}

fn four_points(links: [&Link; SEGMENTS], of: impl Fn(&Link) -> Point) -> FourPoints {
    [0, 1, 2].map(|axis| four(links, |link| of(link)[axis]))
}

impl Chain {
    /// Of the atoms of a source and its linkage.
    pub fn new(atoms: &[ResidueAtoms], linkage: &Linkage) -> Option<Chain> {
        let (first, own) = links(atoms, linkage)?;
        let count = own.len().div_ceil(SEGMENTS);
        let still = Joint { offset: 0.0, sin: 0.0, cos: 1.0 };
        let zero = Point::zeros();
        // Behind the end of the chain nothing turns and nothing goes on.
        let nothing = Link {
            joints: [still, still],
            n: 0.0,
            c: 0.0,
            cb: zero,
            centroid: zero,
            o: zero,
            next_h: zero,
            next_ca: zero,
        };
        let (mut links, mut offsets) = (Vec::new(), Vec::new());
        for number in 0..count {
            let of = [0, 1, 2, 3].map(|lane| own.get(lane * count + number).unwrap_or(&nothing));
            offsets.extend([0, 1].map(|joint| four(of, |link| link.joints[joint].offset)));
            links.push(FourLinks {
                sin: [0, 1].map(|joint| four(of, |link| link.joints[joint].sin)),
                cos: [0, 1].map(|joint| four(of, |link| link.joints[joint].cos)),
                n: four(of, |link| link.n),
                c: four(of, |link| link.c),
                cb: four_points(of, |link| link.cb),
                centroid: four_points(of, |link| link.centroid),
                o: four_points(of, |link| link.o),
                next_h: four_points(of, |link| link.next_h),
                next_ca: four_points(of, |link| link.next_ca),
            });
        }
        let slot = |residue: usize, kind| {
            let joint = usize::from(kind == TorsionKind::Psi);
            ((2 * (residue % count) + joint) as u32, (residue / count) as u32)
        };
        let torsions = linkage.torsions.iter();
        let slots = torsions.map(|torsion| slot(torsion.residue, torsion.kind)).collect();
        let first_h = first.ca;
        Some(Chain { len: own.len(), first, first_h, links, offsets, slots })
    }

    /// Places all atoms.
    #[inline(always)]
    pub fn place<S: Simd>(&self, simd: S, q: &[f64], out: &mut Placed) {
        if self.len == 0 {
            return;
        }
        let mut turns = std::mem::take(&mut out.turns);
        self.turns(simd, q, &mut turns);
        let begins = self.begins(simd, &turns);
        self.atoms(simd, begins, &turns, out);
        out.turns = turns;
    }

    /// Sine and cosine of every turn: for phi and then psi of each of `links`.
    #[inline(always)]
    fn turns<S: Simd>(&self, simd: S, q: &[f64], turns: &mut Vec<[Four; 2]>) {
        turns.clear();
        turns.resize(self.offsets.len(), [[0.0; 4]; 2]);
        // The torsions stand where their sines are to be.
        for ((number, lane), value) in self.slots.iter().zip(q) {
            let value =
                if value.abs() < SIN_COS_WITHIN - 8.0 { *value } else { math::wrap_angle(*value) };
            turns[*number as usize][0][*lane as usize] = value;
        }
        for (turn, offset) in turns.iter_mut().zip(&self.offsets) {
            let angle = f64x4::load_array(simd, turn[0]) + f64x4::load_array(simd, *offset);
            let (sine, cosine) = sin_cos(simd, angle);
            *turn = [sine.to_array(), cosine.to_array()];
        }
    }

    /// Where each segment begins.
    #[inline(always)]
    fn begins<S: Simd>(&self, simd: S, turns: &[[Four; 2]]) -> Frames<S> {
        let same = |point: Point| [0, 1, 2].map(|axis| f64x4::splat(simd, point[axis]));
        let mut frames = Frames {
            x: same(Point::x()),
            y: same(Point::y()),
            z: same(Point::z()),
            ca: same(Point::zeros()),
        };
        for (links, turns) in self.links.iter().zip(turns.as_chunks().0) {
            let [phi, psi]: &[[Four; 2]; 2] = turns;
            frames.turn(simd, phi);
            frames.tilt(simd, &links.sin[0], &links.cos[0]);
            frames.turn(simd, psi);
            frames.ca = frames.at(simd, &links.next_ca);
            frames.tilt(simd, &links.sin[1], &links.cos[1]);
        }
        let ends = frames.to_frames();
        let mut begins = [self.first; SEGMENTS];
        for segment in 1..SEGMENTS {
            begins[segment] = begins[segment - 1].then(&ends[segment - 1]);
        }
        Frames::of(simd, &begins)
    }

    /// The atoms, given where the segments begin.
    #[inline(always)]
    fn atoms<S: Simd>(
        &self,
        simd: S,
        mut frames: Frames<S>,
        turns: &[[Four; 2]],
        out: &mut Placed,
    ) {
        let count = self.links.len();
        let store = |to: &mut Coordinates, at: usize, [x, y, z]: [f64x4<S>; 3]| {
            let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
            for lane in 0..SEGMENTS {
                let residue = lane * count + at;
                let axes = (to.x.get_mut(residue), to.y.get_mut(residue), to.z.get_mut(residue));
                if let (Some(to_x), Some(to_y), Some(to_z)) = axes {
                    (*to_x, *to_y, *to_z) = (x[lane], y[lane], z[lane]);
                }
            }
        };
        out.h.put(0, &self.first_h);
        for ((number, links), turns) in self.links.iter().enumerate().zip(turns.as_chunks().0) {
            let [phi, psi]: &[[Four; 2]; 2] = turns;
            store(&mut out.ca, number, frames.ca);
            let n = f64x4::load_array(simd, links.n);
            let back = frames.z.map(|z| z * n);
            let [x, y, z] = frames.ca;
            store(&mut out.n, number, [x - back[0], y - back[1], z - back[2]]);
            frames.turn(simd, phi);
            store(&mut out.cb, number, frames.at(simd, &links.cb));
            store(&mut out.centroid, number, frames.at(simd, &links.centroid));
            frames.tilt(simd, &links.sin[0], &links.cos[0]);
            let c = f64x4::load_array(simd, links.c);
            let on = frames.z.map(|z| z * c);
            store(&mut out.c, number, [x + on[0], y + on[1], z + on[2]]);
            frames.turn(simd, psi);
            store(&mut out.o, number, frames.at(simd, &links.o));
            store(&mut out.h, number + 1, frames.at(simd, &links.next_h));
            frames.ca = frames.at(simd, &links.next_ca);
            frames.tilt(simd, &links.sin[1], &links.cos[1]);
        }
    }
}

impl<S: Simd> Frames<S> {
    #[inline(always)]
    fn of(simd: S, frames: &[Frame; SEGMENTS]) -> Frames<S> {
        let gather = |of: fn(&Frame) -> Point| {
            [0, 1, 2].map(|axis| f64x4::load_array(simd, frames.map(|frame| of(&frame)[axis])))
        };
        Frames {
            x: gather(|frame| frame.axes[0]),
            y: gather(|frame| frame.axes[1]),
            z: gather(|frame| frame.axes[2]),
            ca: gather(|frame| frame.ca),
        }
    }

    fn to_frames(self) -> [Frame; SEGMENTS] {
        let point =
            |of: [f64x4<S>; 3], lane: usize| Point::new(of[0][lane], of[1][lane], of[2][lane]);
        [0, 1, 2, 3].map(|lane| Frame {
            axes: [point(self.x, lane), point(self.y, lane), point(self.z, lane)],
            ca: point(self.ca, lane),
        })
    }

    /// Turns about the third vector.
    #[inline(always)]
    fn turn(&mut self, simd: S, [sin, cos]: &[Four; 2]) {
        let (sin, cos) = (f64x4::load_array(simd, *sin), f64x4::load_array(simd, *cos));
        let (x, y) = (self.x, self.y);
        self.x = [0, 1, 2].map(
            #[inline(always)]
            |k| x[k] * cos + y[k] * sin,
        );
        self.y = [0, 1, 2].map(
            #[inline(always)]
            |k| y[k] * cos - x[k] * sin,
        );
    }

    /// Turns about the first vector.
    #[inline(always)]
    fn tilt(&mut self, simd: S, sin: &Four, cos: &Four) {
        let (sin, cos) = (f64x4::load_array(simd, *sin), f64x4::load_array(simd, *cos));
        let (y, z) = (self.y, self.z);
        self.y = [0, 1, 2].map(
            #[inline(always)]
            |k| y[k] * cos + z[k] * sin,
        );
        self.z = [0, 1, 2].map(
            #[inline(always)]
            |k| z[k] * cos - y[k] * sin,
        );
    }

    /// Where a position is that is seen from here.
    #[inline(always)]
    fn at(&self, simd: S, local: &FourPoints) -> [f64x4<S>; 3] {
        let local = [0, 1, 2].map(
            #[inline(always)]
            |k| f64x4::load_array(simd, local[k]),
        );
        [0, 1, 2].map(
            #[inline(always)]
            |k| self.ca[k] + (self.x[k] * local[0] + self.y[k] * local[1] + self.z[k] * local[2]),
        )
    }
}
