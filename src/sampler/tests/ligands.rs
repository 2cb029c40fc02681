//! Samplers that place a ligand at a protein, and milestones about given configurations: biotin at streptavidin.

use super::sampler;
use crate::context::Context;
use crate::model::{CellLimits, Scratch};
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::roadmap::Configs;
use crate::seed::Seed;
use crate::structure::Point;
use std::path::Path;

fn context() -> Context {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    let text = "[docking]\nprotein = { file = \"structures/1STP.pdb\" }\n\
                ligand = { file = \"structures/1STP.pdb\", residue = \"BTN\" }\n\
                box = { centre = [11.0, 2.0, -11.0], size = [14.0, 14.0, 14.0] }\n\
                grid = { spacing = 0.75 }\n";
    let problem = Problem::parse(&folder.join("p.toml"), text);
    problem.unwrap_or_else(|error| panic!("{error}")).context()
}

fn sample(cx: &Context, method: &str, ordinal: u64, count: usize) -> Configs {
    let kind = sampler(method);
    kind.method().suits(cx).unwrap();
    let mut configs = Configs::new(cx.space.len());
    let seed = Seed::of_set(1, "ligands", Ordinal(ordinal));
    kind.method().sample(cx, &seed, count, &mut Scratch::new(), &mut configs).unwrap();
    configs
}

/// How far the nearest atom of the protein's cubes is from the surface of the ligand's base, whose balls have a radius of 1 Å: negative where they
/// overlap.
fn gap(cx: &Context, q: &[f64]) -> f64 {
    let ligand = cx.model.ligand().unwrap();
    let positions = ligand.positions(q);
    let to_cube = |at: &Point, atom: &Point| {
        (at - atom).map(|along| (along.abs() - 0.5).max(0.0)).norm() - 1.0
    };
    let of_atom = |number: &usize| {
        let near = ligand.protein().iter().map(|atom| to_cube(&positions[*number], atom));
        near.fold(f64::INFINITY, f64::min)
    };
    ligand.pieces()[0].iter().map(of_atom).fold(f64::INFINITY, f64::min)
}

#[test]
fn bases_lie_at_the_surface() {
    let (cx, scratch) = (context(), &mut Scratch::new());
    let method = "protein-surface = { halvings = 6 }";
    let configs = sample(&cx, method, 0, 60);
    for q in configs.iter() {
        assert!(cx.model.is_valid(q, scratch));
        let gap = gap(&cx, q);
        // The base was moved until it was free, the last step halved six times: 0.5 / 64 Å.
        assert!((0.0..0.01).contains(&gap), "{gap} Å from the surface");
    }
    // Torsions are drawn, too, and orientations.
    let spread =
        |at: usize| configs.iter().any(|q| q[at] < -1.0) && configs.iter().any(|q| q[at] > 1.0);
    assert!((7..12).all(spread));
}

#[test]
fn bases_begin_in_low_cells() {
    let (cx, scratch) = (context(), &mut Scratch::new());
    let ligand = cx.model.ligand().unwrap();
    let configs = sample(&cx, "low-energy-cells = { at_boundary = 1.0 }", 0, 40);
    // The atom of the ring that is nearest to its centre.
    let positions = ligand.ligand().positions().unwrap();
    let base = &ligand.pieces()[0];
    let centre = base.iter().map(|atom| positions[*atom]).sum::<Point>() / base.len() as f64;
    let central = *base
        .iter()
        .min_by(|a, b| {
            let distance = |atom: &usize| (positions[*atom] - centre).norm();
            distance(a).total_cmp(&distance(b))
        })
        .unwrap();
    let cells = ligand.low_cells(central, CellLimits { low: -1.0, high: 0.0 });
    for q in configs.iter() {
        assert!(cx.model.is_valid(q, scratch));
        let at = Point::new(q[0], q[1], q[2]);
        let is_in =
            |cell: &Point| (at - cell).iter().all(|by| by.abs() <= cells.spacing / 2.0 + 1e-9);
        assert!(cells.at_boundary.iter().any(is_in), "{at}");
        for (atom, place) in ligand.positions(q).iter().enumerate() {
            let beside = (0..6).any(|side| {
                let mut near = *place;
                near[side / 2] += if side % 2 == 0 { cells.spacing } else { -cells.spacing };
                ligand.atom_energy(atom, &near) <= 0.0
            });
            assert!(beside || ligand.atom_energy(atom, place) <= 0.0, "atom {atom} at {place}");
        }
    }
}

#[test]
fn given_configurations_come_first_and_then_others_near_them() {
    let cx = context();
    let native = cx.model.native().unwrap().to_vec();
    let mut beside = native.clone();
    beside[0] += 0.1;
    let method = format!("given = {{ configurations = [{native:?}, {beside:?}], radius = 0.2 }}");
    let [first, second] = [0, 1].map(|ordinal| sample(&cx, &method, ordinal, 3));
    // One configuration after the other; sets go on where the sets before them end.
    assert_eq!(first.get(0), &native[..]);
    assert_eq!(first.get(1), &beside[..]);
    let far = |q: &[f64], from: &[f64]| cx.space.distance(q, from);
    for (q, about) in [(first.get(2), &native), (second.get(0), &beside), (second.get(1), &native)]
    {
        let distance = far(q, about);
        assert!(distance > 0.0 && distance <= 0.2 + 1e-9, "{distance}");
    }
}

#[test]
fn others_than_ligands_are_refused() {
    let cx = super::context(super::SCENE);
    for method in ["protein-surface = {}", "low-energy-cells = {}"] {
        assert!(sampler(method).method().suits(&cx).unwrap_err().contains("ligand"));
    }
    let wrong = sampler("given = { configurations = [[1.0, 2.0]] }");
    assert!(wrong.method().suits(&cx).unwrap_err().contains("configurations[0]"));
    for method in [
        "protein-surface = { cube = 0.0 }",
        "protein-surface = { halvings = 31 }",
        "low-energy-cells = { at_boundary = 1.5 }",
        "low-energy-cells = { angles = 0 }",
        "low-energy-cells = { low = inf }",
        "given = { configurations = [] }",
        "given = { configurations = [[1.0]], radius = -1.0 }",
    ] {
        assert!(sampler(method).method().complaint().is_some(), "{method}");
    }
}
