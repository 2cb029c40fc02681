use crate::cli::WorkerArguments;
use crate::exit::{Code, Failure};
use roadmill_workers::WorkerError;
use roadmill_workers::channel::{ChannelError, WorkerId, private_umask};

/// Runs a worker process.
pub fn worker(arguments: &WorkerArguments) -> Result<Code, Failure> {
    private_umask();
    let arguments = roadmill_workers::WorkerArguments {
        directory: arguments.channel.clone(),
        worker: WorkerId(arguments.worker),
        coordinator: arguments.coordinator,
    };
    match roadmill_workers::run(&arguments) {
        Ok(never) => match never {},
        // The run is over; a worker that notices first has nothing to complain of.
        Err(
            WorkerError::Orphaned
            | WorkerError::Channel(ChannelError::HubGone | ChannelError::Abandoned),
        ) => Ok(Code::Done),
        Err(error) => Err(Failure::system(format!("worker {}: {error}", arguments.worker))),
    }
}
