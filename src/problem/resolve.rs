//! From the file as written to a checked problem.

use super::configuration::settle;
use super::error::ProblemError;
use super::file::{BodyTable, File, QueryTable, ShapeTable, Solid, StrategyTable};
use super::{DEFAULT_SEED, Limits, Problem};
use crate::context::Ends;
use crate::evaluate::{self, EvaluatorKind};
use crate::math;
use crate::scene::{Body, Pose, Shape, read_mesh};
use crate::space::{Motion, canonical};
use crate::strategy::Strategy;
use crate::validity::{Bounds, robot_radius};
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// The most nodes a roadmap may have: ids take 32 bits, and two more name start and goal.
pub const NODES_MAX: u64 = u32::MAX as u64 - 2;
const SET_NODES_MAX: u64 = 1_000_000;
const SETS_PER_ROUND_MAX: u64 = 1_000_000;
const DEFAULT_SETS_PER_ROUND: u64 = 5;
const DEFAULT_NODES_MAX: u64 = 100_000;
/// The finest resolution, as a fraction of the diagonal of the bounds.
const FINEST: f64 = 1e-7;

/// One step on the way to a value in the file.
#[derive(Clone, Copy)]
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}
use Step::{Index, Key};

/// The file at hand, for saying where something is wrong.
struct Source<'a> {
    path: &'a Path,
    text: &'a str,
    tree: DeTable<'a>,
}

impl Source<'_> {
    /// An error at the deepest step of `place` that the file has.
    fn error(&self, place: &[Step], message: String) -> ProblemError {
        let mut key = String::new();
        for step in place {
            match step {
                Key(name) if key.is_empty() => key.push_str(name),
                Key(name) => key = format!("{key}.{name}"),
                Index(index) => key = format!("{key}[{index}]"),
            }
        }
        let message = format!("{key}: {message}");
        match self.find(place) {
            Some(offset) => ProblemError::line(self.path, line_of(self.text, offset), message),
            None => ProblemError::file(self.path, message),
        }
    }

    fn find(&self, place: &[Step]) -> Option<usize> {
        let (first, rest) = place.split_first()?;
        let Key(name) = first else { return None };
        let mut value = self.tree.get(*name)?;
        let mut offset = value.span().start;
        for step in rest {
            let next = match (step, value.get_ref()) {
                (Key(name), DeValue::Table(table)) => table.get(*name),
                (Index(index), DeValue::Array(array)) => array.get(*index),
                _ => None,
            };
            let Some(next) = next else { break };
            value = next;
            offset = value.span().start;
        }
        Some(offset)
    }
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())].iter().filter(|byte| **byte == b'\n').count()
}

fn syntax_error(path: &Path, text: &str, error: &toml::de::Error) -> ProblemError {
    let message = error.message().to_owned();
    match error.span() {
        Some(span) => ProblemError::line(path, line_of(text, span.start), message),
        None => ProblemError::file(path, message),
    }
}

pub(super) fn resolve(path: &Path, text: &str) -> Result<Problem, ProblemError> {
    let tree = DeTable::parse(text).map_err(|error| syntax_error(path, text, &error))?.into_inner();
    let file: File = toml::from_str(text).map_err(|error| syntax_error(path, text, &error))?;
    let source = Source { path, text, tree };
    let mut notes = Vec::new();

    let name = name_of(&source, &file)?;
    let bounds = bounds_of(&source, &file)?;
    let robot = bodies(&source, &[Key("robot"), Key("bodies")], &file.robot.bodies, &mut notes)?;
    let obstacles = bodies(&source, &[Key("obstacles")], &file.obstacles, &mut notes)?;
    check_bodies(&source, &robot, &obstacles)?;
    let motion = file.space.motion;
    let resolution = resolution_of(&source, &file, &bounds, &robot, &mut notes)?;
    let rotation_length = rotation_length_of(&source, &file, &robot, &mut notes)?;
    let (strategies, schedule, sets_per_round) = strategies_of(&source, &file)?;
    let limits = limits_of(&source, &file)?;
    let evaluators = evaluators_of(&source, &file)?;
    let seed = match file.seed {
        Some(seed) => seed,
        None => {
            notes.push(format!("seed = {DEFAULT_SEED}, as none is given"));
            DEFAULT_SEED
        }
    };

    let problem = Problem {
        name,
        seed,
        motion,
        bounds,
        resolution,
        rotation_length,
        robot,
        obstacles,
        query: None,
        strategies,
        schedule,
        sets_per_round,
        evaluators,
        limits,
        notes,
    };
    match file.query {
        Some(query) => with_query(&source, problem, query),
        None => Ok(problem),
    }
}

