//! What a roadmap says of an energy whose saddles are known: the potential of Müller and Brown.

use roadmill::img::{
    Core, Cut, Grown, Judgement, Observer, Progress, Round, Serial, Setup, Stop, build_in_threads,
    drive,
};
use roadmill::math;
use roadmill::model::{Directed, Scratch};
use roadmill::problem::Problem;
use roadmill::roadmap::Tally;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

/// The shipped problem with another seed, limit and criteria.
fn problem(seed: u64, nodes: u64, evaluators: &str) -> Arc<Setup> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/muller-brown.toml");
    let text = std::fs::read_to_string(&path).expect("it ships");
    let (begin, _) = text.split_once("# The higher saddle").expect("its criteria come last");
    let begin = begin.replace("seed = 1", &format!("seed = {seed}"));
    let text = format!("evaluators = [{evaluators}]\n{begin}\n[limits]\nnodes = {nodes}\n");
    let problem = Problem::parse(&path, &text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((problem.seed(), problem.limits().nodes), (seed, nodes));
    Arc::new(Setup::new(problem))
}

/// Never met, so that a build goes on to its limit.
const BARRIER: &str = "{ lowest-barrier = { energy = -1000.0 } }";
const FLOW: &str = "{ max-flow = { flow = 1e9, least_weight = 1.0 } }";

/// Energy, gradient and second derivatives (xx, xy, yy) of the potential as its authors give it, written down again.
fn potential([x, y]: [f64; 2]) -> (f64, [f64; 2], [f64; 3]) {
    // Height, a, b, c and centre of each term.
    let terms = [
        (-200.0, [-1.0, 0.0, -10.0], [1.0, 0.0]),
        (-100.0, [-1.0, 0.0, -10.0], [0.0, 0.5]),
        (-170.0, [-6.5, 11.0, -6.5], [-0.5, 1.5]),
        (15.0, [0.7, 0.6, 0.7], [-1.0, 1.0]),
    ];
    let (mut energy, mut slope, mut bend) = (0.0, [0.0; 2], [0.0; 3]);
    for (height, [a, b, c], centre) in terms {
        let (u, v) = (x - centre[0], y - centre[1]);
        let term = height * math::exp(a * u * u + b * u * v + c * v * v);
        let (along_x, along_y) = (2.0 * a * u + b * v, b * u + 2.0 * c * v);
        energy += term;
        slope[0] += term * along_x;
        slope[1] += term * along_y;
        bend[0] += term * (along_x * along_x + 2.0 * a);
        bend[1] += term * (along_x * along_y + b);
        bend[2] += term * (along_y * along_y + 2.0 * c);
    }
    (energy, slope, bend)
}

/// The stationary point near `at`, by Newton's method, with its energy and whether it is a minimum.
fn stationary(mut at: [f64; 2]) -> ([f64; 2], f64, bool) {
    for _ in 0..20 {
        let (_, [gx, gy], [xx, xy, yy]) = potential(at);
        let determinant = xx * yy - xy * xy;
        at[0] -= (yy * gx - xy * gy) / determinant;
        at[1] -= (xx * gy - xy * gx) / determinant;
    }
    let (energy, slope, [xx, xy, yy]) = potential(at);
    assert!(slope.iter().all(|slope| slope.abs() < 1e-9), "{slope:?} at {at:?}");
    (at, energy, xx * yy - xy * xy > 0.0 && xx > 0.0)
}

/// The energy of the saddle between the two deep minima: what every way between them has to reach.
fn saddle() -> f64 {
    stationary([-0.822, 0.624]).1
}

/// The literature's stationary points, to their digits.
#[test]
fn minima_and_saddles_are_those_of_the_literature() {
    let setup = problem(1, 100, BARRIER);
    for (at, expected, is_minimum) in [
        ([-0.558, 1.442], -146.700, true),
        ([0.623, 0.028], -108.167, true),
        ([-0.050, 0.467], -80.768, true),
        ([-0.822, 0.624], -40.665, false),
        ([0.212, 0.293], -72.249, false),
    ] {
        let (found, energy, minimum) = stationary(at);
        assert_eq!(minimum, is_minimum, "{at:?}");
        // Half of the last digit that is given.
        assert!((0..2).all(|i| (found[i] - at[i]).abs() <= 5e-4), "{found:?}, not {at:?}");
        assert!((energy - expected).abs() <= 5e-4, "{energy}, not {expected}");
        let of_model =
            setup.context().model().energy(&found, &mut Scratch::new()).expect("it has energies");
        assert!((of_model - energy).abs() < 1e-10, "{of_model}, not {energy}");
    }
}

