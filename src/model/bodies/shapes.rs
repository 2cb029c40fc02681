//! The robot's bodies and the obstacles.

use super::robot::Robot;
use super::tables::{BodyTable, ShapeTable, Solid, TurnTable};
use crate::digest::SourceFile;
use crate::math;
use crate::scene::{Body, LENGTH_MAX, MeshOptions, Pose, ReadMesh, Shape, Weld, read_mesh_with};
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source};
use crate::space::{canonical, stored_form};
use std::path::Path;

/// The largest share of a mesh's size that its vertices may be apart and be one.
const WELD_MAX: f64 = 0.01;

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
        let what = if place.len() == 1 { "obstacle" } else { "robot body" };
        let what = format!("{what} {index}");
        let (shape, pairs) = shape_of(source, table, &what, notes)
            .map_err(|message| source.error(&at("shape"), message))?;
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
                notes.push(format!(
                    "{what}: solid = {closed}, as {}",
                    found(mesh.odd_edges(), pairs)
                ));
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

/// What decides whether a mesh is solid: its open edges, and pairs of equal triangles that were kept to close it.
pub(super) fn found(odd_edges: usize, pairs: usize) -> String {
    match (odd_edges, pairs) {
        (0, 0) => "the mesh is closed".to_owned(),
        (0, 1) => {
            "the mesh is closed but for a wall within it, 1 pair of equal triangles".to_owned()
        }
        (0, _) => {
            format!("the mesh is closed but for walls within it, {pairs} pairs of equal triangles")
        }
        (odd, _) => format!("the mesh has {odd} open edges"),
    }
}

/// How far apart vertices are that had to be joined to close a mesh.
pub(super) fn closed_by(read: &ReadMesh) -> Option<String> {
    let (length, open) = read.closed_by?;
    Some(format!("vertices at most {length:.3e} apart joined, without which {open} edges are open"))
}

/// Reads a shape, and of a mesh how many pairs of equal triangles it keeps.
fn shape_of(
    source: &Source,
    table: &BodyTable,
    what: &str,
    notes: &mut Vec<String>,
) -> Result<(Shape, usize), String> {
    let length = |key: &str, value: f64| {
        if value > 0.0 && value <= LENGTH_MAX {
            Ok(value)
        } else {
            Err(format!("{key} = {value} found; a positive length expected"))
        }
    };
    let shape = match &table.shape {
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
        ShapeTable::Mesh { file, scale, weld } => {
            length("scale", *scale)?;
            if !(0.0..=WELD_MAX).contains(weld) {
                let expected = format!("a share of the mesh's size from 0 to {WELD_MAX} expected");
                return Err(format!("weld = {weld} found; {expected}"));
            }
            let folder = source.path.parent().unwrap_or(Path::new(""));
            let options = MeshOptions {
                scale: [*scale; 3],
                weld: Weld::ToClose(*weld),
                ..MeshOptions::default()
            };
            let read = read_mesh_with(&folder.join(file), &options);
            let read = read.map_err(|error| error.to_string())?;
            let path = file.to_string_lossy().into_owned();
            source.read(SourceFile { path, digest: read.digest });
            if let Some(joined) = closed_by(&read) {
                notes.push(format!("{what}: {joined} (weld = {weld:e})"));
            }
            return Ok((Shape::Mesh(read.mesh), read.pairs));
        }
    };
    Ok((shape, 0))
}

/// Checks the robot and the obstacles against one another.
pub(super) fn check_bodies(
    source: &Source,
    robot: &Robot,
    obstacles: &[Body],
) -> Result<(), ProblemError> {
    if robot.bodies().next().is_none() {
        let message = "no bodies found; at least one expected".to_owned();
        return Err(source.error(&[Key("robot"), Key("bodies")], message));
    }
    if let Some(index) = obstacles.iter().position(|body| body.shape == Shape::Point) {
        let message = "a point cannot be an obstacle; a shape with an extent expected";
        let place = [Key("obstacles"), Index(index), Key("shape")];
        return Err(source.error(&place, message.to_owned()));
    }
    let pointlike = robot.bodies().any(|body| body.shape == Shape::Point);
    if pointlike && let Some(index) = obstacles.iter().position(|body| !body.solid) {
        let message = "a point robot never touches a surface without inside at the configurations \
                       that are checked; a solid obstacle or a robot with an extent expected";
        let place = [Key("obstacles"), Index(index)];
        return Err(source.error(&place, message.to_owned()));
    }
    Ok(())
}
