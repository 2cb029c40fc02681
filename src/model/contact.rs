use super::Scratch;

/// A place where two bodies meet that must not, and how the model moves them apart there.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// A point of the place, in the world's frame.
    pub point: [f64; 3],
    /// In which direction the moving body leaves the other one there: a unit vector in the world's frame.
    pub normal: [f64; 3],
    /// How far the moving body would have to be translated along the normal for the two to be apart at this place, in the scene's unit. Elsewhere the same
    /// two bodies may be deeper in one another.
    pub depth: f64,
    /// How fast the two come apart along the normal when the configuration moves, per number of
    /// [`Space::moved`](crate::space::Space::moved): lengths per unit of the degree of freedom (the contact Jacobian's row).
    pub rates: Vec<f64>,
}

/// The capability of a model whose bodies collide: where they do, and how configurations get out of it.
pub trait Contacts {
    /// The places where bodies meet at `q`, the deepest first, at most `most`; none where nothing meets. That bodies reach beyond the bounds is no contact.
    ///
    /// What is given is a guide for moving out of a collision and no measure: bodies that have penetrated each other deeply leave
    /// open in which direction they come apart.
    fn contacts(&self, q: &[f64], most: usize, scratch: &mut Scratch) -> Vec<Contact>;
}
