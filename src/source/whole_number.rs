//! What is wrong with a setting that must be a whole number.

use super::{Misfit, Step, place_of};
use std::fmt::Display;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where in the text of a problem file something else stands than the whole number that is expected there, and what is to be
/// said of it: the setting by its key, what was found, and the range. `None` of what is wrong in another way.
///
/// The library says neither key nor range. The range is that of the type in which a setting is kept; the method that the
/// setting belongs to may expect less.
pub(super) fn complaint(tree: &DeTable, misfit: &Misfit) -> Option<(usize, String)> {
    let message = misfit.message();
    let kinds = ["invalid value: ", "invalid type: "];
    let rest = kinds.iter().find_map(|kind| message.strip_prefix(kind))?;
    let (found, expected) = rest.split_once(", expected ")?;
    let expected = match expected {
        "u8" => range(u8::MIN, u8::MAX),
        "u16" => range(u16::MIN, u16::MAX),
        "u32" => range(u32::MIN, u32::MAX),
        "u64" | "usize" => range(u64::MIN, u64::MAX),
        "i32" => range(i32::MIN, i32::MAX),
        "i64" => range(i64::MIN, i64::MAX),
        words if words.contains("a whole number") => words.to_owned(),
        _ => return None,
    };
    let (offset, mut place) = (misfit.span()?.start, Vec::new());
    let is_there = tree.iter().any(|(key, value)| {
        let key = Step::Key(key.get_ref());
        leads_to(offset, key, value, &mut place)
    });
    let found = in_file(found);
    is_there.then(|| (offset, format!("{}: {found} found; {expected} expected", place_of(&place))))
}

fn range(least: impl Display, most: impl Display) -> String {
    format!("a whole number from {least} to {most}")
}

/// A value as a problem file has it, of how the library names it: "integer `5`", "string \"some\"", "map".
fn in_file(named: &str) -> &str {
    let quoted = named.split_once('`').and_then(|(_, rest)| rest.split_once('`'));
    match (quoted, named) {
        (Some((value, _)), _) => value,
        (None, "map") => "a table",
        (None, "date") => "a date",
        (None, "sequence") => "an array",
        (None, other) => other.strip_prefix("string ").unwrap_or(other),
    }
}

/// Whether the value at the end of a step begins at `offset` or holds one that does; then `place` goes on to the innermost.
fn leads_to<'a>(
    offset: usize,
    step: Step<'a>,
    value: &'a Spanned<DeValue>,
    place: &mut Vec<Step<'a>>,
) -> bool {
    place.push(step);
    let is_within = match value.get_ref() {
        DeValue::Table(table) => table.iter().any(|(key, value)| {
            let key = Step::Key(key.get_ref());
            leads_to(offset, key, value, place)
        }),
        DeValue::Array(array) => array.iter().enumerate().any(|(index, value)| {
            let index = Step::Index(index);
            leads_to(offset, index, value, place)
        }),
        _ => false,
    };
    let is_it = is_within || value.span().start == offset;
    if !is_it {
        place.pop();
    }
    is_it
}
