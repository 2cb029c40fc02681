//! How fast atoms move with torsions.
//!
//! Torsion k turns everything after its bond about the bond. An atom at x that it carries moves by u × (x − p) per radian,
//! where u is the bond's direction and p a point on it, both where the configuration has them. This is written
//! u × x + m with m = −u × p: a *screw*, which is one for all the atoms.

use crate::model::protein::linkage::{Linkage, Motion, Torsion};
use crate::structure::Point;

/// A velocity field of a rigid body: a position x moves by angular × x + linear.
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    /// The angular velocity.
    pub angular: Point,
    /// The velocity of the origin, Å.
    pub linear: Point,
}

impl Screw {
    /// The velocity of a position.
    pub fn at(&self, position: &Point) -> Point {
        self.angular.cross(position) + self.linear
    }
}

/// The screws of all torsions, per radian, at the configuration that has these motions. Screw k moves the bodies from k + 1 on.
pub fn screws(linkage: &Linkage, motions: &[Motion]) -> Vec<Screw> {
    let screw = |(torsion, motion): (&Torsion, &Motion)| {
        let angular = motion.rotation * torsion.axis.into_inner();
        let through = motion.apply(&torsion.through);
        Screw { angular, linear: through.cross(&angular) }
    };
    linkage.torsions.iter().zip(motions).map(screw).collect()
}

/// The change of the distance of two sites with the torsions between their bodies: one number per torsion from
/// `bodies.0` to before `bodies.1`, the lower body being the first one's. The distance is `(to - from).norm()`.
pub fn distance_gradient<'a>(
    screws: &'a [Screw],
    bodies: (usize, usize),
    from: &Point,
    to: &Point,
) -> impl Iterator<Item = f64> + use<'a> {
    let distance = (to - from).norm();
    // Atoms on one another are pushed apart along a fixed direction.
    let direction = if distance > 0.0 { (to - from) / distance } else { Point::x() };
    let to = *to;
    screws[bodies.0..bodies.1].iter().map(move |screw| direction.dot(&screw.at(&to)))
}
