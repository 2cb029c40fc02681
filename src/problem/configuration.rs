use crate::space::Space;

/// Reads a configuration as people write it: one number per degree of freedom, separated by
/// blanks or commas, in the order of [`Space::dofs`]; returns it in stored form.
///
/// # Errors
/// Says what was found and what is expected.
pub fn parse_configuration(space: &Space, text: &str) -> Result<Vec<f64>, String> {
    let mut q = Vec::new();
    for word in text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty()) {
        q.push(word.parse().map_err(|_| format!("`{word}` found, a number expected"))?);
    }
    settle(space, &mut q)?;
    Ok(q)
}

/// Checks the number of values and brings them into stored form.
pub(super) fn settle(space: &Space, q: &mut [f64]) -> Result<(), String> {
    if q.len() != space.len() {
        let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
        let (found, expected) = (q.len(), space.len());
        return Err(format!("{found} values found, {expected} expected: {}", names.join(" ")));
    }
    space.canonicalize(q)
}
