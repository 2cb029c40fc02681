//! What a milestone could tell in advance about its edges: two certificates that were not built, by what they would come to.
//!
//! ```text
//! cargo bench --bench certificates -- [--milestones N] SCENE …
//! ```
//!
//! - *Free balls.* With clearances c and d at the ends of a motion none of whose points moves by more than m, the motion is free
//!   if c + d > m. Printed: of the motions of a list the share for which that holds, and what finding one clearance costs.
//! - *One descent.* A search from a milestone for everything that its edges could touch would come down to the pairs of
//!   triangles, one of the robot's and one of an obstacle's, that are no farther apart there than the robot's points move on any of its
//!   edges. Printed: how many pairs those are for each of its edges, in the mean over N milestones (default 20). A search edge by edge comes down
//!   to the numbers in `docs/performance.md`, "The kernel" (pairs): about ten near obstacles.
//!
//! Lists are those of `bench/race.rs`: uniform and Gaussian milestones with their 10 nearest.

mod support;

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::Triangle;
use roadmill::Context;
use roadmill::model::Scratch;
use roadmill::problem::Problem;
use roadmill::roadmap::Configs;
use roadmill::scene::{Body, Shape};
use std::path::Path;
use support::cpu_seconds;
use support::lists::List;
use support::peer::surfaces;

fn main() {
    let mut milestones = 20;
    let mut scenes = Vec::new();
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        match word.as_str() {
            "--milestones" => {
                milestones = words.next().and_then(|word| word.parse().ok()).expect("a number");
            }
            _ => scenes.push(word),
        }
    }
    println!("| scene | list | motions | free by the balls | µs a clearance | pairs an edge |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for path in scenes {
        let problem = surfaces(Path::new(&path));
        let cx = problem.context();
        for list in [List::Uniform, List::Gaussian] {
            let (configs, pairs) = list.draw(&problem, &cx);
            let (share, micros) = by_balls(&cx, &configs, &pairs);
            let each = pairs_of_an_edge(&problem, &configs, &pairs, milestones);
            let (name, list, count) = (problem.name(), list.name(), pairs.len());
            println!(
                "| {name} | {list} | {count} | {:.1} % | {micros:.1} | {each:.0} |",
                100.0 * share
            );
        }
    }
}

/// The share of the motions that clearances at their ends prove free, and the CPU microseconds of a clearance.
fn by_balls(cx: &Context, configs: &Configs, pairs: &[(usize, usize)]) -> (f64, f64) {
    let clearances = cx.model().clearances().expect("bodies among obstacles");
    let scratch = &mut Scratch::new();
    let begun = cpu_seconds();
    let found: Vec<f64> = configs
        .iter()
        .map(|q| clearances.clearance(q, scratch).map_or(f64::INFINITY, |it| it.distance))
        .collect();
    let micros = (cpu_seconds() - begun) * 1e6 / configs.len() as f64;
    let is_free = |(i, j): &&(usize, usize)| {
        found[*i] + found[*j] > clearances.farthest(configs.get(*i), configs.get(*j))
    };
    (pairs.iter().filter(is_free).count() as f64 / pairs.len() as f64, micros)
}

/// The mean number, per edge, of pairs of triangles that a milestone's edges could bring together.
fn pairs_of_an_edge(
    problem: &Problem,
    configs: &Configs,
    pairs: &[(usize, usize)],
    milestones: usize,
) -> f64 {
    let cx = problem.context();
    let clearances = cx.model().clearances().expect("bodies among obstacles");
    let figure = problem.model().description().figure().expect("bodies");
    let obstacles = triangles(figure.obstacles());
    let (mut found, mut edges) = (0, 0);
    for i in (0..milestones).map(|k| k * configs.len() / milestones) {
        let ends: Vec<usize> = pairs
            .iter()
            .filter_map(|(a, b)| (*a == i).then_some(*b).or((*b == i).then_some(*a)))
            .collect();
        let q = configs.get(i);
        let ways = ends.iter().map(|end| clearances.farthest(q, configs.get(*end)));
        let reach = ways.fold(0.0, f64::max);
        found += near(&triangles(&figure.bodies_at(q)), &obstacles, reach);
        edges += ends.len();
    }
    found as f64 / edges as f64
}

/// A triangle in the world's frame, and a ball that holds it.
struct Piece {
    triangle: Triangle,
    centre: Vector,
    radius: f64,
}

fn triangles(bodies: &[Body]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for body in bodies {
        let Shape::Mesh(mesh) = &body.shape else { panic!("meshes expected") };
        let corner = |index: u32| Vector::from(body.pose.apply(mesh.vertices[index as usize]));
        for face in mesh.faces() {
            let [a, b, c] = face.map(corner);
            let centre = (a + b + c) / 3.0;
            let radius = [a, b, c].map(|it| (it - centre).length()).into_iter().fold(0.0, f64::max);
            pieces.push(Piece { triangle: Triangle::new(a, b, c), centre, radius });
        }
    }
    pieces
}

/// How many pairs are no farther apart than that.
fn near(robot: &[Piece], obstacles: &[Piece], reach: f64) -> usize {
    let here = &Pose::IDENTITY;
    let is_near = |a: &Piece, b: &Piece| {
        (a.centre - b.centre).length() <= a.radius + b.radius + reach
            && distance(here, &a.triangle, here, &b.triangle).is_ok_and(|it| it.distance <= reach)
    };
    robot.iter().map(|a| obstacles.iter().filter(|b| is_near(a, b)).count()).sum()
}
