use super::report::End;

/// Why there is no refit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefitError {
    /// The chains do not match.
    #[error(
        "the {} has {source_len} residues and the {} {target_len}, where a refit needs residue for residue",
        End::Source,
        End::Target
    )]
    Lengths {
        /// The residues of the source.
        source_len: usize,
        /// The residues of the target.
        target_len: usize,
    },
    /// The chains are too long: the matrix of the least squares has the square of their torsions as its size.
    #[error("chains of {residues} residues found; at most {max} expected for a refit")]
    TooLong {
        /// The residues of the source.
        residues: usize,
        /// The most that are fitted.
        max: usize,
    },
    /// An atom of the backbone was not seen.
    #[error(
        "{residue} of the {end} has no atom {atom}, where a refit needs N, CA, C and O of every residue"
    )]
    NoAtom {
        /// Whose it is.
        end: End,
        /// The residue.
        residue: String,
        /// The atom's name.
        atom: &'static str,
    },
    /// The chain has no torsions: bonded atoms stand on one another, or coordinates are no numbers.
    #[error(
        "the backbone of the {0} has two atoms on one another, or a coordinate that is no number"
    )]
    NoBackbone(End),
    /// The linkage, or the torsions to begin with, are not those of the source.
    #[error("the linkage or its torsions are not those of the {}", End::Source)]
    OtherLinkage,
}
