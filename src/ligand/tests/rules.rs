//! Torsion links and the tree of rigid pieces.

use super::super::{BondOrder, LinkRule, RigidTree, from_smiles};
use super::{links, one};

/// The ligands of Bayazit's Table IV: residue name, SMILES, the torsion links that the table has (its degrees of freedom
/// less six), the same without amides, and the heavy atoms. UVC (6RSA, uridine vanadate; 8 degrees of freedom) is left
/// out: how its vanadium is bonded is not certain.
const TABLE_IV: [(&str, &str, usize, usize, usize); 12] = [
    // guanine
    ("GUN", "Nc1nc2[nH]cnc2c(=O)[nH]1", 0, 0, 11),
    // sulphate
    ("SO4", "[O-]S(=O)(=O)[O-]", 0, 0, 5),
    // oxamate
    ("OXM", "NC(=O)C(=O)[O-]", 1, 1, 6),
    // 4-hydroxybenzoate
    ("PHB", "OC(=O)c1ccc(O)cc1", 1, 1, 10),
    // benzamidinium
    ("BEN", "NC(=[NH2+])c1ccccc1", 1, 1, 9),
    // 3-phenyllactate
    ("LOF", "OC(=O)[C@@H](O)Cc1ccccc1", 3, 3, 12),
    // leucine's hydroxamate
    ("LNO", "N[C@@H](CC(C)C)C(=O)NO", 4, 3, 10),
    // biotin
    ("BTN", "OC(=O)CCCC[C@H]1SC[C@@H]2NC(=O)N[C@H]12", 5, 5, 16),
    // methotrexate
    ("MTX", "CN(Cc1cnc2nc(N)nc(N)c2n1)c1ccc(cc1)C(=O)N[C@@H](CCC(=O)O)C(=O)O", 10, 9, 33),
    // argatroban (MD-805)
    ("MIT", "CC1CCN(C(C1)C(=O)O)C(=O)C(CCCNC(N)=N)NS(=O)(=O)c1cccc2c1NCC(C)C2", 11, 10, 35),
    // NAPAP
    ("MID", "NC(=N)c1ccc(cc1)CC(NC(=O)CNS(=O)(=O)c1ccc2ccccc2c1)C(=O)N1CCCCC1", 11, 9, 37),
    // L-700,417: the table counts 36 atoms, the file of 4PHV has 46 heavy ones
    (
        "VAC",
        "OC(CC(Cc1ccccc1)C(=O)NC1C(O)Cc2ccccc12)CC(Cc1ccccc1)C(=O)NC1C(O)Cc2ccccc12",
        14,
        12,
        46,
    ),
];

#[test]
fn the_rule_gives_the_degrees_of_freedom_of_bayazits_table_iv() {
    for (name, smiles, with, without, heavy) in TABLE_IV {
        let ligand = from_smiles(smiles).unwrap();
        assert_eq!(links(&ligand), (with, without), "{name}");
        assert_eq!(ligand.heavy_atoms(), heavy, "{name}");
        assert_eq!(ligand.degrees_of_freedom(LinkRule::default()), 6 + with, "{name}");
    }
}

#[test]
fn dithiothreitol_is_the_exception_three_links_by_the_rule_where_the_table_has_none() {
    let dithiothreitol = from_smiles("SCC(O)C(O)CS DTT").unwrap();
    assert_eq!((dithiothreitol.name(), dithiothreitol.heavy_atoms()), ("DTT", 8));
    assert_eq!(links(&dithiothreitol), (3, 3));
}

#[test]
fn double_bonds_rings_and_ends_do_not_turn() {
    for (smiles, expected) in [
        ("CC", (0, 0)),
        ("CCC", (0, 0)),
        ("CCCC", (1, 1)),
        ("[H]C([H])([H])C([H])([H])[H]", (0, 0)),
        ("CC=CC", (0, 0)),
        ("C/C=C/C", (0, 0)),
        ("CC#CC", (0, 0)),
        ("C1CCCCC1", (0, 0)),
        // biphenyl: the bond between the rings has no symbol, and is single
        ("c1ccccc1c1ccccc1", (1, 1)),
        ("c1ccccc1-c1ccccc1", (1, 1)),
        // two rings that share an atom, and two with a bond between them
        ("C1CCC12CCC2", (0, 0)),
        ("C1CC1C1CC1", (1, 1)),
        // N-methylacetamide, a thioamide, an ester, a carbamate, a sulphonamide
        ("CNC(C)=O", (1, 0)),
        ("CNC(C)=S", (1, 0)),
        ("COC(C)=O", (1, 1)),
        ("COC(=O)NC", (2, 1)),
        ("CNS(=O)(=O)C", (1, 1)),
        // a lactam's bond is in its ring
        ("O=C1CCCN1", (0, 0)),
    ] {
        assert_eq!(links(&from_smiles(smiles).unwrap()), expected, "{smiles}");
    }
}

