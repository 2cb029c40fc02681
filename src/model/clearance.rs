use super::Scratch;

/// The distance of the robot's surface from the nearest obstacle's surface, and the nearest points of the two (the
/// witnesses of the distance).
///
/// Ties go to the obstacle named first, then to its first triangle, then to the robot's first link and triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The distance of the surfaces, in the scene's unit: 0 where they meet. It is positive inside an obstacle, too:
    /// [`Model::validity`](super::Model::validity) tells whether the robot is inside.
    pub distance: f64,
    /// The nearest point of the robot, in the world's frame.
    pub on_robot: [f64; 3],
    /// The nearest point of the obstacle, in the world's frame.
    pub on_obstacle: [f64; 3],
    /// Index of the obstacle.
    pub obstacle: usize,
}

/// A [`Clearance`] with the motions that use it up.
#[derive(Clone, Debug, PartialEq)]
pub struct Approach {
    /// How far the nearest obstacle is.
    pub clearance: Clearance,
    /// How fast the robot's nearest point moves toward the obstacle's nearest point when the configuration moves, per number of
    /// [`Space::moved`](crate::space::Space::moved): lengths per unit of the degree of freedom. All are 0 where the surfaces meet, since
    /// then no direction leads from the one point to the other.
    pub rates: Vec<f64>,
}

/// What of a body's surface a witness of a clearance lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PartKind {
    /// A body that is convex as a whole: a box, a ball, a capsule, a cylinder or a point. It is not divided further.
    Convex,
    /// A vertex of a mesh.
    Vertex([[f64; 3]; 1]),
    /// An edge of a mesh, without its ends.
    Edge([[f64; 3]; 2]),
    /// A triangle of a mesh, without its edges.
    Face([[f64; 3]; 3]),
}

impl PartKind {
    /// The corners of the part, in the frame of its link or in the world's; none of a convex body.
    pub fn corners(&self) -> &[[f64; 3]] {
        match self {
            PartKind::Convex => &[],
            PartKind::Vertex(corners) => corners,
            PartKind::Edge(corners) => corners,
            PartKind::Face(corners) => corners,
        }
    }
}

/// The part of a body's surface that a witness of a clearance lies on. Points and directions are in the frame of the
/// link that the body belongs to, or, of an obstacle, in the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePart {
    /// The robot's link; `None` of an obstacle.
    pub link: Option<usize>,
    /// Index of the body among the link's bodies, or among the obstacles.
    pub body: usize,
    /// Of a mesh, the index of a triangle that has the part, among its [`faces`](crate::scene::Mesh::faces); else 0.
    pub triangle: usize,
    /// What the part is.
    pub kind: PartKind,
    /// The witness: without the padding, if the body has one.
    pub point: [f64; 3],
    /// The unit vector from there to the other body's witness, or zero where the surfaces meet.
    pub outward: [f64; 3],
}

/// The share of a part's size by which corners may be above a plane and yet count as in it, since they are rounded.
const FLAT: f64 = 1e-9;

impl SurfacePart {
    /// Whether two witnesses lie on the same part: on the same convex body, or on the same vertex, edge or triangle.
    pub fn is_same(&self, other: &SurfacePart) -> bool {
        let (own, others) = (self.kind.corners(), other.kind.corners());
        (self.link, self.body, own.len()) == (other.link, other.body, others.len())
            && own.iter().all(|corner| others.contains(corner))
    }

    /// Whether a witness can move from the one part to the other without a jump: the parts are the same, or they have a
    /// corner in common and neither rises above the plane through the other's witness that faces outward, as where
    /// triangles lie in a plane or meet at a convex edge. It is `false` of parts of different bodies, of parts without a common corner, and
    /// of parts on the two sides of a concave edge: the three cases of Figure 5.5 of H.-Y. Yeh's dissertation (2016).
    pub fn leads_to(&self, other: &SurfacePart) -> bool {
        if (self.link, self.body) != (other.link, other.body) {
            return false;
        }
        let (own, others) = (self.kind.corners(), other.kind.corners());
        let adjacent = own.iter().any(|corner| others.contains(corner));
        self.is_same(other) || adjacent && self.is_outmost_of(others) && other.is_outmost_of(own)
    }

    /// Whether none of the points lies farther outward than the witness.
    fn is_outmost_of(&self, points: &[[f64; 3]]) -> bool {
        points.iter().all(|point| {
            let way = [0, 1, 2].map(|i| point[i] - self.point[i]);
            let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            dot(&way, &self.outward) <= FLAT * dot(&way, &way).sqrt()
        })
    }
}

/// A [`Clearance`] with the parts of the two surfaces that its witnesses lie on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witnesses {
    /// How far the nearest obstacle is.
    pub clearance: Clearance,
    /// The part of the obstacle.
    pub of_obstacle: SurfacePart,
    /// The part of the robot.
    pub of_robot: SurfacePart,
}

/// The capability of a model whose robot moves among obstacles: how far the nearest one is.
pub trait Clearances {
    /// The shortest way from the robot at `q` to an obstacle; `None` if there are none.
    fn clearance(&self, q: &[f64], scratch: &mut Scratch) -> Option<Clearance>;

    /// The same, and which motions lead toward that obstacle; `None` if there are no obstacles.
    fn approach(&self, q: &[f64], scratch: &mut Scratch) -> Option<Approach>;

    /// The same, and on which parts of the two surfaces the witnesses lie; `None` if there are no obstacles.
    fn witnesses(&self, q: &[f64], scratch: &mut Scratch) -> Option<Witnesses>;

    /// How far what must stay within the bounds is from their sides at `q`, per axis from the lower and from the upper
    /// side; negative beyond them, infinite along axes that are not bounded.
    fn room(&self, q: &[f64], scratch: &mut Scratch) -> [[f64; 2]; 3];

    /// A bound on the length of the way of any robot point along [`Space::interpolate`](crate::space::Space::interpolate) from `a` to
    /// `b`. No clearance on the motion differs from that at an end by more.
    fn farthest(&self, a: &[f64], b: &[f64]) -> f64;
}
