//! Every kernel alone: nanoseconds per operation, and, under callgrind, instructions.
//!
//! ```text
//! cargo bench --bench kernels [-- NAME …]
//! bench/kernels/count [--record] [NAME …]
//! ```
//!
//! Kernels run on problems that ship with the project, in one thread, always on the same inputs. Without
//! further words each is run until a fifth of a second is full, five times in turn, and the median is printed.
//! `--list` prints the names, `--once NAME` runs one a single time, after a first time that is not counted:
//! what the script counts instructions of and compares with those that it recorded in `counts.txt`.

#[path = "../support/mod.rs"]
mod support;

mod kernels;

use kernels::{KERNELS, Kernel};
use std::hint::black_box;
use support::{cpu_seconds, median};

const ROUNDS: usize = 5;
const SECONDS: f64 = 0.2;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    match words.first().map(String::as_str) {
        Some("--list") => KERNELS.iter().for_each(|kernel| println!("{}", kernel.name)),
        Some("--once") => {
            let kernel =
                KERNELS.iter().find(|kernel| words.get(1).is_some_and(|w| w == kernel.name));
            let mut work = (kernel.expect("--once takes a name of --list").prepare)();
            black_box(work());
            black_box(counted_kernel(&mut *work));
        }
        _ => time(&words),
    }
}

/// What callgrind counts: all that is called from here.
#[inline(never)]
fn counted_kernel(work: &mut dyn FnMut() -> usize) -> usize {
    black_box(work())
}

fn time(wanted: &[String]) {
    let kernels = KERNELS.iter().filter(|kernel| {
        wanted.is_empty() || wanted.iter().any(|word| kernel.name.starts_with(word.as_str()))
    });
    println!("| kernel | operation | ns |");
    println!("| --- | --- | --- |");
    for Kernel { name, operation, prepare } in kernels {
        let mut work = prepare();
        work();
        let mut nanoseconds: Vec<f64> = (0..ROUNDS)
            .map(|_| {
                let begun = cpu_seconds();
                let mut operations = 0;
                while cpu_seconds() - begun < SECONDS {
                    operations += black_box(work());
                }
                (cpu_seconds() - begun) * 1e9 / operations as f64
            })
            .collect();
        println!("| {name} | {operation} | {:.0} |", median(&mut nanoseconds));
    }
}
