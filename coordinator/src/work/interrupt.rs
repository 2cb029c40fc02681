use crate::exit::{Code, Failure};
use crate::signals::Signals;
use roadmill::Cancel;
use std::sync::Arc;

/// What may end work from outside: a signal, or the program itself.
#[derive(Clone, Default)]
pub(super) struct Interrupt {
    pub signals: Option<Arc<Signals>>,
    pub cancel: Cancel,
}

impl Interrupt {
    /// Whether the work is to end.
    pub fn came(&self) -> bool {
        self.cancel.is_cancelled() || self.signals.as_ref().is_some_and(|signals| signals.came())
    }

    /// Why it is, for people.
    pub fn reason(&self) -> &'static str {
        if self.cancel.is_cancelled() { "it was cancelled" } else { "a signal came" }
    }

    /// The same as a failure, once it came.
    pub fn check(&self) -> Result<(), Failure> {
        if self.came() { Err(Failure::new(Code::Interrupted, self.reason())) } else { Ok(()) }
    }
}