fn name_of(source: &Source, file: &File) -> Result<String, ProblemError> {
    let name = match &file.name {
        Some(name) => name.clone(),
        None => {
            source.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into())
        }
    };
    // The name becomes that of a folder.
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    if name.is_empty() || name.starts_with('.') || name.len() > 100 || !name.chars().all(fits) {
        let expected = "letters, digits, `-`, `_` and `.` expected, at most 100, not led by `.`";
        return Err(source.error(&[Key("name")], format!("`{name}` found; {expected}")));
    }
    Ok(name)
}

fn bounds_of(source: &Source, file: &File) -> Result<Bounds, ProblemError> {
    let axes = file.space.motion.translations();
    let mut box_of = [[0.0; 3]; 2];
    for (corner, (key, values)) in
        box_of.iter_mut().zip([("min", &file.space.min), ("max", &file.space.max)])
    {
        let place = [Key("space"), Key(key)];
        if values.len() != axes {
            let message = format!("{} values found; {axes} expected", values.len());
            return Err(source.error(&place, message));
        }
        for (axis, value) in values.iter().enumerate() {
            if !value.is_finite() || value.abs() > 1e100 {
                let message = format!("{value} found; a finite number expected");
                return Err(source.error(&place, message));
            }
            corner[axis] = *value;
        }
    }
    let [min, max] = box_of;
    for axis in 0..axes {
        if min[axis] >= max[axis] {
            let (name, low, high) = (["x", "y", "z"][axis], min[axis], max[axis]);
            let message = format!("in {name} max = {high} found; more than min = {low} expected");
            return Err(source.error(&[Key("space"), Key("max")], message));
        }
    }
    Ok(Bounds { min, max, meaning: file.space.bounds })
}

fn bodies(
    source: &Source,
    place: &[Step],
    tables: &[BodyTable],
    notes: &mut Vec<String>,
) -> Result<Vec<Body>, ProblemError> {
    let mut bodies = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let at = |key| [place, &[Index(index), Key(key)]].concat();
        let pose = pose_of(table).map_err(|(key, message)| source.error(&at(key), message))?;
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

fn pose_of(table: &BodyTable) -> Result<Pose, (&'static str, String)> {
    if table.position.iter().any(|value| !value.is_finite()) {
        let message = format!("{:?} found; finite numbers expected", table.position);
        return Err(("position", message));
    }
    let rotation = match (&table.orientation, &table.turn) {
        (Some(_), Some(_)) => {
            return Err(("turn", "given beside orientation; one of the two expected".to_owned()));
        }
        (Some(quaternion), None) => canonical(*quaternion).ok_or_else(|| {
            let expected = "a finite quaternion w x y z other than zero expected";
            ("orientation", format!("{quaternion:?} found; {expected}"))
        })?,
        (None, Some(turn)) => {
            let [x, y, z] = turn.axis;
            // The canonical form of (0, axis) is the axis at unit length, up to its sign.
            let length = (x * x + y * y + z * z).sqrt();
            if !(length.is_finite() && length > 1e-100 && turn.degrees.is_finite()) {
                let expected = "an axis other than zero and finite degrees expected";
                let message = format!("axis {:?} by {}° found; {expected}", turn.axis, turn.degrees);
                return Err(("turn", message));
            }
            quarter_exact(turn.axis.map(|value| value / length), turn.degrees)
        }
        (None, None) => Pose::IDENTITY.rotation,
    };
    Ok(Pose { translation: table.position, rotation })
}

/// The rotation by `degrees` about a unit axis.
fn quarter_exact(axis: [f64; 3], degrees: f64) -> [f64; 4] {
    let half = degrees / 360.0 * std::f64::consts::PI;
    let (sine, cosine) = (math::sin(half), math::cos(half));
    let quaternion = [cosine, axis[0] * sine, axis[1] * sine, axis[2] * sine];
    canonical(quaternion).unwrap_or(Pose::IDENTITY.rotation)
}

fn shape_of(source: &Source, table: &BodyTable) -> Result<Shape, String> {
    let length = |key: &str, value: f64| {
        if value.is_finite() && value > 0.0 {
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
            let mesh =
                read_mesh(&folder.join(file), *scale).map_err(|error| error.to_string())?;
            Shape::Mesh(mesh)
        }
    })
}

