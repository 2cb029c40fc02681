//! Orders in which parts form, counted over pathways.

use super::Native;
use std::collections::BTreeMap;
use std::ops::Range;

/// An order in which parts form. Parts that form at the same frame have no order among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// The parts, by their indices, in groups: those of a group form at the same frame, before those of the next.
    pub groups: Vec<Vec<usize>>,
    /// On how many pathways.
    pub pathways: u64,
}

impl Order {
    /// The order as text: `α1 < [β3 β4] < β1`; parts in brackets form at the same frame.
    pub fn in_words(&self, native: &Native) -> String {
        let groups = self.groups.iter().map(|group| {
            let names: Vec<&str> = group.iter().map(|part| &*native.parts[*part].name).collect();
            if names.len() == 1 { names[0].to_owned() } else { format!("[{}]", names.join(" ")) }
        });
        groups.collect::<Vec<_>>().join(" < ")
    }
}

/// On how many pathways one part forms before another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Precedence {
    /// `before[a][b]`: the number of pathways on which part `a` forms earlier than part `b`.
    before: Vec<Vec<u64>>,
    /// The number of all pathways.
    pathways: u64,
}

impl Precedence {
    pub(super) fn new(parts: usize) -> Precedence {
        Precedence { before: vec![vec![0; parts]; parts], pathways: 0 }
    }

    /// Counts a pathway. `depths` says of each part how many frames are between where it forms and the end.
    pub(super) fn count(&mut self, depths: &[u32]) {
        self.pathways += 1;
        for (a, row) in self.before.iter_mut().enumerate() {
            for (b, count) in row.iter_mut().enumerate() {
                *count += u64::from(depths[a] > depths[b]);
            }
        }
    }

    /// The share of pathways on which part `a` forms earlier than part `b`; 0 without pathways.
    pub fn share(&self, a: usize, b: usize) -> f64 {
        self.before[a][b] as f64 / self.pathways.max(1) as f64
    }

    /// By how much the share of a pair of parts differs from what it was, for the pair for which that is most.
    pub fn change(&self, before: &Precedence) -> f64 {
        let parts = self.before.len();
        let pairs = (0..parts).flat_map(|a| (0..parts).map(move |b| (a, b)));
        pairs.map(|(a, b)| (self.share(a, b) - before.share(a, b)).abs()).fold(0.0, f64::max)
    }
}

/// Counts orders.
#[derive(Default)]
pub(super) struct Orders(BTreeMap<Vec<Vec<usize>>, u64>);

impl Orders {
    /// Counts a pathway, by where the parts among `parts` form, as for [`Precedence::count`].
    pub fn count(&mut self, parts: Range<usize>, depths: &[u32]) {
        *self.0.entry(Orders::groups(parts, depths)).or_default() += 1;
    }

    /// The order of a pathway, see [`Order::groups`].
    pub fn groups(parts: Range<usize>, depths: &[u32]) -> Vec<Vec<usize>> {
        let mut by_depth: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for part in parts {
            by_depth.entry(depths[part]).or_default().push(part);
        }
        by_depth.into_values().rev().collect()
    }

    /// The orders, the most frequent first; of equally frequent ones, the one whose parts come first.
    pub fn ranked(self) -> Vec<Order> {
        let orders = self.0.into_iter();
        let mut orders: Vec<Order> =
            orders.map(|(groups, pathways)| Order { groups, pathways }).collect();
        orders.sort_by_key(|order| std::cmp::Reverse(order.pathways));
        orders
    }
}
