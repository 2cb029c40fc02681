//! The robot's bodies and the obstacles.

use super::robot::Robot;
use super::tables::{BodyTable, ShapeTable, Solid, TurnTable};
use crate::digest::SourceFile;
use crate::math;
use crate::scene::{Body, LENGTH_MAX, MeshOptions, Pose, Shape, read_mesh_with};
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source};
use crate::space::{canonical, stored_form};
use std::path::Path;

/// Reads the bodies of the table at `place`.
pub(super) fn bodies(
    source: &Source,
    place: &[Step],
    tables: &[BodyTable],
    notes: &mut Vec<String>,
) -> Result<Vec<Body>, ProblemError> {
    let mut bodies = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let at = |key| [place, &[Index(index), Key(key)]].concat();
        let frame = (&table.position, &table.orientation, &table.turn);
        let pose = pose_of(frame).map_err(|(key, message)| source.error(&at(key), message))?;
        let shape =
            shape_of(source, table).map_err(|message| source.error(&at("shape"), message))?;
        let solid = match (&shape, table.solid) {
            (Shape::Mesh(mesh), Solid::Yes) if !mesh.is_closed() => {
                let message = format!(
                    "true found, but the mesh is not closed ({} edges belong to an odd number of \
                     triangles); false or \"auto\" expected",
                    mesh.odd_edges()
                );
                return Err(source.error(&at("solid"), message));
            }
            (Shape::Mesh(mesh), Solid::Auto) => {
                let closed = mesh.is_closed();
                let what = if place.len() == 1 { "obstacle" } else { "robot body" };
                let found = match mesh.odd_edges() {
                    0 => "the mesh is closed".to_owned(),
                    odd => format!("the mesh has {odd} open edges"),
                };
                notes.push(format!("{what} {index}: solid = {closed}, as {found}"));
                closed
            }
            (Shape::Mesh(_), Solid::Yes) => true,
            (Shape::Mesh(_), Solid::No) => false,
            (_, Solid::No) => {
                let message = format!("false found; a {} is always solid", shape.name());
                return Err(source.error(&at("solid"), message));
            }
            _ => true,
        };
        bodies.push(Body { shape, pose, solid });
    }
    Ok(bodies)
}

/// A frame as a file writes it: position, and orientation or turn.
type Frame<'a> = (&'a [f64; 3], &'a Option<[f64; 4]>, &'a Option<TurnTable>);

/// Reads a frame, or says which key is wrong and how.
pub(super) fn pose_of(
    (position, orientation, turn): Frame,
) -> Result<Pose, (&'static str, String)> {
    // Written so that NaN fails it.
    if !position.iter().all(|value| value.abs() <= LENGTH_MAX) {
        let message = format!("{position:?} found; finite lengths expected");
        return Err(("position", message));
    }
    let rotation = match (orientation, turn) {
        (Some(_), Some(_)) => {
            return Err(("turn", "given beside orientation; one of the two expected".to_owned()));
        }
        (Some(quaternion), None) => stored_form(*quaternion).ok_or_else(|| {
            let expected = "a finite quaternion w x y z other than zero expected";
            ("orientation", format!("{quaternion:?} found; {expected}"))
        })?,
        (None, Some(turn)) => {
            let axis = unit(turn.axis).filter(|_| turn.degrees.is_finite());
            let axis = axis.ok_or_else(|| {
                let expected = "an axis other than zero and finite degrees expected";
                ("turn", format!("axis {:?} by {}° found; {expected}", turn.axis, turn.degrees))
            })?;
            rotation_about(axis, turn.degrees)
        }
        (None, None) => Pose::IDENTITY.rotation,
    };
    Ok(Pose { translation: *position, rotation })
}

/// The vector at unit length, if it has a direction. One that has unit length to within rounding is
/// taken as it is, so that what is written can be read again.
pub(super) fn unit([x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    let length = (x * x + y * y + z * z).sqrt();
    if (length - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some([x, y, z]);
    }
    (length.is_finite() && length > 1e-100).then(|| [x / length, y / length, z / length])
}

/// The rotation by `degrees` about a unit axis.
fn rotation_about(axis: [f64; 3], degrees: f64) -> [f64; 4] {
    let half = degrees / 360.0 * std::f64::consts::PI;
    let (sine, cosine) = (math::sin(half), math::cos(half));
    let quaternion = [cosine, axis[0] * sine, axis[1] * sine, axis[2] * sine];
    canonical(quaternion).unwrap_or(Pose::IDENTITY.rotation)
}

fn shape_of(source: &Source, table: &BodyTable) -> Result<Shape, String> {
    let length = |key: &str, value: f64| {
        if value > 0.0 && value <= LENGTH_MAX {
            Ok(value)
        } else {
            Err(format!("{key} = {value} found; a positive length expected"))
        }
    };
    Ok(match &table.shape {
        ShapeTable::Point {} => Shape::Point,
        ShapeTable::Box { size } => {
            for edge in size {
                length("size", *edge)?;
            }
            Shape::Box { size: *size }
        }
        ShapeTable::Sphere { radius } => Shape::Sphere { radius: length("radius", *radius)? },
        ShapeTable::Cylinder { radius, height } => Shape::Cylinder {
            radius: length("radius", *radius)?,
            height: length("height", *height)?,
        },
        ShapeTable::Capsule { radius, height } => Shape::Capsule {
            radius: length("radius", *radius)?,
            height: length("height", *height)?,
        },
        ShapeTable::Mesh { file, scale } => {
            length("scale", *scale)?;
            let folder = source.path.parent().unwrap_or(Path::new(""));
            let options = MeshOptions { scale: [*scale; 3], ..MeshOptions::default() };
            let read = read_mesh_with(&folder.join(file), &options);
            let read = read.map_err(|error| error.to_string())?;
            let path = file.to_string_lossy().into_owned();
            source.read(SourceFile { path, digest: read.digest });
            Shape::Mesh(read.mesh)
        }
    })
}

/// Checks the robot and the obstacles against one another.
pub(super) fn check_bodies(
    source: &Source,
    robot: &Robot,
    obstacles: &[Body],
) -> Result<(), ProblemError> {
    bodies_complaint(robot, obstacles)
        .map_or(Ok(()), |(place, message)| Err(source.error(&place, message.to_owned())))
}

/// What is wrong with the robot and the obstacles taken together, if anything: where, what was found and what is
/// expected.
pub(super) fn bodies_complaint(
    robot: &Robot,
    obstacles: &[Body],
) -> Option<(Vec<Step<'static>>, &'static str)> {
    if robot.bodies().next().is_none() {
        let message = "no bodies found; at least one expected";
        return Some((vec![Key("robot"), Key("bodies")], message));
    }
    if let Some(index) = obstacles.iter().position(|body| body.shape == Shape::Point) {
        let message = "a point cannot be an obstacle; a shape with an extent expected";
        return Some((vec![Key("obstacles"), Index(index), Key("shape")], message));
    }
    let pointlike = robot.bodies().any(|body| body.shape == Shape::Point);
    if pointlike && let Some(index) = obstacles.iter().position(|body| !body.solid) {
        let message = "a point robot never touches a surface without inside at the configurations \
                       that are checked; a solid obstacle or a robot with an extent expected";
        return Some((vec![Key("obstacles"), Index(index)], message));
    }
    None
}
