//! The description and the model as a whole.

use super::*;
use crate::model::{Cost, Model, ModelKind, Scratch, Validity};
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::{Purpose, Seed};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("problems")
}

fn parse(table: &str) -> Result<Problem, String> {
    let text = format!("[protein]\nsource = {{ file = \"structures/1UAO.pdb\" }}\n{table}");
    Problem::parse(&folder().join("p.toml"), &text).map_err(|error| error.to_string())
}

fn protein(table: &str) -> Protein {
    match parse(table).unwrap_or_else(|error| panic!("{error}")).model() {
        ModelKind::Protein(protein) => protein.clone(),
        other => panic!("{other:?}"),
    }
}

/// The peptide with itself as the other end.
const TWO_ENDS: &str = "target = { file = \"structures/1UAO.pdb\" }\n";

#[test]
fn torsions_are_those_of_the_peptide() {
    let space = protein("").space();
    let names: Vec<&str> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
    let expected = "psi_1 phi_2 psi_2 phi_3 psi_3 psi_4 phi_5 psi_5 phi_6 psi_6 phi_7 psi_7 phi_8 psi_8 phi_9 psi_9 phi_10";
    assert_eq!(names.join(" "), expected);
}

/// What is written as files is read as the same description, and so is what is made from it again.
#[test]
fn a_protein_is_written_and_read_again() {
    let scratch = tempfile::tempdir().unwrap();
    for table in [
        "",
        TWO_ENDS,
        "rules = { backbone = 0.0 }\nenergy = { ends = { union = {} } }\nhighest = 500.0\nstep = 0.3\n",
    ] {
        let problem = parse(table).unwrap();
        let written = problem.to_toml("p-structures");
        std::fs::create_dir_all(scratch.path().join("p-structures")).unwrap();
        for (name, text) in &written.files {
            std::fs::write(scratch.path().join("p-structures").join(name), text).unwrap();
        }
        let again = Problem::parse(&scratch.path().join("p.toml"), &written.text).unwrap();
        assert_eq!(again.model(), problem.model());
        assert_eq!(again.digest(), problem.digest());
        assert_eq!(problem.to_builder().build().unwrap().model(), problem.model());
    }
}

#[test]
fn wrong_tables_are_refused_by_their_keys() {
    for (table, expected) in [
        ("highest = nan\n", "p.toml:3: protein.highest"),
        ("step = 0.0\n", "p.toml:3: protein.step"),
        ("rules = { backbone = -1.0 }\n", "p.toml:3: protein.rules: backbone = -1 found"),
        ("energy = { ends = { smooth-minimum = { kt = 0.0 } } }\n", "protein.energy: kt = 0 found"),
        ("obstacles = [\"B\"]\n", "protein.obstacles: no chain `B` found"),
        ("target = { file = \"structures/none.pdb\" }\n", "protein.target"),
        (
            "target = { file = \"structures/1UAO.pdb\", residues = \"2-99\" }\n",
            "no residue 99 found",
        ),
        ("target = { file = \"structures/1UAO.pdb\", residues = \"all\" }\n", "such as 4-147"),
        ("target = { file = \"structures/1UAO.pdb\", model = 7 }\n", "no model 7 found"),
        ("gaps = \"bridge\"\n", "p.toml:3"),
    ] {
        let error = parse(table).expect_err(table);
        assert!(error.contains(expected), "{table}: {error}");
    }
}

/// Bytes from elsewhere that no file could give.
#[test]
fn unsound_descriptions_are_refused() {
    let sound = protein(TWO_ENDS);
    assert_eq!(sound.sound(), Ok(()));
    let spoil: [fn(&mut Protein); 14] = [
        |p| p.source.clear(),
        |p| p.source.truncate(1),
        |p| p.source[3].atoms[1].position.x = f64::NAN,
        |p| p.source[3].atoms[1].position.y = 1e7,
        |p| p.source[3].atoms[0].name = "CB".into(),
        |p| p.source[3].atoms[0].name = "a b".into(),
        |p| p.source[3].atoms.clear(),
        |p| p.source[3].name = "\u{1b}[31m".into(),
        |p| p.source[3].atoms[1].position = p.source[3].atoms[0].position,
        |p| p.target.as_mut().unwrap().matches[0] = [0, 10],
        |p| p.target.as_mut().unwrap().matches.swap(0, 1),
        |p| p.rules.side_chains = f64::INFINITY,
        |p| p.step = f64::NAN,
        |p| {
            p.source.iter_mut().skip(5).flat_map(|r| &mut r.atoms).for_each(|a| a.position.x += 9.0)
        },
    ];
    for (index, spoil) in spoil.into_iter().enumerate() {
        let mut unsound = sound.clone();
        spoil(&mut unsound);
        assert!(unsound.sound().is_err(), "{index}");
    }
}

