//! Where a problem comes from: how files are opened and their bytes become text, the text of a problem file or the
//! values of a program, and errors that say where in it something is wrong.

mod error;
mod file;
mod names;
mod text;
mod values;
#[cfg(test)]
mod values_tests;
mod whole_number;
mod xml;

pub use error::ProblemError;
pub(crate) use file::read_file;
pub(crate) use names::{fits, fitting, fitting_name};
pub(crate) use text::{NoText, text_of, xml_text};
pub(crate) use values::{Misfit, Reader};
pub(crate) use xml::too_many_attributes;

use crate::digest::SourceFile;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml::ser::ValueSerializer;

/// One step on the way to a value in the file.
#[derive(Clone, Copy)]
pub(crate) enum Step<'a> {
    Key(&'a str),
    Index(usize),
}
/// What a problem comes from, for saying where something is wrong: a problem file, or a program that gives values.
pub(crate) struct Source<'a> {
    /// Where the relative paths of other files start.
    pub folder: &'a Path,
    /// The problem file, if there is one.
    file: Option<File<'a>>,
    /// The files read so far, first the problem's own.
    pub files: RefCell<Vec<SourceFile>>,
    /// The configurations that files of the model give names to, for the query to use.
    pub states: RefCell<Vec<NamedState>>,
    /// The end effectors that files of the model name, for poses that name no link.
    pub hands: RefCell<Vec<Hand>>,
}

/// An end effector of a robot.
pub(crate) struct Hand {
    /// Its name.
    pub name: String,
    /// The link on which it is mounted.
    pub link: String,
}

/// The link that is meant where none is named: that on which the only end effector is mounted.
///
/// # Errors
/// Says what was found and what is expected.
pub(crate) fn link_of_hand(hands: &[Hand]) -> Result<&str, String> {
    match hands {
        [hand] => Ok(&hand.link),
        [] => Err("no link found; the name of one expected, as no end effector of an SRDF is \
                   mounted on the links that move"
            .to_owned()),
        _ => {
            let listed: Vec<String> = hands
                .iter()
                .map(|Hand { name, link }| format!("`{link}` of the end effector `{name}`"))
                .collect();
            Err(format!("no link found; one of several expected: {}", listed.join(", ")))
        }
    }
}

/// A configuration, or some of its values, under a name.
pub(crate) struct NamedState {
    /// Its name, unique within its group.
    pub name: String,
    /// The group of values that it is about; empty if none is named.
    pub group: String,
    /// Whether that is the group for which is planned.
    pub is_planned: bool,
    /// Values by the names of degrees of freedom, or of joints that have none.
    pub values: BTreeMap<String, f64>,
}

impl NamedState {
    /// What tells it from states of other groups.
    fn whole_name(&self) -> String {
        let NamedState { name, group, .. } = self;
        if group.is_empty() { name.clone() } else { format!("{group}/{name}") }
    }
}

/// The state that is meant by `NAME` or `GROUP/NAME`: of several of one name that of the group for which is planned.
///
/// # Errors
/// Says what was found and what is expected.
pub(crate) fn state_of<'s>(states: &'s [NamedState], name: &str) -> Result<&'s NamedState, String> {
    let is_meant = |state: &&NamedState| state.name == name || state.whole_name() == name;
    let mut meant: Vec<&NamedState> = states.iter().filter(is_meant).collect();
    if meant.iter().any(|state| state.is_planned) {
        meant.retain(|state| state.is_planned);
    }
    let listed = |states: &mut dyn Iterator<Item = &NamedState>| {
        let names: Vec<String> = states.map(NamedState::whole_name).collect();
        if names.is_empty() { "none, as no SRDF names any".to_owned() } else { names.join(", ") }
    };
    match meant[..] {
        [state] => Ok(state),
        [] => Err(format!(
            "`{name}` found; the name of a state expected: {}",
            listed(&mut states.iter())
        )),
        _ => Err(format!(
            "`{name}` found, which several groups have; one of them expected: {}",
            listed(&mut meant.into_iter())
        )),
    }
}

/// A problem file.
struct File<'a> {
    path: &'a Path,
    text: &'a str,
    tree: Spanned<DeTable<'a>>,
}

