use crate::context::Context;
use crate::space::Space;
use crate::validity::Scratch;

/// Reads a valid configuration as people write it: one number per degree of freedom, separated by
/// blanks or commas, in the order of [`Space::dofs`]; returns it in stored form.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = Vec::new();
    for word in text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty())
    {
        q.push(word.parse().map_err(|_| format!("`{word}` found, a number expected"))?);
    }
    settle(cx, &mut q)?;
    Ok(q)
}

/// Brings a configuration into stored form and says what is wrong with it.
pub(super) fn settle(cx: &Context, q: &mut [f64]) -> Result<(), String> {
    let space: &Space = &cx.space;
    if q.len() != space.len() {
        let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
        let (found, expected) = (q.len(), space.len());
        return Err(format!("{found} values found, {expected} expected: {}", names.join(" ")));
    }
    space.canonicalize(q)?;
    if !space.within_bounds(q) {
        return Err(format!("{q:?} found, a configuration within the bounds expected"));
    }
    if !cx.validity.valid(q, &mut Scratch::new()) {
        let expected = "a valid configuration expected";
        return Err(format!(
            "{q:?} found, where the robot collides or leaves the bounds; {expected}"
        ));
    }
    Ok(())
}
