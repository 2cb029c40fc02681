//! `.path`: a line that begins with `VIZMO_PATH_FILE`, the number of robots, the number of configurations, then a configuration a line, as
//! Open-PPL writes it and Vizmo reads it.

use super::words::number;
use crate::math;
use crate::model::bodies::foreign::frames::euler;
use crate::space::{FactorKind, Space};
use std::f64::consts::PI;

/// With what the first line begins.
const FIRST_WORD: &str = "VIZMO_PATH_FILE";

/// Whether a text is a path of this format, by its first word.
pub(crate) fn is_parasol_path(text: &str) -> bool {
    text.split_whitespace().next() == Some(FIRST_WORD)
}

/// The configurations of a path in a space. Positions stand as they are, every angle as a fraction of π; a rotation in 3D is
/// three angles, about x, y and z, which together mean `Rz · Ry · Rx`. Before the numbers of a line the robot's index may stand, as in older files.
///
/// # Errors
/// The line, what was found there and what is expected.
pub(crate) fn read_parasol_path(
    text: &str,
    space: &Space,
) -> Result<Vec<Vec<f64>>, (usize, String)> {
    let mut lines = text.lines().enumerate().filter_map(|(index, line)| {
        let said = line.split_whitespace().take_while(|word| !word.starts_with('#'));
        let words: Vec<&str> = said.collect();
        (!words.is_empty()).then_some((index + 1, words))
    });
    let last_line = text.lines().count().max(1);
    let mut next =
        |what: &str| lines.next().ok_or_else(|| (last_line, format!("cut off; {what} expected")));
    let (line, words) = next("a line that begins with VIZMO_PATH_FILE")?;
    if words[0] != FIRST_WORD {
        return Err((line, format!("`{}` found; `{FIRST_WORD}` expected", words[0])));
    }
    let count = |what: &str, next: &mut dyn FnMut(&str) -> Result<_, (usize, String)>| {
        let (line, words): (usize, Vec<&str>) = next(what)?;
        match (&words[..], words[0].parse::<usize>()) {
            ([_], Ok(count)) => Ok((line, count)),
            _ => Err((line, format!("`{}` found; {what} expected", words.join(" ")))),
        }
    };
    let (line, robots) = count("the number of robots, 1,", &mut next)?;
    if robots != 1 {
        return Err((line, format!("{robots} robots found; 1 expected")));
    }
    let (_, configurations) = count("the number of configurations", &mut next)?;
    let mut path = Vec::new();
    for _ in 0..configurations {
        let found = path.len();
        let what = format!("{configurations} configurations, of which {found} were found,");
        let (line, words) = next(&what)?;
        path.push(configuration(&words, space).map_err(|message| (line, message))?);
    }
    match lines.next() {
        None => Ok(path),
        Some((line, words)) => {
            let found = words.join(" ");
            Err((
                line,
                format!("`{found}` found after {configurations} configurations; nothing expected"),
            ))
        }
    }
}

fn configuration(words: &[&str], space: &Space) -> Result<Vec<f64>, String> {
    let expected = space.cube_dimensions();
    let words = match words.split_first() {
        Some((robot, rest)) if rest.len() == expected && *robot == "0" => rest,
        _ => words,
    };
    if words.len() != expected {
        return Err(format!("{} numbers found; {expected} expected", words.len()));
    }
    let mut values = Vec::with_capacity(expected);
    for word in words {
        let finite = || format!("`{word}` found; a finite number expected");
        values.push(number(word).ok_or_else(finite)?);
    }
    let mut values = values.into_iter();
    let mut value = || values.next().unwrap_or_default();
    let mut q = Vec::with_capacity(space.len());
    for factor in space.factors() {
        match factor.kind {
            FactorKind::Rotation => q.extend(euler([value(), value(), value()])),
            FactorKind::Angle => q.push(math::wrap_angle(value() * PI)),
            FactorKind::Real { .. } if space.dofs()[factor.at].unit == "rad" => {
                q.push(value() * PI);
            }
            FactorKind::Real { .. } => q.push(value()),
        }
    }
    Ok(q)
}
