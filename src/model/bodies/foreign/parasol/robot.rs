//! A robot: a number of bodies, then `Connections`, a number of them.
//!
//! A body's frame in that of the body before it is F·Rz(θ)·Tz(d)·Tx(a)·Rx(α)·G: F from body to joint, G
//! from joint to body, between them the four numbers of Denavit and Hartenberg. A revolute joint moves
//! θ, a spherical one θ and α, whose values in the file then do not count.

use super::words::{Words, number};
use super::{Geometry, Reader};
use crate::model::bodies::foreign::frames::{compose, turn};
use crate::model::bodies::foreign::{
    Base, DhOrder, ForeignBody, ForeignError, ForeignJoint, ForeignJointKind, ForeignLink,
};
use crate::model::bodies::robot::{LINKS_MAX, TURN_MAX};
use crate::scene::Pose;
use crate::space::BaseJoint;
use std::collections::BTreeSet;
use std::f64::consts::PI;

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

pub(super) struct Robot {
    pub base: Base,
    pub links: Vec<ForeignLink>,
    pub may_touch: Vec<(usize, usize)>,
    /// For each moving joint in the order of the links: its place among Parasol's joint values, which
    /// follow the indices of the joints' bodies.
    pub places: Vec<usize>,
}

struct Body {
    name: String,
    base: Option<Base>,
    body: ForeignBody,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Revolute,
    Spherical,
    NonActuated,
}

struct Connection {
    line: usize,
    from: usize,
    to: usize,
    kind: Kind,
    /// In radians.
    limits: [[f64; 2]; 2],
    before: Pose,
    /// alpha a d theta, angles in radians.
    dh: [f64; 4],
    /// Whether the four act as Rx(alpha) Tx(a) Rz(theta) Tz(d), not as Rz(theta) Tz(d) Tx(a) Rx(alpha).
    modified: bool,
    after: Pose,
}

pub(super) fn read(words: &mut Words, reader: &mut Reader) -> Result<Robot, ForeignError> {
    let count = words.count("the number of the robot's bodies")?;
    if count == 0 {
        return Err(words.error("0 bodies found; at least one expected"));
    }
    if count > LINKS_MAX {
        return Err(words.error(format!("{count} bodies found; at most {LINKS_MAX} expected")));
    }
    let mut bodies = Vec::new();
    let mut names = BTreeSet::new();
    for index in 0..count {
        let body = body(words, index, &mut names, reader)?;
        if body.base.is_some() && bodies.iter().any(|other: &Body| other.base.is_some()) {
            return Err(words.error("a second base found; one, and else `Joint`, expected"));
        }
        bodies.push(body);
    }
    let Some(base) = bodies.iter().position(|body| body.base.is_some()) else {
        let expected = "`Planar`, `Volumetric` or `Fixed` expected of one";
        return Err(words.error(format!("no base among the {count} bodies found; {expected}")));
    };
    let mut touching = Vec::new();
    if words.peek().is_some_and(|word| word.eq_ignore_ascii_case("adjacencies")) {
        words.keyword("Adjacencies")?;
        for _ in 0..words.count("the number of adjacencies")? {
            touching.push((index(words, count)?, index(words, count)?));
        }
    }
    words.keyword("Connections")?;
    let mut connections = Vec::new();
    for _ in 0..words.count("the number of connections")? {
        let connection = connection(words, count, reader)?;
        if connection.to == base {
            return Err(words.error(format!("body {base} is the base and cannot hang on another")));
        }
        if connections.iter().any(|other: &Connection| other.to == connection.to) {
            let message = format!(
                "body {} hangs on two others; closed loops are not supported",
                connection.to
            );
            return Err(words.error(message));
        }
        connections.push(connection);
    }
    connections.sort_by_key(|connection| (connection.from, connection.to));
    assemble(words, base, bodies, &connections, &touching)
}

