//! Parasol's scene files: `.env` (bounds and obstacles, in the older dialect the robot too), `.robot`
//! and `.query`; and its `.path`.
//!
//! Conventions, as in Parasol's library: poses are x y z and degrees about X, Y, Z, rotations
//! Rz·Ry·Rx; configurations give angles as fractions of π; every mesh's origin is the mean of its
//! vertices; the bounds hold every point of the robot.

mod env;
mod path;
mod query;
mod robot;
mod words;

use super::bodies::{Meshes, Named, why_solid};
use super::error::read_text;
use super::{Base, ForeignBody, ForeignError, ForeignScene, SceneOptions, Solidity};
use crate::model::bodies::validity::{Bounds, BoundsMeaning};
use crate::scene::{Centre, MeshOptions, Pose};
use std::path::{Path, PathBuf};
use words::Words;

pub(crate) use path::{is_parasol_path, read_parasol_path};

/// Reads a Parasol scene. Where the options name no robot (needed where the `.env` has no active body)
/// or no query, the file beside the `.env` that has its stem is taken, or else the only one with the
/// extension; a scene without any query file has no query.
///
/// Unless the options say otherwise, meshes are solid if they are closed and their origins are the mean
/// of their vertices, and the bounds hold every point of the robot. The result's angles are radians.
///
/// # Errors
/// Names the file and line: unreadable, a word or number out of place, what this reader does not
/// support, joints that make no tree, a mesh that cannot be read; or the files there are to choose from.
pub fn read_parasol(env: &Path, options: &SceneOptions) -> Result<ForeignScene, ForeignError> {
    let mut notes = Vec::new();
    let meshes = Meshes::new(options, &mut notes);
    let mut reader = Reader { options, meshes, notes };
    if options.origin.is_none() {
        let what = "the mean of each mesh's vertices, as Parasol's library does (--origin)";
        reader.notes.push(format!("origins moved to {what}"));
    }
    let (text, source) = read_text(env)?;
    reader.meshes.sources.push(source);
    let found = env::read(&mut Words::new(env, &text), &mut reader)?;
    let robot = match (found.robot, options.robot) {
        (Some(_), Some(other)) => {
            let message =
                format!("has an active body; the robot of {} comes beside it", other.display());
            return Err(ForeignError::whole(env, message));
        }
        (Some(active), None) => active,
        (None, given) => {
            let path = match given {
                Some(path) => path.to_owned(),
                None => beside(env, "robot", &mut reader.notes)?.ok_or_else(|| {
                    let message = "no active body in it and no .robot beside it; a robot expected";
                    ForeignError::whole(env, message)
                })?,
            };
            let (text, source) = read_text(&path)?;
            reader.meshes.sources.push(source);
            let mut words = Words::new(&path, &text);
            let robot = robot::read(&mut words, &mut reader)?;
            words.end("the end after the connections")?;
            robot
        }
    };
    let notes = &mut reader.notes;
    let bounds = found.boundary.bounds(robot.base, env, options, notes)?;
    let query = match options.query {
        Some(path) => Some(path.to_owned()),
        None => beside(env, "query", notes)?,
    };
    let query = match query {
        Some(path) => {
            let (text, source) = read_text(&path)?;
            reader.meshes.sources.push(source);
            Some(query::read(&path, &text, &robot, notes)?)
        }
        None => None,
    };
    Ok(ForeignScene {
        name: env.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into()),
        base: robot.base,
        bounds,
        obstacles: found.obstacles,
        links: robot.links,
        may_touch: robot.may_touch,
        query,
        notes: reader.notes,
        sources: reader.meshes.sources,
    })
}

/// What reading a scene comes with.
struct Reader<'a> {
    options: &'a SceneOptions<'a>,
    meshes: Meshes,
    notes: Vec<String>,
}

