use super::{GaveUp, Sampler, default_attempts, zero};
use crate::context::Context;
use crate::math;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{Factor, FactorKind};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Gaussian noise about known configurations: every angle is turned by a normal deviate, and the configuration is kept by
/// its energy (N. M. Amato, G. Song, *Using motion planning to study protein folding pathways*, J. Comput. Biol. 2002,
/// draw about the native state with deviations from 5° to 160°, and keep a conformation of energy E with probability
/// 1 below E_min, (E_max − E) / (E_max − E_min) between, and 0 above E_max).
///
/// Milestone number `m`, counted through all sets of the strategy, has width number `m` mod the number of widths, so that
/// all widths have equal shares however hard they are to draw for (in a `mix`, which draws its shares, only about equal ones). With two ends it stands about the start for one
/// round of the widths, and about the goal for the next.
///
/// The papers give E_min and E_max in numbers, which belong to one protein and one energy. Here every width has its own: the
/// median and the 95th percentile of the energies of [`CALIBRATED`] draws of that width, valid or not. They are found once,
/// when a problem that leaves `windows` away is read, by the base seed that its file says, and are part of the problem from
/// then on: another `--seed` draws other sets in the same windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct TorsionNoise {
    /// Standard deviations of the noise, in degrees; if there are none, those of [`WIDTHS`] of which at least [`FEASIBLE`] in
    /// [`CALIBRATED`] draws about every configuration are valid, or else the least.
    #[serde(default)]
    pub degrees: Vec<f64>,
    /// About which configurations.
    #[serde(default)]
    pub about: About,
    /// Per width E_min and E_max, first those of all widths about the first configuration, then those about the second;
    /// found by draws if there are none.
    #[serde(default)]
    pub windows: Vec<[f64; 2]>,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

/// About which configurations [`TorsionNoise`] draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum About {
    /// The model's native configuration.
    #[default]
    Native,
    /// The start and the goal of the query.
    Ends,
}

/// How many configurations are drawn to find the window of a width.
pub const CALIBRATED: usize = 1000;

/// The widths, in degrees, among which those are chosen that a chain can be drawn with: the longer it is, the fewer of its
/// conformations are possible at a width.
pub const WIDTHS: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0];

/// How many of [`CALIBRATED`] draws of a width are valid at least if it is chosen.
pub const FEASIBLE: usize = 5;

impl Default for TorsionNoise {
    fn default() -> TorsionNoise {
        TorsionNoise {
            degrees: Vec::new(),
            about: About::default(),
            windows: Vec::new(),
            attempts: default_attempts(),
        }
    }
}

impl TorsionNoise {
    /// The configurations about which is drawn.
    fn centres<'a>(&self, cx: &'a Context) -> Vec<&'a [f64]> {
        match (self.about, &cx.query) {
            (About::Ends, Some(ends)) => ends.all().collect(),
            _ => cx.model.native().into_iter().collect(),
        }
    }

    /// Draws one configuration about `centre`.
    fn draw(centre: &[f64], degrees: f64, stream: &mut Stream, out: &mut [f64]) {
        let radians = degrees * (PI / 180.0);
        for (value, about) in out.iter_mut().zip(centre) {
            *value = math::wrap_angle(about + radians * stream.normal());
        }
    }

    /// How many of [`CALIBRATED`] draws are valid.
    fn valid(centre: &[f64], degrees: f64, cx: &Context, seed: &Seed) -> usize {
        let (stream, scratch) = (&mut seed.stream(Purpose::Sampling), &mut Scratch::new());
        let mut q = vec![0.0; centre.len()];
        let is_valid = |_: &usize| {
            TorsionNoise::draw(centre, degrees, stream, &mut q);
            cx.model.is_valid(&q, scratch)
        };
        (0..CALIBRATED).filter(is_valid).count()
    }

    /// The widths that can be drawn with.
    fn feasible(&self, cx: &Context, seed: &Seed) -> Vec<f64> {
        let centres = self.centres(cx);
        let is_feasible = |degrees: &f64| {
            let enough = |at: &&[f64]| TorsionNoise::valid(at, *degrees, cx, seed) >= FEASIBLE;
            centres.iter().all(enough)
        };
        let chosen: Vec<f64> = WIDTHS.into_iter().filter(is_feasible).collect();
        if chosen.is_empty() { vec![WIDTHS[0]] } else { chosen }
    }

    /// The energies of [`CALIBRATED`] draws, in ascending order.
    fn energies(centre: &[f64], degrees: f64, cx: &Context, seed: &Seed) -> Vec<f64> {
        let (stream, scratch) = (&mut seed.stream(Purpose::Sampling), &mut Scratch::new());
        let mut q = vec![0.0; centre.len()];
        let draw = |_| {
            TorsionNoise::draw(centre, degrees, stream, &mut q);
            cx.model.energy(&q, scratch).unwrap_or_default()
        };
        let mut energies: Vec<f64> = (0..CALIBRATED).map(draw).collect();
        energies.sort_by(f64::total_cmp);
        energies
    }
}

