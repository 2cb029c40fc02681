//! How near a cubic curve comes to the origin.
//!
//! The curve is in Bernstein form, by four control points, in whose convex hull it lies (G. Farin, *Curves and Surfaces
//! for CAGD*, 2002, ch. 4).

use crate::structure::Point;

/// A curve: control points for the times 0, 1/3, 2/3 and 1, Å.
pub(super) type Cubic = [Point; 4];

/// More halvings would tell times apart that rounding does not.
const HALVINGS_MAX: u32 = 30;

/// What is known of a curve's distance from the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// At all times it is at least the greater of two distances.
    Apart,
    /// At some time it is less than the lesser.
    Close,
    /// At some time it is less than the greater, rounding aside, and whether it is ever less than the lesser was not found out.
    Between,
}

/// Holds the distance of the curve from the origin against `greater` and `lesser`, in Å.
pub(super) fn verdict(curve: &Cubic, greater: f64, lesser: f64) -> Verdict {
    piece(curve, greater, lesser, 0)
}

fn piece(curve: &Cubic, greater: f64, lesser: f64, halvings: u32) -> Verdict {
    // The hull is beyond a plane at that distance.
    let towards = curve[0] + curve[1] + curve[2] + curve[3];
    let reach = greater * towards.norm();
    if reach > 0.0 && curve.iter().all(|point| point.dot(&towards) >= reach) {
        return Verdict::Apart;
    }
    let ends = curve[0].norm_squared().min(curve[3].norm_squared());
    if lesser > 0.0 && ends < lesser * lesser {
        return Verdict::Close;
    }
    // What is no number does not keep.
    let ends_keep = ends >= greater * greater;
    if !ends_keep || halvings == HALVINGS_MAX {
        return Verdict::Between;
    }
    let [first, second] = halves(curve);
    match piece(&first, greater, lesser, halvings + 1) {
        Verdict::Apart => piece(&second, greater, lesser, halvings + 1),
        found => found,
    }
}

/// The halves of a curve (de Casteljau).
fn halves(curve: &Cubic) -> [Cubic; 2] {
    let middle = |a: &Point, b: &Point| (a + b) * 0.5;
    let [a, b, c] = [0, 1, 2].map(|k| middle(&curve[k], &curve[k + 1]));
    let (ab, bc) = (middle(&a, &b), middle(&b, &c));
    let half = middle(&ab, &bc);
    [[curve[0], a, ab, half], [half, bc, c, curve[3]]]
}
