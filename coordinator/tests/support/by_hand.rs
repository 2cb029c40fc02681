//! A reader and writer of ledgers after `docs/ledger.md`, which shares no code with the program's.

#![allow(dead_code, reason = "every test file uses another part")]

/// The place of a record: its first byte and the first byte behind it.
#[derive(Clone, Debug)]
pub struct Frame {
    pub start: usize,
    pub end: usize,
    pub hash: [u8; 32],
    pub payload: Vec<u8>,
}

pub fn hash(parts: &[&[u8]]) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(part);
    }
    *hasher.finalize().as_bytes()
}

const LEDGER: &[u8; 16] = b"roadmill ledger\x02";
pub const SETS: &[u8; 16] = b"roadmill sets  \x01";

/// The records of a ledger, every length and hash checked.
pub fn frames(ledger: &[u8]) -> Vec<Frame> {
    frames_behind(LEDGER, ledger)
}

/// The same of any file with this heading.
pub fn frames_behind(heading: &[u8; 16], ledger: &[u8]) -> Vec<Frame> {
    assert_eq!(&ledger[..16], heading);
    let (mut at, mut before) = (16, hash(&[&ledger[..16]]));
    let mut frames = Vec::new();
    while at < ledger.len() {
        let head = &ledger[at..at + 16];
        assert_eq!(head[8..], hash(&[&head[..8]])[..8], "the check of a length");
        let length = u64::from_le_bytes(head[..8].try_into().unwrap()) as usize;
        let payload = &ledger[at + 48..at + 48 + length];
        let own = hash(&[&before, head, payload]);
        assert_eq!(ledger[at + 16..at + 48], own, "the hash of a record");
        let end = at + 48 + length;
        frames.push(Frame { start: at, end, hash: own, payload: payload.to_vec() });
        (at, before) = (end, own);
    }
    frames
}

/// A ledger of these payloads.
pub fn ledger_of(payloads: impl IntoIterator<Item = Vec<u8>>) -> Vec<u8> {
    file_of(LEDGER, payloads)
}

/// A file with this heading of these payloads.
pub fn file_of(heading: &[u8; 16], payloads: impl IntoIterator<Item = Vec<u8>>) -> Vec<u8> {
    let mut ledger = heading.to_vec();
    let mut before = hash(&[&ledger]);
    for payload in payloads {
        let mut head = (payload.len() as u64).to_le_bytes().to_vec();
        head.extend_from_within(..);
        let check = hash(&[&head[..8]]);
        head[8..].copy_from_slice(&check[..8]);
        before = hash(&[&before, &head, &payload]);
        ledger.extend(head);
        ledger.extend(before);
        ledger.extend(payload);
    }
    ledger
}

/// A side file whose newest slot says that this many frames are durable.
pub fn durable(frames: &[Frame]) -> Vec<u8> {
    let last = frames.last().expect("a frame");
    let mut slot = 7u64.to_le_bytes().to_vec();
    slot.extend((last.end as u64).to_le_bytes());
    slot.extend((frames.len() as u64).to_le_bytes());
    slot.extend(last.hash);
    slot.extend(hash(&[&slot]));
    let mut file = vec![0; 8192];
    file[4096..4096 + slot.len()].copy_from_slice(&slot);
    file
}

/// Where the fields of a set's record (kind 1) are: its degrees of freedom, and its values after their number.
pub fn set_places(payload: &[u8]) -> (usize, usize) {
    let mut fields = Fields(payload);
    fields.bytes(4 + 8);
    fields.text();
    fields.u64();
    let dofs = payload.len() - fields.0.len();
    (dofs, dofs + 4 + 8)
}

/// Writes the digest of the roadmap after each round anew, as if the sets had been made like that.
pub fn seal(payloads: &mut [Vec<u8>]) {
    let mut canonical: Option<blake3::Hasher> = None;
    let mut nodes = 0;
    for payload in payloads {
        let mut fields = Fields(payload);
        match fields.u32() {
            1 => {
                fields.u64();
                fields.text();
                fields.u64();
                let dofs = fields.u32();
                let values = fields.list(Fields::f64);
                let edges = fields.list(Fields::edge);
                fields.bytes(16);
                let joins = fields.list(Fields::edge);
                let hasher = canonical.get_or_insert_with(|| {
                    let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 roadmap digest");
                    hasher.update(&u64::from(dofs).to_le_bytes());
                    hasher
                });
                let own = (values.len() / dofs as usize) as u32;
                hasher.update(&u64::from(own).to_le_bytes());
                for value in &values {
                    hasher.update(&(value + 0.0).to_le_bytes());
                }
                for (list, first) in [(edges, nodes), (joins, 0)] {
                    hasher.update(&(list.len() as u64).to_le_bytes());
                    for (low, high, planner, weight) in list {
                        let (low, high) = (low.wrapping_add(first), high.wrapping_add(first));
                        hasher.update(&low.to_le_bytes()).update(&high.to_le_bytes());
                        hasher.update(&[planner]).update(&weight.to_le_bytes());
                    }
                }
                nodes += own;
            }
            2 => {
                let digest = canonical.as_ref().expect("sets came before").finalize();
                let at = payload.len() - 32;
                payload[at..].copy_from_slice(digest.as_bytes());
            }
            _ => {}
        }
    }
}

/// Reads fields one after the other.
pub struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    pub fn bytes(&mut self, count: usize) -> &'a [u8] {
        let (bytes, rest) = self.0.split_at(count);
        self.0 = rest;
        bytes
    }

    pub fn u8(&mut self) -> u8 {
        self.bytes(1)[0]
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes(4).try_into().unwrap())
    }

    pub fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.bytes(8).try_into().unwrap())
    }

    pub fn f64(&mut self) -> f64 {
        f64::from_bits(self.u64())
    }

    pub fn text(&mut self) -> String {
        let length = self.u64() as usize;
        String::from_utf8(self.bytes(length).to_vec()).unwrap()
    }

    pub fn hash(&mut self) -> [u8; 32] {
        self.bytes(32).try_into().unwrap()
    }

    pub fn list<T>(&mut self, mut item: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..self.u64()).map(|_| item(self)).collect()
    }

    pub fn option<T>(&mut self, item: impl FnOnce(&mut Self) -> T) -> Option<T> {
        match self.u8() {
            0 => None,
            1 => Some(item(self)),
            other => panic!("an option that begins with {other}"),
        }
    }

    pub fn edge(&mut self) -> (u32, u32, u8, f64) {
        (self.u32(), self.u32(), self.u8(), self.f64())
    }

    /// Whether it is satisfied, the value, and the length of the path if there is one.
    pub fn verdict(&mut self) -> (bool, f64, Option<f64>) {
        let satisfied = self.u8() == 1;
        let (value, _threshold) = (self.f64(), self.f64());
        assert!(self.u32() <= 1, "at least or at most");
        self.list(Fields::f64);
        let length = self.option(|fields| {
            fields.bytes(4 + 4 + 1);
            let length = fields.option(|fields| {
                fields.u32();
                fields.list(Fields::f64);
                fields.f64()
            });
            fields.u64();
            length
        });
        self.option(|fields| drop(fields.list(|fields| fields.bytes(4 + 4 + 8).len())));
        self.list(Fields::verdict);
        self.bytes(16);
        (satisfied, value, length.flatten())
    }
}
