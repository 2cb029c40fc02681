//! Chains for tests: made up, and read from files of the data folder.

use crate::math;
use crate::structure::{AminoAcid, Atom, Point, Residue, ResidueNumber};
use std::path::PathBuf;

/// Numbers in [0, 1) that follow from a number.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Numbers {
        Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Normally distributed, of deviation 1 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * math::ln(1.0 - self.next())).sqrt();
        radius * math::cos(math::TURN * self.next())
    }

    fn point(&mut self, size: f64) -> Point {
        Point::from_fn(|_, _| (2.0 * self.next() - 1.0) * size)
    }
}

fn residue(number: usize, amino_acid: AminoAcid, atoms: &[(&str, Point)]) -> Residue {
    let atom = |(name, position): &(&str, Point)| Atom {
        name: name.to_string(),
        element: name[..1].to_string(),
        position: *position,
    };
    Residue {
        number: ResidueNumber { number: number as i32 + 1, insertion: None },
        name: amino_acid.code().to_string(),
        amino_acid: Some(amino_acid),
        atoms: atoms.iter().map(atom).collect(),
    }
}

/// A chain that nature would not build: every bond has a direction of its own.
pub fn crooked(len: usize, seed: u64) -> Vec<Residue> {
    use AminoAcid::*;
    let mut numbers = Numbers::new(seed);
    let mut at = Point::zeros();
    let mut step = |numbers: &mut Numbers| {
        at += Point::new(0.8, 0.0, 0.0) + numbers.point(1.0);
        at
    };
    let of = |i| {
        let kinds = [Alanine, Glycine, Proline, Serine, Leucine];
        let kind = kinds[(numbers.next() * 5.0) as usize];
        let (n, ca, c) = (step(&mut numbers), step(&mut numbers), step(&mut numbers));
        let o = c + numbers.point(1.0);
        let mut atoms = vec![("N", n), ("CA", ca), ("C", c), ("O", o)];
        if kind != Glycine {
            atoms.extend([("CB", ca + numbers.point(1.0)), ("CG", ca + numbers.point(2.0))]);
        }
        residue(i, kind, &atoms)
    };
    (0..len).map(of).collect()
}

/// The first chain of a file of `structures` in the folder of `ROADMILL_DATA`: its ATOM records up to the first TER or
/// ENDMDL, of several locations the first. `None`, said aloud, without the folder.
pub fn read(name: &str) -> Option<Vec<Residue>> {
    let folder =
        std::env::var_os("ROADMILL_DATA").map(|data| PathBuf::from(data).join("structures"));
    let Some(folder) = folder.filter(|folder| folder.is_dir()) else {
        let required = std::env::var_os("ROADMILL_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "ROADMILL_DATA names no folder with `structures` in it");
        println!("skipped: ROADMILL_DATA names no folder with `structures` in it");
        return None;
    };
    let text = std::fs::read_to_string(folder.join(name)).expect("it is among the structures");
    let mut residues: Vec<Residue> = Vec::new();
    let is_end = |line: &&str| line.starts_with("TER") || line.starts_with("ENDMDL");
    for line in text.lines().take_while(|line| !is_end(line)) {
        if !line.starts_with("ATOM") || !matches!(line.as_bytes()[16], b' ' | b'A') {
            continue;
        }
        let number = line[22..26].trim().parse().expect("a number");
        let code = line[17..20].trim();
        if residues.last().is_none_or(|residue| residue.number.number != number) {
            let kind = AminoAcid::of_code(code).expect("an amino acid");
            let mut next = self::residue(0, kind, &[]);
            next.number.number = number;
            residues.push(next);
        }
        let number = |from: usize| line[from..from + 8].trim().parse::<f64>().expect("a number");
        let name = line[12..16].trim();
        residues.last_mut().expect("just pushed").atoms.push(Atom {
            name: name.to_string(),
            element: name.trim_start_matches(|c: char| c.is_ascii_digit())[..1].to_string(),
            position: Point::new(number(30), number(38), number(46)),
        });
    }
    Some(residues)
}
