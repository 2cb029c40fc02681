//! The deformer: which lattice points are pushed, and how far (ICRA 2002, §6.1).
//!
//! Points are pushed toward a guide, the centre of the box, until nothing of an obstacle is on the segment that is left.

use super::lattice::Lattice;
use crate::deformation::{Obstacles, SoftBody};
use crate::scene::Pose;

/// From where rays are cast to the guide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rays {
    /// From the lattice points on the surface of the box, which are then pushed themselves: the paper's rule.
    FromBox,
    /// From the vertices of the robot. The corners of the cell around a vertex are pushed by the share of the way to the guide by which
    /// the vertex must be moved, so that what of the box is outside the robot causes no deformation. The cell shrinks
    /// toward the guide, an affine map, so that the vertex moves by just as much.
    FromRobot,
}

/// How far lattice points must be displaced toward the guide, at least.
pub(super) struct Pushes {
    /// The guide, in the robot's frame, and the lattice points that are held where they rest.
    pub guide: Guide,
    /// Per lattice point how far it is pushed, as a share of its way to the guide; 0 of those that are not.
    pub shares: Vec<f64>,
    /// Per lattice point the way to the guide.
    ways: Vec<[f64; 3]>,
}

/// Where points are pushed to.
#[derive(Clone)]
pub(super) struct Guide {
    pub at: [f64; 3],
    /// The lattice points nearest to it.
    pub held: Vec<usize>,
}

/// Where the robot's frame stands and among which obstacles.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub obstacles: &'a Obstacles,
    pub pose: &'a Pose,
    /// The least distance from obstacles.
    pub clearance: f64,
    /// How far beyond an obstacle a point is pushed: a little more than the clearance.
    pub beyond: f64,
}

impl Scene<'_> {
    /// How far a point of the robot's frame must be moved toward another until no obstacle is on the segment that is left; 0 if none
    /// is.
    fn length(&self, from: [f64; 3], to: [f64; 3]) -> f64 {
        let hit = self.obstacles.last_hit(self.pose.apply(from), self.pose.apply(to));
        let way = distance(from, to);
        hit.map_or(0.0, |share| (share * way + self.beyond).min(way))
    }

    /// The same as a share of the way.
    fn share(&self, from: [f64; 3], to: [f64; 3]) -> f64 {
        let length = self.length(from, to);
        if length > 0.0 { length / distance(from, to) } else { 0.0 }
    }
}

impl Guide {
    /// The centre of the box, and the lattice points nearest to it.
    pub fn centre(lattice: &Lattice) -> Guide {
        let at = lattice.centre();
        Guide { at, held: nearest(lattice, at, |_| true) }
    }

    /// The centre of the box; where that is within an obstacle, the lattice point nearest to it that is not: of those equally near the
    /// one from which the most points of the box's surface are seen, and of these the first. `None` if all are within obstacles.
    /// `centre` is the guide of [`Guide::centre`], which is the same at all poses.
    pub fn choose(lattice: &Lattice, centre: &Guide, scene: &Scene) -> Option<Guide> {
        if !scene.obstacles.contains(scene.pose.apply(centre.at)) {
            return Some(centre.clone());
        }
        let free =
            |index: &usize| !scene.obstacles.contains(scene.pose.apply(lattice.points[*index]));
        let candidates = nearest(lattice, centre.at, |index| free(&index));
        let surface: Vec<usize> =
            (0..lattice.points.len()).filter(|index| lattice.is_on_surface(*index)).collect();
        let seen = |index: &usize| {
            let at = scene.pose.apply(lattice.points[*index]);
            let sees = |other: &&usize| {
                let to = scene.pose.apply(lattice.points[**other]);
                scene.obstacles.first_hit(at, to).is_none()
            };
            surface.iter().filter(sees).count()
        };
        let best = candidates.into_iter().map(|index| (seen(&index), index));
        let (_, best) = best.max_by(|one, other| one.0.cmp(&other.0).then(other.1.cmp(&one.1)))?;
        Some(Guide { at: lattice.points[best], held: vec![best] })
    }
}