#[test]
fn smiles_has_orders_charges_rings_and_brackets() {
    let ligand =
        from_smiles("[13CH3:1]C%12=CC(=C[NH3+])[C@TH1]%12([O--])[Se]C%(345)C=[Fe+2]%(345)");
    let ligand = ligand.unwrap();
    let elements: Vec<_> = ligand.atoms().iter().map(|atom| atom.element.symbol()).collect();
    assert_eq!(elements, ["C", "C", "C", "C", "C", "N", "C", "O", "Se", "C", "C", "Fe"]);
    let charges: Vec<_> = ligand.atoms().iter().filter_map(|atom| atom.formal_charge).collect();
    assert_eq!(charges, [0, 0, 0, 0, 0, 1, 0, -2, 0, 0, 0, 2]);
    assert_eq!(ligand.bonds().len(), 13);
    let doubles = ligand.bonds().iter().filter(|bond| bond.order == BondOrder::Double);
    assert_eq!(doubles.count(), 3);
    let benzene = from_smiles("c1ccccc1").unwrap();
    assert!(benzene.bonds().iter().all(|bond| bond.order == BondOrder::Aromatic));
    assert!(benzene.positions().is_none() && benzene.line().is_none());
}

#[test]
fn broken_smiles_are_refused_where_they_break() {
    for (smiles, expected) in [
        ("", "nothing found"),
        ("C", "1 atom without bonds found"),
        ("C.C", "`.`, which separates molecules, found"),
        ("C*", "`*` as character 2"),
        ("C$C", "`$` as character 2"),
        ("C[X]", "`X` as the element of atom 2 found"),
        ("C[C", "the end of the SMILES found; `]`"),
        ("C[c", "the end of the SMILES found; `]`"),
        ("C(C", "the end of the SMILES found"),
        ("CC)C", "`)` as character 3"),
        ("(C)C", "`(` as character 1"),
        ("C=", "the end of the SMILES found"),
        ("C==C", "`=` as character 3"),
        ("=CC", "`=` as character 1"),
        ("C1CC", "ring 1 without an end found"),
        ("C=1CC#1", "ring 1 with two different bonds found"),
        ("C11", "a bond of atoms 1 and 1 found"),
        ("C1C1", "a second bond of atoms 1 and 2 found"),
        ("C%1C", "`C` as character 4"),
        ("1CC", "`1` as character 1"),
        ("C[N+99]", "a charge of at most 15"),
        ("Cé", "`é` as character 2"),
        ("C[CH4:]", "the number of an atom's class"),
        ("C((C))C", "`(` as character 3 of the SMILES found; an atom that a branch"),
        ("C()C", "`)` as character 3 of the SMILES found; an atom that a branch"),
    ] {
        let error = from_smiles(smiles).unwrap_err().to_string();
        assert!(error.contains(expected), "{smiles}: {error}");
    }
    let long = "C".repeat(1001);
    let error = from_smiles(&long).unwrap_err().to_string();
    assert_eq!(error, "1001 atoms found; at most 1000 expected");
    // Neither brackets nor branches are followed by calls of functions.
    assert!(from_smiles(&"(".repeat(1_000_000)).is_err());
    let deep = format!("{}C{}", "C(".repeat(900), ")".repeat(900));
    assert_eq!(links(&from_smiles(&deep).unwrap()).0, 898);
}

#[test]
fn the_tree_grows_from_the_largest_piece() {
    // Toluene's ring with a chain of three links, written from the chain's end.
    let ligand = from_smiles("OCCCc1ccccc1").unwrap();
    let tree = RigidTree::new(&ligand, LinkRule::default());
    let pieces: [&[usize]; 4] = [&[4, 5, 6, 7, 8, 9], &[3], &[2], &[0, 1]];
    assert_eq!(tree.pieces, pieces);
    let axes: Vec<_> = tree.links.iter().map(|link| (link.axis, link.parent)).collect();
    assert_eq!(axes, [([4, 3], 0), ([3, 2], 1), ([2, 1], 2)]);
    let moved: [&[usize]; 3] = [&[0, 1, 2], &[0, 1], &[0]];
    assert_eq!(tree.links.iter().map(|link| &link.moved[..]).collect::<Vec<_>>(), moved);
}

