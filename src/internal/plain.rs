//! Text of files that is shown to people.

use std::borrow::Cow;

/// The text as a terminal may show it: characters that would act on the terminal rather than be seen (escape
/// sequences, line breaks, marks that turn the direction of writing) become escapes such as `\u{1b}`.
///
/// Names and values in messages come from files, which anyone may have written.
pub(crate) fn plain(text: &str) -> Cow<'_, str> {
    if !text.chars().any(acts) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if acts(c) { shown.extend(c.escape_default()) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}

/// Whether a terminal obeys the character, or shows nothing for it.
fn acts(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_sequences_are_shown_and_letters_stay() {
        assert_eq!(
            plain("a\u{1b}[31mb\r\n\u{9b}2J\u{202e}"),
            "a\\u{1b}[31mb\\r\\n\\u{9b}2J\\u{202e}"
        );
        assert!(matches!(plain("Würfel 〒 \\u"), Cow::Borrowed(_)));
    }
}
