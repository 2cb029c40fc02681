//! Torsions of real structures: measured from coordinates, they give the coordinates back, and so do any others.
//!
//! The structures are not part of the repository. They are looked for in the folder that `ROADMILL_DATA` names; with
//! `ROADMILL_REQUIRE_DATA=1` their absence is a failure.

#[path = "support/pdb.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod pdb;

use roadmill::math;
use roadmill::model::protein::kinematics::Conformer;
use roadmill::model::protein::linkage::{Linkage, Torsion, TorsionKind};
use roadmill::model::protein::placed::{Placed, Site};
use roadmill::numbers::Ordinal;
use roadmill::seed::{Purpose, Seed};
use roadmill::structure::{Point, Residue, read};

/// Files that are no structures, and chains of which no torsion turns, with the reason.
const NOT_TESTED: &[(&str, &str)] = &[
    ("1STP_ligand.pdbqt", "no structure: a ligand"),
    ("3PTB_BEN.sdf", "no structure: a ligand"),
    ("ALA_DIPEPTIDE.pdb", "no torsion turns: one amino acid between caps"),
];

/// The most that an atom may be off, Å.
const OFF_MAX: f64 = 1e-6;
/// The most that a torsion may be off, radians.
const TURN_MAX: f64 = 1e-9;

/// N, CA and C of every residue, Å.
type Backbone = Vec<[Point; 3]>;

fn backbone_of(residues: &[Residue]) -> Option<Backbone> {
    let of = |residue: &Residue| {
        let [n, ca, c] = ["N", "CA", "C"].map(|name| residue.position(name));
        residue.position("O").and(Some([n?, ca?, c?]))
    };
    residues.iter().map(of).collect()
}

fn backbone_placed(placed: &Placed) -> Backbone {
    (0..placed.len())
        .map(|i| [placed.at(Site::N, i), placed.at(Site::CA, i), placed.at(Site::C, i)])
        .collect()
}

/// The torsion of four points, radians: the angle between the outer bonds as seen along the middle one. This is another
/// formula than the library's, which takes the normals of two planes.
fn torsion(a: &Point, b: &Point, c: &Point, d: &Point) -> f64 {
    let axis = (c - b).normalize();
    let across = |bond: Point| bond - axis * axis.dot(&bond);
    let (back, forth) = (across(a - b), across(d - c));
    math::atan2(back.cross(&forth).dot(&axis), back.dot(&forth))
}

/// Every torsion of a linkage, measured from positions, radians.
fn measured(linkage: &Linkage, backbone: &Backbone) -> Vec<f64> {
    let of = |Torsion { residue, kind, .. }: &Torsion| {
        let [n, ca, c] = &backbone[*residue];
        match kind {
            TorsionKind::Phi => torsion(&backbone[residue - 1][2], n, ca, c),
            TorsionKind::Psi => torsion(n, ca, c, &backbone[residue + 1][0]),
        }
    };
    linkage.torsions.iter().map(of).collect()
}

/// The greatest of some numbers, at least 0; what is no number counts as the greatest.
fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| if number <= most { most } else { number })
}

/// The greatest turn between torsions of two conformations, radians.
fn turned(a: &[f64], b: &[f64]) -> f64 {
    greatest(a.iter().zip(b).map(|(a, b)| math::angle_between(*a, *b)))
}

/// What came of a chain.
struct Off {
    /// By how far the fast kinematics and the linkage's motions miss the source's atoms at its measured torsions, Å.
    rebuilt: [f64; 2],
    /// By how far other torsions are missed when they are measured from what each of the two makes of them, radians.
    turned: [f64; 2],
}

