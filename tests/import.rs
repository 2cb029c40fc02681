//! Problems written out: whatever loads, loads again from what is written to the same problem.

#[path = "support/scenes.rs"]
#[allow(dead_code)]
mod scenes;

use roadmill::problem::Problem;
use std::path::{Path, PathBuf};

/// Writes a problem into a scratch folder and reads it again.
fn again(problem: &Problem) -> Problem {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let written = problem.to_toml("own meshes");
    let meshes = folder.path().join("own meshes");
    std::fs::create_dir(&meshes).expect("a folder can be made");
    for (name, text) in &written.files {
        std::fs::write(meshes.join(name), text).expect("a mesh can be written");
    }
    let file = folder.path().join("again.toml");
    std::fs::write(&file, &written.text).expect("a problem can be written");
    Problem::load(&file).unwrap_or_else(|error| panic!("{error}\n{}", written.text))
}

#[track_caller]
fn assert_same(path: &Path) {
    let problem = Problem::load(path).unwrap_or_else(|error| panic!("{error}"));
    let again = again(&problem);
    assert_eq!(again.digest(), problem.digest(), "{}", path.display());
    // The digest leaves out the query, the criteria and the limits.
    assert_eq!(again.name(), problem.name(), "{}", path.display());
    assert_eq!(again.query(), problem.query(), "{}", path.display());
    assert_eq!(again.evaluators(), problem.evaluators(), "{}", path.display());
    assert_eq!(again.limits(), problem.limits(), "{}", path.display());
}

fn problems_in(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() > 3);
    paths
}

#[test]
fn our_own_problems_come_back_the_same() {
    for path in problems_in("problems").iter().chain(&problems_in("tests/problems")) {
        assert_same(path);
    }
}

#[test]
fn foreign_scenes_come_back_the_same() {
    let Some(data) = scenes::data() else { return };
    for name in scenes::ALL {
        let folder = if name.ends_with(".cfg") { "scenes/ompl" } else { "scenes/parasol" };
        assert_same(&data.join(folder).join(name));
    }
}
