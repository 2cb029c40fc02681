use crate::structure::Residue;

/// The longest distance of a C and the N after it that counts as a peptide bond, in Å: W. Kabsch & C. Sander,
/// *Dictionary of protein secondary structure*, Biopolymers 22 (1983) 2577, on chain breaks. The bond itself is 1.33 Å.
const LONGEST_PEPTIDE_BOND: f64 = 2.5;

/// For each residue the number of the unbroken piece of chain that it belongs to, counted from 0. Between two residues
/// whose C and N are more than 2.5 Å apart, or of which one of these was not seen, there is a break.
pub fn segments(residues: &[Residue]) -> Vec<usize> {
    let mut segment = 0;
    let mut segments = Vec::with_capacity(residues.len());
    for (i, residue) in residues.iter().enumerate() {
        if i > 0 && !are_joined(&residues[i - 1], residue) {
            segment += 1;
        }
        segments.push(segment);
    }
    segments
}

fn are_joined(before: &Residue, after: &Residue) -> bool {
    let (Some(c), Some(n)) = (before.position("C"), after.position("N")) else { return false };
    (n - c).norm() <= LONGEST_PEPTIDE_BOND
}
