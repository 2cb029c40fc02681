//! Real files: what is read of them, beside what other programs read.

use super::super::{BondSource, Group, LinkRule, RigidTree, read, read_all, read_group};
use super::{data, links, sorted_bonds};

/// Heavy atoms, links, and links without amides by RDKit 2026.09.1 (its own rings and bond orders, the same rule), and
/// all atoms, in the order of the file.
const THROMBIN: [(usize, usize, usize, usize); 22] = [
    (29, 9, 7, 58),
    (29, 9, 7, 56),
    (27, 8, 6, 52),
    (27, 8, 6, 52),
    (28, 8, 6, 53),
    (29, 9, 7, 54),
    (27, 8, 6, 55),
    (27, 8, 6, 52),
    (27, 8, 6, 52),
    (27, 8, 6, 54),
    (28, 9, 7, 56),
    (28, 8, 6, 52),
    (28, 9, 7, 56),
    (28, 8, 6, 52),
    (28, 9, 7, 56),
    (28, 8, 6, 55),
    (27, 8, 6, 52),
    (27, 8, 6, 53),
    (28, 9, 7, 58),
    (26, 8, 6, 52),
    (27, 8, 6, 52),
    (30, 9, 7, 55),
];

/// The same of TYK2.
const TYK2: [(usize, usize, usize, usize); 13] = [
    (23, 7, 4, 37),
    (24, 6, 4, 36),
    (24, 6, 4, 39),
    (24, 6, 4, 36),
    (23, 6, 4, 36),
    (21, 5, 3, 32),
    (22, 6, 4, 35),
    (22, 6, 4, 33),
    (24, 7, 5, 39),
    (24, 6, 4, 39),
    (22, 6, 4, 33),
    (23, 6, 4, 38),
    (25, 6, 4, 42),
];

#[test]
fn measured_ligands_have_the_atoms_and_links_that_rdkit_finds() {
    let Some(data) = data() else { return };
    for (target, expected, first) in
        [("thrombin", &THROMBIN[..], "lig_4"), ("tyk2", &TYK2[..], "lig_ejm_54")]
    {
        let ligands = read_all(data.join("ligands").join(target).join("ligands.sdf")).unwrap();
        assert_eq!(ligands[0].name(), first);
        let found: Vec<_> = ligands
            .iter()
            .map(|ligand| {
                let (with, without) = links(ligand);
                (ligand.heavy_atoms(), with, without, ligand.atoms().len())
            })
            .collect();
        assert_eq!(found, expected, "{target}");
        for ligand in &ligands {
            let tree = RigidTree::new(ligand, LinkRule::default());
            assert_eq!(tree.pieces.len(), tree.links.len() + 1);
            assert_eq!(tree.pieces.concat().len(), ligand.atoms().len());
        }
    }
    let error = read(data.join("ligands/tyk2/ligands.sdf")).unwrap_err().to_string();
    assert!(error.contains("13 molecules found (lig_ejm_54 at line 1, "), "{error}");
}

#[test]
fn benzamidine_has_one_link_in_sdf_and_in_the_pdb_file() {
    let Some(data) = data() else { return };
    let sdf = read(data.join("structures/3PTB_BEN.sdf")).unwrap();
    assert_eq!((sdf.name(), sdf.atoms().len(), sdf.heavy_atoms()), ("BEN", 18, 9));
    assert_eq!((links(&sdf), sdf.bonds().len()), ((1, 1), 18));
    let charge: i32 = sdf.atoms().iter().filter_map(|atom| atom.formal_charge).map(i32::from).sum();
    assert_eq!(charge, 1);
    // The only group of more than one atom besides waters.
    let pdb = read(data.join("structures/3PTB.pdb")).unwrap();
    assert_eq!((pdb.name(), pdb.atoms().len(), links(&pdb)), ("BEN", 9, (1, 1)));
    let places = pdb.positions().unwrap();
    assert_eq!(places, sdf.positions().unwrap()[..9]);
}

