use crate::structure::Residue;

/// The capability of a model of a molecule: the atoms of a configuration, for programs that show molecules.
pub trait Molecule {
    /// The chains, first that which moves, with all atoms where they are at the configuration `q`, in Å.
    fn chains_at(&self, q: &[f64]) -> Vec<Vec<Residue>>;
}
