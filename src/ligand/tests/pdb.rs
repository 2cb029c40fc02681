//! What is taken from groups of PDB files whose lines are not as simple as most.

use super::super::{Group, read_bytes, read_group};
use super::{error, one, symbols};

/// A line of an atom: its serial number, name, letter of the alternative location, five columns of residue name and
/// chain, x and y in Å, occupancy and element.
fn line(
    serial: usize,
    name: &str,
    letter: char,
    residue: &str,
    [x, y]: [f64; 2],
    occupancy: f64,
    element: &str,
) -> String {
    format!(
        "HETATM{serial:>5} {name:<4}{letter}{residue:<5}   1    {x:8.3}{y:8.3}   0.000{occupancy:6.2} 10.00          {element:>2}\n"
    )
}

/// Acetaldehyde's two carbons and its oxygen, in a residue.
fn acetaldehyde(residue: &str) -> String {
    [
        line(1, " C1", ' ', residue, [0.0, 0.0], 1.0, "C"),
        line(2, " C2", ' ', residue, [1.5, 0.0], 1.0, "C"),
        line(3, " O1", ' ', residue, [2.2, 1.2], 1.0, "O"),
    ]
    .concat()
}

#[test]
fn lines_with_other_characters_than_ascii_are_refused() {
    let text = acetaldehyde("LIG A");
    // The prime of a nucleotide's atom as a word processor writes it, where the columns begin to shift and before.
    for (from, to, number) in
        [(" O1 ", " O5’", 3), (" C2 ", " C’2", 2), ("HETATM    1", "HETATM’   1", 1)]
    {
        let found = error(&text.replace(from, to)).to_string();
        let expected = format!(
            "line {number}: a line of an atom or a bond with `’` found; columns of ASCII expected"
        );
        assert_eq!(found, expected, "{to}");
    }
    for other in ["ATOM      9  O5’ DA  B   1\n", "CONECT    1    2 é\n"] {
        assert_eq!(error(&format!("{text}{other}")).line(), Some(4), "{other}");
    }
    assert_eq!(one(&format!("REMARK   1 AUTH   J.MÜLLER\n{text}")).atoms().len(), 3);
    let found = error(&super::ETHER.replacen(" O1 ", " O’ ", 1));
    assert_eq!(found.line(), Some(3), "{found}");
}

#[test]
fn atoms_without_the_chosen_location_have_their_most_occupied_one() {
    let text = [
        line(1, " C1", ' ', "LIG A", [0.0, 0.0], 1.0, "C"),
        line(2, " C2", ' ', "LIG A", [1.5, 0.0], 1.0, "C"),
        line(3, " O1", 'A', "LIG A", [2.2, 1.2], 0.5, "O"),
        line(4, " O1", 'B', "LIG A", [2.2, -1.2], 0.5, "O"),
        line(5, " F1", 'C', "LIG A", [-0.7, 1.2], 0.2, "F"),
        line(6, " F1", 'D', "LIG A", [-0.7, -1.2], 0.4, "F"),
        line(7, " F2", 'C', "LIG A", [-0.7, 1.2], 0.2, "F"),
        line(8, " F2", 'D', "LIG A", [-0.7, -1.2], 0.2, "F"),
    ];
    let ligand = one(&text[..6].concat());
    assert_eq!(symbols(&ligand), ["C", "C", "O", "F"]);
    let y = |ligand: &super::Ligand, atom: usize| ligand.positions().unwrap()[atom].y;
    assert_eq!((y(&ligand, 2), y(&ligand, 3)), (1.2, -1.2));
    // Of locations of equal occupancy the first is taken.
    let ligand = one(&[&text[..4], &text[6..]].concat().concat());
    assert_eq!((symbols(&ligand), y(&ligand, 3)), (vec!["C", "C", "O", "F"], 1.2));
}

#[test]
fn an_ion_with_two_locations_is_one_atom_and_no_ligand() {
    let ion = [('A', 0.6), ('B', 0.4)]
        .map(|(letter, occupancy)| line(10, "CA", letter, " CA B", [20.0, 0.0], occupancy, "CA"));
    let ligand = one(&format!("{}{}", acetaldehyde("LIG A"), ion.concat()));
    assert_eq!((ligand.name(), ligand.atoms().len()), ("LIG", 3));
    let found = error(&ion.concat()).to_string();
    assert!(found.ends_with("none of more than one atom but waters"), "{found}");
}

