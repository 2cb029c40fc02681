use super::bound::{Interval, peak};
use super::energy::energy;
use super::*;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::{Purpose, Seed};
use proptest::prelude::*;
use std::path::Path;

const FILE: &str = "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2.0]\n\
                    energy = { muller-brown = {} }\n";

fn parse(text: &str) -> Result<Problem, String> {
    Problem::parse(Path::new("p.toml"), text).map_err(|error| error.to_string())
}

/// The stationary points that the literature gives, to their digits.
#[test]
fn the_energy_is_that_of_muller_and_brown() {
    let terms = Energy::MullerBrown.terms();
    for (x, y, expected) in [
        (-0.558, 1.442, -146.700),
        (0.623, 0.028, -108.167),
        (-0.050, 0.467, -80.768),
        (-0.822, 0.624, -40.665),
        (0.212, 0.293, -72.249),
    ] {
        let found = energy(&terms, [x, y]);
        assert!((found - expected).abs() < 2e-3, "{found} at ({x}, {y}), {expected} expected");
    }
}

proptest! {
    /// Motions of all lengths: no energy on the way exceeds the peak, and one comes near it.
    #[test]
    fn peaks_are_above_all_energies_and_within_the_tolerance(
        a in [-1.5f64..1.2, -0.5f64..2.0], b in [-1.5f64..1.2, -0.5f64..2.0], scale in 0u32..12,
        tolerance in 1e-6f64..1.0,
    ) {
        let share = 1.0 / f64::from(1u32 << scale);
        let b = [0, 1].map(|i| a[i] + share * (b[i] - a[i]));
        let terms = Energy::MullerBrown.terms();
        let found = peak(&terms, [a, b], tolerance, &mut vec![Interval::rubbish(3)]);
        let highest = (0..=20_000)
            .map(|i| f64::from(i) / 20_000.0)
            .map(|t| energy(&terms, [0, 1].map(|i| a[i] + t * (b[i] - a[i]))))
            .fold(f64::NEG_INFINITY, f64::max);
        prop_assert!(highest <= found, "{highest} on the way, above {found}");
        // Between two of the samples the energy may be a little higher.
        prop_assert!(found <= highest + tolerance + 1e-3, "{found}, highest {highest}");
    }
}

#[test]
fn costs_there_and_back_differ_as_the_energies_of_the_ends() {
    let cx = parse(FILE).unwrap().context();
    let mut stream = Seed::of_set(1, "landscape", Ordinal(0)).stream(Purpose::Sampling);
    let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
    let scratch = &mut Scratch::new();
    for _ in 0..1000 {
        cx.space.sample_uniform(&mut stream, &mut a);
        cx.space.sample_uniform(&mut stream, &mut b);
        let Some(Cost::Directed(cost)) = cx.model.motion(&a, &b, 1, scratch) else {
            panic!("every motion in the bounds is valid");
        };
        let Some(Cost::Directed(back)) = cx.model.motion(&b, &a, 1, scratch) else {
            panic!("so is the motion back");
        };
        let [at_a, at_b] = [a, b].map(|q| cx.model.energy(&q, scratch).unwrap());
        let size = at_a.abs().max(at_b.abs()).max(cost.peak.abs());
        assert!((cost.forward - cost.backward - (at_b - at_a)).abs() <= 1e-12 * size);
        assert!((cost.forward - back.backward).abs() <= 0.01 + 1e-9 * size);
        assert!(cost.forward >= 0.0 && cost.backward >= 0.0);
    }
}

/// Energies so large that rounding exceeds the tolerance: the search ends where halving brings the bounds no nearer.
#[test]
fn the_search_for_a_peak_ends_at_rounding() {
    let saddle = "[landscape]\nmin = [-4, -4]\nmax = [4, 4]\nenergy = { terms = [{ height = 1, \
                  centre = [0, 0], xx = 1.5, yy = -1 }] }\n";
    let cx = parse(saddle).unwrap().context();
    let scratch = &mut Scratch::new();
    // Across the ridge, whose top is between the ends.
    let (a, b) = ([3.9, -3.0], [3.95, 3.5]);
    let Some(Cost::Directed(cost)) = cx.model.motion(&a, &b, 20, scratch) else {
        panic!("every motion in the bounds is valid");
    };
    let top = cx.model.energy(&[3.92, 0.0], scratch).unwrap();
    assert!(cost.peak >= top && cost.peak < 2.0 * top, "{} for {top}", cost.peak);
}

#[test]
fn what_is_above_the_highest_valid_energy_is_invalid() {
    let cx = parse(&format!("{FILE}highest = -60.0\n")).unwrap().context();
    let scratch = &mut Scratch::new();
    let [left, right] = [[-0.558, 1.442], [0.623, 0.028]];
    assert!(cx.model.is_valid(&left, scratch) && cx.model.is_valid(&right, scratch));
    // Between the deep minima lies a saddle at −40.7.
    assert_eq!(cx.model.motion(&left, &right, 1, scratch), None);
    assert_eq!(cx.model.validity(&[-1.0, 0.0], scratch), Validity::Invalid);
    assert_eq!(cx.model.validity(&[-2.0, 0.0], scratch), Validity::OutOfBounds);
}

#[test]
fn wrong_tables_are_named() {
    let term = "{ height = 1, centre = [0, 0], xx = -1, yy = -1 }";
    for (from, to, expected) in [
        ("[1.2, 2.0]", "[-1.6, 2.0]", "p.toml:3: landscape.max: in x max = -1.6 found"),
        ("[1.2, 2.0]", "[1.2, nan]", "p.toml:3: landscape.max: [1.2, NaN] found"),
        ("muller-brown = {}", "morse = {}", "p.toml:4: unknown variant `morse`"),
        ("{ muller-brown = {} }", "{ terms = [] }", "landscape.energy: 0 terms found"),
        (
            "{ muller-brown = {} }",
            &format!("{{ terms = [{term}, {}] }}", term.replace("-1,", "1e6,")),
            "landscape.energy: terms[1]: exponents of up to",
        ),
        ("[landscape]", "[landscape]\ntolerance = 0", "landscape.tolerance: 0 found"),
        ("[landscape]", "[landscape]\nheighest = 0", "unknown field `heighest`"),
        ("[landscape]", "[landscape]\nhighest = inf", "landscape.highest: inf found"),
        ("[landscape]", "obstacles = []\n[landscape]", "unknown field `obstacles`"),
    ] {
        let error = parse(&FILE.replace(from, to)).unwrap_err();
        assert!(error.starts_with("p.toml:") && error.contains(expected), "{error}");
    }
}

#[test]
fn what_is_written_is_read_again() {
    let terms =
        "{ terms = [{ height = 0.1, centre = [0.3, 1e-7], xx = -1.1, xy = 0.2, yy = -3 }] }";
    for text in [FILE.to_owned(), FILE.replace("{ muller-brown = {} }", terms) + "highest = 3.5\n"]
    {
        let problem = parse(&text).unwrap();
        let written = problem.to_toml("files");
        let again = parse(&written.text).unwrap();
        assert_eq!(again.model, problem.model);
        assert_eq!(again.digest(), problem.digest());
        let (layout, bytes) = problem.to_bytes();
        assert_eq!(Problem::from_bytes(layout, &bytes).unwrap(), problem);
    }
}
