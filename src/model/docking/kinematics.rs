//! Where a ligand's atoms are at a configuration, and how an energy changes with it.
//!
//! A configuration is the position x y z of the ligand's centre, Å, its orientation as a unit quaternion w x y z, and one angle per
//! torsion link, radians. At the angles 0 the ligand has the shape that it was given with. The centre is the centroid of the
//! root piece's atoms, the frame that of the ligand's file.

use crate::ligand::{Ligand, LinkRule, RigidTree};
use crate::math;
use crate::structure::Point;

/// The configuration's values before its angles: a position and a quaternion.
pub(super) const BASE: usize = 7;

/// The ligand as a linkage: rigid pieces in the shape that the ligand was given with, and the links that turn them.
#[derive(Clone, Debug)]
pub(super) struct Linkage {
    /// Positions of all atoms in the given shape, from the centre, Å.
    shape: Vec<Point>,
    /// Where the centre is in the given pose, Å.
    centre: Point,
    /// The pieces: first the root's, then one for each link.
    pieces: Vec<Vec<usize>>,
    /// The links; link `k` turns piece `k + 1` and all that hang on it.
    links: Vec<Link>,
}

/// A torsion link.
#[derive(Clone, Debug)]
struct Link {
    /// The piece on the side of the root.
    parent: usize,
    /// The atom of the axis on the far side in the given shape, from the centre.
    point: Point,
    /// The axis' direction, of unit length, away from the root.
    axis: Point,
    /// How far from the axis an atom that the link moves can be, whatever the angles beyond it, Å.
    reach: f64,
    /// What a radian counts as in the metric of the space, Å.
    weight: f64,
}

/// The place of a rigid piece: a point p of the given shape is at `turn * p + shift`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    turn: Rotation,
    shift: Point,
}

impl Linkage {
    /// The linkage of a ligand, whose atoms have positions; without links if it is `rigid`.
    pub fn of(ligand: &Ligand, rule: LinkRule, rigid: bool) -> Option<Linkage> {
        let positions = ligand.positions()?;
        let tree = match rigid {
            true => RigidTree { pieces: vec![(0..positions.len()).collect()], links: Vec::new() },
            false => RigidTree::new(ligand, rule),
        };
        let root = tree.pieces.first()?;
        let sum = root.iter().fold(Point::zeros(), |sum, atom| sum + positions[*atom]);
        let centre = sum / root.len() as f64;
        let shape: Vec<Point> = positions.iter().map(|position| position - centre).collect();
        let link = |link: &crate::ligand::Link| {
            let [near, far] = link.axis;
            let direction = shape[far] - shape[near];
            let axis = direction / direction.norm();
            let from_axis = |atom: &usize| (shape[*atom] - shape[far]).cross(&axis).norm_squared();
            let mean = link.moved.iter().map(from_axis).sum::<f64>() / shape.len() as f64;
            let ways = ways_along_bonds(ligand, &shape, far);
            let reach = link.moved.iter().map(|atom| ways[*atom]).fold(0.0, f64::max);
            // A radian counts as what it moves the ligand by, but never as nothing: two conformations are not one.
            let weight = mean.sqrt().max(WEIGHT_MIN);
            Link { parent: link.parent, point: shape[far], axis, reach, weight }
        };
        let links = tree.links.iter().map(link).collect();
        Some(Linkage { centre, links, pieces: tree.pieces, shape })
    }

    /// How many torsion links there are.
    pub fn links(&self) -> usize {
        self.links.len()
    }

    /// The atoms of the pieces, first the root's, then those of the pieces that links turn.
    pub fn pieces(&self) -> &[Vec<usize>] {
        &self.pieces
    }

    /// The piece on the side of the root, of the piece with this number, which is not the root.
    pub fn parent(&self, piece: usize) -> usize {
        self.links[piece - 1].parent
    }

    /// The atom of the root piece that is nearest to the centre, of several the first.
    pub fn central_atom(&self) -> usize {
        let distance = |atom: &&usize| self.shape[**atom].norm_squared();
        let nearest = self.pieces[0].iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.copied().unwrap_or(0)
    }

    /// The configuration of the pose that the ligand was given with.
    pub fn given(&self) -> Vec<f64> {
        let mut q = vec![self.centre.x, self.centre.y, self.centre.z, 1.0, 0.0, 0.0, 0.0];
        q.resize(BASE + self.links.len(), 0.0);
        q
    }

