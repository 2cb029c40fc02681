use crate::context::Context;
use crate::model::{Cost, Directed, Scratch};
use crate::query::{PATH_REFINEMENT, Path};
use crate::roadmap::{Rank, Value};

/// What a path comes to. Everything is looked at [`PATH_REFINEMENT`] times finer than the problem asks for, as paths are
/// checked before they are given out, and as [`shorten`](crate::query::shorten) compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The highest energy on the path, in the model's unit of energy; `None` where there are no energies.
    pub peak: Option<f64>,
    /// From the start to the goal.
    pub there: OneWay,
    /// From the goal to the start.
    pub back: OneWay,
}

/// What a path comes to in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneWay {
    /// The highest energy on the path above the energy at departure, in the model's unit of energy; `None` where there are no
    /// energies.
    pub barrier: Option<f64>,
    /// The sum of what its motions cost in this direction, in the model's unit of costs: of proteins Σ −ln P in kT, of
    /// bodies the length.
    pub cost: f64,
}

impl Measured {
    /// Measures a path; `None` where one of its motions is not valid.
    pub fn of(cx: &Context, path: &Path, scratch: &mut Scratch) -> Option<Measured> {
        let configs = &path.configs;
        let ends = [0, configs.len().checked_sub(1)?].map(|index| configs.get(index));
        // Motions of models whose nodes have no values cost their lengths.
        if cx.model.node_values().is_empty() {
            let cost = path.lengths(&cx.space).last().copied().unwrap_or(0.0);
            let way = OneWay { barrier: None, cost };
            return Some(Measured { peak: None, there: way, back: way });
        }
        let energies = match ends.map(|q| cx.model.energy(q, scratch)) {
            [Some(start), Some(goal)] => Some([start, goal]),
            _ => None,
        };
        let highest = energies.map_or(f64::NEG_INFINITY, |[start, goal]| start.max(goal));
        let mut whole = Directed { forward: 0.0, backward: 0.0, peak: highest };
        for index in 1..configs.len() {
            let (a, b) = (configs.get(index - 1), configs.get(index));
            if a == b {
                continue;
            }
            match cx.model.motion(a, b, PATH_REFINEMENT, scratch)? {
                Cost::Directed(leg) => whole = whole.then(leg),
                Cost::Metric => return None,
            }
        }
        let way = |end: usize, cost: f64| OneWay {
            barrier: energies.map(|energies| whole.peak - energies[end]),
            cost,
        };
        let (there, back) = (way(0, whole.forward), way(1, whole.backward));
        Some(Measured { peak: energies.map(|_| whole.peak), there, back })
    }

    /// Integers in the order of the ranking from start to goal, the best first.
    pub(super) fn key(&self, rank: Rank) -> [u64; 2] {
        let peak = self.peak.unwrap_or(f64::NEG_INFINITY);
        Value { peak, cost: self.there.cost }.key(rank)
    }
}
