//! Validity functions written in Python.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes};
use roadmill::model::{FunctionFailed, JudgeConfigurations, ValidityFunction};
use roadmill_coordinator::exit::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// Between two looks whether calls of a function have ended.
const CALLS_PAUSE: Duration = Duration::from_millis(2);

/// What Python gives of a validity function: its identity, and a callable from the bytes of a configuration (float64, little-endian)
/// to a bool.
pub type Given = (String, Py<PyAny>);

/// A function in Python, and the calls of it.
pub struct PythonFunction {
    pub function: ValidityFunction,
    calls: Arc<Calls>,
}

#[derive(Default)]
struct Calls {
    running: AtomicUsize,
    /// No call begins any more.
    are_over: AtomicBool,
}

impl PythonFunction {
    pub fn new((identity, callable): Given) -> Result<PythonFunction, Failure> {
        let calls = Arc::<Calls>::default();
        let judge = Judge { callable, calls: calls.clone() };
        let function = ValidityFunction::new(identity, judge).map_err(Failure::usage)?;
        Ok(PythonFunction { function, calls })
    }

    /// Lets no call begin any more, and waits until those that run have ended, or a signal's handler raises: what a build that was
    /// ended leaves behind in its threads must not call Python when that ends.
    pub fn end_calls(&self, py: Python<'_>) -> PyResult<()> {
        self.calls.are_over.store(true, Ordering::SeqCst);
        while self.calls.running.load(Ordering::SeqCst) > 0 {
            py.check_signals()?;
            py.detach(|| std::thread::sleep(CALLS_PAUSE));
        }
        Ok(())
    }
}

/// The exception that a function failed with; one that says what it did where it raised none.
pub fn exception(py: Python<'_>, failed: &FunctionFailed) -> PyErr {
    let raised = failed.cause.as_ref().and_then(|cause| cause.downcast_ref::<PyErr>());
    raised.map_or_else(
        || PyRuntimeError::new_err(failed.message.clone()),
        |error| error.clone_ref(py),
    )
}

struct Judge {
    callable: Py<PyAny>,
    calls: Arc<Calls>,
}

impl JudgeConfigurations for Judge {
    fn is_valid(&self, q: &[f64]) -> Result<bool, FunctionFailed> {
        self.calls.running.fetch_add(1, Ordering::SeqCst);
        let answer = match self.calls.are_over.load(Ordering::SeqCst) {
            false => self.ask(q),
            true => Err(FunctionFailed { message: "the work is over".to_owned(), cause: None }),
        };
        self.calls.running.fetch_sub(1, Ordering::SeqCst);
        answer
    }
}

impl Judge {
    fn ask(&self, q: &[f64]) -> Result<bool, FunctionFailed> {
        Python::attach(|py| {
            let bytes: Vec<u8> = q.iter().flat_map(|value| value.to_le_bytes()).collect();
            let answer = self.callable.bind(py).call1((PyBytes::new(py, &bytes),));
            let answer = answer.and_then(|answer| Ok(answer.cast::<PyBool>()?.is_true()));
            answer.map_err(|error: PyErr| {
                let message = format!("the validity function failed: {error}");
                FunctionFailed { message, cause: Some(Arc::new(error)) }
            })
        })
    }
}
