use crate::model::{Approach, Model, Scratch};

/// An exact answer: what a model says of one configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// The configuration is valid.
    Free {
        /// The configuration.
        q: Vec<f64>,
        /// The way to the nearest obstacle; `None` where there are no obstacles, or the model has no clearances.
        nearest: Option<Approach>,
    },
    /// The configuration is not valid: it collides, or lies out of bounds.
    Colliding {
        /// The configuration.
        q: Vec<f64>,
    },
}

impl Exact {
    /// What `model` says of `q`, a configuration in stored form ([`Space::canonicalize`](crate::space::Space::canonicalize)).
    pub fn at(model: &dyn Model, q: &[f64], scratch: &mut Scratch) -> Exact {
        if !model.is_valid(q, scratch) {
            return Exact::Colliding { q: q.to_vec() };
        }
        let nearest = model.clearances().and_then(|it| it.approach(q, scratch));
        Exact::Free { q: q.to_vec(), nearest }
    }

    /// The configuration.
    pub fn q(&self) -> &[f64] {
        match self {
            Exact::Free { q, .. } | Exact::Colliding { q } => q,
        }
    }

    /// Whether it is not valid.
    pub fn collides(&self) -> bool {
        matches!(self, Exact::Colliding { .. })
    }
}
