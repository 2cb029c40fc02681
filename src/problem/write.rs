//! A problem written out as a problem file that loads to the same problem.

use super::Problem;
use crate::roadmap::Digest;
use crate::robot::{JointKind, Limits, Link};
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::space::Motion;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A problem as files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The problem file.
    pub text: String,
    /// The meshes that it names: file name and contents, Wavefront `.obj`. Bodies with the same mesh
    /// share one.
    pub meshes: Vec<(String, String)>,
}

impl Problem {
    /// Writes the problem as TOML whose meshes stand in `folder`, a path from the file's own folder.
    /// What loads from it has the same [`Problem::digest`] and the same query: every number is
    /// written with the digits that give it back to the bit, and every mesh as it is used, after all
    /// that its reader joined, turned and moved. Notes become comments.
    pub fn to_toml(&self, folder: &str) -> Written {
        let mut writer =
            Writer { folder, meshes: Vec::new(), taken: BTreeSet::new(), mesh_of: BTreeMap::new() };
        let mut text = String::new();
        writer.problem(self, &mut text).expect("writing to memory cannot fail");
        Written { text, meshes: writer.meshes }
    }
}

struct Writer<'a> {
    folder: &'a str,
    meshes: Vec<(String, String)>,
    /// The file names of the meshes in small letters: some file systems take capitals for the same.
    taken: BTreeSet<String>,
    mesh_of: BTreeMap<Digest, String>,
}

impl Writer<'_> {
    fn problem(&mut self, problem: &Problem, out: &mut String) -> std::fmt::Result {
        for note in &problem.notes {
            let line: String = note.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            writeln!(out, "# {line}")?;
        }
        writeln!(out, "name = {}", value(&problem.name))?;
        writeln!(out, "seed = {}", problem.seed)?;
        if problem.evaluators.is_empty() && problem.query.is_some() {
            writeln!(out, "evaluators = []")?;
        }

        let (robot, bounds) = (&problem.robot, &problem.bounds);
        let axes = robot.motion.bounded_axes();
        writeln!(out, "\n[space]\nmotion = {}", value(&robot.motion))?;
        writeln!(out, "min = {:?}\nmax = {:?}", &bounds.min[..axes], &bounds.max[..axes])?;
        writeln!(out, "bounds = {}", value(&bounds.meaning))?;
        writeln!(out, "resolution = {:?}", problem.resolution)?;
        writeln!(out, "edges = {}", value(&problem.edges))?;
        writeln!(out, "rotation_length = {:?}", problem.rotation_length)?;

        writeln!(out, "\n[robot]\nname = {}", value(&robot.links[0].name))?;
        if robot.motion == Motion::Fixed {
            writeln!(out, "base = {}", frame(&robot.base))?;
        }
        self.link_bodies(&robot.links[0], out)?;
        let name = |link: u32| value(&robot.links[link as usize].name);
        if !robot.may_touch.is_empty() {
            let pair = |(a, b): &(u32, u32)| format!("[{}, {}]", name(*a), name(*b));
            let pairs: Vec<String> = robot.may_touch.iter().map(pair).collect();
            writeln!(out, "may_touch = [{}]", pairs.join(", "))?;
        }
        for link in &robot.links[1..] {
            let joint = link.joint.as_ref().expect("every link but the base hangs on a joint");
            writeln!(out, "\n[[robot.links]]\nname = {}", value(&link.name))?;
            self.link_bodies(link, out)?;
            writeln!(out, "[robot.links.joint]\nname = {}", value(&joint.name))?;
            writeln!(out, "parent = {}\nkind = {}", name(joint.parent), kind(&joint.kind))?;
            for (key, pose) in [("before", &joint.before), ("after", &joint.after)] {
                writeln!(out, "{key} = {}", frame(pose))?;
            }
        }

        for (index, body) in problem.obstacles.iter().enumerate() {
            writeln!(out, "\n[[obstacles]]")?;
            writeln!(out, "shape = {}", self.shape(&body.shape, &format!("obstacle-{index}")))?;
            for (key, array) in pose_keys(&body.pose) {
                writeln!(out, "{key} = {array}")?;
            }
            if let Shape::Mesh(_) = body.shape {
                writeln!(out, "solid = {}", body.solid)?;
            }
        }

        if let Some(query) = &problem.query {
            writeln!(out, "\n[query]\nstart = {:?}\ngoal = {:?}", query.start, query.goal)?;
        }
        building(problem, out)
    }

    fn link_bodies(&mut self, link: &Link, out: &mut String) -> std::fmt::Result {
        if link.bodies.is_empty() {
            return Ok(());
        }
        writeln!(out, "bodies = [")?;
        for (index, body) in link.bodies.iter().enumerate() {
            let name = match index {
                0 => link.name.clone(),
                _ => format!("{}-{index}", link.name),
            };
            writeln!(out, "    {{ {} }},", self.body(body, &name))?;
        }
        writeln!(out, "]")
    }

    fn body(&mut self, body: &Body, name: &str) -> String {
        let mut text = format!("shape = {}", self.shape(&body.shape, name));
        for (key, array) in pose_keys(&body.pose) {
            text += &format!(", {key} = {array}");
        }
        if let Shape::Mesh(_) = body.shape {
            text += &format!(", solid = {}", body.solid);
        }
        text
    }

    fn shape(&mut self, shape: &Shape, name: &str) -> String {
        match shape {
            Shape::Point => "{ point = {} }".to_owned(),
            Shape::Box { size } => format!("{{ box = {{ size = {size:?} }} }}"),
            Shape::Sphere { radius } => format!("{{ sphere = {{ radius = {radius:?} }} }}"),
            Shape::Cylinder { radius, height } => {
                format!("{{ cylinder = {{ radius = {radius:?}, height = {height:?} }} }}")
            }
            Shape::Capsule { radius, height } => {
                format!("{{ capsule = {{ radius = {radius:?}, height = {height:?} }} }}")
            }
            Shape::Mesh(mesh) => {
                let mesh = self.mesh(mesh, name);
                let file = format!("{}/{mesh}", self.folder);
                format!("{{ mesh = {{ file = {} }} }}", value(&file))
            }
        }
    }

    /// The file of a mesh: that of an equal one, or a new one of a name that none has.
    fn mesh(&mut self, mesh: &Mesh, name: &str) -> String {
        let digest = Digest::of(&crate::wire::encode(mesh));
        if let Some(file) = self.mesh_of.get(&digest) {
            return file.clone();
        }
        let mut file = format!("{name}.obj");
        for count in 2.. {
            if self.taken.insert(file.to_lowercase()) {
                break;
            }
            file = format!("{name}-{count}.obj");
        }
        self.meshes.push((file.clone(), mesh.to_obj()));
        self.mesh_of.insert(digest, file.clone());
        file
    }
}

