//! Configurations at which a link has a pose, by damped least squares from many starts.
//!
//! The method is that of C. W. Wampler, *Manipulator inverse kinematic solutions based on vector formulations and damped
//! least-squares methods* (IEEE Trans. Systems, Man, and Cybernetics, 1986), with a damping that rises after a step that
//! did not help and falls after one that did, as of D. W. Marquardt (1963). Starts are drawn uniformly from the space, by a
//! seed, so that what is found is the same everywhere.

use super::Bodies;
use crate::math;
use crate::model::{Description, PoseFound, PoseGoal};
use crate::scene::{LENGTH_MAX, Pose};
use crate::seed::{Purpose, Seed};
use crate::source::fitting;
use crate::space::{FactorKind, Space, stored_form};
use parry3d_f64::math::{Rotation, Vector};

/// From how many configurations is searched.
const STARTS: usize = 200;
/// How many configurations are enough.
const ENOUGH: usize = 8;
/// The most steps from one start.
const STEPS_MAX: usize = 100;
/// Configurations nearer to one another than this share of the largest distance in the space count as one.
const SAME: f64 = 1e-3;
/// By how many radians values are changed to find derivatives, and by what share of a lever lengths are.
const NUDGE: f64 = 1e-6;

/// Searches configurations at which the link is within the tolerances of the pose. `accept` brings one into stored form and
/// says whether it counts.
///
/// # Errors
/// The key that is wrong, what was found and what is expected.
pub(super) fn configurations_at(
    bodies: &Bodies,
    goal: &PoseGoal,
    seed: &Seed,
    accept: &mut dyn FnMut(&mut [f64]) -> bool,
) -> Result<PoseFound, (&'static str, String)> {
    let space = bodies.space();
    let solver = Solver::new(bodies, &space, goal)?;
    let mut found = PoseFound {
        configurations: Vec::new(),
        starts: 0,
        reached: 0,
        tolerances: solver.tolerances,
        nearest: [f64::INFINITY; 2],
    };
    let same = SAME * space.diameter();
    for start in 0..STARTS {
        let mut stream = seed.part(start as u64).stream(Purpose::Sampling);
        let mut q = vec![0.0; space.len()];
        space.sample_uniform(&mut stream, &mut q);
        found.starts += 1;
        let ended = solver.descend(&mut q);
        if solver.share(ended) < solver.share(found.nearest) {
            found.nearest = ended;
        }
        if solver.share(ended) > 1.0 {
            continue;
        }
        found.reached += 1;
        let is_new = |other: &Vec<f64>| space.distance(other, &q) > same;
        if found.configurations.iter().all(is_new) && accept(&mut q) {
            // The stored form may differ from what was found, by rounding.
            if solver.share(solver.distances(&q)) <= 1.0 {
                found.configurations.push(q);
            }
        }
        if found.configurations.len() == ENOUGH {
            break;
        }
    }
    Ok(found)
}

/// What is searched.
struct Solver<'a> {
    bodies: &'a Bodies,
    space: &'a Space,
    link: usize,
    position: Vector,
    rotation: Option<Rotation>,
    /// How far the link may be from the pose: a length, and an angle.
    tolerances: [f64; 2],
    /// What a radian counts for beside lengths.
    lever: f64,
    /// Per dimension of the space by how much it is changed to find derivatives: a length, or an angle.
    nudges: Vec<f64>,
}

