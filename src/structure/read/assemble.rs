//! From the atoms of a file to residues and chains.

use super::super::{
    Alternative, Atom, Chain, ModelCounts, Residue, ResidueNumber, StructureError, StructureModel,
};
use super::alternatives::{chosen, letters, restore_letters};
use super::names::{self, Parents};
use super::overlaps::{Placed, expect_apart};
use super::site::{RawModel, Site};
use crate::structure::peptides::PEPTIDE_BOND_MAX;
use std::collections::{BTreeMap, BTreeSet};

/// The most atoms of an amino acid. Larger residues, such as sheets of carbon, are taken as they are, without a search for
/// alternatives and parts that stand elsewhere, which compares each atom with all others.
const RESIDUE_MAX: usize = 1000;

/// A model made of a file's atoms.
pub(super) struct Assembled {
    pub model: StructureModel,
    pub counts: ModelCounts,
    pub alternatives: Vec<Alternative>,
    /// How many atoms of amino acids stood there twice and were taken once.
    pub repeated: usize,
}

/// Makes residues and chains of the atoms of a model.
pub(super) fn assemble(raw: &mut RawModel, parents: &Parents) -> Result<Assembled, StructureError> {
    for residue in raw.sites.chunk_by_mut(is_same_residue) {
        let has_partial = |site: &Site| site.letter.is_none() && site.occupancy < 1.0;
        if residue.iter().any(has_partial) && residue.len() <= RESIDUE_MAX {
            restore_letters(residue);
        }
    }
    let groups = groups(&raw.sites);
    let counts = ModelCounts {
        atoms: raw.sites.len(),
        residues: groups.iter().map(|group| group.names).sum(),
    };
    let (mut alternatives, mut repeated) = (Vec::new(), 0);
    let mut drafts = Vec::with_capacity(groups.len());
    for group in &groups {
        let sites = || group.sites.iter().map(|index| &raw.sites[*index]);
        let is_small = group.sites.len() <= RESIDUE_MAX;
        let letters = if is_small { letters(sites()) } else { Vec::new() };
        let letter = chosen(&letters);
        let taken: Vec<&Site> = sites()
            .filter(|site| letter.is_none() || site.letter.is_none() || site.letter == letter)
            .collect();
        let draft = Draft::of(&taken, parents, &mut repeated)?;
        if let Some(chosen) = letter {
            alternatives.push(Alternative {
                model: raw.number,
                chain: taken[0].chain.clone(),
                number: draft.residue.number,
                name: draft.residue.name.clone(),
                letters,
                chosen,
            });
        }
        drafts.push(draft);
    }
    expect_apart(&drafts.iter().flat_map(Draft::placed).collect::<Vec<_>>())?;
    let is_in_polymer: Vec<bool> =
        (0..drafts.len()).map(|place| is_in_polymer(&drafts, place)).collect();
    let chains = chains(drafts, &is_in_polymer);
    let model = StructureModel { number: raw.number, chains };
    Ok(Assembled { model, counts, alternatives, repeated })
}

/// Atoms of the file that are one residue, or alternatives of one.
struct Group {
    sites: Vec<usize>,
    /// How many names of residues they have.
    names: usize,
}

/// Groups atoms that follow one another with one chain and number, and one name or alternatives of it. What stands
/// elsewhere, as some programs list alternatives and hydrogens, goes to the residue of its name and number if that has
/// none of these atoms; else it is another one, as are molecules of water whose numbers begin anew.
fn groups(sites: &[Site]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut by_name: BTreeMap<(&str, ResidueNumber, &str), usize> = BTreeMap::new();
    let mut begin = 0;
    for run in sites.chunk_by(is_same_residue) {
        let indices = begin..begin + run.len();
        begin += run.len();
        let first = &run[0];
        let key = |name| (first.chain.as_str(), first.number, name);
        let names: BTreeSet<&str> = run.iter().map(|site| site.residue.as_str()).collect();
        if let Some(earlier) = by_name.get(&key(first.residue.as_str())) {
            let earlier = &mut groups[*earlier].sites;
            let is_same =
                |one: &Site, other: &Site| one.name == other.name && one.letter == other.letter;
            let has = |site: &Site| earlier.iter().any(|index| is_same(site, &sites[*index]));
            if earlier.len() + run.len() <= RESIDUE_MAX && !run.iter().any(has) {
                earlier.extend(indices);
                continue;
            }
        }
        for name in &names {
            by_name.insert(key(name), groups.len());
        }
        groups.push(Group { sites: indices.collect(), names: names.len() });
    }
    groups
}

fn is_same_residue(one: &Site, other: &Site) -> bool {
    one.number == other.number
        && one.chain == other.chain
        && (one.residue == other.residue || one.letter.is_some() && other.letter.is_some())
}

/// A residue, not yet in a chain.
struct Draft {
    chain: String,
    residue: Residue,
    /// The line of each of the residue's atoms.
    lines: Vec<usize>,
    is_hetero: bool,
    in_polymer: Option<bool>,
}