#[test]
fn of_pieces_of_one_size_the_root_has_the_lowest_atom_and_branches_follow_their_numbers() {
    // A carbon with three chains: each piece has two heavy atoms at most.
    let ligand = from_smiles("CCC(CC)CC").unwrap();
    let tree = RigidTree::new(&ligand, LinkRule::default());
    let pieces: [&[usize]; 4] = [&[0, 1], &[2], &[3, 4], &[5, 6]];
    assert_eq!(tree.pieces, pieces);
    let axes: Vec<_> = tree.links.iter().map(|link| (link.axis, link.parent)).collect();
    assert_eq!(axes, [([1, 2], 0), ([2, 3], 1), ([2, 5], 1)]);
    let moved: [&[usize]; 3] = [&[3, 4, 5, 6], &[4], &[6]];
    assert_eq!(tree.links.iter().map(|link| &link.moved[..]).collect::<Vec<_>>(), moved);
    // Hydrogens do not make a piece larger: the chain's end of four atoms is no root.
    let ligand = from_smiles("CC(=O)CC([H])([H])[H]").unwrap();
    assert_eq!(RigidTree::new(&ligand, LinkRule::default()).pieces[0], [0, 1, 2]);
    let rigid = RigidTree::new(&from_smiles("CCC").unwrap(), LinkRule::default());
    assert_eq!((rigid.pieces.len(), rigid.links.len()), (1, 0));
}

#[test]
fn every_link_of_table_iv_moves_what_is_beyond_it_and_no_more() {
    for (name, smiles, ..) in TABLE_IV {
        let ligand = from_smiles(smiles).unwrap();
        for amides in [true, false] {
            let tree = RigidTree::new(&ligand, LinkRule { amides });
            let mut atoms: Vec<usize> = tree.pieces.concat();
            atoms.sort_unstable();
            assert!(atoms.into_iter().eq(0..ligand.atoms().len()), "{name}");
            assert_eq!(tree.links.len() + 1, tree.pieces.len(), "{name}");
            for (number, link) in tree.links.iter().enumerate() {
                assert!(link.parent <= number, "{name}");
                assert!(tree.pieces[link.parent].contains(&link.axis[0]), "{name}");
                assert!(tree.pieces[number + 1].contains(&link.axis[1]), "{name}");
                // No bond but the link's own joins what moves, with the end of the axis, to the rest.
                let is_beyond = |atom| atom == link.axis[1] || link.moved.contains(&atom);
                let across = |atoms: [usize; 2]| is_beyond(atoms[0]) != is_beyond(atoms[1]);
                let bonds = ligand.bonds().iter().enumerate();
                let crossing: Vec<usize> =
                    bonds.filter(|(_, bond)| across(bond.atoms)).map(|(bond, _)| bond).collect();
                assert_eq!(crossing, [link.bond], "{name}");
            }
        }
    }
}

#[test]
fn bonds_of_unknown_order_are_single_by_their_length() {
    let chain = |length: f64, third: &str| {
        let place =
            |x: f64, element: &str| format!("{x:10.4}    0.0000    0.0000 {element:<3} 0  0\n");
        let atoms = [(-1.5, "C"), (0.0, "C"), (length, third), (length + 1.5, "C")];
        let atoms: String = atoms.map(|(x, element)| place(x, element)).concat();
        let bonds = "  1  2  1  0\n  2  3  8  0\n  3  4  1  0\n";
        one(&format!("\n\n\n  4  3  0  0  0  0            999 V2000\n{atoms}{bonds}M  END\n"))
    };
    for (length, element, expected) in [
        (1.34, "C", 0),
        (1.46, "C", 1),
        (1.28, "N", 0),
        (1.33, "N", 1),
        (1.36, "O", 1),
        (1.22, "O", 0),
        (1.80, "S", 1),
        (1.90, "Se", 1),
    ] {
        assert_eq!(links(&chain(length, element)).0, expected, "{length} {element}");
    }
}
