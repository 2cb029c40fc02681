use crate::structure::Residue;

/// The capability of a model of a molecule: the atoms of a configuration, for programs that show molecules.
pub trait Molecule {
    /// The chains, first that which moves, with all atoms where they are at the configuration `q`, in Å.
    fn chains_at(&self, q: &[f64]) -> Vec<Vec<Residue>>;

    /// Whether chains are there that do not move.
    fn has_chains_that_stand_still(&self) -> bool;

    /// What energies a configuration has, part by part.
    fn energies(&self) -> Energies<'_>;

    /// What these energies are and what they are not, in a paragraph for people who read results.
    fn about_energies(&self) -> &'static str;
}

/// The parts of a molecule's energy, and the whole.
pub struct Energies<'a> {
    /// The name of each, with its unit, as `energy [kJ/mol]`; the last is the whole.
    pub columns: Vec<&'static str>,
    /// The numbers at a configuration, in that order.
    #[allow(clippy::type_complexity, reason = "a function of a configuration")]
    pub at: Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>,
}
