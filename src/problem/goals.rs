//! The goals of a query as they are asked for: one, or a list of which any will do.

use super::ConfigurationSpec;
use super::ends::Reader;
use crate::source::Step::{self, Index, Key};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The most goals of a query: every one is a query of its own whenever the roadmap is judged.
pub(super) const GOALS_MAX: usize = 100;

/// What a query may end at: `goal` of a `[query]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum GoalsSpec {
    One(ConfigurationSpec),
    Several(Vec<ConfigurationSpec>),
}

impl GoalsSpec {
    /// Each goal with its place in the file.
    pub fn each(&self) -> Vec<(Vec<Step<'static>>, &ConfigurationSpec)> {
        let place = [Key("query"), Key("goal")];
        match self {
            GoalsSpec::One(goal) => vec![(place.to_vec(), goal)],
            GoalsSpec::Several(goals) => {
                let at = |index| [&place[..], &[Index(index)]].concat();
                goals.iter().enumerate().map(|(index, goal)| (at(index), goal)).collect()
            }
        }
    }

    /// Adds a goal.
    pub fn or(self, goal: ConfigurationSpec) -> GoalsSpec {
        match self {
            GoalsSpec::One(first) => GoalsSpec::Several(vec![first, goal]),
            GoalsSpec::Several(mut goals) => {
                goals.push(goal);
                GoalsSpec::Several(goals)
            }
        }
    }
}

impl<'de> Deserialize<'de> for GoalsSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<GoalsSpec, D::Error> {
        deserializer.deserialize_any(GoalsReader)
    }
}

struct GoalsReader;

impl<'de> Visitor<'de> for GoalsReader {
    type Value = GoalsSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Reader.expecting(f)?;
        f.write_str(", or a list of these")
    }

    /// A list of numbers is a configuration, any other one of goals.
    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<GoalsSpec, A::Error> {
        let (mut numbers, mut goals) = (Vec::new(), Vec::new());
        while let Some(entry) = entries.next_element()? {
            match entry {
                Entry::Number(number) => numbers.push(number),
                Entry::Goal(goal) => goals.push(goal),
            }
        }
        match (numbers.is_empty(), goals.is_empty()) {
            (_, true) => Ok(GoalsSpec::One(ConfigurationSpec::Values(numbers))),
            (true, false) => Ok(GoalsSpec::Several(goals)),
            (false, false) => {
                let message = "numbers beside configurations found; either a configuration or a list of goals expected";
                Err(A::Error::custom(message))
            }
        }
    }

    fn visit_str<E: Error>(self, state: &str) -> Result<GoalsSpec, E> {
        Reader.visit_str(state).map(GoalsSpec::One)
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<GoalsSpec, A::Error> {
        Reader.visit_map(entries).map(GoalsSpec::One)
    }
}

/// What stands in a list.
enum Entry {
    Number(f64),
    Goal(ConfigurationSpec),
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Entry, D::Error> {
        deserializer.deserialize_any(EntryReader)
    }
}

struct EntryReader;

impl<'de> Visitor<'de> for EntryReader {
    type Value = Entry;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or ")?;
        Reader.expecting(f)
    }

    fn visit_f64<E>(self, value: f64) -> Result<Entry, E> {
        Ok(Entry::Number(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Entry, E> {
        Ok(Entry::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Entry, E> {
        Ok(Entry::Number(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, values: A) -> Result<Entry, A::Error> {
        Reader.visit_seq(values).map(Entry::Goal)
    }

    fn visit_str<E: Error>(self, state: &str) -> Result<Entry, E> {
        Reader.visit_str(state).map(Entry::Goal)
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Entry, A::Error> {
        Reader.visit_map(entries).map(Entry::Goal)
    }
}
