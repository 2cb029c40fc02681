//! A path, or a roadmap's nodes, as a DCD trajectory: for VMD, PyMOL, MDAnalysis, mdtraj and others.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::model::Molecule;

/// The DCD format of CHARMM and NAMD, little-endian: one frame for every configuration of the path that answers the query, in
/// its order; without a path, one for every node in the order of their ids. Coordinates are float32 in Å of the atoms that a
/// PDB file of the same export has, in its order; that file says which they are.
pub(super) struct Dcd;

impl RoadmapFormat for Dcd {
    fn name(&self) -> &'static str {
        "dcd"
    }

    fn about(&self) -> &'static str {
        "The same as a trajectory of CHARMM and NAMD, whose atoms are those of the pdb export"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let (molecule, configs) = exported.conformations()?;
        Ok(vec![ExportFile::named(dcd(molecule, configs.into_iter())?)])
    }
}

/// Conformations of a molecule as the frames of a DCD file, with all atoms of the source structure, in Å.
///
/// A file is made of Fortran records: the length of each, in bytes, stands before and behind it. The first has the word
/// `CORD` and 20 integers, of which the first is the number of frames and the last, 24, says that the layout is CHARMM's;
/// the second has titles of 80 characters, the third the number of atoms. Then every frame has three records: all x, all y, all
/// z.
///
/// # Errors
/// Says what does not fit into the numbers of the format.
pub fn dcd<'a>(
    molecule: &dyn Molecule,
    configs: impl ExactSizeIterator<Item = &'a [f64]>,
) -> Result<Vec<u8>, CannotExport> {
    let frames = i32::try_from(configs.len())
        .map_err(|_| CannotExport("more frames than a DCD file can number".to_owned()))?;
    let mut out = Vec::new();
    let mut is_first = true;
    for q in configs {
        let chains = molecule.chains_at(q);
        let atoms = chains.iter().flatten().flat_map(|residue| &residue.atoms);
        let mut axes: [Vec<u8>; 3] = Default::default();
        let mut atoms_here = 0;
        for atom in atoms {
            atoms_here += 1;
            for (axis, value) in axes.iter_mut().zip(atom.position.iter()) {
                let single = *value as f32;
                if !single.is_finite() {
                    return Err(CannotExport("a coordinate is no finite number".to_owned()));
                }
                axis.extend(single.to_le_bytes());
            }
        }
        if std::mem::take(&mut is_first) {
            head(&mut out, frames, atoms_here)?;
        }
        axes.iter().for_each(|axis| record(&mut out, axis));
    }
    if is_first {
        head(&mut out, frames, 0)?;
    }
    Ok(out)
}

/// The three records before the first frame. The number of atoms is known with it; a file without frames has none.
fn head(out: &mut Vec<u8>, frames: i32, atoms: usize) -> Result<(), CannotExport> {
    let number = i32::try_from(atoms).ok().filter(|atoms| *atoms < i32::MAX / 4);
    let number =
        number.ok_or_else(|| CannotExport(format!("{atoms} atoms do not fit into a DCD file")))?;
    // Frames, the step of the first, steps from one to the next, all steps; the time of a step, as float32; the layout.
    let mut control = [0i32; 20];
    (control[0], control[1], control[2], control[3]) = (frames, 1, 1, frames);
    control[9] = i32::from_le_bytes(1.0f32.to_le_bytes());
    control[19] = 24;
    let mut first = b"CORD".to_vec();
    control.iter().for_each(|number| first.extend(number.to_le_bytes()));
    record(out, &first);
    let mut titles = 1i32.to_le_bytes().to_vec();
    titles.extend(format!("{:<80}", "REMARKS conformations, without time").bytes());
    record(out, &titles);
    record(out, &number.to_le_bytes());
    Ok(())
}

/// Appends a Fortran record.
fn record(out: &mut Vec<u8>, bytes: &[u8]) {
    let length = (bytes.len() as u32).to_le_bytes();
    out.extend(length);
    out.extend(bytes);
    out.extend(length);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;

    #[test]
    fn records_hold_what_the_format_says() {
        let problem = Problem::load("problems/peptide.toml".as_ref()).expect("it ships");
        let molecule = problem.model.description().molecule().expect("it is one");
        let ends = problem.query().expect("it has a query");
        let file = dcd(molecule, [&ends.start[..], &ends.goal].into_iter());
        let file = file.expect("it fits");
        let chains = molecule.chains_at(&ends.goal);
        let atoms: Vec<_> = chains.iter().flatten().flat_map(|residue| &residue.atoms).collect();
        let mut records = Vec::new();
        let mut rest = &file[..];
        while !rest.is_empty() {
            let number =
                |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().expect("four")) as usize;
            let length = number(&rest[..4]);
            assert_eq!(number(&rest[4 + length..8 + length]), length);
            records.push(&rest[4..4 + length]);
            rest = &rest[8 + length..];
        }
        assert_eq!(records.len(), 3 + 2 * 3);
        assert_eq!((records[0].len(), &records[0][..8]), (84, &b"CORD\x02\0\0\0"[..]));
        assert_eq!(records[1].len(), 84);
        assert_eq!(records[2], (atoms.len() as u32).to_le_bytes());
        for (index, axis) in records[6..].iter().enumerate() {
            for (atom, bytes) in atoms.iter().zip(axis.chunks(4)) {
                let read = f32::from_le_bytes(bytes.try_into().expect("four"));
                assert_eq!(read, atom.position[index] as f32);
            }
        }
    }
}
