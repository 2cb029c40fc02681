use super::crew::workers;
use crate::cli::VerifyArguments;
use crate::exit::{Code, Failure};
use crate::output::line;
use crate::signals::Signals;
use crate::work::relaxing::is_relaxation;
use crate::work::{Run, Selection};
use std::sync::Arc;

/// Recomputes sets from their seeds and compares them with the ledger.
pub fn verify(arguments: &VerifyArguments) -> Result<Code, Failure> {
    let selection = match (arguments.all, &arguments.sets[..], arguments.sample) {
        (true, ..) => Selection::All,
        (false, [_, ..], _) => Selection::Sets(arguments.sets.clone()),
        (false, [], Some(share)) => Selection::Share(share),
        (false, [], None) => Selection::default(),
    };
    if is_relaxation(&arguments.run) {
        return super::relax::verify(arguments, selection);
    }
    let workers = workers(&arguments.crew)?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let run = Run::at(&arguments.run);
    let mut verification = run.verify(selection).workers(&workers).signals(&signals);
    if let Some(parent) = &arguments.parent {
        verification = verification.parent(parent);
    }
    let verified = verification.check()?;
    line(format_args!(
        "{} of {} sets and {} judgements recomputed: all as recorded",
        verified.sets, verified.sets_recorded, verified.judgements
    ));
    if let without @ 1.. = verified.judgements_without_direct_motion {
        line(format_args!(
            "{without} of these judgements are by an earlier version, which looked for paths through the roadmap only; \
             this one also tries the direct motion between a query's ends"
        ));
    }
    if let Some(digest) = verified.digest {
        line(format_args!("digest {digest}"));
    }
    Ok(Code::Done)
}
