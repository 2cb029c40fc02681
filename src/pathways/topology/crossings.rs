use super::section;
use crate::context::Context;
use crate::model::{Figure, Scratch};
use crate::seed::{Purpose, Seed};
use robust::{Coord, orient2d};
use std::fmt;

/// A path crosses the ray of a puncture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// Number of the puncture.
    pub puncture: u32,
    /// Whether x grows: from the ray's left to its right.
    pub rightwards: bool,
}

impl Crossing {
    /// The same on the way back.
    pub fn reversed(self) -> Crossing {
        Crossing { rightwards: !self.rightwards, ..self }
    }
}

/// A reduced word of crossings: none stands beside its reverse.
pub type Word = Vec<Crossing>;

/// Appends crossings to a reduced word, which stays reduced.
pub fn append(word: &mut Word, crossings: impl IntoIterator<Item = Crossing>) {
    for crossing in crossings {
        match word.last() {
            Some(last) if *last == crossing.reversed() => {
                word.pop();
            }
            _ => word.push(crossing),
        }
    }
}

/// Points of the plane that no path passes, one in each part of an obstacle that the plane cuts. From each a
/// ray leads up, along y.
///
/// Without the rays the plane is simply connected, so the word of the rays that a path crosses, reduced, is all there is to
/// say: two paths of a point with the same ends can be deformed into one another without passing a puncture if, and only if, their
/// reduced words are equal. The words are the elements of the fundamental group of the plane without the punctures, which is free. (In
/// motion planning: S. Bhattacharya, M. Likhachev, V. Kumar, *Topological constraints in search-based robot path planning*, Autonomous Robots
/// 33, 2012; A. Hatcher, *Algebraic Topology*, §1.2.)
///
/// A part is what one closed curve bounds in which the plane z = 0 cuts the obstacle's surface: an arch that stands on the plane has two. Its
/// point is the first of several inside it, those far from its border first, at which the robot's reference point cannot lie; of a
/// box, ball, cylinder or capsule its middle is looked at before. A connected piece that the plane does not cut, which only a robot with extent can
/// meet, is one part with the point that lies below or above one of its vertices. Where the robot's reference point can lie at every point that is looked at, the part has no puncture, and ways
/// around it are not told apart: [`Punctures::left_out`] counts such parts.
///
/// Obstacles that touch need not be known as one. Where several punctures lie in one piece of what is forbidden, its
/// letters come together in every word, and words are equal as they would be with a single one.
///
/// Rays with the same x are taken as if each lay a little to the right of those before it, and a point at the x of a puncture
/// as if it lay to the ray's left.
#[derive(Clone, Debug)]
pub struct Punctures {
    /// Where they are, by their numbers.
    points: Vec<[f64; 2]>,
    /// Per puncture the index of its obstacle, and the number of the part within it.
    parts: Vec<[usize; 2]>,
    /// The numbers, in the order of x, ties by number.
    by_x: Vec<u32>,
    /// How many parts of obstacles have none.
    left_out: usize,
}

/// In so many ways the robot is placed where a puncture is to be.
const PLACED: usize = 32;

