//! What makes a protein's description sound, whether it comes from files or from bytes.

use super::kinematics::Conformer;
use super::linkage::{Linkage, in_line};
use super::motion::EnergySteps;
use super::{Gaps, Protein, Target, write};
use crate::structure::matching::match_chains;
use crate::structure::{Chain, Residue, backbone, peptides, read_bytes};
use std::path::Path;

/// The longest chain. Some tables of energies and motions have the square of it as their size.
const RESIDUES_MAX: usize = 5_000;
/// The most atoms of a residue.
const ATOMS_MAX: usize = 200;
/// How far an atom is at most from the Cα of its residue, Å.
const FROM_ALPHA_MAX: f64 = 100.0;
/// The largest coordinate, Å: that which the reader of structures takes.
pub(super) const COORDINATE_MAX: f64 = crate::structure::COORDINATE_MAX;
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
        // All that a model is made of: what is sound here is what `ChainInEnergy::of` expects.
        let linkage = Linkage::of(source).filter(|of| Conformer::of(source, of).is_some());
        let Some(linkage) = linkage else {
            let message = "a residue without N, CA, C or O, or with two of them in one place found; a backbone expected";
            return Some(("source", message.to_owned()));
        };
        if let Some(at) = in_line(source) {
            let [before, residue] = [&source[at - 1], &source[at]];
            let message = format!(
                "{residue}: N in a line with CA and the C of {before} found, where phi is not defined; a bond angle expected"
            );
            return Some(("source", message));
        }
        if linkage.torsions.is_empty() {
            return Some((
                "source",
                "no torsion that turns found; at least one expected".to_owned(),
            ));
        }
        if let Some(message) = complaint_of_gaps(source, *gaps) {
            return Some(("source", message));
        }
        if let Some(Target { residues, matches }) = target {
            if let Some(message) =
                complaint_of_chain(residues).or_else(|| complaint_of_gaps(residues, *gaps))
            {
                return Some(("target", message));
            }
            if let Some(residue) =
                residues.iter().find(|residue| backbone::missing_atom(residue).is_some())
            {
                let message = format!("{residue} without N, CA, C or O found; all four expected");
                return Some(("target", message));
            }
            let ends = [source.len(), residues.len()];
            let is_within = |pair: &[u32; 2]| (0..2).all(|side| (pair[side] as usize) < ends[side]);
            let ascends = |two: &[[u32; 2]]| (0..2).all(|side| two[0][side] < two[1][side]);
            if !matches.iter().all(is_within) || !matches.windows(2).all(ascends) {
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
        let (key, radians) = match *step {
            EnergySteps::Length(length) => ("step", length),
            EnergySteps::Turn(turn) => ("turn", turn),
        };
        if !(STEP_MIN..=STEP_MAX).contains(&radians) {
            let message = format!("{radians} found; {STEP_MIN} to {STEP_MAX} radians expected");
            return Some((key, message));
        }
        self.complaint_of_files()
    }

    /// What of the structures would be something else once it was written as files and read again. So residues that came
    /// from bytes are held to all that the reader asks of files: atoms that stand apart, names that are known.
    fn complaint_of_files(&self) -> Option<(&'static str, String)> {
        let chains = std::iter::once(&self.source).chain(&self.obstacles);
        let keys = std::iter::once("source").chain(std::iter::repeat("obstacles"));
        let (text, _) = write::source_file(self);
        let expected: Vec<_> = keys.zip(chains.map(Vec::as_slice)).collect();
        if let Some(complaint) = complaint_of_file("source.cif", &text, &expected) {
            return Some(complaint);
        }
        let Target { residues, matches } = self.target.as_ref()?;
        let (name, text) = ("target.cif", write::target_file(residues));
        if let Some(complaint) = complaint_of_file(name, &text, &[("target", residues)]) {
            return Some(complaint);
        }
        let chain = |residues: &[Residue]| Chain {
            name: String::new(),
            residues: residues.to_vec(),
            others: Vec::new(),
        };
        let matching = match match_chains(&chain(&self.source), &chain(residues)) {
            Ok(matching) => matching,
            Err(error) => return Some(("target", error.to_string())),
        };
        let is_one = |(pair, of): (&[u32; 2], &crate::structure::matching::Pair)| {
            (pair[0] as usize, pair[1] as usize) == (of.first, of.second)
        };
        let are_same = matches.len() == matching.pairs.len()
            && matches.iter().zip(&matching.pairs).all(is_one);
        (!are_same).then(|| {
            let message = "residues matched otherwise than by number or sequence found; a matching of these chains expected";
            ("target", message.to_owned())
        })
    }
}

