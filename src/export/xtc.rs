//! A path, or a roadmap's nodes, as an XTC trajectory: for GROMACS, VMD, PyMOL, MDAnalysis, mdtraj and others.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::model::Molecule;
use crate::structure::Point;
use molly::{Frame, XTCWriter};

/// The XTC format of GROMACS: one frame for every configuration of the path that answers the query, in its order; without a
/// path, one for every node in the order of their ids. The file has nm, as the format wants, rounded to 0.001 Å, of the
/// atoms that a PDB file of the same export has, in its order; that file says which they are. There is no box, and the time
/// of a frame is its number from 0 on.
pub(super) struct Xtc;

/// Units of length that are told apart, per nm.
const PRECISION: f32 = 1e4;

/// Coordinates beyond this many Å are refused: as whole numbers of units they might not fit.
const REACH: f64 = 1e5;

impl RoadmapFormat for Xtc {
    fn name(&self) -> &'static str {
        "xtc"
    }

    fn about(&self) -> &'static str {
        "The same as a trajectory of GROMACS, compressed, rounded to 0.001 Å"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let (molecule, configs) = exported.conformations()?;
        Ok(vec![ExportFile::named(xtc(molecule, configs.into_iter())?)])
    }
}

/// Conformations of a molecule as the frames of an XTC file, with all atoms of the source structure.
///
/// # Errors
/// Says what does not fit into the numbers of the format.
pub fn xtc<'a>(
    molecule: &dyn Molecule,
    configs: impl ExactSizeIterator<Item = &'a [f64]>,
) -> Result<Vec<u8>, CannotExport> {
    let mut writer = XTCWriter::new(Vec::new());
    for (index, q) in configs.enumerate() {
        let step = u32::try_from(index)
            .map_err(|_| CannotExport("more frames than an XTC file can number".to_owned()))?;
        let chains = molecule.chains_at(q);
        let atoms = chains.iter().flatten().flat_map(|residue| &residue.atoms);
        let positions = coordinates(&atoms.map(|atom| atom.position).collect::<Vec<_>>())?;
        let frame =
            Frame { step, time: step as f32, boxvec: [0.0; 9], precision: PRECISION, positions };
        writer.write_frame(&frame).map_err(|error| CannotExport(error.to_string()))?;
    }
    Ok(writer.file)
}

/// Positions in Å as coordinates in nm.
fn coordinates(positions: &[Point]) -> Result<Vec<f32>, CannotExport> {
    let values = positions.iter().flatten().copied();
    let fits = |value: f64| (-REACH..=REACH).contains(&value);
    values
        .map(|value| match fits(value) {
            true => Ok((value / 10.0) as f32),
            false => Err(CannotExport(format!("{value} Å does not fit into an XTC file"))),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;
    use molly::XTCReader;
    use std::io::Cursor;

    #[test]
    fn what_is_written_is_read_again() {
        let problem = Problem::load("problems/peptide.toml".as_ref()).expect("it ships");
        let molecule = problem.model.description().molecule().expect("it is one");
        let ends = problem.query().expect("it has a query");
        let ends = [&ends.start[..], &ends.goal];
        let file = xtc(molecule, ends.into_iter()).expect("it fits");
        let frames = XTCReader::new(Cursor::new(file)).read_all_frames().expect("it is one");
        assert_eq!(frames.len(), 2);
        for (frame, q) in frames.iter().zip(ends) {
            let chains = molecule.chains_at(q);
            let atoms: Vec<_> =
                chains.iter().flatten().flat_map(|residue| &residue.atoms).collect();
            assert_eq!(frame.natoms(), atoms.len());
            let expected = atoms.iter().flat_map(|atom| atom.position.iter());
            for (read, expected) in frame.positions.iter().zip(expected) {
                assert!((f64::from(*read) * 10.0 - expected).abs() < 1e-3);
            }
        }
        assert!(coordinates(&[Point::new(f64::NAN, 0.0, 0.0)]).is_err());
        assert!(coordinates(&[Point::new(2e5, 0.0, 0.0)]).is_err());
    }
}
