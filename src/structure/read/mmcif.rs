//! mmCIF, the PDBx/mmCIF dictionary's `_atom_site` (wwPDB).
//!
//! Chains and residue numbers are the authors' (`auth_asym_id`, `auth_seq_id`), as in PDB files, and those of the
//! dictionary (`label_…`) where the file has no others. Read is the first block that has atoms.

use super::super::{Point, ResidueNumber, StructureError};
use super::cif::{Row, Value, rows};
use super::elements;
use super::names::{Parents, amino_acid};
use super::site::{RawModel, Site, coordinate, expect_room};
use std::collections::BTreeMap;

/// What an mmCIF file holds.
#[derive(Debug, Default)]
pub(super) struct MmcifText {
    pub models: Vec<RawModel>,
    pub parents: Parents,
    /// What was passed over.
    pub notes: Vec<String>,
}

/// Reads the text of an mmCIF file.
pub(super) fn read(text: &str) -> Result<MmcifText, StructureError> {
    let mut mmcif = MmcifText::default();
    let mut layout: Option<(usize, Layout)> = None;
    let mut block_of_atoms = None;
    let mut places: BTreeMap<i32, usize> = BTreeMap::new();
    let mut count = 0;
    let mut has_polymers = false;
    rows(text, |row| {
        let Some((category, _)) = row.columns[0].split_once('.') else { return Ok(()) };
        if category.eq_ignore_ascii_case("_pdbx_struct_mod_residue") {
            let name = item(row, "label_comp_id").or_else(|| item(row, "auth_comp_id"));
            note_parent(&mut mmcif.parents, name, item(row, "parent_comp_id"));
        } else if category.eq_ignore_ascii_case("_chem_comp") {
            note_parent(&mut mmcif.parents, item(row, "id"), item(row, "mon_nstd_parent_comp_id"));
        }
        if !category.eq_ignore_ascii_case("_atom_site") {
            return Ok(());
        }
        if *block_of_atoms.get_or_insert(row.block) != row.block {
            let note = "atoms of further blocks are passed over".to_owned();
            if !mmcif.notes.contains(&note) {
                mmcif.notes.push(note);
            }
            return Ok(());
        }
        if layout.as_ref().is_none_or(|(table, _)| *table != row.table) {
            layout = Some((row.table, Layout::of(row)?));
        }
        let (_, layout) = layout.as_ref().expect("it has just been made");
        expect_room(count, row.line)?;
        count += 1;
        let (model, site) = layout.site(row)?;
        has_polymers |= site.in_polymer == Some(true);
        let models = &mut mmcif.models;
        let place = *places.entry(model).or_insert_with(|| {
            models.push(RawModel { number: model, sites: Vec::new() });
            models.len() - 1
        });
        models[place].sites.push(site);
        Ok(())
    })?;
    // Parents may stand behind the atoms; elements that the file lacks are guessed once they are known.
    for site in mmcif.models.iter_mut().flat_map(|model| &mut model.sites) {
        if site.element.is_empty() {
            let is_amino_acid = amino_acid(&site.residue, &mmcif.parents).is_some();
            site.element = elements::of_name(&site.name, &site.residue, is_amino_acid);
        }
        if !has_polymers {
            site.in_polymer = None;
        }
    }
    Ok(mmcif)
}

/// The value of a column of the row's category.
fn item<'a>(row: &Row<'a, '_>, name: &str) -> Option<&'a str> {
    row.values[column(row, name)?].known()
}

fn column(row: &Row, name: &str) -> Option<usize> {
    let is_named = |column: &&str| {
        column.split_once('.').is_some_and(|(_, item)| item.eq_ignore_ascii_case(name))
    };
    row.columns.iter().position(is_named)
}

fn note_parent(parents: &mut Parents, name: Option<&str>, parent: Option<&str>) {
    if let (Some(name), Some(parent)) = (name, parent) {
        parents.insert(name.to_owned(), parent.to_owned());
    }
}

