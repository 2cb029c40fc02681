//! Neighbour finders: what a search costs and how good it is, and what a hop limit does to a graph that grows.
//!
//! ```text
//! cargo bench --bench neighbors -- queries [NODES]
//! cargo bench --bench neighbors -- figures [NODES [[FIRST-]SEEDS [SCENE]]]
//! ```
//!
//! - `queries`: every finder at 200, 2000, 20 000 and 200 000 random configurations, up to NODES (default: all), in spaces of 2, 6 and 20
//!   degrees of freedom: microseconds of CPU per search for the 10 nearest, what of the true neighbours it finds, and how
//!   much farther those are that it gives.
//! - `figures`: Figures 12 to 16 of S. K. Nath's thesis (2013): an RRG with hop limits 1, 2 and 3, with brute force and with the index, at
//!   NODES nodes (default 200) and for seeds FIRST (default 1) to SEEDS (default 10), in the scenes whose names contain SCENE (default: all).

mod figures;
mod queries;
#[allow(dead_code, reason = "some of its scenes are those of other benches")]
mod scenes;
#[path = "../support/mod.rs"]
mod support;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let number = |at: usize, default: u64| {
        words.get(at).map_or(default, |word| word.parse().expect("a number"))
    };
    match words.first().map(String::as_str) {
        Some("queries") => queries::run(number(1, u64::MAX)),
        Some("figures") => {
            let scene = words.get(3).map_or("", String::as_str);
            let seeds = words.get(2).map_or("10", String::as_str);
            let (first, last) = seeds.split_once('-').unwrap_or(("1", seeds));
            let [first, last] = [first, last].map(|seed| seed.parse().expect("a number"));
            figures::run(number(1, 200), first..=last, scene);
        }
        _ => println!("queries or figures expected"),
    }
}
