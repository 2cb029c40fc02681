//! What is written is read again, by the library and by RDKit.

use super::super::{Atom, Bond, BondSource, Element, Group, from_smiles, read_bytes, read_group};
use super::*;
use crate::ligand::BondOrder;
use proptest::prelude::*;
use std::process::Command;

fn element(symbol: &str) -> Element {
    Element::of_symbol(symbol).unwrap()
}

/// A chain of atoms 1.5 Å apart, of these elements and charges, with bonds of these orders.
fn chain(elements: &[&str], charges: &[i8], orders: &[BondOrder]) -> Ligand {
    let atom = |(number, symbol): (usize, &&str)| Atom {
        name: String::new(),
        element: element(symbol),
        position: Some(Point::new(1.5 * number as f64, 0.25, -0.125)),
        formal_charge: Some(charges.get(number).copied().unwrap_or(0)),
        partial_charge: None,
    };
    let bond =
        |(number, order): (usize, &BondOrder)| Bond { atoms: [number, number + 1], order: *order };
    let atoms = elements.iter().enumerate().map(atom).collect();
    Ligand::new("chain", atoms, orders.iter().enumerate().map(bond).collect()).unwrap()
}

/// A molecule with every order that there is.
fn all_orders() -> Ligand {
    use BondOrder::{Aromatic, Double, Single, Triple, Unknown};
    chain(
        &["C", "Cl", "N", "O", "Br", "H"],
        &[0, 1, -2, 15, 0, -15],
        &[Single, Double, Triple, Aromatic, Unknown],
    )
}

fn record(ligand: &Ligand, name: &str, comment: &str, data: &[(&str, String)]) -> String {
    let positions = ligand.positions().unwrap();
    sdf(&SdfRecord { ligand, positions: &positions, name, comment, data }).unwrap()
}

fn one(text: &str) -> Ligand {
    let mut read = read_bytes(text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(read.len(), 1, "{text}");
    read.remove(0)
}

#[test]
fn a_record_is_read_as_it_was() {
    let ligand = all_orders();
    let text = record(&ligand, "a name", "a comment", &[("energy_kJ_mol", "-12.5".to_owned())]);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..3], ["a name", "  roadmill          3D", "a comment"]);
    assert_eq!(lines[3], "  6  5  0  0  0  0  0  0  0  0999 V2000");
    assert_eq!(lines[5], "    1.5000    0.2500   -0.1250 Cl  0  0  0  0  0  0  0  0  0  0  0  0");
    assert_eq!(lines[15], "M  CHG  4   2   1   3  -2   4  15   6 -15");
    let end =
        ["M  END", "> <energy_kJ_mol>", "-12.5", "", "> <bonds_of_unknown_order>", "5", "", "$$$$"];
    assert_eq!(lines[16..], end);
    let read = one(&text);
    assert_eq!(read.name(), "a name");
    assert_eq!(read.atoms(), ligand.atoms());
    assert_eq!(read.bonds()[..4], ligand.bonds()[..4]);
    assert_eq!(read.bonds()[4].order, BondOrder::Single);
    // Ten charges take two lines.
    let many = chain(&["C"; 11], &[1, 2, 3, 4, 5, -1, -2, -3, -4, -5], &[BondOrder::Single; 10]);
    let text = record(&many, "", "", &[]);
    assert!(text.contains("\nM  CHG  8   1   1") && text.contains("\nM  CHG  2   9  -4  10  -5\n"));
    assert_eq!(one(&text).atoms(), many.atoms());
}

#[test]
fn what_v2000_has_no_columns_for_is_written_in_v3000() {
    let mut ligand = all_orders();
    let mut far = ligand.positions().unwrap();
    far[0].x = -12_345.678_9;
    let record = |ligand: &Ligand, positions: &[Point]| {
        sdf(&SdfRecord { ligand, positions, name: "n", comment: "", data: &[] }).unwrap()
    };
    let text = record(&ligand, &far);
    assert!(text.contains("V3000") && text.contains("M  V30 1 C -12345.6789 0.2500 -0.1250 0\n"));
    ligand.atoms[0].position = Some(far[0]);
    let read = one(&text);
    assert_eq!(read.atoms(), ligand.atoms());
    assert_eq!(read.bonds()[..4], ligand.bonds()[..4]);
    // 999 atoms, and 1000.
    for (count, version) in [(999, "V2000"), (1000, "V3000")] {
        let long = chain(&vec!["C"; count], &[], &vec![BondOrder::Single; count - 1]);
        let text = record(&long, &long.positions().unwrap());
        assert!(text.contains(version), "{count}");
        let read = one(&text);
        assert_eq!((read.atoms(), read.bonds()), (long.atoms(), long.bonds()));
    }
}

