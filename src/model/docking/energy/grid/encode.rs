//! How energies are kept.

use super::Lookup;
use crate::math;
use crate::structure::Point;

/// Above.
const CAP: f64 = 1e5;
const REPULSION_LEAST: f64 = 1e-12;
const ATTRACTION_LEAST: f64 = 1e-6;

pub(super) fn encode(lookup: Lookup, repulsion: f64, attraction: f64, out: &mut [f32]) {
    match lookup {
        Lookup::Nearest | Lookup::Trilinear | Lookup::Tricubic => {
            out[0] = (repulsion - attraction).min(CAP) as f32;
        }
        Lookup::Roots | Lookup::CubicRoots => {
            out[0] = math::exp(math::ln(repulsion.max(REPULSION_LEAST)) / -12.0) as f32;
            out[1] = math::exp(math::ln(attraction.max(ATTRACTION_LEAST)) / -6.0) as f32;
        }
    }
}

#[inline(always)]
pub(super) fn energy_of_roots([u, w]: [f64; 2], [du, dw]: [Point; 2]) -> (f64, Point) {
    let u = u.max(0.01);
    let w = w.max(0.01);
    let u2 = u * u;
    let u4 = u2 * u2;
    let u12 = u4 * u4 * u4;
    let w2 = w * w;
    let w6 = w2 * w2 * w2;
    let both = 1.0 / (u12 * w6);
    let (rep, att) = (w6 * both, u12 * both);
    let gradient = du * (-12.0 * rep / u) + dw * (6.0 * att / w);
    (rep - att, gradient)
}
