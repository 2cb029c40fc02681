//! What a refit came to.

use crate::model::protein::equations::Kind;
use std::fmt;

/// Whose a structure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The structure whose bonds, angles and omegas are kept.
    Source,
    /// The structure that is to be come near to.
    Target,
}

/// `source` or `target`.
impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            End::Source => "source",
            End::Target => "target",
        })
    }
}

/// Two sites of the refitted chain that are nearer than a rule allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clash {
    /// The earlier residue, counted from 0, and what of it: an atom's name, or `side chain`.
    pub first: (usize, &'static str),
    /// The later residue.
    pub second: (usize, &'static str),
    /// How far apart they are, Å.
    pub distance: f64,
    /// What the rule asks for, Å.
    pub least: f64,
}

impl Clash {
    pub(super) fn of(
        first: (usize, Kind),
        second: (usize, Kind),
        distance: f64,
        least: f64,
    ) -> Clash {
        let named = |(residue, kind): (usize, Kind)| (residue, kind.name());
        Clash { first: named(first), second: named(second), distance, least }
    }
}

/// A configuration of the source's linkage that is as near to the target as it gets, and how near that is.
#[derive(Clone, Debug, PartialEq)]
pub struct Refit {
    /// The torsions in radians, in [−π, π), in the order of the linkage.
    pub q: Vec<f64>,
    /// RMSD of N, CA, C and O from the target, each after superposition, with the target's torsions merely copied, Å.
    pub copied_rmsd: f64,
    /// RMSD of the CA of all residues from the target after superposition, Å.
    pub ca_rmsd: f64,
    /// RMSD of N, CA, C and O of all residues after superposition, Å.
    pub backbone_rmsd: f64,
    /// How far the CA of each residue is from the target's, in the superposition of all CA, Å.
    pub deviations: Vec<f64>,
    /// How many hydrogen bonds the target has (Kabsch & Sander, below −0.5 kcal/mol).
    pub hydrogen_bonds: usize,
    /// Those of them that the refitted chain does not have: donor and acceptor, counted from 0.
    pub lost_hydrogen_bonds: Vec<(usize, usize)>,
    /// The energy of these hydrogen bonds as constraints, in model kJ/mol: in the target as it is, and in the refitted chain.
    /// Bonds whose donor is a proline of the source count in neither.
    pub energy: [f64; 2],
    /// What violates the rules in the refitted chain and does not in the target.
    pub new_clashes: Vec<Clash>,
    /// Residues, counted from 0, the peptide bond before which is cis in one of the structures and trans in the other. Omega is
    /// the source's, so nothing comes near to the target there.
    pub turned_peptides: Vec<usize>,
    /// The steps of least squares that were tried.
    pub steps: usize,
}

impl Refit {
    /// The share of the target's hydrogen bonds that is kept; 1 if there are none.
    pub fn kept(&self) -> f64 {
        let lost = self.lost_hydrogen_bonds.len() as f64;
        if self.hydrogen_bonds == 0 { 1.0 } else { 1.0 - lost / self.hydrogen_bonds as f64 }
    }
}
