//! `roadmill`: the coordinator of builds, and the command line around it.
//!
//! A program of your own can build with worker processes too, in a run folder that survives crashes: see
//! [`Run`], and [`work`] for an example. With other workers, or without a run folder, it is put together from
//! an executable `roadmill` ([`crew::Executable::at`]), a crew of processes that run it ([`crew::LocalCrew`]), and a
//! [`dispatch::Dispatcher`] over the crew as the executor of [`roadmill::img::drive`].

pub mod agent;
mod cli;
mod commands;
mod cpu;
pub mod crew;
pub mod dispatch;
pub mod exit;
mod files;
mod memory;
mod output;
mod progress;
pub mod run;
pub mod signals;
mod waiting;
pub mod work;

pub use progress::Report as ProgressReport;
pub use work::{Ended, Growth, Relaxing, Run, Selection, Workers};

use exit::{Code, Failure};
use std::process::ExitCode;

/// Runs the program with the command line that the process was given.
pub fn main() -> ExitCode {
    if let Err(error) = signals::take_limits_for_errors() {
        output::note(format_args!("roadmill: cannot listen to signals: {error}"));
        return ExitCode::from(Code::System as u8);
    }
    let code = match cli::Arguments::of_process() {
        Ok(arguments) => run(arguments.command).unwrap_or_else(say_failure),
        // Help and version are output as any other.
        Err(told) if !told.use_stderr() => {
            output::printed(told.print());
            Code::Done
        }
        Err(error) => {
            // Nobody may be there to read it.
            let _ = error.print();
            Code::Usage
        }
    };
    let lost = output::lost().map(say_failure);
    // What is no success already, as a signal that came with the end of the terminal, keeps its code.
    let code = if code == Code::Done { lost.unwrap_or(code) } else { code };
    ExitCode::from(code as u8)
}

fn run(command: cli::Command) -> Result<Code, Failure> {
    match command {
        cli::Command::Build(arguments) => commands::build(&arguments),
        cli::Command::Generate(arguments) => commands::generate(&arguments),
        cli::Command::Resume(arguments) => commands::resume(&arguments),
        cli::Command::Agent(arguments) => commands::agent(&arguments),
        cli::Command::Status(arguments) => commands::status(&arguments),
        cli::Command::Verify(arguments) => commands::verify(&arguments),
        cli::Command::Diff(arguments) => commands::diff(&arguments),
        cli::Command::Log(arguments) => commands::log(&arguments),
        cli::Command::Query(arguments) => commands::query(&arguments),
        cli::Command::Paths(arguments) => commands::paths(&arguments),
        cli::Command::Deform(arguments) => commands::deform(&arguments),
        cli::Command::Orders(arguments) => commands::orders(&arguments),
        cli::Command::Report(arguments) => commands::report(&arguments),
        cli::Command::Compare(arguments) => commands::compare(&arguments),
        cli::Command::View(arguments) => commands::view(&arguments),
        cli::Command::Check(arguments) => commands::check(&arguments),
        cli::Command::Import(arguments) => commands::import(&arguments),
        cli::Command::Export(arguments) => commands::export(&arguments),
        cli::Command::Transition(arguments) => commands::transition(&arguments),
        cli::Command::Fold(arguments) => commands::fold(&arguments),
        cli::Command::Replan(arguments) => commands::replan(&arguments),
        cli::Command::Relax(arguments) => commands::relax(&arguments),
        cli::Command::Protein(command) => commands::protein(&command),
        cli::Command::Ligand(command) => commands::ligand(&command),
        cli::Command::Completions(arguments) => commands::completions(&arguments),
        cli::Command::Man(arguments) => commands::man(&arguments),
        cli::Command::Worker(arguments) => commands::worker(&arguments),
    }
}

fn say_failure(Failure { code, message }: Failure) -> Code {
    output::note(format_args!("roadmill: {message}"));
    code
}
