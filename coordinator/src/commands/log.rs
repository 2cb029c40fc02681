use crate::cli::LogArguments;
use crate::exit::{Code, Failure};
use crate::output::{self, Word};
use crate::run::{Replay, Scan, Told};
use roadmill::img::Joined;
use roadmill::internal::wire;
use roadmill::numbers::{Ordinal, RoundNumber, SetNumber};
use roadmill::roadmap::{Digest, Full, Increment};
use roadmill::seed::Seed;
use serde::Serialize;
use std::fmt;

/// A set in the list.
#[derive(Serialize)]
struct SetLine<'a> {
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
    if !arguments.json {
        output::line("round number set seed nodes edges joining configurations motions digest");
    }
    while let Some(told) = replay.read()? {
        let Told::Round(round, _) = told else { continue };
        for set in &round.sets {
            let (increment, joined) = (&set.increment, &set.joined);
            let label = problem.strategies()[set.strategy.index()].label();
            let line = SetLine {
                number: set.number,
                round: round.number,
                label,
                ordinal: set.ordinal,
                seed: Seed::of_set(problem.seed(), label, set.ordinal).to_string(),
                nodes: increment.configs.len(),
                edges: increment.edges.len() + increment.root_edges.len(),
                joining_edges: joined.edges.len(),
                configurations_checked: increment
                    .asked
                    .configurations
                    .saturating_add(joined.asked.configurations),
                motions_checked: increment.asked.motions.saturating_add(joined.asked.motions),
                digest: digest_of(increment, joined).to_string(),
            };
            let is_read = if arguments.json { output::json(&line) } else { output::line(&line) };
            if !is_read {
                return Ok(Code::Done);
            }
        }
    }
    Ok(Code::Done)
}

impl fmt::Display for SetLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} {} {}:{} {} {} {} {} {} {} {}",
            self.round,
            self.number,
            Word(self.label),
            self.ordinal,
            &self.seed[..16],
            self.nodes,
            self.edges,
            self.joining_edges,
            self.configurations_checked,
            self.motions_checked,
            &self.digest[..16],
        )
    }
}
