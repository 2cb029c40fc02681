//! Pairs of links that touch always, or never, as lines of a problem file.

use super::Bodies;
use super::validity::PairTouches;
use crate::source::value;
use std::fmt::Write;

/// The key `may_touch` of a problem file with the pairs of links, of those that are tested, that touch in all or in none of
/// `samples` drawn configurations.
pub(super) fn lines(bodies: &Bodies, samples: u64, base_seed: u64) -> String {
    let pairs = bodies.validity().touching(samples, base_seed);
    let name = |link: usize| value(&bodies.robot.links[link].name);
    let mut out = String::new();
    let named = |pair: &&PairTouches| format!("[{}, {}]", name(pair.links.0), name(pair.links.1));
    let always: Vec<_> = pairs.iter().filter(|pair| pair.touching == samples).collect();
    let never: Vec<_> = pairs.iter().filter(|pair| pair.touching == 0).collect();
    let sometimes = pairs.len() - always.len() - never.len();
    let count = pairs.len();
    writeln!(out, "# Of {count} pairs of links, in {samples} configurations drawn uniformly (seed {base_seed}):")
        .and_then(|()| writeln!(out, "# {sometimes} touch in some, and are to be tested."))
        .expect("writing to memory cannot fail");
    out += "may_touch = [\n";
    for (what, pairs) in [
        ("touch in all: nothing is valid unless they may", always),
        ("touch in none: tests of them are left out at the risk that they touch somewhere", never),
    ] {
        out += &format!("    # {} {what}.\n", pairs.len());
        for pair in &pairs {
            out += &format!("    {},\n", named(pair));
        }
    }
    out += "]\n";
    out
}
