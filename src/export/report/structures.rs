//! The paths as structures that move: what the page's viewer is given.

use super::super::markup::quoted;
use super::super::palette::{ENDS, colour};
use super::super::pdb;
use super::Report;
use super::along::Along;
use super::residues::Motion;
use crate::model::Molecule;
use crate::pathways::Frames;
use crate::structure::measure::superpose;
use crate::structure::{Point, Residue};
use base64::prelude::{BASE64_STANDARD, Engine};
use std::fmt::Write;

/// All coordinates of a page together have at most about so many bytes as they are written.
const BYTES_MAX: usize = 8 << 20;

/// Bytes of an atom in a frame: three numbers of 16 bits, in base64.
const ATOM_BYTES: usize = 8;

/// The finest unit of coordinates, Å.
const FINEST: f64 = 0.01;

/// What is kept of the structures so that a page does not become too large.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kept {
    /// N, CA, C and O alone; otherwise all heavy atoms.
    backbone: bool,
    /// Every how many frames one is kept, besides the last.
    stride: usize,
}

impl Kept {
    /// All heavy atoms if there is room; otherwise the backbone; otherwise the backbone of every second frame, every third,
    /// and so on. `frames` counts those of each path.
    fn of(heavy: usize, backbone: usize, frames: &[usize]) -> Kept {
        let bytes = |atoms: usize, stride: usize| {
            let kept: usize = frames.iter().map(|count| count.div_ceil(stride) + 1).sum();
            kept * atoms * ATOM_BYTES
        };
        if bytes(heavy, 1) <= BYTES_MAX {
            return Kept { backbone: false, stride: 1 };
        }
        let most = frames.iter().copied().max().unwrap_or(1).max(1);
        let stride = (1..most).find(|stride| bytes(backbone, *stride) <= BYTES_MAX);
        Kept { backbone: true, stride: stride.unwrap_or(most) }
    }

    /// The chains with what is kept of their atoms.
    fn atoms(self, mut chains: Vec<Vec<Residue>>) -> Vec<Vec<Residue>> {
        for residue in chains.iter_mut().flatten() {
            residue.atoms.retain(|atom| {
                let is_backbone = matches!(atom.name.as_str(), "N" | "CA" | "C" | "O");
                atom.is_heavy() && (is_backbone || !self.backbone)
            });
        }
        chains
    }

    /// The indices of the frames that are kept.
    fn frames(self, count: usize) -> Vec<usize> {
        (0..count).filter(|index| index % self.stride == 0 || index + 1 == count).collect()
    }
}

/// The section with the viewer, and its data as a JSON text; without data where there is no path, or where a structure cannot
/// be written, which the section then says. `None` where the model is no molecule.
pub(super) fn section(
    report: &Report,
    tables: &[Along],
    motion: &Motion,
) -> Option<(String, Option<String>)> {
    let molecule = report.problem.model.description().molecule()?;
    let heading = "<section id=\"structures\"><h2>The structures, moving</h2>\n";
    if report.pathways.pathways.is_empty() {
        return Some((format!("{heading}<p>There is no path to be shown.</p></section>\n"), None));
    }
    let start = molecule.chains_at(&report.ends.start);
    let count = |kept: Kept| {
        kept.atoms(start.clone()).iter().flatten().map(|residue| residue.atoms.len()).sum()
    };
    let [heavy, backbone] = [false, true].map(|backbone| count(Kept { backbone, stride: 1 }));
    let frames: Vec<usize> =
        report.pathways.pathways.iter().map(|pathway| pathway.frames.len()).collect();
    let kept = Kept::of(heavy, backbone, &frames);
    let start = kept.atoms(start);
    let mut model = String::new();
    if let Err(error) = pdb::model(&start, &mut model) {
        let why = super::super::markup::escaped(&error.to_string());
        return Some((format!("{heading}<p>They cannot be shown: {why}.</p></section>\n"), None));
    }
    let mut html = heading.to_owned();
    html += VIEWER;
    write!(
        html,
        "<p>{} of every chain, ",
        if kept.backbone { "N, CA, C and O" } else { "All heavy atoms" }
    )
    .expect("memory");
    html += match kept.stride {
        1 => "every frame. ",
        2 => "every second frame. ",
        _ => "",
    };
    if kept.stride > 2 {
        write!(html, "every {}th frame. ", kept.stride).expect("memory");
    }
    html += match molecule.has_chains_that_stand_still() {
        false => "Frames are superposed on the start by all Cα. ",
        true => {
            "The other chains stand still, and frames stand as they do in the model, by the chain's first residue. "
        }
    };
    html += "Atoms beside the backbone move rigidly along. Ribbons keep the secondary structure of the start. A page has all heavy atoms \
        as long as their coordinates take at most 8 MiB, otherwise the backbone, and then fewer frames.</p></section>\n";
    Some((html, Some(data(report, molecule, tables, motion, &model, kept))))
}

