//! The bounds at which a build stops without having met its criteria, and what they are where a problem leaves them
//! open.

pub use crate::numbers::NODES_MAX;
use crate::space::Space;
use bincode::{Decode, Encode};

/// The limit on nodes of problems that left it open, before it went by memory: ledgers of that time have it.
const FORMER_NODES: u64 = 100_000;
/// Bytes of memory that a roadmap may take whose limit is left open. A constant, so that where a build ends does not
/// depend on the machine.
const MEMORY: u64 = 4 << 30;
/// Bytes that a node takes beside its configuration: some 80 in the indices, and ten edges of 17 bytes, and of 72 more
/// while a search goes through them.
const NODE_BYTES: u64 = 1024;
/// Bytes that each value of a node's configuration takes: in the roadmap, and in the set that it came with.
const VALUE_BYTES: u64 = 16;

/// Bounds on a build. It stops at the end of the first round that reaches one.
#[derive(Clone, Copy, Debug, PartialEq, Encode, Decode)]
pub struct Limits {
    /// Nodes of the roadmap.
    pub nodes: u64,
    /// Node sets.
    pub sets: u64,
    /// Wall-clock seconds. The only limit under which two runs may end at different rounds.
    pub seconds: Option<f64>,
}

impl Limits {
    /// The limits of a problem in this space that has none.
    pub fn left_open(space: &Space) -> Limits {
        Limits { nodes: Limits::nodes_left_open(space), sets: u64::MAX, seconds: None }
    }

    /// The limit on nodes where neither a number of nodes nor a time is given: as many as take about 4 GiB of memory.
    fn nodes_left_open(space: &Space) -> u64 {
        MEMORY / (NODE_BYTES + VALUE_BYTES * space.len() as u64)
    }

    /// The same limits where the time is limited, too: that is then what ends the build, and the number of nodes, if
    /// it was left open, is as large as can be.
    pub fn with_time(self, space: &Space) -> Limits {
        let is_left_open = self.nodes == Limits::nodes_left_open(space);
        Limits { nodes: if is_left_open { NODES_MAX } else { self.nodes }, ..self }
    }

    /// The same limits for a build that reads no clock. Where the time was to end the build and the number of nodes was
    /// left open, the build ends at the number of nodes that is the limit of a problem without limits.
    pub(crate) fn without_clock(self, space: &Space) -> Limits {
        let is_left_to_time = self.seconds.is_some() && self.nodes == NODES_MAX;
        let nodes = if is_left_to_time { Limits::nodes_left_open(space) } else { self.nodes };
        Limits { nodes, ..self }
    }

    /// Whether the limit on nodes is one that a problem has which leaves it open, with or without a limit of time.
    pub fn leaves_nodes_open(&self, space: &Space) -> bool {
        [Limits::nodes_left_open(space), NODES_MAX].contains(&self.nodes)
    }

    /// Whether the limit on nodes of a run may be that of a problem which left it open: today, or when an earlier
    /// version of the program began the run.
    pub fn may_have_left_nodes_open(&self, space: &Space) -> bool {
        self.leaves_nodes_open(space) || self.nodes == FORMER_NODES
    }

    /// What is wrong with the limits: which one, what was found and what is expected.
    pub fn complaint(&self) -> Option<(&'static str, String)> {
        if !(1..=NODES_MAX).contains(&self.nodes) {
            let expected = format!("1 to {NODES_MAX} expected (node ids take 32 bits)");
            return Some(("nodes", format!("{} found; {expected}", self.nodes)));
        }
        if self.sets == 0 {
            return Some(("sets", "0 found; at least 1 expected".to_owned()));
        }
        match self.seconds {
            Some(seconds) if !(seconds.is_finite() && seconds > 0.0) => {
                Some(("seconds", format!("{seconds} found; a positive number expected")))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{BaseJoint, rigid_space};

    #[test]
    fn nodes_left_open_go_by_memory_and_give_way_to_a_limit_of_time() {
        let space = rigid_space(BaseJoint::Translation2d, [0.0; 3], [1.0, 1.0, 0.0], 0.0);
        let open = Limits::left_open(&space);
        let bytes = open.nodes * (NODE_BYTES + 2 * VALUE_BYTES);
        assert!(open.nodes > 1_000_000 && bytes <= MEMORY && MEMORY - bytes < 2000, "{open:?}");
        assert_eq!(open.complaint(), None);
        assert_eq!(open.with_time(&space).nodes, NODES_MAX);
        let timed = Limits { seconds: Some(1.0), ..open.with_time(&space) };
        assert_eq!(timed.without_clock(&space).nodes, open.nodes);
        assert_eq!(open.with_time(&space).without_clock(&space).nodes, NODES_MAX);
        let chosen = Limits { nodes: 500, ..open };
        assert_eq!(chosen.with_time(&space), chosen);
        for (nodes, is_open, was_open) in
            [(FORMER_NODES, false, true), (NODES_MAX, true, true), (500, false, false)]
        {
            let limits = Limits { nodes, ..open };
            assert_eq!(limits.leaves_nodes_open(&space), is_open, "{nodes}");
            assert_eq!(limits.may_have_left_nodes_open(&space), was_open, "{nodes}");
        }
    }
}
