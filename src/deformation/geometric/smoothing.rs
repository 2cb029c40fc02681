//! The limits of edge lengths, and the smoothing that restores them.

use super::surface::Surface;
use parry3d_f64::math::Vector;

/// How often all edges are gone through.
const SWEEPS: u32 = 200;
/// How far within the limits edges are brought, as a share of the range between rest and limit, so that a finite
/// number of sweeps ends within them.
const WITHIN: f64 = 0.02;
/// By how much less a vertex moves that takes full part in a push than one that was not pushed.
const HEAVIER: f64 = 0.9;
/// What rounding may add to the length of an edge, as a share of it.
const ROUNDING: f64 = 1e-9;

/// How short and how long an edge may become, as shares of its length at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub shortest: f64,
    pub longest: f64,
}

impl Limits {
    /// Whether all edges are within the limits.
    pub fn are_kept(&self, surface: &Surface, shape: &[Vector]) -> bool {
        surface.edges.iter().all(|edge| {
            let length = between(shape, edge.ends).1;
            length >= edge.length * (self.shortest - ROUNDING)
                && length <= edge.length * (self.longest + ROUNDING)
        })
    }

    /// The longest push that is tried of a region whose weight falls to 0 within `falloff`: twice the longest that leaves edges within
    /// their limits where the push goes across the surface, or along it. Smoothing spreads a push over more of the surface, but not without end.
    pub fn longest_push(&self, falloff: f64) -> f64 {
        let across = (self.longest * self.longest - 1.0).sqrt();
        2.0 * falloff * across.max(1.0 - self.shortest)
    }

    /// Moves vertices until edges are within the limits: each edge that is not is brought within them by moving its ends
    /// along it, edges in order, up to 200 times (position-based dynamics: M. Müller, B. Heidelberger, M. Hennix and
    /// J. Ratcliff, *Position based dynamics*, J. Visual Communication and Image Representation 18, 2007, §3.3). An edge that is within the limits moves
    /// nothing. `pushed` says per vertex which share of a push it took part in: the greater, the less the vertex is moved, since it
    /// would collide again.
    pub fn restore(&self, surface: &Surface, shape: &mut [Vector], pushed: &[f64]) {
        let within = |share: f64| {
            [
                self.shortest + share * (1.0 - self.shortest),
                self.longest - share * (self.longest - 1.0),
            ]
        };
        let (least, wanted) = (within(WITHIN / 2.0), within(WITHIN));
        for _ in 0..SWEEPS {
            let mut is_within = true;
            for edge in &surface.edges {
                let [a, b] = edge.ends.map(|end| end as usize);
                let (along, length) = between(shape, edge.ends);
                if length >= edge.length * least[0] && length <= edge.length * least[1] {
                    continue;
                }
                if length == 0.0 {
                    continue;
                }
                let wanted = length.clamp(edge.length * wanted[0], edge.length * wanted[1]);
                is_within = false;
                let (light, lighter) = (1.0 - HEAVIER * pushed[a], 1.0 - HEAVIER * pushed[b]);
                let by = along * ((length - wanted) / (length * (light + lighter)));
                shape[a] += by * light;
                shape[b] -= by * lighter;
            }
            if is_within {
                return;
            }
        }
    }
}

/// From the first vertex of an edge to the second, and how far that is.
fn between(shape: &[Vector], [a, b]: [u32; 2]) -> (Vector, f64) {
    let along = shape[b as usize] - shape[a as usize];
    (along, along.dot(along).sqrt())
}