fn check_bodies(
    source: &Source,
    robot: &[Body],
    obstacles: &[Body],
) -> Result<(), ProblemError> {
    let place = [Key("robot"), Key("bodies")];
    if robot.is_empty() {
        return Err(source.error(&place, "[] found; at least one body expected".to_owned()));
    }
    if let Some(index) = obstacles.iter().position(|body| body.shape == Shape::Point) {
        let message = "a point cannot be an obstacle; a shape with an extent expected";
        let place = [Key("obstacles"), Index(index), Key("shape")];
        return Err(source.error(&place, message.to_owned()));
    }
    let pointlike = robot.iter().any(|body| body.shape == Shape::Point);
    if pointlike && let Some(index) = obstacles.iter().position(|body| !body.solid) {
        let message = "a point robot never touches a surface without inside at the configurations \
                       that are checked; a solid obstacle or a robot with an extent expected";
        let place = [Key("obstacles"), Index(index)];
        return Err(source.error(&place, message.to_owned()));
    }
    Ok(())
}

fn resolution_of(
    source: &Source,
    file: &File,
    bounds: &Bounds,
    robot: &[Body],
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let axes = file.space.motion.translations();
    let square = |axis: usize| (bounds.max[axis] - bounds.min[axis]).powi_2();
    let diagonal = (0..axes).map(square).sum::<f64>().sqrt();
    if let Some(resolution) = file.space.resolution {
        if !(resolution.is_finite() && resolution >= FINEST * diagonal) {
            let expected = format!("a length of at least {:e} expected", FINEST * diagonal);
            let message = format!("{resolution} found; {expected}");
            return Err(source.error(&[Key("space"), Key("resolution")], message));
        }
        return Ok(resolution);
    }
    // Fine enough for the scene as a whole and for the thinnest part of the robot.
    let thinnest = robot.iter().map(thickness).fold(f64::INFINITY, f64::min);
    let mut resolution = diagonal / 200.0;
    let mut reason = "a 200th of the diagonal of the bounds";
    if thinnest > 0.0 && thinnest / 2.0 < resolution {
        resolution = (thinnest / 2.0).max(FINEST * diagonal);
        reason = "half the robot's thinnest extent";
    }
    notes.push(format!("resolution = {resolution}, {reason}"));
    Ok(resolution)
}

trait Square {
    fn powi_2(self) -> f64;
}

impl Square for f64 {
    fn powi_2(self) -> f64 {
        self * self
    }
}

/// The least extent of a body along the axes of its own frame; 0 for a point.
fn thickness(body: &Body) -> f64 {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let along = axes.map(|axis| body.shape.extent(axis) + body.shape.extent(axis.map(|x| -x)));
    along.into_iter().fold(f64::INFINITY, f64::min)
}

fn rotation_length_of(
    source: &Source,
    file: &File,
    robot: &[Body],
    notes: &mut Vec<String>,
) -> Result<f64, ProblemError> {
    let place = [Key("space"), Key("rotation_length")];
    match file.space.rotation_length {
        Some(length) if length.is_finite() && length >= 0.0 => Ok(length),
        Some(length) => {
            Err(source.error(&place, format!("{length} found; a length of at least 0 expected")))
        }
        None => {
            let radius = robot_radius(robot);
            if matches!(file.space.motion, Motion::Rigid2d | Motion::Rigid3d) {
                notes.push(format!(
                    "rotation_length = {radius}, the farthest robot point from the reference point"
                ));
            }
            Ok(radius)
        }
    }
}