#[test]
fn differences_are_named() {
    let one = protein(TWO_ENDS);
    let of = |table: &str| ModelKind::Protein(protein(table));
    assert_eq!(one.difference(&of(TWO_ENDS)), None);
    assert_eq!(one.difference(&of("")), Some("the target structure"));
    let rules = format!("{TWO_ENDS}rules = {{ backbone = 1.0 }}\n");
    assert_eq!(one.difference(&of(&rules)), Some("the rules"));
}

/// Draws about the native state.
fn draws(model: &dyn Model, degrees: f64, count: usize) -> Vec<Vec<f64>> {
    let mut stream = Seed::of_set(3, "draws", Ordinal(0)).stream(Purpose::Sampling);
    let native = model.native().unwrap().to_vec();
    let mut turn =
        |value: &f64| crate::math::wrap_angle(value + stream.normal() * degrees.to_radians());
    (0..count).map(|_| native.iter().map(&mut turn).collect()).collect()
}

/// Answers do not depend on what the scratch has seen, and motions cost there and back what they climb.
#[test]
fn answers_are_pure_and_costs_are_climbs() {
    let model = protein("").prepare();
    let configs = draws(&*model, 15.0, 60);
    let scratch = &mut Scratch::new();
    let (mut valid, mut joined) = (0, 0);
    for (index, q) in configs.iter().enumerate() {
        let validity = model.validity(q, &mut Scratch::new());
        scratch.poison(index as u64);
        assert_eq!(model.validity(q, scratch), validity);
        let energy = model.energy(q, scratch).unwrap();
        scratch.poison(f64::NAN.to_bits());
        assert_eq!(model.energy(q, scratch).unwrap().to_bits(), energy.to_bits());
        valid += usize::from(validity == Validity::Valid);
    }
    let valid_ones: Vec<&Vec<f64>> =
        configs.iter().filter(|q| model.is_valid(q, &mut Scratch::new())).collect();
    for pair in valid_ones.windows(2) {
        let there = model.motion(pair[0], pair[1], 1, &mut Scratch::new());
        scratch.poison(7);
        assert_eq!(model.motion(pair[0], pair[1], 1, scratch), there);
        let back = model.motion(pair[1], pair[0], 1, scratch);
        let Some(Cost::Directed(there)) = there else {
            assert_eq!(back, None);
            continue;
        };
        let Some(Cost::Directed(back)) = back else { panic!("free one way only") };
        assert_eq!(
            (there.forward, there.backward, there.peak),
            (back.backward, back.forward, back.peak)
        );
        let ends = [pair[0], pair[1]].map(|q| model.energy(q, scratch).unwrap());
        // The climbs there less those back are the difference of the ends' energies, in kT.
        let rise = (ends[1] - ends[0]) / chain_in_energy::KT;
        assert!((there.forward - there.backward - rise).abs() < 1e-6 * (1.0 + there.forward));
        assert!(there.peak >= ends[0].max(ends[1]));
        joined += 1;
    }
    assert!(valid > 20 && joined > 5, "{valid} {joined}");
}

/// All atoms move rigidly with the backbone: bonded atoms keep their distances, and the source's torsions give the source.
#[test]
fn all_atoms_go_along() {
    let protein = protein("");
    let model = protein.prepare();
    let molecule = protein.molecule().unwrap();
    let native = model.native().unwrap();
    assert_eq!(molecule.chains_at(native)[0], protein.source);
    let moved = &molecule.chains_at(&draws(&*model, 60.0, 1)[0])[0];
    for (before, after) in protein.source.iter().zip(moved) {
        for i in 0..before.atoms.len() {
            for j in 0..i {
                let bond = (before.atoms[i].position - before.atoms[j].position).norm();
                if bond < 1.6 {
                    let now = (after.atoms[i].position - after.atoms[j].position).norm();
                    let names = (&before.atoms[i].name, &before.atoms[j].name);
                    assert!((now - bond).abs() < 1e-9, "{before} {names:?}: {now} for {bond}");
                }
            }
        }
    }
}
