//! Torsion noise keeps what its papers say.

use super::statistics::fits;
use super::{SCENE, context, sampler, sets};
use crate::context::Context;
use crate::math;
use crate::model::protein::{ChainSpec, ProteinSpec};
use crate::model::{ModelKind, Scratch};
use crate::problem::Problem;
use crate::sampler::{SamplerKind, WIDTHS};
use crate::seed::Seed;
use std::f64::consts::PI;
use std::path::Path;

/// A peptide of ten residues without rules, so that every conformation is valid.
fn peptide() -> Context {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/free.toml");
    let text = "[protein]\nsource = { file = \"structures/1UAO.pdb\" }\n\
        rules = { alpha-carbons = 0, side-chains = 0, nitrogen-oxygen = 0, backbone = 0, motion-alpha-carbons = 0, \
        motion-side-chains = 0 }\n";
    Problem::parse(&path, text).unwrap_or_else(|error| panic!("{error}")).context()
}

/// A sampler with windows that keep everything.
fn open(degrees: &str, count: usize) -> SamplerKind {
    let windows = vec!["[1e9, 2e9]"; count].join(", ");
    sampler(&format!("torsion-noise = {{ degrees = {degrees}, windows = [{windows}] }}"))
}

/// Milestone number m has width number m mod 2, through all sets; deviations are normal with that width.
#[test]
fn widths_take_turns_and_deviations_are_normal() {
    let cx = peptide();
    let configs = sets(&cx, &open("[2.0, 20.0]", 2), 0..8, 75, &mut Scratch::new());
    let native = cx.model.native().expect("a protein has one").to_vec();
    // Shares of a normal distribution in cells of half a deviation, from -1 to 1 and beyond.
    let shares = [0.158_655, 0.149_882, 0.191_462, 0.191_462, 0.149_882, 0.158_655];
    for width in 0..2 {
        let deviation = [2.0, 20.0][width] * PI / 180.0;
        let mut counts = [0; 6];
        for q in configs.iter().skip(width).step_by(2) {
            for (value, about) in q.iter().zip(&native) {
                let turned = math::wrap_angle(value - about) / deviation;
                let cell = [-1.0, -0.5, 0.0, 0.5, 1.0].iter().filter(|end| turned > **end).count();
                counts[cell] += 1;
            }
        }
        fits(&counts, &shares);
    }
}

/// The share kept falls linearly from E_min to E_max.
#[test]
fn conformations_are_kept_by_their_energies() {
    let cx = peptide();
    let scratch = &mut Scratch::new();
    let kind = open("[10.0]", 1);
    let all = sets(&cx, &kind, 0..20, 100, scratch);
    let mut energies: Vec<f64> =
        all.iter().map(|q| cx.model.energy(q, scratch).expect("a protein has one")).collect();
    energies.sort_by(f64::total_cmp);
    let (always, never) = (energies[500], energies[1500]);
    let text =
        format!("torsion-noise = {{ degrees = [10.0], windows = [[{always:?}, {never:?}]] }}");
    let kept = sets(&cx, &sampler(&text), 100..120, 100, scratch);
    // Cells of a quarter of what was drawn without a window.
    let ends = [energies[500], energies[1000], energies[1500]];
    let cell = |energy: f64| ends.iter().filter(|end| energy > **end).count();
    let mut counts = [0; 4];
    for q in kept.iter() {
        counts[cell(cx.model.energy(q, scratch).expect("a protein has one"))] += 1;
    }
    let mut shares = [0.0; 4];
    for energy in &energies {
        shares[cell(*energy)] += ((never - energy) / (never - always)).clamp(0.0, 1.0);
    }
    assert_eq!(counts[3], 0, "{counts:?}");
    // The expected shares are themselves of 2000 draws, so that only large differences count.
    let (kept, expected): (f64, f64) =
        (counts.iter().map(|c| f64::from(*c)).sum(), shares.iter().sum());
    for (count, share) in counts.iter().zip(&shares) {
        let (found, wanted) = (f64::from(*count) / kept, share / expected);
        assert!((found - wanted).abs() < 0.05, "{counts:?} {shares:?}");
    }
}

#[test]
fn windows_are_found_once_from_the_seed() {
    let cx = peptide();
    let calibrated = |seed: u64| {
        let mut kind = sampler("torsion-noise = { degrees = [2.0, 20.0] }");
        kind.method_mut().calibrate(&cx, &Seed::of_calibration(seed, "noise"));
        kind
    };
    assert_eq!(calibrated(1), calibrated(1));
    assert_ne!(calibrated(1), calibrated(2));
    let SamplerKind::TorsionNoise(noise) = calibrated(1) else { panic!("torsion noise expected") };
    let [[low, high], [wide_low, wide_high]] = noise.windows[..] else { panic!("{noise:?}") };
    assert!(low < high && wide_low < wide_high && high < wide_low, "{noise:?}");
    // What is there is not found again.
    let mut again = calibrated(1);
    again.method_mut().calibrate(&cx, &Seed::of_calibration(2, "noise"));
    assert_eq!(again, calibrated(1));
}

