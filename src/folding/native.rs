//! The native structure, and the parts of it whose formation is followed.

use crate::model::{Model, Scratch};
use crate::structure::Point;
use crate::structure::measure::{APART, CA_REACH, Element, ThreeStates, contacts_of_points};

/// A pairing has at least so many contacts: two elements that touch at one place only are none.
const PAIRING_LEAST: usize = 3;

/// A native conformation with its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Native {
    /// Its configuration.
    pub q: Vec<f64>,
    /// Its contacts: pairs of residues by their indices, ascending.
    pub contacts: Vec<(usize, usize)>,
    /// Its parts: first the elements of secondary structure that have contacts, in their order along the chain, then the pairings.
    pub parts: Vec<Part>,
}

/// A part of a native structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The element's name, as `β1`, or for a pairing those of its two elements, as `β1–β2`.
    pub name: String,
    /// Whether it is a pairing of two elements.
    pub is_pairing: bool,
    /// The contacts that make it, by their indices in [`Native::contacts`].
    pub contacts: Vec<u32>,
}

impl Native {
    /// The native conformation of a model; `None` for a model that has none, or no Cα.
    ///
    /// A helix is made of the contacts within it; a strand, within which there are none, of those with all other strands; a pairing
    /// of those between two elements, of which there are at least three. Contacts of loops belong to no part.
    pub fn of(model: &dyn Model, scratch: &mut Scratch) -> Option<Native> {
        let q = model.native()?;
        let alphas = model.shape(q, scratch)?;
        let contacts = contacts_of_points(&alphas, CA_REACH, APART);
        let parts = parts(model.elements(), &contacts);
        Some(Native { q: q.to_vec(), contacts, parts })
    }

    /// How many of the parts are elements; the others are pairings.
    pub fn elements(&self) -> usize {
        self.parts.iter().filter(|part| !part.is_pairing).count()
    }

    /// Which contacts a conformation with Cα at `alphas` has.
    pub(super) fn kept(&self, alphas: &[Point]) -> impl Iterator<Item = bool> {
        self.contacts.iter().map(|(a, b)| (alphas[*a] - alphas[*b]).norm() <= CA_REACH)
    }
}

fn parts(elements: &[Element], contacts: &[(usize, usize)]) -> Vec<Part> {
    let element_of =
        |residue: &usize| elements.iter().position(|element| element.residues.contains(residue));
    let ends: Vec<_> = contacts.iter().map(|(a, b)| (element_of(a), element_of(b))).collect();
    let where_ends = |is_of: &dyn Fn(usize, usize) -> bool| -> Vec<u32> {
        let both = ends.iter().enumerate().filter_map(|(at, (a, b))| Some((at, (*a)?, (*b)?)));
        both.filter(|(_, a, b)| is_of(*a, *b)).map(|(at, ..)| at as u32).collect()
    };
    let is_strand = |at: usize| elements[at].kind == ThreeStates::Strand;
    let mut parts = Vec::new();
    for (at, element) in elements.iter().enumerate() {
        let contacts = match is_strand(at) {
            false => where_ends(&|a, b| (a, b) == (at, at)),
            true => {
                where_ends(&|a, b| a != b && (a == at && is_strand(b) || b == at && is_strand(a)))
            }
        };
        if !contacts.is_empty() {
            parts.push(Part { name: element.name.clone(), is_pairing: false, contacts });
        }
    }
    for (b, second) in elements.iter().enumerate() {
        for (a, first) in elements[..b].iter().enumerate() {
            let contacts = where_ends(&|one, other| (one, other) == (a, b));
            if contacts.len() >= PAIRING_LEAST {
                let name = format!("{}–{}", first.name, second.name);
                parts.push(Part { name, is_pairing: true, contacts });
            }
        }
    }
    parts
}
