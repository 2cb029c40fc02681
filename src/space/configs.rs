use crate::shelf::{self, Block, BlockName, Shelf};
use bincode::de::{Decode, Decoder};
use bincode::enc::{Encode, Encoder};
use bincode::error::{DecodeError, EncodeError};

/// Number of configurations in a block that is kept on a shelf; a power of two.
const BLOCK: usize = if cfg!(test) { 1 << 5 } else { 1 << 10 };

/// A list of configurations, `dofs` values each.
#[derive(Clone, Debug)]
pub struct Configs {
    dofs: u32,
    /// The blocks of [`BLOCK`] configurations that are kept on a shelf: the beginning of the list.
    blocks: Vec<Block>,
    /// The values of the remaining configurations.
    values: Vec<f64>,
}

impl Configs {
    /// No configurations of `dofs` values.
    pub fn new(dofs: usize) -> Configs {
        Configs { dofs: dofs as u32, blocks: Vec::new(), values: Vec::new() }
    }

    /// Number of configurations.
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.values.len() / self.dofs().max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty() && self.values.is_empty()
    }

    /// Number of values of a configuration.
    pub fn dofs(&self) -> usize {
        self.dofs as usize
    }

    /// Configuration `index`.
    #[inline]
    pub fn get(&self, index: usize) -> &[f64] {
        let (dofs, block) = (self.dofs(), index / BLOCK);
        let (values, index) = match self.blocks.get(block) {
            None => (&self.values[..], index - self.blocks.len() * BLOCK),
            Some(block) => (bytemuck::cast_slice(block), index % BLOCK),
        };
        &values[index * dofs..(index + 1) * dofs]
    }

    /// Appends one configuration.
    ///
    /// # Panics
    /// If it has not `dofs` values.
    pub fn push(&mut self, q: &[f64]) {
        assert_eq!(q.len(), self.dofs());
        self.values.extend_from_slice(q);
    }

    /// Appends one configuration, unless it is the last one of the list already.
    pub(crate) fn push_if_new(&mut self, q: &[f64]) {
        let again = self.len().checked_sub(1).is_some_and(|last| self.get(last) == q);
        if !again {
            self.push(q);
        }
    }

    /// Appends another list, whose configurations have as many values.
    pub fn extend(&mut self, other: &Configs) {
        assert_eq!(other.dofs, self.dofs);
        other.slices().for_each(|values| self.values.extend_from_slice(values));
    }

    /// All configurations in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        (0..self.len()).map(|index| self.get(index))
    }

    /// All values, configuration after configuration.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.slices().flatten().copied()
    }

    fn slices(&self) -> impl Iterator<Item = &[f64]> {
        let blocks = self.blocks.iter().map(|block| bytemuck::cast_slice(block));
        blocks.chain(std::iter::once(&self.values[..]))
    }

    /// Whether the list holds whole configurations of `dofs` finite values: a check of decoded bytes.
    pub fn is_sound(&self, dofs: usize) -> bool {
        self.dofs() == dofs
            && self.values.len().is_multiple_of(dofs.max(1))
            && self.values().all(f64::is_finite)
    }

    /// Moves what fills whole blocks to the shelf, which replicas of the roadmap share.
    pub(crate) fn share_full_blocks(&mut self, shelf: &dyn Shelf) {
        let length = BLOCK * self.dofs();
        let mut rest = &self.values[..];
        while let Some((values, others)) = rest.split_at_checked(length.max(1)) {
            let name = BlockName::Configs(self.blocks.len() as u32);
            let bytes = bytemuck::cast_slice(values);
            let mut fill = |block: &mut [u8]| block.copy_from_slice(bytes);
            self.blocks.push(shelf::kept(shelf, name, bytes.len(), &mut fill));
            rest = others;
        }
        let shared = self.values.len() - rest.len();
        self.values.drain(..shared);
    }
}

/// Two lists are equal if their configurations are, wherever these are kept.
impl PartialEq for Configs {
    fn eq(&self, other: &Configs) -> bool {
        self.dofs == other.dofs && self.len() == other.len() && self.values().eq(other.values())
    }
}

/// Encoded as the number of values of a configuration, followed by all values.
impl Encode for Configs {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.dofs.encode(encoder)?;
        let shared = self.blocks.len() * BLOCK * self.dofs();
        ((shared + self.values.len()) as u64).encode(encoder)?;
        self.values().try_for_each(|value| value.encode(encoder))
    }
}

impl<Context> Decode<Context> for Configs {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Configs, DecodeError> {
        let dofs = u32::decode(decoder)?;
        Ok(Configs { dofs, blocks: Vec::new(), values: Vec::decode(decoder)? })
    }
}
bincode::impl_borrow_decode!(Configs);
