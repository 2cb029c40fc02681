//! The description and the model as a whole.

use super::*;
use crate::model::{Cost, Model, ModelKind, Scratch, Validity};
use crate::numbers::Ordinal;
use crate::problem::{Problem, about_native, transition};
use crate::seed::{Purpose, Seed};
use crate::structure::AminoAcid;
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
    let spoil: [fn(&mut Protein); 31] = [
        |p| p.source.clear(),
        |p| p.source.truncate(1),
        |p| p.source[3].atoms[1].position.x = f64::NAN,
        |p| p.source[3].atoms[1].position.y = 1e7,
        |p| p.source[3].atoms[0].name = "CB".into(),
        |p| p.source[3].atoms[0].name = "a b".into(),
        |p| p.source[3].atoms.clear(),
        |p| p.source[3].name = "\u{1b}[31m".into(),
        |p| p.source[3].atoms[1].position = p.source[3].atoms[0].position,
        // Whatever a model is made of, in residues whose torsions turn and in those where they do not.
        |p| p.source[4].atoms.retain(|atom| atom.name != "O"),
        |p| p.source[0].atoms[0].position = p.source[0].atoms[1].position,
        |p| p.source[3].atoms[0].position = p.source[3].atoms[1].position,
        |p| p.source[9].atoms[2].position = p.source[9].atoms[1].position,
        |p| p.target.as_mut().unwrap().residues[4].atoms.retain(|atom| atom.name != "O"),
        // What would be read as something else.
        |p| p.source[4].number = p.source[3].number,
        |p| p.source[4].number.insertion = Some('?'),
        |p| p.source[4].amino_acid = Some(AminoAcid::Alanine),
        |p| p.source[4].amino_acid = None,
        |p| p.source[4].atoms[1].element = "c".into(),
        |p| p.source[4].atoms[1].element = "".into(),
        |p| p.source[4].atoms[4].name = "OT2".into(),
        |p| p.source[4].atoms[4].position.x += 101.0,
        |p| p.source[4].atoms[4].position = p.source[7].atoms[4].position,
        |p| p.obstacles = vec![p.source.clone()],
        |p| p.target.as_mut().unwrap().matches.truncate(9),
        |p| p.target.as_mut().unwrap().matches[0] = [0, 10],
        |p| p.target.as_mut().unwrap().matches.swap(0, 1),
        |p| p.rules.side_chains = f64::INFINITY,
        |p| p.step = EnergySteps::Length(f64::NAN),
        |p| p.step = EnergySteps::Turn(0.0),
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

/// The first residue that a file would not give back is named.
#[test]
fn what_does_not_read_back_is_named() {
    let mut unsound = protein(TWO_ENDS);
    unsound.target.as_mut().unwrap().residues[4].amino_acid = Some(AminoAcid::Alanine);
    let message = unsound.sound().unwrap_err();
    assert!(
        message.starts_with("protein.target: GLU 5 found, which a file cannot hold"),
        "{message}"
    );
    let mut unsound = protein("");
    unsound.source[4].atoms[1].position.x -= 1000.0;
    let message = unsound.sound().unwrap_err();
    assert!(message.starts_with("protein.source: GLU 5 N: "), "{message}");
    assert!(message.ends_with(" Å from its CA found; at most 100 Å expected"), "{message}");
}

/// Where N is in a line with its neighbours phi is not defined, and frames of motions have no axes: this is refused by name,
/// also where no frame of motions stands. Nearly in a line is no error, and its motions are judged.
#[test]
fn a_backbone_in_a_line_is_refused() {
    let sound = protein("");
    for at in [1, 4, 9] {
        let [c, ca] =
            [sound.source[at - 1].position("C").unwrap(), sound.source[at].position("CA").unwrap()];
        let bent = |aside: f64| {
            let mut bent = sound.clone();
            bent.source[at].atoms.retain(|atom| matches!(&*atom.name, "N" | "CA" | "C" | "O"));
            let n = bent.source[at].atoms.iter_mut().find(|atom| atom.name == "N").unwrap();
            let across = (ca - c).cross(&crate::structure::Point::new(0.3, 0.5, 0.7)).normalize();
            n.position = (c + ca) / 2.0 + across * aside;
            bent
        };
        let message = bent(0.0).sound().unwrap_err();
        let expected = format!("protein.source: {}: N in a line with CA", sound.source[at]);
        assert!(message.starts_with(&expected), "{message}");
        let bent = bent(0.01);
        assert_eq!(bent.sound(), Ok(()));
        let rules = Rules { motion_side_chains: 0.5, ..Rules::none() };
        let model = Protein { rules, ..bent }.prepare();
        let native = model.native().unwrap();
        let near: Vec<f64> =
            native.iter().map(|value| crate::math::wrap_angle(value + 0.1)).collect();
        assert!(model.motion(native, &near, 1, &mut Scratch::new()).is_some());
    }
}

/// The peptide's atoms as those of a chain, moved along x, Å.
fn chain(name: char, shift: f64) -> String {
    let text = std::fs::read_to_string(folder().join("structures/1UAO.pdb")).unwrap();
    let atoms = text.lines().filter(|line| line.starts_with("ATOM"));
    let of = |line: &str| {
        let x: f64 = line[30..38].trim().parse().unwrap();
        format!("{}{name}{}{:8.3}{}\n", &line[..21], &line[22..30], x + shift, &line[38..])
    };
    atoms.map(of).collect()
}

const WATER: &str =
    "HETATM  999  O   HOH B  99     100.000   0.000   0.000  1.00  0.00           O\n";

/// A problem about a structure file of this text, in a folder of its own.
fn parse_of(text: &str, table: &str) -> Result<(tempfile::TempDir, Problem), String> {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("x.pdb"), text).unwrap();
    let problem = Problem::parse(&scratch.path().join("p.toml"), &format!("[protein]\n{table}"));
    problem.map(|problem| (scratch, problem)).map_err(|error| error.to_string())
}

