use super::*;
use crate::deformation::bounding_box::relaxation::relax;
use crate::model::deformable::LatticeInterpolation;
use crate::numbers::Ordinal;
use crate::scene::Mesh;
use crate::seed::{Purpose, Seed, Stream};
use proptest::prelude::*;

fn stream(ordinal: u64) -> Stream {
    Seed::of_set(22, "chainmail", Ordinal(ordinal)).stream(Purpose::Sampling)
}

/// A lattice, limits of a material, and what is demanded of some points.
fn drawn(stream: &mut Stream) -> (Lattice, Limits, Vec<usize>, Vec<Interval>) {
    let lattice = [0; 3].map(|_| 2 + stream.below(3) as u32);
    let box_of = Mesh {
        vertices: vec![[0.0; 3], [1.0, 2.0, 3.0], [1.0, 0.0, 3.0]],
        triangles: vec![[0, 1, 2]],
    };
    let settings = BoundingBoxSettings {
        lattice,
        least: [0; 3].map(|_| 0.1 + 0.9 * stream.unit()),
        greatest: [0; 3].map(|_| 1.0 + stream.unit()),
        shear: 0.5 * stream.unit(),
        order: ChainMailOrder::Queue,
        relaxation: 0,
        interpolation: LatticeInterpolation::Trilinear,
    };
    let lattice = Lattice::around(&box_of, lattice);
    let limits = Limits::new(&settings, lattice.spacing);
    let mut intervals = vec![Interval::ALL; lattice.points.len()];
    let size = 1.5 * stream.unit();
    for _ in 0..1 + stream.below(4) {
        let by = [0; 3].map(|_| size * (2.0 * stream.unit() - 1.0));
        let point = stream.below(intervals.len() as u64) as usize;
        intervals[point] = match stream.below(3) {
            0 => Interval::HELD,
            1 => Interval { least: by, greatest: by },
            _ => Interval::pushed(by),
        };
    }
    let demanded = (0..intervals.len()).filter(|i| intervals[*i] != Interval::ALL).collect();
    (lattice, limits, demanded, intervals)
}

/// Points in an order that is drawn.
fn narrow_in_any_order(
    (lattice, limits): (&Lattice, &Limits),
    demanded: &[usize],
    intervals: &mut [Interval],
    stream: &mut Stream,
) -> Result<(), Empty> {
    let mut open = demanded.to_vec();
    let mut counts = Counts::default();
    while !open.is_empty() {
        let point = open.swap_remove(stream.below(open.len() as u64) as usize);
        let changed = |neighbour| open.push(neighbour);
        pass_on(lattice, limits, point, intervals, &mut counts, changed)?;
    }
    Ok(())
}

/// Bellman and Ford: as many rounds over all pairs of neighbours as there are points.
fn bellman_ford(
    lattice: &Lattice,
    limits: &Limits,
    intervals: &mut [Interval],
) -> Result<(), Empty> {
    for _ in 0..intervals.len() {
        for point in 0..intervals.len() {
            for (axis, next, neighbour) in lattice.neighbours(point) {
                for k in 0..3 {
                    let [low, high] = limits.of[axis][k];
                    let [low, high] = if next { [low, high] } else { [-high, -low] };
                    let from = intervals[point];
                    let to = &mut intervals[neighbour];
                    to.least[k] = to.least[k].max(from.least[k] + low);
                    to.greatest[k] = to.greatest[k].min(from.greatest[k] + high);
                }
            }
        }
    }
    if intervals.iter().any(Interval::is_empty) { Err(Empty) } else { Ok(()) }
}

/// How far limits are exceeded at most.
fn excess(lattice: &Lattice, limits: &Limits, displacements: &[[f64; 3]]) -> f64 {
    let mut most = 0.0f64;
    for (point, from) in displacements.iter().enumerate() {
        for (axis, next, neighbour) in lattice.neighbours(point) {
            for k in (0..3).filter(|_| next) {
                let difference = displacements[neighbour][k] - from[k];
                let [low, high] = limits.of[axis][k];
                most = most.max(low - difference).max(difference - high);
            }
        }
    }
    most
}

proptest! {
    /// The laws of the module's documentation.
    #[test]
    fn it_ends_keeps_limits_whatever_the_order_and_refuses_what_bellman_and_ford_do(
        ordinal in any::<u64>(), sweeps in 0u32..5,
    ) {
        let mut stream = stream(ordinal);
        let (lattice, limits, demanded, start) = drawn(&mut stream);
        let mut expected = start.clone();
        let verdict = bellman_ford(&lattice, &limits, &mut expected);
        let bits = |intervals: &[Interval]| -> Vec<u64> {
            let bounds = intervals.iter().flat_map(|i| i.least.into_iter().chain(i.greatest));
            bounds.map(f64::to_bits).collect()
        };
        let mut orders = Vec::new();
        for order in [ChainMailOrder::Queue, ChainMailOrder::MostReached] {
            let mut found = start.clone();
            let counts = &mut Counts::default();
            let end = narrow(order, &lattice, &limits, &demanded, &mut found, counts);
            orders.push((end, found));
        }
        for _ in 0..3 {
            let mut found = start.clone();
            let both = (&lattice, &limits);
            let end = narrow_in_any_order(both, &demanded, &mut found, &mut stream);
            orders.push((end, found));
        }
        for (end, found) in &orders {
            prop_assert_eq!(*end, verdict);
            if end.is_ok() {
                prop_assert_eq!(bits(found), bits(&orders[0].1));
                for (one, other) in found.iter().zip(&expected) {
                    prop_assert_eq!(one, other);
                }
            }
        }
        if verdict.is_ok() {
            let intervals = &orders[0].1;
            let mut displacements: Vec<[f64; 3]> =
                intervals.iter().map(|interval| interval.nearest([0.0; 3])).collect();
            prop_assert!(excess(&lattice, &limits, &displacements) <= 1e-12);
            relax(&lattice, intervals, sweeps, &mut displacements);
            prop_assert!(excess(&lattice, &limits, &displacements) <= 1e-12);
            for (interval, by) in start.iter().zip(&displacements) {
                prop_assert_eq!(interval.nearest(*by), *by);
            }
        }
    }
}
