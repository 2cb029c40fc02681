//! Models: what is planned for. One folder per model.
//!
//! A model has two sides. Its *description* is plain data, as a problem file gives it: it travels between
//! processes, enters the problem's digest, is written back as a file, described for people and drawn. From
//! it a process *prepares* the model itself, which answers the questions of planning: what is valid, what
//! a motion costs. Samplers, connections and evaluators know a model by the trait [`Model`] alone. What
//! not every model can say, such as how far the nearest obstacle is, is a capability, asked for.
//!
//! ```
//! use roadmill::{model::Scratch, problem::Problem};
//!
//! // A ball among obstacles, which only translates.
//! let problem = Problem::load("tests/problems/slide.toml".as_ref())?;
//! let model = problem.model().description().prepare();
//! let scratch = &mut Scratch::new();
//! let (corner, slab) = ([-3.0, -3.0, -3.0], [2.0, 0.0, 0.0]);
//! assert!(model.is_valid(&corner, scratch));
//! assert!(!model.is_valid(&slab, scratch));
//! // What a motion costs, if it is valid at the problem's resolution.
//! assert!(model.motion(&corner, &[-3.0, 3.0, -3.0], 1, scratch).is_some());
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod clearance;
mod contact;
mod cost;
mod description;
mod elasticity;
mod figure;
mod function;
mod gap;
mod ligand_at_protein;
mod molecule;
mod pose_goal;
mod reason;
mod relaxation;
mod scene_change;
mod scratch;

pub mod bodies;
pub mod deformable;
pub mod docking;
pub mod landscape;
pub mod protein;

pub use bodies::foreign::SceneOptions;
pub use clearance::{Approach, Clearance, Clearances, PartKind, SurfacePart, Witnesses};
pub use contact::{Contact, Contacts};
pub use cost::{Cost, Directed};
pub use description::{Description, Documents, ForeignProblem};
pub use elasticity::{Draw, Elastic};
pub use figure::{Figure, Placement};
pub use function::{FunctionFailed, JudgeConfigurations, ValidityFunction, with_functions};
pub use gap::Gaps;
pub use ligand_at_protein::{CellLimits, EnergyParts, ExposedResidue, LigandAtProtein, LowCells};
pub use molecule::{Energies, Molecule};
pub use pose_goal::{PoseFound, PoseGoal};
pub use reason::{BodyName, Reason};
pub use relaxation::{
    CannotRelax, ExtraJoint, ExtraJointKind, HigherEnergy, Penetration, Relaxation, RelaxedModel,
    ScaleAxes, ScaleCentre, ScaleObstacles, ScaleRobot, ThinRobot,
};
pub use scene_change::SceneChange;
pub use scratch::{Asked, ModelScratch, Scratch};

pub(crate) use bodies::foreign::{is_parasol_path, read_parasol_path};
pub(crate) use description::{Resolve, import};
pub(crate) use reason::{SOLE_LINK, link_named, out_of_range};

use crate::scene::Body;
use crate::shelf::Shelf;
use crate::source::{ProblemError, Source};
use crate::space::Space;
use crate::structure::Point;
use crate::structure::measure::Element;
use bincode::{Decode, Encode};
use std::any::Any;
use std::sync::Arc;

