use crate::context::Context;
use crate::model::Scratch;
use crate::seed::Stream;
use crate::space::Direction;

/// How often the last step of a search is halved toward the collision.
const HALVINGS: u32 = 4;

/// A stretch of an approximate path that collides.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The valid configuration before it, if there is one (the dissertation: *c_f*).
    pub before: Option<&'a [f64]>,
    /// The configurations that are not valid, in the order of the path; each near its neighbours.
    pub colliding: &'a [Vec<f64>],
    /// The valid configuration after it, if there is one (the dissertation: *c_l*).
    pub after: Option<&'a [f64]>,
}

/// A valid configuration that a push has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Pushed {
    /// From which colliding configuration of the stretch it was pushed: its index there.
    pub from: usize,
    /// The configuration, in stored form.
    pub q: Vec<f64>,
}

/// What pushes work with, and how far they go.
pub struct Search<'a> {
    /// The problem.
    pub cx: &'a Context,
    /// Working memory of the model.
    pub scratch: &'a mut Scratch,
    /// From which directions are drawn.
    pub stream: Stream,
    /// How far a search moves between two looks, in the space's metric.
    pub step: f64,
    /// The farthest that a configuration is moved, in the space's metric.
    pub reach: f64,
    /// How often the same stretch was pushed before: each time more directions are tried, in wider cones.
    pub effort: u32,
}

impl Search<'_> {
    /// Whether a configuration is valid and no farther from another than the reach.
    pub fn accepts(&mut self, from: &[f64], q: &[f64]) -> bool {
        self.cx.space.distance(from, q) <= self.reach && self.cx.model.is_valid(q, self.scratch)
    }

    /// The number of steps within the reach, at least one.
    pub fn steps(&self) -> u32 {
        (self.reach / self.step).floor().clamp(1.0, 10_000.0) as u32
    }

    /// The configuration at `length` from `from` in a direction, if it is valid and within the reach.
    pub fn at(&mut self, from: &[f64], direction: &Direction, length: f64) -> Option<Vec<f64>> {
        let mut q = from.to_vec();
        self.cx.space.along(from, direction, length, &mut q);
        self.accepts(from, &q).then_some(q)
    }

    /// The first valid configuration in a direction, looked for step by step as far as the reach; then the last step is
    /// halved several times, so that it lies near the collision that it was pushed out of.
    pub fn first_valid(&mut self, from: &[f64], direction: &Direction) -> Option<Vec<f64>> {
        (1..=self.steps()).find_map(|step| {
            let (short, long) = (f64::from(step - 1) * self.step, f64::from(step) * self.step);
            let found = self.at(from, direction, long)?;
            Some(self.nearest_valid(from, direction, [short, long], found).1)
        })
    }

    /// Halves the stretch between two lengths in a direction, of which the shorter collides and the longer is valid: the valid end of the last
    /// part, its length and its configuration, which for the longer one is `found`.
    pub fn nearest_valid(
        &mut self,
        from: &[f64],
        direction: &Direction,
        [mut short, mut long]: [f64; 2],
        mut found: Vec<f64>,
    ) -> (f64, Vec<f64>) {
        for _ in 0..HALVINGS {
            let middle = (short + long) / 2.0;
            match self.at(from, direction, middle) {
                Some(q) => (long, found) = (middle, q),
                None => short = middle,
            }
        }
        (long, found)
    }
}