    /// What a radian of the base's rotation counts as in the metric of the space, Å: about the root mean square of the way of all
    /// atoms when the ligand turns by a radian about a random axis through its centre.
    pub fn rotation_length(&self) -> f64 {
        let square = self.shape.iter().map(Point::norm_squared).sum::<f64>();
        (square / self.shape.len() as f64 * (2.0 / 3.0)).sqrt().max(WEIGHT_MIN)
    }

    /// What a radian of each torsion counts as in the metric of the space, Å: the root mean square of the ways of all atoms in the
    /// given shape.
    pub fn torsion_weights(&self) -> impl Iterator<Item = f64> {
        self.links.iter().map(|link| link.weight)
    }

    /// How far an atom is from the centre at most in the given shape, Å.
    pub fn radius(&self) -> f64 {
        self.shape.iter().map(Point::norm).fold(0.0, f64::max)
    }

    /// The largest distance of two atoms in the given shape, Å.
    pub fn diameter(&self) -> f64 {
        let from = |a: &Point| self.shape.iter().map(|b| (a - b).norm()).fold(0.0, f64::max);
        self.shape.iter().map(from).fold(0.0, f64::max)
    }

    /// An upper bound of how far any atom moves on the straight motion between two configurations, Å: `turn` is the angle of the
    /// base's rotation, radians.
    pub fn longest_way(&self, a: &[f64], b: &[f64], turn: f64) -> f64 {
        let square = (0..3).map(|axis| (b[axis] - a[axis]) * (b[axis] - a[axis])).sum::<f64>();
        let mut way = square.sqrt();
        // However the angles are, no atom is farther from the centre than the longest way along the links' bonds.
        way += turn * self.reach();
        for (at, link) in self.links.iter().enumerate() {
            way += math::wrap_angle(b[BASE + at] - a[BASE + at]).abs() * link.reach;
        }
        way
    }

    /// How far an atom can be from the centre, whatever the angles are, Å.
    pub fn reach(&self) -> f64 {
        let root = self.pieces[0].iter().map(|atom| self.shape[*atom].norm()).fold(0.0, f64::max);
        // Everything beyond a link of the root is within the reach of that link from an atom which does not move about the root.
        let of_root = self.links.iter().filter(|link| link.parent == 0);
        of_root.map(|link| link.point.norm() + link.reach).fold(root, f64::max)
    }

    /// Places the pieces at a configuration.
    pub fn place_pieces(&self, q: &[f64], pieces: &mut Vec<Placement>) {
        let turn = Rotation::of_quaternion([q[3], q[4], q[5], q[6]]);
        pieces.clear();
        pieces.push(Placement { turn, shift: Point::new(q[0], q[1], q[2]) });
        for (link, angle) in self.links.iter().zip(&q[BASE..]) {
            let placed = pieces[link.parent].turned(link, *angle);
            pieces.push(placed);
        }
    }

    /// The positions of a piece's atoms, written to `out` by the numbers of the atoms, Å.
    pub fn place_atoms(&self, piece: usize, placed: &Placement, out: &mut [Point]) {
        for atom in &self.pieces[piece] {
            out[*atom] = placed.turn.of(&self.shape[*atom]) + placed.shift;
        }
    }

    /// The positions of all atoms at a configuration, Å.
    pub fn place(&self, q: &[f64], pieces: &mut Vec<Placement>, out: &mut Vec<Point>) {
        self.place_pieces(q, pieces);
        out.resize(self.shape.len(), Point::zeros());
        for (number, placed) in pieces.iter().enumerate() {
            self.place_atoms(number, placed, out);
        }
    }

    /// From the gradient by the atoms' positions that by the configuration, in the numbers of
    /// [`Space::moved`](crate::space::Space::moved): three of the position, three of a rotation vector in the ligand's own frame, one for
    /// every torsion. `pieces` and `positions` are those of the configuration.
    pub fn gradient(
        &self,
        pieces: &[Placement],
        positions: &[Point],
        by_atoms: &[Point],
        sums: &mut Vec<[Point; 2]>,
        out: &mut [f64],
    ) {
        // Per piece the sum of its atoms' gradients, and that of their torques about the origin.
        sums.clear();
        sums.extend(self.pieces.iter().map(|atoms| {
            let zero = [Point::zeros(); 2];
            atoms.iter().fold(zero, |[force, torque], atom| {
                let by = by_atoms[*atom];
                [force + by, torque + positions[*atom].cross(&by)]
            })
        }));
        for (number, link) in self.links.iter().enumerate().rev() {
            let [force, torque] = sums[number + 1];
            let parent = &pieces[link.parent];
            let axis = parent.turn.of(&link.axis);
            let point = parent.turn.of(&link.point) + parent.shift;
            out[6 + number] = axis.dot(&(torque - point.cross(&force)));
            let [of_parent, torque_of_parent] = &mut sums[link.parent];
            *of_parent += force;
            *torque_of_parent += torque;
        }
        let ([force, torque], base) = (sums[0], &pieces[0]);
        let turning = base.turn.back(&(torque - base.shift.cross(&force)));
        for axis in 0..3 {
            out[axis] = force[axis];
            out[3 + axis] = turning[axis];
        }
    }
}

