//! Files as they come, and as they should not.

use super::read_bytes;
use crate::structure::{Structure, StructureFormat, peptides};
use proptest::prelude::*;
use std::fmt::Write;
use std::path::Path;

fn try_read(text: &str) -> Result<Structure, String> {
    read_bytes(Path::new("x.pdb"), text.as_bytes()).map_err(|error| error.to_string())
}

#[track_caller]
fn read(text: &str) -> Structure {
    try_read(text).unwrap()
}

/// An atom's line of a PDB file.
struct Line<'a> {
    record: &'a str,
    /// Four columns.
    name: &'a str,
    letter: char,
    residue: &'a str,
    chain: char,
    number: i32,
    insertion: char,
    x: f64,
    occupancy: f64,
    element: &'a str,
}

const LINE: Line = Line {
    record: "ATOM",
    name: " CA ",
    letter: ' ',
    residue: "ALA",
    chain: 'A',
    number: 1,
    insertion: ' ',
    x: 0.0,
    occupancy: 1.0,
    element: "C",
};

impl Line<'_> {
    fn text(&self) -> String {
        let Line { record, name, letter, residue, chain, number, insertion, x, occupancy, element } =
            self;
        format!(
            "{record:<6}{:>5} {name:<4}{letter}{residue:<4}{chain}{number:>4}{insertion}   \
             {x:8.3}{:8.3}{:8.3}{occupancy:6.2}{:6.2}          {element:>2}\n",
            1, 0.0, 0.0, 10.0
        )
    }
}

/// The backbone of a residue that a peptide bond joins to those of the numbers before and after it, as lines.
fn residue(record: &str, residue: &str, chain: char, number: i32) -> String {
    let at = |offset: f64| 3.8 * f64::from(number) + offset;
    [(" N  ", 0.0, "N"), (" CA ", 1.2, "C"), (" C  ", 2.5, "C"), (" O  ", 3.2, "O")]
        .map(|(name, offset, element)| {
            Line { record, name, residue, chain, number, x: at(offset), element, ..LINE }.text()
        })
        .concat()
}

/// For each chain its name, the numbers of its residues and the names of the others.
fn shape(structure: &Structure) -> Vec<String> {
    let chain = |chain: &crate::structure::Chain| {
        let numbers: Vec<String> =
            chain.residues.iter().map(|residue| residue.number.to_string()).collect();
        let others: Vec<&str> = chain.others.iter().map(|other| other.name.as_str()).collect();
        format!("{}: {} | {}", chain.name, numbers.join(" "), others.join(" "))
    };
    structure.models[0].chains.iter().map(chain).collect()
}

#[test]
fn models_are_those_of_model_records_or_one() {
    let body = residue("ATOM", "ALA", 'A', 1);
    let numbers =
        |text: &str| -> Vec<i32> { read(text).models.iter().map(|model| model.number).collect() };
    assert_eq!(numbers(&body), [1]);
    assert_eq!(numbers(&format!("MODEL        3\n{body}ENDMDL\nMODEL 5\n{body}ENDMDL\n")), [3, 5]);
    // A model ends where the next one begins.
    assert_eq!(numbers(&format!("MODEL\n{body}MODEL\n{body}END\n")), [1, 2]);
    let outside = format!("MODEL 1\n{body}ENDMDL\n{body}");
    assert!(try_read(&outside).unwrap_err().starts_with(":7: an atom outside all models"));
    let late = format!("{body}MODEL 1\n{body}");
    assert!(try_read(&late).unwrap_err().starts_with(":5: MODEL after atoms"));
    let ended = read(&format!("{body}END\n{body}"));
    assert_eq!(ended.counts[0].atoms, 4);
    assert_eq!(ended.notes, ["line 6: atoms after END are passed over"]);
}

#[test]
fn calcium_and_water_within_a_chain_are_no_residues_of_it() {
    let calcium = Line {
        record: "HETATM",
        name: "CA  ",
        residue: " CA",
        number: 5,
        x: 90.0,
        element: "CA",
        ..LINE
    };
    let water = Line { record: "HETATM", name: " O  ", residue: "HOH", number: 3, x: 95.0, ..LINE };
    let text = [
        residue("ATOM", "ALA", 'A', 1),
        water.text(),
        calcium.text(),
        residue("ATOM", "GLY", 'A', 2),
    ]
    .concat();
    let structure = read(&text);
    assert_eq!(shape(&structure), ["A: 1 2 | HOH CA"]);
    assert_eq!(structure.models[0].chains[0].others[1].atoms[0].element, "Ca");
    // Without the column of elements the name's own columns tell it.
    let without = text.lines().map(|line| format!("{}\n", &line[..54])).collect::<String>();
    let structure = read(&without);
    assert_eq!(structure.models[0].chains[0].others[1].atoms[0].element, "Ca");
    assert_eq!(structure.models[0].chains[0].residues[0].atoms[1].element, "C");
}

