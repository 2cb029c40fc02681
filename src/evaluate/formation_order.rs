use super::attaching::{attaching, default_neighbors, default_planners};
use super::{Evaluator, Verdict};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::folding::{Formation, Native, Settings};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::Attachment;
use crate::roadmap::{Extent, Roadmap};

/// Samples between two evaluations: S. Nath 2013, §5.3.2.
fn default_every() -> u64 {
    250
}

/// How far shares may change: S. Nath 2013, §5.3.2, 10 %.
fn default_change() -> f64 {
    0.1
}

/// Shares of fewer pathways are too coarse for a change of 10 % to say something: one of 50 pathways is 2 %.
fn default_pathways() -> u64 {
    50
}

fn default_formed() -> f64 {
    Settings::default().formed
}

fn default_unstructured() -> u32 {
    Settings::default().unstructured
}

attaching! {
    /// The order in which the parts of a protein's native structure form varies no more: for each two parts, helices, strands and
    /// pairings, the share of [pathways](crate::folding) on which the one forms before the other has changed by at most `change` over the
    /// last `every` samples (S. Nath 2013, §5.3.2).
    ///
    /// The roadmap is compared with what it was at the end of the last round that had at least `every` nodes less. The
    /// value is the greatest change; infinite while there are not yet `pathways` pathways in both. For models with helices or strands.
    pub struct FormationOrder {
        /// Over how many nodes the change is measured.
        #[serde(default = "default_every")]
        pub every: u64,
        /// The greatest change of a share that satisfies the criterion, from 0 to 1.
        #[serde(default = "default_change")]
        pub change: f64,
        /// How many pathways there must be at least.
        #[serde(default = "default_pathways")]
        pub pathways: u64,
        /// The share of a part's native contacts from which on it is formed.
        #[serde(default = "default_formed")]
        pub formed: f64,
        /// A pathway begins at a node with at most so many native contacts.
        #[serde(default = "default_unstructured")]
        pub unstructured: u32,
    }
}

impl Default for FormationOrder {
    fn default() -> FormationOrder {
        FormationOrder {
            every: default_every(),
            change: default_change(),
            pathways: default_pathways(),
            formed: default_formed(),
            unstructured: default_unstructured(),
            neighbors: default_neighbors(),
            planners: default_planners(),
        }
    }
}

impl FormationOrder {
    /// What counts as formed, and what as unstructured.
    pub fn settings(&self) -> Settings {
        Settings { formed: self.formed, unstructured: self.unstructured }
    }

    /// How far the roadmap went when it had at least `every` nodes less.
    fn earlier(&self, roadmap: &Roadmap) -> Extent {
        let most = (roadmap.configs().len() as u64).saturating_sub(self.every);
        let earlier = roadmap.rounds().iter().rev().find(|extent| extent.nodes as u64 <= most);
        earlier.copied().unwrap_or_default()
    }
}

impl Evaluator for FormationOrder {
    fn name(&self) -> &'static str {
        "formation-order"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["pathways", "share of the most frequent order", "pathways before", "nodes before"]
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let Some(native) = Native::of(&*cx.model, scratch) else {
            return Verdict::at_most(self.change, f64::INFINITY, scratch.take_asked());
        };
        let earlier = self.earlier(roadmap);
        let extents = [earlier, roadmap.extent()];
        let (settings, how) = (self.settings(), self.how());
        let [before, now] = Formation::at(
            cx,
            roadmap,
            extents,
            (&native, &settings, &how),
            &Cancel::new(),
            scratch,
        );
        let enough = before.pathways.min(now.pathways) >= self.pathways;
        let change = if enough { now.change(&before) } else { f64::INFINITY };
        let measures =
            vec![now.pathways as f64, now.dominant(), before.pathways as f64, earlier.nodes as f64];
        Verdict { measures, ..Verdict::at_most(self.change, change, scratch.take_asked()) }
    }

    fn attachment(&self) -> Option<Attachment> {
        Some(self.how())
    }

    fn complaint(&self) -> Option<Complaint> {
        let share = |key, value: f64, expected| {
            let fits = value > 0.0 && value <= 1.0;
            (!fits).then(|| Complaint::new(key, value, expected))
        };
        let at_least_1 =
            |key, value: u64| (value == 0).then(|| Complaint::new(key, value, "at least 1"));
        None.or_else(|| at_least_1("every", self.every))
            .or_else(|| share("change", self.change, "more than 0, at most 1"))
            .or_else(|| at_least_1("pathways", self.pathways))
            .or_else(|| share("formed", self.formed, "more than 0, at most 1"))
            .or_else(|| self.how().complaint())
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        let native = Native::of(&*cx.model, &mut Scratch::new());
        match native.is_some_and(|native| !native.parts.is_empty()) {
            true => Ok(()),
            false => Err("an order of formation found, a protein with helices or strands expected"
                .to_owned()),
        }
    }
}
