use crate::context::Context;

/// Reads a valid configuration as people write it: one number per degree of freedom, separated by
/// blanks or commas, in the order of [`Space::dofs`](crate::space::Space::dofs); returns it in stored form.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = numbers(text)?;
    cx.accept(&mut q)?;
    Ok(q)
}

/// The same of a configuration that need not be valid.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration_at_all(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = numbers(text)?;
    cx.stored(&mut q)?;
    Ok(q)
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    words
        .map(|word| word.parse().map_err(|_| format!("`{word}` found, a number expected")))
        .collect()
}