#[test]
fn modified_residues_stand_in_the_chain_and_free_amino_acids_do_not() {
    let body = |residues: &[(&str, &str, i32)]| -> String {
        residues.iter().map(|(record, name, number)| residue(record, name, 'A', *number)).collect()
    };
    // A peptide bond joins it, no record ends the chain.
    let joined = body(&[("ATOM", "ALA", 1), ("HETATM", "CSO", 2), ("ATOM", "ALA", 3)]);
    let structure = read(&joined);
    assert_eq!(shape(&structure), ["A: 1 2 3 | "]);
    let chain = &structure.models[0].chains[0];
    assert_eq!((chain.sequence().as_str(), chain.residues[1].name.as_str()), ("ACA", "CSO"));
    // Far from the chain, it is a ligand, unless it stands before the end of the chain.
    let far = body(&[("ATOM", "ALA", 1), ("HETATM", "MSE", 30)]);
    assert_eq!(shape(&read(&far)), ["A: 1 | MSE"]);
    assert_eq!(shape(&read(&format!("{far}TER\n"))), ["A: 1 30 | "]);
    let ligand = format!("{}TER\n{}", body(&[("ATOM", "ALA", 1)]), body(&[("HETATM", "GLY", 30)]));
    assert_eq!(shape(&read(&ligand)), ["A: 1 | GLY"]);
    // Two that a peptide bond joins, behind the end of the chain: a ligand too.
    let dipeptide = body(&[("HETATM", "MSE", 30), ("HETATM", "CSO", 31)]);
    assert_eq!(shape(&read(&dipeptide)), ["A: 30 31 | "]);
    let ended = format!("{}TER\n{dipeptide}", body(&[("ATOM", "ALA", 1)]));
    assert_eq!(shape(&read(&ended)), ["A: 1 | MSE CSO"]);
    // Every model has its own ends, and a second TER ends a second part.
    let models = format!("MODEL 1\n{ended}ENDMDL\nMODEL 2\n{dipeptide}ENDMDL\n");
    let chains = &read(&models).models[1].chains;
    assert_eq!(chains[0].residues.len(), 2);
    assert_eq!(shape(&read(&format!("{ended}TER\n"))), ["A: 1 30 31 | "]);
    // The file knows parents that nobody else does.
    let own = body(&[("ATOM", "ALA", 1), ("HETATM", "XYZ", 2)]);
    assert_eq!(shape(&read(&own)), ["A: 1 | XYZ"]);
    let modres = format!("MODRES 1ABC XYZ A    2  TRP  SOMETHING\n{own}");
    assert_eq!(shape(&read(&modres)), ["A: 1 2 | "]);
}

#[test]
fn of_alternatives_the_likelier_conformer_is_taken_whole() {
    let alternative = |name: &'static str, letter, x, occupancy| {
        Line { name, letter, x, occupancy, ..LINE }.text()
    };
    let text = [
        alternative(" CA ", ' ', 0.0, 1.0),
        alternative(" CB ", 'A', 1.5, 0.4),
        alternative(" CB ", 'B', 1.7, 0.6),
        alternative(" OG ", 'A', 3.0, 0.5),
        alternative(" OG ", 'B', 3.2, 0.5),
        alternative(" HG ", 'A', 4.0, 0.1),
    ]
    .concat();
    let structure = read(&text);
    assert_eq!(structure.counts[0].atoms, 6);
    let found = &structure.alternatives[0];
    assert_eq!((found.chosen, found.letters.len()), ('B', 2));
    let residue = &structure.models[0].chains[0].residues[0];
    let xs: Vec<f64> = residue.atoms.iter().map(|atom| atom.position.x).collect();
    assert_eq!(xs, [0.0, 1.7, 3.2]);
}

