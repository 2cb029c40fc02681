//! The ends of a query as they are asked for: by values, by names of joints and states.

use super::PoseSpec;
use crate::source::Step::{self, Key};
use crate::source::{NamedState, fitting, state_of};
use crate::space::Space;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// A configuration as a problem asks for it: `start` or `goal` of a `[query]`.
#[derive(Clone, Debug, PartialEq)]
pub enum ConfigurationSpec {
    /// One value per degree of freedom, in their order.
    Values(Vec<f64>),
    /// The name of a state of the robot's SRDF, `NAME` or `GROUP/NAME`.
    State(String),
    /// Values by the names of degrees of freedom: all of them, or, beside a state, those that differ from it.
    Named {
        /// The name of a state, as of [`ConfigurationSpec::State`].
        state: Option<String>,
        /// Values by names.
        values: BTreeMap<String, f64>,
    },
    /// Any configuration at which a link has a pose.
    Pose(PoseSpec),
}

impl From<PoseSpec> for ConfigurationSpec {
    fn from(pose: PoseSpec) -> ConfigurationSpec {
        ConfigurationSpec::Pose(pose)
    }
}

impl From<Vec<f64>> for ConfigurationSpec {
    fn from(values: Vec<f64>) -> ConfigurationSpec {
        ConfigurationSpec::Values(values)
    }
}

impl<const N: usize> From<[f64; N]> for ConfigurationSpec {
    fn from(values: [f64; N]) -> ConfigurationSpec {
        ConfigurationSpec::Values(values.to_vec())
    }
}

impl From<&str> for ConfigurationSpec {
    fn from(state: &str) -> ConfigurationSpec {
        ConfigurationSpec::State(state.to_owned())
    }
}

impl<'n, const N: usize> From<[(&'n str, f64); N]> for ConfigurationSpec {
    fn from(values: [(&'n str, f64); N]) -> ConfigurationSpec {
        let values = values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        ConfigurationSpec::Named { state: None, values }
    }
}

impl ConfigurationSpec {
    /// The values that are asked for, in the order of the space; of a pose none are.
    ///
    /// # Errors
    /// The place in the configuration's table, what was found and what is expected.
    pub(super) fn values<'s>(
        &'s self,
        space: &Space,
        states: &[NamedState],
    ) -> Result<Vec<f64>, (Vec<Step<'s>>, String)> {
        let whole = |message: String| (Vec::new(), message);
        let (state, values) = match self {
            ConfigurationSpec::Values(values) => return Ok(values.clone()),
            ConfigurationSpec::Pose(_) => return Ok(Vec::new()),
            ConfigurationSpec::State(state) => (Some(state), None),
            ConfigurationSpec::Named { state, values } => (state.as_ref(), Some(values)),
        };
        let state = match (state, values) {
            (None, _) => None,
            (Some(name), None) => Some(state_of(states, name).map_err(whole)?),
            (Some(name), Some(_)) => {
                let at_state = |message| (vec![Key("state")], message);
                Some(state_of(states, name).map_err(at_state)?)
            }
        };
        let mut found: Vec<Option<f64>> = space
            .dofs()
            .iter()
            .map(|dof| state.and_then(|state| state.values.get(&dof.name)).copied())
            .collect();
        for (name, value) in values.into_iter().flatten() {
            let known = space.dofs().iter().position(|dof| dof.name == *name);
            let fits = |name: &str| space.dofs().iter().position(|dof| dof.name == fitting(name));
            let Some(index) = known.or_else(|| fits(name)) else {
                let message =
                    format!("`{name}` found; one of {} expected", names_of(space, |_| true));
                return Err((vec![Key(name)], message));
            };
            found[index] = Some(*value);
        }
        let all: Option<Vec<f64>> = found.iter().copied().collect();
        all.ok_or_else(|| {
            let lacking = names_of(space, |index| found[index].is_none());
            let beside = match (state, values) {
                (Some(state), None) => {
                    let name = &state.name;
                    format!(", as {{ state = \"{name}\", NAME = VALUE, … }}")
                }
                _ => String::new(),
            };
            whole(format!("no value of {lacking} found; one for each expected{beside}"))
        })
    }
}

/// The names of the degrees of freedom that are meant.
fn names_of(space: &Space, is_meant: impl Fn(usize) -> bool) -> String {
    let meant = space.dofs().iter().enumerate().filter(|(index, _)| is_meant(*index));
    meant.map(|(_, dof)| format!("`{}`", dof.name)).collect::<Vec<_>>().join(", ")
}

impl<'de> Deserialize<'de> for ConfigurationSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ConfigurationSpec, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

pub(super) struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = ConfigurationSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "an array of numbers, the name of a state, or a table of joints and their values",
        )
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<ConfigurationSpec, A::Error> {
        let mut all = Vec::new();
        while let Some(value) = values.next_element()? {
            all.push(value);
        }
        Ok(ConfigurationSpec::Values(all))
    }

    fn visit_str<E>(self, state: &str) -> Result<ConfigurationSpec, E> {
        Ok(ConfigurationSpec::State(state.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<ConfigurationSpec, A::Error> {
        let (mut state, mut values) = (None, BTreeMap::new());
        while let Some(name) = entries.next_key::<String>()? {
            match entries.next_value()? {
                Entry::Value(value) => _ = values.insert(name, value),
                Entry::State(named) if name == "state" => state = Some(named),
                Entry::Pose(pose) if name == "pose" => {
                    if !values.is_empty()
                        || state.is_some()
                        || entries.next_key::<String>()?.is_some()
                    {
                        let message =
                            "`pose` found beside others; either a pose or values expected";
                        return Err(serde::de::Error::custom(message));
                    }
                    return Ok(ConfigurationSpec::Pose(pose));
                }
                Entry::Pose(_) => {
                    let message = format!("`{name}` = {{ … }} found; a number expected");
                    return Err(serde::de::Error::custom(message));
                }
                Entry::State(named) => {
                    let message = format!("`{name}` = \"{named}\" found; a number expected");
                    return Err(serde::de::Error::custom(message));
                }
            }
        }
        Ok(ConfigurationSpec::Named { state, values })
    }
}

/// What stands at a name: a joint of any name has a number, so that `state` may also be the name of one.
enum Entry {
    Value(f64),
    State(String),
    Pose(PoseSpec),
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
        f.write_str("a number")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Entry, E> {
        Ok(Entry::Value(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Entry, E> {
        Ok(Entry::Value(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Entry, E> {
        Ok(Entry::Value(value as f64))
    }

    fn visit_str<E>(self, name: &str) -> Result<Entry, E> {
        Ok(Entry::State(name.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, pose: A) -> Result<Entry, A::Error> {
        PoseSpec::deserialize(MapAccessDeserializer::new(pose)).map(Entry::Pose)
    }
}
