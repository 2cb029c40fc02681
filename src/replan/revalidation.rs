use crate::context::Context;
use crate::local::{self, Planner};
use crate::model::{SceneChange, Scratch};
use crate::query::{PATH_REFINEMENT, Path};
use crate::roadmap::EdgeCost;

/// Says which configurations and motions that were valid before a scene changed are valid still.
///
/// - What was valid among the old obstacles is valid among the new ones if it is valid among those that came, taken
///   alone; obstacles that went, and pairs of links, make nothing invalid that was valid.
/// - A box around the robot along the whole motion, which costs a few comparisons, meets none of the boxes of the
///   obstacles that came for most motions ([`Model::may_meet`](crate::model::Model::may_meet)): they are valid.
/// - The rest is checked against the obstacles that came and nothing else, by the motion check of the scene, at its
///   resolution ([`Model::among`](crate::model::Model::among)).
/// - Where more than obstacles has changed, everything is checked in the whole new scene.
///
/// Nothing that is said to be valid is refused by a check in the whole scene, and nothing else is said to be invalid, up to
/// the tolerance by which motions are checked, at which the check itself goes by what stands around (`docs/validity.md`).
pub struct Revalidation<'a> {
    cx: &'a Context,
    /// The robot among the obstacles that came, alone; `None` where everything is checked in the whole scene.
    among_added: Option<Context>,
    checked: u64,
}

impl<'a> Revalidation<'a> {
    /// For a problem in the new scene, which `change` leads to.
    pub fn new(cx: &'a Context, change: &SceneChange) -> Revalidation<'a> {
        let among = match &change.beyond_obstacles {
            Some(_) => None,
            None => cx.model.among(&change.added),
        };
        let among_added = among.map(|model| Context {
            space: cx.space.clone(),
            model,
            base_seed: cx.base_seed,
            query: None,
            tries_direct_motion: cx.tries_direct_motion,
        });
        Revalidation { cx, among_added, checked: 0 }
    }

    /// How many configurations and motions boxes did not suffice for.
    pub fn checked(&self) -> u64 {
        self.checked
    }

    /// Whether a configuration that was valid is valid still.
    pub fn keeps_node(&mut self, q: &[f64], scratch: &mut Scratch) -> bool {
        match &self.among_added {
            Some(among) if !among.model.may_meet(q, q, scratch) => true,
            among => {
                self.checked += 1;
                among.as_ref().unwrap_or(self.cx).model.is_valid(q, scratch)
            }
        }
    }

    /// What the motion costs by which `planner` joined `a` to `b`, both valid still, if the motion is valid still. It is
    /// checked `refinement` times finer than the problem asks for, and so it was before.
    pub fn keeps_motion(
        &mut self,
        planner: Planner,
        (a, b): (&[f64], &[f64]),
        refinement: u32,
        scratch: &mut Scratch,
    ) -> Option<EdgeCost> {
        if let Some(among) = &self.among_added {
            let length = |from: &[f64], to: &[f64], scratch: &mut Scratch| {
                let may_meet = among.model.may_meet(from, to, scratch);
                (!may_meet).then(|| self.cx.space.distance(from, to))
            };
            let free = match planner {
                // It has no turns, so that nothing needs to be written down.
                Planner::StraightLine => length(a, b, scratch),
                planner => {
                    let motion = planner.motion(self.cx, a, b);
                    let legs = 1..motion.len();
                    legs.map(|i| length(motion.get(i - 1), motion.get(i), scratch))
                        .try_fold(0.0, |sum, length| Some(sum + length?))
                }
            };
            if let Some(length) = free {
                return Some(EdgeCost::Metric(length));
            }
        }
        self.checked += 1;
        let cx = self.among_added.as_ref().unwrap_or(self.cx);
        local::connect(cx, &[planner], (a, b), refinement, scratch).map(|(_, cost)| cost)
    }

    /// Whether a path that was given out in the old scene is one that is given out in the new one: every configuration
    /// of it is valid, and every motion between two of them is, [`PATH_REFINEMENT`] times finer than the problem asks for.
    pub fn keeps_path(&mut self, path: &Path, scratch: &mut Scratch) -> bool {
        let configs = &path.configs;
        configs.iter().all(|q| self.keeps_node(q, scratch))
            && (1..configs.len()).all(|i| {
                let ends = (configs.get(i - 1), configs.get(i));
                let straight = Planner::StraightLine;
                self.keeps_motion(straight, ends, PATH_REFINEMENT, scratch).is_some()
            })
    }
}