#[test]
fn alternatives_may_be_other_residues_stand_elsewhere_or_have_lost_their_letters() {
    let at = |name: &'static str, residue: &'static str, letter, x, occupancy| {
        Line { name, residue, letter, x, occupancy, ..LINE }.text()
    };
    let other_names = [at(" CA ", "SER", 'A', 0.0, 0.3), at(" CA ", "THR", 'B', 0.1, 0.7)].concat();
    let structure = read(&other_names);
    let residue = &structure.models[0].chains[0].residues;
    assert_eq!((residue.len(), residue[0].name.as_str()), (1, "THR"));
    assert_eq!(structure.counts[0].residues, 2);
    let elsewhere = [
        at(" CA ", "SER", 'A', 0.0, 0.3),
        Line { number: 2, x: 4.0, ..LINE }.text(),
        at(" CA ", "SER", 'B', 0.1, 0.7),
    ]
    .concat();
    let structure = read(&elsewhere);
    assert_eq!(
        (shape(&structure), structure.counts[0].residues),
        (vec!["A: 1 2 | ".to_owned()], 2)
    );
    assert_eq!(structure.models[0].chains[0].residues[0].atoms[0].position.x, 0.1);
    let without = [at(" CA ", "SER", ' ', 0.0, 0.5), at(" CA ", "SER", ' ', 0.1, 0.5)].concat();
    let structure = read(&without);
    assert_eq!(structure.alternatives[0].chosen, 'A');
    assert_eq!(structure.models[0].chains[0].residues[0].atoms.len(), 1);
}

#[test]
fn chains_without_names_begin_anew_where_numbers_do() {
    let body = |shift: f64| -> String {
        let line = |number: i32| {
            let x = 3.8 * f64::from(number) + shift;
            Line { chain: ' ', number, x, ..LINE }.text()
        };
        (1..=3).map(line).collect()
    };
    assert_eq!(shape(&read(&(body(0.0) + &body(50.0)))), [": 1 2 3 | ", ": 1 2 3 | "]);
    // Segments are names where chains have none.
    let with_segment: String =
        body(0.0).lines().map(|line| format!("{}  PROA{}\n", &line[..70], &line[76..])).collect();
    assert_eq!(shape(&read(&with_segment)), ["PROA: 1 2 3 | "]);
}

#[test]
fn insertion_codes_tell_residues_apart() {
    let line = |insertion, x| Line { number: 52, insertion, x, ..LINE }.text();
    let text = [line(' ', 0.0), line('A', 4.0), line('B', 8.0)].concat();
    assert_eq!(shape(&read(&text)), ["A: 52 52A 52B | "]);
}

#[test]
fn names_with_four_letters_and_lines_that_end_early_are_read() {
    let water = "ATOM      1  OH2 TIP3W   1      10.000   0.000   0.000\n";
    assert_eq!(shape(&read(water)), ["W:  | TIP3"]);
    let two_letters = "ATOM      1  CA  ALAAB   1      10.000   0.000   0.000\n";
    assert_eq!(shape(&read(two_letters)), ["AB: 1 | "]);
    // The names by which GROMACS and AMBER tell protonation states: the fourth letter is none of the chain's.
    for name in [
        "HISA", "HISB", "HISD", "HISE", "HISH", "CYSH", "CYS2", "ASPH", "ASPP", "GLUH", "GLUP",
        "LYSH",
    ] {
        for chain in ['A', ' '] {
            let ring = format!("ATOM      1  CA  {name}{chain}   1      10.000   0.000   0.000\n");
            let structure = read(&ring);
            let found = &structure.models[0].chains[0];
            assert_eq!(
                (found.name.as_str(), &*found.residues[0].name),
                (format!("{chain}").trim(), name)
            );
        }
    }
    // In a file whose chains have two letters, as another residue shows, it is.
    let histidine = "ATOM      1  CA  HISEA   1      10.000   0.000   0.000\n";
    let alanine = "ATOM      1  CA  ALAEA   2      13.800   0.000   0.000\n";
    let hydroxyl = "HETATM    1  O   HOHEA   3      33.800   0.000   0.000\n";
    let both = format!("{histidine}{alanine}{hydroxyl}");
    assert_eq!(shape(&read(&both)), ["EA: 1 2 | HOH"]);
    assert_eq!(shape(&read(histidine)), ["A: 1 | "]);
    let beyond_ascii = "REMARK  Würfel\nATOM      1  CA  ALA é   1      10.000   0.000   0.000\n";
    assert_eq!(shape(&read(beyond_ascii)), ["é: 1 | "]);
}

