//! Puts into the program what tells builds of different sources apart, on whatever machine they were made: agents of
//! other sources do not work on one roadmap.

use std::fs;
use std::path::{Path, PathBuf};

/// Everything that can change what a program computes or says to another.
const SOURCES: [&str; 6] =
    ["../src", "../workers/src", "src", "../Cargo.lock", "../workers/Cargo.toml", "../Cargo.toml"];

fn main() {
    let mut files = Vec::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
        collect(Path::new(source), &mut files);
    }
    files.sort();
    let mut hasher = blake3::Hasher::new();
    for file in files {
        let bytes = fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let name = file.to_string_lossy();
        hasher.update(&(name.len() as u64).to_le_bytes()).update(name.as_bytes());
        hasher.update(&(bytes.len() as u64).to_le_bytes()).update(&bytes);
    }
    println!("cargo::rustc-env=ROADMILL_SOURCE={}", hasher.finalize().to_hex());
}

/// The files under `path`, or `path` itself where it is a file. What is not there, as the lock file of a package, is none.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_file() {
        files.push(path.to_owned());
    }
    let Ok(entries) = fs::read_dir(path) else { return };
    for entry in entries.flatten() {
        collect(&entry.path(), files);
    }
}
