//! Runs that were loaded.

use crate::failure::raised;
use crate::validity::{Given, PythonFunction, exception};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use roadmill::export::npz;
use roadmill::model::{Scratch, ValidityFunction, with_functions};
use roadmill::query::{ClearPath, Clearest, Path, shorten};
use roadmill::roadmap::Configs;
use roadmill_coordinator::Run;
use roadmill_coordinator::exit::Failure;
use roadmill_coordinator::work::Recorded;
use std::path::PathBuf;

/// A path: its configurations one after the other, as bytes of float64, and its length.
type FoundPath<'py> = (Bound<'py, PyBytes>, f64);

/// The roadmap of a run's complete rounds, and its problem made ready for queries.
#[pyclass(frozen, name = "LoadedRun", module = "roadmill._core")]
pub struct LoadedRun {
    recorded: Recorded,
}

#[pymethods]
impl LoadedRun {
    /// Reads a run folder; every record and every round's digest are checked. Queries of a run whose configurations a validity
    /// function judged need that function.
    #[new]
    #[pyo3(signature = (folder, validity))]
    fn load(py: Python<'_>, folder: PathBuf, validity: Option<Given>) -> PyResult<LoadedRun> {
        let function = validity.map(PythonFunction::new).transpose().map_err(raised)?;
        let recorded = py.detach(|| {
            let recorded = Run::at(folder).read()?;
            match &function {
                Some(function) => recorded.with_validity_function(&function.function),
                None => Ok(recorded),
            }
        });
        Ok(LoadedRun { recorded: recorded.map_err(raised)? })
    }

    /// The identity of the validity function that judged configurations, if there was one.
    #[getter]
    fn validity(&self) -> Option<&str> {
        self.recorded.problem().validity_function().map(ValidityFunction::identity)
    }

    /// The roadmap's digest.
    #[getter]
    fn digest(&self) -> String {
        self.recorded.digest().to_string()
    }

    /// The problem's name.
    #[getter]
    fn problem_name(&self) -> &str {
        self.recorded.problem().name()
    }

    /// The base seed.
    #[getter]
    fn seed(&self) -> u64 {
        self.recorded.problem().seed()
    }

    /// Names and units of the values of a configuration.
    #[getter]
    fn dofs(&self) -> Vec<(String, String)> {
        let space = self.recorded.context().space();
        space.dofs().iter().map(|dof| (dof.name.clone(), dof.unit.to_string())).collect()
    }

    /// Numbers of nodes, edges and components.
    #[getter]
    fn sizes(&self) -> (usize, usize, usize) {
        let roadmap = self.recorded.roadmap();
        (roadmap.configs().len(), roadmap.edges().len(), roadmap.components().count())
    }

    /// Start and goal of the problem's query, if it has one.
    #[getter]
    fn ends(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let query = self.recorded.problem().query()?;
        Some((query.start.clone(), query.goal.clone()))
    }

    /// The path that answers the problem's query, if the last judgement found one.
    #[getter]
    fn path<'py>(&self, py: Python<'py>) -> Option<FoundPath<'py>> {
        self.recorded.path().map(|path| given(py, path))
    }

    /// Looks for a path as `roadmill query` does, with `tries` shortcuts if it is to be shortened. Gives the path, or why there
    /// is none, and the number of edges that were left out because they failed the finer check.
    #[pyo3(signature = (start, goal, tries))]
    fn query<'py>(
        &self,
        py: Python<'py>,
        start: Vec<f64>,
        goal: Vec<f64>,
        tries: Option<u32>,
    ) -> PyResult<(Option<FoundPath<'py>>, Option<&'static str>, u64)> {
        let ask = || {
            self.recorded.expect_validity_function()?;
            let answer = self.recorded.query(&start, &goal);
            let mut answer = answer.map_err(Failure::usage)?;
            if let (Some(path), Some(tries)) = (&mut answer.path, tries) {
                *path = shorten(self.recorded.context(), path, tries, &mut Scratch::new());
            }
            Ok(answer)
        };
        let answer = py.detach(|| with_functions(ask));
        let answer = answer.map_err(|failed| exception(py, &failed))?.map_err(raised)?;
        let why = answer.path.is_none().then(|| answer.why_no_path());
        Ok((answer.path.as_ref().map(|path| given(py, path)), why, answer.dropped_edges))
    }

    /// The path that keeps away from obstacles best, as `roadmill query --clearest` finds it, by the highest least clearance if
    /// `widest`, else by lengths weighted with clearance; and its least and mean clearance. None if there is no path.
    #[pyo3(signature = (start, goal, widest))]
    fn clearest<'py>(
        &self,
        py: Python<'py>,
        start: Vec<f64>,
        goal: Vec<f64>,
        widest: bool,
    ) -> PyResult<Option<(FoundPath<'py>, f64, f64)>> {
        let by = if widest { Clearest::Widest } else { Clearest::Weighted };
        let ask = || {
            self.recorded.expect_validity_function()?;
            self.recorded.clearest((&start, &goal), by)
        };
        let found = py.detach(|| with_functions(ask));
        let found = found.map_err(|failed| exception(py, &failed))?.map_err(raised)?;
        Ok(found.map(|ClearPath { path, clearance }| {
            (given(py, &path), clearance.least, clearance.mean)
        }))
    }

    /// The clearances of the nodes, and of the edges the least and the mean one of each in turn, as bytes of float64.
    fn clearances<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
        let find = || {
            let of_edges = self.recorded.clearances_of_edges()?;
            let of_edges = of_edges.iter().flat_map(|along| [along.least, along.mean]);
            Ok((bytes(self.recorded.clearances_of_nodes()?), bytes(of_edges)))
        };
        let (of_nodes, of_edges) = py.detach(find).map_err(raised)?;
        Ok((PyBytes::new(py, &of_nodes), PyBytes::new(py, &of_edges)))
    }

    /// Writes the roadmap's arrays as an `.npz` file.
    fn write_npz(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        let write = || {
            let bytes = npz(self.recorded.problem(), self.recorded.roadmap())?;
            std::fs::write(&file, bytes)
        };
        let failure = |error| Failure::system(format!("{}: cannot write: {error}", file.display()));
        py.detach(write).map_err(|error: std::io::Error| raised(failure(error)))
    }
}

/// A path for Python.
fn given<'py>(py: Python<'py>, path: &Path) -> FoundPath<'py> {
    (bytes_of(py, &path.configs), path.length)
}

fn bytes_of<'py>(py: Python<'py>, configs: &Configs) -> Bound<'py, PyBytes> {
    PyBytes::new(py, &bytes(configs.values()))
}

fn bytes(numbers: impl IntoIterator<Item = f64>) -> Vec<u8> {
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}
