//! Measures of real structures: values that are known, and those of other programs.
//!
//! The structures are not part of the repository. They are looked for in the folder that `ROADMILL_DATA` names; with
//! `ROADMILL_REQUIRE_DATA=1` their absence is a failure.

#[path = "support/pdb.rs"]
mod pdb;

use pdb::{chain, data, model};
use roadmill::structure::measure::{
    APART, BACKBONE_AND_CB, CA, CA_REACH, CentredPoints, NativeContacts, Probe, SecondaryStructure,
    ThreeStates, ca_contacts, domain_angle, hydrogen_bonds, radius_of_gyration,
    radius_of_gyration_by_mass, rmsd, rmsd_in_place, secondary_structure, solvent_accessible_areas,
    superpose,
};
use roadmill::structure::{Point, Residue};
use std::fmt::Write;
use std::io::Write as _;
use std::ops::RangeInclusive;
use std::process::{Command, Stdio};

fn ca(residues: &[Residue], numbers: RangeInclusive<i32>) -> Vec<Point> {
    let chosen = residues.iter().filter(|residue| numbers.contains(&residue.number.number));
    chosen.filter_map(|residue| residue.position("CA")).collect()
}

fn letters(residues: &[Residue]) -> String {
    secondary_structure(residues).into_iter().map(SecondaryStructure::letter).collect()
}

#[test]
fn calmodulin_moves_by_known_distances() {
    let Some(data) = data() else { return };
    let [free, bound] = ["1CFD", "1CLL"].map(|name| chain(&data, name, 'A'));
    for (numbers, expected) in
        [(4..=147, 10.829), (4..=75, 4.575), (82..=147, 4.611), (65..=92, 3.351)]
    {
        let [a, b] = [&free, &bound].map(|residues| ca(residues, numbers.clone()));
        assert_eq!((a.len(), b.len()), (numbers.clone().count(), numbers.clone().count()));
        let found = superpose(&a, &b);
        assert!((found.rmsd - expected).abs() < 0.005, "{numbers:?}: {}", found.rmsd);
        assert!((rmsd(&a, &b) - found.rmsd).abs() < 1e-9);
        let moved: Vec<Point> = a.iter().map(|point| found.apply(point)).collect();
        assert!((rmsd_in_place(&moved, &b) - found.rmsd).abs() < 1e-9);
        let [a, b] = [a, b].map(|points| CentredPoints::new(&points));
        assert_eq!(a.rmsd(&b).to_bits(), b.rmsd(&a).to_bits());
    }
}

#[test]
fn the_central_helix_of_calmodulin_is_whole_with_calcium_and_broken_without() {
    let Some(data) = data() else { return };
    for (name, broken) in [("1CLL", None), ("1CFD", Some(76..=81))] {
        let residues = chain(&data, name, 'A');
        for (kind, residue) in secondary_structure(&residues).into_iter().zip(&residues) {
            let number = residue.number.number;
            if (65..=92).contains(&number) {
                let is_broken = broken.as_ref().is_some_and(|broken| broken.contains(&number));
                let expected = if is_broken { ThreeStates::Coil } else { ThreeStates::Helix };
                assert_eq!(kind.three_states(), expected, "{name} {residue}");
            }
        }
    }
}

#[test]
fn the_domains_of_adenylate_kinase_stand_at_known_angles() {
    let Some(data) = data() else { return };
    for (name, atoms, nmp, lid) in [
        ("4AKE", CA, 72.782, 144.522),
        ("4AKE", BACKBONE_AND_CB, 72.115, 144.791),
        ("1AKE", CA, 45.136, 106.404),
        ("1AKE", BACKBONE_AND_CB, 44.314, 106.075),
    ] {
        let residues = chain(&data, name, 'A');
        let degrees = |one, middle, other| {
            domain_angle(&residues, one, middle, other, atoms).expect("an angle").to_degrees()
        };
        let found =
            [degrees(115..=125, 90..=100, 35..=55), degrees(179..=185, 115..=125, 125..=153)];
        let error = [found[0] - nmp, found[1] - lid];
        assert!(error.iter().all(|error| error.abs() < 0.001), "{name}: {found:?}");
    }
}

