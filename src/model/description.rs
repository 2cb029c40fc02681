use super::bodies::foreign::SceneOptions;
use super::{
    CannotRelax, Figure, Model, ModelKind, Molecule, NodeValue, PoseFound, PoseGoal, Relaxation,
    RelaxedModel, SceneChange, ValidityFunction,
};
use crate::digest::SourceFile;
use crate::seed::Seed;
use crate::source::{ProblemError, Source};
use crate::space::Space;
use std::collections::BTreeMap;
use std::path::Path;

/// The side of a model that is plain data: what a problem file says of it.
pub trait Description {
    /// The configuration space.
    fn space(&self) -> Space;

    /// What numbers every milestone of a roadmap carries; see [`Model::node_values`].
    fn node_values(&self) -> &'static [NodeValue] {
        &[]
    }

    /// The unit of what edges cost.
    fn cost_unit(&self) -> &'static str {
        "length"
    }

    /// Whether motions cost something that depends on the direction, as [`Cost::Directed`](super::Cost) says;
    /// otherwise all of them cost their lengths.
    fn has_directed_costs(&self) -> bool {
        false
    }

    /// Whether the description is one that a problem file could give: every number finite and in its range, every index
    /// that of something there. Descriptions that were read from a file are; bytes from elsewhere must show it
    /// before anything else is asked, since the other methods rely on it.
    ///
    /// # Errors
    /// The first thing that is wrong: where, what was found and what is expected.
    fn sound(&self) -> Result<(), String>;

    /// Makes the model ready for work.
    fn prepare(&self) -> Box<dyn Model>;

    /// Whether a program's own function can judge configurations beside the model: of a model of whose motions nothing is promised
    /// but that they are valid at steps.
    ///
    /// # Errors
    /// What was found that is in the way.
    fn takes_function(&self) -> Result<(), &'static str> {
        Err("another model than that of bodies found")
    }

    /// [`Description::prepare`], with a function beside the model; without it of a model that takes none.
    fn prepare_with(&self, _function: &ValidityFunction) -> Box<dyn Model> {
        self.prepare()
    }

    /// The first thing in which another description of the same kind of model differs, for people to read
    /// ("the robot"); `None` where they are equal.
    fn difference(&self, other: &ModelKind) -> Option<&'static str>;

    /// How the scene `after` differs from this one, of a model whose obstacles can come and go.
    ///
    /// # Errors
    /// Says why what was valid here says nothing of what is valid there: it is another model, or another robot.
    fn change(&self, _after: &ModelKind) -> Result<SceneChange, String> {
        Err("the model has no obstacles that come and go; a robot among obstacles expected"
            .to_owned())
    }

    /// What `check` says of it before the query: lines of a word of 16 characters and a text.
    fn describe(&self, out: &mut String);

    /// What `check` says of one end of the query, called `name`, beside its values; nothing of most models.
    fn describe_end(&self, _name: &str, _q: &[f64], _out: &mut String) {}

    /// Writes its tables as they stand in a problem file, so that what is read from them is equal to the
    /// last bit.
    fn write(&self, documents: &mut Documents);

    /// The atoms of its configurations, of a molecule.
    fn molecule(&self) -> Option<&dyn Molecule> {
        None
    }

    /// Configurations at which a part of the model is at a pose, of a model that has parts with poses. `accept` brings a
    /// configuration into stored form and says whether it counts; the seed determines where the search begins.
    ///
    /// # Errors
    /// The key of the pose that is wrong, what was found and what is expected.
    fn configurations_at(
        &self,
        goal: &PoseGoal,
        _seed: &Seed,
        _accept: &mut dyn FnMut(&mut [f64]) -> bool,
    ) -> Result<PoseFound, (&'static str, String)> {
        Err(("link", format!("`{}` found, but the model has no links; bodies expected", goal.link)))
    }

    /// The relaxation of a problem that names none, of a model that has a usual one.
    fn usual_relaxation(&self) -> Option<Relaxation> {
        None
    }

    /// The model with its constraints relaxed: an easier one of the same kind. `level` is at least 0, where it is easiest, and below 1:
    /// at 1 the model is this one. What is promised of the motions of the relaxed model is what its own description says.
    ///
    /// # Errors
    /// By which setting the model cannot be relaxed.
    fn relaxed(&self, relaxation: &Relaxation, _level: f64) -> Result<RelaxedModel, CannotRelax> {
        Err(CannotRelax::unknown(relaxation, "this model", "another model expected"))
    }

    /// How it is drawn, if it can be.
    fn figure(&self) -> Option<&dyn Figure> {
        None
    }
}

/// A problem file in the making, with the files that it names.
#[derive(Debug)]
pub struct Documents {
    /// The text so far.
    pub text: String,
    /// The folder of the other files, a path from the problem file's own folder.
    pub folder: String,
    /// The other files: name and contents.
    pub files: Vec<(String, String)>,
    /// By the digest of what a file holds: its name.
    pub(crate) names: BTreeMap<crate::digest::Digest, String>,
}

/// A problem that another program's file describes, as far as that file goes.
#[derive(Debug)]
pub struct ForeignProblem {
    /// Its name there.
    pub name: String,
    /// What is planned for.
    pub model: ModelKind,
    /// Start and goal, as they are written.
    pub query: Option<[Vec<f64>; 2]>,
    /// What was chosen where the file leaves a choice.
    pub notes: Vec<String>,
    /// The files that were read.
    pub sources: Vec<SourceFile>,
}

/// How a description comes from what a problem asks for.
pub(crate) trait Resolve: Sized {
    /// What a problem asks for, before anything is checked: the tables of a problem file, or what a program gives
    /// instead.
    type Spec;

    /// The keys of the tables of the file that describe the model, first the one that it cannot do without. A model that
    /// takes in the tables of another has a first table that no other model has.
    const TABLES: &'static [&'static str];

    /// Reads these tables.
    fn spec(source: &Source) -> Result<Self::Spec, ProblemError>;

    /// Checks what is asked for. `notes` gets what was chosen where that leaves a choice.
    fn resolve(
        spec: &Self::Spec,
        source: &Source,
        notes: &mut Vec<String>,
    ) -> Result<Self, ProblemError>;

    /// What asks for this description.
    fn to_spec(&self) -> Self::Spec;
}

/// Reads the file of another program, told apart by its extension; `None` for any other file.
pub(crate) fn import(
    path: &Path,
    options: &SceneOptions,
) -> Option<Result<ForeignProblem, ProblemError>> {
    super::bodies::import(path, options)
}