impl<'a> Solver<'a> {
    fn new(
        bodies: &'a Bodies,
        space: &'a Space,
        goal: &PoseGoal,
    ) -> Result<Solver<'a>, (&'static str, String)> {
        let links = &bodies.robot.links;
        let named =
            |link: &super::robot::Link| link.name == goal.link || link.name == fitting(&goal.link);
        let Some(link) = links.iter().position(named) else {
            return Err(("link", format!("`{}` found; the name of a link expected", goal.link)));
        };
        let reach = bodies.robot.reach();
        // Written so that NaN fails it.
        if !goal.position.iter().all(|x| x.abs() <= LENGTH_MAX) {
            let message =
                format!("{:?} found; lengths within ±{LENGTH_MAX:e} expected", goal.position);
            return Err(("position", message));
        }
        let rotation = match goal.rotation {
            None => None,
            Some(given) => Some(stored_form(given).ok_or_else(|| {
                let expected = "a finite quaternion w x y z other than zero expected";
                ("orientation", format!("{given:?} found; {expected}"))
            })?),
        };
        let tolerances = [
            ("position_tolerance", goal.position_tolerance.unwrap_or(1e-4 * reach)),
            ("orientation_tolerance", goal.orientation_tolerance.unwrap_or(1e-3)),
        ];
        for (key, tolerance) in tolerances {
            if !(tolerance.is_finite() && tolerance > 0.0) {
                return Err((key, format!("{tolerance} found; a positive number expected")));
            }
        }
        let lever = (reach / 2.0).max(f64::MIN_POSITIVE);
        let nudges = space.factors().iter().flat_map(|factor| match factor.kind {
            FactorKind::Rotation => vec![NUDGE; 3],
            _ if space.dofs()[factor.at].unit == "length" => vec![NUDGE * lever],
            _ => vec![NUDGE],
        });
        Ok(Solver {
            nudges: nudges.collect(),
            bodies,
            space,
            link,
            position: Vector::from_array(goal.position),
            rotation: rotation.map(|[w, x, y, z]| Rotation::from_xyzw(x, y, z, w)),
            tolerances: tolerances.map(|(_, tolerance)| tolerance),
            lever,
        })
    }

    fn pose(&self, q: &[f64], poses: &mut Vec<Pose>) -> (Vector, Rotation) {
        self.bodies.robot.link_poses(q, poses);
        let pose = poses[self.link].to_parry();
        (pose.translation, pose.rotation)
    }

    /// What is missing of the pose: a translation, and a rotation vector, in the world's frame.
    fn missing(&self, (position, rotation): (Vector, Rotation)) -> [Vector; 2] {
        let turn = self.rotation.map_or(Vector::ZERO, |goal| rotation_vector(goal, rotation));
        [self.position - position, turn]
    }

    /// How far a configuration is from the pose: a length, and an angle.
    fn distances(&self, q: &[f64]) -> [f64; 2] {
        self.missing(self.pose(q, &mut Vec::new())).map(Vector::length)
    }

    /// The larger of the two as a share of its tolerance: at most 1 within the tolerances.
    fn share(&self, [length, angle]: [f64; 2]) -> f64 {
        (length / self.tolerances[0]).max(angle / self.tolerances[1])
    }

    /// What is missing until the link is well within the tolerances, in lengths.
    fn residual(&self, missing: [Vector; 2]) -> [f64; 6] {
        let beyond = |vector: Vector, tolerance: f64| {
            let length = vector.length();
            if length <= 0.5 * tolerance {
                Vector::ZERO
            } else {
                vector * (1.0 - 0.5 * tolerance / length)
            }
        };
        let [x, y, z] = beyond(missing[0], self.tolerances[0]).to_array();
        let [a, b, c] = (beyond(missing[1], self.tolerances[1]) * self.lever).to_array();
        [x, y, z, a, b, c]
    }

    /// Goes from `q` toward the pose, and says how far from it that ended.
    fn descend(&self, q: &mut [f64]) -> [f64; 2] {
        let poses = &mut Vec::new();
        let dimensions = self.nudges.len();
        let mut missing = self.missing(self.pose(q, poses));
        let mut residual = self.residual(missing);
        let mut damping = 0.1 * self.lever;
        let mut tried = q.to_vec();
        for _ in 0..STEPS_MAX {
            let cost = square(&residual);
            if cost == 0.0 {
                break;
            }
            let columns = self.columns(q, dimensions, poses);
            let mut improved = false;
            while !improved && damping < 1e3 * self.lever {
                let Some(step) = damped_step(&columns, &residual, damping) else { break };
                self.space.moved(q, &step, &mut tried);
                self.space.clamp(&mut tried);
                let there = self.missing(self.pose(&tried, poses));
                let left = self.residual(there);
                improved = square(&left) < cost;
                if improved {
                    q.copy_from_slice(&tried);
                    (missing, residual) = (there, left);
                    damping = (damping * 0.3).max(1e-6 * self.lever);
                } else {
                    damping *= 4.0;
                }
            }
            if !improved {
                break;
            }
        }
        missing.map(Vector::length)
    }

    /// How the pose changes with each dimension of the space, in the units of the residual: the Jacobian by columns.
    fn columns(&self, q: &[f64], dimensions: usize, poses: &mut Vec<Pose>) -> Vec<[f64; 6]> {
        let mut by = vec![0.0; dimensions];
        let mut there = q.to_vec();
        let mut columns = Vec::with_capacity(dimensions);
        for dimension in 0..dimensions {
            let nudge = self.nudges[dimension];
            let [before, after] = [-nudge, nudge].map(|nudge| {
                by[dimension] = nudge;
                self.space.moved(q, &by, &mut there);
                self.pose(&there, poses)
            });
            by[dimension] = 0.0;
            let way = (after.0 - before.0) / (2.0 * nudge);
            let turn = match self.rotation {
                Some(_) => rotation_vector(after.1, before.1) * (self.lever / (2.0 * nudge)),
                None => Vector::ZERO,
            };
            let ([x, y, z], [a, b, c]) = (way.to_array(), turn.to_array());
            columns.push([x, y, z, a, b, c]);
        }
        columns
    }
}

