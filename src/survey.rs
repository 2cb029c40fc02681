//! How much of the space is valid, and what is mostly in the way: told before a build, and where one finds nothing.

use crate::context::Context;
use crate::model::{Reason, Scratch, link_named};
use crate::seed::{Purpose, Seed};
use std::collections::BTreeMap;
use std::fmt;

/// What uniformly drawn configurations came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// How many were drawn.
    pub draws: usize,
    /// How many of them are valid.
    pub valid: usize,
    /// What is in the way, with how many configurations it refuses, most first: pairs of bodies that collide, links that
    /// leave the bounds. Several reasons may refuse one configuration.
    pub reasons: Vec<(String, usize)>,
}

impl Survey {
    /// Draws `draws` configurations uniformly, the same for the same problem and base seed, and asks why each is not valid.
    /// The roadmap does not depend on it: the stream of chance is the survey's own.
    pub fn new(cx: &Context, draws: usize) -> Survey {
        let mut stream = Seed::of_evaluator(cx.base_seed, "survey").stream(Purpose::Sampling);
        let (mut q, scratch) = (vec![0.0; cx.space.len()], &mut Scratch::new());
        let mut valid = 0;
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for _ in 0..draws {
            cx.space.sample_uniform(&mut stream, &mut q);
            if cx.model.is_valid(&q, scratch) {
                valid += 1;
                continue;
            }
            let mut names: Vec<_> = cx.model.reasons(&q, false).iter().map(name).collect();
            names.sort();
            names.dedup();
            for name in names {
                *counts.entry(name).or_default() += 1;
            }
        }
        let mut reasons: Vec<(String, usize)> = counts.into_iter().collect();
        reasons.sort_by_key(|(_, count)| usize::MAX - count);
        Survey { draws, valid, reasons }
    }

    /// The share of valid configurations.
    pub fn share(&self) -> f64 {
        self.valid as f64 / self.draws.max(1) as f64
    }

    /// What might suit where few draws are valid, for people to read; `None` where nothing is unusual.
    pub fn advice(&self) -> Option<&'static str> {
        // One draw in 200 is what the default bound of attempts and usual sets get along with.
        match self.share() {
            share if share >= 0.005 => None,
            0.0 => Some(
                "nothing that was drawn is valid: look at the bounds, the scene's unit and `may_touch`; if they are right, \
                 a sampler that walks out of obstacles (maprm, obprm) or a generator that grows from the query \
                 (rrt-connect) might suit",
            ),
            _ => Some(
                "little is valid: more `attempts`, a sampler that starts from obstacles (obprm, maprm) or a generator that \
                 grows from the query (rrt-connect) might suit",
            ),
        }
    }
}

/// The reasons that are told apart: who collides with whom, not how deep.
fn name(reason: &Reason) -> String {
    match reason {
        Reason::Collision { body, other, .. } => format!("{body} collides with {other}"),
        Reason::Bounds { link, .. } => {
            format!("{} leaves the bounds", link_named(link))
        }
        Reason::Range { dof, .. } => format!("{dof} is out of its range"),
        Reason::Other { text } => {
            // "Backbone: VAL 35 N and …": the rule, not the place.
            let rule = text.split_once(':').map_or(&**text, |(rule, _)| rule);
            rule.chars().take_while(|c| !c.is_ascii_digit()).collect::<String>().trim().to_owned()
        }
    }
}

impl fmt::Display for Survey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Survey { draws, valid, reasons } = self;
        write!(f, "{valid} of {draws} uniform draws are valid")?;
        for (index, (reason, count)) in reasons.iter().take(3).enumerate() {
            let before = if index == 0 { "; most often " } else { ", " };
            write!(f, "{before}{reason} ({count})")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;
    use std::path::Path;

    #[test]
    fn a_survey_counts_what_is_valid_and_what_is_in_the_way() {
        // A point in a unit square of which a wall takes 30 % and a disk that the wall does not touch about 3 %.
        let text = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [1.0, 1.0]
bounds = "body"
resolution = 0.01
[robot]
bodies = [{ shape = { point = {} } }]
[[obstacles]]
shape = { box = { size = [0.3, 4.0, 1.0] } }
position = [0.5, 0.5, 0.0]
[[obstacles]]
shape = { sphere = { radius = 0.1 } }
position = [0.15, 0.5, 0.0]
"#;
        let problem = Problem::parse(Path::new("square.toml"), text);
        let problem = problem.unwrap_or_else(|error| panic!("{error}"));
        let survey = Survey::new(&problem.context(), 4000);
        // Four deviations of the binomial distribution.
        let near = |found: usize, share: f64| {
            let (expected, draws) = (share * 4000.0, 4000.0);
            (found as f64 - expected).abs() < 4.0 * (draws * share * (1.0 - share)).sqrt()
        };
        assert!(near(survey.valid, 1.0 - 0.3 - 0.0314), "{survey}");
        assert_eq!(survey.reasons.len(), 2, "{survey}");
        let [(wall, in_wall), (disk, in_disk)] = &survey.reasons[..] else { panic!("{survey}") };
        assert_eq!(wall, "the robot collides with obstacles[0]");
        assert_eq!(disk, "the robot collides with obstacles[1]");
        assert!(near(*in_wall, 0.3) && near(*in_disk, 0.0314), "{survey}");
        assert_eq!(survey.valid + in_wall + in_disk, 4000);
        assert_eq!(survey.advice(), None);
        assert_eq!(survey, Survey::new(&problem.context(), 4000));
    }
}
