use crate::cli::{Arguments, ManArguments};
use crate::exit::{Code, Failure};
use crate::files::{cannot_write, write_whole};
use crate::output::data;
use clap_mangen::Man;
use std::fs;

/// Prints the manual page of the program, or writes a page for it and for each of its commands.
pub fn man(arguments: &ManArguments) -> Result<Code, Failure> {
    let mut command = Arguments::whole();
    // Names the commands of `protein` by all their words.
    command.build();
    let Some(folder) = &arguments.out else {
        data(&page(&command)?);
        return Ok(Code::Done);
    };
    fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))?;
    let mut left = vec![command];
    while let Some(command) = left.pop() {
        let name = command.get_display_name().unwrap_or_else(|| command.get_name());
        write_whole(&folder.join(format!("{name}.1")), page(&command)?)?;
        let inner = command.get_subcommands().filter(|inner| !inner.is_hide_set());
        left.extend(inner.filter(|inner| inner.get_name() != "help").cloned());
    }
    Ok(Code::Done)
}

fn page(command: &clap::Command) -> Result<String, Failure> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page).map_err(Failure::system)?;
    String::from_utf8(page).map_err(Failure::system)
}
