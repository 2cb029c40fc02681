//! Bodies among whose valid configurations a program's own function chooses.

use super::BodyValidity;
use crate::model::{Cost, Model, Reason, Scratch, Validity, ValidityFunction};
use crate::space::Space;

/// Bodies, of whose valid configurations a function allows some.
pub(super) struct BodiesWithFunction {
    bodies: BodyValidity,
    function: ValidityFunction,
}

impl BodiesWithFunction {
    /// Bodies whose motions are looked at in steps, and a function.
    pub fn new(bodies: BodyValidity, function: ValidityFunction) -> BodiesWithFunction {
        BodiesWithFunction { bodies, function }
    }
}

impl Model for BodiesWithFunction {
    fn space(&self) -> &Space {
        self.bodies.space()
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        match self.bodies.validity(q, scratch) {
            Validity::Valid if !self.function.allows(q) => Validity::Invalid,
            validity => validity,
        }
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let cost = self.bodies.motion(a, b, refinement, scratch)?;
        let steps = self.bodies.steps(a, b, refinement);
        let allowed = self
            .bodies
            .all_between(a, b, steps, &mut vec![0.0; a.len()], |q| self.function.allows(q));
        allowed.then_some(cost)
    }

    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        let mut reasons = self.bodies.reasons(q, depths);
        let identity = self.function.identity();
        if !self.function.is_given() {
            let text = format!("the validity function `{identity}` is not here to judge it");
            reasons.push(Reason::Other { text });
        } else if reasons.is_empty() && !self.function.allows(q) {
            let text = format!("the validity function `{identity}` forbids it");
            reasons.push(Reason::Other { text });
        }
        reasons
    }

    fn is_obstructed(&self) -> bool {
        true
    }
}