impl<'a> Source<'a> {
    /// Parses the text of a problem file.
    pub fn of_text(path: &'a Path, text: &'a str) -> Result<Source<'a>, ProblemError> {
        let tree = DeTable::parse(text)
            .map_err(|error| complaint(path, text, error.message(), error.span()))?;
        let files = RefCell::new(vec![SourceFile::named(path, text.as_bytes())]);
        let folder = path.parent().unwrap_or(Path::new(""));
        let file = Some(File { path, text, tree });
        Ok(Source { folder, file, files, states: RefCell::default(), hands: RefCell::default() })
    }

    /// A program that gives values, and no problem file.
    pub fn of_values(folder: &'a Path) -> Source<'a> {
        Source {
            folder,
            file: None,
            files: RefCell::default(),
            states: RefCell::default(),
            hands: RefCell::default(),
        }
    }

    /// Reads the tables of the file that `T` describes; others are not looked at.
    pub fn tables<T: DeserializeOwned>(&self) -> Result<T, ProblemError> {
        let nothing = DeTable::new();
        let Some(File { path, text, tree }) = &self.file else {
            return T::deserialize(Reader::of_table(&nothing, 0..0))
                .map_err(|misfit| complaint(Path::new(""), "", misfit.message(), misfit.span()));
        };
        let reader = Reader::of_table(tree.get_ref(), tree.span());
        T::deserialize(reader).map_err(|misfit| {
            match whole_number::complaint(tree.get_ref(), &misfit) {
                Some((offset, message)) => ProblemError::line(path, line_of(text, offset), message),
                None => complaint(path, text, misfit.message(), misfit.span()),
            }
        })
    }

    /// The name of the file without folder and extension; empty where there is no file.
    pub fn stem(&self) -> String {
        let stem = self.file.as_ref().and_then(|file| file.path.file_stem());
        stem.map_or_else(String::new, |stem| stem.to_string_lossy().into())
    }

    /// Whether the file has this key at its top.
    pub fn has(&self, key: &str) -> bool {
        self.file.as_ref().is_some_and(|file| file.tree.get_ref().contains_key(key))
    }

    /// Complains of the first key at the top of the file that is none of these.
    pub fn expect_keys(&self, keys: &[&str]) -> Result<(), ProblemError> {
        let Some(File { path, text, tree }) = &self.file else { return Ok(()) };
        let unknown = tree.get_ref().keys().filter(|key| !keys.contains(&&**key.get_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let line = line_of(text, key.span().start);
        let listed: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
        let message =
            format!("unknown field `{}`, expected one of {}", key.get_ref(), listed.join(", "));
        Err(ProblemError::line(path, line, message))
    }

    /// Notes that a file was read.
    pub fn read(&self, file: SourceFile) {
        let mut files = self.files.borrow_mut();
        if !files.contains(&file) {
            files.push(file);
        }
    }

    /// An error at `place`: where there is a file, with the line of the deepest step that the file has.
    pub fn error(&self, place: &[Step], message: String) -> ProblemError {
        let message = format!("{}: {message}", place_of(place));
        let Some(file) = &self.file else { return ProblemError::pathless(message) };
        match file.find(place) {
            Some(offset) => ProblemError::line(file.path, line_of(file.text, offset), message),
            None => ProblemError::file(file.path, message),
        }
    }
}

impl File<'_> {
    /// Where in the text the deepest step of `place` is that the file has.
    fn find(&self, place: &[Step]) -> Option<usize> {
        let (first, rest) = place.split_first()?;
        let Step::Key(name) = first else { return None };
        let mut value = self.tree.get_ref().get(*name)?;
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

/// What is wrong with the text of a problem file, in the words of problems.
fn complaint(path: &Path, text: &str, message: &str, place: Option<Range<usize>>) -> ProblemError {
    let message = match message {
        // What the library calls a variant is a method or a shape here, the only key of a table.
        "invalid type: unit variant, expected newtype variant" => {
            let name = place.clone().and_then(|place| text.get(place)).unwrap_or("name");
            let name = name.trim_matches(['"', '\'']);
            format!(
                "`{name}` alone found; a table with its settings expected, as {{ {name} = {{ … }} }}"
            )
        }
        "wanted exactly 1 element, found 0 elements" => {
            "an empty table found; one with one key, which says what it is, expected".to_owned()
        }
        "wanted exactly 1 element, more than 1 element" => {
            "a table with several keys found; one with one key, which says what it is, expected"
                .to_owned()
        }
        other => other.to_owned(),
    };
    match place {
        Some(place) => ProblemError::line(path, line_of(text, place.start), message),
        None => ProblemError::file(path, message),
    }
}

/// A method, which is an inline table of one key, as that key and its value: as it stands in a table of its own.
pub(crate) fn setting<T: Serialize + ?Sized>(method: &T) -> String {
    let table = value(method);
    let inside = table.strip_prefix('{').and_then(|rest| rest.strip_suffix('}'));
    inside.expect("a method is a table").trim().to_owned()
}

/// A value as TOML writes it, within one line.
pub(crate) fn value<T: Serialize + ?Sized>(of: &T) -> String {
    let mut text = String::new();
    // Not by way of `toml::Value`, which holds no integer above 2⁶³.
    of.serialize(ValueSerializer::new(&mut text)).expect("problems hold what TOML can write");
    text
}
