use crate::exit::{Code, Failure};
use crate::signals::Signals;
use roadmill::Cancel;
use roadmill::model::ValidityFunction;
use std::sync::Arc;

/// What may end work from outside: a signal, the program itself, or a validity function that fails.
#[derive(Clone, Default)]
pub(super) struct Interrupt {
    pub signals: Option<Arc<Signals>>,
    pub cancel: Cancel,
    pub function: Option<ValidityFunction>,
}

impl Interrupt {
    /// Whether the work is to end.
    pub fn came(&self) -> bool {
        self.cancel.is_cancelled()
            || self.signals.as_ref().is_some_and(|signals| signals.came())
            || self.function_failed()
    }

    /// Why it is, for people.
    pub fn reason(&self) -> &'static str {
        if self.function_failed() {
            "its validity function failed"
        } else if self.cancel.is_cancelled() {
            "it was cancelled"
        } else {
            "a signal came"
        }
    }

    /// The same as a failure, once it came.
    pub fn check(&self) -> Result<(), Failure> {
        if let Some(failed) = self.function.as_ref().and_then(ValidityFunction::failure) {
            return Err(Failure::usage(failed));
        }
        if self.came() { Err(self.failure()) } else { Ok(()) }
    }

    /// The failure of work that it has ended.
    pub fn failure(&self) -> Failure {
        Failure::new(Code::Interrupted, self.reason())
    }

    fn function_failed(&self) -> bool {
        self.function.as_ref().is_some_and(|function| function.failure().is_some())
    }
}
