//! `roadmill`: the coordinator of builds, and the command line around it.

mod cli;
mod commands;
mod cpu;
mod exit;
mod pool;
mod progress;
mod run;
mod signals;

use clap::Parser;
use exit::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let result = match cli::Arguments::parse().command {
        cli::Command::Build(arguments) => commands::build(&arguments),
        cli::Command::Query(arguments) => commands::query(&arguments),
        cli::Command::Check(arguments) => commands::check(&arguments),
        cli::Command::Import(arguments) => commands::import(&arguments),
        cli::Command::Export(arguments) => commands::export(&arguments),
        cli::Command::Worker(arguments) => commands::worker(&arguments),
    };
    let code = result.unwrap_or_else(|Failure { code, message }| {
        eprintln!("roadmill: {message}");
        code
    });
    ExitCode::from(code as u8)
}
