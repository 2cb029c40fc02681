use super::{Chain, ResidueNumber, Structure, StructureError, StructureModel};

/// Which part of a model is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChainSelection<'a> {
    /// The chain's name; `None` of the only chain of amino acids.
    pub chain: Option<&'a str>,
    /// The first and the last residue; `None` of all.
    pub range: Option<(ResidueNumber, ResidueNumber)>,
}

/// Reads the first and the last residue of a range such as `4-147`, `-3-52A`.
pub fn parse_range(text: &str) -> Option<(ResidueNumber, ResidueNumber)> {
    // The first character may be a sign.
    let after_first = text.char_indices().nth(1)?.0;
    let middle = after_first + text[after_first..].find('-')?;
    Some((parse_number(&text[..middle])?, parse_number(&text[middle + 1..])?))
}

/// Reads a residue's number with its insertion code: `52`, `52A`.
fn parse_number(text: &str) -> Option<ResidueNumber> {
    let insertion = text.chars().next_back().filter(char::is_ascii_alphabetic);
    let number = if insertion.is_some() { &text[..text.len() - 1] } else { text };
    Some(ResidueNumber { number: number.parse().ok()?, insertion })
}

/// The model of this number, or the first if no number is asked for.
///
/// # Errors
/// No such model; the numbers that there are, are listed.
pub fn select_model(
    structure: &Structure,
    number: Option<i32>,
) -> Result<&StructureModel, StructureError> {
    let models = &structure.models;
    let Some(number) = number else { return Ok(&models[0]) };
    models.iter().find(|model| model.number == number).ok_or_else(|| {
        let numbers: Vec<String> = models.iter().map(|model| model.number.to_string()).collect();
        let numbers = numbers.join(", ");
        StructureError::pathless(format!("no model {number} found; one of {numbers} expected"))
    })
}

/// The index in the model of the chain that is meant by its name, or of the only chain of amino acids.
///
/// A sole chain of amino acids answers to any name, for many files leave it blank.
///
/// # Errors
/// No such chain, or several that may be meant; what there is, is listed.
pub fn find_chain(model: &StructureModel, name: Option<&str>) -> Result<usize, StructureError> {
    let proteins: Vec<usize> =
        (0..model.chains.len()).filter(|at| !model.chains[*at].residues.is_empty()).collect();
    let named = |at: &usize| name.is_none_or(|name| model.chains[*at].name == name);
    let matching: Vec<usize> = proteins.iter().copied().filter(named).collect();
    let list =
        |places: &[usize]| list(&places.iter().map(|at| &model.chains[*at]).collect::<Vec<_>>());
    let message = match (matching.as_slice(), proteins.as_slice()) {
        ([chain], _) | ([], [chain]) => return Ok(*chain),
        (_, []) => "no amino acids found; a chain of amino acids expected".to_owned(),
        ([], _) => {
            let (name, listed) = (name.unwrap_or_default(), list(&proteins));
            format!("no chain `{name}` found; one of {listed} expected")
        }
        (several, _) => {
            let what = match name {
                Some(name) => format!("{} chains called `{name}`", several.len()),
                None => format!("{} chains", several.len()),
            };
            format!("{what} found: {}; the name of one expected", list(several))
        }
    };
    Err(StructureError::pathless(message))
}

/// The chain that is meant, without what is no residue of its range. `others` stay as they are.
///
/// # Errors
/// As [`find_chain`], and no such residue; what there is, is listed.
pub fn select_chain(
    model: &StructureModel,
    selection: ChainSelection,
) -> Result<Chain, StructureError> {
    let chain = &model.chains[find_chain(model, selection.chain)?];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{AminoAcid, Residue};

    fn chain(name: &str, numbers: std::ops::Range<i32>) -> Chain {
        let residue = |number| Residue {
            number: ResidueNumber { number, insertion: None },
            name: "GLY".to_owned(),
            amino_acid: Some(AminoAcid::Glycine),
            atoms: Vec::new(),
        };
        Chain {
            name: name.to_owned(),
            residues: numbers.map(residue).collect(),
            others: Vec::new(),
        }
    }

    fn model(chains: Vec<Chain>) -> StructureModel {
        StructureModel { number: 1, chains }
    }

    fn error(model: &StructureModel, chain: Option<&str>, range: Option<&str>) -> String {
        let range = range.and_then(parse_range);
        select_chain(model, ChainSelection { chain, range }).unwrap_err().to_string()
    }

    #[test]
    fn a_sole_chain_answers_to_any_name() {
        let model = model(vec![chain("", 1..6), chain("W", 0..0)]);
        for name in [None, Some("A"), Some("")] {
            let selection = ChainSelection { chain: name, range: parse_range("2-4") };
            let found = select_chain(&model, selection).unwrap();
            let numbers: Vec<i32> =
                found.residues.iter().map(|residue| residue.number.number).collect();
            assert_eq!(numbers, [2, 3, 4]);
        }
    }

    #[test]
    fn errors_list_what_there_is() {
        let two = model(vec![chain("A", 1..6), chain("B", -2..9)]);
        let listed = "`A` (GLY 1 to GLY 5), `B` (GLY -2 to GLY 8)";
        assert_eq!(
            error(&two, Some("C"), None),
            format!("no chain `C` found; one of {listed} expected")
        );
        assert!(error(&two, None, None).contains(listed));
        assert!(
            error(&two, Some("A"), Some("0-4")).starts_with("no residue 0 found; one of chain `A`")
        );
        assert!(error(&two, Some("A"), Some("4-2")).contains("the first before the last"));
        let same = model(vec![chain("A", 1..6), chain("A", 1..9)]);
        assert!(error(&same, Some("A"), None).starts_with("2 chains called `A` found"));
        assert!(error(&model(Vec::new()), None, None).starts_with("no amino acids"));
    }

    #[test]
    fn ranges_may_begin_below_zero_and_end_at_inserted_residues() {
        let shown = |text: &str| parse_range(text).map(|(a, b)| format!("{a} {b}"));
        assert_eq!(shown("4-147").as_deref(), Some("4 147"));
        assert_eq!(shown("-3-52A").as_deref(), Some("-3 52A"));
        assert_eq!(shown("-9--3").as_deref(), Some("-9 -3"));
        for text in ["", "4", "-4", "a-b", "4-", "é-4", "4-é", "A-4"] {
            assert_eq!(shown(text), None, "{text}");
        }
    }
}