/// A small mmCIF with two models, an inserted residue, a modified one, alternatives and an ion.
const MMCIF: &str = "data_TEST\n#\nloop_\n_chem_comp.id\n_chem_comp.mon_nstd_parent_comp_id\n'XYZ' TRP\n#\nloop_\n\
    _atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_alt_id\n\
    _atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.pdbx_PDB_ins_code\n\
    _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.auth_seq_id\n\
    _atom_site.auth_asym_id\n_atom_site.pdbx_PDB_model_num\n\
    ATOM   1 N  N  . ALA A 1 ? 0.0 0.0 0.0 1.0 5 L 1\n\
    ATOM   2 C  CA A ALA A 1 ? 1.4 0.0 0.0 0.4 5 L 1\n\
    ATOM   3 C  CA B ALA A 1 ? 1.5 0.0 0.0 0.6 5 L 1\n\
    HETATM 4 N  N  . XYZ A 2 A 3.8 0.0 0.0 1.0 5 L 1\n\
    HETATM 5 CA CA . CA  B . ? 9.0 0.0 0.0 1.0 9 L 1\n\
    HETATM 6 O  \"O'\" . LIG C . ? 12.0 0.0 0.0\n 1.0 9 M 1\n\
    ATOM   7 N  N  . ALA A 1 ? 0.0 0.0 0.0 1.0 5 L 2\n#\n";

