use super::message::PROTOCOL;
use bincode::{Decode, Encode};
use roadmill::BITS_VERSION;
use std::fmt;

/// Which program this is. Programs of one machine are told apart by their file
/// ([`roadmill_workers::build_id`]); those of different machines are different files, built for each, of the same sources.
#[derive(Debug, Clone, PartialEq, Eq, Encode, Decode)]
pub struct Identity {
    /// [`PROTOCOL`].
    pub protocol: u32,
    /// [`BITS_VERSION`].
    pub bits: u32,
    /// BLAKE3 of all sources that it was built from, in hexadecimal digits.
    pub source: String,
    /// Its version and the machine that it is for, for people.
    pub program: String,
}

impl Identity {
    /// Of this program.
    pub fn own() -> Identity {
        Identity {
            protocol: PROTOCOL,
            bits: BITS_VERSION,
            source: env!("ROADMILL_SOURCE").to_owned(),
            program: format!("roadmill {} ({})", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH),
        }
    }

    /// Why these two may not work on one roadmap, if they may not: said of `other`.
    pub fn differs_from(&self, other: &Identity) -> Option<String> {
        let (theirs, ours) = (other.program.as_str(), self.program.as_str());
        if other.protocol != self.protocol {
            let (theirs_protocol, ours_protocol) = (other.protocol, self.protocol);
            return Some(format!(
                "{theirs} speaks version {theirs_protocol} of the agents' messages, {ours} version {ours_protocol}"
            ));
        }
        if other.bits != self.bits {
            return Some(format!(
                "{theirs} makes bits of version {}, {ours} of version {}",
                other.bits, self.bits
            ));
        }
        (other.source != self.source).then(|| {
            format!(
                "{theirs} was built from other sources ({}) than {ours} ({})",
                short(&other.source),
                short(&self.source)
            )
        })
    }
}

/// The beginning of a digest, for people; whatever the other end may have sent instead.
fn short(source: &str) -> String {
    source.chars().filter(char::is_ascii_hexdigit).take(12).collect()
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, sources {}", self.program, short(&self.source))
    }
}
