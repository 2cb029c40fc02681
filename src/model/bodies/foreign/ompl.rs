//! OMPL.app's `.cfg`: an INI file whose section `problem` names the meshes of a rigid body and of its
//! world, start and goal, and the box that holds the reference point.
//!
//! The numbers assume meshes as OMPL.app's importer gives them: turned to y up, scaled by the file's
//! unit, and the robot's origin moved to the mean of its vertices.

use super::bodies::{Meshes, Named, why_solid};
use super::error::read_text;
use super::frames::turn;
use super::{
    Base, ForeignBody, ForeignError, ForeignLink, ForeignScene, SceneOptions, Solidity, Unit,
};
use crate::model::bodies::validity::{Bounds, BoundsMeaning};
use crate::scene::{Centre, LENGTH_MAX, MeshOptions, Pose, Up, UpAxis};
use crate::space::BaseJoint;
use std::collections::BTreeMap;
use std::path::Path;

/// Reads an OMPL.app `.cfg` of a rigid body in three dimensions.
///
/// Angles are radians, positions those of the robot's frame. Unless the options say otherwise, the
/// bounds hold the reference point only, the world is a surface without inside, as OMPL's checker sees
/// it, and the robot is solid if its mesh is closed.
///
/// # Errors
/// Names the file and line: unreadable, a key missing or twice, a value that is no finite number, an
/// empty box, or a mesh that cannot be read.
pub fn read_ompl(path: &Path, options: &SceneOptions) -> Result<ForeignScene, ForeignError> {
    let (text, source) = read_text(path)?;
    let file = Config::read(path, &text)?;
    let mut notes = Vec::new();
    let mut meshes = Meshes::new(options, &mut notes);
    meshes.sources.push(source);
    let world = file.mesh("world", options, &mut meshes, &mut notes)?;
    let robot = file.mesh("robot", options, &mut meshes, &mut notes)?;
    let corner = |which: &str| -> Result<[f64; 3], ForeignError> {
        Ok([
            file.length(&format!("volume.{which}.x"))?,
            file.length(&format!("volume.{which}.y"))?,
            file.length(&format!("volume.{which}.z"))?,
        ])
    };
    let (min, max) = (corner("min")?, corner("max")?);
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        if min[axis] >= max[axis] {
            let line = file.line(&format!("volume.max.{name}"));
            let (low, high) = (min[axis], max[axis]);
            let message = format!(
                "volume.max.{name} = {high} found; more than volume.min.{name} = {low} expected"
            );
            return Err(ForeignError::line(path, line, message));
        }
    }
    let query = (file.configuration("start")?, file.configuration("goal")?);
    let name = match file.values.get("name") {
        Some((_, name)) if !name.is_empty() => (*name).to_owned(),
        _ => path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into()),
    };
    for (key, (line, value)) in &file.values {
        if !is_read(key) {
            notes.push(format!("line {line}: {key} = {value} passed over"));
        }
    }
    let meaning = options.bounds.unwrap_or_else(|| {
        notes.push("the bounds hold the reference point, as OMPL.app's do (--bounds)".to_owned());
        BoundsMeaning::Reference
    });
    Ok(ForeignScene {
        name,
        base: Base::Moving(BaseJoint::Rigid3d),
        bounds: Bounds { min, max, meaning },
        obstacles: vec![world],
        links: vec![ForeignLink { name: "robot".to_owned(), bodies: vec![robot], joint: None }],
        may_touch: Vec::new(),
        query: Some(query),
        notes,
        sources: meshes.sources,
    })
}

fn is_read(key: &str) -> bool {
    let parts: Vec<&str> = key.split('.').collect();
    match parts[..] {
        ["name" | "robot" | "world"] => true,
        ["start" | "goal", "theta"] => true,
        ["start" | "goal", axis] | ["start" | "goal", "axis", axis] => {
            matches!(axis, "x" | "y" | "z")
        }
        ["volume", "min" | "max", axis] => matches!(axis, "x" | "y" | "z"),
        _ => false,
    }
}

/// The section `problem`: line and value of every key.
struct Config<'a> {
    path: &'a Path,
    values: BTreeMap<&'a str, (usize, &'a str)>,
    end: usize,
}

