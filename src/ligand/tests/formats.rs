//! What is taken from files of each format.

use super::super::{BondOrder, BondSource, Element, Group, read, read_all, read_bytes, read_group};
use super::{ACETAMIDE, ACETONE, ETHANOL, ETHANOL_V3000, ETHER, links, one, sorted_bonds, symbols};

#[test]
fn sdf_of_both_versions_is_read_alike() {
    let old = one(ETHANOL);
    assert_eq!(
        (old.name(), old.line(), old.bond_source()),
        ("ethanol", Some(1), BondSource::Format)
    );
    assert_eq!(symbols(&old), ["C", "C", "O"]);
    assert_eq!(old.atoms()[2].formal_charge, Some(-1));
    assert_eq!(old.positions().unwrap()[2], super::super::Point::new(2.0, 1.35, 0.0));
    assert_eq!(old, one(ETHANOL_V3000));
    // Line ends of other systems, a mark at the beginning, and a file without its last line.
    let others = [
        ETHANOL.replace('\n', "\r\n"),
        ETHANOL.replace('\n', "\r"),
        format!("\u{feff}{ETHANOL}"),
        ETHANOL.replace("$$$$\n", ""),
        ETHANOL.split_inclusive("M  END").next().unwrap().to_owned(),
    ];
    for text in others {
        assert_eq!(old, one(&text));
    }
}

#[test]
fn charges_of_the_property_block_replace_those_of_atoms() {
    let text = ETHANOL.replace("M  END", "M  CHG  1   1   1\nM  END");
    let charges: Vec<_> = one(&text).atoms().iter().map(|atom| atom.formal_charge).collect();
    assert_eq!(charges, [Some(1), Some(0), Some(0)]);
}