impl Punctures {
    /// Those of a planar model: of every part of an obstacle a point within the bounds at which the robot's reference point
    /// cannot be. A point at which a configuration was found that is valid is none: the robot can
    /// pass it with that point, whatever else it touches. Looked for are configurations with all other values drawn uniformly, 32
    /// of them.
    pub(super) fn of(cx: &Context, figure: &dyn Figure, scratch: &mut Scratch) -> Punctures {
        let [min, max] = figure.bounds();
        let (mut points, mut parts, mut left_out) = (Vec::new(), Vec::new(), 0);
        let mut stream = Seed::of_evaluator(cx.base_seed, "topology").stream(Purpose::Sampling);
        let mut q = vec![0.0; cx.space.len()];
        for (obstacle, body) in figure.obstacles().iter().enumerate() {
            for (part, candidates) in section::parts(body).into_iter().enumerate() {
                // What lies outside the bounds no path goes around.
                let is_within =
                    |[x, y]: &[f64; 2]| min[0] < *x && *x < max[0] && min[1] < *y && *y < max[1];
                let within: Vec<[f64; 2]> = candidates.into_iter().filter(is_within).collect();
                let mut is_forbidden = |[x, y]: &[f64; 2]| {
                    (0..PLACED).all(|_| {
                        cx.space.sample_uniform(&mut stream, &mut q);
                        (q[0], q[1]) = (*x, *y);
                        !cx.model.is_valid(&q, scratch)
                    })
                };
                match within.iter().find(|point| is_forbidden(point)) {
                    Some(point) => {
                        points.push(*point);
                        parts.push([obstacle, part]);
                    }
                    None => left_out += usize::from(!within.is_empty()),
                }
            }
        }
        Punctures { left_out, ..Punctures::at(points, parts) }
    }

    /// Punctures at these points, each with the index of its obstacle and the number of the part within it.
    pub fn at(points: Vec<[f64; 2]>, parts: Vec<[usize; 2]>) -> Punctures {
        let mut by_x: Vec<u32> = (0..points.len() as u32).collect();
        // Stable: ties stay in the order of their numbers.
        by_x.sort_by(|a, b| points[*a as usize][0].total_cmp(&points[*b as usize][0]));
        Punctures { points, parts, by_x, left_out: 0 }
    }

    /// Where they are, by their numbers.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// How many parts of obstacles have none, since the robot's reference point can be there.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The crossings on the straight way from `a` to `b`, in order.
    pub fn crossings(&self, a: [f64; 2], b: [f64; 2]) -> Vec<Crossing> {
        let rightwards = a[0] < b[0];
        let (left, right) = if rightwards { (a, b) } else { (b, a) };
        let x_of = |number: &u32| self.points[*number as usize][0];
        let begin = self.by_x.partition_point(|number| x_of(number) < left[0]);
        let end = self.by_x.partition_point(|number| x_of(number) < right[0]);
        let coord = |[x, y]: [f64; 2]| Coord { x, y };
        // Exact: whether the puncture is below the line.
        let is_below = |number: &&u32| {
            let point = self.points[**number as usize];
            orient2d(coord(left), coord(right), coord(point)) < 0.0
        };
        let crossed = self.by_x[begin..end.max(begin)].iter().filter(is_below);
        let mut crossings: Vec<Crossing> =
            crossed.map(|number| Crossing { puncture: *number, rightwards }).collect();
        if !rightwards {
            crossings.reverse();
        }
        crossings
    }

    /// The reduced word of a path along straight ways between points.
    pub fn word(&self, points: impl IntoIterator<Item = [f64; 2]>) -> Word {
        let (mut word, mut before) = (Word::new(), None);
        for point in points {
            if let Some(before) = before {
                append(&mut word, self.crossings(before, point));
            }
            before = Some(point);
        }
        word
    }

    /// A word as people read it: the numbers of the obstacles, counted from 1, above which the path passes, with a minus where
    /// it does so from right to left. Of a further part of an obstacle the part's number follows after a stroke. `-` alone is the
    /// word without letters.
    pub fn text(&self, word: &[Crossing]) -> String {
        if word.is_empty() {
            return "-".to_owned();
        }
        let letter = |crossing: &Crossing| {
            let sign = if crossing.rightwards { "" } else { "-" };
            let [obstacle, part] = self.parts[crossing.puncture as usize];
            match part {
                0 => format!("{sign}{}", obstacle + 1),
                _ => format!("{sign}{}/{}", obstacle + 1, part + 1),
            }
        };
        word.iter().map(letter).collect::<Vec<_>>().join(" ")
    }
}

/// For tests and logs: the number of the puncture, counted from 1, with a minus from right to left.
impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.rightwards { "" } else { "-" };
        write!(f, "{sign}{}", self.puncture + 1)
    }
}
