use super::{Evaluator, Verdict, complaint_of_change};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Asked, Scratch};
use crate::neighbor::{FarPair, farthest_pair};
use crate::numbers::NodeId;
use crate::roadmap::{Component, Components, Configs, Roadmap};
use crate::space::Space;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

/// The roadmap's layout no longer changes: TR05-007 §3.2, *"It computes the inter-component distances
/// and intra-component distances of the connected components … The evaluator returns success if
/// both sets of distances stabilize."*
///
/// As in the report, the distance between two components is that of their centres, and the width of a component is
/// the distance of its two farthest configurations. From round to round components merge and appear, so that they
/// cannot be compared one by one. Both measures are therefore taken as distributions over the roadmap's nodes: *width*
/// is the width of the component of a node drawn at random, *separation* the distance between the components of two
/// nodes drawn at random, 0 if that is the same component. When two components merge, the nodes of both move to a
/// larger width and the pairs across to separation 0; a component that appears or grows counts by its share of the
/// nodes.
///
/// How far a distribution has moved between two rounds is measured by the earth mover's distance: the mean change of
/// distance that turns one into the other. The value is the largest move of either distribution between the roadmap
/// now and any of the `rounds` rounds before, divided by the space's diameter, so that a slow drift is noticed, too.
/// Earlier rounds are read from the roadmap's own history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Expansion {
    /// For how many rounds the distances have to stand still.
    #[serde(default = "default_rounds")]
    pub rounds: u32,
    /// The largest move that counts as none, in percent of the space's diameter.
    #[serde(default = "default_percent")]
    pub percent: f64,
    /// How many components count: those with most nodes.
    #[serde(default = "default_components")]
    pub components: u32,
}

impl Default for Expansion {
    fn default() -> Expansion {
        Expansion {
            rounds: default_rounds(),
            percent: default_percent(),
            components: default_components(),
        }
    }
}

fn default_rounds() -> u32 {
    3
}

fn default_percent() -> f64 {
    1.0
}

fn default_components() -> u32 {
    100
}

const ROUNDS_MAX: u32 = 1000;
const COMPONENTS_MAX: u32 = 1000;

impl Evaluator for Expansion {
    fn name(&self) -> &'static str {
        "expansion"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["width", "separation", "width moved", "separation moved"]
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        _scratch: &mut Scratch,
    ) -> Verdict {
        let space = &cx.space;
        let now = self.distributions(space, roadmap, roadmap.components(), None);
        let (mut moved, diameter) = ([0.0f64; 2], space.diameter());
        let mut later = None;
        let before = roadmap.rounds().iter().rev().skip(1).take(self.rounds as usize);
        for extent in before.clone() {
            let components = roadmap.components_at(space, *extent);
            let then =
                self.distributions(space, roadmap, &components, later.as_ref().or(Some(&now)));
            moved[0] = moved[0].max(earth_movers(&now.width, &then.width));
            moved[1] = moved[1].max(earth_movers(&now.separation, &then.separation));
            later = Some(then);
        }
        let enough = before.len() == self.rounds as usize;
        // With too few rounds to compare the criterion is not satisfied.
        let value = if enough && diameter > 0.0 { moved[0].max(moved[1]) / diameter } else { 1.0 };
        let means = [mean(&now.width), mean(&now.separation)];
        Verdict {
            measures: means.into_iter().chain(moved).collect(),
            ..Verdict::at_most(self.percent / 100.0, value, Asked::default())
        }
    }

    fn complaint(&self) -> Option<Complaint> {
        if !(1..=ROUNDS_MAX).contains(&self.rounds) {
            return Some(Complaint::new("rounds", self.rounds, "1 to 1000"));
        }
        if !(1..=COMPONENTS_MAX).contains(&self.components) {
            return Some(Complaint::new("components", self.components, "1 to 1000"));
        }
        complaint_of_change(self.percent)
    }
}

/// Distances, ascending, each with the number of nodes or of ordered pairs of nodes for which it stands.
type Distances = Vec<(f64, u128)>;

/// The two distributions of a round.
struct Distributions {
    /// The farthest nodes of each component.
    widths: Vec<FarPair>,
    width: Distances,
    separation: Distances,
}

impl Expansion {
    /// The distributions for the roadmap whose connected components are `components`; `later`, those of a later round,
    /// spares searches for farthest pairs that have not changed.
    fn distributions(
        &self,
        space: &Space,
        roadmap: &Roadmap,
        components: &Components,
        later: Option<&Distributions>,
    ) -> Distributions {
        let mut largest: Vec<&Component> = components.iter().collect();
        largest.sort_by_key(|component| (Reverse(component.members.len()), component.name));
        largest.truncate(self.components as usize);

        let count = |component: &Component| component.members.len() as u128;
        let (mut widths, mut width, mut separation) = (Vec::new(), Vec::new(), Vec::new());
        for (index, component) in largest.iter().enumerate() {
            let ends = ends(space, roadmap.configs(), components, component, later);
            widths.push(ends);
            width.push((ends.distance, count(component)));
            separation.push((0.0, count(component) * count(component)));
            for other in &largest[..index] {
                let distance = space.distance(&component.centre, &other.centre);
                separation.push((distance, 2 * count(component) * count(other)));
            }
        }
        width.sort_by(|a, b| a.0.total_cmp(&b.0));
        separation.sort_by(|a, b| a.0.total_cmp(&b.0));
        Distributions { widths, width, separation }
    }
}

