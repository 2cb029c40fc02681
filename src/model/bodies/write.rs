//! Rigid robots and obstacles written out as the tables of a problem file.

use super::Bodies;
use super::padding::spec_of_padding;
use super::robot::{JointKind, Limits, Link, Mimic};
use super::spec::PaddingSpec;
use crate::digest::Digest;
use crate::model::Documents;
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::source::value;
use crate::space::BaseJoint;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Appends the tables.
pub(super) fn write(bodies: &Bodies, documents: &mut Documents) {
    let mut text = String::new();
    let mut writer = Writer { documents, taken: BTreeSet::new() };
    writer.tables(bodies, &mut text).expect("writing to memory cannot fail");
    documents.text += &text;
}

struct Writer<'a> {
    documents: &'a mut Documents,
    /// The file names of the meshes in small letters: some file systems take capitals for the same.
    taken: BTreeSet<String>,
}

impl Writer<'_> {
    fn tables(&mut self, bodies: &Bodies, out: &mut String) -> std::fmt::Result {
        let (robot, bounds) = (&bodies.robot, &bodies.bounds);
        let axes = robot.motion.bounded_axes();
        writeln!(out, "\n[space]\nmotion = {}", value(&robot.motion))?;
        writeln!(out, "min = {:?}\nmax = {:?}", &bounds.min[..axes], &bounds.max[..axes])?;
        writeln!(out, "bounds = {}", value(&bounds.meaning))?;
        writeln!(out, "resolution = {:?}", bodies.resolution)?;
        writeln!(out, "edges = {}", value(&bodies.edges))?;
        writeln!(out, "rotation_length = {:?}", bodies.rotation_length)?;

        writeln!(out, "\n[robot]\nname = {}", value(&robot.links[0].name))?;
        if robot.motion == BaseJoint::Fixed {
            writeln!(out, "base = {}", frame(&robot.base))?;
        }
        self.link_bodies(&robot.links[0], out)?;
        let name = |link: u32| value(&robot.links[link as usize].name);
        if !robot.may_touch.is_empty() {
            let pair = |(a, b): &(u32, u32)| format!("[{}, {}]", name(*a), name(*b));
            let pairs: Vec<String> = robot.may_touch.iter().map(pair).collect();
            writeln!(out, "may_touch = [{}]", pairs.join(", "))?;
        }
        match spec_of_padding(robot) {
            None => {}
            Some(PaddingSpec::Same(length)) => writeln!(out, "padding = {length:?}")?,
            Some(PaddingSpec::ByLink(by_link)) => {
                let entry = |(link, length)| format!("{} = {length:?}", value(link));
                let entries: Vec<String> = by_link.iter().map(entry).collect();
                writeln!(out, "padding = {{ {} }}", entries.join(", "))?;
            }
        }
        for link in &robot.links[1..] {
            let joint = link.joint.as_ref().expect("every link but the base hangs on a joint");
            writeln!(out, "\n[[robot.links]]\nname = {}", value(&link.name))?;
            self.link_bodies(link, out)?;
            writeln!(out, "[robot.links.joint]\nname = {}", value(&joint.name))?;
            writeln!(out, "parent = {}\nkind = {}", name(joint.parent), kind(&joint.kind))?;
            if let Some(Mimic { value, multiplier, offset }) = joint.kind.mimic() {
                let link =
                    robot.link_of_value(*value).map_or_else(String::new, |link| name(link as u32));
                let numbers = format!("multiplier = {multiplier:?}, offset = {offset:?}");
                writeln!(out, "mimic = {{ link = {link}, {numbers} }}")?;
            }
            for (key, pose) in [("before", &joint.before), ("after", &joint.after)] {
                writeln!(out, "{key} = {}", frame(pose))?;
            }
        }

        for (index, body) in bodies.obstacles.iter().enumerate() {
            writeln!(out, "\n[[obstacles]]")?;
            writeln!(out, "shape = {}", self.shape(&body.shape, &format!("obstacle-{index}")))?;
            for (key, array) in pose_keys(&body.pose) {
                writeln!(out, "{key} = {array}")?;
            }
            if let Shape::Mesh(_) = body.shape {
                writeln!(out, "solid = {}", body.solid)?;
            }
        }
        Ok(())
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
                // Of an open mesh no more vertices are to be joined than were; a closed one stays as it is anyway.
                let weld = if mesh.is_closed() { "" } else { ", weld = 0" };
                let mesh = self.mesh(mesh, name);
                let file = format!("{}/{mesh}", self.documents.folder);
                format!("{{ mesh = {{ file = {}{weld} }} }}", value(&file))
            }
        }
    }

    /// The file of a mesh: that of an equal one, or a new one of a name that none has.
    fn mesh(&mut self, mesh: &Mesh, name: &str) -> String {
        let digest = Digest::of(&crate::wire::encode(mesh));
        if let Some(file) = self.documents.names.get(&digest) {
            return file.clone();
        }
        let mut file = format!("{name}.obj");
        for count in 2.. {
            if self.taken.insert(file.to_lowercase()) {
                break;
            }
            file = format!("{name}-{count}.obj");
        }
        self.documents.files.push((file.clone(), mesh.to_obj()));
        self.documents.names.insert(digest, file.clone());
        file
    }
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
        JointKind::Locked => "{ locked = {} }".to_owned(),
        JointKind::PrismaticMimic { axis, .. } => {
            format!("{{ prismatic = {{ axis = {axis:?} }} }}")
        }
        JointKind::Revolute { axis, limits: None } | JointKind::RevoluteMimic { axis, .. } => {
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
