use bincode::{Decode, Encode};

/// Configurations in one flat block, `dofs` values each.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Configs {
    dofs: u32,
    values: Vec<f64>,
}

impl Configs {
    /// No configurations of `dofs` values.
    pub fn new(dofs: usize) -> Configs {
        Configs { dofs: dofs as u32, values: Vec::new() }
    }

    /// Number of configurations.
    pub fn len(&self) -> usize {
        self.values.len() / (self.dofs as usize).max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Number of values of a configuration.
    pub fn dofs(&self) -> usize {
        self.dofs as usize
    }

    /// Configuration `index`.
    pub fn get(&self, index: usize) -> &[f64] {
        &self.values[index * self.dofs()..(index + 1) * self.dofs()]
    }

    /// Appends one configuration.
    ///
    /// # Panics
    /// If it has not `dofs` values.
    pub fn push(&mut self, q: &[f64]) {
        assert_eq!(q.len(), self.dofs());
        self.values.extend_from_slice(q);
    }

    /// Appends all of another block of the same `dofs`.
    pub fn extend(&mut self, other: &Configs) {
        assert_eq!(other.dofs, self.dofs);
        self.values.extend_from_slice(&other.values);
    }

    /// All configurations in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.dofs().max(1))
    }

    /// All values, configuration after configuration.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Whether the block is whole and holds finite numbers only: what decoded bytes must be.
    pub fn is_sound(&self, dofs: usize) -> bool {
        self.dofs() == dofs
            && self.values.len().is_multiple_of(dofs.max(1))
            && self.values.iter().all(|value| value.is_finite())
    }
}
