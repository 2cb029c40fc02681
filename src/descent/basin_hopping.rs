use super::{Descent, Gradient};
use crate::context::Context;
use crate::math;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::scene::LENGTH_MAX;
use crate::seed::Stream;
use crate::space::{Factor, FactorKind};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// From minimum to minimum: a random change of one part of the configuration, a descent by the gradient, and the new minimum is kept
/// if it is lower, or by chance, exp(−ΔE/kT), if it is higher; what is found in the end is the lowest of all (Monte Carlo with
/// minimisation: Z. Li, H. A. Scheraga, PNAS 84 (1987) 6611-6615; as basin hopping D. J. Wales, J. P. K. Doye, J. Phys. Chem. A 101 (1997)
/// 5111-5116). AutoDock Vina searches like that (O. Trott, A. J. Olson, J. Comput. Chem. 31 (2010) 455-461), which also has the three
/// kinds of changes: the position by up to `step`, the orientation by so much that it counts as much, or one other angle to any.
///
/// The theses end at the minimum below a node, which is [`Gradient`]; with many torsions hardly any of these minima is a low one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct BasinHopping {
    /// How many changes are made.
    pub hops: u32,
    /// The largest change of a position, and of an orientation, in the metric of the space.
    pub step: f64,
    /// kT, in the unit of the energy.
    pub kt: f64,
    /// The descent after each change.
    pub descent: Gradient,
}

impl Default for BasinHopping {
    fn default() -> BasinHopping {
        BasinHopping { hops: 50, step: 2.0, kt: 5.0, descent: Gradient::default() }
    }
}

impl BasinHopping {
    /// Changes one part of a configuration, drawn uniformly: the position of the base, or one of the other factors.
    fn change(&self, cx: &Context, stream: &mut Stream, q: &mut [f64]) {
        let factors = cx.space.factors();
        let translations = cx.space.translations();
        let others = &factors[translations..];
        let parts = others.len() + usize::from(translations > 0);
        let part = stream.below(parts.max(1) as u64) as usize;
        let changed: &[Factor] = match others.get(part) {
            Some(factor) => std::slice::from_ref(factor),
            None => &factors[..translations],
        };
        let mut by = vec![0.0; cx.space.cube_dimensions()];
        let mut at = 0;
        for factor in factors {
            let numbers = if factor.kind == FactorKind::Rotation { 3 } else { 1 };
            if changed.contains(factor) {
                for by in &mut by[at..at + numbers] {
                    let drawn = 2.0 * stream.unit() - 1.0;
                    *by = match factor.kind {
                        FactorKind::Angle => PI * drawn,
                        FactorKind::Real { .. } | FactorKind::Rotation => {
                            self.step * drawn / factor.weight
                        }
                    };
                }
            }
            at += numbers;
        }
        let from = q.to_vec();
        cx.space.moved(&from, &by, q);
        cx.space.clamp(q);
    }
}

impl BasinHopping {
    /// Descends from `q` and hops from there on, and shows `visit` every minimum with its energy; `q` becomes the lowest of them, whose energy
    /// is returned.
    pub(crate) fn chain(
        &self,
        cx: &Context,
        stream: &mut Stream,
        q: &mut [f64],
        scratch: &mut Scratch,
        visit: &mut dyn FnMut(&[f64], f64),
    ) -> f64 {
        let mut here = q.to_vec();
        let mut energy = self.descent.descend(cx, stream, &mut here, scratch);
        let (mut lowest, mut next) = (energy, here.clone());
        q.copy_from_slice(&here);
        visit(&here, energy);
        for _ in 0..self.hops {
            next.copy_from_slice(&here);
            self.change(cx, stream, &mut next);
            let reached = self.descent.descend(cx, stream, &mut next, scratch);
            visit(&next, reached);
            // Drawn for every hop, so that no energy shifts the numbers of later ones.
            let drawn = stream.unit();
            let is_kept = reached <= energy || drawn < math::exp((energy - reached) / self.kt);
            if is_kept {
                here.copy_from_slice(&next);
                energy = reached;
            }
            if reached < lowest {
                lowest = reached;
                q.copy_from_slice(&next);
            }
        }
        lowest
    }
}

impl Descent for BasinHopping {
    fn descend(
        &self,
        cx: &Context,
        stream: &mut Stream,
        q: &mut [f64],
        scratch: &mut Scratch,
    ) -> f64 {
        self.chain(cx, stream, q, scratch, &mut |_, _| ())
    }

    fn complaint(&self) -> Option<Complaint> {
        if let Some(complaint) = Complaint::of_length("step", self.step, LENGTH_MAX) {
            return Some(complaint);
        }
        if !(self.kt.is_finite() && self.kt > 0.0) {
            return Some(Complaint::new("kt", self.kt, "an energy above 0"));
        }
        if !(1..=1_000_000).contains(&self.hops) {
            return Some(Complaint::new("hops", self.hops, "1 to 1000000"));
        }
        self.descent.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.descent.suits(cx)
    }
}