/// The models' enums, with what follows from their list: each model's description and its spec, what is asked for.
macro_rules! models {
    ($($variant:ident($description:ty, $spec:ty),)+) => {
        /// The models, each by its description.
        #[derive(Clone, Debug, PartialEq, Encode, Decode)]
        pub enum ModelKind {
            $(#[allow(missing_docs)] $variant($description),)+
        }

        impl ModelKind {
            /// The description behind its role.
            pub fn description(&self) -> &dyn Description {
                match self {
                    $(ModelKind::$variant(description) => description,)+
                }
            }

            /// Checks what is asked for. `notes` gets what was chosen where that leaves a choice.
            pub(crate) fn resolve(
                spec: &ModelSpec,
                source: &Source,
                notes: &mut Vec<String>,
            ) -> Result<ModelKind, ProblemError> {
                match spec {
                    $(ModelSpec::$variant(spec) => {
                        Resolve::resolve(spec, source, notes).map(ModelKind::$variant)
                    })+
                }
            }
        }

        impl ModelKind {
            /// What asks for this model, so that something of it can be changed and checked again.
            pub fn to_spec(&self) -> ModelSpec {
                match self {
                    $(ModelKind::$variant(description) => {
                        ModelSpec::$variant(Resolve::to_spec(description))
                    })+
                }
            }
        }

        /// A model as a problem asks for it, before anything is checked.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(clippy::large_enum_variant, reason = "there is one for a problem")]
        pub enum ModelSpec {
            $(#[allow(missing_docs)] $variant($spec),)+
        }

        $(impl From<$spec> for ModelSpec {
            fn from(spec: $spec) -> ModelSpec {
                ModelSpec::$variant(spec)
            }
        })+

        impl ModelSpec {
            /// The keys of the tables of the model that a problem file describes: the model whose first table it
            /// has, or else any, or else the first model. A model that takes in the tables of another and has a first
            /// table of its own comes before the other.
            pub(crate) fn tables_in(source: &Source) -> &'static [&'static str] {
                let listed = [$(<$description as Resolve>::TABLES),+];
                let has_first = |keys: &&&[&str]| source.has(keys[0]);
                let has_any = |keys: &&&[&str]| keys.iter().any(|key| source.has(key));
                let takes_in = |more: &&&[&str], keys: &[&str]| more[1..].contains(&keys[0]);
                let is_alone = |keys: &&&[&str]| {
                    has_first(keys) && !listed.iter().filter(has_first).any(|more| takes_in(&more, keys))
                };
                let described = listed.iter().find(is_alone).or_else(|| listed.iter().find(has_any));
                described.unwrap_or(&listed[0])
            }

            /// Reads the tables of that model.
            pub(crate) fn read(source: &Source) -> Result<ModelSpec, ProblemError> {
                let tables = ModelSpec::tables_in(source);
                $(if tables == <$description as Resolve>::TABLES {
                    return <$description as Resolve>::spec(source).map(ModelSpec::$variant);
                })+
                unreachable!("the tables are those of a listed model")
            }
        }
    };
}

models! {
    Bodies(bodies::Bodies, bodies::BodiesSpec),
    Landscape(landscape::Landscape, landscape::LandscapeSpec),
    Protein(protein::Protein, protein::ProteinSpec),
    Docking(docking::Docking, docking::DockingSpec),
    Deformable(deformable::Deformable, deformable::DeformableSpec), // new ones at the end, since ledgers know models by number
}

impl ModelKind {
    /// The description of rigid bodies, if that is what the model is.
    pub fn bodies(&self) -> Option<&bodies::Bodies> {
        match self {
            ModelKind::Bodies(bodies) => Some(bodies),
            _ => None,
        }
    }

    /// The description of a deformable robot, if that is what the model is.
    pub fn deformable(&self) -> Option<&deformable::Deformable> {
        match self {
            ModelKind::Deformable(deformable) => Some(deformable),
            _ => None,
        }
    }

    /// The same of bodies, to be changed by tests.
    #[cfg(test)]
    pub(crate) fn bodies_mut(&mut self) -> Option<&mut bodies::Bodies> {
        match self {
            ModelKind::Bodies(bodies) => Some(bodies),
            _ => None,
        }
    }
}

impl ModelSpec {
    /// Changes what is asked of bodies, also of those of a deformable robot; what is asked of another model stays as it is.
    pub fn change_bodies(
        self,
        change: impl FnOnce(bodies::BodiesSpec) -> bodies::BodiesSpec,
    ) -> ModelSpec {
        match self {
            ModelSpec::Bodies(bodies) => ModelSpec::Bodies(change(bodies)),
            ModelSpec::Deformable(spec) => ModelSpec::Deformable(spec.change_bodies(change)),
            other => other,
        }
    }
}

/// Whether a configuration is valid, and if it is not, in which of two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Validity {
    /// It is within its bounds, and nothing forbids it.
    Valid,
    /// It is not within its bounds; whether something else forbids it is not known.
    OutOfBounds,
    /// It is within its bounds but forbidden: of bodies, the robot touches an obstacle or itself.
    Invalid,
}

/// A number that a model gives every milestone, such as an energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeValue {
    /// Its name in exported files.
    pub name: &'static str,
    /// Its unit, `1` for a number without one.
    pub unit: &'static str,
}

/// A model made ready for work.
///
/// All answers are pure functions of the arguments: what a [`Scratch`] remembers may change how fast an
/// answer comes, never the answer. Chance (which configurations are kept, say) stays in samplers.
pub trait Model: Any + Send + Sync {
    /// The configuration space.
    fn space(&self) -> &Space;

