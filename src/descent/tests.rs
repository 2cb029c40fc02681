use super::*;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::{Purpose, Seed};
use std::path::Path;

/// The minima of the Müller-Brown potential, and their energies.
const MINIMA: [([f64; 2], f64); 3] =
    [([-0.558, 1.442], -146.700), ([0.623, 0.028], -108.167), ([-0.050, 0.467], -80.768)];

fn context(text: &str) -> Context {
    let problem = Problem::parse(Path::new("p.toml"), text);
    problem.unwrap_or_else(|error| panic!("{error}")).context()
}

fn muller_brown() -> Context {
    context("[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2.0]\nenergy = { muller-brown = {} }\n")
}

/// From wherever it starts, a descent by the gradient ends in one of the minima, or at the bounds.
#[test]
fn the_gradient_leads_to_the_minima() {
    let (cx, scratch) = (muller_brown(), &mut Scratch::new());
    let mut stream = Seed::of_set(1, "descent", Ordinal(0)).stream(Purpose::Sampling);
    let descent = Gradient { least: 0.0, ..Gradient::default() };
    let mut reached = [0; 3];
    let mut q = [0.0; 2];
    for _ in 0..300 {
        cx.space.sample_uniform(&mut stream, &mut q);
        let before = cx.model.energy(&q, scratch).unwrap();
        let energy = descent.descend(&cx, &mut stream, &mut q, scratch);
        assert_eq!(energy, cx.model.energy(&q, scratch).unwrap());
        assert!(energy <= before && cx.space.within_bounds(&q));
        let near = |([x, y], depth): &([f64; 2], f64)| {
            (q[0] - x).abs() < 2e-3 && (q[1] - y).abs() < 2e-3 && (energy - depth).abs() < 1e-2
        };
        if let Some(minimum) = MINIMA.iter().position(near) {
            reached[minimum] += 1;
        }
    }
    assert!(reached.iter().sum::<usize>() > 270 && !reached.contains(&0), "{reached:?}");
}

/// The published descent goes down, too, and ends near a minimum, though not at it.
#[test]
fn lowest_neighbors_lead_down() {
    let (cx, scratch) = (muller_brown(), &mut Scratch::new());
    let mut stream = Seed::of_set(1, "descent", Ordinal(1)).stream(Purpose::Sampling);
    let descent = LowestNeighbor { radius: 0.1, iterations: 200 };
    let mut near_minima = 0;
    let mut q = [0.0; 2];
    for _ in 0..300 {
        cx.space.sample_uniform(&mut stream, &mut q);
        let before = cx.model.energy(&q, scratch).unwrap();
        let energy = descent.descend(&cx, &mut stream, &mut q, scratch);
        assert!(energy <= before && cx.space.within_bounds(&q));
        assert_eq!(energy, cx.model.energy(&q, scratch).unwrap());
        let near = |(_, depth): &([f64; 2], f64)| (energy - depth).abs() < 10.0;
        near_minima += usize::from(MINIMA.iter().any(near));
    }
    assert!(near_minima > 150, "{near_minima}");
}

/// Hops find the deepest minimum of all from wherever they begin, which a single descent does from its own basin alone.
#[test]
fn hops_lead_to_the_lowest_minimum() {
    let (cx, scratch) = (muller_brown(), &mut Scratch::new());
    let mut stream = Seed::of_set(1, "descent", Ordinal(3)).stream(Purpose::Sampling);
    let descent = BasinHopping { hops: 60, step: 2.0, ..BasinHopping::default() };
    let mut q = [0.0; 2];
    let mut lowest = 0;
    for _ in 0..50 {
        cx.space.sample_uniform(&mut stream, &mut q);
        let energy = descent.descend(&cx, &mut stream, &mut q, scratch);
        assert_eq!(energy, cx.model.energy(&q, scratch).unwrap());
        assert!(cx.space.within_bounds(&q));
        lowest += usize::from((energy - MINIMA[0].1).abs() < 0.1);
    }
    assert!(lowest > 40, "{lowest} of 50");
}

/// Where all is flat nothing moves, and at a bound nothing leaves it.
#[test]
fn descents_stay_within_the_bounds() {
    // A slope over the whole box, down towards x = -1.
    let cx = context(
        "[landscape]\nmin = [-1.0, -1.0]\nmax = [1.0, 1.0]\n\
         energy = { terms = [{ height = -10.0, centre = [-9.0, 0.0], xx = -0.01, yy = 0.0 }] }\n",
    );
    let scratch = &mut Scratch::new();
    let mut stream = Seed::of_set(1, "descent", Ordinal(2)).stream(Purpose::Sampling);
    for (kind, reached) in [
        (DescentKind::Gradient(Gradient::default()), -0.9),
        // This one ends by chance where the few neighbours that it looks at are all higher.
        (DescentKind::LowestNeighbor(LowestNeighbor { radius: 0.3, iterations: 1000 }), 0.5),
    ] {
        let mut q = [0.5, 0.25];
        kind.method().descend(&cx, &mut stream, &mut q, scratch);
        assert!(cx.space.within_bounds(&q) && q[0] < reached, "{q:?} by {kind:?}");
        let mut corner = [-1.0, -1.0];
        kind.method().descend(&cx, &mut stream, &mut corner, scratch);
        assert!(cx.space.within_bounds(&corner) && corner[0] == -1.0, "{corner:?} by {kind:?}");
    }
}

#[test]
fn wrong_settings_and_models_without_energies_are_refused() {
    let bad = [
        DescentKind::Gradient(Gradient { longest: 0.0, ..Gradient::default() }),
        DescentKind::Gradient(Gradient { least: f64::NAN, ..Gradient::default() }),
        DescentKind::Gradient(Gradient { iterations: 0, ..Gradient::default() }),
        DescentKind::BasinHopping(BasinHopping { hops: 0, ..BasinHopping::default() }),
        DescentKind::BasinHopping(BasinHopping { kt: 0.0, ..BasinHopping::default() }),
        DescentKind::BasinHopping(BasinHopping { step: f64::NAN, ..BasinHopping::default() }),
        DescentKind::LowestNeighbor(LowestNeighbor { radius: -1.0, iterations: 1 }),
        DescentKind::LowestNeighbor(LowestNeighbor { radius: 1.0, iterations: 0 }),
    ];
    for kind in bad {
        assert!(kind.method().complaint().is_some(), "{kind:?}");
    }
    let bodies = context(
        "[space]\nmotion = \"rigid-3d\"\nmin = [0.0, 0.0, 0.0]\nmax = [1.0, 1.0, 1.0]\n\
         bounds = \"body\"\n[robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n",
    );
    for kind in [DescentKind::default(), DescentKind::LowestNeighbor(LowestNeighbor::default())] {
        assert!(kind.method().suits(&bodies).is_err());
        assert!(kind.method().complaint().is_none());
    }
}
