//! The text of a problem file, and errors that say where in it something is wrong.

mod error;
mod names;

pub use error::ProblemError;
pub(crate) use names::{fits, fitting, fitting_name};

use crate::digest::SourceFile;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// One step on the way to a value in the file.
#[derive(Clone, Copy)]
pub(crate) enum Step<'a> {
    Key(&'a str),
    Index(usize),
}
/// The file at hand, for saying where something is wrong.
pub(crate) struct Source<'a> {
    pub path: &'a Path,
    text: &'a str,
    tree: DeTable<'a>,
    /// The files read so far, this one first.
    pub files: RefCell<Vec<SourceFile>>,
}

impl<'a> Source<'a> {
    /// Parses the file's text.
    pub fn new(path: &'a Path, text: &'a str) -> Result<Source<'a>, ProblemError> {
        let tree = DeTable::parse(text).map_err(|error| syntax_error(path, text, &error))?;
        let files = RefCell::new(vec![SourceFile::named(path, text.as_bytes())]);
        Ok(Source { path, text, tree: tree.into_inner(), files })
    }

    /// Reads the tables that `T` describes; others are not looked at.
    pub fn tables<T: DeserializeOwned>(&self) -> Result<T, ProblemError> {
        toml::from_str(self.text).map_err(|error| syntax_error(self.path, self.text, &error))
    }

    /// Whether the file has this key at its top.
    pub fn has(&self, key: &str) -> bool {
        self.tree.contains_key(key)
    }

    /// Complains of the first key at the top of the file that is none of these.
    pub fn expect_keys(&self, keys: &[&str]) -> Result<(), ProblemError> {
        let unknown = self.tree.keys().filter(|key| !keys.contains(&&**key.get_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let line = line_of(self.text, key.span().start);
        let listed: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
        let message =
            format!("unknown field `{}`, expected one of {}", key.get_ref(), listed.join(", "));
        Err(ProblemError::line(self.path, line, message))
    }

    /// Notes that a file was read.
    pub fn read(&self, file: SourceFile) {
        let mut files = self.files.borrow_mut();
        if !files.contains(&file) {
            files.push(file);
        }
    }

    /// An error at the deepest step of `place` that the file has.
    pub fn error(&self, place: &[Step], message: String) -> ProblemError {
        let message = format!("{}: {message}", place_of(place));
        match self.find(place) {
            Some(offset) => ProblemError::line(self.path, line_of(self.text, offset), message),
            None => ProblemError::file(self.path, message),
        }
    }

    fn find(&self, place: &[Step]) -> Option<usize> {
        let (first, rest) = place.split_first()?;
        let Step::Key(name) = first else { return None };
        let mut value = self.tree.get(*name)?;
        let mut offset = value.span().start;
        for step in rest {
            let next = match (step, value.get_ref()) {
                (Step::Key(name), DeValue::Table(table)) => table.get(*name),
                (Step::Index(index), DeValue::Array(array)) => array.get(*index),
                _ => None,
            };
            let Some(next) = next else { break };
            value = next;
            offset = value.span().start;
        }
        Some(offset)
    }
}

/// A place in a file for people to read, such as `obstacles[3].shape`.
pub(crate) fn place_of(place: &[Step]) -> String {
    let mut key = String::new();
    for step in place {
        match step {
            Step::Key(name) if key.is_empty() => key.push_str(name),
            Step::Key(name) => key = format!("{key}.{name}"),
            Step::Index(index) => key = format!("{key}[{index}]"),
        }
    }
    key
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())].iter().filter(|byte| **byte == b'\n').count()
}

fn syntax_error(path: &Path, text: &str, error: &toml::de::Error) -> ProblemError {
    let message = error.message().to_owned();
    match error.span() {
        Some(span) => ProblemError::line(path, line_of(text, span.start), message),
        None => ProblemError::file(path, message),
    }
}

/// A value as TOML writes it, within one line.
pub(crate) fn value<T: Serialize + ?Sized>(of: &T) -> String {
    toml::Value::try_from(of).expect("problems hold what TOML can write").to_string()
}