/// The two farthest configurations of a component. Components only grow: if the farthest pair of a
/// component of a later round lies in this component, then it is this component's farthest pair, too.
fn ends(
    space: &Space,
    configs: &Configs,
    components: &Components,
    component: &Component,
    later: Option<&Distributions>,
) -> FarPair {
    let known = later.and_then(|later| {
        later.widths.iter().find(|pair| {
            [pair.low, pair.high].iter().all(|node| components.contains(component, NodeId(*node)))
        })
    });
    if let Some(ends) = known {
        return *ends;
    }
    let alone = FarPair { distance: 0.0, low: component.name.0, high: component.name.0 };
    farthest_pair(space, configs, &component.members, &component.centre).unwrap_or(alone)
}

fn mean(distances: &Distances) -> f64 {
    let total: u128 = distances.iter().map(|(_, count)| count).sum();
    let shares = distances.iter().map(|(distance, count)| distance * share(*count, total));
    shares.sum()
}

fn share(part: u128, whole: u128) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// The earth mover's distance between two distributions on the line: the area between their cumulative
/// shares. Counts are added as integers, so that the order of equal distances does not matter.
fn earth_movers(a: &Distances, b: &Distances) -> f64 {
    let total = |side: &Distances| side.iter().map(|(_, count)| count).sum::<u128>();
    let (totals, mut below) = ([total(a), total(b)], [0u128; 2]);
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    let (mut at, mut area) = (None, 0.0);
    loop {
        let (side, (distance, count)) = match (a.peek(), b.peek()) {
            (Some(first), Some(second)) if first.0 <= second.0 => (0, **first),
            (Some(first), None) => (0, **first),
            (_, Some(second)) => (1, **second),
            (None, None) => return area,
        };
        if side == 0 {
            a.next()
        } else {
            b.next()
        };
        if let Some(at) = at {
            let apart = share(below[0], totals[0]) - share(below[1], totals[1]);
            area += apart.abs() * (distance - at);
        }
        below[side] += count;
        at = Some(distance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::tests::{grow, hand_made};

    #[test]
    fn the_earth_movers_distance_is_the_mean_way_of_what_must_move() {
        let whole = |distance: f64| vec![(distance, 4)];
        assert_eq!(earth_movers(&whole(2.0), &whole(2.0)), 0.0);
        assert_eq!(earth_movers(&whole(2.0), &whole(5.0)), 3.0);
        // Half of it goes from 0 to 4, a quarter from 4 to 8; how many stand for it does not matter.
        let (a, b) = (vec![(0.0, 2), (4.0, 2)], vec![(0.0, 0), (4.0, 30), (8.0, 10)]);
        assert_eq!(earth_movers(&a, &b), 3.0);
        assert_eq!(earth_movers(&b, &a), 3.0);
    }

    #[test]
    fn distances_move_when_components_merge_and_stand_still_when_they_grow_from_within() {
        let criterion = Expansion { rounds: 1, percent: 1.0, components: 100 };
        let (space, mut roadmap) = hand_made();
        let mut fold = |nodes: &[[f64; 2]], joins: &[(u32, u32)]| {
            grow(&space, &mut roadmap, nodes, joins);
            criterion.layouts(&space, &roadmap)
        };
        // Two components of two nodes each, 3 and 4 wide, their centres 10 apart.
        let (_, now) = fold(&[[0.0, 0.0], [3.0, 0.0], [1.5, 8.0], [1.5, 12.0]], &[(0, 1), (2, 3)]);
        assert_eq!((mean(&now.width), mean(&now.separation)), (3.5, 5.0));
        // A node inside each: the centres stay and so do the farthest two.
        let (then, now) = fold(&[[1.5, 0.0], [1.5, 10.0]], &[(0, 4), (2, 5)]);
        assert_eq!(earth_movers(&now.width, &then.width), 0.0);
        assert_eq!(earth_movers(&now.separation, &then.separation), 0.0);
        // They merge: (0, 0) to (1.5, 12) are √146.25, and nothing is apart.
        let (then, now) = fold(&[[1.5, 5.0]], &[(4, 6), (5, 6)]);
        assert_eq!(now.widths, [FarPair { distance: 146.25f64.sqrt(), low: 0, high: 3 }]);
        assert_eq!(mean(&now.separation), 0.0);
        assert_eq!(earth_movers(&now.separation, &then.separation), 5.0);
        assert_eq!(earth_movers(&now.width, &then.width), 146.25f64.sqrt() - 3.5);
        // One appears: a seventh … of the nodes has no width, two times 1/8 · 7/8 of the pairs are apart.
        let (then, now) = fold(&[[30.0, 40.0]], &[]);
        assert!((earth_movers(&now.width, &then.width) - 146.25f64.sqrt() / 8.0).abs() < 1e-12);
        let apart = space.distance(&[1.5, 5.0], &[30.0, 40.0]);
        assert!((mean(&now.separation) - apart * 14.0 / 64.0).abs() < 1e-12);
    }

    impl Expansion {
        /// The layouts of the round before, if there is one, and of the present round.
        fn layouts(&self, space: &Space, roadmap: &Roadmap) -> (Distributions, Distributions) {
            let now = self.distributions(space, roadmap, roadmap.components(), None);
            let before = roadmap.rounds().iter().rev().nth(1).copied().unwrap_or_default();
            let components = roadmap.components_at(space, before);
            let then = self.distributions(space, roadmap, &components, Some(&now));
            let anew = self.distributions(space, roadmap, &components, None);
            assert_eq!(then.widths, anew.widths, "what is known of later rounds changes nothing");
            (then, now)
        }
    }
}
