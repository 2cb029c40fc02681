//! Verification of runs whose configurations a function in Python judged, which no process of the program has.

use crate::failure::raised;
use crate::validity::{Given, PythonFunction, exception};
use pyo3::prelude::*;
use roadmill::Cancel;
use roadmill_coordinator::{Run, Selection, Workers};
use std::path::PathBuf;
use std::time::Duration;

/// Between two times that Python is asked whether a signal came.
const SIGNALS_PAUSE: Duration = Duration::from_millis(10);

/// How many sets were recomputed, of how many, how many judgements, and the roadmap's digest.
type Found = (u64, u64, u64, Option<String>);

/// Recomputes a share of a run, all of it, or the sets that are named, in threads, with its validity function.
#[pyfunction]
#[pyo3(signature = (run, share, everything, sets, threads, validity))]
pub fn verify(
    py: Python<'_>,
    run: PathBuf,
    share: Option<f64>,
    everything: bool,
    sets: Vec<String>,
    threads: usize,
    validity: Given,
) -> PyResult<Found> {
    let function = PythonFunction::new(validity).map_err(raised)?;
    let selection = match (everything, share) {
        (true, _) => Selection::All,
        (false, _) if !sets.is_empty() => Selection::Sets(sets),
        (false, Some(share)) => Selection::Share(share),
        (false, None) => Selection::default(),
    };
    let cancel = Cancel::new();
    let verification = Run::at(run)
        .verify(selection)
        .workers(&Workers::threads(threads))
        .validity_function(&function.function)
        .cancel(&cancel);
    // In a thread of its own, so that this one hears of signals.
    // In a thread of its own, so that this one hears of signals.
    let (verified, signal) = std::thread::scope(|scope| {
        let working = scope.spawn(|| verification.check());
        let mut signal = Ok(());
        while !working.is_finished() {
            if signal.is_ok() {
                signal = py.check_signals();
            }
            if signal.is_err() {
                cancel.cancel();
            }
            py.detach(|| std::thread::sleep(SIGNALS_PAUSE));
        }
        (working.join(), signal)
    });
    let failed = function.function.failure().map(|failed| exception(py, failed));
    function.end_calls(py)?;
    if let Some(failed) = failed {
        return Err(failed);
    }
    signal?;
    let verified = match verified {
        Ok(verified) => verified.map_err(raised)?,
        Err(panic) => std::panic::resume_unwind(panic),
    };
    let digest = verified.digest.map(|digest| digest.to_string());
    Ok((verified.sets, verified.sets_recorded, verified.judgements, digest))
}