#[test]
fn texts_cannot_break_a_record() {
    let ligand = all_orders();
    for bad in [
        "$$$$",
        "M  END",
        "> <x>",
        "@<TRIPOS>MOLECULE",
        "$RXN",
        "a\n$$$$\nb",
        "\r\n",
        "\u{1b}[31m",
        "\u{2028}",
    ] {
        let data = [(bad, format!("{bad}\n\n{bad}")), ("ok", bad.to_owned())];
        let text = record(&ligand, bad, bad, &data);
        let read = one(&text);
        assert_eq!(read.atoms(), ligand.atoms());
        let shown = crate::internal::plain::plain(bad.trim());
        assert_eq!(read.name(), shown);
        assert_eq!(text.matches("\n$$$$\n").count(), 1, "{text}");
        assert_eq!(text.lines().filter(|line| line.starts_with("> <")).count(), 3, "{text}");
        assert!(text.chars().all(|c| c == '\n' || !crate::internal::plain::acts(c)));
    }
    let long = "x ".repeat(300);
    let text = record(&ligand, &long, &long, &[("long", long.clone())]);
    assert!(text.lines().all(|line| line.chars().count() <= 200));
    assert_eq!(text.lines().next().unwrap().len(), 79);
    let lines = text.lines().skip_while(|line| *line != "> <long>").skip(1);
    let value: String = lines.take_while(|line| !line.is_empty()).collect();
    assert_eq!(value, long.trim());
}

proptest! {
    #[test]
    fn any_texts_are_written(name in "\\PC{0,90}|(?s).{0,90}", value in "(?s).{0,500}") {
        let ligand = all_orders();
        let data = [(&*name, value.clone()), ("last", value)];
        let text = record(&ligand, &name, &name, &data);
        let two = read_bytes(format!("{text}{text}").as_bytes()).unwrap();
        prop_assert_eq!(two.len(), 2);
        prop_assert_eq!(two[1].atoms(), ligand.atoms());
        let pose = PdbPose { positions: ligand.positions().unwrap(), remarks: vec![name.clone()] };
        let residue = PdbResidue { name, ..PdbResidue::of(&ligand) };
        let text = pdb(&ligand, &residue, &[pose.clone(), pose]).unwrap();
        prop_assert!(text.is_ascii() && text.lines().all(|line| line.len() <= 80));
        prop_assert_eq!(one(&text).atoms().len(), 6);
    }
}