#[test]
fn several_molecules_are_read_with_their_names_and_lines() {
    let second = ETHANOL.replacen("ethanol", "another", 1);
    let text = format!("{ETHANOL}{second}{ETHANOL_V3000}\n\n");
    let ligands = read_bytes(text.as_bytes()).unwrap();
    let found: Vec<_> = ligands.iter().map(|ligand| (ligand.name(), ligand.line())).collect();
    assert_eq!(found, [("ethanol", Some(1)), ("another", Some(15)), ("ethanol", Some(29))]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.sdf");
    std::fs::write(&path, format!("{ETHANOL}{second}")).unwrap();
    let error = read(&path).unwrap_err();
    assert_eq!(error.path(), Some(path.as_path()));
    let expected = "2 molecules found (ethanol at line 1, another at line 15); one expected: read all of \
                    them, or write one into a file of its own";
    assert!(error.to_string().ends_with(expected), "{error}");
    assert_eq!(read_all(&path).unwrap().len(), 2);
    std::fs::write(&path, ETHANOL).unwrap();
    assert_eq!(read(&path).unwrap(), one(ETHANOL));
}

#[test]
fn mol2_has_names_partial_charges_and_bonds_that_are_none() {
    let ligand = one(ACETAMIDE);
    assert_eq!((ligand.name(), ligand.line()), ("acet amide", Some(2)));
    assert_eq!(symbols(&ligand), ["C", "C", "O", "N"]);
    assert_eq!(ligand.atoms()[3].name, "N1");
    assert_eq!(ligand.atoms()[1].partial_charge, Some(0.616));
    assert_eq!(ligand.atoms()[1].formal_charge, None);
    let orders: Vec<_> = ligand.bonds().iter().map(|bond| bond.order).collect();
    assert_eq!(orders, [BondOrder::Single, BondOrder::Double, BondOrder::Single]);
    let uncharged = ACETAMIDE.replace("USER_CHARGES", "NO_CHARGES");
    assert!(one(&uncharged).atoms().iter().all(|atom| atom.partial_charge.is_none()));
    let unknown = ACETAMIDE.replace("2 4 am", "2 4 un");
    assert_eq!(one(&unknown).bonds()[2].order, BondOrder::Unknown);
    let two = read_bytes(format!("{ACETAMIDE}{ACETAMIDE}").as_bytes()).unwrap();
    assert_eq!((two.len(), two[1].line()), (2, Some(22)));
    // A molecule without a name has a blank line for it.
    assert_eq!(one(&ACETAMIDE.replace("acet amide", "")).name(), "");
}

#[test]
fn pdbqt_has_types_charges_and_single_bonds_at_branches() {
    let ligand = one(ETHER);
    assert_eq!((ligand.name(), ligand.line()), ("ether", Some(1)));
    assert_eq!(symbols(&ligand), ["O", "C", "C", "C", "C"]);
    assert_eq!(ligand.atoms()[2].partial_charge, Some(0.04));
    assert_eq!(sorted_bonds(&ligand), [[0, 1], [0, 3], [1, 2], [3, 4]]);
    assert_eq!(ligand.bonds()[1].order, BondOrder::Single);
    assert_eq!(ligand.bonds()[0].order, BondOrder::Unknown);
    assert_eq!((links(&ligand), ligand.bond_source()), ((2, 2), BondSource::Distances));
    let models = format!("MODEL 1\n{ETHER}ENDMDL\nMODEL 2\n{ETHER}ENDMDL\n");
    let poses = read_bytes(models.as_bytes()).unwrap();
    assert_eq!(poses.iter().map(super::Ligand::line).collect::<Vec<_>>(), [Some(1), Some(14)]);
    // AutoDock's own types: aromatic, hydrogen bonds, and where a macrocycle was opened.
    let types = ETHER.replace("0.040 C", "0.040 A").replace("-0.380 OA", "-0.380 NA");
    assert_eq!(symbols(&one(&types)), ["N", "C", "C", "C", "C"]);
    assert_eq!(symbols(&one(&ETHER.replace("0.100 C", "0.100 CG0"))), symbols(&ligand));
}

#[test]
fn groups_of_pdb_files_have_conect_records_or_distances() {
    let ligand = one(ACETONE);
    assert_eq!((ligand.name(), ligand.line()), ("ACN", Some(1)));
    // Of the alternative locations that with the larger occupancy.
    assert_eq!(ligand.positions().unwrap()[2].z, 0.1);
    assert_eq!(ligand.atoms()[3].formal_charge, Some(-1));
    assert_eq!(ligand.bond_source(), BondSource::Conect);
    let orders: Vec<_> = ligand.bonds().iter().map(|bond| (bond.atoms, bond.order)).collect();
    let (single, double) = (BondOrder::Single, BondOrder::Double);
    assert_eq!(orders, [([0, 1], single), ([1, 2], single), ([1, 3], double)]);
    // Records that list every bond twice tell no orders; records that do not join all atoms are not taken.
    let twice = ACETONE
        .replace("2    1    4    5    5", "2    1    1    4    4")
        .replace("CONECT    4    2\n", "CONECT    4    2\nCONECT    2    5    5\n");
    let ligand_twice = one(&twice);
    assert_eq!(ligand_twice.bond_source(), BondSource::Conect);
    assert!(ligand_twice.bonds().iter().all(|bond| bond.order == BondOrder::Unknown));
    let partly = ACETONE.replace("CONECT    1    2\nCONECT    2    1    4    5    5\n", "");
    let perceived = one(&partly);
    assert_eq!(perceived.bond_source(), BondSource::Distances);
    assert_eq!(sorted_bonds(&perceived), sorted_bonds(&ligand));
    // Without the columns of elements, names tell them.
    let narrow: Vec<&str> = ACETONE.lines().map(|line| line.get(..66).unwrap_or(line)).collect();
    assert_eq!(symbols(&one(&narrow.join("\n"))), ["C", "C", "C", "O"]);
}

#[test]
fn groups_are_chosen_by_name_chain_and_number() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.pdb");
    let other: String = ACETONE
        .lines()
        .filter(|line| line.contains("ACN"))
        .map(|line| {
            format!("{}\n", line.replace(" A   1", " B   7").replacen("HETATM   ", "HETATM  1", 1))
        })
        .collect();
    std::fs::write(&path, format!("{other}{ACETONE}")).unwrap();
    let group = |residue: &str, chain: Option<&str>, number| Group {
        residue: residue.to_owned(),
        chain: chain.map(str::to_owned),
        number,
        insertion: None,
    };
    let error = read(&path).unwrap_err().to_string();
    assert!(
        error.contains("2 molecules found (ACN at line 1, ACN at line 6); one expected"),
        "{error}"
    );
    let error = read_group(&path, &group("ACN", None, None)).unwrap_err().to_string();
    assert!(error.contains("(ACN 7 of chain `B`, ACN 1 of chain `A`); one expected"), "{error}");
    let chosen = read_group(&path, &group("ACN", Some("A"), None)).unwrap();
    assert_eq!((chosen.line(), chosen.bond_source()), (Some(6), BondSource::Conect));
    let chosen = read_group(&path, &group("ACN", None, Some(7))).unwrap();
    assert_eq!((chosen.line(), chosen.bond_source()), (Some(1), BondSource::Distances));
    let error = read_group(&path, &group("XYZ", Some("A"), Some(2))).unwrap_err().to_string();
    let expected = "no HETATM group XYZ of chain `A` with number 2 found; one of the file's expected: ACN 7 \
                    of chain `B`, ACN 1 of chain `A`";
    assert!(error.ends_with(expected), "{error}");
    let error = read_group(&path, &group("CA", Some("A"), None)).unwrap_err().to_string();
    assert!(
        error.ends_with(":12: 1 atom without bonds found; atoms that bonds join expected"),
        "{error}"
    );
    let error = read_group(&path, &group("HOH", None, None)).unwrap_err().to_string();
    let expected = "water found (HOH, 1 of it); another HETATM group of the file expected: ACN 7 of chain `B`, ACN 1 of chain `A`";
    assert!(error.ends_with(expected), "{error}");
    // A name of water that the file does not have is not there, and no more is said.
    let error = read_group(&path, &group("WAT", None, None)).unwrap_err().to_string();
    assert!(error.contains("no HETATM group WAT found; one of the file's expected"), "{error}");
    std::fs::write(&path, ETHANOL).unwrap();
    let error = read_group(&path, &group("ACN", None, None)).unwrap_err().to_string();
    assert!(error.ends_with("a PDB file, as a group is named, expected"), "{error}");
}

