use super::*;
use crate::math;
use crate::numbers::Ordinal;
use crate::scene::{Mesh, box_surface};
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{Configs, Factor, FactorKind, Space};
use std::f64::consts::PI;

fn stream(label: &str, ordinal: u64) -> Stream {
    Seed::of_set(5, label, Ordinal(ordinal)).stream(Purpose::Sampling)
}

fn boxed(size: [f64; 3]) -> Mesh {
    let (vertices, triangles) = box_surface(size);
    Mesh { vertices: vertices.to_vec(), triangles }
}

#[test]
fn cells_have_the_areas_of_what_is_in_them() {
    let grid = Grid::new([-4.0, -4.0, -4.0], [4.0, 4.0, 4.0], [4, 4, 1]).unwrap();
    // A cube around the origin, an eighth of whose corner stands in each of the four middle cells: three sides of 1 by 1 and of 1 by 2.
    let areas = grid.areas(&boxed([2.0; 3]));
    for (cell, area) in areas.iter().enumerate() {
        let expected = if [5, 6, 9, 10].contains(&cell) { 6.0 } else { 0.0 };
        assert!((area - expected).abs() < 1e-12, "{areas:?}");
    }
    // Sides across all cells: nothing is lost and nothing counts twice.
    let size = [7.1, 5.3, 6.7];
    let whole = 2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
    let fine = Grid::new([-4.0; 3], [4.0; 3], [7, 5, 3]).unwrap();
    assert!((fine.areas(&boxed(size)).iter().sum::<f64>() - whole).abs() < 1e-9);
    assert_eq!(Grid::new([0.0; 3], [1.0, 1.0, 0.0], [1; 3]), None);
    assert_eq!(Grid::new([0.0; 3], [1.0; 3], [1, 0, 1]), None);
    assert_eq!(Grid::new([0.0; 3], [1.0; 3], [1 << 40, 1 << 40, 1]), None);
    assert_eq!((grid.cell_of([4.0, 4.0, 4.0]), grid.cell_of([-4.0; 3])), (Some(15), Some(0)));
    assert_eq!((grid.cell_of([0.0, -2.1, 0.0]), grid.cell_of([4.1, 0.0, 0.0])), (Some(2), None));
    assert_eq!(grid.cell_of([f64::NAN, 0.0, 0.0]), None);
}

/// On a circle the distances of independent uniform points are exponential, so that mean and deviation are alike, π / n; of points
/// that stand evenly the deviation is 0.
#[test]
fn distances_from_the_nearest_tell_chance_from_evenness() {
    let factors = vec![Factor { kind: FactorKind::Angle, at: 0, weight: 1.0 }];
    let dofs = vec![crate::space::Dof { name: "theta".to_owned(), unit: "rad" }];
    let space = Space::new(factors, dofs, 0);
    let count = 1500;
    let (mut drawn, mut even) = (Configs::new(1), Configs::new(1));
    let mut stream = stream("circle", 0);
    for i in 0..count {
        let mut q = [0.0];
        space.sample_uniform(&mut stream, &mut q);
        drawn.push(&q);
        even.push(&[math::wrap_angle(2.0 * PI * f64::from(i) / f64::from(count))]);
    }
    let spread = |configs| Spread::of(&nearest_distances(&space, configs)).unwrap();
    let expected = PI / f64::from(count);
    let by_chance = spread(&drawn);
    assert!((by_chance.mean / expected - 1.0).abs() < 0.1, "{by_chance:?}");
    assert!((by_chance.deviation / expected - 1.0).abs() < 0.15, "{by_chance:?}");
    let evenly = spread(&even);
    assert!((evenly.mean / (2.0 * expected) - 1.0).abs() < 1e-9 && evenly.deviation < 1e-12);
    let mut one = Configs::new(1);
    one.push(&[0.0]);
    assert_eq!((nearest_distances(&space, &one), Spread::of(&[])), (Vec::new(), None));
}

/// Points on the sides of a box, each drawn as often as its triangle is large.
#[test]
fn triangles_are_hit_as_often_as_they_are_large() {
    let mesh = boxed([4.0, 2.0, 1.0]);
    let areas = triangle_areas(&mesh);
    assert!((areas.iter().sum::<f64>() - 28.0).abs() < 1e-12);
    let mut draw = stream("triangles", 0);
    let mut points = Vec::new();
    for (face, area) in mesh.faces().zip(&areas) {
        let [a, b, c] = face.map(|corner| mesh.vertices[corner as usize]);
        for _ in 0..(10.0 * area) as usize {
            let (mut u, mut v) = (draw.unit(), draw.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            points.push([0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])));
        }
    }
    let counts = triangle_counts(&mesh, &points);
    for (count, area) in counts.iter().zip(&areas) {
        assert!((*count as f64 - 10.0 * area).abs() <= 1.0, "{counts:?}");
    }
}