/// `FILE Planar|Volumetric Rotational|Translational`, `FILE Fixed POSE` or `FILE Joint`.
fn body(
    words: &mut Words,
    index: usize,
    names: &mut BTreeSet<String>,
    reader: &mut Reader,
) -> Result<Body, ForeignError> {
    let geometry = Geometry::read(words)?;
    let kind = words.next("`Planar`, `Volumetric`, `Fixed` or `Joint`")?.to_ascii_lowercase();
    let base = match kind.as_str() {
        "joint" => None,
        "fixed" => Some(Base::Fixed(words.pose()?)),
        "planar" | "volumetric" => {
            let movement = words.next("`Rotational` or `Translational`")?;
            let planar = kind == "planar";
            Some(Base::Moving(match movement.to_ascii_lowercase().as_str() {
                "translational" if planar => BaseJoint::Translation2d,
                "translational" => BaseJoint::Translation3d,
                "rotational" if planar => BaseJoint::Rigid2d,
                "rotational" => BaseJoint::Rigid3d,
                _ => {
                    let expected = "`Rotational` or `Translational` expected";
                    return Err(words.error(format!("`{movement}` found; {expected}")));
                }
            }))
        }
        _ => {
            let expected = "`Planar`, `Volumetric`, `Fixed` or `Joint` expected";
            return Err(words.error(format!("`{kind}` found; {expected}")));
        }
    };
    let what = format!("robot body {index}");
    let body = geometry.body(&what, words.path, Pose::IDENTITY, reader)?;
    let stem = body.file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
    let name = if names.contains(&stem) { format!("{stem}-{index}") } else { stem };
    names.insert(name.clone());
    Ok(Body { name, base, body })
}

fn connection(
    words: &mut Words,
    bodies: usize,
    reader: &mut Reader,
) -> Result<Connection, ForeignError> {
    let (from, to) = (index(words, bodies)?, index(words, bodies)?);
    let line = words.line();
    let word = words.next("the kind of a joint")?;
    let (kind, turns) = match word.to_ascii_lowercase().as_str() {
        "revolute" => (Kind::Revolute, 1),
        "spherical" => (Kind::Spherical, 2),
        "nonactuated" => (Kind::NonActuated, 0),
        _ => {
            let expected = "`Revolute`, `Spherical` or `NonActuated` expected";
            return Err(words.error(format!("`{word}` found; {expected}")));
        }
    };
    let mut limits = [[0.0; 2]; 2];
    for limit in limits.iter_mut().take(turns) {
        let word = words.next("limits min:max")?;
        let ends = word.split_once(':');
        let ends = ends.and_then(|(low, high)| Some([number(low)? * PI, number(high)? * PI]));
        *limit = match ends {
            // Ten turns either way, as in problem files.
            Some([low, high]) if low <= high && low.abs().max(high.abs()) <= TURN_MAX => {
                [low, high]
            }
            _ => {
                let expected = "limits min:max within ±20 (times π) expected";
                return Err(words.error(format!("`{word}` found; {expected}")));
            }
        };
    }
    let before = words.pose()?;
    let mut dh = [0.0; 4];
    for value in &mut dh {
        *value = words.number("alpha a d theta of Denavit and Hartenberg")?;
    }
    let after = words.pose()?;
    let [alpha, a, d, theta] = dh;
    let given_alpha = if kind == Kind::Spherical { 0.0 } else { alpha };
    let modified = reader.options.dh == Some(DhOrder::Modified);
    let notes = &mut reader.notes;
    if [given_alpha, a, d] != [0.0; 3] && reader.options.dh.is_none() {
        notes.push(format!(
            "line {line}: alpha a d theta read as Rz(theta) Tz(d) Tx(a) Rx(alpha), in radians, as by \
             Parasol's present library; scenes of older ones may mean Rx(alpha) Tx(a) Rz(theta) Tz(d) \
             (--dh)"
        ));
    }
    let moved = [kind != Kind::NonActuated && theta != 0.0, given_alpha != alpha];
    if moved != [false; 2] {
        notes.push(format!("line {line}: values of what the joint moves passed over"));
    }
    Ok(Connection { line, from, to, kind, limits, before, dh, modified, after })
}

fn index(words: &mut Words, bodies: usize) -> Result<usize, ForeignError> {
    let index = words.count("the index of a body")?;
    if index >= bodies {
        return Err(words.error(format!("body {index} does not exist; there are {bodies}, from 0")));
    }
    Ok(index)
}

