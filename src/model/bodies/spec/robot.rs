use super::{BodySpec, FrameSpec, JointSpec};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The robot: a base, and links that hang on it by joints. The table `[robot]`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotSpec {
    pub(in crate::model::bodies) name: Option<String>,
    pub(in crate::model::bodies) urdf: Option<PathBuf>,
    pub(in crate::model::bodies) srdf: Option<PathBuf>,
    pub(in crate::model::bodies) group: Option<String>,
    #[serde(default)]
    pub(in crate::model::bodies) rest: Vec<String>,
    #[serde(default)]
    pub(in crate::model::bodies) lock: BTreeMap<String, f64>,
    #[serde(default)]
    pub(in crate::model::bodies) bodies: Vec<BodySpec>,
    pub(in crate::model::bodies) base: Option<FrameSpec>,
    #[serde(default)]
    pub(in crate::model::bodies) links: Vec<LinkSpec>,
    #[serde(default)]
    pub(in crate::model::bodies) attach: Vec<AttachSpec>,
    #[serde(default)]
    pub(in crate::model::bodies) may_touch: Vec<[String; 2]>,
    pub(in crate::model::bodies) padding: Option<PaddingSpec>,
}

/// How near to links obstacles are already in the way: the key `padding`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a length, or a table of links and their lengths, \"*\" being all others"
)]
pub(in crate::model::bodies) enum PaddingSpec {
    /// The same of all links.
    Same(f64),
    /// By the names of links; [`ALL_OTHERS`] stands for those that are not named.
    ByLink(BTreeMap<String, f64>),
}

/// What stands for all links that a padding does not name; no link can have this name.
pub(in crate::model::bodies) const ALL_OTHERS: &str = "*";

impl RobotSpec {
    /// A base without bodies and links.
    pub fn new() -> RobotSpec {
        RobotSpec::default()
    }

    /// The robot of a URDF file, whose links and bodies take the place of all that could be given here. A relative path
    /// starts where those of meshes do.
    pub fn urdf(file: impl Into<PathBuf>) -> RobotSpec {
        RobotSpec { urdf: Some(file.into()), ..RobotSpec::default() }
    }

    /// The SRDF that stands beside the URDF, by a path as that of the URDF: its groups, named states, and pairs of links
    /// that may touch.
    pub fn srdf(self, file: impl Into<PathBuf>) -> RobotSpec {
        RobotSpec { srdf: Some(file.into()), ..self }
    }

    /// The SRDF's group of joints that move. All others are locked.
    pub fn group(self, name: impl Into<String>) -> RobotSpec {
        RobotSpec { group: Some(name.into()), ..self }
    }

    /// A named state of the SRDF at which joints outside the group are locked, after those given before.
    pub fn rest(mut self, state: impl Into<String>) -> RobotSpec {
        self.rest.push(state.into());
        self
    }

    /// Locks a joint at a value: an angle in radians, or a length.
    pub fn lock(mut self, joint: impl Into<String>, value: f64) -> RobotSpec {
        self.lock.insert(joint.into(), value);
        self
    }

    /// The name of the base, by which `may_touch` and joints know it; `base` if nothing is said.
    pub fn name(self, name: impl Into<String>) -> RobotSpec {
        RobotSpec { name: Some(name.into()), ..self }
    }

    /// Adds a body to the base; its frame is the base's.
    pub fn body(mut self, body: impl Into<BodySpec>) -> RobotSpec {
        self.bodies.push(body.into());
        self
    }

    /// Where a base that does not move stands in the world.
    pub fn base(self, frame: FrameSpec) -> RobotSpec {
        RobotSpec { base: Some(frame), ..self }
    }

    /// Adds a link.
    pub fn link(mut self, link: LinkSpec) -> RobotSpec {
        self.links.push(link);
        self
    }

    /// Attaches bodies to a link.
    pub fn attach(mut self, attached: AttachSpec) -> RobotSpec {
        self.attach.push(attached);
        self
    }

    /// Lets obstacles be in the way as soon as they come as near as this length to any link, in the place of all padding that
    /// was given before.
    pub fn padding(self, length: f64) -> RobotSpec {
        RobotSpec { padding: Some(PaddingSpec::Same(length)), ..self }
    }

    /// Lets obstacles be in the way as soon as they come as near as this length to a link, whatever is said of all links.
    pub fn padding_of(self, link: impl Into<String>, length: f64) -> RobotSpec {
        let mut by_link = match self.padding {
            None => BTreeMap::new(),
            Some(PaddingSpec::Same(length)) => BTreeMap::from([(ALL_OTHERS.to_owned(), length)]),
            Some(PaddingSpec::ByLink(by_link)) => by_link,
        };
        by_link.insert(link.into(), length);
        RobotSpec { padding: Some(PaddingSpec::ByLink(by_link)), ..self }
    }

    /// Allows two links to touch, which are no neighbours: neighbours always may.
    pub fn may_touch(mut self, first: impl Into<String>, second: impl Into<String>) -> RobotSpec {
        self.may_touch.push([first.into(), second.into()]);
        self
    }
}

/// A link and the joint by which it hangs on another: one of `[[robot.links]]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkSpec {
    pub(in crate::model::bodies) name: String,
    #[serde(default)]
    pub(in crate::model::bodies) bodies: Vec<BodySpec>,
    pub(in crate::model::bodies) joint: JointSpec,
}

impl LinkSpec {
    /// A link without bodies. Its name is one that no other link has.
    pub fn new(name: impl Into<String>, joint: JointSpec) -> LinkSpec {
        LinkSpec { name: name.into(), bodies: Vec::new(), joint }
    }

    /// Adds a body; its frame is the link's.
    pub fn body(mut self, body: impl Into<BodySpec>) -> LinkSpec {
        self.bodies.push(body.into());
        self
    }
}

/// Bodies that a link carries, such as a tool or a load: one of `[[robot.attach]]`. They become a link of their own, held by a
/// locked joint, which may touch the link that carries it and no other.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AttachSpec {
    pub(in crate::model::bodies) name: String,
    pub(in crate::model::bodies) link: String,
    pub(in crate::model::bodies) bodies: Vec<BodySpec>,
}

impl AttachSpec {
    /// A new link of a name that no other has, on the link `link`, and without bodies at first.
    pub fn new(name: impl Into<String>, link: impl Into<String>) -> AttachSpec {
        AttachSpec { name: name.into(), link: link.into(), bodies: Vec::new() }
    }

    /// Adds a body; its frame is that of the link that carries it.
    pub fn body(mut self, body: impl Into<BodySpec>) -> AttachSpec {
        self.bodies.push(body.into());
        self
    }
}
