//! The command line of orders of formation.

use super::folder;
use clap::Args;
use std::path::PathBuf;

/// Of `orders`.
#[derive(Debug, Args)]
pub struct OrdersArguments {
    /// The run folder of a protein's roadmap
    pub run: PathBuf,
    #[command(flatten)]
    pub formation: FormationArguments,
    /// A folder for tables of orders, parts and contacts, new or empty
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: Option<PathBuf>,
}

/// What counts as formed, and what as unstructured.
#[derive(Debug, Default, Args)]
pub struct FormationArguments {
    /// The share of its native contacts from which on a helix, a strand or a pairing is formed [default: as the run's evaluator
    /// formation-order has it, otherwise 0.6]
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub formed: Option<f64>,
    /// Pathways begin at conformations with at most so many native contacts [default: as the run's evaluator formation-order has
    /// it, otherwise 0]
    #[arg(long, value_name = "CONTACTS")]
    pub unstructured: Option<u32>,
}

fn share(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    number.ok_or_else(|| "a number above 0, at most 1 expected".to_owned())
}
