//! What is taken from groups of PDB files whose lines are not as simple as most.

use super::{error, one};

/// A line of an atom: its serial number, name, letter of the alternative location, five columns of residue name and
/// chain, x and y in Å, occupancy and element.
fn line(
    serial: usize,
    name: &str,
    letter: char,
    residue: &str,
    [x, y]: [f64; 2],
    occupancy: f64,
    element: &str,
) -> String {
    format!(
        "HETATM{serial:>5} {name:<4}{letter}{residue:<5}   1    {x:8.3}{y:8.3}   0.000{occupancy:6.2} 10.00          {element:>2}\n"
    )
}

/// Acetaldehyde's two carbons and its oxygen, in a residue.
fn acetaldehyde(residue: &str) -> String {
    [
        line(1, " C1", ' ', residue, [0.0, 0.0], 1.0, "C"),
        line(2, " C2", ' ', residue, [1.5, 0.0], 1.0, "C"),
        line(3, " O1", ' ', residue, [2.2, 1.2], 1.0, "O"),
    ]
    .concat()
}

#[test]
fn lines_with_other_characters_than_ascii_are_refused() {
    let text = acetaldehyde("LIG A");
    // The prime of a nucleotide's atom as a word processor writes it, where the columns begin to shift and before.
    for (from, to, number) in
        [(" O1 ", " O5’", 3), (" C2 ", " C’2", 2), ("HETATM    1", "HETATM’   1", 1)]
    {
        let found = error(&text.replace(from, to)).to_string();
        let expected = format!(
            "line {number}: a line of an atom or a bond with `’` found; columns of ASCII expected"
        );
        assert_eq!(found, expected, "{to}");
    }
    for other in ["ATOM      9  O5’ DA  B   1\n", "CONECT    1    2 é\n"] {
        assert_eq!(error(&format!("{text}{other}")).line(), Some(4), "{other}");
    }
    assert_eq!(one(&format!("REMARK   1 AUTH   J.MÜLLER\n{text}")).atoms().len(), 3);
    let found = error(&super::ETHER.replacen(" O1 ", " O’ ", 1));
    assert_eq!(found.line(), Some(3), "{found}");
}
