//! Every command of `examples/`, as its READMEs have them.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{Scratch, children};

/// Copies a folder with all that is in it.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in children(from) {
        let there = to.join(entry.file_name().expect("it has a name"));
        if entry.is_dir() {
            copy(&entry, &there);
        } else {
            fs::copy(&entry, &there).unwrap_or_else(|error| panic!("{}: {error}", entry.display()));
        }
    }
}

/// The blocks of shell commands of a README.
fn blocks(text: &str) -> Vec<&str> {
    let fenced = text.split("```").skip(1).step_by(2);
    fenced.filter_map(|block| block.strip_prefix("sh\n")).collect()
}

#[test]
fn every_command_of_the_examples_works() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let scratch = Scratch::new();
    // The examples name files of `problems`, too.
    for folder in ["examples", "problems"] {
        copy(&root.join(folder), &scratch.path(folder));
    }
    let program = Path::new(env!("CARGO_BIN_EXE_roadmill")).parent().expect("it is in a folder");
    let path = std::env::var("PATH").expect("a path");
    let path = format!("{}:{path}", program.display());
    let folders: Vec<PathBuf> = children(&scratch.path("examples"));
    let listed = fs::read_to_string(scratch.path("examples/README.md")).expect("a README");
    let mut seen = 0;
    for folder in folders.into_iter().filter(|folder| folder.is_dir()) {
        let name = folder.file_name().and_then(|name| name.to_str()).expect("a name");
        assert!(listed.contains(&format!("[{name}]({name})")), "{name} is not in the list");
        let text = fs::read_to_string(folder.join("README.md"));
        let text = text.unwrap_or_else(|error| panic!("{name}: README.md: {error}"));
        let blocks = blocks(&text);
        // The tests of the Python package run notebooks.
        let is_notebook = |file: &PathBuf| file.extension().is_some_and(|kind| kind == "ipynb");
        let has_notebook = children(&folder).iter().any(is_notebook);
        assert!(!blocks.is_empty() || has_notebook, "{name} has no commands");
        for block in blocks {
            let mut command = Command::new("sh");
            command.args(["-ec", &format!("cd {}\n{block}", folder.display())]).env("PATH", &path);
            let done = scratch.start_command(command, "").finish();
            let code = done.status.code();
            assert_eq!(code, Some(0), "{name}:\n{block}\n{}\n{}", done.stdout, done.stderr);
            seen += 1;
        }
    }
    assert!(seen >= 6, "{seen} blocks of commands were seen");
}
