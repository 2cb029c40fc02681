//! Text of files that is shown to people.
//!
//! Names, labels and values in messages come from files, which anyone may have written. Characters that would act on a
//! terminal rather than be seen (escape sequences, line breaks, marks that turn the direction of writing) are shown as
//! escapes such as `\u{1b}`. This is the one place that says which these are.

use std::borrow::Cow;

/// The text as one line that a terminal may show.
pub fn plain(text: &str) -> Cow<'_, str> {
    escape(text, acts)
}

/// The same of text that is laid out in lines and columns: line breaks and tabs stay. What comes from files has to be
/// made [`plain`] before it is put in.
pub fn plain_lines(text: &str) -> Cow<'_, str> {
    escape(text, |c| acts(c) && !matches!(c, '\n' | '\t'))
}

/// The text as one word, as a column of a table: blanks of all kinds are escaped, too.
pub fn plain_word(text: &str) -> Cow<'_, str> {
    escape(text, |c| acts(c) || c.is_whitespace())
}

/// Whether a terminal obeys the character, or shows nothing for it.
pub fn acts(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

fn escape(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            ' ' if is_escaped(c) => shown.extend(c.escape_unicode()),
            c if is_escaped(c) => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_sequences_are_shown_and_letters_stay() {
        assert_eq!(
            plain("a\u{1b}[31mb\r\n\u{9b}2J\u{202e}\u{61c}\u{200b}\u{7f}"),
            "a\\u{1b}[31mb\\r\\n\\u{9b}2J\\u{202e}\\u{61c}\\u{200b}\\u{7f}"
        );
        assert!(matches!(plain("Würfel 〒 \\u → \u{1f600}"), Cow::Borrowed(_)));
    }

    #[test]
    fn lines_stay_lines_and_words_stay_words() {
        assert_eq!(plain_lines("a\tb\nc\r\u{202e}"), "a\tb\nc\\r\\u{202e}");
        assert_eq!(plain_word("a b\tc\u{3000}d"), "a\\u{20}b\\tc\\u{3000}d");
        assert!(matches!(plain_word("a-b"), Cow::Borrowed(_)));
    }
}
