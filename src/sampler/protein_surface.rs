use super::{GaveUp, Sampler, collect, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{LigandAtProtein, Scratch};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use crate::structure::Point;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// A ligand placed at the surface of a protein by geometry alone (O. B. Bayazit, PhD thesis, 2003, chapter V D 1 and Figure 22): the
/// protein's atoms are cubes, those of the ligand's base balls; the base is put where it touches no cube, close to one; torsions
/// are random; what has an energy above the highest that is valid is dropped.
///
/// The base is the ligand's root piece. As in obstacle-based sampling it starts at a random atom of the protein, with a random
/// orientation, and moves in a random direction until it is free; the last step is then halved. The thesis gives cubes of 1 Å, balls
/// with a radius of 1 Å and a highest energy of 5000 kJ/mol; how the base comes to be close to atoms, it does not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct ProteinSurface {
    /// The edge of the cube that an atom of the protein is, Å.
    pub cube: f64,
    /// The radius of the ball that an atom of the ligand is, Å.
    pub ball: f64,
    /// The step by which the base moves, Å.
    pub step: f64,
    /// How often the last step is halved.
    pub halvings: u32,
    /// The most placements tried for one milestone.
    pub attempts: u64,
}

impl Default for ProteinSurface {
    fn default() -> ProteinSurface {
        let attempts = default_attempts();
        ProteinSurface { cube: 1.0, ball: 1.0, step: 0.5, halvings: 4, attempts }
    }
}

/// The most steps of a base: from within the largest protein it comes out.
const STEPS_MAX: u32 = 10_000;
/// The largest cube, ball and step, Å: several times what an atom is.
const LENGTH_MAX: f64 = 100.0;
/// The most often that a step is halved.
const HALVINGS_MAX: u32 = 30;

impl ProteinSurface {
    /// Puts the base at the surface, and everything else at random; whether that is within the bounds.
    fn place(
        &self,
        cx: &Context,
        ligand: &dyn LigandAtProtein,
        stream: &mut Stream,
        q: &mut [f64],
    ) -> bool {
        cx.space.sample_uniform(stream, q);
        let atoms = ligand.protein();
        let start = atoms[stream.below(atoms.len() as u64) as usize];
        let direction = [0; 3].map(|_| stream.normal());
        let direction =
            Point::from(direction) / Point::from(direction).norm().max(f64::MIN_POSITIVE);
        // Where the atoms of the base are, from its centre.
        let positions = ligand.positions(q);
        let centre = Point::new(q[0], q[1], q[2]);
        let base: Vec<Point> =
            ligand.pieces()[0].iter().map(|atom| positions[*atom] - centre).collect();
        let is_free = |way: f64| {
            let place = start + direction * way;
            !base.iter().any(|atom| self.touches(ligand, &(place + atom)))
        };
        let Some(steps) = (1..=STEPS_MAX).find(|step| is_free(f64::from(*step) * self.step)) else {
            return false;
        };
        let (mut touching, mut free) =
            (f64::from(steps - 1) * self.step, f64::from(steps) * self.step);
        for _ in 0..self.halvings {
            let middle = (touching + free) / 2.0;
            if is_free(middle) { free = middle } else { touching = middle }
        }
        let place = start + direction * free;
        q[..3].copy_from_slice(place.as_slice());
        cx.space.within_bounds(q)
    }

    /// Whether a ball at a place touches the cube of an atom of the protein.
    fn touches(&self, ligand: &dyn LigandAtProtein, at: &Point) -> bool {
        let half = self.cube / 2.0;
        let mut touches = false;
        // The farthest point of a cube is at its corner.
        ligand.atoms_near(at, self.ball + half * 3f64.sqrt(), &mut |atom| {
            let beyond = (at - atom).map(|along| (along.abs() - half).max(0.0));
            touches |= beyond.norm_squared() < self.ball * self.ball;
        });
        touches
    }
}

impl Sampler for ProteinSurface {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let Some(ligand) = cx.model.ligand() else {
            return Err(GaveUp { attempts: 0 });
        };
        collect(count, self.attempts, out, |q| {
            self.place(cx, ligand, &mut stream, q) && cx.model.is_valid(q, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        let lengths = [("cube", self.cube), ("ball", self.ball), ("step", self.step)];
        let is_wrong =
            |(key, length): &(&'static str, f64)| Complaint::of_length(key, *length, LENGTH_MAX);
        if let Some(complaint) = lengths.iter().find_map(is_wrong) {
            return Some(complaint);
        }
        if self.halvings > HALVINGS_MAX {
            return Some(Complaint::new("halvings", self.halvings, "0 to 30"));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        super::at_a_protein(cx)
    }
}
