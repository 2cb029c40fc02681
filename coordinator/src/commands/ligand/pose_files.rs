//! Files of poses and of ways out.

use super::pose_table::{PoseTable, Row};
use crate::cli::PoseFormat;
use crate::exit::Failure;
use crate::files::write_whole;
use roadmill::binding::{Candidates, WayOut};
use roadmill::export::structure_pdb;
use roadmill::ligand::{LigandError, PdbPose, PdbResidue, SdfRecord, pdb, sdf};
use roadmill::model::docking::Docking;
use roadmill::structure::Point;
use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The most models of a PDB file.
const MODELS_MAX: usize = 9_999;

/// A file whose name begins as the others' do.
pub(super) fn named(prefix: &Path, end: &str) -> PathBuf {
    let mut name = OsString::from(prefix);
    name.push(end);
    PathBuf::from(name)
}

/// The files that are written for a format.
pub(super) fn places(prefix: &Path, format: PoseFormat) -> Vec<PathBuf> {
    match format {
        PoseFormat::Sdf => vec![named(prefix, ".sdf")],
        PoseFormat::Pdb => vec![named(prefix, ".pdb"), named(prefix, "-protein.pdb")],
        PoseFormat::Csv => vec![named(prefix, ".csv")],
    }
}

/// Writes the poses in a format.
pub(super) fn write(
    format: PoseFormat,
    prefix: &Path,
    docking: &Docking,
    found: &Candidates,
    table: &PoseTable,
) -> Result<(), Failure> {
    let files = places(prefix, format);
    match format {
        PoseFormat::Sdf => {
            let mut text = String::new();
            for (row, pose) in table.rows.iter().zip(&found.candidates) {
                text += &record(docking, row, &pose.positions)?;
            }
            write_whole(&files[0], text)
        }
        PoseFormat::Pdb => {
            let poses = table.rows.iter().zip(&found.candidates).map(|(row, pose)| PdbPose {
                positions: pose.positions.clone(),
                remarks: vec![format!("POSE {} ENERGY {:.3} KJ/MOL", row.rank, row.energy)],
            });
            write_whole(&files[0], of_ligand(docking, &poses.collect::<Vec<_>>())?)?;
            write_whole(&files[1], protein(docking)?)
        }
        PoseFormat::Csv => write_whole(&files[0], table.csv()),
    }
}

/// The protein as a PDB file.
///
/// # Errors
/// Exit code 2: the format has no columns for it.
pub(super) fn protein(docking: &Docking) -> Result<String, Failure> {
    let chains = docking.chains().iter().map(|chain| chain.residues.clone()).collect();
    structure_pdb(chains).map_err(|error| Failure::usage(format!("--format: {error}")))
}

/// A pose as an SDF record with its numbers.
pub(super) fn record(docking: &Docking, row: &Row, positions: &[Point]) -> Result<String, Failure> {
    let mut data = vec![
        ("rank", row.rank.to_string()),
        ("energy_kJ_mol", row.energy.to_string()),
        ("van_der_waals_kJ_mol", row.parts.van_der_waals.to_string()),
        ("coulomb_kJ_mol", row.parts.coulomb.to_string()),
        ("hydrophobic_kJ_mol", row.parts.hydrophobic.to_string()),
        ("own_kJ_mol", row.parts.own.to_string()),
        ("score_kJ_mol", row.score.to_string()),
        ("population", row.population.to_string()),
    ];
    let optional = [("barrier_kJ_mol", row.barrier), ("rmsd_A", row.rmsd)];
    data.extend(optional.iter().filter_map(|(name, value)| Some((*name, (*value)?.to_string()))));
    data.extend(row.rmsd_rotated.map(|rmsd| ("rmsd_rotated_A", rmsd.to_string())));
    plain_record(docking, positions, &data)
}

/// Positions of the ligand as an SDF record.
pub(super) fn plain_record(
    docking: &Docking,
    positions: &[Point],
    data: &[(&str, String)],
) -> Result<String, Failure> {
    let ligand = docking.ligand();
    let (name, comment) = (ligand.name(), "");
    sdf(&SdfRecord { ligand, positions, name, comment, data }).map_err(cannot)
}

fn of_ligand(docking: &Docking, poses: &[PdbPose]) -> Result<String, Failure> {
    pdb(docking.ligand(), &PdbResidue::of(docking.ligand()), poses).map_err(cannot)
}

fn cannot(error: LigandError) -> Failure {
    Failure::usage(format!("--format: {error}"))
}

/// Writes a way out: a model for every place on it, and its energies.
pub(super) fn write_way(
    prefix: &Path,
    number: usize,
    docking: &Docking,
    way: &WayOut,
) -> Result<(), Failure> {
    let steps = steps(docking, way);
    // A longer way is thinned out, so that the format has numbers for all models.
    let every = steps.len().div_ceil(MODELS_MAX).max(1);
    let pose = |step: &Step| PdbPose {
        positions: step.positions.clone(),
        remarks: vec![format!("AT {:.3} A ENERGY {:.3} KJ/MOL", step.along, step.energy)],
    };
    let poses: Vec<PdbPose> = steps.iter().step_by(every).map(pose).collect();
    write_whole(&named(prefix, &format!("-way-{number}.pdb")), of_ligand(docking, &poses)?)?;
    let mut csv = "step,along [A],energy [kJ/mol]\n".to_owned();
    for (index, step) in steps.iter().enumerate() {
        writeln!(csv, "{},{},{}", index + 1, step.along, step.energy)
            .expect("writing to memory cannot fail");
    }
    write_whole(&named(prefix, &format!("-way-{number}.csv")), csv)
}

/// A place on a way out.
pub(super) struct Step {
    pub positions: Vec<Point>,
    /// How far the atoms have come since the pose: the sum of the RMSDs from step to step, Å.
    pub along: f64,
    pub energy: f64,
}

/// The places on a way out.
pub(super) fn steps(docking: &Docking, way: &WayOut) -> Vec<Step> {
    let mut along = 0.0;
    let mut steps: Vec<Step> = Vec::new();
    for (q, energy) in way.configurations.iter().zip(&way.energies) {
        let positions = docking.positions_at(q);
        if let Some(last) = steps.last() {
            along += roadmill::structure::measure::rmsd_in_place(&last.positions, &positions);
        }
        steps.push(Step { positions, along, energy: *energy });
    }
    steps
}