impl<'a> Config<'a> {
    fn read(path: &'a Path, text: &'a str) -> Result<Config<'a>, ForeignError> {
        let mut values = BTreeMap::new();
        let mut section = "";
        let mut end = 1;
        for (index, line) in text.lines().enumerate() {
            let number = index + 1;
            let fail = |message: String| Err(ForeignError::line(path, number, message));
            // Comments take a line of their own, or follow a blank: names may hold the signs.
            let cut = line.find(" #").or_else(|| line.find(" ;")).unwrap_or(line.len());
            let line = line[..cut].trim();
            if line.is_empty() || line.starts_with(['#', ';']) {
                continue;
            }
            if let Some(rest) = line.strip_prefix('[') {
                match rest.strip_suffix(']') {
                    Some(name) => section = name.trim(),
                    None => return fail(format!("`{line}` found; `[section]` expected")),
                }
                continue;
            }
            let Some((key, value)) = line.split_once('=') else {
                return fail(format!("`{line}` found; `key = value` expected"));
            };
            if section == "problem" {
                end = number;
                let key = key.trim();
                if let Some((first, _)) = values.insert(key, (number, value.trim())) {
                    return fail(format!("{key} found again; line {first} gives it already"));
                }
            }
        }
        Ok(Config { path, values, end })
    }

    fn line(&self, key: &str) -> usize {
        self.values.get(key).map_or(self.end, |(line, _)| *line)
    }

    fn value(&self, key: &str) -> Result<&'a str, ForeignError> {
        match self.values.get(key) {
            Some((_, value)) => Ok(value),
            None => {
                let message = format!("{key} is missing from the section `problem` of a 3D scene");
                Err(ForeignError::line(self.path, self.end, message))
            }
        }
    }

    fn number(&self, key: &str) -> Result<f64, ForeignError> {
        let word = self.value(key)?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let message = format!("{key} = `{word}` found; a finite number expected");
                Err(ForeignError::line(self.path, self.line(key), message))
            }
        }
    }

    fn length(&self, key: &str) -> Result<f64, ForeignError> {
        let number = self.number(key)?;
        if number.abs() > LENGTH_MAX {
            let message = format!("{key} = {number:e} found; at most {LENGTH_MAX:e} expected");
            return Err(ForeignError::line(self.path, self.line(key), message));
        }
        Ok(number)
    }

    /// `x y z qw qx qy qz` of `start` or `goal`.
    fn configuration(&self, end: &str) -> Result<Vec<f64>, ForeignError> {
        let mut q = Vec::new();
        for axis in ["x", "y", "z"] {
            q.push(self.length(&format!("{end}.{axis}"))?);
        }
        let angle = self.number(&format!("{end}.theta"))?;
        let mut axis = [0.0; 3];
        for (value, name) in axis.iter_mut().zip(["x", "y", "z"]) {
            *value = self.number(&format!("{end}.axis.{name}"))?;
        }
        let rotation = match turn(axis, angle) {
            Some(rotation) => rotation,
            None if angle == 0.0 => Pose::IDENTITY.rotation,
            None => {
                let message =
                    format!("{end}.axis = {axis:?} found; an axis other than zero expected");
                let line = self.line(&format!("{end}.axis.x"));
                return Err(ForeignError::line(self.path, line, message));
            }
        };
        q.extend(rotation);
        Ok(q)
    }

    /// The robot's or the world's mesh. Only the robot's origin is moved.
    fn mesh(
        &self,
        key: &str,
        options: &SceneOptions,
        meshes: &mut Meshes,
        notes: &mut Vec<String>,
    ) -> Result<ForeignBody, ForeignError> {
        let named = Named { scene: self.path, line: self.line(key), file: self.value(key)? };
        let (centre, solid) = match key {
            "robot" => (options.origin.unwrap_or(Centre::VertexMean), Solidity::Auto),
            _ => (Centre::AsStored, Solidity::No),
        };
        let up = options.up.unwrap_or(Up::Y);
        let mut mesh = MeshOptions { centre, up, ..MeshOptions::default() };
        let solid = options.solid.unwrap_or(solid);
        let (mut body, mut read) = meshes.body(&named, &mesh, Pose::IDENTITY, solid)?;
        if let Some(metres) = read.unit_metres
            && metres != 1.0
            && options.unit != Some(Unit::AsStored)
        {
            // Welding is a length of the scene, so the file is read again rather than stretched.
            mesh.scale = [metres; 3];
            (body, read) = meshes.body(&named, &mesh, Pose::IDENTITY, solid)?;
            let what = "the metres of the file's unit (--unit)";
            notes.push(format!("{key}: lengths times {metres}, {what}"));
        }
        let turned = match read.up {
            Some(UpAxis::Z) => Some("z up to y up, (x, y, z) → (x, z, −y)"),
            Some(UpAxis::X) => Some("x up to y up, (x, y, z) → (−y, x, z)"),
            Some(UpAxis::Y) | None => None,
        };
        if let (Some(turned), Up::Y) = (turned, up) {
            notes.push(format!("{key}: turned from {turned} (--up)"));
        }
        if centre == Centre::VertexMean {
            let [x, y, z] = read.centre;
            let what = "the mean of the vertices";
            notes.push(format!("{key}: origin moved to {what}, {x} {y} {z} (--origin)"));
        }
        let why = match (key, options.solid) {
            ("world", None) => {
                "solid = false, as OMPL's checker tests surfaces only (--solid)".to_owned()
            }
            _ => why_solid(&body.body, &read, options.solid),
        };
        notes.push(format!("{key}: {why}"));
        Ok(body)
    }
}
