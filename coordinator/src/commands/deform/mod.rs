//! Deforms the robot of a run along a path of its roadmap, or along a path that is given.

mod place;
mod summary;
mod timed;

use super::query::ends;
use crate::cli::{DeformArguments, DeformBy};
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::files::{is_standard_output, write_out, write_whole};
use crate::output::{note, told};
use crate::signals::Signals;
use crate::waiting::waiting;
use crate::work::{Recorded, Run, bounded};
use place::Places;
use roadmill::deformation::{
    DeformableRobot, DeformedPath, DeformingAnswer, NoDeformedPath, PreparedRobot, deform_path,
    deform_query,
};
use roadmill::export::{
    DeformedPage, deformed_page, energies_csv, frame_name, frame_obj, obstacles_obj,
};
use roadmill::model::deformable::{
    BoundingBoxSettings, Deformable, DeformationMethod, DeformationSettings, GeometricSpec,
    MethodSpec,
};
use roadmill::model::{ModelKind, Scratch};
use roadmill::problem::read_path;
use roadmill::scene::read_mesh;
use roadmill::space::Configs;
use roadmill::{Cancel, Ends};
use summary::{Seconds, summary};
use timed::Timed;

/// Deforms the robot of a run along a path, says what that came to, and writes it.
pub fn deform(arguments: &DeformArguments) -> Result<Code, Failure> {
    let places = Places::of(arguments)?;
    let run = Run::at(&arguments.run).read()?;
    match run.stopped() {
        None => note("the build has not ended; its complete rounds are searched"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let ModelKind::Deformable(description) = run.problem().model() else {
        let message = "a run of another model found; one of a deformable robot expected, whose problem has the table [deformable]";
        return Err(Failure::usage(message));
    };
    let description = described(arguments, description)?;
    let settings = settings(arguments, &description);
    let method = match &settings.method {
        DeformationMethod::BoundingBox(_) => "bounding-box",
        DeformationMethod::Geometric(_) => "geometric",
    };
    let robot = PreparedRobot::new(&description, settings).map_err(Failure::usage)?;
    let way = Way::of(arguments, &run)?;
    // Until here a signal ends the process at once, as nothing is found yet.
    let signals = Signals::listen().map_err(Failure::system)?;
    let clock = CpuClock::start();
    let timed = Timed::new(robot.robot().method);
    let asked = DeformableRobot { method: &timed, ..robot.robot() };
    let work = |cancel: &Cancel| way.deformed(&run, asked, cancel);
    let deforming = || bounded(|| signals.came(), arguments.max_time, work);
    let answer = waiting("deforming", deforming)?;
    let seconds = Seconds { all: clock.own_seconds(), deforming: timed.seconds() };
    let facts = summary(&answer, method, (way.is_given(), seconds));
    let is_beside_data = arguments.csv.as_deref().is_some_and(is_standard_output);
    for (term, text) in &facts {
        told(format_args!("{term:<16} {text}"), is_beside_data);
    }
    let path = match &answer.path {
        Ok(path) => path,
        Err(no) => return Err(failure(*no, signals.came(), way.is_given())),
    };
    if let Way::Between(ends) = &way
        && let Some(number) =
            ends.goal_number(path.frames.iter().map(|frame| &frame.configuration[..]))
    {
        told(format_args!("{:<16} {number} of {}", "goal", ends.goals().count()), is_beside_data);
    }
    let given = Given { run: &run, description: &description, robot: &robot, path };
    given.write(arguments, &places, &facts)?;
    Ok(Code::Done)
}

/// The description by which the robot is deformed: the run's, or, with `--robot`, the same with another robot.
fn described(arguments: &DeformArguments, description: &Deformable) -> Result<Deformable, Failure> {
    let Some(file) = &arguments.robot else { return Ok(description.clone()) };
    let mesh = read_mesh(file, 1.0).map_err(Failure::usage)?;
    let other = description.with_robot(&mesh);
    other.map_err(|message| Failure::usage(format!("{}: {message}", file.display())))
}

/// The problem's settings, with those of the command line in their place.
fn settings(arguments: &DeformArguments, description: &Deformable) -> DeformationSettings {
    let own = description.deformation();
    let asked = match (arguments.method, &own.method) {
        (Some(DeformBy::BoundingBox), DeformationMethod::Geometric(_)) => {
            Some(MethodSpec::BoundingBox(BoundingBoxSettings::default()))
        }
        (Some(DeformBy::Geometric), DeformationMethod::BoundingBox(_)) => {
            Some(MethodSpec::Geometric(GeometricSpec::default()))
        }
        _ => None,
    };
    DeformationSettings {
        method: asked.map_or_else(|| own.method.clone(), |asked| description.method(&asked)),
        highest_energy: arguments.highest_energy.unwrap_or(own.highest_energy),
        clearance: arguments.clearance.unwrap_or(own.clearance),
        step: arguments.step.unwrap_or(own.step),
    }
}

/// The way that the robot is to go.
enum Way {
    /// A path of the roadmap, which is looked for.
    Between(Ends),
    /// A path that is given.
    Given(Configs),
}

impl Way {
    fn of(arguments: &DeformArguments, run: &Recorded) -> Result<Way, Failure> {
        match &arguments.path {
            Some(file) => {
                let configs = read_path(run.context(), file).map_err(Failure::usage)?;
                let space = run.context().space();
                // Bounds that hold the whole robot keep its shapes in only where its reference point is within them.
                let outside =
                    (0..configs.len()).find(|index| !space.within_bounds(configs.get(*index)));
                match outside {
                    None => Ok(Way::Given(configs)),
                    Some(index) => Err(Failure::usage(format!(
                        "{}: configuration {} is beyond the bounds of the space; configurations within them expected",
                        file.display(),
                        index + 1
                    ))),
                }
            }
            None => ends(run, &arguments.start, &arguments.goal).map(Way::Between),
        }
    }

    fn is_given(&self) -> bool {
        matches!(self, Way::Given(_))
    }

    fn deformed(&self, run: &Recorded, robot: DeformableRobot, cancel: &Cancel) -> DeformingAnswer {
        let ends = match self {
            Way::Between(ends) => ends,
            Way::Given(configs) => return deform_path(configs, robot, cancel),
        };
        let (attachment, scratch) = (run.problem().attachment(), &mut Scratch::new());
        deform_query(run.context(), run.roadmap(), ends, &attachment, robot, cancel, scratch)
    }
}

fn failure(no: NoDeformedPath, signal_came: bool, is_given: bool) -> Failure {
    match (no, signal_came) {
        (NoDeformedPath::Cancelled, true) => {
            Failure::new(Code::Interrupted, "no path: a signal came before one was found")
        }
        (NoDeformedPath::Cancelled, false) => {
            Failure::new(Code::NoSuccess, "no path: the time was up before one was found")
        }
        (NoDeformedPath::Refused, _) if is_given => {
            let message = "no path: the robot cannot be deformed along a leg of the path";
            Failure::new(Code::NoSuccess, message)
        }
        (why, _) => Failure::new(Code::NoSuccess, format!("no path: {why}")),
    }
}

/// A path that was found, with what is needed to write it.
struct Given<'a> {
    run: &'a Recorded,
    description: &'a Deformable,
    robot: &'a PreparedRobot,
    path: &'a DeformedPath,
}

impl Given<'_> {
    /// Writes the path in every form that the command line asks for.
    fn write(
        &self,
        arguments: &DeformArguments,
        places: &Places,
        facts: &[(&'static str, String)],
    ) -> Result<(), Failure> {
        let Given { run, description, robot, path } = *self;
        let obstacles = description.bodies().obstacles();
        if let Some(file) = &arguments.csv {
            write_out(file, energies_csv(run.context().space(), path))?;
        }
        if let Some(folder) = &arguments.obj {
            places.empty_folder(folder)?;
            write_whole(&folder.join(place::OBSTACLES), obstacles_obj(obstacles))?;
            for (index, frame) in path.frames.iter().enumerate() {
                let name = frame_name(index, path.frames.len());
                write_whole(&folder.join(name), frame_obj(robot.body(), frame))?;
            }
        }
        if let Some(file) = &arguments.html {
            let title = run.problem().name();
            let body = robot.body();
            // The page tells of the path itself, and is the same however long the search took.
            let facts: Vec<_> = facts
                .iter()
                .filter(|(term, _)| !summary::LEFT_OUT.contains(term))
                .cloned()
                .collect();
            let page = DeformedPage { title, facts: &facts, body, obstacles, path };
            write_whole(file, deformed_page(&page))?;
        }
        Ok(())
    }
}
