//! What a search of the index is told about the configurations that it searches.

/// The configurations that a search goes through, and which of them it may return.
///
/// The ids are those of the [`Index`](super::Index). A label is what the index was given for an id when it was
/// extended, such as the connected component of a roadmap's node.
pub trait Searched {
    /// The configuration of an eligible id, in stored form.
    fn config(&self, id: u32) -> &[f64];

    /// Whether the search may return an id.
    fn is_eligible(&self, _id: u32) -> bool {
        true
    }

    /// The name under which the search returns an eligible id. Ties are broken by names.
    fn name(&self, id: u32) -> u32 {
        id
    }

    /// `Some(true)` if all ids with the same label as `id` are eligible, `Some(false)` if none of them is, `None`
    /// if labels do not decide that. It spares looking at ids whose common label is known.
    fn label_is_eligible(&self, _id: u32) -> Option<bool> {
        None
    }
}
