use super::Geometric;
use super::directions::directions;
use super::push::push;
use super::regions::{Region, filled, regions, whole};
use super::settle::{Moved, settle};
use super::trial::Trial;
use crate::deformation::{Deformed, Refusal};
use crate::scene::Pose;
use parry3d_f64::math::Vector;
use std::cell::OnceCell;

/// By how much farther than the clearance triangles are pushed: as a share of the clearance, and of the robot's size, so that rounding
/// and smoothing do not at once make them collide. In later rounds it is as many times as much.
const BEYOND_CLEARANCE: f64 = 0.05;
const BEYOND_SIZE: f64 = 1e-5;
/// How often the neighbourhood is halved where a region can be freed neither by a push nor by the guide.
const HALVINGS: u32 = 2;

/// A way to free a region.
#[derive(Clone, Copy)]
enum Way {
    /// All in one direction.
    Push,
    /// All in one direction, together with what is cut off by the colliding triangles.
    PushAll,
    /// Toward the guide of this number.
    Region(usize),
    /// The whole surface toward the guide of this number, which is free.
    Whole(usize),
}

/// The ways that are compared, and those that are tried where none of these frees the region.
const WAYS: [Way; 4] = [Way::Push, Way::PushAll, Way::Region(0), Way::Region(1)];
const LAST_WAYS: [Way; 2] = [Way::Whole(0), Way::Whole(1)];

/// One pose at which the robot at rest is not free.
pub(super) struct Attempt<'a> {
    method: &'a Geometric,
    pose: &'a Pose,
    /// The vertices at rest in the world's frame.
    rest: Vec<Vector>,
    /// The guides, made when they are asked for.
    guides: [Guide; 2],
}

/// A guide at a pose.
#[derive(Default)]
struct Guide {
    /// The vertices in the world's frame.
    vertices: OnceCell<Vec<Vector>>,
    /// Whether all of it is free, by as much as is ever asked for.
    is_free: OnceCell<bool>,
}

