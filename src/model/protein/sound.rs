//! What makes a protein's description sound, whether it comes from files or from bytes.

use super::linkage::Linkage;
use super::{Gaps, Protein};
use crate::structure::Residue;

/// The longest chain.
const RESIDUES_MAX: usize = 20_000;
/// The most atoms of a residue.
const ATOMS_MAX: usize = 200;
/// The largest coordinate, Å: that of the PDB format.
pub(super) const COORDINATE_MAX: f64 = 1e6;
/// The finest step of motions, radians.
const STEP_MIN: f64 = 1e-4;
/// The coarsest.
const STEP_MAX: f64 = 100.0;

impl Protein {
    /// What is wrong with the description, if anything: the key of the table by which a problem file says it, what was
    /// found and what is expected.
    pub(super) fn complaint(&self) -> Option<(&'static str, String)> {
        let Protein { source, target, gaps, obstacles, rules, energy, highest, step } = self;
        if let Some(message) = complaint_of_chain(source) {
            return Some(("source", message));
        }
        let Some(linkage) = Linkage::of(source) else {
            let message = "a residue without N, CA, C or with two of them in one place found; a backbone expected";
            return Some(("source", message.to_owned()));
        };
        if linkage.torsions.is_empty() {
            return Some((
                "source",
                "no torsion that turns found; at least one expected".to_owned(),
            ));
        }
        if let (Gaps::Error, Some(gap)) = (gaps, linkage.gaps.first()) {
            let (before, after) = (&source[*gap], &source[gap + 1]);
            let message = format!(
                "a gap between {before} and {after} found; an unbroken chain, or gaps = \"rigid\", expected"
            );
            return Some(("source", message));
        }
        if let Some(target) = target {
            if let Some(message) = complaint_of_chain(&target.residues) {
                return Some(("target", message));
            }
            let ends = [source.len(), target.residues.len()];
            let is_within = |pair: &[u32; 2]| (0..2).all(|side| (pair[side] as usize) < ends[side]);
            let ascends = |two: &[[u32; 2]]| (0..2).all(|side| two[0][side] < two[1][side]);
            if !target.matches.iter().all(is_within) || !target.matches.windows(2).all(ascends) {
                return Some(("target", "residues matched that are not there".to_owned()));
            }
        }
        for (chain, residues) in obstacles.iter().enumerate() {
            if let Some(message) = complaint_of_chain(residues) {
                return Some(("obstacles", format!("chain {chain}: {message}")));
            }
        }
        if let Some(complaint) = rules.complaint() {
            return Some(("rules", complaint.to_string()));
        }
        if let Some(complaint) = energy.complaint() {
            return Some(("energy", complaint.to_string()));
        }
        if let Some(highest) = highest.filter(|highest| !highest.is_finite()) {
            return Some(("highest", format!("{highest} found; a finite energy expected")));
        }
        let is_step = (STEP_MIN..=STEP_MAX).contains(step);
        (!is_step)
            .then(|| ("step", format!("{step} found; {STEP_MIN} to {STEP_MAX} radians expected")))
    }
}

/// What is wrong with the residues of a chain.
fn complaint_of_chain(residues: &[Residue]) -> Option<String> {
    if !(1..=RESIDUES_MAX).contains(&residues.len()) {
        return Some(format!("{} residues found; 1 to {RESIDUES_MAX} expected", residues.len()));
    }
    for residue in residues {
        if !is_name(&residue.name)
            || residue.number.insertion.is_some_and(|c| !c.is_ascii_graphic())
        {
            return Some(format!(
                "the residue {:?} found; a name of letters and digits expected",
                residue.name
            ));
        }
        if residue.atoms.len() > ATOMS_MAX {
            let found = residue.atoms.len();
            return Some(format!("{residue}: {found} atoms found; at most {ATOMS_MAX} expected"));
        }
        for (index, atom) in residue.atoms.iter().enumerate() {
            let is_twice = residue.atoms[..index].iter().any(|other| other.name == atom.name);
            if !is_name(&atom.name) || !is_name(&atom.element) || is_twice {
                let name = &atom.name;
                return Some(format!(
                    "{residue}: the atom {name:?} found; a name that no other atom has expected"
                ));
            }
            // Written so that NaN fails it.
            if !atom.position.iter().all(|value| value.abs() <= COORDINATE_MAX) {
                let (name, at) = (&atom.name, &atom.position);
                return Some(format!(
                    "{residue} {name}: a position {at:?} found; finite coordinates expected"
                ));
            }
        }
    }
    None
}

/// Whether a name can stand in a file.
fn is_name(name: &str) -> bool {
    (1..=16).contains(&name.len()) && name.chars().all(|c| c.is_ascii_graphic())
}
