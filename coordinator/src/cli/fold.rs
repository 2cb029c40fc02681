//! Arguments of `fold`.

use super::{ChainArguments, JobArguments, exit};
use clap::Args;
use std::path::PathBuf;

/// Of `fold`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct FoldArguments {
    /// A PDB or mmCIF file (docs/structures.md) with the native structure
    pub file: PathBuf,
    #[command(flatten)]
    pub chain: ChainArguments,
    #[command(flatten)]
    pub job: JobArguments,
}
