//! Validity that a program adds to a problem by a function of its own.
//!
//! The function judges single configurations, beside the model: valid is what both allow. Nothing can be proved of a function, so
//! that motions are looked at in steps, and only models that do so too (bodies with `edges = "sampled"`) can have one. It is no
//! data: ledgers and digests have its *identity*, a text that whoever writes the function declares and changes with it.
//! Whoever goes on with a run, verifies it or asks it for paths has to have the function again
//! ([`Problem::supplied_with`](crate::problem::Problem::supplied_with)).
//!
//! A function that fails, or contradicts itself, ends the work that needs it: no answer of such a function may reach a roadmap.

use crate::digest::Digest;
use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, OnceLock};

/// The most bytes of an identity.
const IDENTITY_BYTES_MAX: usize = 200;
/// The function is asked again about one configuration in so many, chosen by the configuration alone.
const ASKED_AGAIN: u8 = 16;

/// A function that says which configurations are valid.
pub trait JudgeConfigurations: Send + Sync {
    /// Whether `q` is valid: always the same answer for the same configuration, in whichever thread. `q` is within its bounds, and
    /// valid by the model.
    ///
    /// # Errors
    /// When the function fails.
    fn is_valid(&self, q: &[f64]) -> Result<bool, FunctionFailed>;
}

impl<F: Fn(&[f64]) -> bool + Send + Sync> JudgeConfigurations for F {
    fn is_valid(&self, q: &[f64]) -> Result<bool, FunctionFailed> {
        Ok(self(q))
    }
}

/// Why a validity function gave no answer that counts.
#[derive(Clone)]
pub struct FunctionFailed {
    /// The reason, for people.
    pub message: String,
    /// What the function failed with, for whoever wrote it: an exception, say.
    pub cause: Option<Arc<dyn Any + Send + Sync>>,
}

impl fmt::Debug for FunctionFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FunctionFailed").field(&self.message).finish()
    }
}

impl fmt::Display for FunctionFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for FunctionFailed {}

/// A validity function by its identity; and the function itself, where this process was given it.
#[derive(Clone)]
pub struct ValidityFunction {
    identity: String,
    given: Option<Given>,
}

#[derive(Clone)]
struct Given {
    function: Arc<dyn JudgeConfigurations>,
    /// The first failure, of all that work with the function.
    failure: Arc<OnceLock<FunctionFailed>>,
}

impl ValidityFunction {
    /// A function, and the identity that it is known by.
    ///
    /// # Errors
    /// Says what is wrong with the identity.
    pub fn new(
        identity: impl Into<String>,
        function: impl JudgeConfigurations + 'static,
    ) -> Result<ValidityFunction, String> {
        let given = Given { function: Arc::new(function), failure: Arc::default() };
        ValidityFunction::known(identity.into(), Some(given))
    }

    /// A function that is not here, of which the identity is known.
    ///
    /// # Errors
    /// Says what is wrong with the identity.
    pub(crate) fn absent(identity: String) -> Result<ValidityFunction, String> {
        ValidityFunction::known(identity, None)
    }

    fn known(identity: String, given: Option<Given>) -> Result<ValidityFunction, String> {
        let fits = (1..=IDENTITY_BYTES_MAX).contains(&identity.len());
        if !fits || identity.chars().any(char::is_control) {
            return Err(format!(
                "the identity {identity:?} of a validity function found; 1 to {IDENTITY_BYTES_MAX} bytes without control \
                 characters expected"
            ));
        }
        Ok(ValidityFunction { identity, given })
    }

    /// What the function is known by.
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// Whether the function itself is here.
    pub fn is_given(&self) -> bool {
        self.given.is_some()
    }

    /// Why the function failed, if it did: what was under way with it then has come to nothing.
    pub fn failure(&self) -> Option<&FunctionFailed> {
        self.given.as_ref()?.failure.get()
    }

    /// What the function says of a configuration. One that is not here allows none.
    pub(super) fn allows(&self, q: &[f64]) -> bool {
        let Some(Given { function, failure }) = &self.given else { return false };
        let answer = || function.is_valid(q);
        let found = match (answer(), is_asked_again(q)) {
            (Ok(first), true) => match answer() {
                Ok(second) if second != first => Err(FunctionFailed {
                    message: format!(
                        "the validity function `{}` said {first} of {q:?}, and {second} when it was asked again; a function \
                         of the configuration alone expected",
                        self.identity
                    ),
                    cause: None,
                }),
                again => again,
            },
            (first, _) => first,
        };
        match found {
            Ok(allowed) => allowed,
            Err(failed) => {
                _ = failure.set(failed.clone());
                // No answer may come of this, and the trait `Model` has no failures: the work ends here. No panic is reported.
                resume_unwind(Box::new(failed))
            }
        }
    }
}

/// Functions with the same identity count as the same.
impl PartialEq for ValidityFunction {
    fn eq(&self, other: &ValidityFunction) -> bool {
        self.identity == other.identity
    }
}

impl fmt::Debug for ValidityFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { identity, given } = self;
        write!(f, "ValidityFunction({identity:?}, given: {})", given.is_some())
    }
}

/// Whether the function is asked twice about a configuration. All that ask agree, wherever and whenever they do.
fn is_asked_again(q: &[f64]) -> bool {
    let bytes: Vec<u8> = q.iter().flat_map(|value| value.to_le_bytes()).collect();
    Digest::of(&bytes).0[0] < u8::MAX / ASKED_AGAIN + 1
}

/// Does work that may ask a validity function, and gives the function's failure if that ended it. Panics go on.
///
/// # Errors
/// When a validity function failed.
pub fn with_functions<T>(work: impl FnOnce() -> T) -> Result<T, FunctionFailed> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| match panic.downcast::<FunctionFailed>() {
        Ok(failed) => *failed,
        Err(panic) => resume_unwind(panic),
    })
}

#[cfg(test)]
mod tests;
