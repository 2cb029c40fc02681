//! Arguments of `fold`.

use super::{ChainArguments, JobArguments};
use clap::Args;
use std::path::PathBuf;

/// Of `fold`.
#[derive(Debug, Args)]
pub struct FoldArguments {
    /// A PDB or mmCIF file (docs/structures.md) with the native structure
    pub file: PathBuf,
    #[command(flatten)]
    pub chain: ChainArguments,
    #[command(flatten)]
    pub job: JobArguments,
}