/// The file beside `env` with another extension: of the same stem, or the only one.
fn beside(
    env: &Path,
    extension: &str,
    notes: &mut Vec<String>,
) -> Result<Option<PathBuf>, ForeignError> {
    let same = env.with_extension(extension);
    let chosen = if same.is_file() {
        same
    } else {
        let folder = match env.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let fail = |error| ForeignError::whole(folder, format!("cannot list the folder: {error}"));
        let mut found = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(fail)? {
            let path = entry.map_err(fail)?.path();
            if path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension)) {
                found.push(path);
            }
        }
        // The order of a folder is the file system's own.
        found.sort();
        if found.len() > 1 {
            let names: Vec<_> = found.iter().map(|path| file_name(path)).collect();
            let message = format!(
                "which .{extension}? {} stand beside it, none of its own name; name one",
                names.join(", ")
            );
            return Err(ForeignError::whole(env, message));
        }
        match found.pop() {
            Some(path) => path,
            None => return Ok(None),
        }
    };
    notes.push(format!(
        "{extension}: {}, found beside the scene (--{extension})",
        file_name(&chosen)
    ));
    Ok(Some(chosen))
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into())
}

/// The intervals of a box, two or three, and the line that they stand in.
struct Boundary {
    line: usize,
    intervals: Vec<[f64; 2]>,
}

impl Boundary {
    fn bounds(
        &self,
        base: Base,
        env: &Path,
        options: &SceneOptions,
        notes: &mut Vec<String>,
    ) -> Result<Bounds, ForeignError> {
        let axes = match base {
            Base::Moving(motion) => motion.translations(),
            Base::Fixed(_) => 3,
        };
        let given = self.intervals.len();
        if given < axes {
            let message = format!("a box of {given} intervals found; {axes} expected by the robot");
            return Err(ForeignError::line(env, self.line, message));
        }
        if given > axes {
            notes.push("the bounds' z is not used, as the robot is planar".to_owned());
        }
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for (axis, [low, high]) in self.intervals.iter().take(axes).enumerate() {
            (min[axis], max[axis]) = (*low, *high);
        }
        let meaning = options.bounds.unwrap_or_else(|| {
            let what = "every point of the robot, as Parasol's do (--bounds)";
            notes.push(format!("the bounds hold {what}"));
            BoundsMeaning::Body
        });
        Ok(Bounds { min, max, meaning })
    }
}

/// `FILE` and the options after it: what a body is made of.
struct Geometry<'a> {
    line: usize,
    file: &'a str,
    centre: Centre,
}

impl<'a> Geometry<'a> {
    /// Reads the file's name and `-a(…)`, `-c(…)`, `-t(…)`: origin, colour and texture.
    fn read(words: &mut Words<'a>) -> Result<Geometry<'a>, ForeignError> {
        let file = words.next("a mesh file")?;
        let line = words.line();
        let mut centre = Centre::VertexMean;
        while let Some(option) = words.option()? {
            match option.to_ascii_lowercase().as_str() {
                "-a(com)" => centre = Centre::VertexMean,
                "-a(none)" => centre = Centre::AsStored,
                other if other.starts_with("-c(") || other.starts_with("-t(") => {}
                _ => {
                    let expected = "-a(COM), -a(NONE), -c(…) or -t(…) expected";
                    return Err(words.error(format!("`{option}` not supported; {expected}")));
                }
            }
        }
        Ok(Geometry { line, file, centre })
    }

    /// Reads the mesh and says what was made of it.
    fn body(
        &self,
        what: &str,
        scene: &Path,
        pose: Pose,
        reader: &mut Reader,
    ) -> Result<ForeignBody, ForeignError> {
        let named = Named { scene, line: self.line, file: self.file };
        let (centre, asked) = (reader.options.origin.unwrap_or(self.centre), reader.options.solid);
        let options = MeshOptions { centre, ..MeshOptions::default() };
        let solid = asked.unwrap_or(Solidity::Auto);
        let (body, read) = reader.meshes.body(&named, &options, pose, solid)?;
        let mut note = format!("{what} ({}): {}", self.file, why_solid(&body.body, &read, asked));
        if centre == Centre::AsStored {
            note += "; origin as stored";
        }
        reader.notes.push(note);
        Ok(body)
    }
}
