//! The atoms that a refit looks at, as the linkage carries them, and where a configuration puts them.

use crate::model::protein::atoms::ResidueAtoms;
use crate::model::protein::linkage::{Carried, Linkage, Motion};
use crate::structure::Point;

/// What a site is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// N.
    Nitrogen,
    /// CA.
    AlphaCarbon,
    /// C.
    Carbon,
    /// O.
    Oxygen,
    /// CB.
    BetaCarbon,
    /// The centroid of the side chain's heavy atoms, which stands for the side chain.
    SideChain,
    /// The hydrogen at N, placed ideally.
    Hydrogen,
}

/// The kinds that are fitted, which every residue has.
pub const FITTED: [Kind; 4] = [Kind::Nitrogen, Kind::AlphaCarbon, Kind::Carbon, Kind::Oxygen];

/// All kinds, in their order.
const KINDS: [Kind; 7] = [
    Kind::Nitrogen,
    Kind::AlphaCarbon,
    Kind::Carbon,
    Kind::Oxygen,
    Kind::BetaCarbon,
    Kind::SideChain,
    Kind::Hydrogen,
];

impl Kind {
    /// Its name, in files if it is an atom.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Nitrogen => "N",
            Kind::AlphaCarbon => "CA",
            Kind::Carbon => "C",
            Kind::Oxygen => "O",
            Kind::BetaCarbon => "CB",
            Kind::SideChain => "side chain",
            Kind::Hydrogen => "H",
        }
    }

    /// Where a residue has it, in Å.
    pub fn of(self, atoms: &ResidueAtoms) -> Option<Point> {
        match self {
            Kind::Nitrogen => Some(atoms.n),
            Kind::AlphaCarbon => Some(atoms.ca),
            Kind::Carbon => Some(atoms.c),
            Kind::Oxygen => Some(atoms.o),
            Kind::BetaCarbon => atoms.cb,
            Kind::SideChain => atoms.centroid,
            Kind::Hydrogen => atoms.hydrogen,
        }
    }
}

/// An atom, or a centroid, of the linkage.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// The residue, counted from 0 along the chain.
    pub residue: usize,
    /// What it is.
    pub kind: Kind,
    /// Where it is in the source, and what carries it.
    pub carried: Carried,
}

/// The sites of a chain, residue after residue, within a residue in the order of [`Kind`].
#[derive(Clone, Debug)]
pub struct Sites {
    /// The sites.
    pub sites: Vec<Site>,
    numbers: Vec<[Option<usize>; KINDS.len()]>,
}

impl Sites {
    /// The sites of the chain that a linkage is made of.
    pub fn of(residues: &[ResidueAtoms], linkage: &Linkage) -> Sites {
        let mut sites = Vec::new();
        let mut numbers = Vec::with_capacity(residues.len());
        for (residue, atoms) in residues.iter().enumerate() {
            let mut of_residue = [None; KINDS.len()];
            for (kind, number) in KINDS.iter().zip(&mut of_residue) {
                let Some(position) = kind.of(atoms) else { continue };
                *number = Some(sites.len());
                let body = linkage.body(residue, kind.name());
                sites.push(Site { residue, kind: *kind, carried: Carried { position, body } });
            }
            numbers.push(of_residue);
        }
        Sites { sites, numbers }
    }

    /// How many residues there are.
    pub fn residues(&self) -> usize {
        self.numbers.len()
    }

    /// The number of the site of this kind in a residue.
    pub fn number(&self, residue: usize, kind: Kind) -> Option<usize> {
        self.numbers.get(residue)?[kind as usize]
    }

    /// The body that carries a site.
    pub fn body(&self, number: usize) -> usize {
        self.sites[number].carried.body
    }

    /// Where the sites are in the source.
    pub fn source(&self) -> Vec<Point> {
        self.sites.iter().map(|site| site.carried.position).collect()
    }

    /// Where the sites are, given the motions of the bodies.
    pub fn place(&self, motions: &[Motion]) -> Vec<Point> {
        let place = |site: &Site| motions[site.carried.body].apply(&site.carried.position);
        self.sites.iter().map(place).collect()
    }

    /// The positions of one kind, residue after residue.
    pub fn of_kind(&self, kind: Kind, positions: &[Point]) -> Vec<Point> {
        self.numbers.iter().filter_map(|numbers| Some(positions[numbers[kind as usize]?])).collect()
    }
}