/// The controls.
const VIEWER: &str = "<div class=\"controls\">\
    <label>path <select id=\"path\"></select></label> \
    <label>drawn as <select id=\"style\"><option value=\"cartoon\">ribbon</option><option value=\"trace\">trace</option><option value=\"stick\">sticks</option></select></label> \
    <label>coloured <select id=\"colours\"><option value=\"path\">by path</option><option value=\"chain\">along the chain</option><option value=\"motion\">by how far it moves between the ends</option></select></label> \
    <label><input type=\"checkbox\" id=\"show-ends\" checked> both ends</label></div>\n\
    <div id=\"viewer\"></div>\n\
    <div class=\"controls\"><button id=\"play\" type=\"button\">play</button> \
    <input id=\"frame\" type=\"range\" min=\"0\" max=\"0\" value=\"0\" aria-label=\"frame\"> <output id=\"told\"></output></div>\n\
    <div class=\"controls\"><button id=\"save\" type=\"button\">save this path as PDB</button></div>\n";

/// The JSON text.
fn data(
    report: &Report,
    molecule: &dyn Molecule,
    tables: &[Along],
    motion: &Motion,
    model: &str,
    kept: Kept,
) -> String {
    let coordinates: Vec<Vec<Vec<Point>>> = (report.pathways.pathways.iter())
        .map(|pathway| placed(molecule, &pathway.frames, kept))
        .collect();
    let all = coordinates.iter().flatten().flatten();
    let farthest =
        all.flat_map(|point| point.iter()).fold(0.0f64, |far, value| far.max(value.abs()));
    let mut unit = FINEST;
    while farthest > unit * f64::from(i16::MAX) && unit < 1e6 {
        unit *= 2.0;
    }
    let largest = motion.ends.iter().copied().fold(0.0, f64::max);
    let numbers = |values: &mut dyn Iterator<Item = f64>| -> String {
        let texts: Vec<String> = values.map(|value| format!("{value:.2}")).collect();
        texts.join(",")
    };
    let mut json = format!(
        "{{\"name\":{},\"unit\":{unit},\"ends\":[{},{}],\"pdb\":{},\n",
        quoted(report.problem.name()),
        quoted(ENDS[0]),
        quoted(ENDS[1]),
        quoted(model)
    );
    write!(
        json,
        "\"motion\":[{}],\"largest\":{largest:.2},\n\"paths\":[",
        numbers(&mut motion.ends.iter().copied())
    )
    .expect("memory");
    for (index, (frames, table)) in coordinates.iter().zip(tables).enumerate() {
        let columns = ["frame", "length", "energy", "rmsd_start", "rmsd_goal"];
        let columns = columns.map(|name| table.column(name).expect("tables of molecules have it"));
        let comma = if index == 0 { "" } else { ",\n" };
        write!(json, "{comma}{{\"colour\":{},\"told\":[", quoted(colour(index))).expect("memory");
        let rows = kept.frames(table.table.rows.len()).into_iter().map(|row| {
            let row = &table.table.rows[row];
            format!("[{}]", numbers(&mut columns.iter().map(|column| row[*column])))
        });
        json += &rows.collect::<Vec<_>>().join(",");
        let bytes: Vec<u8> = (frames.iter().flatten())
            .flat_map(|point| [point.x, point.y, point.z])
            .flat_map(|value| ((value / unit).round() as i16).to_le_bytes())
            .collect();
        write!(json, "],\"coordinates\":{}}}", quoted(&BASE64_STANDARD.encode(&bytes)))
            .expect("memory");
    }
    json + "]}"
}

/// Where the kept atoms are in each kept frame of a path.
fn placed(molecule: &dyn Molecule, frames: &Frames, kept: Kept) -> Vec<Vec<Point>> {
    let alphas = |chain: &[Residue]| -> Vec<Point> {
        chain.iter().map(|residue| residue.position("CA").unwrap_or_default()).collect()
    };
    let start = alphas(&molecule.chains_at(frames.configs.get(0))[0]);
    let of_frame = |index: usize| -> Vec<Point> {
        let chains = molecule.chains_at(frames.configs.get(index));
        // Among other chains, which stand still, a conformation stays where the model has it.
        let motion = (!molecule.has_chains_that_stand_still())
            .then(|| superpose(&alphas(&chains[0]), &start));
        let chains = kept.atoms(chains);
        let atoms = chains.iter().flatten().flat_map(|residue| &residue.atoms);
        let place = |position: &Point| match &motion {
            Some(motion) => motion.apply(position),
            None => *position,
        };
        atoms.map(|atom| place(&atom.position)).collect()
    };
    kept.frames(frames.len()).into_iter().map(of_frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_paths_lose_side_chains_first_and_frames_then() {
        assert_eq!(Kept::of(100, 40, &[20, 30]), Kept { backbone: false, stride: 1 });
        // 1656 heavy atoms of 214 residues: 633 frames have room, of the backbone 1225.
        assert_eq!(Kept::of(1656, 856, &[600]), Kept { backbone: false, stride: 1 });
        assert_eq!(Kept::of(1656, 856, &[600, 600]), Kept { backbone: true, stride: 1 });
        let kept = Kept::of(1656, 856, &[4000, 3000]);
        assert_eq!(kept, Kept { backbone: true, stride: 6 });
        assert_eq!(kept.frames(14), [0, 6, 12, 13]);
        assert_eq!(
            Kept::of(1 << 20, 1 << 20, &[7]).stride,
            7,
            "both ends stay, whatever they take"
        );
        assert_eq!(Kept { backbone: true, stride: 7 }.frames(7), [0, 6]);
    }
}
