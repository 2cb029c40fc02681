use crate::connect::AmongKind;
use crate::context::Context;
use crate::generator::GeneratorKind;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;

/// How the node sets of one label are made and joined to the roadmap.
#[derive(Clone, Debug, PartialEq)]
pub struct Strategy {
    /// Its name, unique in the problem: part of the seed of each of its sets.
    pub(crate) label: String,
    /// Milestones per set (TR05-007: *n*).
    pub(crate) nodes: u32,
    /// What makes its sets.
    pub(crate) generator: GeneratorKind,
    /// How a set is connected with what came before it.
    pub(crate) among: AmongKind,
}

impl Strategy {
    /// Its name, unique in the problem: part of the seed of each of its sets.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Milestones per set (TR05-007: *n*), at least one.
    pub fn nodes(&self) -> u32 {
        self.nodes
    }

    /// What makes its sets.
    pub fn generator(&self) -> &GeneratorKind {
        &self.generator
    }

    /// How a set is connected with what came before it.
    pub fn among(&self) -> &AmongKind {
        &self.among
    }

    /// Makes the set `ordinal` of this strategy: a pure function of the problem, the base seed, the label, the
    /// ordinal and, where the generator grows the roadmap, the roadmap at the start of the set's round,
    /// `frozen`.
    ///
    /// # Errors
    /// When the generator gives up.
    pub fn generate(
        &self,
        cx: &Context,
        ordinal: Ordinal,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        scratch.take_asked();
        let seed = Seed::of_set(cx.base_seed, &self.label, ordinal);
        let generator = self.generator.method();
        let mut increment = generator.generate(cx, &seed, self.nodes as usize, frozen, scratch)?;
        if !cx.model.node_values().is_empty() {
            for q in increment.configs.iter() {
                cx.model.values(q, &mut increment.values, scratch);
            }
        }
        increment.asked = scratch.take_asked();
        Ok(increment)
    }
}
