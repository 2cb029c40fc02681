use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A switch that ends a build, or a search for pathways. Its clones are the same switch: one stays with the work, another goes to
/// a signal handler, a button or a clock.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// A switch that is off.
    pub fn new() -> Cancel {
        Cancel::default()
    }

    /// Ends the work: now, if it runs, or as soon as it begins.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// Whether the work is to end.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