/// Writes a problem into its folder and reads it again.
fn written_and_read(scratch: &tempfile::TempDir, problem: &Problem) -> Problem {
    let written = problem.to_toml("again-structures");
    std::fs::create_dir_all(scratch.path().join("again-structures")).unwrap();
    for (name, text) in &written.files {
        std::fs::write(scratch.path().join("again-structures").join(name), text).unwrap();
    }
    Problem::parse(&scratch.path().join("again.toml"), &written.text).unwrap()
}

/// Other chains of the file stand around the protein; a modified residue, an inserted one and all of them come back from the
/// files that are written.
#[test]
fn obstacles_are_other_chains() {
    let moving = chain('A', 0.0).replace("GLY A  10 ", "GLY A   9A");
    let moving = moving.replace("THR A   6", "TPO A   6");
    let text = [moving, chain('B', 30.0), chain('C', 60.0), WATER.to_owned()].concat();
    let table = "source = { file = \"x.pdb\", chain = \"A\" }\nobstacles = [\"C\", \"B\"]\n";
    let (scratch, problem) = parse_of(&text, table).unwrap();
    let ModelKind::Protein(found) = problem.model() else { panic!("no protein") };
    assert_eq!(found.source[9].number.to_string(), "9A");
    assert_eq!((&*found.source[5].name, found.obstacles.len()), ("TPO", 2));
    let x = |residues: &[Residue]| residues[0].position("N").unwrap().x;
    assert!((x(&found.obstacles[0]) - x(&found.source) - 60.0).abs() < 1e-9);
    let notes = problem.notes().join("\n");
    assert!(notes.contains("obstacles: chain B: 1 HOH left out"), "{notes}");
    assert!(!notes.contains("not valid"), "{notes}");
    let again = written_and_read(&scratch, &problem);
    assert_eq!(again.model(), problem.model());
    assert_eq!(again.digest(), problem.digest());

    let near = "source = { file = \"x.pdb\", chain = \"A\" }\nobstacles = [\"B\"]\nrules = { obstacle-backbone = 10.0 }\n";
    let text = [chain('A', 0.0), chain('B', 14.0)].concat();
    let (_scratch, problem) = parse_of(&text, near).unwrap();
    let notes = problem.notes().join("\n");
    assert!(notes.contains("the source is not valid: ObstacleBackbone: "), "{notes}");
}

#[test]
fn the_chain_that_moves_and_twins_are_no_obstacles() {
    let (one, two) = (chain('A', 0.0), chain('B', 30.0));
    let both = format!("{one}{two}{WATER}");
    for (text, source, obstacles, expected) in [
        (&one, "", "\"A\"", "`A` found, the chain that moves"),
        (&one, ", chain = \"Z\"", "\"A\"", "`A` found, the chain that moves"),
        (&one, "", "\"B\"", "no chain `B` found; none, for the file has no other chain"),
        (&both, ", chain = \"A\"", "\"D\"", "no chain `D` found; one of `B` expected"),
        (&both, ", chain = \"A\"", "\"B\", \"B\"", "`B` found twice"),
        (&format!("{both}{}", chain('B', 60.0)), ", chain = \"A\"", "\"B\"", "2 chains `B` found"),
    ] {
        let table = format!("source = {{ file = \"x.pdb\"{source} }}\nobstacles = [{obstacles}]\n");
        let error = parse_of(text, &table).expect_err(expected);
        assert!(error.contains("protein.obstacles") && error.contains(expected), "{error}");
    }
    let residues = ChainSpec::Residues(protein("").source);
    let spec = ProteinSpec::new(residues).obstacles(["B".to_owned()]);
    let error = Problem::builder("x", spec).build().unwrap_err().to_string();
    assert!(error.contains("protein.obstacles: names of chains found"), "{error}");
}