/// The least weight of a rotation in the metric, Å per radian.
const WEIGHT_MIN: f64 = 0.1;

impl Placement {
    /// The place of the piece beyond a link, this being that of the piece before it.
    fn turned(&self, link: &Link, angle: f64) -> Placement {
        let (sin, cos) = (math::sin(angle), math::cos(angle));
        let ([x, y, z], point): ([f64; 3], _) = (link.axis.into(), link.point);
        // Rodrigues' formula.
        let rest = 1.0 - cos;
        let turn = Rotation([
            [cos + x * x * rest, x * y * rest - z * sin, x * z * rest + y * sin],
            [y * x * rest + z * sin, cos + y * y * rest, y * z * rest - x * sin],
            [z * x * rest - y * sin, z * y * rest + x * sin, cos + z * z * rest],
        ]);
        let shift = self.turn.of(&(point - turn.of(&point))) + self.shift;
        Placement { turn: self.turn.after(&turn), shift }
    }
}

/// From one atom to each, the length of the shortest way along bonds, Å: an upper bound of their distance, whatever the
/// angles of torsion links are. All atoms of a ligand are joined by bonds.
fn ways_along_bonds(ligand: &Ligand, shape: &[Point], from: usize) -> Vec<f64> {
    let mut ways = vec![f64::INFINITY; shape.len()];
    ways[from] = 0.0;
    let lengths: Vec<([usize; 2], f64)> = ligand
        .bonds()
        .iter()
        .map(|bond| (bond.atoms, (shape[bond.atoms[0]] - shape[bond.atoms[1]]).norm()))
        .collect();
    let mut is_settled = false;
    while !is_settled {
        is_settled = true;
        for ([a, b], length) in &lengths {
            for (near, far) in [(*a, *b), (*b, *a)] {
                if ways[near] + length < ways[far] {
                    ways[far] = ways[near] + length;
                    is_settled = false;
                }
            }
        }
    }
    ways
}

/// A rotation as a matrix, row by row. The products are written out: they are most of what placing atoms takes.
#[derive(Clone, Copy, Debug)]
struct Rotation([[f64; 3]; 3]);

impl Rotation {
    /// That of a unit quaternion w x y z.
    fn of_quaternion([w, x, y, z]: [f64; 4]) -> Rotation {
        Rotation([
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ])
    }

    /// A vector, rotated.
    #[inline]
    fn of(&self, vector: &Point) -> Point {
        let [a, b, c] = &self.0;
        let (x, y, z) = (vector.x, vector.y, vector.z);
        Point::new(
            a[0] * x + a[1] * y + a[2] * z,
            b[0] * x + b[1] * y + b[2] * z,
            c[0] * x + c[1] * y + c[2] * z,
        )
    }

    /// A vector, rotated the other way.
    #[inline]
    fn back(&self, vector: &Point) -> Point {
        let [a, b, c] = &self.0;
        let (x, y, z) = (vector.x, vector.y, vector.z);
        Point::new(
            a[0] * x + b[0] * y + c[0] * z,
            a[1] * x + b[1] * y + c[1] * z,
            a[2] * x + b[2] * y + c[2] * z,
        )
    }

    /// This rotation after another one.
    #[inline]
    fn after(&self, first: &Rotation) -> Rotation {
        let [p, q, r] = &first.0;
        let row = |of: &[f64; 3]| {
            [
                of[0] * p[0] + of[1] * q[0] + of[2] * r[0],
                of[0] * p[1] + of[1] * q[1] + of[2] * r[1],
                of[0] * p[2] + of[1] * q[2] + of[2] * r[2],
            ]
        };
        let [a, b, c] = &self.0;
        Rotation([row(a), row(b), row(c)])
    }
}