/// Counts of a run: `segments` draws of a cell by its share, each counted `hits` times.
fn run(draw: &mut Stream, shares: &[f64], segments: usize, hits: usize) -> Vec<usize> {
    let mut counts = vec![0; shares.len()];
    for _ in 0..segments {
        let mut at = draw.unit() * shares.iter().sum::<f64>();
        let cell = shares.iter().position(|share| {
            at -= share;
            at < 0.0
        });
        counts[cell.unwrap_or(shares.len() - 1)] += hits;
    }
    counts
}

/// How many of 200 studies, of 40 runs each, find the law wrong at the level of 5 %.
fn rejected(shares: &[f64], expected: &[f64], hits: usize, label: &str) -> usize {
    let study = |ordinal: u64| {
        let mut draw = stream(label, ordinal);
        let runs: Vec<Vec<usize>> =
            (0..40).map(|_| run(&mut draw, shares, 400 / hits, hits)).collect();
        Shares::of(&runs, expected).unwrap().test.unwrap().probability < 0.05
    };
    (0..200).filter(|ordinal| study(*ordinal)).count()
}

/// Pearson's χ² of a study's counts, divided by its degrees of freedom: about 1 for independent samples.
fn pearson(runs: &[Vec<usize>], shares: &[f64]) -> f64 {
    let (all, whole): (usize, f64) = (runs.iter().flatten().sum(), shares.iter().sum());
    let cells = shares.iter().enumerate().map(|(cell, share)| {
        let found: usize = runs.iter().map(|run| run[cell]).sum();
        let expected = all as f64 * share / whole;
        (found as f64 - expected) * (found as f64 - expected) / expected
    });
    cells.sum::<f64>() / (shares.len() as f64 - 1.0)
}

/// The law holds, with independent samples and with samples that come in lots of five: the test rejects as often as it says. Pearson's
/// χ² takes the lots for evidence. A law that is off by a few per cent is rejected.
#[test]
fn the_test_over_runs_holds_where_samples_come_in_lots() {
    let shares = [1.0, 2.0, 3.0, 2.0, 1.0, 0.0];
    for (hits, label) in [(1, "single"), (5, "lots")] {
        let found = rejected(&shares, &shares, hits, label);
        assert!((1..=22).contains(&found), "{found} of 200 in {label}");
    }
    let mut draw = stream("pearson", 0);
    let lots: Vec<Vec<usize>> = (0..400).map(|_| run(&mut draw, &shares, 80, 5)).collect();
    let mean = lots.iter().map(|one| pearson(std::slice::from_ref(one), &shares[..5])).sum::<f64>();
    assert!((mean / 400.0 - 5.0).abs() < 1.0, "{mean}");
    let other = [1.1, 2.0, 3.0, 2.0, 0.9, 0.0];
    assert!(rejected(&shares, &other, 1, "other") > 195);
}

#[test]
fn shares_are_told_cell_by_cell() {
    let runs = [[30, 10, 0], [20, 20, 0], [25, 15, 0]];
    let found = Shares::of(&runs, &[5.0, 3.0, 0.0]).unwrap();
    let [first, second, third] = found.cells[..] else { panic!("three cells") };
    assert_eq!((first.expected, first.mean, first.error), (0.625, 0.625, Some(0.0)));
    assert!((first.deviation - 0.125).abs() < 1e-15 && (second.mean - 0.375).abs() < 1e-15);
    assert_eq!((third.mean, third.error, found.largest_error), (0.0, None, 0.0));
    // One share is free, two follow from it, so F is the square of Student's t.
    let test = found.test.unwrap();
    assert_eq!((test.runs, test.freedom, test.f, test.probability), (3, 1, 0.0, 1.0));
    assert_eq!(Shares::of(&[[1, 1]; 3], &[1.0, 1.0]).unwrap().test, None);
    assert_eq!(Shares::of(&[[1, 2], [2, 1]], &[1.0, -1.0]), None);
    assert_eq!(Shares::of(&[[0, 0]], &[1.0, 1.0]), None);
    assert_eq!(Shares::of(&[[1]], &[1.0, 1.0]), None);
    assert_eq!(Shares::of(&[] as &[[usize; 2]], &[1.0, 1.0]), None);
}
