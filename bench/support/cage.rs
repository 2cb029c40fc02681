//! A build as long as wanted.

use roadmill::numbers::StrategyIndex;
use roadmill::problem::{Limits, Problem};
use std::path::{Path, PathBuf};

/// Writes the cage without its query, to be built up to so many nodes in sets of `set`, into a folder.
pub fn cage(folder: &Path, nodes: u64, set: u32) -> PathBuf {
    let problems = Path::new(env!("CARGO_MANIFEST_DIR")).join("../problems");
    endless(folder, &problems.join("cage.toml"), (nodes, set), None)
}

/// The same for another scene, with its own sampler or this one, as a problem file names it.
pub fn endless(
    folder: &Path,
    scene: &Path,
    (nodes, set): (u64, u32),
    sampler: Option<&str>,
) -> PathBuf {
    let mut problem = Problem::load(scene).unwrap_or_else(|error| panic!("{error}"));
    problem.query = None;
    problem.evaluators.clear();
    problem.strategies.truncate(1);
    problem.strategies[0].nodes = set;
    problem.schedule = vec![StrategyIndex(0)];
    problem.limits = Limits { nodes, sets: u64::MAX >> 1, seconds: None };
    let mut written = problem.to_toml("meshes");
    if let Some(sampler) = sampler {
        let line = |line: &str| match line.starts_with("sampler = ") {
            true => format!("sampler = {{ {sampler} }}\n"),
            false => format!("{line}\n"),
        };
        written.text = written.text.lines().map(line).collect();
    }
    let path = folder.join("scene.toml");
    let write = || -> std::io::Result<()> {
        std::fs::create_dir_all(folder.join("meshes"))?;
        for (name, text) in &written.files {
            std::fs::write(folder.join("meshes").join(name), text)?;
        }
        std::fs::write(&path, &written.text)
    };
    write().expect("a problem can be written");
    path
}