#[test]
fn groups_of_pdb_files_have_the_links_of_their_molecules() {
    let Some(data) = data() else { return };
    for (file, residue, chain, heavy, bonds, expected) in [
        ("3PTB", "BEN", "A", 9, 9, (1, 1)),
        ("1STP", "BTN", "A", 16, 17, (5, 5)),
        ("4DFR", "MTX", "A", 33, 35, (10, 9)),
        ("4DFR", "MTX", "B", 33, 35, (10, 9)),
        ("1HVR", "XK2", "A", 46, 52, (8, 8)),
        ("1A28", "STR", "A", 23, 26, (1, 1)),
        ("1A28", "STR", "B", 23, 26, (1, 1)),
    ] {
        let path = data.join("structures").join(format!("{file}.pdb"));
        let group = Group {
            residue: residue.to_owned(),
            chain: Some(chain.to_owned()),
            ..Group::default()
        };
        let ligand = read_group(&path, &group).unwrap();
        assert_eq!((ligand.heavy_atoms(), ligand.bonds().len()), (heavy, bonds), "{file} {chain}");
        assert_eq!(links(&ligand), expected, "{file} {chain}");
        assert_eq!(ligand.bond_source(), BondSource::Conect, "{file}");
        // Distances alone give the same bonds.
        let text = std::fs::read_to_string(&path).unwrap();
        let lines = text.lines().filter(|line| !line.starts_with("CONECT"));
        let without: String = lines.map(|line| format!("{line}\n")).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("without.pdb");
        std::fs::write(&path, without).unwrap();
        let perceived = read_group(&path, &group).unwrap();
        assert_eq!(perceived.bond_source(), BondSource::Distances, "{file}");
        assert_eq!(sorted_bonds(&perceived), sorted_bonds(&ligand), "{file} {chain}");
        assert_eq!(links(&perceived), expected, "{file} {chain}");
    }
    let error = read(data.join("structures/4DFR.pdb")).unwrap_err().to_string();
    assert!(error.contains("2 molecules found (MTX at line "), "{error}");
}

#[test]
fn biotin_in_pdbqt_has_the_atoms_and_links_of_the_pdb_file() {
    let Some(data) = data() else { return };
    let pdbqt = read(data.join("structures/1STP_ligand.pdbqt")).unwrap();
    let pdb = read(data.join("structures/1STP.pdb")).unwrap();
    assert_eq!((pdbqt.name(), pdb.name()), ("BTN", "BTN"));
    assert_eq!((pdbqt.atoms().len(), pdbqt.heavy_atoms(), pdb.atoms().len()), (18, 16, 16));
    assert_eq!((links(&pdbqt), links(&pdb)), ((5, 5), (5, 5)));
    // The same bonds between atoms of the same names.
    let named = |ligand: &super::Ligand| {
        let name = |atom: usize| ligand.atoms()[atom].name.clone();
        let is_heavy = |atom: usize| ligand.atoms()[atom].element.is_heavy();
        let heavy =
            ligand.bonds().iter().filter(|bond| bond.atoms.iter().all(|atom| is_heavy(*atom)));
        let mut names: Vec<_> = heavy
            .map(|bond| {
                let [a, b] = bond.atoms.map(name);
                [a.clone().min(b.clone()), a.max(b)]
            })
            .collect();
        names.sort();
        names
    };
    assert_eq!(named(&pdbqt), named(&pdb));
    // Both have the ring with the sulphur and the ureido group as the root, of whichever atoms it is made.
    for ligand in [&pdbqt, &pdb] {
        let tree = RigidTree::new(ligand, LinkRule::default());
        assert!(tree.pieces[0].iter().any(|atom| ligand.atoms()[*atom].name == "S1"));
        assert_eq!(tree.links.len(), 5);
        assert!(tree.links.iter().enumerate().all(|(number, link)| link.parent == number));
    }
}