#[test]
fn poses_are_read_as_models_of_a_pdb_file() {
    use BondOrder::{Double, Single, Triple};
    let ligand =
        chain(&["C", "Cl", "N", "O", "H"], &[0, 2, -1, 0], &[Single, Double, Triple, Single]);
    let mut positions = ligand.positions().unwrap();
    let first = PdbPose { positions: positions.clone(), remarks: vec!["energy -1".to_owned()] };
    positions[1].x += 0.5;
    let second = PdbPose { positions, remarks: Vec::new() };
    let residue = PdbResidue { name: "BEN".to_owned(), chain: 'L', number: 42 };
    let text = pdb(&ligand, &residue, &[first.clone(), second]).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[..4],
        [
            "MODEL        1",
            "REMARK   6 energy -1",
            "HETATM    1  C1  BEN L  42       0.000   0.250  -0.125  1.00  0.00           C",
            "HETATM    2 CL1  BEN L  42       1.500   0.250  -0.125  1.00  0.00          CL2+",
        ]
    );
    assert_eq!(lines[7..9], ["ENDMDL", "MODEL        2"]);
    assert_eq!(lines[15], "CONECT    1    2");
    assert_eq!(lines[16..18], ["CONECT    2    1    3    3", "CONECT    3    2    2    4    4"]);
    let read = one(&text);
    assert_eq!((read.name(), read.bond_source()), ("BEN", BondSource::Conect));
    assert_eq!(read.bonds(), ligand.bonds());
    for (read, written) in read.atoms().iter().zip(ligand.atoms()) {
        assert_eq!((read.element, read.position), (written.element, written.position));
        assert_eq!(read.formal_charge.unwrap_or(0), written.formal_charge.unwrap());
    }
    // One pose has no model, and can be chosen by its chain.
    let text = pdb(&ligand, &residue, &[first]).unwrap();
    assert!(!text.contains("MODEL") && text.ends_with("END\n"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pose.pdb");
    std::fs::write(&path, text).unwrap();
    let group = Group {
        residue: "BEN".to_owned(),
        chain: Some("L".to_owned()),
        number: Some(42),
        insertion: None,
    };
    assert_eq!(read_group(&path, &group).unwrap().atoms().len(), 5);
    // Orders of which one has no way to be told are not told at all.
    let text = pdb(
        &all_orders(),
        &residue,
        &[PdbPose { positions: all_orders().positions().unwrap(), remarks: Vec::new() }],
    )
    .unwrap();
    assert!(one(&text).bonds().iter().all(|bond| bond.order == BondOrder::Unknown));
}

#[test]
fn names_of_atoms_are_the_files_or_made_and_each_is_there_once() {
    let mut ligand = chain(&["C", "Cl", "C", "H"], &[], &[BondOrder::Single; 3]);
    let give = |ligand: &mut Ligand, names: [&str; 4]| {
        for (atom, name) in ligand.atoms.iter_mut().zip(names) {
            name.clone_into(&mut atom.name);
        }
        names::atom_names(ligand)
    };
    assert_eq!(give(&mut ligand, ["CA", "CL", "C2", "HX11"]), ["CA", "CL", "C2", "HX11"]);
    let made = ["C1", "CL1", "C2", "H1"];
    for names in [
        ["C", "C", "X", "H"],
        ["CA", "", "C2", "H"],
        ["CA", "CL", "LONG1", "H"],
        ["C A", "CL", "C2", "H"],
        ["Cé", "CL", "C2", "H"],
    ] {
        assert_eq!(give(&mut ligand, names), made, "{names:?}");
    }
    for symbol in ["Cl", "C"] {
        let many = chain(&vec![symbol; 1000], &[], &vec![BondOrder::Single; 999]);
        let mut names = names::atom_names(&many);
        assert!(names.iter().all(|name| name.len() <= 4));
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 1000, "{symbol}");
    }
}

#[test]
fn what_cannot_be_written_is_said() {
    let ligand = all_orders();
    let fine = ligand.positions().unwrap();
    let written = |positions: &[Point]| {
        let record = SdfRecord { ligand: &ligand, positions, name: "", comment: "", data: &[] };
        sdf(&record).unwrap_err().to_string()
    };
    assert_eq!(written(&fine[1..]), "5 positions found; 6, one for each atom, expected");
    let mut bad = fine.clone();
    bad[2].y = f64::NAN;
    assert!(
        written(&bad)
            .starts_with("`NaN` found; a number of at most 99999 Å as a coordinate of atom 3")
    );
    let charged = chain(&["C", "C"], &[16], &[BondOrder::Single]);
    let positions = charged.positions().unwrap();
    let record =
        SdfRecord { ligand: &charged, positions: &positions, name: "", comment: "", data: &[] };
    assert_eq!(sdf(&record).unwrap_err().to_string(), "`16` found; a charge of -15 to 15 expected");

    let residue = PdbResidue::of(&ligand);
    let refused = |residue: &PdbResidue, positions: Vec<Point>| {
        let poses = [PdbPose { positions, remarks: Vec::new() }];
        pdb(&ligand, residue, &poses).unwrap_err().to_string()
    };
    bad[2].y = -1000.0;
    assert_eq!(
        refused(&residue, bad),
        "`-1000` found; a coordinate that fits into the columns of a PDB file expected"
    );
    assert_eq!(pdb(&ligand, &residue, &[]).unwrap_err().fault(), &LigandFault::Empty);
    let chain = PdbResidue { chain: '\n', ..residue.clone() };
    assert_eq!(
        refused(&chain, fine.clone()),
        "`\\n` as a chain found; one ASCII letter or digit expected"
    );
    let number = PdbResidue { number: 10_000, ..residue };
    assert!(refused(&number, fine).starts_with("`10000` found; a number of a residue"));
    // A molecule from SMILES has no positions of its own, but any can be given.
    let ethane = from_smiles("CC").unwrap();
    let record =
        SdfRecord { ligand: &ethane, positions: &positions, name: "", comment: "", data: &[] };
    assert_eq!(one(&sdf(&record).unwrap()).positions().unwrap(), positions);
}