#[test]
fn names_of_four_letters_tell_chlorine_and_bromine() {
    for (name, element) in [
        ("CL10", "Cl"),
        ("BR12", "Br"),
        ("Cl10", "Cl"),
        ("CLA1", "C"),
        ("C123", "C"),
        ("HG11", "H"),
        ("CL1", "Cl"),
    ] {
        let text = [
            line(1, " C1", ' ', "LIG A", [0.0, 0.0], 1.0, ""),
            line(2, name, ' ', "LIG A", [1.3, 0.0], 1.0, ""),
        ];
        assert_eq!(symbols(&one(&text.concat())), ["C", element], "{name}");
    }
}

#[test]
fn each_of_many_groups_has_the_bonds_of_its_own_conect_records() {
    let groups = 1000;
    let (mut atoms, mut bonds) = (String::new(), String::new());
    for group in 0..groups {
        let [a, b] = [2 * group + 1, 2 * group + 2];
        for (serial, x) in [(a, 0.0), (b, 1.5)] {
            let number = format!("LIG A{group:>4} ");
            atoms += &line(serial, " C1", ' ', "LIG A", [x, 0.0], 1.0, "C").replacen(
                "LIG A   1 ",
                &number,
                1,
            );
        }
        bonds += &format!("CONECT{a:>5}{b:>5}\nCONECT{b:>5}{a:>5}\n");
    }
    let ligands = read_bytes(format!("{atoms}{bonds}").as_bytes()).unwrap();
    assert_eq!(ligands.len(), groups);
    assert!(ligands.iter().all(|ligand| ligand.bond_source() == super::super::BondSource::Conect));
    assert!(ligands.iter().all(|ligand| ligand.bonds().len() == 1));
}

#[test]
fn residue_names_have_four_letters_and_chains_two_where_columns_tell() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("four.pdb");
    for (columns, residue, chain) in [
        ("LIGXA", "LIGX", "A"),
        ("CA XA", "CA", "XA"),
        ("LIG A", "LIG", "A"),
        ("LIGX ", "LIGX", ""),
    ] {
        let text = acetaldehyde(columns);
        assert_eq!(one(&text).name(), residue, "{columns}");
        std::fs::write(&path, text).unwrap();
        let group = |residue: &str| Group {
            residue: residue.to_owned(),
            chain: Some(chain.to_owned()),
            ..Group::default()
        };
        assert_eq!(read_group(&path, &group(residue)).unwrap().name(), residue);
        let found = read_group(&path, &group("LI")).unwrap_err().to_string();
        assert!(found.ends_with(&format!("expected: {residue} 1 of chain `{chain}`")), "{found}");
    }
    // Waters are waters under their longer names.
    assert_eq!(one(&format!("{}{}", acetaldehyde("LIG A"), acetaldehyde("TIP3W"))).name(), "LIG");
}

#[test]
fn groups_are_chosen_by_number_and_insertion_code() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("inserted.pdb");
    let with_code = |code: &str| acetaldehyde("LIG A").replace("   1 ", &format!("   1{code}"));
    let group = |insertion| Group {
        residue: "LIG".to_owned(),
        number: Some(1),
        insertion,
        ..Group::default()
    };
    std::fs::write(&path, with_code("A")).unwrap();
    assert_eq!(read_group(&path, &group(None)).unwrap().atoms().len(), 3);
    std::fs::write(&path, format!("{}{}", with_code("A"), with_code("B"))).unwrap();
    let found = read_group(&path, &group(None)).unwrap_err().to_string();
    let expected = "(LIG 1A of chain `A`, LIG 1B of chain `A`); one expected: choose it by chain, number and insertion code";
    assert!(found.ends_with(expected), "{found}");
    assert_eq!(read_group(&path, &group(Some('B'))).unwrap().line(), Some(4));
    let found = read_group(&path, &group(Some('C'))).unwrap_err().to_string();
    assert!(found.contains("no HETATM group LIG with number 1C found"), "{found}");
}
