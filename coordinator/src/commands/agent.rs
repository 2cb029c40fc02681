use super::crew;
use crate::agent::{Served, serve};
use crate::cli::AgentArguments;
use crate::exit::{Code, Failure};
use crate::signals::Signals;
use roadmill_workers::channel::private_umask;
use std::io::{IsTerminal, stdin, stdout};
use std::os::fd::AsFd;

/// Works for a coordinator at the other end of standard input and output.
pub fn agent(arguments: &AgentArguments) -> Result<Code, Failure> {
    let workers = crew::checked("--workers", arguments.workers)?;
    // Standard output may be one: `srun -u` makes it so.
    if stdin().is_terminal() {
        return Err(Failure::usage(
            "a terminal as standard input found, a coordinator at its other end expected: \
             `roadmill build --agents` starts agents",
        ));
    }
    private_umask();
    let signals = Signals::listen().map_err(Failure::system)?;
    let files =
        || Ok((stdin().as_fd().try_clone_to_owned()?, stdout().as_fd().try_clone_to_owned()?));
    let (reader, writer) = files().map_err(|error: std::io::Error| Failure::system(error))?;
    // What is printed goes nowhere: standard output is the link's.
    match serve(reader, writer, workers, &signals).map_err(Failure::system)? {
        Served::Closed => Ok(Code::Done),
        Served::Cut(why) => Err(Failure::system(format!("the link to the coordinator: {why}"))),
        Served::Refused(why) => Err(Failure::usage(why)),
        Served::Signalled => Err(Failure::new(Code::Interrupted, "a signal came")),
        Served::Failed(why) => Err(Failure::new(Code::WorkersLost, why)),
    }
}
