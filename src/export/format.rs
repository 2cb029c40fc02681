use crate::model::Molecule;
use crate::problem::Problem;
use crate::query::Path;
use crate::roadmap::Roadmap;
use std::fmt;

/// A roadmap to be written for other programs.
#[derive(Clone, Copy)]
pub struct Exported<'a> {
    /// The problem that it was grown for.
    pub problem: &'a Problem,
    /// The roadmap.
    pub roadmap: &'a Roadmap,
    /// The path that answers the problem's query, if there is one.
    pub path: Option<&'a Path>,
}

impl<'a> Exported<'a> {
    /// The molecule, and its conformations: those of the path, in its order, or without a path those of all nodes, in the order
    /// of their ids.
    ///
    /// # Errors
    /// The model is no molecule.
    pub(super) fn conformations(&self) -> Result<(&'a dyn Molecule, Vec<&'a [f64]>), CannotExport> {
        let Exported { problem, roadmap, path } = *self;
        let molecule = problem.model.description().molecule();
        let molecule =
            molecule.ok_or_else(|| CannotExport("this model is no molecule".to_owned()))?;
        let configs = path.map_or(roadmap.configs(), |path| &path.configs);
        Ok((molecule, configs.iter().collect()))
    }
}

/// One of the files that a format consists of.
pub struct ExportFile {
    /// What stands in the place of the extension of the name that the user gives; `None`: the name as it is.
    pub extension: Option<&'static str>,
    /// The contents.
    pub contents: Vec<u8>,
}

impl ExportFile {
    /// The file that has the name that the user gives.
    pub fn named(contents: impl Into<Vec<u8>>) -> ExportFile {
        ExportFile { extension: None, contents: contents.into() }
    }
}

/// What a format cannot write.
#[derive(Debug)]
pub struct CannotExport(pub String);

impl fmt::Display for CannotExport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for CannotExport {}

/// A format of roadmaps. The same bytes for the same roadmap.
pub trait RoadmapFormat: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// What it is for, in one line.
    fn about(&self) -> &'static str;

    /// The files.
    ///
    /// # Errors
    /// Says what about the problem cannot be written in the format.
    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport>;
}