/// A Python that has mdtraj and gemmi, unless there is none and none is required.
fn has_python() -> bool {
    let there = Command::new("python3").args(["-c", "import mdtraj, gemmi"]).output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
        assert!(!required, "no python3 with mdtraj and gemmi");
        println!("not tested: no python3 with mdtraj and gemmi");
    }
    there
}

/// What is measured of one chain, as an object of JSON.
fn measured(residues: &[Residue]) -> String {
    let numbers: Vec<i32> = residues.iter().map(|residue| residue.number.number).collect();
    let atoms: Vec<_> = residues.iter().flat_map(|residue| &residue.atoms).collect();
    let positions: Vec<Point> = atoms.iter().map(|atom| atom.position).collect();
    let areas = solvent_accessible_areas(&atoms, Probe::default()).expect("elements of proteins");
    let bonds = hydrogen_bonds(residues);
    let bonds: Vec<_> =
        bonds.iter().map(|b| [b.donor as f64, b.acceptor as f64, b.energy_kcal]).collect();
    let contacts = ca_contacts(residues, CA_REACH, APART);
    let contacts: Vec<[usize; 2]> = contacts.into_iter().map(|(a, b)| [a, b]).collect();
    let kinds = secondary_structure(residues).into_iter();
    let three: String = kinds.map(|kind| kind.three_states().letter()).collect();
    format!(
        r#""numbers": {numbers:?}, "letters": {:?}, "three": {three:?}, "radius": {:?}, "radius_by_mass": {:?},
        "contacts": {contacts:?}, "areas": {areas:?}, "bonds": {bonds:?}"#,
        letters(residues),
        radius_of_gyration(&positions),
        radius_of_gyration_by_mass(atoms.iter().copied()).expect("elements of proteins"),
    )
}

#[test]
fn mdtraj_and_gemmi_measure_the_same() {
    let Some(data) = data() else { return };
    if !has_python() {
        return;
    }
    let mut json = String::from("{\"chains\": [");
    for (name, chains) in pdb::PROTEINS {
        for letter in chains.chars() {
            let separator = if json.ends_with('[') { "" } else { ",\n" };
            let measured = measured(&chain(&data, name, letter));
            write!(
                json,
                "{separator}{{\"file\": \"{name}\", \"chain\": \"{letter}\", {measured}}}"
            )
            .expect("a string");
        }
    }
    json.push_str("], \"pairs\": [");
    for (a, b, first, last) in pdb::PAIRS {
        let separator = if json.ends_with('[') { "" } else { ",\n" };
        let [p, q] = [a, b].map(|name| ca(&chain(&data, name, 'A'), *first..=*last));
        let found = superpose(&p, &q);
        let rotation: Vec<f64> = found.rotation.transpose().iter().copied().collect();
        let translation: Vec<f64> = found.translation.iter().copied().collect();
        write!(
            json,
            r#"{separator}{{"files": ["{a}", "{b}"], "first": {first}, "last": {last}, "rmsd": {:?},
            "rotation": {rotation:?}, "translation": {translation:?}}}"#,
            found.rmsd
        )
        .expect("a string");
    }
    let [native, other] = [1, 20].map(|number| model(&data, "1L2Y", 'A', number));
    let native = NativeContacts::of(&native);
    write!(
        json,
        r#"], "native": {{"count": {}, "share": {:?}}}}}"#,
        native.len(),
        native.share(&other)
    )
    .expect("a string");

    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/structures/against_mdtraj.py");
    let mut python = Command::new("python3")
        .arg(script)
        .arg(data.join("structures"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("python3 starts");
    let mut stdin = python.stdin.take().expect("a pipe");
    stdin.write_all(json.as_bytes()).expect("python3 reads all of it before it writes");
    drop(stdin);
    let output = python.wait_with_output().expect("python3 ends");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    println!("{out}");
    assert!(output.status.success() && out.contains("agree"), "{out}\n{err}");
}