/// A stretched peptide without four of its residues: both sides of the gap, 15 Å wide, move as one, and the gap is no bond
/// that other parts of the chain would have to keep clear of.
#[test]
fn a_gap_may_be_rigid() {
    let whole = protein("");
    let mut residues = whole.molecule().unwrap().chains_at(&STRETCHED)[0].clone();
    residues.drain(3..7);
    let wide = crate::structure::peptides::gaps(&residues)[0].distance.unwrap();
    assert!(wide > 12.0, "{wide}");
    let spec = ProteinSpec::new(ChainSpec::Residues(residues));
    let error = Problem::builder("gap", spec.clone()).build().unwrap_err().to_string();
    assert!(error.contains("a gap between ASP 3 and THR 8 found"), "{error}");
    let problem = Problem::builder("gap", spec.gaps(Gaps::Rigid)).build().unwrap();
    let names: Vec<String> = problem.space().dofs().iter().map(|dof| dof.name.clone()).collect();
    assert_eq!(names.join(" "), "psi_1 phi_2 psi_2 phi_3 psi_8 phi_9 psi_9 phi_10");
    let ModelKind::Protein(protein) = problem.model() else { panic!("no protein") };
    let model = protein.prepare();
    let native = model.native().unwrap().to_vec();
    let near: Vec<f64> = native.iter().map(|value| crate::math::wrap_angle(value + 0.02)).collect();
    let scratch = &mut Scratch::new();
    assert!(model.is_valid(&native, scratch) && model.is_valid(&near, scratch));
    assert!(model.motion(&native, &near, 1, scratch).is_some());
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(written_and_read(&folder, &problem).digest(), problem.digest());
}

/// The goal of `problems/peptide.toml`.
const STRETCHED: [f64; 17] = [
    2.36, -2.43, 2.36, -2.43, 2.36, 2.36, -2.43, 2.36, -2.43, 2.36, -2.43, 2.36, -2.43, 2.36,
    -2.43, 2.36, -2.43,
];

#[test]
fn a_transition_has_the_source_and_the_refit_as_its_ends() {
    let file = || FileSpec::new("structures/1UAO.pdb");
    let spec = || ProteinSpec::new(file().into());
    let of = |spec: &ProteinSpec| transition("x", &folder(), spec, 0.0);
    let made = of(&spec().target(file().into())).unwrap();
    assert!(made.refit.ca_rmsd < 1e-3, "{}", made.refit.ca_rmsd);
    let query = made.problem.query().unwrap();
    let ModelKind::Protein(protein) = made.problem.model() else { panic!("no protein") };
    assert_eq!(query.start, protein.linkage().source());
    assert_eq!(query.goal, made.refit.q);
    for (spec, expected) in [
        (spec(), "protein.target: none found"),
        (spec().target(file().residues("2-10").into()), "no counterpart of GLY 1 found"),
        (
            spec().target(file().into()).rules(Rules { backbone: 4.0, ..Rules::default() }),
            "the start is not valid: Backbone: ",
        ),
        (spec().target(file().into()).highest(-1e9), "the start is not valid: an energy of "),
    ] {
        let error = of(&spec).unwrap_err().to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn about_one_structure_it_has_to_be_valid() {
    let spec = ProteinSpec::new(FileSpec::new("structures/1UAO.pdb").into());
    assert!(about_native("x", &folder(), &spec).is_ok());
    let spec = spec.rules(Rules { backbone: 4.0, ..Rules::default() });
    let error = about_native("x", &folder(), &spec).unwrap_err().to_string();
    assert!(error.contains("the source is not valid: Backbone: "), "{error}");
}

/// Where the chain stands beside obstacles follows from its first residue, which is said.
#[test]
fn transitions_beside_obstacles_say_where_the_goal_stands() {
    let scratch = tempfile::tempdir().unwrap();
    let text = format!("{}{}", chain('A', 0.0), chain('B', 30.0));
    std::fs::write(scratch.path().join("x.pdb"), text).unwrap();
    let file = || FileSpec::new("x.pdb").chain("A");
    let spec = ProteinSpec::new(file().into()).target(file().into()).obstacles(["B".to_owned()]);
    let notes = transition("x", scratch.path(), &spec, 0.0).unwrap().problem.notes().join("\n");
    assert!(notes.contains("the first residue stands still"), "{notes}");
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
        let rise = (ends[1] - ends[0]) / KT;
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