/// The seeds are not those by which the problem's settings were chosen.
#[test]
fn the_lowest_barrier_is_the_saddle_for_every_seed() {
    let saddle = saddle();
    let barriers: Vec<(u64, f64)> = (101..=120)
        .map(|seed| {
            let build = build_in_threads(&problem(seed, 5000, BARRIER), 2);
            assert_eq!((build.stop, build.roadmap.configs().len()), (Stop::NodeLimit, 5000));
            (seed, build.judgement.expect("every round was judged").verdicts[0].value)
        })
        .collect();
    for (seed, barrier) in &barriers {
        println!("seed {seed}: barrier {barrier:.4}, {:.4} above the saddle", barrier - saddle);
    }
    for (seed, barrier) in barriers {
        assert!(barrier >= saddle, "seed {seed}: {barrier} is below the saddle, {saddle}");
        assert!(barrier <= -40.665 + 0.1, "seed {seed}: {barrier} is above the saddle, {saddle}");
    }
}

/// Keeps the values of all verdicts.
#[derive(Default)]
struct Values(Vec<[f64; 2]>);

impl Observer for Values {
    type Error = Infallible;

    fn folded(&mut self, _: &Round, _: &Tally) -> Result<(), Infallible> {
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        self.0.push([0, 1].map(|index| judgement.verdicts[index].value));
        Ok(())
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Infallible> {
        Ok(None)
    }
}

#[test]
fn no_flow_falls_and_no_barrier_rises_from_round_to_round() {
    for seed in 201..=205 {
        let setup = problem(seed, 2000, &format!("{FLOW}, {BARRIER}"));
        let (mut core, mut values) = (Core::new(&setup, 0), Values::default());
        let Ok(stop) = drive(&mut core, &mut Serial::new(setup.clone()), &mut values);
        assert_eq!(stop, Stop::NodeLimit);
        let Values(values) = values;
        for pair in values.windows(2) {
            let [[flow, barrier], [later_flow, later_barrier]] = [pair[0], pair[1]];
            assert!(later_flow >= flow, "seed {seed}: {later_flow} after {flow}");
            assert!(later_barrier <= barrier, "seed {seed}: {later_barrier} after {barrier}");
        }
        let [first, last] = [values[0], values[values.len() - 1]];
        assert!(last[0] > first[0] && last[1].is_finite(), "something has changed: {values:?}");
    }
}

#[test]
fn edges_cost_what_energies_say_and_peaks_are_above_all_energies() {
    let setup = problem(301, 1000, BARRIER);
    let Grown { roadmap, .. } = build_in_threads(&setup, 2);
    let (cx, scratch) = (setup.context(), &mut Scratch::new());
    let tolerance = 0.001;
    for (index, edge) in roadmap.edges().iter().enumerate() {
        let ends = [edge.low, edge.high].map(|node| roadmap.configs().get(node.index()));
        let energies = ends.map(|q| cx.model().energy(q, scratch).expect("it has energies"));
        let values = [edge.low, edge.high].map(|node| roadmap.values_of(node, 1)[0]);
        assert_eq!(energies, values, "a milestone carries its energy");
        let Directed { forward, backward, peak } = edge.cost.directed().expect("a directed cost");
        // To the last bit: a climb is the peak less the energy at the end where it begins.
        assert_eq!([forward, backward], energies.map(|energy| peak - energy));
        let difference = (forward - backward) - (energies[1] - energies[0]);
        assert!(difference.abs() <= 1e-12, "{difference}");

        // Every eighth edge is looked at closely.
        if index % 8 == 0 {
            const POINTS: u32 = 500;
            let mut highest = f64::NEG_INFINITY;
            let mut q = [0.0; 2];
            for i in 0..=POINTS {
                cx.space().interpolate(ends[0], ends[1], f64::from(i) / f64::from(POINTS), &mut q);
                highest = highest.max(cx.model().energy(&q, scratch).expect("it has energies"));
            }
            assert!(highest <= peak, "{highest} on an edge with the peak {peak}");
            // Between two of the points the energy may be a little higher.
            assert!(peak <= highest + tolerance + 0.01, "{peak} is no energy of this edge");
        }
    }
    assert!(roadmap.edges().len() > 5000, "many edges were looked at");
}
