//! From the command line to a model of docking.

use crate::cli::{DockingArguments, Kept, Lookup, OwnTerms, ReceptorArguments, RegionArguments};
use crate::exit::Failure;
use crate::work::Recorded;
use roadmill::model::ModelKind;
use roadmill::model::docking::energy::{EnergySpec, Own, ParameterSet};
use roadmill::model::docking::{
    Docking, DockingSpec, EnergyLookup, GridSpec, LigandSpec, Policy, ReceptorFile, ReceptorSpec,
};
use roadmill::problem::Problem;
use std::path::Path;

/// The model of a ligand at the protein of a file.
pub(super) fn spec_of(
    protein: &Path,
    ligand: LigandSpec,
    receptor: &ReceptorArguments,
    model: &DockingArguments,
    region: &RegionArguments,
) -> DockingSpec {
    let ReceptorArguments { chains, structure_model, waters, metals, others, keep, hydrogens } =
        receptor;
    let mut file = ReceptorFile::new(protein)
        .waters(policy(*waters))
        .metals(policy(*metals))
        .others(policy(*others))
        .keep(keep.iter().cloned());
    if let Some(names) = chains {
        file = file.chains(names.iter().cloned());
    }
    if let Some(number) = structure_model {
        file = file.model(*number);
    }
    let energy = EnergySpec::default();
    let energy = EnergySpec {
        parameters: if model.uff { ParameterSet::Uff } else { energy.parameters },
        cutoff: model.cutoff.unwrap_or(energy.cutoff),
        dielectric: model.dielectric,
        hydrophobic: model.hydrophobic,
        own: match model.own {
            OwnTerms::None => Own::None,
            OwnTerms::Repulsion => Own::Repulsion,
            OwnTerms::Whole => Own::Whole,
        },
    };
    let lookup = match model.grid {
        Lookup::Reciprocal => EnergyLookup::Reciprocal,
        Lookup::Tricubic => EnergyLookup::Tricubic,
        Lookup::Trilinear => EnergyLookup::Trilinear,
        Lookup::Nearest => EnergyLookup::Nearest,
        Lookup::Exact => EnergyLookup::Exact,
    };
    let grid = GridSpec { lookup, spacing: model.spacing.unwrap_or(GridSpec::default().spacing) };
    let mut spec = DockingSpec::new(ReceptorSpec::File(file), ligand)
        .hydrogens(policy(*hydrogens))
        .rigid(model.rigid)
        .amides(!model.no_amides)
        .energy(energy)
        .grid(grid);
    if let Some(energy) = model.highest {
        spec = spec.highest(energy);
    }
    if let (Some(centre), Some(size)) = (region.box_at, region.box_size) {
        spec = spec.region(centre, size);
    }
    spec
}

fn policy(kept: Kept) -> Policy {
    match kept {
        Kept::Remove => Policy::Remove,
        Kept::Keep => Policy::Keep,
    }
}

/// The molecules as the model takes them, before there is a box.
///
/// # Errors
/// Exit code 2: what is wrong with them.
pub(super) fn molecules(spec: &DockingSpec) -> Result<Docking, Failure> {
    // A small box anywhere, as a box of the protein might be more than a grid can have.
    let spec = spec.clone().region([0.0; 3], [1.0; 3]);
    let problem = Problem::builder("ligand", spec).build().map_err(Failure::usage)?;
    match problem.model() {
        ModelKind::Docking(docking) => Ok(docking.clone()),
        _ => Err(Failure::usage("another model found; a ligand at a protein expected")),
    }
}

/// The model of a run that is about a ligand at a protein.
///
/// # Errors
/// Exit code 2: it is about something else.
pub(super) fn docking_of(run: &Recorded) -> Result<&Docking, Failure> {
    match run.problem().model() {
        ModelKind::Docking(docking) => Ok(docking),
        _ => Err(Failure::usage(
            "a run of another model found; one of a ligand at a protein expected, as `roadmill ligand problem` writes its problem",
        )),
    }
}
