use super::growth::{Complaints, GrowingSet};
use super::hint_path::HintPath;
use super::hinting::{Layer, bridge, broken, draw_near, fitted};
use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::push::Push;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::scene::LENGTH_MAX;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The step of a problem that names none, as a share of the largest distance in the space: with a hundredth the hints in a passage that is a
/// twentieth of the space long are several, and the straight motions between them are short.
const STEP_SHARE: f64 = 0.01;
/// The reach of a problem that names none, in steps.
const REACH_STEPS: f64 = 8.0;
/// Into how many configurations a path is cut at most, of however many it consists.
const HINTS_MAX: usize = 10_000;
/// How long the extensions are by which the two sides of a gap are grown together, in steps, and how many motions are tried to bend a blocked one aside.
const BRIDGE_STEPS: f64 = 2.0;
const BRIDGE_TRIALS: u32 = 12;
/// How often hints are set closer together, by half each time, where a path stays broken.
const FINER_MAX: u32 = 4;

/// Approximate paths turned into valid milestones: hints (O. B. Bayazit, *Solving motion planning problems by iterative
/// relaxation of constraints*, dissertation, Texas A&M University 2003, chapter IV C and D).
///
/// A hint is a path that a person drew or another planner found, or the solution of an easier version of the problem; it may collide.
///
/// *The first sets* lay the paths, a set for each, in their order. The path is sampled in steps; the valid configurations become milestones in their order, and each
/// run of colliding ones between them is pushed free ([`Push`]). Each milestone is joined to its neighbours along the path, where the
/// straight motion is valid.
///
/// *Every later set* takes a path in turn and looks where it is still broken: at which hints it passes from one connected component of the roadmap
/// to another. By turns, the path is sampled more finely there and its colliding hints are pushed again, in other directions, more of them each
/// time; or trees are grown toward each other from the components on both sides, as by [`ContactTrees`](super::ContactTrees), but along the path.
///
/// What a set has room for beyond that are random configurations near the hints where the path is broken, at first within `spread`, then
/// farther and farther away, so that sets are always full. So the method gives up only where uniform sampling would.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Hints {
    /// The approximate path.
    #[serde(default)]
    pub path: Option<HintPath>,
    /// More of them, those that are trusted most first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub paths: Vec<HintPath>,
    /// How colliding hints are moved to valid configurations.
    #[serde(default)]
    pub push: Push,
    /// The most that consecutive hints are apart, and by how much a push moves at a time, in the space's metric. If none is given, a hundredth of the largest distance in
    /// the space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The farthest that a push moves a hint, in the space's metric. If none is given, eight steps.
    #[serde(default)]
    pub reach: Option<f64>,
    /// Within which distance of the hints random configurations are drawn at first, in the space's metric. If none is given, a step.
    #[serde(default)]
    pub spread: Option<f64>,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_attempts() -> u64 {
    10_000
}

impl Hints {
    /// The method for one path, with its usual settings.
    pub fn new(path: HintPath) -> Hints {
        Hints {
            path: Some(path),
            paths: Vec::new(),
            push: Push::default(),
            step: None,
            reach: None,
            spread: None,
            attempts: default_attempts(),
        }
    }

    /// All paths, those that are trusted most first.
    pub fn all_paths(&self) -> impl Iterator<Item = &HintPath> {
        self.path.iter().chain(&self.paths)
    }

    fn step_in(&self, cx: &Context) -> f64 {
        self.step.unwrap_or_else(|| STEP_SHARE * cx.space.diameter())
    }

    fn reach_in(&self, cx: &Context) -> f64 {
        self.reach.unwrap_or_else(|| REACH_STEPS * self.step_in(cx))
    }

    /// The configurations of a path in stored form.
    ///
    /// # Errors
    /// Says what is wrong with the path.
    fn stored(path: &HintPath, cx: &Context) -> Result<Vec<Vec<f64>>, String> {
        let of = |(index, q): (usize, &Vec<f64>)| {
            let mut q = q.clone();
            let stored = cx.stored(&mut q);
            stored.map(|()| q).map_err(|why| format!("configuration {}: {why}", index + 1))
        };
        path.configurations().iter().enumerate().map(of).collect()
    }
}

impl Generator for Hints {
    fn reads(&self) -> Reads {
        Reads::Roadmap
    }

    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let ordinal = seed.ordinal().0;
        let paths: Vec<&HintPath> = self.all_paths().collect();
        // What is refused in a problem file can still come in bytes.
        let path = paths.get((ordinal % paths.len().max(1) as u64) as usize);
        let hints = path.map(|path| Hints::stored(path, cx)).and_then(Result::ok);
        let Some(path) = hints.filter(|path| !path.is_empty() && self.complaint().is_none()) else {
            return Err(GaveUp { attempts: 0 });
        };
        // How often the path was dealt with before.
        let effort = (ordinal / paths.len() as u64).min(1000) as u32;
        let (step, reach) = (self.step_in(cx), self.reach_in(cx));
        let spread = self.spread.unwrap_or(step);
        let limits = (BRIDGE_STEPS * step, self.attempts);
        let set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        let set = set.with_bending(BRIDGE_TRIALS, 0.0);
        let set = if cx.model.contacts().is_some() { set.with_retraction() } else { set };
        let mut layer = Layer { set, push: self.push, step, reach, effort };
        let near = if effort == 0 {
            let hints = fitted(&cx.space, &path, step, count);
            let gaps = layer.lay(&hints, [None, None], seed);
            if gaps.is_empty() { hints } else { gaps }
        } else {
            let hints = fitted(&cx.space, &path, step, HINTS_MAX);
            let only_valid = effort % 4 < 2;
            let gaps = broken(cx, &hints, frozen, only_valid, layer.set.scratch);
            if effort % 2 == 1 {
                // The first time as before.
                let finer = step / f64::from(1u32 << (effort / 2).min(FINER_MAX));
                layer.step = finer;
                layer.mend(&hints, &gaps, finer, seed);
            } else {
                bridge(&mut layer.set, &hints, &gaps, (spread, effort as usize / 2), seed);
            }
            let broken: Vec<Vec<f64>> = gaps.iter().flat_map(|gap| gap.of(&hints)).collect();
            if broken.is_empty() { hints } else { broken }
        };
        draw_near(&mut layer.set, &near, spread, seed)?;
        Ok(layer.set.made)
    }

    fn hint_paths_mut(&mut self) -> Vec<&mut HintPath> {
        self.path.iter_mut().chain(&mut self.paths).collect()
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        let positive = |length: f64| Some(length).filter(|length| *length > 0.0);
        self.step = self.step.or_else(|| positive(self.step_in(cx)));
        self.reach = self.reach.or_else(|| positive(self.reach_in(cx)));
        self.spread = self.spread.or(self.step);
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.all_paths().next().is_none() {
            return Some(Complaint::new("path", "none", "the file of an approximate path"));
        }
        let of = |key, length: Option<f64>| {
            length.and_then(|length| Complaint::of_length(key, length, LENGTH_MAX))
        };
        Complaints::of_step(self.step)
            .or_else(|| of("reach", self.reach))
            .or_else(|| of("spread", self.spread))
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.push.suits(cx)?;
        for (index, path) in self.all_paths().enumerate() {
            let which = match path.file() {
                "" => format!("path {}", index + 1),
                file => file.to_owned(),
            };
            let stored = Hints::stored(path, cx).map_err(|why| format!("{which}: {why}"))?;
            if stored.is_empty() {
                return Err(format!("{which}: no configuration found; at least 1 expected"));
            }
        }
        Ok(())
    }
}
