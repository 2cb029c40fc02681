//! The pattern by which a problem file chooses among methods.

use std::borrow::Cow;
use std::fmt;

/// What is wrong with a method's setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// The setting's key.
    pub key: &'static str,
    /// The value that was found.
    pub found: String,
    /// What is expected, in words.
    pub expected: Cow<'static, str>,
}

impl Complaint {
    /// A complaint about the value `found` of the setting `key`.
    pub fn new(key: &'static str, found: impl fmt::Display, expected: &'static str) -> Complaint {
        Complaint { key, found: found.to_string(), expected: expected.into() }
    }

    /// What is wrong with a setting that must be a length above 0 and not above `most`, if anything is.
    pub fn of_length(key: &'static str, length: f64, most: f64) -> Option<Complaint> {
        // Written so that NaN is none.
        let is_sound = length > 0.0 && length <= most;
        let found = if length > most { format!("{length:e}") } else { length.to_string() };
        let expected = format!("a length above 0, at most {most:e},").into();
        (!is_sound).then_some(Complaint { key, found, expected })
    }

    /// What is wrong with the setting `attempts` of a method that tries at most so often, if anything is: it must be from 1 to
    /// `most`, so that a method which finds nothing ends.
    pub fn of_attempts(attempts: u64, most: u64) -> Option<Complaint> {
        let (found, expected) = (attempts.to_string(), format!("1 to {most}").into());
        let fits = (1..=most).contains(&attempts);
        (!fits).then_some(Complaint { key: "attempts", found, expected })
    }
}

/// As an error message: what was found, and what is expected.
impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} found; {} expected", self.key, self.found, self.expected)
    }
}

/// The most brackets that a method may have within one another as a problem file writes it, where the reader of TOML has
/// its bound. A program could give methods within methods without end, which would overflow the stack.
pub(crate) const BRACKETS_MAX: u32 = 80;

/// Room for the brackets of a method that holds no others: as many as the deepest of its settings has.
pub(crate) const BRACKETS_OF_SETTINGS: u32 = 6;

/// What is wrong with methods beyond [`BRACKETS_MAX`].
pub(crate) fn too_deep() -> String {
    format!(
        "methods within methods found; at most {BRACKETS_MAX} brackets within one another expected"
    )
}

/// An enum whose variants hold the settings of one method each, read straight from a problem file
/// (`sampler = { uniform = { attempts = 100 } }`, so that a misspelt key is reported at its own
/// line) and seen through a trait object.
macro_rules! methods {
    ($(#[$about:meta])* pub enum $name:ident: dyn $role:ident {
        $($variant:ident($method:ty),)+
    }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        #[derive(serde::Serialize, serde::Deserialize, bincode::Encode, bincode::Decode)]
        #[serde(rename_all = "kebab-case")]
        pub enum $name {
            $(#[allow(missing_docs)] $variant($method),)+
        }

        impl $name {
            /// The method behind its role.
            pub fn method(&self) -> &dyn $role {
                match self {
                    $($name::$variant(method) => method,)+
                }
            }

            /// The method behind its role, to be changed.
            #[allow(dead_code)]
            pub(crate) fn method_mut(&mut self) -> &mut dyn $role {
                match self {
                    $($name::$variant(method) => method,)+
                }
            }
        }
    };
}

pub(crate) use methods;
