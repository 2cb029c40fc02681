use bincode::Encode;
use bincode::de::{Decode, Decoder};
use bincode::error::DecodeError;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::sync::Arc;

/// The most configurations of a hint.
pub(crate) const CONFIGURATIONS_MAX: usize = 1_000_000;

/// An approximate path: configurations in their order, valid or not, between which the robot is meant to move straight.
///
/// A problem file names the file that holds it, from the folder of the problem file, or lists the configurations. Once the problem is read, the
/// configurations are part of the problem, as its meshes are; where they came from does not count, so that paths from different
/// files can be equal.
#[derive(Clone, Default)]
pub struct HintPath {
    /// The file, as the problem file writes it; empty where the configurations were listed or come from bytes.
    file: String,
    configurations: Arc<Vec<Vec<f64>>>,
}

impl HintPath {
    /// A path of these configurations. What is wrong with them is told when a problem is built that has the path.
    pub fn new(configurations: Vec<Vec<f64>>) -> HintPath {
        HintPath { file: String::new(), configurations: Arc::new(configurations) }
    }

    /// The path that a file holds; the file is read when a problem is built that has the path.
    pub fn of_file(file: impl Into<String>) -> HintPath {
        HintPath { file: file.into(), configurations: Arc::default() }
    }

    /// The file that holds it; empty where the configurations were listed or come from bytes.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The configurations in their order; none of a file that is not read yet.
    pub fn configurations(&self) -> &[Vec<f64>] {
        &self.configurations
    }

    /// The same file with what was read from it.
    pub(crate) fn with(self, configurations: Vec<Vec<f64>>) -> HintPath {
        HintPath { configurations: Arc::new(configurations), ..self }
    }

    /// The same configurations, as if they had been read from another file.
    pub(crate) fn named(&self, file: String) -> HintPath {
        HintPath { file, configurations: Arc::clone(&self.configurations) }
    }
}

/// The file and the number of configurations alone: a description of a problem is for people to read.
impl fmt::Debug for HintPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {} configurations", self.file, self.configurations.len())
    }
}

impl PartialEq for HintPath {
    fn eq(&self, other: &HintPath) -> bool {
        self.configurations == other.configurations
    }
}

/// The file, if there is one, else the configurations.
impl Serialize for HintPath {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.file.is_empty() {
            true => self.configurations.serialize(serializer),
            false => self.file.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for HintPath {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<HintPath, D::Error> {
        struct FileOrList;
        impl<'de> Visitor<'de> for FileOrList {
            type Value = HintPath;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a file, or an array of configurations")
            }

            fn visit_str<E: serde::de::Error>(self, file: &str) -> Result<HintPath, E> {
                match file.is_empty() {
                    true => Err(E::custom("no name found; the name of a file expected")),
                    false => Ok(HintPath::of_file(file)),
                }
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<HintPath, A::Error> {
                let mut configurations: Vec<Vec<f64>> = Vec::new();
                while let Some(q) = list.next_element()? {
                    if configurations.len() == CONFIGURATIONS_MAX {
                        return Err(A::Error::custom(too_long()));
                    }
                    configurations.push(q);
                }
                Ok(HintPath::new(configurations))
            }
        }
        deserializer.deserialize_any(FileOrList)
    }
}

/// What is wrong with a path of more configurations than [`CONFIGURATIONS_MAX`].
pub(crate) fn too_long() -> String {
    format!("more than {CONFIGURATIONS_MAX} configurations found; at most as many expected")
}

impl Encode for HintPath {
    fn encode<E: bincode::enc::Encoder>(
        &self,
        encoder: &mut E,
    ) -> Result<(), bincode::error::EncodeError> {
        self.configurations.encode(encoder)
    }
}

/// Checks what decoded bytes must show: finite values.
impl<Context> Decode<Context> for HintPath {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let configurations: Vec<Vec<f64>> = Decode::decode(decoder)?;
        match configurations.iter().flatten().all(|value| value.is_finite()) {
            true => Ok(HintPath::new(configurations)),
            false => Err(DecodeError::Other("a hint with a value that is no finite number")),
        }
    }
}
bincode::impl_borrow_decode!(HintPath);
