use std::ops::Range;

/// A chain as an elastic network about one configuration: what is near one another there is held by springs, and steps are
/// taken that stretch these springs little. The directions of low frequency, in which large parts move against one
/// another, come by themselves, and what is strained relaxes on the way.
///
/// Steps are scaled until the shape has moved as far as is asked, by the root of the mean squared distance (RMSD) of all Cα
/// after superposition. Chance is the caller's: deviates come from outside.
pub trait Elastic {
    /// A random step to a distance of `length` Å, with a part that relaxes what is strained here. That part is not scaled: where it
    /// alone leads farther than `length`, the step is about that part, and longer than is asked. `deviates` are independent and normal with variance 1, as many as the
    /// space has degrees of freedom: along each direction the step is the wider the softer the network is there.
    ///
    /// `None` where the step is not to be had: where nothing moves, or numbers overflow.
    fn random(&self, deviates: &[f64], length: f64) -> Option<Vec<f64>>;

    /// A step that draws residues toward where another configuration has them, to a distance of at most `length` Å from here.
    ///
    /// `None` as for [`random`](Elastic::random), or where `draw` names what is not there.
    fn toward(&self, draw: &Draw, length: f64) -> Option<Vec<f64>>;
}

/// What draws a chain.
#[derive(Clone, Debug)]
pub struct Draw<'a> {
    /// The configuration to which it is drawn.
    pub target: &'a [f64],
    /// The residues that are drawn, counted from 0; the others are held where they are. The two shapes are laid upon one
    /// another by the residues that are held, or, where all are drawn, by all.
    pub residues: Range<usize>,
    /// How strongly each Cα is drawn, kT/Å².
    pub strength: f64,
}
