//! The energies before and after the descents of a run.

use crate::exit::Failure;
use crate::run::{Replay, Scan, Told};
use roadmill::binding::Exact;
use roadmill::generator::GeneratorKind;
use roadmill::roadmap::Roadmap;
use std::path::Path;

/// The energies of configurations as they were drawn, and of the minima below them, by exact sums, kJ/mol (O. B. Bayazit 2003, Figure 24). Both in
/// the order of the roadmap.
#[derive(Clone, Debug, Default)]
pub(super) struct Descents {
    pub before: Vec<f64>,
    pub after: Vec<f64>,
}

impl Descents {
    /// Those of a run: of sets that `minima` makes every other node is the minimum below the one before.
    ///
    /// # Errors
    /// Exit code 4: the run is damaged.
    pub fn of(folder: &Path, exact: &Exact, roadmap: &Roadmap) -> Result<Descents, Failure> {
        let scan = Scan::read(folder)?;
        let problem = scan.problem()?;
        let mut replay = Replay::new(&scan, &problem)?;
        let (mut first, mut found) = (0, Descents::default());
        while let Some(told) = replay.read()? {
            let Told::Round(round, _) = told else { continue };
            for set in &round.sets {
                let count = set.increment.configs.len();
                let strategy = problem.strategies().get(set.strategy.index());
                let is_descended = strategy.is_some_and(|strategy| {
                    matches!(strategy.generator(), GeneratorKind::Minima(_))
                });
                if is_descended {
                    // A last node without a minimum is left out.
                    for drawn in (first..first + count / 2 * 2).step_by(2) {
                        let energy = |node| exact.energy(roadmap.configs().get(node)).sum();
                        found.before.push(energy(drawn));
                        found.after.push(energy(drawn + 1));
                    }
                }
                first += count;
            }
        }
        Ok(found)
    }

    /// The median before, and after; `None` if there are no descents.
    pub fn medians(&self) -> Option<[f64; 2]> {
        let median = |energies: &[f64]| {
            let mut rising = energies.to_vec();
            rising.sort_unstable_by(f64::total_cmp);
            rising.get(rising.len() / 2).copied()
        };
        Some([median(&self.before)?, median(&self.after)?])
    }
}
