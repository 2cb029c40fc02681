//! Geometric deformation (Bayazit, Lien and Amato, *Probabilistic Roadmap Motion Planning for Deformable Objects*, ICRA 2002, §6.2): the
//! triangles of the robot that collide are moved until they are free.
//!
//! Colliding triangles make [regions](regions). Each is pushed in one of several [directions](directions), the one in which the
//! [push](push) is shortest, or, where none frees it, toward a [smaller robot](guide) that is free; then it [settles](settle) against the
//! obstacle. [Smoothing](smoothing) restores the limits of edge lengths. As long as that makes triangles collide again, this is repeated.
//!
//! A shape is a pure function of the pose. It follows the pose continuously but where the choice among directions, or whether there is a region,
//! changes: there it jumps. `docs/deformable-geometric.md` says what of this the paper leaves open.

mod directions;
mod guide;
mod push;
mod regions;
mod self_collision;
mod settle;
mod smoothing;
mod surface;
mod trial;

use self::regions::{Region, regions};
use self::self_collision::SelfCollision;
use self::settle::{Moved, settle};
use self::smoothing::Limits;
use self::surface::Surface;
use self::trial::Trial;
use super::{Deform, Deformed, Obstacles, Refusal, SoftBody};
use crate::model::deformable::GeometricSettings;
use crate::scene::Pose;
use parry3d_f64::math::Vector;
use std::cell::OnceCell;
use std::sync::Arc;

/// By how much farther than the clearance triangles are pushed: as a share of the clearance, and of the robot's size, so that rounding
/// and smoothing do not at once make them collide. In later rounds it is as many times as much.
const BEYOND_CLEARANCE: f64 = 0.05;
const BEYOND_SIZE: f64 = 1e-5;
/// How often the neighbourhood is halved where a region can be freed neither by a push nor by the guide.
const HALVINGS: u32 = 2;

/// Deformation of the robot's own triangles.
///
/// The energy of a shape is the sum of the displacements of all vertices from where they are at rest, a length.
pub struct Geometric {
    body: SoftBody,
    settings: GeometricSettings,
    highest_energy: f64,
    clearance: f64,
    obstacles: Arc<Obstacles>,
    surface: Surface,
    uniform: Vec<Vector>,
    /// The vertices of the guide, in the robot's frame.
    guide: Vec<[f64; 3]>,
    /// The centroid of the robot at rest, in its frame.
    centroid: Vector,
    /// The diagonal of the robot's bounding box.
    size: f64,
    self_collision: Option<SelfCollision>,
}

impl Geometric {
    /// A method that deforms this robot among these obstacles. Shapes have at most `highest_energy`, a length that may be infinite, and are no nearer
    /// to obstacles than `clearance`.
    ///
    /// # Errors
    /// What of the settings is out of its range.
    pub fn new(
        body: &SoftBody,
        settings: &GeometricSettings,
        highest_energy: f64,
        clearance: f64,
        obstacles: Arc<Obstacles>,
    ) -> Result<Geometric, String> {
        check(settings, highest_energy, clearance)?;
        let surface = Surface::new(body);
        let rest: Vec<Vector> = body.vertices().iter().copied().map(Vector::from_array).collect();
        let centroid = guide::centroid(body);
        let (min, max) = body.mesh().bounding_box();
        let diagonal = Vector::from_array(max) - Vector::from_array(min);
        let smaller = |vertex: &Vector| (centroid + (*vertex - centroid) * settings.guide).to_array();
        Ok(Geometric {
            guide: rest.iter().map(smaller).collect(),
            uniform: directions::uniform(settings.directions),
            self_collision: settings.refuse_self_collisions.then(|| SelfCollision::new(&surface, &rest)),
            size: diagonal.dot(diagonal).sqrt(),
            body: body.clone(),
            settings: settings.clone(),
            highest_energy,
            clearance,
            obstacles,
            surface,
            centroid,
        })
    }
}

/// What of the settings is out of its range.
fn check(settings: &GeometricSettings, highest_energy: f64, clearance: f64) -> Result<(), String> {
    let GeometricSettings { shortest, longest, neighbourhood, guide, .. } = *settings;
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    let wrong = [
        ((0.0..=1.0).contains(&shortest), "shortest", shortest, "a share of at least 0 and at most 1"),
        (longest >= 1.0 && longest.is_finite(), "longest", longest, "a share of at least 1"),
        (not_negative(neighbourhood), "neighbourhood", neighbourhood, "a length of at least 0"),
        (guide > 0.0 && guide < 1.0, "guide", guide, "a scale above 0 and below 1"),
        (highest_energy >= 0.0, "highest_energy", highest_energy, "a length of at least 0"),
        (not_negative(clearance), "clearance", clearance, "a length of at least 0"),
    ];
    match wrong.into_iter().find(|(is_right, ..)| !is_right) {
        None => Ok(()),
        Some((_, key, value, expected)) => Err(format!("{key} of {value} found; {expected} expected")),
    }
}

impl Deform for Geometric {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        let rest: Vec<[f64; 3]> = self.body.vertices().iter().map(|vertex| pose.apply(*vertex)).collect();
        if self.obstacles.is_free(&rest, self.body.triangles(), self.clearance) {
            return Ok(Deformed { vertices: self.body.vertices().to_vec(), energy: 0.0 });
        }
        let rest: Vec<Vector> = rest.into_iter().map(Vector::from_array).collect();
        Attempt { method: self, pose, rest: &rest, guide: OnceCell::new() }.deform()
    }
}