#[test]
fn elements_have_symbols_numbers_and_radii() {
    for (symbol, number, radius) in
        [("c", 6, 0.76), ("CL", 17, 1.02), ("D", 1, 0.31), ("Cm", 96, 1.69)]
    {
        let element = Element::of_symbol(symbol).unwrap();
        assert_eq!((element.number(), element.covalent_radius()), (number, radius), "{symbol}");
    }
    for number in 1..=96 {
        let known = (b'A'..=b'Z').flat_map(|first| {
            let one = char::from(first).to_string();
            let two = (b'a'..=b'z')
                .map(move |second| format!("{}{}", char::from(first), char::from(second)));
            std::iter::once(one).chain(two)
        });
        let of_number = known.filter_map(|symbol| {
            Element::of_symbol(&symbol)
                .filter(|element| element.number() == number && element.symbol() == symbol)
        });
        assert_eq!(of_number.count(), 1, "{number}");
    }
    for symbol in ["", "Du", "LP", "R#", "*", "Bk", "X"] {
        assert_eq!(Element::of_symbol(symbol), None, "{symbol}");
    }
}

#[test]
fn models_of_pdbqt_have_names_of_their_own() {
    let names = |text: &str| -> Vec<String> {
        read_bytes(text.as_bytes()).unwrap().iter().map(|ligand| ligand.name().to_owned()).collect()
    };
    let unnamed = ETHER.replace("REMARK  Name = ether\n", "");
    let other = unnamed.replace("UNL", "BBB");
    let models = |first: &str| format!("MODEL 1\n{first}ENDMDL\nMODEL 2\n{other}ENDMDL\n");
    assert_eq!(names(&models(&unnamed)), ["UNL", "BBB"]);
    assert_eq!(names(&models(ETHER)), ["ether", "BBB"]);
    // A name before the first model is that of all that have none.
    assert_eq!(names(&format!("REMARK  Name = all\n{}", models(ETHER))), ["ether", "all"]);
}

#[test]
fn names_of_mol2_may_begin_with_the_sign_of_comments() {
    assert_eq!(one(&ACETAMIDE.replace("acet amide", "#12 lead")).name(), "#12 lead");
}

#[test]
fn single_lines_do_not_hide_the_format() {
    // A data item like a record of PDBQT, in a file that does not tell its version.
    let text = ETHANOL.replace("0999 V2000", "").replace("$$ no end", "ROOT of plants");
    assert_eq!(one(&text).name(), "ethanol");
    // A remark with the word of an SDF file's fourth line.
    let remarks = "HEADER    X\nTITLE     A\nREMARK  1\nREMARK  V2000 converted\n";
    assert_eq!(one(&format!("{remarks}{ACETONE}")).name(), "ACN");
}
