use super::ConfigurationSpec;
use crate::context::Context;
use std::collections::BTreeMap;

/// Reads a valid configuration as people write it: one number per degree of freedom, separated by
/// blanks or commas, in the order of [`Space::dofs`](crate::space::Space::dofs), or `NAME=NUMBER` for each in any order;
/// returns it in stored form.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = numbers(cx, text)?;
    cx.accept(&mut q)?;
    Ok(q)
}

/// The same of a configuration that need not be valid.
///
/// # Errors
/// Says what was found and what is expected.
pub fn configuration_at_all(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let mut q = numbers(cx, text)?;
    cx.stored(&mut q)?;
    Ok(q)
}

/// The values that a text gives, one per degree of freedom or each with its name.
fn numbers(cx: &Context, text: &str) -> Result<Vec<f64>, String> {
    let (mut q, mut named) = (Vec::new(), BTreeMap::new());
    let number =
        |word: &str| word.parse::<f64>().map_err(|_| format!("`{word}` found, a number expected"));
    for word in text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty())
    {
        match word.split_once('=') {
            Some((name, value)) => {
                if named.insert(name.to_owned(), number(value)?).is_some() {
                    return Err(format!("`{name}` found twice, one value of each name expected"));
                }
            }
            None => q.push(number(word)?),
        }
    }
    if !named.is_empty() {
        if let Some(first) = q.first() {
            return Err(format!(
                "{first} found without a name, NAME=NUMBER as the others expected"
            ));
        }
        let spec = ConfigurationSpec::Named { state: None, values: named };
        q = spec.values(&cx.space, &[]).map_err(|(_, message)| message)?;
    }
    Ok(q)
}
