//! Once a scratch is warm, what decides configurations and motions asks for no memory.

#[path = "../bench/support/edges.rs"]
mod edges;

use edges::with_edges;
use roadmill::model::Scratch;
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::{Purpose, Seed};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

/// The system's, with a count of what each thread asks for.
struct Counting;

thread_local! {
    static ASKED: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: all is handed on to the system's allocator; the count neither allocates nor has a destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        // SAFETY: the caller keeps the contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        // SAFETY: as above.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn nothing_is_allocated_once_the_scratch_is_warm() {
    for name in ["cage", "hook", "walls", "gantry"] {
        let path = Path::new("problems").join(name).with_extension("toml");
        let problem = Problem::load(&path).unwrap();
        for edges in [MotionChecking::Swept, MotionChecking::Sampled] {
            let cx = with_edges(&problem, edges).context();
            let scratch = &mut Scratch::new();
            let mut stream = Seed::of_set(5, name, Ordinal(0)).stream(Purpose::Sampling);
            let mut valid = Vec::new();
            while valid.len() < 40 {
                let mut q = vec![0.0; cx.space().len()];
                cx.space().sample_uniform(&mut stream, &mut q);
                if cx.model().is_valid(&q, scratch) {
                    valid.push(q);
                }
            }
            let mut verdicts = || -> [usize; 3] {
                let mut counts = [0; 3];
                for (a, b) in valid.iter().zip(valid.iter().cycle().skip(1)) {
                    counts[0] += usize::from(cx.model().motion(a, b, 1, scratch).is_some());
                    counts[1] += usize::from(cx.model().is_valid(a, scratch));
                    counts[2] += usize::from(
                        cx.model().clearances().expect("bodies").clearance(a, scratch).is_some(),
                    );
                }
                counts
            };
            let cold = verdicts();
            // Where it looks first depends on the last 32 verdicts: from here on every round begins with the same.
            (0..8).for_each(|_| assert_eq!(verdicts(), cold, "{name}"));
            let before = ASKED.get();
            assert!(before > 0, "what was asked for so far is counted");
            let warm = verdicts();
            let asked = ASKED.get() - before;
            assert_eq!(warm, cold, "{name}");
            assert_eq!(asked, 0, "{name}, {edges:?}: {asked} allocations");
            assert!(cold[0] > 0 && cold[1] == 40, "{name}: {cold:?}");
        }
    }
}
