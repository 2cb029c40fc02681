//! `.env`: `Boundary`, then `Multibodies N` and N bodies, passive or active.

use super::robot::{self, Robot};
use super::words::{Words, number};
use super::{Boundary, Geometry, Reader};
use crate::model::bodies::foreign::{ForeignBody, ForeignError};

/// The most characters of a boundary.
const TEXT_MAX: usize = 1000;

pub(super) struct Env {
    pub boundary: Boundary,
    pub obstacles: Vec<ForeignBody>,
    /// The older dialect's active body.
    pub robot: Option<Robot>,
}

pub(super) fn read(words: &mut Words, reader: &mut Reader) -> Result<Env, ForeignError> {
    words.keyword("Boundary")?;
    let boundary = boundary(words)?;
    words.keyword("Multibodies")?;
    let count = words.count("the number of bodies")?;
    let mut env = Env { boundary, obstacles: Vec::new(), robot: None };
    for body in 0..count {
        let kind = words.next(&format!("body {} of {count}, `Passive` or `Active`,", body + 1))?;
        match kind.to_ascii_lowercase().as_str() {
            // The library tests either for collisions; internal ones are not drawn.
            "passive" | "internal" => {
                let geometry = Geometry::read(words)?;
                if words.peek().is_some_and(|word| word.eq_ignore_ascii_case("fixed")) {
                    words.keyword("Fixed")?;
                }
                let pose = words.pose()?;
                let what = format!("obstacle {}", env.obstacles.len());
                env.obstacles.push(geometry.body(&what, words.path, pose, reader)?);
            }
            "active" if env.robot.is_some() => {
                return Err(words.error("a second active body found; one robot is supported"));
            }
            "active" => env.robot = Some(robot::read(words, reader)?),
            _ => {
                let expected = "`Passive`, `Internal` or `Active` expected";
                return Err(words.error(format!("`{kind}` not supported; {expected}")));
            }
        }
    }
    words.end(&format!("the end after {count} bodies"))?;
    Ok(env)
}

/// `Box [x:x; y:y; z:z]` or `Box2D [x:x; y:y]`, with blanks wherever, or in the oldest files the intervals without
/// brackets and with blanks between them, `Box x:x y:y z:z`.
fn boundary(words: &mut Words) -> Result<Boundary, ForeignError> {
    let kind = words.next("the kind of the boundary")?;
    let line = words.line();
    let expected = match kind.to_ascii_lowercase().as_str() {
        "box" => 2..=3,
        "box2d" => 2..=2,
        _ => {
            return Err(
                words.error(format!("a boundary `{kind}` is not supported; Box or Box2D is"))
            );
        }
    };
    let bracketed = words.peek().is_some_and(|word| word.starts_with('['));
    let text = if bracketed { in_brackets(words)? } else { bare(words)? };
    let mut intervals = Vec::new();
    for interval in text.split(';') {
        let ends = interval.split_once(':');
        let ends = ends.and_then(|(low, high)| Some([number(low)?, number(high)?]));
        match ends {
            Some([low, high]) if low < high => intervals.push([low, high]),
            _ => {
                let message = format!("`{interval}` found; an interval min:max expected");
                return Err(words.error(message));
            }
        }
    }
    if !expected.contains(&intervals.len()) {
        let message = format!("{} intervals found; {} expected", intervals.len(), expected.end());
        return Err(words.error(message));
    }
    Ok(Boundary { line, intervals })
}

/// What stands between the brackets, without blanks.
fn in_brackets(words: &mut Words) -> Result<String, ForeignError> {
    let mut text = String::new();
    while !text.ends_with(']') {
        text += words.next("the `]` of the boundary")?;
        if text.len() > TEXT_MAX {
            return Err(words.error(format!("`{text}` found; `[x:x; y:y; z:z]` expected")));
        }
    }
    Ok(text[1..text.len() - 1].to_owned())
}

/// The words up to `Multibodies` as intervals with `;` between them. Blanks may stand on either side of a colon.
fn bare(words: &mut Words) -> Result<String, ForeignError> {
    let mut text = String::new();
    while let Some(word) = words.peek().filter(|word| !word.eq_ignore_ascii_case("multibodies")) {
        let word = word.trim_end_matches(';');
        words.next("an interval min:max")?;
        if !(text.is_empty() || text.ends_with(':') || word.starts_with(':')) {
            text.push(';');
        }
        text += word;
        if text.len() > TEXT_MAX {
            return Err(words.error(format!("`{text}` found; `x:x y:y z:z` expected")));
        }
    }
    if text.is_empty() {
        return Err(words.error("a boundary without intervals found; `[x:x; y:y; z:z]` expected"));
    }
    Ok(text)
}
