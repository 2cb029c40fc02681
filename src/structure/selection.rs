use super::{Chain, ResidueNumber, StructureError, StructureModel};

/// Which part of a model is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChainSelection<'a> {
    /// The chain's name; `None` of the only chain of amino acids.
    pub chain: Option<&'a str>,
    /// The first and the last residue; `None` of all.
    pub range: Option<(ResidueNumber, ResidueNumber)>,
}

/// The chain that is meant, without what is no residue of its range. `others` stay as they are.
///
/// A sole chain of amino acids answers to any name, for many files leave it blank.
///
/// # Errors
/// No such chain or residue, or several chains that may be meant; what there is, is listed.
pub fn select_chain(
    model: &StructureModel,
    selection: ChainSelection,
) -> Result<Chain, StructureError> {
    let proteins: Vec<&Chain> =
        model.chains.iter().filter(|chain| !chain.residues.is_empty()).collect();
    let named = |chain: &&&Chain| selection.chain.is_none_or(|name| chain.name == name);
    let matching: Vec<&Chain> = proteins.iter().filter(named).copied().collect();
    let chain = match (matching.as_slice(), proteins.as_slice()) {
        ([chain], _) | ([], [chain]) => *chain,
        (_, []) => {
            let message = "no amino acids found; a chain of amino acids expected";
            return Err(StructureError::pathless(message));
        }
        ([], _) => {
            let name = selection.chain.unwrap_or_default();
            let listed = list(&proteins);
            let message = format!("no chain `{name}` found; one of {listed} expected");
            return Err(StructureError::pathless(message));
        }
        (several, _) => {
            let what = match selection.chain {
                Some(name) => format!("{} chains called `{name}`", several.len()),
                None => format!("{} chains", several.len()),
            };
            let message = format!("{what} found: {}; the name of one expected", list(several));
            return Err(StructureError::pathless(message));
        }
    };
    let Some((first, last)) = selection.range else { return Ok(chain.clone()) };
    let place = |number: ResidueNumber| {
        let found = chain.residues.iter().position(|residue| residue.number == number);
        found.ok_or_else(|| {
            let listed = list(&[chain]);
            let message = format!("no residue {number} found; one of chain {listed} expected");
            StructureError::pathless(message)
        })
    };
    let (begin, end) = (place(first)?, place(last)?);
    if begin > end {
        let message =
            format!("residues {first} to {last} found; the first before the last expected");
        return Err(StructureError::pathless(message));
    }
    let residues = chain.residues[begin..=end].to_vec();
    Ok(Chain { name: chain.name.clone(), residues, others: chain.others.clone() })
}

/// Chains with their first and last residues: "`A` (MET 1 to GLY 214)".
fn list(chains: &[&Chain]) -> String {
    let of = |chain: &&Chain| match (chain.residues.first(), chain.residues.last()) {
        (Some(first), Some(last)) => format!("`{}` ({first} to {last})", chain.name),
        _ => format!("`{}`", chain.name),
    };
    chains.iter().map(of).collect::<Vec<_>>().join(", ")
}
