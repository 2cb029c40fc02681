//! What the program prints: results on standard output, notes about the work on standard error.
//!
//! Output that is lost, on a full disk or a terminal that hung up, is a failure of the program, which
//! [`lost`] reports at its end. A reader that has closed the pipe has read enough: that is no failure, and ends the
//! program quietly. Notes that nobody can read change nothing.
//!
//! Names and labels come from files, which may be anybody's. Characters that would move a terminal's cursor, change
//! its colours or the direction of its text, or break a line in two, are printed as escapes such as `\u{1b}`
//! ([`roadmill::internal::plain`] says which).

use crate::exit::Failure;
use roadmill::internal::plain::{acts, plain, plain_lines, plain_word};
use serde::Serialize;
use std::fmt::{self, Display, Write as _};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};

/// Why output was lost first, if any was.
static LOST: Mutex<Option<String>> = Mutex::new(None);

/// Prints a line on standard output, escaped. Whether somebody still reads: if not, there is no use in printing more.
pub(crate) fn line(text: impl Display) -> bool {
    print(format!("{}\n", plain(&text.to_string())).as_bytes())
}

/// Prints lines on standard output, escaped, and a line break behind the last. Names and labels in them have to be
/// [`Plain`] already: nobody could tell their line breaks from the text's. Returns as [`line`].
pub(crate) fn lines(text: impl Display) -> bool {
    print(format!("{}\n", plain_lines(&text.to_string())).as_bytes())
}

/// Prints an object as JSON on a line of standard output. Returns as [`line`].
pub(crate) fn json(value: &impl Serialize) -> bool {
    match serde_json::to_string(value) {
        // JSON has an escape of its own for every character.
        Ok(text) => {
            let mut line = String::with_capacity(text.len() + 1);
            for c in text.chars() {
                if acts(c) {
                    let _ = write!(line, "\\u{:04x}", u32::from(c));
                } else {
                    line.push(c);
                }
            }
            line.push('\n');
            print(line.as_bytes())
        }
        Err(error) => note_loss(&error.into()),
    }
}

/// Prints text that is to be kept, such as a path in CSV, on standard output: byte for byte, but escaped where
/// that is a terminal. Returns as [`line`].
pub(crate) fn data(text: &str) -> bool {
    if io::stdout().is_terminal() {
        print(plain_lines(text).as_bytes())
    } else {
        print(text.as_bytes())
    }
}

/// Prints a file's contents on standard output, byte for byte; text as [`data`] does. Returns as [`line`].
pub(crate) fn bytes(contents: &[u8]) -> bool {
    match std::str::from_utf8(contents) {
        Ok(text) => data(text),
        Err(_) => print(contents),
    }
}

/// Prints a line for people: on standard output, escaped, or on standard error where standard output is for objects alone.
pub(crate) fn told(text: impl Display, is_json: bool) {
    match is_json {
        true => note(text),
        false => {
            line(text);
        }
    }
}

/// Prints a line on standard error, escaped. Nobody may be there to read it.
pub(crate) fn note(text: impl Display) {
    let text = format!("{}\n", plain(&text.to_string()));
    // In one piece, so that lines of several processes do not mix.
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Takes note of the result of somebody else's printing on standard output.
pub(crate) fn printed(result: io::Result<()>) -> bool {
    match result {
        Ok(()) => true,
        Err(error) if error.kind() == ErrorKind::BrokenPipe => false,
        Err(error) => note_loss(&error),
    }
}

/// Prints what is still to be printed; the failure if anything that was to be printed on standard output is lost.
pub(crate) fn lost() -> Option<Failure> {
    printed(io::stdout().flush());
    let lost = LOST.lock().unwrap_or_else(PoisonError::into_inner).take();
    lost.map(|why| Failure::system(format!("cannot write to standard output: {why}")))
}

/// A name or label in a line: with all characters escaped that are not plain text, line breaks too.
pub(crate) struct Plain<'a>(pub &'a str);

impl Display for Plain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&plain(self.0))
    }
}

/// A name or label as one word, as a column of a table: blanks are escaped, too.
pub(crate) struct Word<'a>(pub &'a str);

impl Display for Word<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&plain_word(self.0))
    }
}

fn print(bytes: &[u8]) -> bool {
    let mut out = io::stdout().lock();
    printed(out.write_all(bytes).and_then(|()| out.flush()))
}

fn note_loss(error: &io::Error) -> bool {
    let mut lost = LOST.lock().unwrap_or_else(PoisonError::into_inner);
    lost.get_or_insert_with(|| error.to_string());
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_padded_and_words_have_no_blanks() {
        assert_eq!(Plain("a\nb").to_string(), "a\\nb");
        assert_eq!(format!("{:<5}|", Plain("ab")), "ab   |");
        assert_eq!(Word("a b").to_string(), "a\\u{20}b");
    }
}
