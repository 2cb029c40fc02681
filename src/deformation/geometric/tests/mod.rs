mod limits;
mod measure;
mod parts;
mod scenes;
mod shapes;

use super::Geometric;
use crate::deformation::{Deform, Deformed, Obstacles, Refusal, SoftBody};
use crate::model::deformable::GeometricSettings;
use crate::scene::{Body, Mesh, Pose};
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::Triangle;
use std::sync::Arc;

const CLEARANCE: f64 = 0.01;

fn settings() -> GeometricSettings {
    GeometricSettings {
        directions: 24,
        shortest: 0.4,
        longest: 2.0,
        neighbourhood: 0.6,
        guide: 0.5,
        rounds: 12,
        refuse_self_collisions: true,
    }
}

/// A robot among obstacles, with an own judge.
struct Scene {
    body: SoftBody,
    bodies: Vec<Body>,
    settings: GeometricSettings,
    method: Geometric,
}

impl Scene {
    fn new(mesh: Mesh, bodies: Vec<Body>, settings: GeometricSettings) -> Scene {
        let body = SoftBody::new(mesh).unwrap();
        let obstacles = Arc::new(Obstacles::new(&bodies));
        let method = Geometric::new(&body, &settings, f64::INFINITY, CLEARANCE, obstacles).unwrap();
        Scene { body, bodies, settings, method }
    }

    /// The shape at a pose, which is judged if there is one.
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        let deformed = self.method.deform(pose)?;
        self.judge(pose, &deformed);
        Ok(deformed)
    }

    /// Judges a shape by every triangle's distance from every obstacle, as parry finds it, which must be solid primitives.
    fn judge(&self, pose: &Pose, deformed: &Deformed) {
        assert_eq!(deformed.vertices.len(), self.body.vertices().len());
        let place = |vertex: [f64; 3]| Vector::from_array(pose.apply(vertex));
        for corners in self.body.triangles() {
            let [a, b, c] = corners.map(|corner| place(deformed.vertices[corner as usize]));
            for body in &self.bodies {
                let (shape, upright) = body.shape.to_parry().unwrap();
                let at = body.pose.to_parry() * upright;
                let gap = distance(&ParryPose::IDENTITY, &Triangle::new(a, b, c), &at, &*shape);
                assert!(gap.unwrap().distance >= CLEARANCE - 1e-9, "{:?} {body:?}", gap.unwrap());
                assert!(!shape.contains_point(&at, a));
            }
        }
        let mut energy = 0.0;
        for (vertex, rest) in deformed.vertices.iter().zip(self.body.vertices()) {
            energy += (Vector::from_array(*vertex) - Vector::from_array(*rest)).length();
        }
        assert!((energy - deformed.energy).abs() <= 1e-9 * (1.0 + energy));
        let [least, most] = self.edges(deformed);
        assert!(least >= self.settings.shortest - 1e-9 && most <= self.settings.longest + 1e-9);
    }

    /// The least and the greatest length of an edge, as shares of its length at rest.
    fn edges(&self, deformed: &Deformed) -> [f64; 2] {
        let length = |vertices: &[[f64; 3]], [a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|end| Vector::from_array(vertices[end as usize]));
            (a - b).length()
        };
        let triangles = self.body.triangles().iter();
        let edges = triangles.flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
        let share =
            |ends: [u32; 2]| length(&deformed.vertices, ends) / length(self.body.vertices(), ends);
        edges
            .map(share)
            .fold([f64::INFINITY, 0.0], |[least, most], share| [least.min(share), most.max(share)])
    }

    /// The farthest that a vertex moves in the world's frame from one shape to another.
    fn step(&self, one: (&Pose, &Deformed), other: (&Pose, &Deformed)) -> f64 {
        let place = |(pose, deformed): (&Pose, &Deformed), at: usize| {
            Vector::from_array(pose.apply(deformed.vertices[at]))
        };
        let steps =
            (0..one.1.vertices.len()).map(|at| (place(one, at) - place(other, at)).length());
        steps.fold(0.0, f64::max)
    }

    fn volume(&self, deformed: &Deformed) -> f64 {
        self.body.volume(&deformed.vertices) / self.body.volume(self.body.vertices())
    }
}
