//! Energies beside those of `tests/reference/ligand_energy.py`, which has the formulas and the numbers a second time.

use super::super::{EnergySpec, Own, OwnTerms, PairSum, ParameterSet, Particle};
use super::{Numbers, ligand, particle, pose, protein};
use crate::structure::Point;
use std::fmt::Write as _;
use std::process::Command;

/// Whether Python has numpy. Where `ROADMILL_REQUIRE_PYTHON` is 1 it must.
fn has_python() -> bool {
    let there = Command::new("python3").args(["-c", "import numpy"]).output();
    let there = there.is_ok_and(|output| output.status.success());
    if !there {
        let required =
            std::env::var_os("ROADMILL_REQUIRE_PYTHON").is_some_and(|value| value == "1");
        assert!(!required, "python3 with numpy expected");
        println!("skipped: python3 has no numpy");
    }
    there
}

fn points(points: &[Point]) -> String {
    let points: Vec<[f64; 3]> = points.iter().map(|point| (*point).into()).collect();
    format!("{points:?}")
}

fn particles(particles: &[Particle]) -> String {
    let elements: Vec<&str> = particles.iter().map(|particle| particle.element.symbol()).collect();
    let charges: Vec<f64> = particles.iter().map(|particle| particle.charge).collect();
    let hydrophobic: Vec<bool> = particles.iter().map(|particle| particle.is_hydrophobic).collect();
    format!(r#""elements": {elements:?}, "charges": {charges:?}, "hydrophobic": {hydrophobic:?}"#)
}

#[test]
fn energies_are_those_of_a_program_of_another_hand() {
    if !has_python() {
        return;
    }
    let mut numbers = Numbers(11);
    let (mut of_protein, positions) = protein(&mut numbers);
    // Elements that AutoDock lacks, too.
    of_protein.truncate(600);
    of_protein[3] = particle("Cu", 2.0, false);
    of_protein[4] = particle("Se", 0.0, false);
    let positions = &positions[..600];
    let mut of_ligand = ligand();
    of_ligand[1] = particle("Si", 0.3, false);
    let pairs = [[0, 3], [1, 5], [2, 4], [0, 5]];
    let mut cases: Vec<String> = Vec::new();
    for (set, name, cutoff, (own_terms, own_name), poses) in [
        (ParameterSet::Autodock4, "autodock4", 12.0, (Own::Repulsion, "repulsion"), 600),
        (ParameterSet::Uff, "uff", 9.0, (Own::Whole, "whole"), 400),
    ] {
        let spec = EnergySpec {
            parameters: set,
            cutoff,
            dielectric: Some(4.0),
            hydrophobic: true,
            own: own_terms,
        };
        let sum = PairSum::new(&spec, &of_protein, positions, &of_ligand);
        let own = OwnTerms::new(&spec, &of_ligand, &pairs);
        let poses: Vec<Vec<Point>> = (0..poses).map(|_| pose(&mut numbers)).collect();
        let mut case = String::new();
        write!(
            case,
            r#"{{"spec": {{"parameters": "{name}", "cutoff": {cutoff:?}, "dielectric": 4.0, "hydrophobic": true, "own": "{own_name}"}},
            "protein": {{{}, "positions": {}}}, "ligand": {{{}, "own_pairs": {pairs:?}}}, "poses": ["#,
            particles(&of_protein),
            points(positions),
            particles(&of_ligand),
        )
        .unwrap();
        let all: Vec<String> = poses.iter().map(|pose| points(pose)).collect();
        let energies = poses.iter().map(|pose| {
            let (parts, own) = (sum.parts(pose), own.energy(pose));
            let [van_der_waals, coulomb, hydrophobic] =
                [parts.van_der_waals, parts.coulomb, parts.hydrophobic];
            format!(
                r#"{{"van_der_waals": {van_der_waals:?}, "coulomb": {coulomb:?}, "hydrophobic": {hydrophobic:?}, "own": {own:?}}}"#
            )
        });
        let energies: Vec<String> = energies.collect();
        write!(case, r#"{}], "energies": [{}]}}"#, all.join(", "), energies.join(", ")).unwrap();
        cases.push(case);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("energies.json");
    std::fs::write(&file, format!("[{}]", cases.join(",\n"))).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/ligand_energy.py");
    let output = Command::new("python3").arg(script).arg(&file).output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success() && out.contains("1000 poses agree"), "{out}\n{err}");
}
