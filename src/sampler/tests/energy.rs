//! Sampling by energy keeps what its paper says.

use super::statistics::fits;
use super::{context, sampler, sets};
use crate::model::Scratch;

/// A valley along y = 0 whose energy is −1 + y² to within a hundredth: exp(x) is 1 + x + ….
const VALLEY: &str = "[landscape]\nmin = [0, -1]\nmax = [1, 1]\ntolerance = 1e-3\n\
    energy = { terms = [{ height = -100, centre = [0, 0], xx = 0, yy = -0.01 }] }\n";

/// The share kept falls linearly with the energy from −100 + 0.25 on, where |y| is about a half.
#[test]
fn configurations_are_kept_by_their_energies() {
    let cx = context(VALLEY);
    let kind = sampler("energy = { always = -99.75, never = -99.36 }");
    let configs = sets(&cx, &kind, 0..40, 100, &mut Scratch::new());
    // Cells of |y|, a tenth each; energies are −100 exp(−0.01 y²).
    let mut counts = [0; 8];
    for q in configs.iter() {
        counts[(10.0 * q[1].abs()) as usize] += 1;
    }
    let share = |y: f64| {
        let energy = -100.0 * crate::math::exp(-0.01 * y * y);
        ((-99.36 - energy) / (-99.36 + 99.75)).clamp(0.0, 1.0)
    };
    let mean = |cell: usize| {
        let of = |i: u32| share(0.1 * (cell as f64 + (f64::from(i) + 0.5) / 1000.0));
        (0..1000).map(of).sum::<f64>()
    };
    fits(&counts, &[0, 1, 2, 3, 4, 5, 6, 7].map(mean));
}

#[test]
fn a_model_without_energies_and_wrong_settings_are_refused() {
    let bodies = context(super::SCENE);
    let kind = sampler("energy = { always = -1, never = 0 }");
    assert!(kind.method().suits(&bodies).unwrap_err().contains("a model with energies expected"));
    assert!(kind.method().suits(&context(VALLEY)).is_ok());
    for (text, key) in [
        ("energy = { always = 0, never = 0 }", "never"),
        ("energy = { always = nan, never = 0 }", "never"),
        ("energy = { always = 0, never = 1, attempts = 0 }", "attempts"),
    ] {
        assert_eq!(sampler(text).method().complaint().map(|complaint| complaint.key), Some(key));
    }
}