/// RDKit finds the same atoms, bonds, charges, names and data in both versions, and the models of a PDB file.
#[test]
fn rdkit_reads_what_is_written() {
    let there = Command::new("python3").args(["-c", "import rdkit.Chem"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 has no rdkit");
        return;
    }
    use BondOrder::{Aromatic, Double, Single, Unknown};
    // Phenylacetate with an aromatic ring, and a bond of unknown order.
    let mut atoms = chain(&["C"; 6], &[], &[Single; 5]).atoms;
    let ring = [[0.7, 1.2], [1.4, 0.0], [0.7, -1.2], [-0.7, -1.2], [-1.4, 0.0], [-0.7, 1.2]];
    for (atom, [x, y]) in atoms.iter_mut().zip(ring) {
        atom.position = Some(Point::new(x, y, 0.0));
    }
    let rest = [("C", 0, 2.9, 0.0), ("C", 0, 4.4, 0.0), ("O", 0, 5.0, 1.1), ("O", -1, 5.0, -1.1)];
    for (symbol, charge, x, y) in rest {
        atoms.push(Atom {
            name: String::new(),
            element: element(symbol),
            position: Some(Point::new(x, y, 0.0)),
            formal_charge: Some(charge),
            partial_charge: None,
        });
    }
    let bonds = [
        (0, 1, Aromatic),
        (1, 2, Aromatic),
        (2, 3, Aromatic),
        (3, 4, Aromatic),
        (4, 5, Aromatic),
        (5, 0, Aromatic),
        (1, 6, Single),
        (6, 7, Unknown),
        (7, 8, Double),
        (7, 9, Single),
    ];
    let bonds = bonds.map(|(a, b, order)| Bond { atoms: [a, b], order });
    let ligand = Ligand::new("", atoms, bonds.to_vec()).unwrap();
    let positions = ligand.positions().unwrap();
    let data = [("energy_kJ_mol", "-12.5".to_owned()), ("note", "$$$$\nM  END".to_owned())];
    let near = SdfRecord {
        ligand: &ligand,
        positions: &positions,
        name: "$$$$ pose",
        comment: "c",
        data: &data,
    };
    let far: Vec<Point> = positions.iter().map(|p| p + Point::new(-20_000.0, 0.0, 0.0)).collect();
    let text = sdf(&near).unwrap() + &sdf(&SdfRecord { positions: &far, ..near }).unwrap();
    let pose = PdbPose { positions: positions.clone(), remarks: vec!["first".to_owned()] };
    let models = pdb(&ligand, &PdbResidue::of(&ligand), &[pose.clone(), pose]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("poses.sdf"), text).unwrap();
    std::fs::write(path("poses.pdb"), models).unwrap();
    let script = "
from rdkit import Chem
molecules = list(Chem.SDMolSupplier('poses.sdf'))
assert len(molecules) == 2
for molecule, x in zip(molecules, (0.7, -19999.3)):
    assert Chem.MolToSmiles(molecule) == 'O=C([O-])Cc1ccccc1', Chem.MolToSmiles(molecule)
    assert abs(molecule.GetConformer().GetAtomPosition(0).x - x) < 1e-9
    assert molecule.GetProp('_Name') == ' $$$$ pose'
    assert molecule.GetDoubleProp('energy_kJ_mol') == -12.5
    assert list(molecule.GetPropNames()) == ['energy_kJ_mol', 'note', 'bonds_of_unknown_order']
    assert molecule.GetProp('note') == ' $$$$\\\\nM  END', molecule.GetProp('note')
    assert molecule.GetProp('bonds_of_unknown_order') == '8'
models = Chem.MolFromPDBFile('poses.pdb')
assert (models.GetNumAtoms(), models.GetNumBonds(), models.GetNumConformers()) == (10, 10, 2)
assert models.GetAtomWithIdx(9).GetFormalCharge() == -1
info = models.GetAtomWithIdx(8).GetPDBResidueInfo()
assert (info.GetName(), info.GetResidueName(), info.GetChainId()) == (' O1 ', 'UNL', 'A')
";
    let output = Command::new("python3").args(["-c", script]).current_dir(folder.path()).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
