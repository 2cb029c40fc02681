//! One run: a roadmap is built, and the robot is deformed along a path of it, by the clock.

use super::scenes::{Scene, Ways};
use super::timing::cpu_seconds;
use roadmill::Cancel;
use roadmill::Context;
use roadmill::deformation::{
    Deform, DeformableRobot, Deformed, DeformingAnswer, PreparedRobot, Refusal, deform_path,
    deform_query,
};
use roadmill::img::{Setup, build};
use roadmill::model::deformable::Deformable;
use roadmill::model::{ModelKind, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::query::Attachment;
use roadmill::roadmap::{Configs, Roadmap};
use roadmill::sampler::SamplerKind;
use roadmill::scene::{Body, Pose};
use roadmill::seed::Seed;
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;

/// A roadmap of a scene.
pub struct Built {
    pub problem: Problem,
    pub setup: Arc<Setup>,
    pub roadmap: Roadmap,
    /// CPU seconds: of drawing the milestones, and of joining them.
    pub seconds: [f64; 2],
}

/// What a query came to.
pub struct Outcome {
    pub answer: DeformingAnswer,
    /// CPU seconds of the query.
    pub seconds: f64,
    /// Of these, of deforming.
    pub deforming: f64,
    /// CPU seconds of every deformation that found a shape other than that at rest.
    pub deformed: Vec<f64>,
}

/// Builds the roadmap of a scene that is written to a folder.
pub fn built(scene: &Scene, folder: &Path, ways: &Ways, seed: u64) -> Built {
    let problem = Problem::load(&scene.write(folder, ways));
    let problem = problem.unwrap_or_else(|error| panic!("{error}")).with_seed(seed);
    let setup = Arc::new(Setup::new(problem.clone()));
    // The milestones alone are drawn once more, from the seed of the build's one set.
    let sampler: SamplerKind = toml::from_str(scene.sampler).expect("a sampler");
    let mut configs = Configs::new(setup.context().space().len());
    let begun = cpu_seconds();
    let done = sampler.method().sample(
        setup.context(),
        &Seed::of_set(seed, "all", Ordinal(0)),
        ways.nodes,
        &mut Scratch::new(),
        &mut configs,
    );
    done.unwrap_or_else(|error| panic!("{error}"));
    let drawn = cpu_seconds();
    let grown = build(&setup);
    let all = cpu_seconds() - drawn;
    let generation = drawn - begun;
    let seconds = [generation, (all - generation).max(0.0)];
    Built { problem, setup, roadmap: grown.roadmap, seconds }
}

/// The description of a problem's deformable robot.
pub fn deformable(problem: &Problem) -> &Deformable {
    let ModelKind::Deformable(deformable) = problem.model() else {
        panic!("a deformable robot expected")
    };
    deformable
}

/// The obstacles of a problem.
pub fn obstacles(problem: &Problem) -> &[Body] {
    deformable(problem).bodies().obstacles()
}

/// The robot of a problem, ready to be deformed.
pub fn prepared(problem: &Problem) -> PreparedRobot {
    let deformable = deformable(problem);
    let made = PreparedRobot::new(deformable, deformable.deformation().clone());
    made.unwrap_or_else(|error| panic!("{error}"))
}

/// Answers the problem's query, until deforming has taken `limit` CPU seconds.
pub fn query(built: &Built, limit: f64) -> Outcome {
    timed(&prepared(&built.problem), limit, &|robot, cancel| {
        let (cx, ends): (&Context, _) = (built.setup.context(), built.problem.query());
        let ends = ends.expect("scenes have a query");
        let (attachment, scratch) = (Attachment::default(), &mut Scratch::new());
        deform_query(cx, &built.roadmap, ends, &attachment, robot, cancel, scratch)
    })
}

/// Deforms the robot of a problem along a path that was found for another.
pub fn along(problem: &Problem, path: &Configs, limit: f64) -> Outcome {
    timed(&prepared(problem), limit, &|robot, cancel| deform_path(path, robot, cancel))
}

/// What a query came to, with the times of its deformations.
fn timed(
    prepared: &PreparedRobot,
    limit: f64,
    ask: &dyn Fn(DeformableRobot, &Cancel) -> DeformingAnswer,
) -> Outcome {
    let cancel = Cancel::new();
    let times = RefCell::default();
    let robot = prepared.robot();
    let method = Timed {
        inner: robot.method,
        rest: prepared.body().vertices(),
        limit,
        cancel: &cancel,
        times: &times,
    };
    let begun = cpu_seconds();
    let answer = ask(DeformableRobot { method: &method, ..robot }, &cancel);
    let seconds = cpu_seconds() - begun;
    let Times { all, deformed } = times.into_inner();
    Outcome { answer, seconds, deforming: all, deformed }
}

/// CPU seconds.
#[derive(Default)]
struct Times {
    all: f64,
    deformed: Vec<f64>,
}

/// A method of deformation under the clock.
struct Timed<'a> {
    inner: &'a dyn Deform,
    rest: &'a [[f64; 3]],
    limit: f64,
    cancel: &'a Cancel,
    times: &'a RefCell<Times>,
}

impl Deform for Timed<'_> {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        let begun = cpu_seconds();
        let found = self.inner.deform(pose);
        let took = cpu_seconds() - begun;
        let mut times = self.times.borrow_mut();
        times.all += took;
        if found.as_ref().is_ok_and(|shape| shape.vertices != self.rest) {
            times.deformed.push(took);
        }
        if times.all > self.limit {
            self.cancel.cancel();
        }
        found
    }

    fn accepts_blend(&self, pose: &Pose, vertices: &[[f64; 3]]) -> bool {
        self.inner.accepts_blend(pose, vertices)
    }
}