/// One pose at which the robot at rest is not free.
struct Attempt<'a> {
    method: &'a Geometric,
    pose: &'a Pose,
    /// The vertices at rest in the world's frame.
    rest: &'a [Vector],
    /// The guide's vertices in the world's frame, if the guide is free.
    guide: OnceCell<Option<Vec<Vector>>>,
}

impl Attempt<'_> {
    fn deform(&self) -> Result<Deformed, Refusal> {
        let method = self.method;
        let limits = Limits { shortest: method.settings.shortest, longest: method.settings.longest };
        let mut shape = self.rest.to_vec();
        let mut refusal = Refusal::Collides;
        for round in 0..method.settings.rounds {
            let reach = method.clearance + self.beyond() * f64::from(round + 1);
            let moved = self.free(&shape, reach)?;
            let mut pushed = vec![0.0; shape.len()];
            let before = shape.clone();
            for Moved { vertex, place, share } in moved {
                let vertex = vertex as usize;
                shape[vertex] += place - before[vertex];
                pushed[vertex] = share.max(pushed[vertex]);
            }
            if let Some(accepted) = self.accept(&shape, limits, &mut refusal) {
                return accepted;
            }
            limits.restore(&method.surface, &mut shape, &pushed);
            if let Some(accepted) = self.accept(&shape, limits, &mut refusal) {
                return accepted;
            }
        }
        Err(refusal)
    }

    /// Where the vertices go that one round of pushes moves.
    fn free(&self, shape: &[Vector], reach: f64) -> Result<Vec<Moved>, Refusal> {
        let method = self.method;
        let collides = |corners: &[u32; 3]| {
            let corners = corners.map(|corner| shape[corner as usize].to_array());
            method.obstacles.is_near(corners, method.clearance)
        };
        let within: Vec<bool> =
            shape.iter().map(|vertex| method.obstacles.contains(vertex.to_array())).collect();
        let triangles = (0u32..).zip(&method.surface.triangles);
        let colliding: Vec<u32> = triangles
            .filter(|(_, corners)| corners.iter().any(|corner| within[*corner as usize]) || collides(corners))
            .map(|(index, _)| index)
            .collect();
        if colliding.is_empty() {
            if method.obstacles.is_free(&as_arrays(shape), &method.surface.triangles, method.clearance) {
                // Only the limits are not kept yet.
                return Ok(Vec::new());
            }
            // An obstacle is within the robot. Only the guide knows on which side of it the surface belongs.
            let guide = self.guide().ok_or(Refusal::Collides)?;
            let all = regions::whole(&method.surface, method.settings.neighbourhood);
            return Ok(guide::pull(&method.surface, &all, &method.obstacles, reach, shape, guide));
        }
        let mut moved = Vec::new();
        for region in regions(&method.surface, &colliding, method.settings.neighbourhood) {
            moved.extend(self.free_region(&region, shape, reach, HALVINGS)?);
        }
        Ok(moved)
    }

    fn free_region(
        &self,
        region: &Region,
        shape: &[Vector],
        reach: f64,
        halvings: u32,
    ) -> Result<Vec<Moved>, Refusal> {
        let method = self.method;
        let (surface, obstacles) = (&method.surface, &*method.obstacles);
        let directions = directions::directions(surface, region, shape, obstacles, reach, &method.uniform);
        let mut trial = Trial::new(surface, region, obstacles, reach, shape);
        let middle = Vector::from_array(self.pose.apply(method.centroid.to_array()));
        if let Some(push) = push::push(&mut trial, &directions, method.size, middle) {
            let target = |(vertex, weight): &(u32, f64)| shape[*vertex as usize] + push * *weight;
            let targets: Vec<Vector> = region.vertices.iter().map(target).collect();
            return Ok(settle(&mut trial, &targets));
        }
        if let Some(guide) = self.guide() {
            return Ok(guide::pull(surface, region, obstacles, reach, shape, guide));
        }
        if halvings == 0 || region.slope.is_infinite() {
            return Err(Refusal::NoGuide);
        }
        let mut moved = Vec::new();
        for part in regions(surface, &region.colliding, 0.5 / region.slope) {
            moved.extend(self.free_region(&part, shape, reach, halvings - 1)?);
        }
        Ok(moved)
    }

    /// The guide's vertices, if it is free by as much as is ever asked for.
    fn guide(&self) -> Option<&[Vector]> {
        let guide = self.guide.get_or_init(|| {
            let method = self.method;
            let vertices: Vec<[f64; 3]> =
                method.guide.iter().map(|vertex| self.pose.apply(*vertex)).collect();
            let reach = method.clearance + self.beyond() * f64::from(method.settings.rounds);
            let is_free = method.obstacles.is_free(&vertices, method.body.triangles(), reach);
            is_free.then(|| vertices.into_iter().map(Vector::from_array).collect())
        });
        guide.as_deref()
    }

    /// By how much farther than the clearance the first round pushes.
    fn beyond(&self) -> f64 {
        (BEYOND_CLEARANCE * self.method.clearance).max(BEYOND_SIZE * self.method.size)
    }

    /// The shape if all of it is as it must be, or why it is refused for good; otherwise `refusal` is set to what is wrong so far.
    fn accept(
        &self,
        shape: &[Vector],
        limits: Limits,
        refusal: &mut Refusal,
    ) -> Option<Result<Deformed, Refusal>> {
        let method = self.method;
        if !limits.are_kept(&method.surface, shape) {
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
        let judged: Vec<[f64; 3]> = vertices.iter().map(|vertex| self.pose.apply(*vertex)).collect();
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

fn as_arrays(shape: &[Vector]) -> Vec<[f64; 3]> {
    shape.iter().map(|vertex| vertex.to_array()).collect()
}
