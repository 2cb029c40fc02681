use super::crew::DRAWS;
use super::load::load;
use super::place::check_place;
use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};
use crate::files::{is_standard_output, write_out};
use crate::output::{json, line, lines, told};
use crate::waiting::waiting;
use roadmill::export::svg_at;
use roadmill::model::{NodeValue, Reason, Scratch};
use roadmill::problem::{Problem, configuration_at_all};
use roadmill::survey::Survey;
use serde::Serialize;
use std::collections::BTreeMap;

/// Says what is wrong with a problem, or what it would build; or of one configuration why it is not valid.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    if let Some(text) = &arguments.at {
        return check_at(&problem, text, arguments);
    }
    if let Some(samples) = arguments.touching {
        let Some(bodies) = problem.model().bodies() else {
            return Err(Failure::usage(
                "--touching found; a robot of links without the table [deformable] expected",
            ));
        };
        lines(bodies.may_touch_lines(samples, problem.seed()).trim_end());
        return Ok(Code::Done);
    }
    lines(problem.describe().trim_end());
    let survey = waiting("drawing configurations", || Survey::new(&problem.context(), DRAWS));
    line(format_args!("draws            {survey}"));
    if let Some(advice) = survey.advice() {
        line(format_args!("                 {advice}"));
    }
    Ok(Code::Done)
}

/// What is said of one configuration.
#[derive(Serialize)]
struct Answer {
    configuration: Vec<f64>,
    valid: bool,
    reasons: Vec<Reason>,
    /// What a node there would carry, by its names, of a valid configuration of a model whose nodes have values.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    values: BTreeMap<&'static str, f64>,
}

fn check_at(problem: &Problem, text: &str, arguments: &CheckArguments) -> Result<Code, Failure> {
    if let Some(file) = &arguments.picture {
        check_place("--picture", file)?;
        if arguments.json && is_standard_output(file) {
            return Err(Failure::usage(
                "--picture: - found beside --json; the name of a file expected",
            ));
        }
    }
    let cx = problem.context();
    let q = configuration_at_all(&cx, text);
    let q = q.map_err(|error| Failure::usage(format!("--at: {error}")))?;
    let reasons = cx.model().reasons(&q, true);
    if let Some(file) = &arguments.picture {
        let caption = match reasons.as_slice() {
            [] => "valid".to_owned(),
            [reason] => reason.to_string(),
            [reason, more @ ..] => format!("{reason}; and {} more", more.len()),
        };
        let picture = svg_at(problem, &q, &caption);
        let refused = || Failure::usage("--picture: this model cannot be drawn");
        write_out(file, picture.ok_or_else(refused)?)?;
    }
    let valid = reasons.is_empty();
    let named = cx.model().node_values();
    let mut numbers = Vec::new();
    if valid && !named.is_empty() {
        cx.model().values(&q, &mut numbers, &mut Scratch::new());
    }
    if arguments.json {
        let values = named.iter().map(|value| value.name).zip(numbers).collect();
        json(&Answer { configuration: q, valid, reasons, values });
    } else {
        // Standard output is for the picture alone where it goes there.
        let is_taken = arguments.picture.as_deref().is_some_and(is_standard_output);
        if valid {
            told("valid", is_taken);
        }
        for (NodeValue { name, unit }, number) in named.iter().zip(numbers) {
            let unit = if *unit == "1" { String::new() } else { format!(" {unit}") };
            told(format_args!("{name:<16} {number}{unit}"), is_taken);
        }
        reasons.iter().for_each(|reason| told(reason, is_taken));
    }
    Ok(if valid { Code::Done } else { Code::NoSuccess })
}
