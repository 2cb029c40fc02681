use super::solved::run_in;
use crate::cli::{FormationArguments, OrdersArguments};
use crate::exit::{Code, Failure};
use crate::files::{make_empty, write_whole};
use crate::output::{line, note};
use crate::signals::Signals;
use crate::work::{Recorded, Run, bounded};
use roadmill::Cancel;
use roadmill::evaluate::{EvaluatorKind, FormationOrder};
use roadmill::folding::{Formation, Native, Settings};
use roadmill::model::{ModelKind, Scratch};
use std::fmt::Write;
use std::path::Path;

/// So many of the most frequent orders are printed.
const PRINTED: usize = 10;

/// Says in which order the parts of a protein's native structure form, over all pathways of a run's roadmap.
pub fn orders(arguments: &OrdersArguments) -> Result<Code, Failure> {
    let run = Run::at(run_in(&arguments.run)?).read()?;
    let (native, settings) = (native(&run)?, settings(&run, &arguments.formation));
    if let Some(folder) = &arguments.out {
        make_empty(folder)?;
    }
    // Nothing ends it but a signal, which ends the process.
    let formation = formation(&run, &native, &settings, &Cancel::new());
    let formation = formation.expect("nothing ends it before it is done");
    print(&run, &native, &settings, &formation);
    if formation.pathways == 0 {
        let message = "no pathway: no route joins an unstructured conformation to the native one";
        return Err(Failure::new(Code::NoSuccess, message.to_owned()));
    }
    if let Some(folder) = &arguments.out {
        write(&native, &formation, folder)?;
    }
    Ok(Code::Done)
}

/// The native structure of the run's model.
///
/// # Errors
/// Exit code 2: the run's model has no helices and no strands.
pub(super) fn native(run: &Recorded) -> Result<Native, Failure> {
    native_of(run).ok_or_else(|| {
        let message = "this run's model has no native structure with helices or strands; that of a protein expected";
        Failure::usage(message)
    })
}

/// The native structure of the run's model, if it has one with helices or strands.
pub(super) fn native_of(run: &Recorded) -> Option<Native> {
    let native = Native::of(run.context().model(), &mut Scratch::new());
    native.filter(|native| !native.parts.is_empty())
}

/// How the parts of a run's native structure form by the run's own criterion.
pub(super) struct OwnFormation {
    pub native: Native,
    pub settings: Settings,
    /// `None` where a signal or the time ended it before all pathways were followed.
    pub formation: Option<Formation>,
}

impl OwnFormation {
    /// Follows all pathways of a run about a native structure, no longer than `max_time`, in seconds, and until a signal comes.
    ///
    /// # Errors
    /// Exit code 1: the system refuses a thread.
    pub fn of(
        run: &Recorded,
        native: Native,
        signals: &Signals,
        max_time: Option<f64>,
    ) -> Result<OwnFormation, Failure> {
        let settings = settings(run, &FormationArguments::default());
        let follow = |cancel: &Cancel| formation(run, &native, &settings, cancel);
        let formation = bounded(|| signals.came(), max_time, follow)?;
        Ok(OwnFormation { native, settings, formation })
    }

    /// Prints the orders; nothing where there are none yet.
    pub fn print(&self, run: &Recorded) {
        if let OwnFormation { native, settings, formation: Some(formation) } = self {
            print(run, native, settings, formation);
        }
    }
}

/// What is asked for, or else what the run's criterion has.
fn settings(run: &Recorded, asked: &FormationArguments) -> Settings {
    let of_run = criterion(run.problem().evaluators());
    let usual = of_run.unwrap_or_default();
    Settings {
        formed: asked.formed.unwrap_or(usual.formed),
        unstructured: asked.unstructured.unwrap_or(usual.unstructured),
    }
}

/// The settings of the first criterion of this kind, be it a part of another.
fn criterion(evaluators: &[EvaluatorKind]) -> Option<Settings> {
    evaluators.iter().find_map(|evaluator| match evaluator {
        EvaluatorKind::FormationOrder(order) => Some(FormationOrder::settings(order)),
        other => criterion(other.method().parts()),
    })
}

