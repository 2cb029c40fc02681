//! The element of an atom: by its own column or item, or else by the atom's name.

/// The symbols of all elements, in capitals, and `D`, deuterium.
const SYMBOLS: &str = " H HE LI BE B C N O F NE NA MG AL SI P S CL AR K CA SC TI V CR MN FE CO NI CU ZN GA GE AS SE BR \
    KR RB SR Y ZR NB MO TC RU RH PD AG CD IN SN SB TE I XE CS BA LA CE PR ND PM SM EU GD TB DY HO ER TM YB LU HF TA W \
    RE OS IR PT AU HG TL PB BI PO AT RN FR RA AC TH PA U NP PU AM CM BK CF ES FM MD NO LR D ";

/// The symbol as in the periodic table (`Ca`), if the word is one, in letters of either size.
pub(super) fn symbol(word: &str) -> Option<String> {
    let word = word.trim();
    if word.is_empty() || word.len() > 2 || !word.bytes().all(|byte| byte.is_ascii_alphabetic()) {
        return None;
    }
    let capitals = word.to_ascii_uppercase();
    SYMBOLS.contains(&format!(" {capitals} ")).then(|| {
        let (first, rest) = capitals.split_at(1);
        format!("{first}{}", rest.to_ascii_lowercase())
    })
}

/// The element of an atom that the file does not tell, by its name.
///
/// `name` is as in a PDB file's four columns, in which the element's symbol ends with the second: ` CA ` is an alpha
/// carbon, `CA  ` calcium. In amino acids the first letter decides, for hydrogens of four letters (`HG11`) and names
/// that programs have moved to the left look like other elements; an atom called as its residue (`ZN` of `ZN`) is
/// an ion. The empty word where the name has no letter.
pub(super) fn of_name(name: &str, residue: &str, is_amino_acid: bool) -> String {
    let trimmed = name.trim();
    let letters = trimmed.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
    let first = letters.get(..1).and_then(symbol).unwrap_or_default();
    let first_two = letters.get(..2).and_then(symbol);
    if is_amino_acid {
        return if trimmed == "SE" { "Se".to_owned() } else { first };
    }
    let is_ion = trimmed == residue;
    let is_at_left = name.starts_with(|c: char| c.is_ascii_alphabetic()) && trimmed.len() < 4;
    match first_two {
        Some(two) if is_ion || is_at_left && name.len() == 4 => two,
        _ => first,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_tell_calcium_from_alpha_carbons() {
        assert_eq!(of_name("CA  ", "CA", false), "Ca");
        assert_eq!(of_name("CA  ", "XYZ", false), "Ca");
        assert_eq!(of_name(" CA ", "XYZ", false), "C");
        assert_eq!(of_name("CA  ", "ALA", true), "C");
        assert_eq!(of_name("HG11", "VAL", true), "H");
        assert_eq!(of_name("1HB ", "ALA", true), "H");
        assert_eq!(of_name("SE  ", "MSE", true), "Se");
        assert_eq!(of_name("****", "XYZ", false), "");
    }

    #[test]
    fn symbols_are_those_of_elements() {
        assert_eq!(symbol("CA").as_deref(), Some("Ca"));
        assert_eq!(symbol(" c").as_deref(), Some("C"));
        for word in ["OA", "", "1", "Car", "é"] {
            assert_eq!(symbol(word), None);
        }
    }
}