impl Draft {
    /// The residue of the atoms of one conformer. Counts the atoms that it has twice.
    fn of(
        sites: &[&Site],
        parents: &Parents,
        repeated: &mut usize,
    ) -> Result<Draft, StructureError> {
        let first = sites[0];
        // Atoms without a letter may bear another name only by a mistake of the file.
        let name =
            sites.iter().find(|site| site.letter.is_some()).unwrap_or(&first).residue.clone();
        let amino_acid = names::amino_acid(&name, parents);
        if amino_acid.is_some() && sites.len() > RESIDUE_MAX {
            let message = format!("{first}: more than {RESIDUE_MAX} atoms of one amino acid found");
            let message = format!("{message}; at most that many expected");
            return Err(StructureError::line(first.line, message));
        }
        let mut lines: Vec<usize> = Vec::with_capacity(sites.len());
        let mut atoms: Vec<Atom> = Vec::with_capacity(sites.len());
        for site in sites {
            let atom = Atom {
                name: site.name.clone(),
                element: site.element.clone(),
                position: site.position,
            };
            let same = atoms.iter().position(|other| other.name == atom.name);
            if let (Some(same), Some(_)) = (same, amino_acid) {
                // Hydrogens may have lost a letter of their names; what stands twice at one place is one atom.
                if !atom.is_heavy() || atom.position == atoms[same].position {
                    *repeated += 1;
                    continue;
                }
                let message = format!(
                    "{site} found again after line {}; each atom of a residue once, or its alternatives with letters, \
                     expected",
                    lines[same]
                );
                return Err(StructureError::line(site.line, message));
            }
            atoms.push(atom);
            lines.push(site.line);
        }
        if let Some(amino_acid) = amino_acid {
            names::normalise(amino_acid, &mut atoms);
        }
        Ok(Draft {
            chain: first.chain.clone(),
            residue: Residue { number: first.number, name, amino_acid, atoms },
            lines,
            is_hetero: sites.iter().all(|site| site.is_hetero),
            in_polymer: first.in_polymer,
        })
    }

    /// The heavy atoms of an amino acid.
    fn placed(&self) -> impl Iterator<Item = Placed> {
        let heavy = self.residue.atoms.iter().zip(&self.lines).filter(|(atom, _)| atom.is_heavy());
        let heavy = heavy.filter(|_| self.residue.amino_acid.is_some());
        heavy.map(|(atom, line)| Placed {
            position: atom.position,
            line: *line,
            name: format!("atom {} of {} in chain `{}`", atom.name, self.residue, self.chain),
        })
    }
}

/// Whether a residue is one of a chain's amino acids.
///
/// It is where the file says so: by `label_seq_id`, by a record ATOM, or before the TER of its chain. A HETATM of a
/// chain that does not say where it ends is where a peptide bond joins it to the residue before or after it.
fn is_in_polymer(drafts: &[Draft], place: usize) -> bool {
    let draft = &drafts[place];
    if draft.residue.amino_acid.is_none() {
        return false;
    }
    match draft.in_polymer {
        Some(said) => said || !draft.is_hetero,
        None if !draft.is_hetero => true,
        None => {
            let is_joined = |from: &Draft, to: &Draft| {
                let ends = (from.residue.position("C"), to.residue.position("N"));
                let (Some(c), Some(n)) = ends else { return false };
                from.chain == to.chain && (n - c).norm() <= PEPTIDE_BOND_MAX
            };
            let before = place.checked_sub(1).map(|before| &drafts[before]);
            before.is_some_and(|before| is_joined(before, draft))
                || drafts.get(place + 1).is_some_and(|after| is_joined(draft, after))
        }
    }
}

/// Puts residues into chains by the names of these. A chain begins anew where a number of its amino acids comes again:
/// programs without names for chains leave all of them blank.
fn chains(drafts: Vec<Draft>, is_in_polymer: &[bool]) -> Vec<Chain> {
    let mut chains: Vec<Chain> = Vec::new();
    let mut latest: BTreeMap<String, usize> = BTreeMap::new();
    let mut numbers: BTreeSet<(usize, ResidueNumber)> = BTreeSet::new();
    for (draft, is_in_polymer) in drafts.into_iter().zip(is_in_polymer) {
        let number = draft.residue.number;
        let known = latest.get(&draft.chain).copied();
        let place = match known {
            Some(place) if !(*is_in_polymer && numbers.contains(&(place, number))) => place,
            _ => {
                chains.push(Chain {
                    name: draft.chain.clone(),
                    residues: Vec::new(),
                    others: Vec::new(),
                });
                latest.insert(draft.chain, chains.len() - 1);
                chains.len() - 1
            }
        };
        if *is_in_polymer {
            numbers.insert((place, number));
            chains[place].residues.push(draft.residue);
        } else {
            chains[place].others.push(draft.residue);
        }
    }
    chains
}
