use bincode::{Decode, Encode};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A BLAKE3 digest, shown as 64 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Encode, Decode)]
pub struct Digest(pub [u8; 32]);

impl Digest {
    /// The digest of some bytes.
    pub fn of(bytes: &[u8]) -> Digest {
        Digest(*blake3::hash(bytes).as_bytes())
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// As text, 64 hexadecimal digits.
impl Serialize for Digest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Digest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Digest, D::Error> {
        let text = String::deserialize(deserializer)?;
        let digest = blake3::Hash::from_hex(&text);
        digest.map(|hash| Digest(*hash.as_bytes())).map_err(|_| {
            D::Error::custom(format!("`{text}` found; a digest of 64 hexadecimal digits expected"))
        })
    }
}

/// A file that a problem was read from, and the digest of its bytes.
#[derive(Clone, Debug, PartialEq, Eq, Encode, Decode)]
pub struct SourceFile {
    /// Its path as it is written where it is named; of the problem's own file the name alone.
    pub path: String,
    /// Digest of its bytes.
    pub digest: Digest,
}

impl SourceFile {
    /// The file at `path` with these bytes.
    pub fn new(path: impl Into<String>, bytes: &[u8]) -> SourceFile {
        SourceFile { path: path.into(), digest: Digest::of(bytes) }
    }

    /// The file that names others, by its own name.
    pub fn named(path: &std::path::Path, bytes: &[u8]) -> SourceFile {
        let name = path.file_name().unwrap_or_default();
        SourceFile::new(name.to_string_lossy(), bytes)
    }
}
