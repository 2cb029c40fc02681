//! The pattern by which a problem file chooses among methods.

/// What is wrong with a method's setting: its key, what was found, what is expected.
pub type Complaint = (&'static str, String, &'static str);

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