/// In which columns the items of an atom are.
struct Layout {
    position: [usize; 3],
    name: usize,
    residue: usize,
    chain: Vec<usize>,
    number: Vec<usize>,
    /// The number in the polymer's sequence.
    sequence: Option<usize>,
    insertion: Option<usize>,
    letter: Option<usize>,
    element: Option<usize>,
    occupancy: Option<usize>,
    group: Option<usize>,
    model: Option<usize>,
}

impl Layout {
    fn of(row: &Row) -> Result<Layout, StructureError> {
        let of_either = |name: &str| -> Vec<usize> {
            let names = [format!("auth_{name}"), format!("label_{name}")];
            names.iter().filter_map(|name| column(row, name)).collect()
        };
        let required = |found: Option<usize>, name: &str| {
            found.ok_or_else(|| {
                let message = format!("no column `_atom_site.{name}` found; one expected");
                StructureError::line(row.line, message)
            })
        };
        let name = column(row, "label_atom_id").or_else(|| column(row, "auth_atom_id"));
        let residue = column(row, "label_comp_id").or_else(|| column(row, "auth_comp_id"));
        let position = [
            required(column(row, "Cartn_x"), "Cartn_x")?,
            required(column(row, "Cartn_y"), "Cartn_y")?,
            required(column(row, "Cartn_z"), "Cartn_z")?,
        ];
        Ok(Layout {
            position,
            name: required(name, "label_atom_id")?,
            residue: required(residue, "label_comp_id")?,
            chain: of_either("asym_id"),
            number: of_either("seq_id"),
            sequence: column(row, "label_seq_id"),
            insertion: column(row, "pdbx_PDB_ins_code"),
            letter: column(row, "label_alt_id"),
            element: column(row, "type_symbol"),
            occupancy: column(row, "occupancy"),
            group: column(row, "group_PDB"),
            model: column(row, "pdbx_PDB_model_num"),
        })
    }

    /// The atom of a row, with the number of its model.
    fn site(&self, row: &Row) -> Result<(i32, Site), StructureError> {
        let known = |column: Option<usize>| column.and_then(|column| row.values[column].known());
        let first = |columns: &[usize]| columns.iter().find_map(|column| known(Some(*column)));
        let text = |value: Value| value.text.trim().to_owned();
        let name = text(row.values[self.name]);
        let residue = text(row.values[self.residue]);
        let complain = |message: String| {
            let of = format!("atom `{name}` of residue `{residue}`");
            StructureError::line(row.line, format!("{of}: {message}"))
        };
        let whole = |found: Option<&str>, what: &str, default: i32| match found {
            None => Ok(default),
            Some(found) => found.parse::<i32>().map_err(|_| {
                complain(format!("`{found}` as {what} found; a whole number expected"))
            }),
        };
        let letter = |found: Option<&str>| found.and_then(|found| found.chars().next());
        let number = ResidueNumber {
            number: whole(first(&self.number), "the residue's number", 0)?,
            insertion: letter(known(self.insertion)),
        };
        let mut position = Point::zeros();
        for (axis, column) in self.position.into_iter().enumerate() {
            let value = row.values[column].text;
            position[axis] = coordinate(value, ['x', 'y', 'z'][axis])
                .map_err(|message| complain(format!("residue number {number}: {message}")))?;
        }
        let occupancy = known(self.occupancy).and_then(|found| found.parse::<f64>().ok());
        let model = whole(known(self.model), "the model's number", 1)?;
        let site = Site {
            line: row.line,
            element: known(self.element).and_then(elements::symbol).unwrap_or_default(),
            letter: letter(known(self.letter)),
            number,
            chain: first(&self.chain).unwrap_or_default().to_owned(),
            position,
            occupancy: occupancy.filter(|value| value.is_finite()).unwrap_or(1.0),
            is_hetero: known(self.group) == Some("HETATM"),
            in_polymer: self.sequence.map(|column| row.values[column].known().is_some()),
            name,
            residue,
        };
        Ok((model, site))
    }
}