/// Takes a chain apart and puts it together.
fn off(name: &str, residues: &[Residue], backbone: &Backbone) -> Option<Off> {
    let linkage = Linkage::of(residues).filter(|linkage| !linkage.torsions.is_empty())?;
    let conformer = Conformer::of(residues, &linkage).expect("a whole chain");
    let mut placed = conformer.placed();

    let q = measured(&linkage, backbone);
    assert!(turned(&q, &linkage.source()) < TURN_MAX, "{name}: the linkage has other torsions");
    conformer.place(&q, &mut placed);
    let atoms = conformer.atoms().iter().enumerate();
    let fast = greatest(atoms.flat_map(|(i, atoms)| {
        let pairs = [
            (Some(atoms.n), placed.at(Site::N, i)),
            (Some(atoms.ca), placed.at(Site::CA, i)),
            (Some(atoms.c), placed.at(Site::C, i)),
            (Some(atoms.o), placed.at(Site::O, i)),
            (atoms.cb, placed.at(Site::CB, i)),
            (atoms.centroid, placed.at(Site::Centroid, i)),
            (atoms.hydrogen, placed.at(Site::H, i)),
        ];
        pairs.into_iter().filter_map(|(source, at)| Some((at - source?).norm()))
    }));
    // All atoms of the file, hydrogens too.
    let motions = linkage.motions(&q);
    let atoms = residues.iter().enumerate();
    let atoms = atoms.flat_map(|(i, residue)| residue.atoms.iter().map(move |atom| (i, atom)));
    let plain = greatest(atoms.map(|(i, atom)| {
        let at = motions[linkage.body(i, &atom.name)].apply(&atom.position);
        (at - atom.position).norm()
    }));

    let mut stream = Seed::of_set(1, name, Ordinal(0)).stream(Purpose::Sampling);
    let mut turns = [0.0f64; 2];
    for width in [0.05, 0.5, 5.0] {
        let turn = |value: &f64| math::wrap_angle(value + width * stream.normal());
        let q: Vec<f64> = q.iter().map(turn).collect();
        conformer.place(&q, &mut placed);
        let motions = linkage.motions(&q);
        let moved = backbone.iter().enumerate().map(|(i, atoms)| {
            let at = |k: usize| motions[linkage.body(i, ["N", "CA", "C"][k])].apply(&atoms[k]);
            [at(0), at(1), at(2)]
        });
        for (most, atoms) in turns.iter_mut().zip([backbone_placed(&placed), moved.collect()]) {
            let off = turned(&measured(&linkage, &atoms), &q);
            *most = greatest([*most, off].into_iter());
        }
    }
    Some(Off { rebuilt: [fast, plain], turned: turns })
}

#[test]
fn every_structure_comes_back_from_its_torsions() {
    let Some(data) = pdb::data() else { return };
    let entries = std::fs::read_dir(data.join("structures")).expect("a folder");
    let name = |entry: std::io::Result<std::fs::DirEntry>| {
        entry.expect("an entry").file_name().into_string().expect("a name in UTF-8")
    };
    let mut names: Vec<String> = entries.map(name).collect();
    names.sort();
    let mut skipped = Vec::new();
    let (mut chains, mut rebuilt, mut turned) = (0, [0.0f64; 2], [0.0f64; 2]);
    for name in names {
        let Ok(structure) = read(data.join("structures").join(&name)) else {
            skipped.push(name);
            continue;
        };
        for model in &structure.models {
            for chain in model.chains.iter().filter(|chain| !chain.residues.is_empty()) {
                let label = format!("{name} model {} chain `{}`", model.number, chain.name);
                let backbone = backbone_of(&chain.residues)
                    .unwrap_or_else(|| panic!("{label}: an incomplete backbone"));
                let Some(off) = off(&label, &chain.residues, &backbone) else {
                    skipped.push(name.clone());
                    continue;
                };
                assert!(off.rebuilt.iter().all(|off| *off < OFF_MAX), "{label}: {:?}", off.rebuilt);
                assert!(off.turned.iter().all(|off| *off < TURN_MAX), "{label}: {:?}", off.turned);
                for k in 0..2 {
                    rebuilt[k] = rebuilt[k].max(off.rebuilt[k]);
                    turned[k] = turned[k].max(off.turned[k]);
                }
                chains += 1;
            }
        }
    }
    println!("{chains} chains; most off: {rebuilt:?} Å, {turned:?} radians");
    let expected: Vec<&str> = NOT_TESTED.iter().map(|(name, _)| *name).collect();
    assert_eq!(skipped, expected, "what is no chain with torsions that turn");
    // 38 models of one chain, and the chains of the other files.
    assert_eq!(chains, 38 + 18);
}

/// Chains with a gap: what follows a gap moves as one with what is before it, and comes back likewise.
#[test]
fn broken_chains_come_back_from_their_torsions() {
    let Some(data) = pdb::data() else { return };
    for name in ["1CFD", "1PGA", "4AKE"] {
        let mut residues = pdb::chain(&data, name, 'A');
        residues.drain(30..34);
        residues.drain(12..13);
        let backbone = backbone_of(&residues).expect("a whole backbone");
        let linkage = Linkage::of(&residues).expect("a whole backbone");
        assert_eq!(linkage.gaps, [11, 28], "{name}");
        let off = off(name, &residues, &backbone).expect("torsions that turn");
        assert!(off.rebuilt.iter().all(|off| *off < OFF_MAX), "{name}: {:?}", off.rebuilt);
        assert!(off.turned.iter().all(|off| *off < TURN_MAX), "{name}: {:?}", off.turned);
    }
}
