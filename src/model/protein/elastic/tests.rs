//! Steps of the elastic network of chignolin (1UAO).

use crate::model::{Draw, Model, Scratch};
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::{Purpose, Seed};
use crate::structure::measure::rmsd;
use std::path::Path;

fn model() -> Box<dyn Model> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/p.toml");
    let text = "[protein]\nsource = { file = \"structures/1UAO.pdb\" }\n";
    Problem::parse(&file, text).expect("it is sound").model().description().prepare()
}

fn deviates(count: usize, set: u64) -> Vec<f64> {
    let mut stream = Seed::of_set(7, "elastic", Ordinal(set)).stream(Purpose::Sampling);
    (0..count).map(|_| stream.normal()).collect()
}

#[test]
fn random_steps_are_as_long_as_is_asked_and_stretch_bonds_less_than_noise_does() {
    let (model, scratch) = (model(), &mut Scratch::new());
    let native = model.native().expect("a protein has one").to_vec();
    let here = model.shape(&native, scratch).expect("it has Cα");
    let elastic = model.elastic(&native).expect("a protein is a network");
    let energy = |q: &[f64], scratch: &mut Scratch| model.energy(q, scratch).expect("it has one");
    let (mut stretched, mut of_noise) = (0.0, 0.0);
    for set in 0..20 {
        let z = deviates(native.len(), set);
        let q = elastic.random(&z, 0.4).expect("it moves");
        assert_eq!(Some(&q), elastic.random(&z, 0.4).as_ref());
        let length = rmsd(&model.shape(&q, scratch).unwrap(), &here);
        assert!((length - 0.4).abs() < 0.02, "{length} Å");
        stretched += energy(&q, scratch) / 20.0;
        // Noise on all torsions alike, as long.
        let moved = |degrees: f64| -> Vec<f64> {
            native.iter().zip(&z).map(|(value, z)| value + degrees * z / 57.3).collect()
        };
        let (mut low, mut high) = (0.0, 60.0);
        for _ in 0..30 {
            let middle = (low + high) / 2.0;
            let far = rmsd(&model.shape(&moved(middle), scratch).unwrap(), &here) > 0.4;
            if far { high = middle } else { low = middle }
        }
        of_noise += energy(&moved(low), scratch) / 20.0;
    }
    let rest = energy(&native, scratch);
    assert!(stretched - rest < 0.5 * (of_noise - rest), "{rest}: {stretched}, {of_noise}");
}

#[test]
fn steps_toward_a_configuration_get_there() {
    let (model, scratch) = (model(), &mut Scratch::new());
    let native = model.native().expect("a protein has one").to_vec();
    let there: Vec<f64> =
        native.iter().zip(deviates(native.len(), 3)).map(|(q, z)| q + 0.15 * z).collect();
    let target = model.shape(&there, scratch).unwrap();
    let apart = |q: &[f64], scratch: &mut Scratch| rmsd(&model.shape(q, scratch).unwrap(), &target);
    let first = apart(&native, scratch);
    let mut q = native.clone();
    for _ in 0..40 {
        let elastic = model.elastic(&q).unwrap();
        let draw = Draw { target: &there, residues: 0..target.len(), strength: 100.0 };
        let next = elastic.toward(&draw, 0.3).expect("it moves");
        let here = model.shape(&q, scratch).unwrap();
        assert!(rmsd(&model.shape(&next, scratch).unwrap(), &here) < 0.31);
        q = next;
    }
    let last = apart(&q, scratch);
    assert!(first > 0.3 && last < 0.3 * first, "{first} → {last} Å");
}

#[test]
fn what_is_not_there_draws_nothing() {
    let model = model();
    let native = model.native().expect("a protein has one").to_vec();
    let elastic = model.elastic(&native).unwrap();
    for (target, residues) in [(&native[1..], 0..10), (&native[..], 0..11), (&native[..], 5..5)] {
        assert_eq!(elastic.toward(&Draw { target, residues, strength: 1.0 }, 0.5), None);
    }
    assert_eq!(elastic.random(&[0.0; 3], 0.5), None);
    assert_eq!(elastic.random(&vec![f64::NAN; native.len()], 0.5), None);
    // Nothing moves.
    assert_eq!(elastic.random(&vec![0.0; native.len()], 0.5), None);
}
