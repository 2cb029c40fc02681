//! A chain in lanes: residue number r of each of four segments at once.

use super::super::atoms::ResidueAtoms;
use super::super::linkage::{Linkage, TorsionKind};
use super::super::placed::{Coordinates, Placed};
use super::four::{Four, FourPoints, Frames, SEGMENTS, Vectors};
use super::frames::{Frame, Joint, Link, links};
use crate::math::{self, SIN_COS_WITHIN, sin_cos};
use crate::structure::Point;
use fearless_simd::f64x4;
use fearless_simd::prelude::*;

/// Residue number r of each segment; see [`Link`].
#[derive(Clone, Copy, Debug)]
struct FourLinks {
    /// Sine and cosine of the angle from phi's axis to psi's, and from psi's to the next phi's.
    tilts: [[Four; 2]; 2],
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
    /// By the number of a residue in its segment.
    links: Vec<FourLinks>,
    /// For phi and then psi of each of `links`: what is added to torsions.
    offsets: Vec<Four>,
    /// For each degree of freedom: where its torsion is in `offsets`, number and lane.
    slots: Vec<(u32, u32)>,
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
                tilts: [0, 1].map(|joint| {
                    let sin = four(of, |link| link.joints[joint].sin);
                    [sin, four(of, |link| link.joints[joint].cos)]
                }),
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
        Some(Chain { len: own.len(), first, links, offsets, slots })
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
        let mut frames = Frames::same(simd, &Frame::identity());
        for (links, [phi, psi]) in self.links.iter().zip(turns.as_chunks().0) {
            frames.turn(simd, phi);
            frames.tilt(simd, &links.tilts[0]);
            frames.turn(simd, psi);
            frames.ca = frames.at(simd, &links.next_ca);
            frames.tilt(simd, &links.tilts[1]);
        }
        let mut begins = [self.first; SEGMENTS];
        for segment in 1..SEGMENTS {
            begins[segment] = begins[segment - 1].then(&frames.lane(segment - 1));
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
        out.h.put(0, &self.first.ca);
        for ((number, links), [phi, psi]) in self.links.iter().enumerate().zip(turns.as_chunks().0)
        {
            let ca = frames.ca;
            store(&mut out.ca, count, number, ca);
            let n = frames.z * f64x4::load_array_ref(simd, &links.n);
            store(&mut out.n, count, number, ca - n);
            frames.turn(simd, phi);
            store(&mut out.cb, count, number, frames.at(simd, &links.cb));
            store(&mut out.centroid, count, number, frames.at(simd, &links.centroid));
            frames.tilt(simd, &links.tilts[0]);
            let c = frames.z * f64x4::load_array_ref(simd, &links.c);
            store(&mut out.c, count, number, ca + c);
            frames.turn(simd, psi);
            store(&mut out.o, count, number, frames.at(simd, &links.o));
            store(&mut out.h, count, number + 1, frames.at(simd, &links.next_h));
            frames.ca = frames.at(simd, &links.next_ca);
            frames.tilt(simd, &links.tilts[1]);
        }
    }
}

/// Stores positions of residue number `at` of each segment, the segments having `count` residues.
#[inline(always)]
fn store<S: Simd>(to: &mut Coordinates, count: usize, at: usize, position: Vectors<S>) {
    let Vectors { x, y, z } = position;
    let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
    let len = to.len();
    let (to_x, to_y, to_z) = (&mut to.x[..len], &mut to.y[..len], &mut to.z[..len]);
    for lane in 0..SEGMENTS {
        // Behind the end of the chain there is nothing.
        let residue = lane * count + at;
        if residue < len {
            to_x[residue] = x[lane];
            to_y[residue] = y[lane];
            to_z[residue] = z[lane];
        }
    }
}
