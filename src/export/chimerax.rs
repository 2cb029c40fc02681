//! A script by which ChimeraX shows paths.

use super::palette::{ENDS, colour};
use std::fmt::Write;

/// Frames of the picture for which each frame of a path is shown.
const PAUSE: usize = 4;

/// A ChimeraX script (`.cxc`) that opens the paths `path-1.pdb`, `path-2.pdb` and so on, of which `frames` says how many
/// models each has: every path as one model with the number of the path and a coordinate set for each frame, in a colour of
/// its own, and the ends of the first path as two models after them; path 1 plays, the others are there and hidden.
///
/// The Cα of chain A are held steady while a path plays, which superposes every frame, and the goal is aligned to the start.
/// `has_others` says that other chains stand still in the files: then nothing is superposed.
///
/// Commands as in the ChimeraX user guide: `open … coordsets true`, `coordset`, `align`, `movie`. The script is to be run in
/// the folder of the files.
pub fn chimerax(frames: &[usize], has_others: bool) -> String {
    let mut out = String::from(
        "# Paths of roadmill, for ChimeraX. Run it in the folder of the PDB files: cd FOLDER, then open paths.cxc.\n\
         close session\n\
         set bgColor white\n",
    );
    let mut put = |text: std::fmt::Arguments| {
        out.write_fmt(text).expect("writing to memory cannot fail");
        out.push('\n');
    };
    let steady = |model: usize| match has_others {
        true => String::new(),
        false => format!(" holdSteady #{model}/A@ca"),
    };
    for index in 0..frames.len() {
        let path = index + 1;
        put(format_args!("open path-{path}.pdb id {path} coordsets true name \"path {path}\""));
        put(format_args!("color #{path} {}", colour(index)));
    }
    if let Some(count) = frames.first() {
        let [start, goal] = [frames.len() + 1, frames.len() + 2];
        for (model, name, frame, colour) in
            [(start, "start", 1, ENDS[0]), (goal, "goal", *count, ENDS[1])]
        {
            put(format_args!("open path-1.pdb id {model} coordsets true name {name}"));
            put(format_args!("coordset #{model} {frame}"));
            put(format_args!("color #{model} {colour}"));
        }
        if !has_others {
            put(format_args!("align #{goal}/A@ca toAtoms #{start}/A@ca"));
        }
        put(format_args!("hide atoms"));
        put(format_args!("cartoon"));
        put(format_args!("transparency #{start},{goal} 60 target c"));
        if frames.len() > 1 {
            put(format_args!("hide #2-{} models", frames.len()));
        }
        put(format_args!("view"));
        let play = format!("coordset #1 1,{count} pauseFrames {PAUSE}{}", steady(1));
        put(format_args!("{play}"));
        put(format_args!("# As a film, in this order:"));
        put(format_args!("#   movie record"));
        put(format_args!("#   {play}"));
        put(format_args!("#   wait {}", PAUSE * count));
        put(format_args!("#   movie encode path-1.mp4"));
    }
    for (index, count) in frames.iter().enumerate().skip(1) {
        let (path, all) = (index + 1, frames.len());
        put(format_args!("# Path {path} instead, in this order:"));
        put(format_args!("#   hide #1-{all} models"));
        put(format_args!("#   show #{path} models"));
        put(format_args!("#   coordset #{path} 1,{count} pauseFrames {PAUSE}{}", steady(path)));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_is_opened_held_steady_and_coloured() {
        let script = chimerax(&[12, 30], false);
        for line in [
            "open path-1.pdb id 1 coordsets true name \"path 1\"",
            "open path-2.pdb id 2 coordsets true name \"path 2\"",
            "color #2 #c1440e",
            "coordset #3 1",
            "coordset #4 12",
            "align #4/A@ca toAtoms #3/A@ca",
            "hide #2-2 models",
            "coordset #1 1,12 pauseFrames 4 holdSteady #1/A@ca",
            "#   wait 48",
            "#   coordset #2 1,30 pauseFrames 4 holdSteady #2/A@ca",
        ] {
            assert!(script.lines().any(|found| found == line), "{line}\n{script}");
        }
        let beside = chimerax(&[12, 30], true);
        assert!(!beside.contains("align") && !beside.contains("holdSteady"), "{beside}");
        assert!(!chimerax(&[], false).contains("open path-"));
    }
}