/// Links in the order of a walk from the base.
fn assemble(
    words: &Words,
    base: usize,
    bodies: Vec<Body>,
    connections: &[Connection],
    touching: &[(usize, usize)],
) -> Result<Robot, ForeignError> {
    let mut place = 0;
    let mut places_of = Vec::new();
    for connection in connections {
        places_of.push(place);
        place += match connection.kind {
            Kind::Revolute => 1,
            Kind::Spherical => 2,
            Kind::NonActuated => 0,
        };
    }
    let kind_of_base = bodies[base].base.expect("found above");
    let mut bodies: Vec<Option<Body>> = bodies.into_iter().map(Some).collect();
    let mut link_of = vec![usize::MAX; bodies.len()];
    let mut robot =
        Robot { base: kind_of_base, links: Vec::new(), may_touch: Vec::new(), places: Vec::new() };
    let mut add = |robot: &mut Robot, body: usize, joint| {
        let Body { name, body: own, .. } = bodies[body].take().expect("each body hangs on one");
        robot.links.push(ForeignLink { name, bodies: vec![own], joint });
        link_of[body] = robot.links.len() - 1;
        robot.links.len() - 1
    };
    let mut walk = vec![(base, add(&mut robot, base, None))];
    let mut reached = 0;
    while let Some((body, link)) = walk.get(reached).copied() {
        reached += 1;
        let first = connections.partition_point(|connection| connection.from < body);
        let own = connections[first..].iter().zip(&places_of[first..]);
        for (connection, place) in own.take_while(|(connection, _)| connection.from == body) {
            let joint = connection.joints(link, *place, &mut robot);
            walk.push((connection.to, add(&mut robot, connection.to, Some(joint))));
        }
    }
    if walk.len() < bodies.len() {
        let lost = link_of.iter().position(|link| *link == usize::MAX).expect("one is missing");
        let message = format!("body {lost} does not hang on the base");
        let line = connections.iter().find(|connection| connection.to == lost).map(|c| c.line);
        return Err(match line {
            Some(line) => ForeignError::line(words.path, line, message),
            None => words.error(format!("{message}; a connection to it expected")),
        });
    }
    for (a, b) in touching {
        let (a, b) = (link_of[*a], link_of[*b]);
        robot.may_touch.push((a.min(b), a.max(b)));
    }
    Ok(robot)
}

impl Connection {
    /// The joint of the link beyond; of a spherical joint the second one, after a link of its own for
    /// the first.
    fn joints(&self, parent: usize, place: usize, robot: &mut Robot) -> ForeignJoint {
        let [alpha, a, d, theta] = self.dh;
        let about = |axis, angle| Pose {
            rotation: turn(axis, angle).expect("unit axes have a direction"),
            ..Pose::IDENTITY
        };
        let along = |translation| Pose { translation, ..Pose::IDENTITY };
        let (by_alpha, by_theta) = (about(X, alpha), about(Z, theta));
        // The turn about z, what stands between the turns, and the turn about x; or the other way round.
        let between = along(if self.modified { [a, 0.0, 0.0] } else { [a, 0.0, d] });
        let (before, mut after) = (self.before, self.after);
        if self.modified {
            after = compose(&along([0.0, 0.0, d]), &after);
        }
        let name = format!("{}-{}", self.from, self.to);
        let turns = |axis, [min, max]: [f64; 2]| ForeignJointKind::Revolute { axis, min, max };
        let [about_z, about_x] = [turns(Z, self.limits[0]), turns(X, self.limits[1])];
        match self.kind {
            Kind::NonActuated => {
                let (first, last) =
                    if self.modified { (by_alpha, by_theta) } else { (by_theta, by_alpha) };
                let turned = compose(&first, &compose(&between, &last));
                let after = compose(&turned, &after);
                ForeignJoint { name, parent, kind: ForeignJointKind::Fixed, before, after }
            }
            Kind::Revolute => {
                robot.places.push(place);
                let (before, after) = if self.modified {
                    (compose(&before, &compose(&by_alpha, &between)), after)
                } else {
                    (before, compose(&compose(&between, &by_alpha), &after))
                };
                ForeignJoint { name, parent, kind: about_z, before, after }
            }
            Kind::Spherical => {
                let mut turns = [("theta", about_z, place), ("alpha", about_x, place + 1)];
                if self.modified {
                    turns.reverse();
                }
                robot.places.extend(turns.map(|(_, _, place)| place));
                let [(first, kind, _), (second, last, _)] = turns;
                let first = format!("{name}-{first}");
                let joint =
                    ForeignJoint { name: first.clone(), parent, kind, before, after: between };
                robot.links.push(ForeignLink {
                    name: first,
                    bodies: Vec::new(),
                    joint: Some(joint),
                });
                ForeignJoint {
                    name: format!("{name}-{second}"),
                    parent: robot.links.len() - 1,
                    kind: last,
                    before: Pose::IDENTITY,
                    after,
                }
            }
        }
    }
}
