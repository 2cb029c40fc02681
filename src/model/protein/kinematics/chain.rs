//! A chain in lanes: residue number r of each of four segments at once.

use super::super::atoms::ResidueAtoms;
use super::super::linkage::{Linkage, TorsionKind};
use super::super::placed::{MIDDLE, Placed, Row, SEGMENTS, SITES, Site, Turn};
use super::four::{Eight, Four, FourPoints, Frames, Vectors};
use super::frames::{Frame, Joint, Link, links};
use crate::math::{self, SIN_COS_WITHIN, sin_cos};
use crate::structure::Point;
use fearless_simd::prelude::*;
use fearless_simd::{f64x4, f64x8};

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

/// The number of a torsion that does not turn.
const FIXED: u32 = u32::MAX;

/// The chain.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// The number of residues.
    len: usize,
    /// Before the first torsion.
    first: Frame,
    /// By the number of a residue in its segment.
    links: Vec<FourLinks>,
    /// For each of `links`: what is added to torsions.
    offsets: Vec<Eight>,
    /// For each of `offsets`: which degree of freedom its torsion is, [`FIXED`] if none.
    torsions: Vec<[u32; 2 * SEGMENTS]>,
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
            let [phi, psi] = [0, 1].map(|joint| four(of, |link| link.joints[joint].offset));
            offsets.push([phi[0], phi[1], phi[2], phi[3], psi[0], psi[1], psi[2], psi[3]]);
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
        let mut torsions = vec![[FIXED; 2 * SEGMENTS]; offsets.len()];
        for (number, torsion) in (0..).zip(&linkage.torsions) {
            let psi = usize::from(torsion.kind == TorsionKind::Psi) * SEGMENTS;
            torsions[torsion.residue % count][psi + torsion.residue / count] = number;
        }
        Some(Chain { len: own.len(), first, links, offsets, torsions })
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

    /// Sine and cosine of every turn, for each of `links`. Where an angle is as it was, so are they.
    #[inline(always)]
    fn turns<S: Simd>(&self, simd: S, q: &[f64], turns: &mut Vec<Turn>) {
        turns.resize(self.offsets.len(), Turn::UNKNOWN);
        let within = f64x8::splat(simd, SIN_COS_WITHIN - 8.0);
        for ((turn, offset), numbers) in turns.iter_mut().zip(&self.offsets).zip(&self.torsions) {
            let [a, b, c, d, e, f, g, h] = *numbers;
            let of = |number: u32| if let Some(q) = q.get(number as usize) { *q } else { 0.0 };
            let torsions = [of(a), of(b), of(c), of(d), of(e), of(f), of(g), of(h)];
            let mut torsions = f64x8::load_array(simd, torsions);
            if !torsions.abs().simd_lt(within).all_true() {
                torsions = f64x8::load_array(simd, torsions.to_array().map(wrapped));
            }
            let angles = torsions + f64x8::load_array_ref(simd, offset);
            let before = f64x8::load_array_ref(simd, &turn.angles);
            if !angles.to_bits().simd_eq(before.to_bits()).all_true() {
                let (sines, cosines) = sin_cos(simd, angles);
                angles.store_array(&mut turn.angles);
                sines.store_array(&mut turn.sines);
                cosines.store_array(&mut turn.cosines);
            }
        }
    }

    /// Where each segment begins.
    #[inline(always)]
    fn begins<S: Simd>(&self, simd: S, turns: &[Turn]) -> Frames<S> {
        let mut frames = Frames::same(simd, &Frame::identity());
        for (links, turn) in self.links.iter().zip(turns) {
            let [phi, psi] = loaded(simd, turn);
            frames.turn(phi);
            frames.tilt(simd, &links.tilts[0]);
            frames.turn(psi);
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
    fn atoms<S: Simd>(&self, simd: S, mut frames: Frames<S>, turns: &[Turn], out: &mut Placed) {
        let count = self.links.len();
        let rows = &mut out.rows[..self.len];
        // The hydrogen of a residue is carried by the one before; those of the first residues come at the end.
        let mut h = frames.ca;
        for ((number, links), turn) in self.links.iter().enumerate().zip(turns) {
            let [phi, psi] = loaded(simd, turn);
            let ca = frames.ca;
            let n = ca - frames.z * f64x4::load_array_ref(simd, &links.n);
            frames.turn(phi);
            let cb = frames.at(simd, &links.cb);
            let centroid = frames.at(simd, &links.centroid);
            frames.tilt(simd, &links.tilts[0]);
            let to_c = frames.z * f64x4::load_array_ref(simd, &links.c);
            let (c, middle) = (ca + to_c, ca + to_c * f64x4::splat(simd, MIDDLE));
            frames.turn(psi);
            let o = frames.at(simd, &links.o);
            store(simd, rows, count, number, [n, ca, c, o, cb, h, centroid, middle]);
            h = frames.at(simd, &links.next_h);
            frames.ca = frames.at(simd, &links.next_ca);
            frames.tilt(simd, &links.tilts[1]);
        }
        for lane in 0..SEGMENTS {
            let residue = (lane + 1) * count;
            if residue < self.len {
                rows[residue].put(Site::H, &h.lane(lane));
            }
        }
    }
}

/// Sine and cosine of phi, and those of psi.
#[inline(always)]
fn loaded<S: Simd>(simd: S, Turn { sines, cosines, .. }: &Turn) -> [[f64x4<S>; 2]; 2] {
    let (sin, sin2) = f64x8::load_array_ref(simd, sines).split();
    let (cos, cos2) = f64x8::load_array_ref(simd, cosines).split();
    [[sin, cos], [sin2, cos2]]
}

/// An angle that sines in lanes take.
#[cold]
fn wrapped(angle: f64) -> f64 {
    if angle.abs() < SIN_COS_WITHIN - 8.0 { angle } else { math::wrap_angle(angle) }
}

/// Stores the sites of residue number `at` of each segment, the segments having `count` residues.
#[inline(always)]
fn store<S: Simd>(simd: S, rows: &mut [Row], count: usize, at: usize, sites: [Vectors<S>; SITES]) {
    let [n, ca, c, o, cb, h, centroid, middle] = sites;
    let x = [
        transposed(simd, [n.x, ca.x, c.x, o.x]),
        transposed(simd, [cb.x, h.x, centroid.x, middle.x]),
    ];
    let y = [
        transposed(simd, [n.y, ca.y, c.y, o.y]),
        transposed(simd, [cb.y, h.y, centroid.y, middle.y]),
    ];
    let z = [
        transposed(simd, [n.z, ca.z, c.z, o.z]),
        transposed(simd, [cb.z, h.z, centroid.z, middle.z]),
    ];
    for lane in 0..SEGMENTS {
        // Behind the end of the chain there is nothing.
        let Some(Row(row)) = rows.get_mut(lane * count + at) else { return };
        for (to, [low, high]) in row.iter_mut().zip([&x, &y, &z]) {
            low[lane].store_slice(&mut to[..SEGMENTS]);
            high[lane].store_slice(&mut to[SEGMENTS..]);
        }
    }
}

/// Columns of four numbers become rows.
#[inline(always)]
fn transposed<S: Simd>(simd: S, [a, b, c, d]: [f64x4<S>; SEGMENTS]) -> [f64x4<S>; SEGMENTS] {
    let ((a, a2), (b, b2)) = (simd.split_f64x4(a), simd.split_f64x4(b));
    let ((c, c2), (d, d2)) = (simd.split_f64x4(c), simd.split_f64x4(d));
    [
        simd.combine_f64x2(a.zip_low(b), c.zip_low(d)),
        simd.combine_f64x2(a.zip_high(b), c.zip_high(d)),
        simd.combine_f64x2(a2.zip_low(b2), c2.zip_low(d2)),
        simd.combine_f64x2(a2.zip_high(b2), c2.zip_high(d2)),
    ]
}
