//! Whatever a file has, it is read or refused, and what is read can be worked with.

use super::super::{LinkRule, RigidTree, from_smiles, read_bytes};
use super::{ACETAMIDE, ACETONE, ETHANOL, ETHANOL_V3000, ETHER, data};
use proptest::prelude::*;
use std::sync::OnceLock;

/// Small files of every format, and real ones where they are.
fn seeds() -> &'static [Vec<u8>] {
    static SEEDS: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    SEEDS.get_or_init(|| {
        let own = [ETHANOL, ETHANOL_V3000, ACETAMIDE, ETHER, ACETONE];
        let mut seeds: Vec<Vec<u8>> = own.iter().map(|text| text.as_bytes().to_vec()).collect();
        let Some(data) = data() else { return seeds };
        for file in ["structures/3PTB_BEN.sdf", "structures/1STP_ligand.pdbqt"] {
            seeds.push(std::fs::read(data.join(file)).unwrap());
        }
        // The first two molecules, and the groups and records of a PDB file without its protein.
        let text = std::fs::read_to_string(data.join("ligands/tyk2/ligands.sdf")).unwrap();
        seeds.push(text.split_inclusive("$$$$\n").take(2).collect::<String>().into_bytes());
        let text = std::fs::read_to_string(data.join("structures/1HVR.pdb")).unwrap();
        let is_group = |line: &&str| line.starts_with("HETATM") || line.starts_with("CONECT");
        let lines = text.lines().filter(is_group);
        seeds.push(lines.map(|line| format!("{line}\n")).collect::<String>().into_bytes());
        seeds
    })
}

/// A change of a file, with places as parts of its length.
#[derive(Clone, Debug)]
enum Change {
    Put(f64, Vec<u8>),
    Remove(f64, usize),
    Repeat(f64, f64),
    Swap(f64, f64),
    End(f64),
}

fn change() -> impl Strategy<Value = Change> {
    let word = prop_oneof![
        prop::collection::vec(any::<u8>(), 1..4),
        prop::sample::select(vec![
            "\n",
            "-",
            "0",
            "1",
            "9",
            " ",
            "999",
            "nan",
            "inf",
            "1e308",
            "-1e-320",
            "é",
            "\u{3000}",
            "$$$$\n",
            "M  END\n",
            "M  V30 ",
            "M  V30 COUNTS 9 99999999999\n",
            "99999999999999999999",
            "ROOT\n",
            "BRANCH 1 2\n",
            "ENDBRANCH 1 2\n",
            "MODEL 1\n",
            "ENDMDL\n",
            "CONECT    1    2\n",
            "@<TRIPOS>ATOM\n",
            "@<TRIPOS>BOND\n",
            "@<TRIPOS>MOLECULE\n",
            "V2000",
            "V3000",
            "M  CHG  1   1   1\n",
            "ATOMS=(1 30)",
            "LABEL=\"",
        ])
        .prop_map(|word| word.as_bytes().to_vec()),
    ];
    let part = 0.0..1.0f64;
    prop_oneof![
        4 => (part.clone(), word).prop_map(|(at, word)| Change::Put(at, word)),
        2 => (part.clone(), 1_usize..40).prop_map(|(at, count)| Change::Remove(at, count)),
        1 => (part.clone(), part.clone()).prop_map(|(from, to)| Change::Repeat(from, to)),
        1 => (part.clone(), part.clone()).prop_map(|(one, other)| Change::Swap(one, other)),
        1 => part.prop_map(Change::End),
    ]
}

fn changed(mut bytes: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        let at = |part: f64| (part * bytes.len() as f64) as usize;
        match change {
            Change::Put(part, word) => {
                let at = at(*part);
                bytes.splice(at..at, word.iter().copied());
            }
            Change::Remove(part, count) => {
                let at = at(*part);
                bytes.drain(at..(at + count).min(bytes.len()));
            }
            Change::Repeat(from, to) => {
                let (from, to) = (at(from.min(*to)), at(from.max(*to)));
                let piece = bytes[from..to.min(from + 2000)].to_vec();
                bytes.splice(to..to, piece);
            }
            Change::Swap(one, other) if !bytes.is_empty() => {
                let (one, other) = (at(*one), at(*other));
                bytes.swap(one, other);
            }
            Change::Swap(..) => {}
            Change::End(part) => {
                let at = at(*part);
                bytes.truncate(at);
            }
        }
    }
    bytes
}

/// Reads the bytes, and works with what was read.
fn try_all(bytes: &[u8]) {
    match read_bytes(bytes) {
        Ok(ligands) => {
            assert!(!ligands.is_empty());
            for ligand in ligands {
                for amides in [true, false] {
                    let tree = RigidTree::new(&ligand, LinkRule { amides });
                    let atoms: usize = tree.pieces.iter().map(Vec::len).sum();
                    assert_eq!(atoms, ligand.atoms().len());
                    assert_eq!(tree.links.len(), ligand.torsion_links(LinkRule { amides }).len());
                }
                let places = ligand.positions().expect("files have positions");
                assert!(places.iter().all(|place| place.iter().all(|value| value.is_finite())));
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    #[test]
    fn changed_files_are_read_or_refused(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec(change(), 1..8),
    ) {
        let seeds = seeds();
        try_all(&changed(seeds[which.index(seeds.len())].clone(), &changes));
    }

    #[test]
    fn random_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        try_all(&bytes);
        // As the body of each format, where they are text.
        let text = String::from_utf8_lossy(&bytes);
        for begin in ["\n\n\n  9  9  0  0  0  0            999 V2000\n", "\n\n\n V3000\nM  V30 BEGIN CTAB\nM  V30 ",
            "@<TRIPOS>MOLECULE\n", "ROOT\nHETATM", "HETATM    1  C1  ACN A   1    "] {
            try_all(format!("{begin}{text}").as_bytes());
        }
    }

    #[test]
    fn smiles_are_read_or_refused(text in "[CNOScnos()\\[\\]=#%:.@H+0-9-]{0,40}", any in "\\PC{0,20}") {
        for smiles in [&text, &any, &format!("C{any}")] {
            if let Ok(ligand) = from_smiles(smiles) {
                let tree = RigidTree::new(&ligand, LinkRule::default());
                prop_assert_eq!(tree.pieces.concat().len(), ligand.atoms().len());
            }
        }
    }
}
