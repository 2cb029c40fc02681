//! What a problem with a chain of a thousand links takes: memory is counted as it is asked for.

#[path = "support/chain.rs"]
mod chain;

use roadmill::problem::Problem;
use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The system's allocator, with a count of the bytes that are held and of their peak.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn add(bytes: usize) {
    let held = HELD.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(held, Ordering::Relaxed);
}

// SAFETY: all is handed on to the system's allocator; counting does not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        // SAFETY: the caller keeps the contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Old and new memory may be held at once.
        add(size);
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The peak of the bytes held by what is done, beyond what was held before.
fn peak_of<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = work();
    (result, PEAK.load(Ordering::Relaxed) - before)
}

/// The only test of this file: another one beside it would count into the same numbers.
#[test]
fn a_chain_of_a_thousand_links_takes_few_bytes_per_pair_of_links() {
    let text = chain::serial_chain(1000);
    let (problem, peak) = peak_of(|| Problem::parse(Path::new("chain.toml"), &text).unwrap());
    assert!(problem.query().is_some(), "start and goal were tested");
    // A pair takes 8 bytes, and while their list grows old and new are held at once. The rest, 32 MB in all, is the
    // text as tables, and what bodies become for tests. Lists of joints per pair would take gigabytes.
    let pairs = 998 * 999 / 2;
    assert!(peak > 8 * pairs, "{peak} bytes: the pairs are counted");
    assert!(peak < 100 * pairs, "{peak} bytes");
    let (described, peak) = peak_of(|| problem.describe());
    let line = format!("1000 links, {pairs} pairs of which must not touch");
    assert!(described.contains(&line), "{line} expected in:\n{described}");
    assert!(peak < 2 * pairs, "{peak} bytes");
}
