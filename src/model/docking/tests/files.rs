//! Descriptions as files and as bytes.

use super::{BIOTIN, biotin, docking_of, parse, problem};
use crate::problem::Problem;
use crate::wire;

/// What is written as files is read as the same description, and so is what is made from it again.
#[test]
fn docking_is_written_and_read_again() {
    let scratch = tempfile::tempdir().unwrap();
    for more in [
        "",
        "rigid = true\namides = false\n",
        "hydrogens = \"keep\"\nhighest = 100.0\nstep = 0.4\ngrid = { lookup = \"nearest\", spacing = 0.5 }\n",
        "energy = { parameters = \"uff\", cutoff = 9.0, dielectric = 4.0, hydrophobic = true, own = \"whole\" }\n",
    ] {
        let problem = problem(&biotin(more));
        let written = problem.to_toml("p-files");
        std::fs::create_dir_all(scratch.path().join("p-files")).unwrap();
        for (name, text) in &written.files {
            std::fs::write(scratch.path().join("p-files").join(name), text).unwrap();
        }
        let again = Problem::parse(&scratch.path().join("p.toml"), &written.text);
        let again = again.unwrap_or_else(|error| panic!("{error}\n{}", written.text));
        assert_eq!(again.model(), problem.model());
        assert_eq!(again.digest(), problem.digest());
        assert_eq!(problem.to_builder().build().unwrap().model(), problem.model());
        let bytes = wire::encode(problem.model());
        assert_eq!(wire::decode::<crate::model::ModelKind>(&bytes).unwrap(), *problem.model());
    }
}

#[test]
fn waters_with_numbers_that_begin_anew_come_back_too() {
    let text = BIOTIN.replace("1STP.pdb\" }", "1STP.pdb\", waters = \"keep\" }");
    let waters = docking_of(&problem(&text));
    let without = docking_of(&problem(BIOTIN));
    let count = |of: &super::Docking| {
        of.chains().iter().flat_map(|chain| &chain.residues).filter(|of| of.is_water()).count()
    };
    assert_eq!((count(&waters), count(&without)), (84, 0));
}

#[test]
fn wrong_tables_are_refused_by_their_keys() {
    for (more, expected) in [
        ("highest = nan\n", "docking.highest: NaN found"),
        ("step = 0.0\n", "docking.step: 0 found"),
        ("grid = { spacing = 0.0 }\n", "docking.grid: spacing 0 found"),
        ("grid = { spacing = 0.375, lookup = \"cubic\" }\n", "unknown variant `cubic`"),
        ("energy = { cutoff = 2.0 }\n", "docking.energy: cutoff 2 found"),
        ("hydrogens = \"perhaps\"\n", "unknown variant `perhaps`"),
        ("colour = 1\n", "unknown field `colour`"),
    ] {
        let error = parse(&biotin(more)).unwrap_err();
        assert!(error.contains("p.toml:") && error.contains(expected), "{error}");
    }
    for (from, to, expected) in [
        ("size = [12.0, 12.0, 12.0]", "size = [12.0, 0.0, 12.0]", "in y found; a least value"),
        (
            "centre = [11.0, 2.0, -11.0], size = [12.0,",
            "centre = [811.0, 2.0, -11.0], size = [-12.0,",
            "in x found; a least value",
        ),
        ("size = [12.0, 12.0, 12.0]", "size = [9e5, 9e5, 9e5]", "docking.grid: a grid of"),
        ("centre = [11.0,", "centre = [811.0,", "docking.box: a box 77"),
        ("centre = [11.0, 2.0, -11.0], ", "", "either `centre` and `size` or `min` and `max`"),
        ("residue = \"BTN\"", "residue = \"MTX\"", "docking.ligand: "),
        ("residue = \"BTN\"", "molecule = \"MTX\"", "no molecule `MTX` found"),
        (", residue = \"BTN\"", ", chain = \"A\"", "without `residue` found"),
        ("ligand = { file", "ligand = { fil", "unknown field `fil`"),
        ("1STP.pdb\" }", "1STP.pdb\", chains = [\"Z\"] }", "no chain `Z` found; one of `A`"),
        ("1STP.pdb\" }", "none.pdb\" }", "docking.protein: "),
    ] {
        let text = BIOTIN.replacen(from, to, 1);
        assert_ne!(text, BIOTIN, "{from}");
        let error = parse(&text).err().unwrap_or_else(|| panic!("{to} is taken"));
        assert!(error.contains("p.toml:") && error.contains(expected), "{error}");
    }
}

/// Bytes that no file could give are refused, whatever is wrong with them.
#[test]
fn unsound_bytes_are_refused() {
    let sound = docking_of(&problem(BIOTIN));
    assert_eq!(sound.complaint(), None);
    let changed = |change: &dyn Fn(&mut super::Docking)| {
        let mut docking = sound.clone();
        change(&mut docking);
        docking.complaint().map(|(key, _)| key)
    };
    assert_eq!(changed(&|of| of.step = f64::NAN), Some("step"));
    assert_eq!(changed(&|of| of.highest = f64::INFINITY), Some("highest"));
    assert_eq!(changed(&|of| of.bounds[0][1] = 1e9), Some("box"));
    assert_eq!(changed(&|of| of.grid.spacing = f64::NAN), Some("grid"));
    assert_eq!(changed(&|of| of.chains.clear()), Some("protein"));
    assert_eq!(changed(&|of| of.chains[0].name = "A\n".to_owned()), Some("protein"));
    let atom = |of: &mut super::Docking, change: &dyn Fn(&mut crate::structure::Atom)| {
        change(&mut of.chains[0].residues[0].atoms[0]);
    };
    assert_eq!(changed(&|of| atom(of, &|atom| atom.position.x = f64::NAN)), Some("protein"));
    assert_eq!(changed(&|of| atom(of, &|atom| atom.element = "Qq".to_owned())), Some("protein"));
    assert_eq!(changed(&|of| atom(of, &|atom| atom.name = "a b".to_owned())), None);
    // Two residues of one number would be one.
    let twice = |of: &mut super::Docking| {
        let residue = of.chains[0].residues[0].clone();
        of.chains[0].residues.push(residue);
    };
    assert_eq!(changed(&twice), Some("protein"));
}

proptest::proptest! {
    #![proptest_config(proptest::test_runner::Config::with_cases(60))]

    /// Whatever bytes come, they are refused or make a model: nothing panics.
    #[test]
    fn bytes_of_any_kind_do_no_harm(
        changes in proptest::collection::vec((0.0f64..1.0, proptest::num::u8::ANY), 1..4),
        kept in 0.0f64..1.5,
    ) {
        static SOUND: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
        let sound = SOUND.get_or_init(|| wire::encode(problem(&biotin("grid = { spacing = 2.0 }\n")).model()));
        let mut bytes = sound.clone();
        for (share, value) in changes {
            let at = (share * bytes.len() as f64) as usize;
            bytes[at] = value;
        }
        bytes.truncate((kept * bytes.len() as f64) as usize);
        if let Ok(model) = wire::decode::<crate::model::ModelKind>(&bytes)
            && model.description().sound().is_ok()
        {
            let space = model.description().space();
            let mut middle = vec![0.0; space.len()];
            space.of_cube(&vec![0.5; space.cube_dimensions()], &mut middle);
            let prepared = model.description().prepare();
            let energy = prepared.energy(&middle, &mut crate::model::Scratch::new());
            // Decoded as another model, it may have none.
            proptest::prop_assert!(energy.is_none_or(|energy| !energy.is_nan()));
        }
    }
}
