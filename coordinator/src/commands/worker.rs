use crate::cli::WorkerArguments;
use crate::exit::{Code, Failure};
use roadmill_workers::WorkerId;
use roadmill_workers::channel::private_umask;

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
        Err(error) if error.is_end() => Ok(Code::Done),
        Err(error) => Err(Failure::system(format!("worker {}: {error}", arguments.worker))),
    }
}