/// What is wrong with chains that were written to the text of a file, each with the key of its table: the first residue that is
/// not read from there as it is.
fn complaint_of_file(
    name: &str,
    text: &str,
    chains: &[(&'static str, &[Residue])],
) -> Option<(&'static str, String)> {
    let path = Path::new(name);
    let read = match read_bytes(path, text.as_bytes()) {
        Ok(structure) => structure,
        Err(error) => {
            return Some((chains[0].0, format!("as a file: {}", error.in_file(path))));
        }
    };
    let again: Vec<&Chain> = read.models.iter().flat_map(|model| &model.chains).collect();
    for (index, (key, residues)) in chains.iter().enumerate() {
        let found = again.get(index).map_or(&[][..], |chain| &chain.residues);
        let is_same = |at: &usize| found.get(*at) == Some(&residues[*at]);
        if let Some(at) = (0..residues.len()).find(|at| !is_same(at)) {
            let residue = &residues[at];
            let message = format!(
                "{residue} found, which a file cannot hold as it is; names, numbers, elements and atoms as the reader of \
                 structures gives them expected"
            );
            return Some((key, message));
        }
    }
    None
}

/// What is wrong with a chain that is broken, unless it may be.
fn complaint_of_gaps(residues: &[Residue], gaps: Gaps) -> Option<String> {
    let gap = match gaps {
        Gaps::Error => peptides::gaps(residues).into_iter().next()?,
        Gaps::Rigid => return None,
    };
    let [before, after] = [gap.before, gap.before + 1].map(|at| &residues[at]);
    Some(format!(
        "a gap between {before} and {after} found; an unbroken chain, or gaps = \"rigid\", expected"
    ))
}

/// What is wrong with the residues of a chain.
fn complaint_of_chain(residues: &[Residue]) -> Option<String> {
    if residues.is_empty() {
        return Some(format!("no residues found; 1 to {RESIDUES_MAX} expected"));
    }
    if residues.len() > RESIDUES_MAX {
        return Some(format!("{} residues found; 1 to {RESIDUES_MAX} expected", residues.len()));
    }
    for residue in residues {
        if !is_name(&residue.name) {
            let name = &residue.name;
            return Some(format!(
                "the residue {name:?} found; a name of 1 to 16 characters expected"
            ));
        }
        if let Some(insertion) = residue.number.insertion.filter(|c| !c.is_ascii_alphanumeric()) {
            let (name, number) = (&residue.name, residue.number.number);
            return Some(format!(
                "{name} {number}: the insertion code {insertion:?} found; a letter or digit expected"
            ));
        }
        if residue.atoms.len() > ATOMS_MAX {
            let found = residue.atoms.len();
            return Some(format!("{residue}: {found} atoms found; at most {ATOMS_MAX} expected"));
        }
        let alpha = residue.position("CA");
        for (index, atom) in residue.atoms.iter().enumerate() {
            let is_twice = residue.atoms[..index].iter().any(|other| other.name == atom.name);
            if !is_name(&atom.name) || is_twice {
                let name = &atom.name;
                return Some(format!(
                    "{residue}: the atom {name:?} found; a name that no other atom has expected"
                ));
            }
            if !is_name(&atom.element) {
                let (name, element) = (&atom.name, &atom.element);
                return Some(format!(
                    "{residue} {name}: the element {element:?} found; its symbol expected"
                ));
            }
            // Written so that NaN fails it.
            if !atom.position.iter().all(|value| value.abs() <= COORDINATE_MAX) {
                let (name, at) = (&atom.name, &atom.position);
                return Some(format!(
                    "{residue} {name}: a position {at:?} found; coordinates of at most {COORDINATE_MAX} Å expected"
                ));
            }
            if let Some(distance) = alpha.map(|alpha| (atom.position - alpha).norm())
                && distance > FROM_ALPHA_MAX
            {
                let name = &atom.name;
                return Some(format!(
                    "{residue} {name}: {distance:.1} Å from its CA found; at most {FROM_ALPHA_MAX} Å expected"
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
