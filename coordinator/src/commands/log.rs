use crate::cli::LogArguments;
use crate::exit::{Code, Failure};
use crate::progress::print_json;
use crate::run::{Replay, Scan, Told};
use roadmill::img::Joined;
use roadmill::internal::wire;
use roadmill::numbers::{Ordinal, RoundNumber, SetNumber};
use roadmill::roadmap::{Digest, Full, Increment};
use roadmill::seed::Seed;
use serde::Serialize;
use std::io::Write;

/// A set in the list.
#[derive(Serialize)]
struct Line<'a> {
    number: SetNumber,
    round: RoundNumber,
    label: &'a str,
    ordinal: Ordinal,
    seed: String,
    nodes: usize,
    edges: usize,
    joining_edges: usize,
    configurations_checked: u64,
    motions_checked: u64,
    digest: String,
}

/// The digest of a set: of its record's bytes from the degrees of freedom on.
fn digest_of(increment: &Increment, joined: &Joined) -> Digest {
    if increment.is_plain() && joined.is_plain() {
        Digest::of(&wire::encode(&(increment, joined)))
    } else {
        Digest::of(&wire::encode(&(Full(increment), Full(joined))))
    }
}

/// Lists a build set by set.
pub fn log(arguments: &LogArguments) -> Result<Code, Failure> {
    let scan = Scan::read(&arguments.run)?;
    let problem = scan.problem()?;
    let mut replay = Replay::new(&scan, &problem)?;
    let mut out = std::io::stdout().lock();
    if !arguments.json {
        let heading = "round number set seed nodes edges joining configurations motions digest";
        let _ = writeln!(out, "{heading}");
    }
    while let Some(told) = replay.read()? {
        let Told::Round(round, _) = told else { continue };
        for set in &round.sets {
            let (increment, joined) = (&set.increment, &set.joined);
            let label = problem.strategies()[set.strategy.index()].label();
            let line = Line {
                number: set.number,
                round: round.number,
                label,
                ordinal: set.ordinal,
                seed: Seed::of_set(problem.seed(), label, set.ordinal).to_string(),
                nodes: increment.configs.len(),
                edges: increment.edges.len() + increment.root_edges.len(),
                joining_edges: joined.edges.len(),
                configurations_checked: increment.asked.configurations
                    + joined.asked.configurations,
                motions_checked: increment.asked.motions + joined.asked.motions,
                digest: digest_of(increment, joined).to_string(),
            };
            if arguments.json {
                print_json(&line);
                continue;
            }
            let written = writeln!(
                out,
                "{} {} {label}:{} {} {} {} {} {} {} {}",
                line.round,
                line.number,
                line.ordinal,
                &line.seed[..16],
                line.nodes,
                line.edges,
                line.joining_edges,
                line.configurations_checked,
                line.motions_checked,
                &line.digest[..16],
            );
            if written.is_err() {
                // Whoever closes the pipe has read enough.
                return Ok(Code::Done);
            }
        }
    }
    Ok(Code::Done)
}
