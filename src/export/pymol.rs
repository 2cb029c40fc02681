//! A script by which PyMOL shows paths.

use super::palette::{ENDS, colour};
use std::fmt::Write;

/// A PyMOL script (`.pml`) that loads the paths `path-1.pdb`, `path-2.pdb` and so on, of which `frames` says how many models
/// each has: every path as one object `path_1` with a state for each frame, in a colour of its own, and the ends of the first
/// path beside it; path 1 plays, the others are there and switched off.
///
/// All states are superposed on the start by the Cα of chain A, which all paths share. `has_others` says that other chains
/// stand still in the files: then nothing is superposed.
///
/// Commands as in the PyMOL command reference: `load`, `intra_fit`, `create`, `mset`, `mplay`. The script is to be run in the
/// folder of the files.
pub fn pymol(frames: &[usize], has_others: bool) -> String {
    let mut out = String::from(
        "# Paths of roadmill, for PyMOL. Run it in the folder of the PDB files: pymol paths.pml, or cd FOLDER and @paths.pml.\n\
         reinitialize\n\
         bg_color white\n",
    );
    let mut put = |text: std::fmt::Arguments| {
        out.write_fmt(text).expect("writing to memory cannot fail");
        out.push('\n');
    };
    for index in 0..frames.len() {
        let path = index + 1;
        let colour = colour(index).replace('#', "0x");
        put(format_args!("load path-{path}.pdb, path_{path}, multiplex=0"));
        if !has_others {
            put(format_args!("intra_fit path_{path} and chain A and name CA, 1"));
        }
        put(format_args!("as cartoon, path_{path}"));
        put(format_args!("color {colour}, path_{path}"));
    }
    if let Some(count) = frames.first() {
        for (name, state, colour) in [("start", 1, ENDS[0]), ("goal", *count, ENDS[1])] {
            let colour = colour.replace('#', "0x");
            put(format_args!("create {name}, path_1 and chain A, {state}, 1"));
            put(format_args!("color {colour}, {name}"));
            put(format_args!("set cartoon_transparency, 0.6, {name}"));
        }
        put(format_args!("# A sole state is shown at every frame."));
        put(format_args!("set static_singletons, on"));
        put(format_args!("disable path_*"));
        put(format_args!("enable path_1"));
        put(format_args!("zoom all"));
        put(format_args!("mset 1 -{count}"));
        put(format_args!("mplay"));
    }
    for (index, count) in frames.iter().enumerate().skip(1) {
        let path = index + 1;
        put(format_args!("# Path {path} instead, in this order:"));
        put(format_args!("#   disable path_*"));
        put(format_args!("#   enable path_{path}"));
        put(format_args!("#   mset 1 -{count}"));
    }
    put(format_args!("# As pictures, a file for each frame:"));
    put(format_args!("#   mpng frame"));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_is_loaded_superposed_and_coloured() {
        let script = pymol(&[12, 30], false);
        for line in [
            "load path-1.pdb, path_1, multiplex=0",
            "load path-2.pdb, path_2, multiplex=0",
            "intra_fit path_2 and chain A and name CA, 1",
            "color 0x0072b2, path_1",
            "color 0xc1440e, path_2",
            "create start, path_1 and chain A, 1, 1",
            "create goal, path_1 and chain A, 12, 1",
            "mset 1 -12",
            "mplay",
            "#   enable path_2",
            "#   mset 1 -30",
        ] {
            assert!(script.lines().any(|found| found == line), "{line}\n{script}");
        }
        assert!(script.is_ascii(), "PyMOL reads scripts in the encoding of the system");
        assert!(!pymol(&[12, 30], true).contains("intra_fit"), "beside other chains nothing moves");
        assert!(!pymol(&[], false).contains("load"));
    }
}
