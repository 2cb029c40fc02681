//! The folder of a relaxation has no ledger of its own: the runs of its levels, which are folders in it, have.

use super::LEDGER;
use std::fs;
use std::path::Path;

/// The file that makes a folder one of a relaxation, whose levels are run folders in it.
pub const RELAXATION_JSON: &str = "relaxation.json";
/// What the names of the run folders of levels begin with.
pub const LEVEL: &str = "level-";

/// The run folders of the levels that have begun in the folder of a relaxation, by their names in the order in which levels were tried; `None` where there is no
/// relaxation.
pub fn levels_in(folder: &Path) -> Option<Vec<String>> {
    if !folder.join(RELAXATION_JSON).is_file() {
        return None;
    }
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_level =
        |name: &String| name.starts_with(LEVEL) && folder.join(name).join(LEDGER).is_file();
    let mut levels: Vec<String> = names.filter(is_level).collect();
    let number = |name: &String| {
        let digits = name[LEVEL.len()..].split('-').next().unwrap_or_default();
        digits.parse::<u64>().unwrap_or_default()
    };
    levels.sort_by_key(|name| (number(name), name.clone()));
    Some(levels)
}
