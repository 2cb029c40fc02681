//! What the evaluators share that attach configurations to the roadmap.

use crate::context::Context;
use crate::local::Planner;
use crate::query::Attachment;

pub(super) fn default_neighbors() -> u32 {
    Attachment::default().neighbors
}

pub(super) fn default_planners() -> Vec<Planner> {
    Attachment::default().planners
}

/// The settings of an evaluator that attaches configurations to the roadmap: its own, followed by `neighbors` and
/// `planners`, from which `how` makes the [`Attachment`]. In a problem file, and in the bytes of a problem, they are
/// settings like the others: nothing is nested.
macro_rules! attaching {
    ($(#[$about:meta])* pub struct $name:ident {
        $($(#[$of_field:meta])* pub $field:ident: $type:ty,)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        #[derive(serde::Serialize, serde::Deserialize, bincode::Encode, bincode::Decode)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($(#[$of_field])* pub $field: $type,)*
            /// How many nearest nodes each configuration tries to connect to.
            #[serde(default = "super::attaching::default_neighbors")]
            pub neighbors: u32,
            /// Local planners, tried in this order until one succeeds.
            #[serde(default = "super::attaching::default_planners")]
            pub planners: Vec<crate::local::Planner>,
        }

        impl $name {
            /// How configurations are attached to the roadmap.
            fn how(&self) -> crate::query::Attachment {
                let (neighbors, planners) = (self.neighbors, self.planners.clone());
                crate::query::Attachment { neighbors, planners }
            }
        }
    };
}

/// The methods of an evaluator by `attaching!` that judges what is between the ends of the problem's query.
macro_rules! between_ends {
    () => {
        fn needs_query(&self) -> bool {
            true
        }

        fn attachment(&self) -> Option<crate::query::Attachment> {
            Some(self.how())
        }
    };
}

/// The ends of the problem's query, which [`Evaluator::needs_query`](super::Evaluator::needs_query) has asked for.
pub(super) fn ends(cx: &Context) -> (&[f64], &[f64]) {
    let query = cx.query.as_ref().expect("a checked problem has the query");
    (&query.start, &query.goal)
}

pub(super) use {attaching, between_ends};
