//! A worker's loop, whatever line it has to its coordinator.

use crate::desk::Desk;
use crate::error::WorkerError;
use crate::faults::{Faults, Slip};
use crate::line::{Line, SharedData};
use crate::message::{FromWorker, PROTOCOL, ToWorker};
use roadmill::img::{Outcome, Replica, Setup, Task};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::numbers::{Ordinal, StrategyIndex};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Roadmap};
use std::convert::Infallible;
use std::sync::Arc;

/// Works for the coordinator at the other end of `line` until it is gone. `build` says which program this
/// is: see [`build_id`](crate::build_id).
///
/// # Errors
/// Whatever ends the worker; that the build is over is one of the reasons ([`WorkerError::is_end`]).
pub fn serve(
    line: &mut impl Line,
    shared: &impl SharedData,
    build: Digest,
) -> Result<Infallible, WorkerError> {
    serve_with_faults(line, shared, build, &Faults::none())
}

/// The same with faults that a test asked for.
pub(crate) fn serve_with_faults(
    line: &mut impl Line,
    shared: &impl SharedData,
    build: Digest,
    faults: &Faults,
) -> Result<Infallible, WorkerError> {
    let hello = FromWorker::Hello { protocol: PROTOCOL, build };
    let problem = match wire::decode(&line.call(&wire::encode(&hello))?)? {
        ToWorker::Problem(problem) => problem,
        ToWorker::Refused(reason) => return Err(WorkerError::Refused(reason)),
        ToWorker::Work { .. } => return Err(WorkerError::Turn("work")),
    };
    let setup = Setup::new(*problem);
    let replica = match shared.shelf() {
        Some(shelf) => Replica::of_worker(&setup, shelf),
        None => Replica::new(&setup),
    };
    let mut desk = Desk::new(&setup, shared, faults, replica);
    let ready = FromWorker::Ready { canary: canary(&setup) };
    line.send(&wire::encode(&ready))?;
    loop {
        let reply = match (line.is_awaiting(), desk.has_jobs()) {
            (false, _) => None,
            (true, false) => Some(line.receive()?),
            (true, true) => line.try_receive()?,
        };
        if let Some(reply) = reply {
            desk.take(&reply)?;
        }
        if desk.is_to_tell() && !line.is_awaiting() {
            let (message, slip) = desk.tell();
            match slip {
                None => line.send(&message)?,
                Some(Slip::Instead(rubbish)) => line.send(&rubbish)?,
                Some(Slip::Twice) => {
                    line.call(&message)?;
                    line.send(&message)?;
                }
            }
        }
        if desk.is_to_wake() {
            line.nudge();
        }
        desk.work()?;
    }
}

/// Digest of a small increment that no build contains: processes in which it differs must not
/// work on one roadmap.
pub fn canary(setup: &Setup) -> Digest {
    let mut problem: Problem = setup.problem.clone();
    for strategy in &mut problem.strategies {
        strategy.nodes = strategy.nodes.min(4);
    }
    let small = Setup { problem, cx: setup.problem.context(), plan: setup.plan.clone() };
    let strategy = StrategyIndex(0);
    // A strategy that grows finds no node to grow from.
    let frozen = setup.grows(strategy).then(|| Arc::new(Roadmap::new(&setup.cx.space)));
    let task = Task::Generate { strategy, ordinal: Ordinal(u64::MAX), frozen };
    let outcome: Outcome = task.run(&small, &mut Scratch::new());
    Digest::of(&wire::encode(&outcome))
}
