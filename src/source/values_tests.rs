//! What is read of a file, and what is said of one that does not fit, is what `toml`'s own deserializer reads and says.

use super::values::Reader;
use proptest::prelude::*;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::fmt::Debug;
use toml::de::DeTable;

#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    name: Option<String>,
    count: Option<u32>,
    large: Option<u64>,
    sign: Option<i64>,
    size: Option<f64>,
    is: Option<bool>,
    #[serde(default)]
    list: Vec<Part>,
    pair: Option<(f64, Option<usize>)>,
    three: Option<[f64; 3]>,
    method: Option<Method>,
    either: Option<Either>,
    named: Option<BTreeMap<String, Length>>,
}

#[derive(Debug, PartialEq, Deserialize)]
struct Part {
    at: f64,
    #[serde(default)]
    inner: Option<Box<Part>>,
}

#[derive(Debug, PartialEq, Deserialize)]
struct Length(f64);

#[derive(Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Method {
    Plain,
    Wrapped(Part),
    Pair(u8, f64),
    Settings { step: f64, trials: Option<u32> },
}

#[derive(Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a word, a number or a list")]
enum Either {
    Word(String),
    Number(f64),
    List(Vec<u32>),
}

/// A value that was read, or the message and the place of what is wrong.
type Outcome<T> = Result<T, (String, Option<std::ops::Range<usize>>)>;

fn by_reader<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    let tree = DeTable::parse(text).map_err(|error| (error.message().to_owned(), error.span()))?;
    let reader = Reader::of_table(tree.get_ref(), tree.span());
    T::deserialize(reader).map_err(|misfit| (misfit.message().to_owned(), misfit.span()))
}

fn by_library<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    toml::from_str(text).map_err(|error| (error.message().to_owned(), error.span()))
}

fn agree<T: DeserializeOwned + Debug + PartialEq>(text: &str) -> Outcome<T> {
    let read = by_reader::<T>(text);
    assert_eq!(read, by_library(text), "{text}");
    read
}

const KEYS: [&str; 13] = [
    "name", "count", "large", "sign", "size", "is", "list", "pair", "three", "method", "either",
    "named", "unknown",
];

/// Values of all kinds that fit some key, and some that fit none.
const VALUES: [&str; 50] = [
    "''",
    "\"a\\u00e9\\n\"",
    "\"\"\"two\nlines\"\"\"",
    "0",
    "-1",
    "7",
    "300",
    "0xff",
    "0o17",
    "0b101",
    "1_000",
    "4294967296",
    "9223372036854775808",
    "18446744073709551616",
    "-9223372036854775809",
    "999999999999999999999999999999999999999999",
    "0.5",
    "-1e3",
    "1e999",
    "inf",
    "-inf",
    "true",
    "false",
    "[]",
    "[1]",
    "[1, 2, 3]",
    "[1.5, 2]",
    "['a', 2]",
    "[[1]]",
    "[1, -2]",
    "{}",
    "{ at = 1 }",
    "{ at = 'x' }",
    "{ inner = { at = 1 } }",
    "{ at = 1, inner = { at = true } }",
    "{ at = 1, more = 2 }",
    "[{ at = 1 }, { at = 2.5, inner = { at = 3 } }]",
    "[{ at = 1 }, {}]",
    "'plain'",
    "'wrapped'",
    "'pair'",
    "'settings'",
    "'none'",
    "{ plain = {} }",
    "{ plain = 1 }",
    "{ wrapped = { at = 1 } }",
    "{ pair = [1, 2] }",
    "{ pair = [1] }",
    "{ settings = { step = 1, trials = -1 } }",
    "{ settings = { step = 1, odd = 2, other = 3 } }",
];

#[test]
fn every_value_at_every_key_is_read_as_by_the_library() {
    let mut fit = 0;
    for key in KEYS {
        for value in VALUES {
            fit += usize::from(agree::<Document>(&format!("# above\n{key} = {value}\n")).is_ok());
        }
    }
    assert!((60..400).contains(&fit), "{fit} of the values fit their keys");
}

#[test]
fn values_in_tables_of_their_own_are_read_as_by_the_library() {
    for text in [
        "",
        "[method.settings]\nstep = 2",
        "[method]\nsettings.step = 2\nplain = {}",
        "[[list]]\nat = 1\n[[list]]\nat = 2\n[list.inner]\nat = 'x'",
        "[named]\na = 1\nb = 2.5\nc = 'x'",
        "list.at = 1",
        "method = { settings = { step = 1, trials = 5000000000 } }",
        "count = 1\ncount = 2",
    ] {
        let _ = agree::<Document>(text);
    }
    let _ = agree::<Part>("at = 1\nelsewhere = { odd = [1, 'a'], when = 1979-05-27 }");
    assert_eq!(agree::<Part>("at = 1").map(|part| part.at), Ok(1.0));
}

/// The library takes dates for tables; here they are dates, and fit nothing.
#[test]
fn dates_are_told_by_name() {
    let (message, place) = by_reader::<Document>("name = 'a'\nsize = 1979-05-27").unwrap_err();
    assert_eq!((message.as_str(), place), ("invalid type: date, expected f64", Some(18..28)));
}

proptest! {
    #[test]
    fn several_keys_are_read_as_by_the_library(entries in prop::collection::vec((0..KEYS.len(), 0..VALUES.len()), 0..6)) {
        let lines = entries.iter().map(|(key, value)| format!("{} = {}\n", KEYS[*key], VALUES[*value]));
        let _ = agree::<Document>(&lines.collect::<String>());
    }
}
