//! What a long chain costs before any work starts: CPU time and peak memory of reading, checking and describing a
//! problem, which is what `roadmill check` does.
//!
//! ```text
//! cargo bench --bench linkage [-- LINKS …]
//! ```
//!
//! The problem is a serial chain of LINKS boxes (default 100, 300, 600 and 1000) with start and goal, so that all of
//! its pairs of links are tested at two configurations. Each number of links is measured in a process of its own,
//! since the peak of a process never falls: this program starts itself again. Per number of links: pairs that must
//! not touch, seconds of CPU, and the most bytes that were resident (`VmHWM` of Linux).

#[path = "../tests/support/chain.rs"]
mod chain;

use roadmill::problem::Problem;
use rustix::time::{ClockId, clock_gettime};
use std::path::Path;
use std::process::Command;

/// Marks a process that measures one number of links.
const ALONE: &str = "--alone";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let alone = words.iter().any(|word| word == ALONE);
    let numbers = words.iter().filter(|word| *word != ALONE);
    let mut links: Vec<usize> = numbers
        .map(|word| {
            word.parse().unwrap_or_else(|_| panic!("`{word}` found; a number of links expected"))
        })
        .collect();
    if alone {
        return links.into_iter().for_each(measure);
    }
    if links.is_empty() {
        links = vec![100, 300, 600, 1000];
    }
    println!("{:>6} {:>8} {:>8} {:>8}", "links", "pairs", "CPU s", "peak MB");
    let program = std::env::current_exe().expect("the path of this program");
    for links in links {
        let status = Command::new(&program).args([ALONE, &links.to_string()]).status();
        assert!(status.expect("this program starts again").success(), "{links} links");
    }
}

fn measure(links: usize) {
    let text = chain::serial_chain(links);
    let problem = Problem::parse(Path::new("chain.toml"), &text);
    let problem = problem.unwrap_or_else(|error| panic!("{error}"));
    let described = problem.describe();
    assert!(!described.is_empty());
    let time = clock_gettime(ClockId::ProcessCPUTime);
    let seconds = time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9;
    let pairs = problem.model().bodies().expect("bodies").robot().self_pairs().count();
    println!("{links:>6} {pairs:>8} {seconds:>8.3} {:>8.1}", peak_bytes() as f64 / 1e6);
}

/// The most bytes of this process that were resident.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("a process of Linux");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    kib.expect("VmHWM in kB") * 1024
}
