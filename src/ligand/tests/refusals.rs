//! What is refused, with the line and the words.

use super::super::{Atom, Bond, BondOrder, Element, Ligand, LigandFault, Point, read, read_bytes};
use super::{ACETAMIDE, ACETONE, ETHANOL, ETHANOL_V3000, ETHER, error, one};

#[test]
fn what_is_wrong_in_sdf_is_named_with_its_line() {
    for (from, to, expected) in [
        ("O   0  5", "Xx  0  5", "line 7: `Xx` as the element of atom 3 found; a chemical element"),
        ("O   0  5", "Du  0  5", "line 7: `Du` as the element of atom 3"),
        (
            "    1.5200",
            "       nan",
            "line 6: `NaN` found; a number of at most 99999 Å as a coordinate of atom 2",
        ),
        ("    1.5200", "  1e300   ", "line 6: `1"),
        ("    1.5200", "   one    ", "line 6: `one` found; a coordinate in Å expected"),
        ("  1  2  1  0\n  2  3  1  0\n", "", "line 8: "),
        (
            "  2  3  1  0",
            "  2  4  1  0",
            "line 9: atom 4 of 3 found; a bond of two different atoms",
        ),
        ("  2  3  1  0", "  2  2  1  0", "line 1: a bond of atoms 2 and 2 found"),
        ("  2  3  1  0", "  2  1  1  0", "line 1: a second bond of atoms 1 and 2 found"),
        (
            "  2  3  1  0",
            "  2  3 11  0",
            "line 9: `11` as the type of a bond found; 1 to 10 expected",
        ),
        (
            "  3  2  0",
            "  3  1  0",
            "line 1: 2 pieces that no bonds join found (2 atoms, 1 atom); one molecule",
        ),
        (
            "  3  2  0",
            "  3  0  0",
            "line 1: 3 atoms without bonds found; atoms that bonds join expected",
        ),
        ("  3  2  0", "  0  0  0", "line 1: nothing found; a molecule expected"),
        ("  3  2  0", "  x  2  0", "line 4: `x  2"),
        ("  3  2  0", "999  2  0", "line 8: "),
        ("3D", "2D", "line 2: a drawing in two dimensions found; positions in three dimensions"),
        ("    1.5200", "    0.0000", "line 1: a bond of atoms 1 and 2 less than 0.4 Å long found"),
    ] {
        let found = error(&ETHANOL.replacen(from, to, 1)).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
    let flat = ETHANOL.replace("1.5200", "0.0000").replace("2.0000    1.3500", "0.0000    0.0000");
    let found = error(&flat).to_string();
    assert_eq!(
        found,
        "line 1: one position for all atoms found; positions in three dimensions, in Å, expected"
    );
    // In a later record lines count from the file's beginning.
    let later = format!("{ETHANOL}{}", ETHANOL.replacen("    1.5200", "   one    ", 1));
    assert_eq!(error(&later).line(), Some(20));
}

#[test]
fn what_is_wrong_in_v3000_is_named_with_its_line() {
    for (from, to, expected) in [
        (
            "COUNTS 3 2",
            "COUNTS 3 99999999999999",
            "line 1: 99999999999999 bonds found; at most 4000 expected",
        ),
        (
            "COUNTS 3 2",
            "COUNTS -\nM  V30 1001 2",
            "line 1: 1001 atoms found; at most 1000 expected",
        ),
        ("COUNTS 3 2", "COUNTS 3 99999999999999999999999", "line 6: "),
        (
            "20 C 1.52",
            "20 C one",
            "line 10: a line that is no part of an SDF record (Invalid x coordinate: one)",
        ),
        ("V30 2 1 20 30", "V30 2 1 20 31", "line 15: atom 31, which is not there, found"),
        ("V30 20 C", "V30 10 C", "line "),
        (
            "COUNTS 3 2",
            "COUNTS 3 1",
            "line 15: a line that is no part of an SDF record (Expected END BOND",
        ),
        ("30 O", "30 R#", "line 11: `R#` as the element of atom 3"),
        (
            "20 C 1.52",
            "20 C nan",
            "line 9: `NaN` found; a number of at most 99999 Å as a coordinate of atom 2",
        ),
    ] {
        let found = error(&ETHANOL_V3000.replacen(from, to, 1)).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
    let twice = ETHANOL_V3000
        .replace("V30 20 C", "V30 10 C")
        .replace("10 20", "10 30")
        .replace("20 30", "10 30");
    let found = error(&twice).to_string();
    assert_eq!(found, "line 1: two atoms with the number 10 found; each number once expected");
}

#[test]
fn what_is_wrong_in_mol2_is_named_with_its_line() {
    for (from, to, expected) in [
        ("O.2 1", "Du 1", "line 12: `Du` as the element of atom O1 (3) found"),
        (
            "0.6160",
            "none",
            "line 10: `none` found; the charge of an atom, a finite number, expected",
        ),
        ("0.6200", "inf", "line 12: `inf` found; x, a finite number, expected"),
        ("0.0000 C.3 1 ACM -0.3660", "", "line 9: 4 words in the line of an atom found"),
        (" 4 N1", " 3 N1", "line 13: a second atom `3` found; each number once expected"),
        ("2 2 3 2", "2 2 9 2", "line 16: atom `9`, which is not there, found"),
        ("2 2 3 2", "2 2 3 x", "line 16: `x` as the type of a bond found"),
        ("2 2 3 2", "2 2 3", "line 16: 3 words in the line of a bond found"),
        (
            " 4 4 0",
            " 5 4 0",
            "line 2: 4 atoms found; 5, by the third line of the molecule, expected",
        ),
        (" 4 4 0", " 4 3 0", "line 2: 4 bonds found; 3, by"),
        (" 4 4 0", " four", "line 2: `four` as the numbers of atoms and bonds found"),
        ("3 2 4 am", "3 2 4 nc", "line 2: 2 pieces that no bonds join found (3 atoms, 1 atom)"),
        (
            "@<TRIPOS>MOLECULE",
            "@<TRIPOS>OTHER",
            "line 9: the section ATOM before any molecule found",
        ),
    ] {
        let found = error(&ACETAMIDE.replacen(from, to, 1)).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
}

#[test]
fn what_is_wrong_in_pdbqt_is_named_with_its_line() {
    for (from, to, expected) in [
        ("-0.380 OA", "-0.380 Q ", "line 3: `Q` as the element of atom O1 found"),
        ("0.040 C", "0.040 G0", "line 5: `G0` as the element"),
        (
            "-0.380 OA",
            "   nan OA",
            "line 3: `nan` found; the charge of an atom in columns 67 to 76",
        ),
        ("1.430   0.000", "1.4x0   0.000", "line 4: `1.4x0` found; x, a finite number, expected"),
        ("BRANCH   1   4\nHET", "BRANCH   1\nHET", "line 7: BRANCH without two numbers found"),
        ("BRANCH   1   4\nHET", "BRANCH   9   4\nHET", "line 10: ENDBRANCH 1 4 found; the end of"),
        ("ENDBRANCH   1   4", "", "line 1: BRANCH 1 4 without an end found"),
        (
            "ENDROOT\nBRANCH   1   4",
            "ENDROOT",
            "line 7: atom `C3` outside of ROOT and BRANCH found",
        ),
        ("TORSDOF 2", "ROOT", "line 11: a second ROOT found"),
        ("TORSDOF 2", "MODEL 2", "line 11: MODEL within a molecule found"),
        ("TORSDOF 2", "BEGIN_RES", "line 11: a flexible residue found; a ligand expected"),
        ("HETATM    5", "HETATM    4", "line 9: a second atom `4` found"),
        (
            "-0.480  -1.340",
            "-0.480  -9.340",
            "line 7: BRANCH 1 4 of atoms that are not near each other",
        ),
        (
            "-2.000  -1.340",
            "-9.000  -1.340",
            "line 1: 2 pieces that no bonds join found (4 atoms, 1 atom)",
        ),
        ("1.430   0.000", "0.100   0.000", "line 1: atoms 1 and 2 only 0.10 Å apart found"),
    ] {
        let found = error(&ETHER.replacen(from, to, 1)).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
    let branches = ETHER.replace("1   4", "9   4");
    let found = error(&branches).to_string();
    assert!(found.starts_with("line 7: BRANCH with atom 9, which is not there, found"), "{found}");
}

#[test]
fn what_is_wrong_in_pdb_is_named_with_its_line() {
    for (from, to, expected) in [
        ("0.00           C", "0.00          XX", "line 1: `XX` as the element of atom C1 found"),
        ("-1.290", "-1.2x0", "line 1: `-1.2x0` found; x, a finite number, expected"),
        ("-1.290", "-9.290", "line 1: "),
    ] {
        let mut text = ACETONE.replacen(from, to, 1);
        if to == "-9.290" {
            // With its records the molecule would be one, however long a bond is.
            text.truncate(text.find("CONECT").unwrap());
        }
        let found = error(&text).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
    let water: String = ACETONE.lines().skip(5).map(|line| format!("{line}\n")).collect();
    let found = error(&water).to_string();
    assert!(found.ends_with("expected: none of more than one atom but waters"), "{found}");
}

#[test]
fn what_is_no_molecule_is_named() {
    for (bytes, expected) in [
        (&b""[..], "nothing found; a molecule expected"),
        (b" \n\t\n", "nothing found"),
        (
            b"a\nb\xff",
            "line 2: byte 4 of the file, which is not UTF-8, found; text in UTF-8 expected",
        ),
        (b"a\n\0", "line 2: binary data (a byte 0) found; text in UTF-8 expected"),
        (b"\x1f\x8b\x08", "data packed by gzip found"),
        (
            b"<html>",
            "a page of HTML or XML found; a molecule in the formats SDF, MOL2, PDBQT or PDB",
        ),
        (b"{\"a\": 1}", "JSON found"),
        (b"data_1ABC\nHETATM 1 C C1", "an mmCIF file found"),
        (b"CCO ethanol", "text in another format found"),
        (b"M  END", "line 1: a header of 1 lines only found"),
        (b"@<TRIPOS>ATOM", "nothing found"),
        (b"ENDMDL\nTORSDOF 0", "line 1: a molecule without ROOT found"),
    ] {
        let found = read_bytes(bytes).unwrap_err().to_string();
        assert!(found.starts_with(expected), "{}: {found}", String::from_utf8_lossy(bytes));
    }
    let folder = tempfile::tempdir().unwrap();
    let found = read(folder.path()).unwrap_err();
    assert!(matches!(found.fault(), LigandFault::Unreadable(_)));
    assert!(found.to_string().contains("a folder found; a regular file expected"), "{found}");
    let found = read(folder.path().join("lost\u{1b}")).unwrap_err().to_string();
    assert!(found.contains("lost\\u{1b}: cannot read the molecule: No such file"), "{found}");
}

#[test]
fn ligands_of_programs_are_checked_as_well() {
    let atom = |x: f64| Atom {
        name: String::new(),
        element: Element::CARBON,
        position: Some(Point::new(x, 0.0, 0.0)),
        formal_charge: None,
        partial_charge: None,
    };
    let bond = |a, b| Bond { atoms: [a, b], order: BondOrder::Single };
    let atoms = || vec![atom(0.0), atom(1.5)];
    assert!(Ligand::new("two", atoms(), vec![bond(0, 1)]).is_ok());
    let fails = |atoms, bonds| Ligand::new("", atoms, bonds).unwrap_err().to_string();
    assert!(fails(atoms(), vec![bond(0, usize::MAX)]).starts_with("a bond of atoms 1 and"));
    assert!(fails(Vec::new(), Vec::new()).starts_with("nothing found"));
    let mut partly = atoms();
    partly[1].position = None;
    assert!(fails(partly, vec![bond(0, 1)]).starts_with("positions of 1 of 2 atoms found"));
    let mut charged = atoms();
    charged[1].partial_charge = Some(f64::NAN);
    assert!(
        fails(charged, vec![bond(0, 1)]).starts_with("`NaN` found; the partial charge of atom 2")
    );
    assert!(
        fails(vec![atom(0.0), atom(f64::INFINITY)], vec![bond(0, 1)]).starts_with("`inf` found")
    );
    let long: Vec<Atom> = (0..1000_u32).map(|x| atom(f64::from(x))).collect();
    let bonds: Vec<Bond> = (1..1000).map(|b| bond(b - 1, b)).collect();
    assert!(Ligand::new("", long.clone(), bonds.clone()).is_ok());
    let longer: Vec<Atom> = long.into_iter().chain([atom(1000.0)]).collect();
    assert_eq!(fails(longer, bonds), "1001 atoms found; at most 1000 expected");
    let many: Vec<Bond> = (0..4001).map(|_| bond(0, 1)).collect();
    assert_eq!(fails(atoms(), many), "4001 bonds found; at most 4000 expected");
}

#[test]
fn charges_of_sdf_that_are_none_are_named_with_their_lines() {
    for (text, from, to, expected) in [
        (
            ETHANOL,
            "O   0  5",
            "O   0  a",
            "line 7: `a` found; the charge of an atom, 0 to 7 in columns 37 to 39, expected",
        ),
        (ETHANOL, "O   0  5", "O   0  8", "line 7: `8` found; the charge of an atom, 0 to 7"),
        (ETHANOL, "O   0  5", "O   0 -1", "line 7: `-1` found; the charge of an atom, 0 to 7"),
        (
            ETHANOL,
            "M  END",
            "M  CHG  2   1   1   3  16\nM  END",
            "line 10: `16` found; a charge of -15 to 15 expected",
        ),
        (
            ETHANOL_V3000,
            "CHG=-1",
            "CHG=-999",
            "line 11: `-999` found; a charge of -15 to 15 expected",
        ),
        (ETHANOL_V3000, "CHG=-1", "chg=x", "line 11: `x` found; a charge of -15 to 15"),
        (ETHANOL_V3000, "CHG=-1", "CHG=-1.0", "line 11: `-1.0` found; a charge"),
        (ETHANOL_V3000, "CHG=-1", "-\nM  V30 CHG=16", "line 11: `16` found; a charge"),
    ] {
        let found = error(&text.replacen(from, to, 1)).to_string();
        assert!(found.starts_with(expected), "{from} -> {to}: {found}");
    }
    assert_eq!(
        one(&ETHANOL_V3000.replace("CHG=-1", "CHG=-15")).atoms()[2].formal_charge,
        Some(-15)
    );
    assert_eq!(one(&ETHANOL.replace("O   0  5", "O")).atoms()[2].formal_charge, Some(0));
}