impl<'a> Attempt<'a> {
    /// An attempt with the vertices at rest in the world's frame.
    pub fn new(method: &'a Geometric, pose: &'a Pose, rest: Vec<[f64; 3]>) -> Attempt<'a> {
        let rest = rest.into_iter().map(Vector::from_array).collect();
        Attempt { method, pose, rest, guides: Default::default() }
    }

    /// Rounds of pushing and smoothing, until the shape is accepted.
    pub fn deform(&self) -> Result<Deformed, Refusal> {
        let method = self.method;
        let mut shape = self.rest.clone();
        let mut refusal = Refusal::Collides;
        for round in 0..method.settings.rounds {
            let reach = method.clearance + self.beyond() * f64::from(round + 1);
            let moved = self.free(&shape, reach)?;
            let (mut next, pushed) = apply(&shape, &moved);
            if let Some(accepted) = self.accept(&next, &mut refusal) {
                return accepted;
            }
            method.limits.restore(&method.surface, &mut next, &pushed);
            shape = next;
            if let Some(accepted) = self.accept(&shape, &mut refusal) {
                return accepted;
            }
        }
        Err(refusal)
    }

    /// Where the vertices go that one round of pushes moves.
    fn free(&self, shape: &[Vector], reach: f64) -> Result<Vec<Moved>, Refusal> {
        let (method, surface) = (self.method, &self.method.surface);
        let collides = |corners: &[u32; 3]| {
            let corners = corners.map(|corner| shape[corner as usize].to_array());
            method.obstacles.is_near(corners, method.clearance)
        };
        let within: Vec<bool> =
            shape.iter().map(|vertex| method.obstacles.contains(vertex.to_array())).collect();
        let is_within = |corners: &[u32; 3]| corners.iter().any(|corner| within[*corner as usize]);
        let triangles = (0u32..).zip(&surface.triangles);
        let colliding: Vec<u32> = triangles
            .filter(|(_, corners)| is_within(corners) || collides(corners))
            .map(|(index, _)| index)
            .collect();
        if colliding.is_empty() {
            if method.obstacles.is_free(&as_arrays(shape), &surface.triangles, method.clearance) {
                // Only the limits are not kept yet.
                return Ok(Vec::new());
            }
            // An obstacle is within the robot. Only a guide knows on which side of it the surface belongs.
            let all = whole(surface, method.settings.neighbourhood);
            let mut ways = (0..self.guides.len()).map(Way::Whole);
            return ways.find_map(|way| self.by(way, &all, shape, reach)).ok_or(Refusal::Collides);
        }
        let mut moved = Vec::new();
        for region in regions(surface, &colliding, method.settings.neighbourhood) {
            moved.extend(self.free_region(&region, shape, reach, HALVINGS)?);
        }
        Ok(moved)
    }

    /// Where the region's vertices go: of the ways to free it after which the shape can be smoothed within its limits and does not meet
    /// itself, by the one with the least sum of displacements; if there is none such, by the whole guides, by halving the neighbourhood, or, since
    /// later rounds may mend the limits, by the first way of all.
    fn free_region(
        &self,
        region: &Region,
        shape: &[Vector],
        reach: f64,
        halvings: u32,
    ) -> Result<Vec<Moved>, Refusal> {
        let mut first = None;
        let mut best: Option<(f64, Vec<Moved>)> = None;
        for way in WAYS {
            let Some(moved) = self.by(way, region, shape, reach) else { continue };
            let sum = displacements(shape, &moved);
            let is_better = best.as_ref().is_none_or(|(least, _)| sum < *least);
            match is_better && self.is_good(shape, &moved) {
                true => best = Some((sum, moved)),
                false => first = first.or(Some(moved)),
            }
        }
        if let Some((_, best)) = best {
            return Ok(best);
        }
        for way in LAST_WAYS {
            let Some(moved) = self.by(way, region, shape, reach) else { continue };
            if self.is_good(shape, &moved) {
                return Ok(moved);
            }
            first = first.or(Some(moved));
        }
        if halvings > 0 && region.slope.is_finite() {
            let mut parts = Vec::new();
            for part in regions(&self.method.surface, &region.colliding, 0.5 / region.slope) {
                match self.free_region(&part, shape, reach, halvings - 1) {
                    Ok(moved) => parts.extend(moved),
                    Err(refusal) => return first.ok_or(refusal),
                }
            }
            if first.is_none() || self.is_good(shape, &parts) {
                return Ok(parts);
            }
        }
        first.ok_or(Refusal::Collides)
    }

    /// Where the region's vertices go in one of the ways to free it; `None` if it is not freed.
    fn by(&self, way: Way, region: &Region, shape: &[Vector], reach: f64) -> Option<Vec<Moved>> {
        let method = self.method;
        let (surface, obstacles) = (&method.surface, &*method.obstacles);
        let (region, guide) = match way {
            Way::Push => return self.push(region, shape, reach),
            Way::PushAll => return self.push(&filled(surface, region)?, shape, reach),
            Way::Region(guide) => (region, self.guide(guide)),
            Way::Whole(guide) => (&whole(surface, 1.0 / region.slope), self.free_guide(guide)?),
        };
        let target = |(vertex, weight): &(u32, f64)| {
            let at = shape[*vertex as usize];
            at + (guide[*vertex as usize] - at) * *weight
        };
        let targets: Vec<Vector> = region.vertices.iter().map(target).collect();
        let mut trial = Trial::new(surface, region, obstacles, reach, shape);
        trial.is_free(targets.iter().copied()).then(|| settle(&mut trial, &targets))
    }

    /// Where the region's vertices go by the shortest push.
    fn push(&self, region: &Region, shape: &[Vector], reach: f64) -> Option<Vec<Moved>> {
        let method = self.method;
        let (surface, obstacles) = (&method.surface, &*method.obstacles);
        let directions = directions(surface, region, shape, obstacles, reach, &method.uniform);
        let mut trial = Trial::new(surface, region, obstacles, reach, shape);
        let middle = Vector::from_array(self.pose.apply(method.centroid.to_array()));
        let falloff = 1.0 / region.slope + surface.mean_edge;
        let longest = method.limits.longest_push(falloff).min(method.size);
        let push = push(&mut trial, &directions, longest, middle)?;
        let target = |(vertex, weight): &(u32, f64)| shape[*vertex as usize] + push * *weight;
        let targets: Vec<Vector> = region.vertices.iter().map(target).collect();
        Some(settle(&mut trial, &targets))
    }

    /// Whether the shape, with these vertices moved, can be smoothed within its limits and does not meet itself then.
    fn is_good(&self, shape: &[Vector], moved: &[Moved]) -> bool {
        let (method, surface) = (self.method, &self.method.surface);
        let (mut shape, pushed) = apply(shape, moved);
        method.limits.restore(surface, &mut shape, &pushed);
        let meets_itself =
            || method.self_collision.as_ref().is_some_and(|check| check.is_met(surface, &shape));
        method.limits.are_kept(surface, &shape) && !meets_itself()
    }

    /// The vertices of a guide.
    fn guide(&self, number: usize) -> &[Vector] {
        let place = |vertex: &Vector| Vector::from_array(self.pose.apply(vertex.to_array()));
        let vertices = &self.guides[number].vertices;
        vertices.get_or_init(|| self.method.guides[number].iter().map(place).collect())
    }

    /// The vertices of a guide, if all of it is free.
    fn free_guide(&self, number: usize) -> Option<&[Vector]> {
        let method = self.method;
        let is_free = self.guides[number].is_free.get_or_init(|| {
            let reach = method.clearance + self.beyond() * f64::from(method.settings.rounds);
            method.obstacles.is_free(
                &as_arrays(self.guide(number)),
                &method.surface.triangles,
                reach,
            )
        });
        is_free.then(|| self.guide(number))
    }

    /// By how much farther than the clearance the first round pushes.
    fn beyond(&self) -> f64 {
        (BEYOND_CLEARANCE * self.method.clearance).max(BEYOND_SIZE * self.method.size)
    }

    /// The shape if all of it is as it must be, or why it is refused for good; otherwise `refusal` is set to what is wrong so far.
    fn accept(&self, shape: &[Vector], refusal: &mut Refusal) -> Option<Result<Deformed, Refusal>> {
        let method = self.method;
        if !method.limits.are_kept(&method.surface, shape) {
            *refusal = Refusal::Limits;
            return None;
        }
        let pose = self.pose.to_parry();
        let at_rest = method.body.vertices();
        // What was not moved keeps its coordinates; the rest is judged as it will be found, in the robot's frame and back.
        let vertices: Vec<[f64; 3]> = (0..shape.len())
            .map(|vertex| match shape[vertex] == self.rest[vertex] {
                true => at_rest[vertex],
                false => pose.inverse_transform_point(shape[vertex]).to_array(),
            })
            .collect();
        let judged: Vec<[f64; 3]> =
            vertices.iter().map(|vertex| self.pose.apply(*vertex)).collect();
        if !method.obstacles.is_free(&judged, method.body.triangles(), method.clearance) {
            *refusal = Refusal::Collides;
            return None;
        }
        let deformed: Vec<Vector> = vertices.iter().copied().map(Vector::from_array).collect();
        if let Some(self_collision) = &method.self_collision
            && self_collision.is_met(&method.surface, &deformed)
        {
            return Some(Err(Refusal::SelfCollision));
        }
        let displacement = |(now, rest): (&Vector, &[f64; 3])| {
            let by = *now - Vector::from_array(*rest);
            by.dot(by).sqrt()
        };
        let energy = deformed.iter().zip(at_rest).map(displacement).sum();
        if energy > method.highest_energy {
            return Some(Err(Refusal::Energy(energy)));
        }
        Some(Ok(Deformed { vertices, energy }))
    }
}

/// The shape with some vertices moved, those of several regions by the sum of their ways; and per vertex the share of a push that it took
/// part in.
fn apply(shape: &[Vector], moved: &[Moved]) -> (Vec<Vector>, Vec<f64>) {
    let (mut after, mut pushed) = (shape.to_vec(), vec![0.0; shape.len()]);
    for Moved { vertex, place, share } in moved {
        let vertex = *vertex as usize;
        after[vertex] += *place - shape[vertex];
        pushed[vertex] = share.max(pushed[vertex]);
    }
    (after, pushed)
}

/// The sum of the displacements of vertices.
fn displacements(shape: &[Vector], moved: &[Moved]) -> f64 {
    let way = |moved: &Moved| moved.place - shape[moved.vertex as usize];
    moved.iter().map(way).map(|way| way.dot(way).sqrt()).sum()
}

fn as_arrays(shape: &[Vector]) -> Vec<[f64; 3]> {
    shape.iter().map(|vertex| vertex.to_array()).collect()
}