#[test]
fn mmcif_has_models_chains_of_the_authors_and_rows_of_any_lines() {
    let structure = read(MMCIF);
    assert_eq!(structure.format, StructureFormat::Mmcif);
    assert_eq!(structure.models.iter().map(|model| model.number).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(shape(&structure), ["L: 5 5A | CA", "M:  | LIG"]);
    let chain = &structure.models[0].chains[0];
    assert_eq!(
        (chain.sequence().as_str(), chain.others[0].atoms[0].element.as_str()),
        ("AW", "Ca")
    );
    assert_eq!(structure.models[0].chains[1].others[0].atoms[0].name, "O'");
    assert_eq!(structure.alternatives[0].chosen, 'B');
    assert_eq!((structure.counts[0].atoms, structure.counts[0].residues), (6, 4));
}

#[test]
fn what_is_no_structure_is_refused_with_what_it_is() {
    for (text, error) in [
        ("<!DOCTYPE html>\n<html>", ":1: a page of HTML or XML found"),
        ("\n{\"a\": 1}", ":2: JSON found"),
        ("", "nothing found"),
        ("REMARK nothing\n", "no atoms found"),
        ("data_x\n_cell.length_a 1.0\n", "no atoms found"),
        ("\x1f\u{8b}", "a"),
        ("REMARK\nROOT\n", ":2: a ligand in the PDBQT format"),
    ] {
        let found = try_read(text).unwrap_err();
        assert!(found.contains(error), "{found}");
    }
    let packed = read_bytes(Path::new("x"), b"\x1f\x8b\x08").unwrap_err().to_string();
    assert!(packed.contains("packed by gzip"), "{packed}");
    assert!(read_bytes(Path::new("x"), b"AT\0M").unwrap_err().to_string().contains("binary"));
}

#[test]
fn atoms_that_cannot_be_are_named_with_line_residue_and_atom() {
    let good = residue("ATOM", "ALA", 'A', 1);
    let bad = |from: &str, to: &str| {
        assert_eq!(good.matches(from).count(), 1, "{from}");
        try_read(&good.replace(from, to)).unwrap_err()
    };
    for (value, shown) in [
        ("     nan", "`nan` as x found"),
        ("     inf", "`inf` as x found"),
        ("********", "`********` as x found"),
        ("  1e9   ", "`1e9` as x found; a number of at most 99999 Å expected"),
    ] {
        let error = bad("   5.000", value);
        assert!(error.starts_with(":2: atom `CA` of residue `ALA`: residue number 1:"), "{error}");
        assert!(error.contains(shown), "{error}");
    }
    let cut = &good[..good.find("   5.000").unwrap() + 12];
    let error = try_read(cut).unwrap_err();
    assert!(
        error.contains(":2: atom `CA` of residue `ALA`: a line that ends after 42 columns"),
        "{error}"
    );
    let error = try_read(&good.replace("A   1 ", "A  x1 ")).unwrap_err();
    assert!(error.contains("`x1` as the residue's number found"), "{error}");
    let twice = format!("{good}{}", Line { x: 7.0, ..LINE }.text());
    let error = try_read(&twice).unwrap_err();
    assert!(error.starts_with(":5: atom CA of ALA 1 in chain `A`"), "{error}");
    let upon = format!("{good}{}", Line { x: 5.3, number: 2, ..LINE }.text());
    assert_eq!(
        try_read(&upon).unwrap_err(),
        ":5: atom CA of ALA 2 in chain `A` found 0.300 Å from atom CA of ALA 1 in chain `A` (line 2); at least 0.5 Å \
         expected"
    );
    let mmcif = try_read(&MMCIF.replace("1.4 0.0", "1.4 x")).unwrap_err();
    assert!(
        mmcif.starts_with(":26: atom `CA` of residue `ALA`: residue number 5: `x` as y"),
        "{mmcif}"
    );
    let without = try_read(&MMCIF.replace("Cartn_x", "Cartn_q")).unwrap_err();
    assert!(without.contains("no column `_atom_site.Cartn_x` found"), "{without}");
}

#[test]
fn files_of_a_million_atoms_are_refused_at_a_line() {
    let mut text = String::new();
    for number in 0..1_000_000 {
        let _ = writeln!(
            text,
            "ATOM      1  O   HOH A{:>4}    {:8.3}{:8.3}{:8.3}",
            number % 10_000,
            f64::from(number % 100),
            f64::from(number / 100 % 100),
            f64::from(number / 10_000)
        );
    }
    let error = try_read(&text).unwrap_err();
    assert!(error.starts_with(":500001: more than 500000 atoms found"), "{error}");
}

#[test]
fn heaps_of_models_names_and_letters_take_no_long_time() {
    let lines = |line: &dyn Fn(u32) -> String| -> String { (0..40_000).map(line).collect() };
    // Were each compared with all others, these would take minutes.
    let models = lines(&|_| "MODEL 1\n".to_owned());
    assert!(try_read(&models).unwrap_err().starts_with("no atoms"));
    let atom = |name: u32, letter, residue: &str, number: u32| {
        format!(
            "ATOM      1 {name:0>4}{letter}{residue} A{number:>4}       0.000   0.000   0.000\n"
        )
    };
    let names = lines(&|line| atom(line % 10_000, ' ', "ALA", 1));
    assert!(try_read(&names).unwrap_err().contains("more than 1000 atoms of one amino acid"));
    let letters =
        lines(&|line| atom(line % 10_000, char::from_u32(0x4e00 + line).unwrap_or('A'), "XYZ", 1));
    assert_eq!(read(&letters).models[0].chains[0].others[0].atoms.len(), 40_000);
    let parts = lines(&|line| atom(line % 10_000, ' ', "XYZ", 1 + line % 2));
    assert_eq!(read(&parts).counts[0].atoms, 40_000);
}

#[test]
fn gaps_are_where_no_peptide_bond_is() {
    let text = [1, 2, 4].map(|number| residue("ATOM", "ALA", 'A', number)).concat();
    let gaps = peptides::gaps(&read(&text).models[0].chains[0].residues);
    assert_eq!(gaps.iter().map(|gap| gap.before).collect::<Vec<_>>(), [1]);
}

/// A small file of either format, and changes to its bytes: places and new values.
fn mutated() -> impl Strategy<Value = Vec<u8>> {
    let pdb = [
        "MODEL        1\n".to_owned(),
        residue("ATOM", "ALA", 'A', 1),
        residue("HETATM", "CSO", 'A', 2),
        Line { letter: 'A', number: 3, x: 20.0, occupancy: 0.5, ..LINE }.text(),
        Line { letter: 'B', number: 3, x: 21.0, occupancy: 0.5, ..LINE }.text(),
        "TER\nENDMDL\nEND\n".to_owned(),
    ]
    .concat();
    let texts = prop_oneof![Just(pdb.into_bytes()), Just(MMCIF.as_bytes().to_vec())];
    let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..8);
    (texts, changes).prop_map(|(mut text, changes)| {
        for (place, byte, kind) in changes {
            let place = place.index(text.len().max(1)).min(text.len());
            match kind {
                0 if !text.is_empty() => drop(text.remove(place.min(text.len() - 1))),
                1 => text.insert(place, byte),
                2 => text.truncate(place.max(text.len() / 2)),
                _ if !text.is_empty() => {
                    let place = place.min(text.len() - 1);
                    // Mostly what such files are made of.
                    text[place] =
                        if byte < 200 { b" .0A1-'\n?;_#\""[usize::from(byte) % 13] } else { byte };
                }
                _ => {}
            }
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in mutated()) {
        if let Ok(structure) = read_bytes(Path::new("x"), &bytes) {
            prop_assert!(!structure.models.is_empty());
        }
    }
}
