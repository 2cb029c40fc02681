use super::Ledger;
use roadmill::generator::{ParentRun, Runs};
use std::path::Path;

/// Reads the run folders that a problem file names as parents.
#[derive(Clone, Copy, Debug)]
pub struct Ledgers;

impl Runs for Ledgers {
    fn read(&self, folder: &Path) -> Result<ParentRun, String> {
        let Ledger { hash, problem, roadmap, .. } =
            Ledger::read(folder).map_err(|failure| failure.message)?;
        Ok(ParentRun { ledger: hash, space: problem.space(), roadmap })
    }
}