/// The rotation vector, in the frame that both are given in, of the turn that makes `to` of `from`.
fn rotation_vector(to: Rotation, from: Rotation) -> Vector {
    let between = to * from.conjugate();
    let sign = if between.w < 0.0 { -1.0 } else { 1.0 };
    let part = Vector::new(between.x, between.y, between.z) * sign;
    let sine = part.length();
    if sine == 0.0 {
        return Vector::ZERO;
    }
    part * (2.0 * math::atan2(sine, between.w * sign) / sine)
}

fn square(vector: &[f64; 6]) -> f64 {
    vector.iter().map(|x| x * x).sum()
}

/// The step Jᵀ (J Jᵀ + damping² 1)⁻¹ r, J having the columns given; `None` where rounding leaves nothing of it.
fn damped_step(columns: &[[f64; 6]], residual: &[f64; 6], damping: f64) -> Option<Vec<f64>> {
    let mut matrix = [[0.0; 6]; 6];
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = columns.iter().map(|column| column[i] * column[j]).sum();
        }
        row[i] += damping * damping;
    }
    let solution = solved(matrix, *residual)?;
    let step = |column: &[f64; 6]| column.iter().zip(&solution).map(|(a, b)| a * b).sum();
    Some(columns.iter().map(step).collect())
}

/// The solution of a system with a symmetric positive definite matrix, by Cholesky's decomposition.
fn solved(mut matrix: [[f64; 6]; 6], mut right: [f64; 6]) -> Option<[f64; 6]> {
    for i in 0..6 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let left = matrix[i][j] - sum;
            if i == j {
                if left.is_nan() || left <= 0.0 {
                    return None;
                }
                matrix[i][i] = left.sqrt();
            } else {
                matrix[i][j] = left / matrix[j][j];
            }
        }
    }
    for i in 0..6 {
        let sum: f64 = (0..i).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - sum) / matrix[i][i];
    }
    for i in (0..6).rev() {
        let sum: f64 = (i + 1..6).map(|k| matrix[k][i] * right[k]).sum();
        right[i] = (right[i] - sum) / matrix[i][i];
    }
    right.iter().all(|x| x.is_finite()).then_some(right)
}
