//! A build as long as wanted.

use std::path::{Path, PathBuf};

/// Writes the cage without its query, to be built up to so many nodes in sets of `set`, into a folder.
pub fn cage(folder: &Path, nodes: u64, set: u64) -> PathBuf {
    let problems = Path::new(env!("CARGO_MANIFEST_DIR")).join("../problems");
    let text = std::fs::read_to_string(problems.join("cage.toml")).expect("the cage ships");
    let text = text.split("[query]").next().expect("a first part");
    let meshes = format!("{}/meshes/", problems.display());
    let strategy = format!("label = \"uniform\"\nnodes = {set}\nsampler = {{ uniform = {{}} }}");
    let text = format!(
        "{}\n[[strategies]]\n{strategy}\n[limits]\nnodes = {nodes}\n",
        text.replace("meshes/", &meshes)
    );
    let path = folder.join("cage.toml");
    std::fs::write(&path, text).expect("a problem can be written");
    path
}