fn formation(
    run: &Recorded,
    native: &Native,
    settings: &Settings,
    cancel: &Cancel,
) -> Option<Formation> {
    let (cx, attachment) = (run.context(), run.problem().attachment());
    let scratch = &mut Scratch::new();
    Formation::of(cx, run.roadmap(), native, settings, &attachment, cancel, scratch)
}

fn print(run: &Recorded, native: &Native, settings: &Settings, formation: &Formation) {
    let has_target =
        matches!(run.problem().model(), ModelKind::Protein(protein) if protein.target().is_some());
    if has_target {
        line(
            "the native conformation is the source structure; the contacts of the target play no part",
        );
    }
    line(format_args!(
        "{} pathways to the native conformation, through {} nodes, from conformations with at most {} of {} native contacts",
        formation.pathways,
        run.roadmap().configs().len(),
        settings.unstructured,
        native.contacts.len()
    ));
    line(format_args!(
        "a part is formed when {} of its contacts are there and stay",
        settings.formed_percent()
    ));
    if formation.pathways == 0 {
        return;
    }
    line("part         contacts  formed at a share of all native contacts of");
    for (part, at) in native.parts.iter().zip(&formation.at) {
        let name = pad(&part.name, 12);
        line(format_args!("{name}{:>9}  {at:.3}", part.contacts.len()));
    }
    for (title, orders) in [
        ("share  order of the helices and strands", &formation.elements),
        ("share  order of the pairings", &formation.pairings),
    ] {
        if orders.is_empty() || orders[0].groups.is_empty() {
            continue;
        }
        line(title);
        for order in orders.iter().take(PRINTED) {
            let share = order.pathways as f64 / formation.pathways as f64;
            line(format_args!("{share:.3}  {}", order.in_words(native)));
        }
        if orders.len() > PRINTED {
            note(format_args!("{} further orders; --out writes all", orders.len() - PRINTED));
        }
    }
}

/// A text with blanks behind it, by its letters, which have one column each.
fn pad(text: &str, width: usize) -> String {
    let blanks = width.saturating_sub(text.chars().count());
    text.to_owned() + &" ".repeat(blanks)
}

/// Writes `orders.csv`, `parts.csv`, `precedence.csv` and `contacts.csv`.
fn write(native: &Native, formation: &Formation, folder: &Path) -> Result<(), Failure> {
    let mut orders = "of,order,pathways,share\n".to_owned();
    let all = (formation.elements.iter().map(|order| ("elements", order)))
        .chain(formation.pairings.iter().map(|order| ("pairings", order)));
    for (of, order) in all {
        let share = order.pathways as f64 / formation.pathways as f64;
        writeln!(orders, "{of},{},{},{share}", order.in_words(native), order.pathways)
            .expect("writing to memory cannot fail");
    }
    let mut parts = "part,contacts,formed_at\n".to_owned();
    for (part, at) in native.parts.iter().zip(&formation.at) {
        writeln!(parts, "{},{},{at}", part.name, part.contacts.len())
            .expect("writing to memory cannot fail");
    }
    let mut precedence = "first,second,share\n".to_owned();
    for (a, first) in native.parts.iter().enumerate() {
        for (b, second) in native.parts.iter().enumerate().filter(|(b, _)| *b != a) {
            let share = formation.precedence.share(a, b);
            writeln!(precedence, "{},{},{share}", first.name, second.name)
                .expect("writing to memory cannot fail");
        }
    }
    let mut contacts = "first,second,formed_at\n".to_owned();
    for ((a, b), at) in native.contacts.iter().zip(&formation.contacts) {
        writeln!(contacts, "{},{},{at}", a + 1, b + 1).expect("writing to memory cannot fail");
    }
    write_whole(&folder.join("orders.csv"), orders)?;
    write_whole(&folder.join("parts.csv"), parts)?;
    write_whole(&folder.join("precedence.csv"), precedence)?;
    write_whole(&folder.join("contacts.csv"), contacts)
}