fn building(problem: &Problem, out: &mut String) -> std::fmt::Result {
    let labels = problem.schedule.iter().map(|index| &problem.strategies[*index as usize].label);
    let labels: Vec<&String> = labels.collect();
    writeln!(out, "\n[img]\nsets_per_round = {}", problem.sets_per_round)?;
    match &problem.adaptive {
        None => writeln!(out, "schedule = {}", value(&labels))?,
        Some(adaptive) => writeln!(out, "schedule = {{ adaptive = {} }}", value(adaptive))?,
    }
    for strategy in &problem.strategies {
        writeln!(out, "\n[[strategies]]\nlabel = {}", value(&strategy.label))?;
        writeln!(out, "nodes = {}\nsampler = {}", strategy.nodes, value(&strategy.sampler))?;
        writeln!(out, "within = {}", value(&strategy.within))?;
        writeln!(out, "among = {}", value(&strategy.among))?;
    }
    for evaluator in &problem.evaluators {
        writeln!(out, "\n[[evaluators]]")?;
        let method = toml::Table::try_from(evaluator).expect("a method is a table");
        for (name, settings) in method {
            writeln!(out, "{name} = {settings}")?;
        }
    }
    let limits = &problem.limits;
    writeln!(out, "\n[limits]\nnodes = {}", limits.nodes)?;
    if limits.sets != u64::MAX {
        writeln!(out, "sets = {}", limits.sets)?;
    }
    match limits.seconds {
        Some(seconds) => writeln!(out, "seconds = {seconds:?}"),
        None => Ok(()),
    }
}

/// A value as TOML writes it, within one line.
fn value<T: Serialize + ?Sized>(of: &T) -> String {
    toml::Value::try_from(of).expect("problems hold what TOML can write").to_string()
}

/// The keys of a pose that moves something.
fn pose_keys(pose: &Pose) -> Vec<(&'static str, String)> {
    // By bits: −0 is not 0 in a digest.
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let (position, orientation) = (&pose.translation, &pose.rotation);
    let mut keys = Vec::new();
    if bits(position) != bits(&Pose::IDENTITY.translation) {
        keys.push(("position", format!("{position:?}")));
    }
    if bits(orientation) != bits(&Pose::IDENTITY.rotation) {
        keys.push(("orientation", format!("{orientation:?}")));
    }
    keys
}

fn frame(pose: &Pose) -> String {
    let keys: Vec<String> =
        pose_keys(pose).into_iter().map(|(key, array)| format!("{key} = {array}")).collect();
    if keys.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", keys.join(", ")) }
}

fn kind(kind: &JointKind) -> String {
    match kind {
        JointKind::Fixed => "{ fixed = {} }".to_owned(),
        JointKind::Spherical => "{ spherical = {} }".to_owned(),
        JointKind::Revolute { axis, limits: None } => {
            format!("{{ revolute = {{ axis = {axis:?} }} }}")
        }
        JointKind::Revolute { axis, limits: Some(Limits { min, max }) } => {
            format!("{{ revolute = {{ axis = {axis:?}, radians = [{min:?}, {max:?}] }} }}")
        }
        JointKind::Prismatic { axis, limits: Limits { min, max } } => {
            format!("{{ prismatic = {{ axis = {axis:?}, range = [{min:?}, {max:?}] }} }}")
        }
    }
}
