//! Names that problem files give to problems, links and joints.

/// Whether something may have the name.
pub(crate) fn fits(name: &str) -> bool {
    let fit = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    !name.is_empty() && name.chars().all(fit)
}

/// The name with other characters replaced by `-`.
pub(crate) fn fitting(name: &str) -> String {
    let fit = |c: char| if fits(c.encode_utf8(&mut [0; 4])) { c } else { '-' };
    name.chars().map(fit).collect()
}

/// A name for a problem, which becomes that of a folder, as near to the given one as may be.
pub(crate) fn fitting_name(name: &str) -> String {
    let fitting = fitting(name);
    let mut end = fitting.len().min(100);
    while !fitting.is_char_boundary(end) {
        end -= 1;
    }
    let fitting = fitting[..end].trim_start_matches('.');
    if fitting.is_empty() { "scene".to_owned() } else { fitting.to_owned() }
}
