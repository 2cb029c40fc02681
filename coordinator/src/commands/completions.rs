use crate::cli::{Arguments, CompletionsArguments};
use crate::exit::{Code, Failure};
use crate::output::data;

/// Prints a script by which a shell completes the program's commands, options and values.
pub fn completions(arguments: &CompletionsArguments) -> Result<Code, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::whole(), "roadmill", &mut script);
    data(&String::from_utf8(script).map_err(Failure::system)?);
    Ok(Code::Done)
}
