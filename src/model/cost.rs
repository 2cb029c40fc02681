/// kT at 298 K, kJ/mol: the unit of the costs of molecules' motions.
pub(crate) const KT: f64 = 2.479;

/// What a valid motion costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Its length in the space's metric, the same there and back.
    Metric,
    /// Something that depends on the direction.
    Directed(Directed),
}

/// The cost of a motion in a model with energies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directed {
    /// What the motion costs from its first end to its second, in the model's unit of costs: a finite number, not
    /// negative.
    pub forward: f64,
    /// What it costs from its second end to its first: the same.
    pub backward: f64,
    /// The highest energy on the way, in the model's unit of energy, or a bound above it.
    pub peak: f64,
}

impl Directed {
    /// The cost of this motion followed by another.
    pub fn then(self, next: Directed) -> Directed {
        Directed {
            forward: self.forward + next.forward,
            backward: self.backward + next.backward,
            peak: self.peak.max(next.peak),
        }
    }
}

impl Cost {
    /// Whether its numbers are ones that a search can work with: what decoded bytes must be.
    pub fn is_sound(&self) -> bool {
        match self {
            Cost::Metric => true,
            Cost::Directed(Directed { forward, backward, peak }) => {
                let is_cost = |cost: &f64| cost.is_finite() && *cost >= 0.0;
                is_cost(forward) && is_cost(backward) && peak.is_finite()
            }
        }
    }
}
