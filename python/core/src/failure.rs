//! Failures as an exception.

use pyo3::PyErr;
use pyo3::exceptions::PyException;
use roadmill_coordinator::exit;

pyo3::create_exception!(
    _core,
    Failure,
    PyException,
    "What the program would have ended with: its arguments are the exit code and the message."
);

/// The exception for a failure.
pub fn raised(failure: exit::Failure) -> PyErr {
    Failure::new_err((failure.code as u8, failure.message))
}
