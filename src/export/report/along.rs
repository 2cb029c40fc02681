//! What is measured along every path, frame by frame.

use super::Report;
use super::order::OrderParameters;
use crate::model::Scratch;
use crate::pathways::{FrameTable, Pathway};

/// A table of numbers along a path, with a row for every frame.
pub(super) struct Along {
    pub table: FrameTable,
    /// Which columns are energies.
    pub energies: std::ops::Range<usize>,
}

impl Along {
    /// The tables of all paths: of a molecule [`FrameTable`]s; of other models the length, the energy if there is one, and the
    /// distances from both ends.
    pub fn all(report: &Report, scratch: &mut Scratch) -> Vec<Along> {
        let pathways = &report.pathways.pathways;
        pathways.iter().map(|pathway| Along::of(report, pathway, scratch)).collect()
    }

    fn of(report: &Report, pathway: &Pathway, scratch: &mut Scratch) -> Along {
        let description = report.problem.model.description();
        if let Some(molecule) = description.molecule() {
            let table = FrameTable::of(molecule, &pathway.frames, report.angles);
            return Along { table, energies: 4..4 + molecule.energies().columns.len() };
        }
        let mut columns = vec!["frame".to_owned(), "length".to_owned()];
        let energy = description.node_values().iter().find(|value| value.name == "energy");
        columns.extend(energy.map(|value| format!("energy [{}]", value.unit)));
        let energies = 2..columns.len();
        let parameters = OrderParameters::of(report, scratch);
        columns.extend(["distance_start", "distance_goal"].map(str::to_owned));
        let rows = (0..pathway.frames.len()).map(|index| {
            let q = pathway.frames.configs.get(index);
            let mut row = vec![(index + 1) as f64, pathway.frames.lengths[index]];
            if !energies.is_empty() {
                row.push(report.cx.model.energy(q, scratch).unwrap_or(f64::NAN));
            }
            row.extend(parameters.at(q, scratch));
            row
        });
        let rows = rows.collect();
        Along { table: FrameTable { columns, rows, contacts: Vec::new() }, energies }
    }

    /// The index of the column of a name, or of a name with a unit behind it.
    pub fn column(&self, name: &str) -> Option<usize> {
        let is_it = |column: &String| {
            column.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(" ["))
        };
        self.table.columns.iter().position(is_it)
    }

    /// The values of a column over the length of the path.
    pub fn points(&self, column: usize) -> Vec<[f64; 2]> {
        let length = self.column("length").expect("every table has the length");
        self.table.rows.iter().map(|row| [row[length], row[column]]).collect()
    }
}
