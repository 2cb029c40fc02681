//! Real structures: every file is read with the atoms and residues that another program finds, or refused for a reason.
//!
//! The structures are not part of the repository. They are looked for in the folder that `ROADMILL_DATA` names; with
//! `ROADMILL_REQUIRE_DATA=1` their absence is a failure.

#[path = "support/pdb.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod pdb;

use roadmill::structure::disulphides::disulphides;
use roadmill::structure::matching::{MatchedBy, match_chains};
use roadmill::structure::peptides::{cis_peptides, gaps};
use roadmill::structure::{
    AminoAcid, Chain, ChainSelection, Structure, backbone, comparison, parse_range, read,
    select_chain,
};
use std::path::Path;

/// Files with the number of their models, the atoms and residues of each by gemmi 0.7.5, and how many amino acids their
/// chains have.
const FILES: &[(&str, usize, usize, usize, &[usize])] = &[
    ("1A28.pdb", 1, 4262, 682, &[251, 249]),
    ("1AKE.pdb", 1, 1661, 214, &[214]),
    ("1BDD.pdb", 1, 722, 46, &[46]),
    ("1CFD.pdb", 1, 2262, 148, &[148]),
    ("1CLL.pdb", 1, 1279, 288, &[144]),
    ("1HVR.pdb", 1, 1890, 199, &[99, 99]),
    ("1L2Y.pdb", 38, 304, 20, &[20]),
    ("1MI0.pdb", 1, 1066, 233, &[61, 62]),
    ("1PGA.pdb", 1, 875, 76, &[56]),
    ("1PGA_noH.pdb", 1, 456, 76, &[56]),
    ("1STP.pdb", 1, 1001, 206, &[121]),
    ("1UAO.pdb", 1, 138, 10, &[10]),
    ("3PTB.pdb", 1, 1701, 287, &[223]),
    ("4AKE.pdb", 1, 1656, 214, &[214]),
    ("4DFR.pdb", 1, 3035, 751, &[159, 159]),
    ("ALA_DIPEPTIDE.pdb", 1, 22, 3, &[1]),
];

fn structure(data: &Path, name: &str) -> Structure {
    read(data.join("structures").join(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn chain(data: &Path, name: &str, range: Option<&str>) -> Chain {
    let range = range.map(|range| parse_range(range).expect("a range"));
    let selection = ChainSelection { chain: Some("A"), range };
    let structure = structure(data, name);
    select_chain(&structure.models[0], selection).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_file_has_the_atoms_and_residues_that_gemmi_finds() {
    let Some(data) = pdb::data() else { return };
    for (name, models, atoms, residues, chains) in FILES {
        let structure = structure(&data, name);
        assert_eq!(structure.models.len(), *models, "{name}");
        for (model, counts) in structure.models.iter().zip(&structure.counts) {
            assert_eq!((counts.atoms, counts.residues), (*atoms, *residues), "{name}");
            let lengths = model.chains.iter().map(|chain| chain.residues.len());
            assert_eq!(lengths.collect::<Vec<_>>(), *chains, "{name}");
            for chain in &model.chains {
                assert!(gaps(&chain.residues).is_empty(), "{name}");
                // The dipeptide's caps are none of the twenty.
                assert!(backbone::check(chain).is_ok(), "{name}");
            }
        }
    }
    for entry in std::fs::read_dir(data.join("structures")).expect("a folder") {
        let name = entry.expect("an entry").file_name().into_string().expect("a name in UTF-8");
        if FILES.iter().any(|(known, ..)| *known == name) {
            continue;
        }
        let error = read(data.join("structures").join(&name)).expect_err(&name).to_string();
        assert!(error.contains("a structure in the PDB or mmCIF format expected"), "{error}");
    }
}

#[test]
fn what_is_known_of_real_structures_is_found() {
    let Some(data) = pdb::data() else { return };
    let trypsin = structure(&data, "3PTB.pdb");
    assert_eq!(disulphides(&trypsin.models[0].chains).len(), 6);
    let protease = chain(&data, "1HVR.pdb", None);
    let modified = &protease.residues[66];
    assert_eq!(
        (modified.to_string().as_str(), modified.amino_acid),
        ("CSO 67", Some(AminoAcid::Cysteine))
    );
    for name in ["4AKE.pdb", "1AKE.pdb"] {
        let chain = chain(&data, name, None);
        let cis: Vec<String> = cis_peptides(&chain.residues)
            .iter()
            .map(|cis| chain.residues[cis.before + 1].to_string())
            .collect();
        assert_eq!(cis, ["PRO 87"], "{name}");
    }
    let calmodulin = structure(&data, "1CLL.pdb");
    let alternative = &calmodulin.alternatives;
    assert_eq!((alternative.len(), alternative[0].number.number), (1, 118));
    let chain = &calmodulin.models[0].chains[0];
    let calcium = |other: &&roadmill::structure::Residue| other.name == "CA";
    let ions: Vec<_> = chain.others.iter().filter(calcium).collect();
    assert!(ions.len() == 4 && ions.iter().all(|ion| ion.atoms[0].element == "Ca"));
}

#[test]
fn two_conformations_are_matched_and_compared() {
    let Some(data) = pdb::data() else { return };
    for (range, rmsd) in [("4-147", 10.829), ("4-75", 4.575), ("82-147", 4.611), ("65-92", 3.351)] {
        let [free, bound] = ["1CFD.pdb", "1CLL.pdb"].map(|name| chain(&data, name, Some(range)));
        let found = comparison::compare(&free, &bound).expect("one protein");
        assert_eq!((found.matching.by, found.matching.identity), (MatchedBy::Number, 1.0));
        assert!((found.superposition.rmsd - rmsd).abs() < 0.005, "{range}");
    }
    let [free, bound] = ["1CFD.pdb", "1CLL.pdb"].map(|name| chain(&data, name, None));
    let found = comparison::compare(&free, &bound).expect("one protein");
    assert_eq!((found.matching.only_first.len(), found.matching.only_second.len()), (4, 0));
    // The largest are those of the linker and of the second lobe.
    let largest: Vec<String> = found.turns[..4]
        .iter()
        .map(|turn| {
            let residue = &free.residues[found.matching.pairs[turn.pair].first];
            format!("{}{}", turn.torsion, residue.number)
        })
        .collect();
    assert_eq!(largest, ["psi131", "psi80", "psi5", "phi147"]);
    let kinase = chain(&data, "4AKE.pdb", None);
    let error = match_chains(&kinase, &free).expect_err("two proteins").to_string();
    assert!(error.contains("two states of one protein"), "{error}");
}
