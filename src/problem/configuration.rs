use crate::context::Context;

/// Reads a valid configuration as people write it: one number per degree of freedom, separated by
/// blanks or commas, in the order of [`Space::dofs`](crate::space::Space::dofs); returns it in stored form.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = Vec::new();
    for word in text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty())
    {
        q.push(word.parse().map_err(|_| format!("`{word}` found, a number expected"))?);
    }
    cx.accept(&mut q)?;
    Ok(q)
}