fn strategies_of(
    source: &Source,
    file: &File,
) -> Result<(Vec<Strategy>, Vec<u32>, u32), ProblemError> {
    let default = [StrategyTable::uniform()];
    let tables = if file.strategies.is_empty() { &default[..] } else { &file.strategies };
    let mut strategies: Vec<Strategy> = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let fail = |keys: &[&str], message: String| {
            let mut place = vec![Key("strategies"), Index(index)];
            place.extend(keys.iter().map(|key| Key(key)));
            Err(source.error(&place, message))
        };
        if table.label.is_empty() || table.label.len() > 100 {
            return fail(&["label"], "1 to 100 bytes expected".to_owned());
        }
        if strategies.iter().any(|other| other.label == table.label) {
            let message = format!("`{}` found twice; labels of their own expected", table.label);
            return fail(&["label"], message);
        }
        if !(1..=SET_NODES_MAX).contains(&table.nodes) {
            let message = format!("{} found; 1 to {SET_NODES_MAX} expected", table.nodes);
            return fail(&["nodes"], message);
        }
        for (role, complaint) in [
            ("sampler", table.sampler.method().complaint()),
            ("within", table.within.method().complaint()),
            ("among", table.among.method().complaint()),
        ] {
            if let Some((key, found, expected)) = complaint {
                return fail(&[role], format!("{key} = {found} found; {expected} expected"));
            }
        }
        strategies.push(Strategy {
            label: table.label.clone(),
            nodes: table.nodes as u32,
            sampler: table.sampler.clone(),
            within: table.within.clone(),
            among: table.among.clone(),
        });
    }

    let place = [Key("img"), Key("schedule")];
    let schedule = match &file.img.schedule {
        None => (0..strategies.len() as u32).collect(),
        Some(labels) => {
            let mut schedule = Vec::new();
            for label in labels {
                let Some(index) = strategies.iter().position(|other| other.label == *label) else {
                    let known: Vec<_> = strategies.iter().map(|s| s.label.as_str()).collect();
                    let known = known.join(", ");
                    let message = format!("`{label}` found; labels of strategies expected: {known}");
                    return Err(source.error(&place, message));
                };
                schedule.push(index as u32);
            }
            schedule
        }
    };
    if schedule.is_empty() {
        return Err(source.error(&place, "[] found; at least one label expected".to_owned()));
    }
    if let Some(idle) = (0..strategies.len()).find(|i| !schedule.contains(&(*i as u32))) {
        let label = &strategies[idle].label;
        return Err(source.error(&place, format!("the strategy `{label}` has no place in it")));
    }
    let sets = file.img.sets_per_round.unwrap_or(DEFAULT_SETS_PER_ROUND);
    if !(1..=SETS_PER_ROUND_MAX).contains(&sets) {
        let message = format!("{sets} found; 1 to {SETS_PER_ROUND_MAX} expected");
        return Err(source.error(&[Key("img"), Key("sets_per_round")], message));
    }
    Ok((strategies, schedule, sets as u32))
}

fn limits_of(source: &Source, file: &File) -> Result<Limits, ProblemError> {
    let table = &file.limits;
    let limits = Limits {
        nodes: table.nodes.unwrap_or(DEFAULT_NODES_MAX),
        sets: table.sets.unwrap_or(u64::MAX),
        seconds: table.seconds,
    };
    limits.complaint().map_or(Ok(limits), |(key, message)| {
        Err(source.error(&[Key("limits"), Key(key)], message))
    })
}

impl Limits {
    /// What is wrong with the limits: which one, what was found and what is expected.
    pub fn complaint(&self) -> Option<(&'static str, String)> {
        if !(1..=NODES_MAX).contains(&self.nodes) {
            let expected = format!("1 to {NODES_MAX} expected (node ids take 32 bits)");
            return Some(("nodes", format!("{} found; {expected}", self.nodes)));
        }
        if self.sets == 0 {
            return Some(("sets", "0 found; at least 1 expected".to_owned()));
        }
        match self.seconds {
            Some(seconds) if !(seconds.is_finite() && seconds > 0.0) => {
                Some(("seconds", format!("{seconds} found; a positive number expected")))
            }
            _ => None,
        }
    }
}

fn evaluators_of(source: &Source, file: &File) -> Result<Vec<EvaluatorKind>, ProblemError> {
    let evaluators = match &file.evaluators {
        Some(evaluators) => evaluators.clone(),
        None if file.query.is_some() => vec![EvaluatorKind::Query(evaluate::Query::default())],
        None => Vec::new(),
    };
    for (index, evaluator) in evaluators.iter().enumerate() {
        let place = [Key("evaluators"), Index(index)];
        let method = evaluator.method();
        if let Some((key, found, expected)) = method.complaint() {
            let message = format!("{key} = {found} found; {expected} expected");
            return Err(source.error(&place, message));
        }
        if method.needs_query() && file.query.is_none() {
            let message = format!("the {} evaluator needs a [query] table", method.name());
            return Err(source.error(&place, message));
        }
    }
    Ok(evaluators)
}

fn with_query(
    source: &Source,
    problem: Problem,
    mut query: QueryTable,
) -> Result<Problem, ProblemError> {
    let cx = problem.context();
    for (key, q) in [("start", &mut query.start), ("goal", &mut query.goal)] {
        settle(&cx, q).map_err(|message| source.error(&[Key("query"), Key(key)], message))?;
    }
    Ok(Problem { query: Some(Ends { start: query.start, goal: query.goal }), ..problem })
}
