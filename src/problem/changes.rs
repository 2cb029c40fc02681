//! In which keys two problems differ, for people who wonder why two runs do.

use super::Problem;
use std::collections::BTreeSet;
use std::fmt;
use toml::{Table, Value};

/// The folder that the written problems name for their other files; equal on both sides.
const FOLDER: &str = "files";
/// The most characters of a value that are shown.
const SHOWN: usize = 60;

/// A key whose value differs between two problems.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedKey {
    /// The key with the tables that it is in, as `strategies[0].nodes`; of a file beside the problem its name.
    pub key: String,
    /// Its values in both; `None` where a problem does not have it. Of a file beside the problem its size.
    pub values: [Option<String>; 2],
}

impl fmt::Display for ChangedKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [left, right] = self.values.each_ref().map(|value| match value {
            None => "not there",
            Some(text) => text,
        });
        write!(f, "{}: {left} and {right}", self.key)
    }
}

impl Problem {
    /// The keys in which this problem and another differ, in the order of their names, both written out with nothing left to
    /// defaults: what a default gives here and the file says there is no difference.
    pub fn changed_keys(&self, other: &Problem) -> Vec<ChangedKey> {
        let written = [self, other].map(|problem| problem.to_toml(FOLDER));
        let [left, right] = written.each_ref().map(|written| {
            let table = written.text.parse::<Table>();
            Value::Table(table.expect("what a problem is written as is TOML"))
        });
        let mut changed = Vec::new();
        compare("", Some(&left), Some(&right), &mut changed);
        let names = written.iter().flat_map(|written| &written.files).map(|(name, _)| name);
        for name in names.collect::<BTreeSet<_>>() {
            let texts = written.each_ref().map(|written| {
                written.files.iter().find(|(known, _)| known == name).map(|(_, text)| text)
            });
            if texts[0] != texts[1] {
                let size = |text: Option<&String>| text.map(|text| format!("{} bytes", text.len()));
                changed.push(ChangedKey { key: format!("file {name}"), values: texts.map(size) });
            }
        }
        changed
    }
}

fn compare(key: &str, left: Option<&Value>, right: Option<&Value>, out: &mut Vec<ChangedKey>) {
    match (left, right) {
        (Some(Value::Table(left)), Some(Value::Table(right))) => {
            for name in left.keys().chain(right.keys()).collect::<BTreeSet<_>>() {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                compare(&key, left.get(name), right.get(name), out);
            }
        }
        (Some(Value::Array(left)), Some(Value::Array(right)))
            if [left, right].iter().all(|array| array.iter().all(Value::is_table)) =>
        {
            for index in 0..left.len().max(right.len()) {
                compare(&format!("{key}[{index}]"), left.get(index), right.get(index), out);
            }
        }
        (left, right) if left == right => {}
        (left, right) => {
            let values = [left, right].map(|value| value.map(short));
            out.push(ChangedKey { key: key.to_owned(), values });
        }
    }
}

/// A value as a problem file says it, cut where it is long.
fn short(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(SHOWN) {
        None => text,
        Some((at, _)) => format!("{}…", &text[..at]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const ROOM: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [1.0, 1.0, 1.0] } }
position = [5.0, 5.0, 0.0]
[[strategies]]
label = "a"
nodes = 20
sampler = { uniform = {} }
[limits]
nodes = 100
"#;

    fn problem(text: &str) -> Problem {
        Problem::parse(Path::new("room.toml"), text).unwrap_or_else(|error| panic!("{error}"))
    }

    fn changed(from: &str, to: &str) -> Vec<String> {
        let changed = problem(ROOM).changed_keys(&problem(&ROOM.replace(from, to)));
        changed.iter().map(ChangedKey::to_string).collect()
    }

    #[test]
    fn what_differs_is_named_by_its_key() {
        assert_eq!(changed("nodes = 20", "nodes = 25"), ["strategies[0].nodes: 20 and 25"]);
        let expected = ["obstacles[0].position: [5.0, 5.0, 0.0] and [5.0, 6.0, 0.0]"];
        assert_eq!(changed("[5.0, 5.0, 0.0]", "[5.0, 6.0, 0.0]"), expected);
        let second =
            "[[strategies]]\nlabel = \"b\"\nnodes = 1\nsampler = { uniform = {} }\n[limits]";
        let found = changed("[limits]", second);
        assert!(
            found.iter().any(|line| line.starts_with("strategies[1]: not there and ")),
            "{found:?}"
        );
    }

    #[test]
    fn what_a_default_gives_is_no_difference() {
        assert_eq!(changed("[limits]", "[img]\nsets_per_round = 5\n[limits]"), [""; 0]);
        assert_eq!(changed("nodes = 100", "nodes = 100 # the same"), [""; 0]);
    }
}