/// The lattice points that are nearest to a point, up to rounding, of those that may be.
fn nearest(lattice: &Lattice, to: [f64; 3], may: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut by_distance: Vec<(f64, usize)> =
        lattice.points.iter().enumerate().map(|(i, point)| (distance(*point, to), i)).collect();
    by_distance.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
    let Some(first) = by_distance.iter().position(|(_, index)| may(*index)) else {
        return Vec::new();
    };
    let farthest = by_distance[first].0 + 1e-9 * lattice.spacing.iter().sum::<f64>();
    let equal = by_distance[first..].iter().take_while(|(distance, _)| *distance <= farthest);
    let mut nearest: Vec<usize> = equal.map(|(_, index)| *index).filter(|i| may(*i)).collect();
    nearest.sort_unstable();
    nearest
}

/// The lattice points around each vertex that move it most: the corners of its cell.
pub(super) struct Cells(Vec<[u32; 8]>);

impl Cells {
    pub fn new(lattice: &Lattice, vertices: &[[f64; 3]]) -> Cells {
        let around = |vertex: &[f64; 3]| lattice.corners(lattice.cell(*vertex).0).map(|i| i as u32);
        Cells(vertices.iter().map(around).collect())
    }

    pub fn around(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        self.0[vertex].iter().map(|index| *index as usize)
    }
}

impl Pushes {
    /// What the rays to the guide demand of the lattice at rest.
    pub fn new(
        lattice: &Lattice,
        cells: &Cells,
        vertices: &[[f64; 3]],
        rays: Rays,
        guide: Guide,
        scene: &Scene,
    ) -> Pushes {
        let to_guide = |point: &[f64; 3]| [0, 1, 2].map(|k| guide.at[k] - point[k]);
        let ways = lattice.points.iter().map(to_guide).collect();
        let mut pushes = Pushes { shares: vec![0.0; lattice.points.len()], ways, guide };
        match rays {
            Rays::FromBox => {
                for (index, point) in lattice.points.iter().enumerate() {
                    if lattice.is_on_surface(index) {
                        let share = scene.share(*point, pushes.guide.at);
                        pushes.raise(index, share);
                    }
                }
            }
            Rays::FromRobot => {
                for (index, vertex) in vertices.iter().enumerate() {
                    let share = scene.share(*vertex, pushes.guide.at);
                    if share > 0.0 {
                        for corner in cells.around(index) {
                            pushes.raise(corner, share);
                        }
                    }
                }
            }
        }
        pushes
    }

    /// Pushes a point by at least a share of its way. Whether that is farther than before; no point is pushed beyond the guide.
    fn raise(&mut self, index: usize, share: f64) -> bool {
        let share = if share < 1.0 { share } else { 1.0 };
        let farther = share > self.shares[index];
        if farther {
            self.shares[index] = share;
        }
        farther
    }

    /// By which vector a point is pushed, if it is.
    pub fn vector(&self, index: usize) -> Option<[f64; 3]> {
        let share = self.shares[index];
        (share > 0.0).then(|| self.ways[index].map(|x| x * share))
    }

    /// Pushes what moves the colliding triangles of a shape farther: obstacles between rays, thinner than the lattice or caught between
    /// vertices, are met by no ray. The corners of the cells around the corners of a colliding triangle are pushed farther by
    /// what the rays from its corners and its middle, as it is deformed, still demand, and by `step` at least. Whether
    /// anything is pushed farther.
    pub fn deepen(
        &mut self,
        cells: &Cells,
        body: &SoftBody,
        vertices: &[[f64; 3]],
        step: f64,
        scene: &Scene,
    ) -> bool {
        let mut by = vec![0.0; self.shares.len()];
        for corners in body.triangles() {
            let at = corners.map(|corner| vertices[corner as usize]);
            let in_world = at.map(|corner| scene.pose.apply(corner));
            if !scene.obstacles.is_near(in_world, scene.clearance) {
                continue;
            }
            let middle = [0, 1, 2].map(|k| (at[0][k] + at[1][k] + at[2][k]) / 3.0);
            let mut length = step;
            for point in [at[0], at[1], at[2], middle] {
                let demanded = scene.length(point, self.guide.at);
                if demanded > length {
                    length = demanded;
                }
            }
            for corner in corners {
                let vertex = *corner as usize;
                let way = distance(body.vertices()[vertex], self.guide.at);
                for index in cells.around(vertex) {
                    if length > by[index] * way {
                        by[index] = if length < way { length / way } else { 1.0 };
                    }
                }
            }
        }
        let mut farther = false;
        for (index, by) in by.into_iter().enumerate() {
            farther |= by > 0.0 && self.raise(index, self.shares[index] + by);
        }
        farther
    }
}

fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| other[k] - one[k]);
    (x * x + y * y + z * z).sqrt()
}