#[test]
fn what_it_cannot_work_with_is_refused() {
    let cx = peptide();
    for (text, expected) in [
        ("torsion-noise = { degrees = [2.0] }", "0 windows found; 1 expected"),
        ("torsion-noise = { degrees = [2.0], windows = [[0, 1], [0, 1]] }", "2 windows found"),
        ("torsion-noise = { about = \"ends\" }", "no [query]"),
    ] {
        let refused = sampler(text).method().suits(&cx).unwrap_err();
        assert!(refused.contains(expected), "{refused}");
    }
    assert!(open("[2.0]", 1).method().suits(&cx).is_ok());
    assert!(
        open("[2.0]", 1).method().suits(&context(SCENE)).unwrap_err().contains("angles expected")
    );
    for (text, key) in [
        ("torsion-noise = { degrees = [], windows = [[0.0, 1.0]] }", "degrees"),
        ("torsion-noise = { degrees = [nan] }", "degrees"),
        ("torsion-noise = { degrees = [361.0] }", "degrees"),
        ("torsion-noise = { degrees = [1.0], windows = [[1.0, 1.0]] }", "windows"),
        ("torsion-noise = { degrees = [1.0], windows = [[0.0, inf]] }", "windows"),
        ("torsion-noise = { attempts = 0 }", "attempts"),
    ] {
        assert_eq!(sampler(text).method().complaint().map(|complaint| complaint.key), Some(key));
    }
}

/// Widths that are left open are those that the chain can be drawn with.
#[test]
fn widths_are_found_that_are_feasible() {
    let found = |cx: &Context| {
        let mut kind = sampler("torsion-noise = {}");
        kind.method_mut().calibrate(cx, &Seed::of_calibration(1, "noise"));
        assert_eq!(kind.method().suits(cx), Ok(()));
        let SamplerKind::TorsionNoise(noise) = kind else { panic!("torsion noise expected") };
        noise.degrees
    };
    // Without rules all are.
    assert_eq!(found(&peptide()), WIDTHS);
    // With distances that no conformation keeps the least remains.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/strict.toml");
    let text =
        "[protein]\nsource = { file = \"structures/1UAO.pdb\" }\nrules = { alpha-carbons = 9.0 }\n";
    let strict = Problem::parse(&path, text).unwrap_or_else(|error| panic!("{error}")).context();
    assert_eq!(found(&strict), [WIDTHS[0]]);
}

/// Sets about the ends of a query depend on it: it is part of the digest, and with another a build goes on by other strategies only.
#[test]
fn the_query_belongs_to_what_is_drawn_about_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/ends.toml");
    let problem = |label: &str, about: &str, turn: f64| {
        let start: Vec<f64> = peptide().model.native().expect("a protein has one").to_vec();
        let mut goal = start.clone();
        goal[3] += turn;
        let text = format!(
            "[protein]\nsource = {{ file = \"structures/1UAO.pdb\" }}\n[query]\nstart = {start:?}\ngoal = {goal:?}\n\
             [[strategies]]\nlabel = \"{label}\"\nnodes = 4\nsampler = {{ torsion-noise = {{ degrees = [2.0], \
             about = \"{about}\", windows = [{}] }} }}\n",
            vec!["[1e9, 2e9]"; if about == "ends" { 2 } else { 1 }].join(", ")
        );
        Problem::parse(&path, &text).unwrap_or_else(|error| panic!("{error}"))
    };
    let [one, other] = [0.01, 0.02].map(|turn| problem("noise", "ends", turn));
    assert_ne!(one.digest(), other.digest());
    let refused = one.continued(&other, 1).unwrap_err();
    assert!(refused.contains("the ends of the query"), "{refused}");
    assert!(one.continued(&one, 1).is_ok());
    let continued = one.continued(&problem("other", "ends", 0.02), 1).expect("by other strategies");
    assert_eq!((continued.query(), continued.strategies().len()), (other.query(), 2));
    // Sets about the native state do not know the query.
    let [one, other] = [0.01, 0.02].map(|turn| problem("noise", "native", turn));
    assert_eq!(one.digest(), other.digest());
    assert!(one.continued(&other, 1).is_ok());
}

/// Two chains of equal length that lack different atoms, with one working memory.
#[test]
fn memory_of_another_chain_does_not_mislead() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/two.toml");
    let prepare = |problem: &Problem| problem.model().description().prepare();
    let text = "[protein]\nsource = { file = \"structures/1UAO.pdb\" }\n";
    let problem = Problem::parse(&path, text).unwrap_or_else(|error| panic!("{error}"));
    let ModelKind::Protein(protein) = problem.model() else { panic!("a protein expected") };
    let mut bare = protein.source().to_vec();
    for residue in &mut bare {
        residue.atoms.retain(|atom| ["N", "CA", "C", "O"].contains(&atom.name.as_str()));
    }
    let spec = ProteinSpec::new(ChainSpec::Residues(bare));
    let other = Problem::builder("bare", spec).build().unwrap_or_else(|error| panic!("{error}"));
    let (whole, bare) = (prepare(&problem), prepare(&other));
    let native = whole.native().expect("a protein has one");
    let scratch = &mut Scratch::new();
    for _ in 0..2 {
        for model in [&whole, &bare] {
            let alone = model.energy(native, &mut Scratch::new());
            assert_eq!(model.energy(native, scratch), alone);
            let alone = model.validity(native, &mut Scratch::new());
            assert_eq!(model.validity(native, scratch), alone);
        }
    }
    assert_ne!(whole.energy(native, scratch), bare.energy(native, scratch));
}