impl Sampler for TorsionNoise {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let mut chance = seed.stream(Purpose::Accepting);
        let centres = self.centres(cx);
        let kinds = self.degrees.len() * centres.len();
        // What is refused in a problem file can still come in bytes.
        if self.complaint().is_some() || self.suits(cx).is_err() {
            return Err(GaveUp { attempts: 0 });
        }
        let mut q = vec![0.0; cx.space.len()];
        // In 128 bits, since nothing bounds a set's number.
        let first = u128::from(seed.ordinal().0) * count as u128;
        for milestone in first..first + count as u128 {
            let kind = (milestone % kinds as u128) as usize;
            let (centre, degrees) =
                (centres[kind / self.degrees.len()], self.degrees[kind % self.degrees.len()]);
            let [always, never] = self.windows[kind];
            let mut tried = 0;
            loop {
                if tried == self.attempts {
                    return Err(GaveUp { attempts: tried });
                }
                tried += 1;
                TorsionNoise::draw(centre, degrees, &mut stream, &mut q);
                // Drawn for every configuration, so that no verdict shifts the numbers of later ones.
                let drawn = chance.unit();
                if !cx.model.is_valid(&q, scratch) {
                    continue;
                }
                let Some(energy) = cx.model.energy(&q, scratch) else { continue };
                let share = (never - energy) / (never - always);
                if drawn < share {
                    break;
                }
            }
            out.push(&q);
        }
        Ok(())
    }

    fn reads_query(&self) -> bool {
        self.about == About::Ends
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        // A model that is none to draw in is refused by `suits`.
        let is_angle = |factor: &Factor| factor.kind == FactorKind::Angle;
        if !self.windows.is_empty() || !cx.space.factors().iter().all(is_angle) {
            return;
        }
        if self.degrees.is_empty() {
            self.degrees = self.feasible(cx, &seed.part(u64::MAX));
        }
        let mut windows = Vec::new();
        for centre in self.centres(cx) {
            for degrees in &self.degrees {
                let seed = seed.part(windows.len() as u64);
                let energies = TorsionNoise::energies(centre, *degrees, cx, &seed);
                let [median, highest] =
                    [50, 95].map(|percent| energies[(energies.len() - 1) * percent / 100]);
                // A window has some width even where all energies are equal.
                windows.push([median, highest.max(median + 1e-6 * (1.0 + median.abs()))]);
            }
        }
        self.windows = windows;
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.degrees.is_empty() && !self.windows.is_empty() || self.degrees.len() > 1000 {
            let found = format!("{} widths", self.degrees.len());
            return Some(Complaint::new("degrees", found, "1 to 1000, or none and no windows"));
        }
        // Written so that NaN fails it.
        if let Some(width) = self.degrees.iter().find(|width| !(**width > 0.0 && **width <= 360.0))
        {
            return Some(Complaint::new("degrees", width, "more than 0, at most 360"));
        }
        let sound = |window: &&[f64; 2]| {
            window.iter().all(|energy| energy.is_finite()) && window[0] < window[1]
        };
        if let Some([always, never]) = self.windows.iter().find(|window| !sound(window)) {
            let found = format!("[{always}, {never}]");
            return Some(Complaint::new("windows", found, "a finite energy and one above it"));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        if cx.space.factors().iter().any(|factor| factor.kind != FactorKind::Angle) {
            return Err(
                "torsion noise found, a model all of whose values are angles expected".to_owned()
            );
        }
        if self.about == About::Ends && cx.query.is_none() {
            return Err("torsion noise about the ends of a query found, but no [query]".to_owned());
        }
        let Some(centre) = self.centres(cx).first().copied() else {
            return Err(
                "torsion noise found, a model with a native configuration expected".to_owned()
            );
        };
        if cx.model.energy(centre, &mut Scratch::new()).is_none() {
            return Err("torsion noise found, a model with energies expected".to_owned());
        }
        let expected = self.degrees.len() * self.centres(cx).len();
        if self.windows.len() != expected || expected == 0 {
            let found = self.windows.len();
            return Err(format!("{found} windows found; {expected} expected, one for each width"));
        }
        Ok(())
    }
}
