use super::super::csv::header;
use crate::deformation::DeformedPath;
use crate::space::Space;
use std::fmt::Write;

/// The energies along a path as CSV: a line per frame, with its number from 1 on, how far along the path it is from 0 to 1, its edge, counted
/// from 1, its configuration, the energy, a length, the volume as a share of that at rest, and whether the shape is a blend of two others (1) or
/// what the method of deformation gives (0). Numbers are written so that reading them back gives the same bits.
pub fn energies_csv(space: &Space, path: &DeformedPath) -> String {
    let mut csv = format!(
        "frame,share [1],edge,{},energy [length],volume [1],blend\n",
        header(space).join(",")
    );
    for (index, frame) in path.frames.iter().enumerate() {
        write!(csv, "{},{},{}", index + 1, frame.share, frame.edge + 1).expect("memory");
        for value in &frame.configuration {
            write!(csv, ",{value}").expect("memory");
        }
        let blend = u8::from(frame.is_blend);
        writeln!(csv, ",{},{},{blend}", frame.energy, frame.volume).expect("memory");
    }
    csv
}