    /// Whether `q` is valid. Bounds are looked at first.
    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity;

    /// Whether `q` is valid.
    fn is_valid(&self, q: &[f64], scratch: &mut Scratch) -> bool {
        self.validity(q, scratch) == Validity::Valid
    }

    /// What the motion from `a` to `b` along [`Space::interpolate`], whose ends are valid, costs; `None` if
    /// it is not valid. It is looked at `refinement` times finer than the problem asks for.
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost>;

    /// The model with the obstacles `bodies` instead of its own and without anything else that could be in the way, such
    /// as the robot itself: what is valid in it, and in the model without these obstacles, is valid in the model with
    /// them. `None` of a model whose obstacles do not come and go.
    fn among(&self, _bodies: &[Body]) -> Option<Box<dyn Model>> {
        None
    }

    /// Whether an obstacle may be in the way of the motion from `a` to `b`, or of the configuration where these are the
    /// same; `false` only where none is, whichever way validity is judged. A test by boxes that takes little time; a model
    /// that has none says `true`. Nothing is counted.
    fn may_meet(&self, _a: &[f64], _b: &[f64], _scratch: &mut Scratch) -> bool {
        true
    }

    /// The energy at `q`; `None` where a configuration is valid or not and that is all there is to say.
    fn energy(&self, _q: &[f64], _scratch: &mut Scratch) -> Option<f64> {
        None
    }

    /// The energy at `q`, and to `out` its derivatives by the numbers of [`Space::moved`], of a model whose energy has derivatives: per
    /// unit of each number, so that of a rotation they are per radian.
    fn gradient(&self, _q: &[f64], _out: &mut [f64], _scratch: &mut Scratch) -> Option<f64> {
        None
    }

    /// Whether the energy has derivatives, that is, [`Model::gradient`] is some.
    fn has_gradient(&self) -> bool {
        false
    }

    /// The model as a ligand at a protein, of a model that is one.
    fn ligand(&self) -> Option<&dyn LigandAtProtein> {
        None
    }

    /// Says where the model may keep large tables that all processes with the same problem have in common.
    fn keep_on(&self, _shelf: &Arc<dyn Shelf>) {}

    /// The positions of all Cα at `q`, Å, in their order along the chain, of a model that has them; as many at every
    /// configuration.
    fn shape(&self, _q: &[f64], _scratch: &mut Scratch) -> Option<Vec<Point>> {
        None
    }

    /// The model as an elastic network about `q`, of a model that is one; see [`Elastic`].
    fn elastic<'a>(&'a self, _q: &[f64]) -> Option<Box<dyn Elastic + 'a>> {
        None
    }

    /// A configuration that is known beforehand, such as a molecule's native state, of a model that has one; perhaps it is
    /// not valid.
    fn native(&self) -> Option<&[f64]> {
        None
    }

    /// The helices and strands of the native configuration, of a model that has them.
    fn elements(&self) -> &[Element] {
        &[]
    }

    /// The reasons why `q` is not valid, every one that there is; none where it is valid. This is for people: it takes much
    /// longer than [`Model::validity`]. Without `depths` it takes less, and depths of collisions are NaN. Nothing is counted.
    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason>;

    /// Whether some configuration within the bounds could be invalid.
    fn is_obstructed(&self) -> bool;

    /// A box, by its least and its largest corner, that holds the position of the robot's base wherever the robot may touch an
    /// obstacle; of a planar robot the third coordinates are any. Outside of it all configurations within the bounds are valid. `None` where
    /// that is not so, as some of the robot's links must not touch one another, or is not known. It may be infinite.
    fn touching_box(&self) -> Option<[[f64; 3]; 2]> {
        None
    }

    /// What numbers every milestone of a roadmap carries, in the order of [`Model::values`].
    fn node_values(&self) -> &'static [NodeValue] {
        &[]
    }

    /// Appends these numbers for the milestone `q`.
    fn values(&self, _q: &[f64], _out: &mut Vec<f64>, _scratch: &mut Scratch) {}

    /// Distances to obstacles, of a model that has them.
    fn clearances(&self) -> Option<&dyn Clearances> {
        None
    }

    /// Where bodies meet and how they come apart, of a model that has bodies.
    fn contacts(&self) -> Option<&dyn Contacts> {
        None
    }

    /// Gaps of a robot and of obstacles, of a model that has both.
    fn gaps(&self) -> Option<&dyn Gaps> {
        None
    }
}
