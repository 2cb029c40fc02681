//! Which of the alternative locations of a residue's atoms are taken.
//!
//! Files give alternatives letters. Of a residue one letter is taken: that whose atoms have the highest occupancy
//! together, of equal ones the first in the alphabet. Its atoms and those without a letter are the residue's; so all of
//! them come from one conformer. Where residues of two names are alternatives (microheterogeneity) the letter decides
//! which of them it is.
//!
//! Some programs drop the letters and keep the atoms. Atoms of one name in a residue that all have an occupancy below 1
//! are given letters in their order.

use super::site::Site;

/// Gives letters to the alternatives of a residue's atoms that have lost them.
pub(super) fn restore_letters(residue: &mut [Site]) {
    let is_partial = |site: &Site| site.letter.is_none() && site.occupancy < 1.0;
    let letter = |place: usize| {
        let site = &residue[place];
        let same = |other: &&Site| other.name == site.name && is_partial(other);
        let before = residue[..place].iter().filter(same).count();
        let is_one_of_several = is_partial(site) && residue.iter().filter(same).count() > 1;
        let letter = is_one_of_several.then(|| ('A'..='Z').nth(before));
        letter.flatten()
    };
    let letters: Vec<Option<char>> = (0..residue.len()).map(letter).collect();
    for (site, letter) in residue.iter_mut().zip(letters) {
        site.letter = site.letter.or(letter);
    }
}

/// The letters of some atoms in the order of the alphabet, each with its atoms' occupancies together.
pub(super) fn letters<'a>(sites: impl Iterator<Item = &'a Site>) -> Vec<(char, f64)> {
    let mut letters: Vec<(char, f64)> = Vec::new();
    for site in sites {
        let Some(letter) = site.letter else { continue };
        match letters.binary_search_by_key(&letter, |(other, _)| *other) {
            Ok(place) => letters[place].1 += site.occupancy,
            Err(place) => letters.insert(place, (letter, site.occupancy)),
        }
    }
    letters
}

/// The letter that is taken; `None` where there are none.
pub(super) fn chosen(letters: &[(char, f64)]) -> Option<char> {
    let (mut best, mut highest) = (None, f64::NEG_INFINITY);
    for (letter, occupancy) in letters {
        if *occupancy > highest {
            (best, highest) = (Some(*letter), *occupancy);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_occupancy_is_taken_and_the_first_letter_of_equals() {
        assert_eq!(chosen(&[]), None);
        assert_eq!(chosen(&[('A', 1.0), ('B', 1.5), ('C', 1.5)]), Some('B'));
        assert_eq!(chosen(&[('A', 1.0), ('B', 1.0)]), Some('A'));
    }
}
