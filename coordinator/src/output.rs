//! What the program prints: results on standard output, notes about the work on standard error.
//!
//! Output that is lost, on a full disk or a terminal that hung up, is a failure of the program, which
//! [`lost`] reports at its end. A reader that has closed the pipe has read enough: that is no failure, and ends the
//! program quietly. Notes that nobody can read change nothing.
//!
//! Names and labels come from files, which may be anybody's. Characters that would move a terminal's cursor, change
//! its colours or the direction of its text are printed as escapes such as `\u{1b}`.

use crate::exit::Failure;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::{self, Display, Write as _};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};

/// Why output was lost first, if any was.
static LOST: Mutex<Option<String>> = Mutex::new(None);

/// Prints lines on standard output, escaped, and a line break behind them. Whether somebody still reads: if not,
/// there is no use in printing more.
pub(crate) fn line(text: impl Display) -> bool {
    let text = text.to_string();
    print(format!("{}\n", escape(&text, keeps_layout)).as_bytes())
}

/// Prints an object as JSON on a line of standard output. Returns as [`line`].
pub(crate) fn json(value: &impl Serialize) -> bool {
    match serde_json::to_string(value) {
        // JSON has an escape of its own for every character.
        Ok(text) => {
            let mut line = String::with_capacity(text.len() + 1);
            for c in text.chars() {
                if is_harmful(c) {
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
        print(escape(text, keeps_layout).as_bytes())
    } else {
        print(text.as_bytes())
    }
}

/// Prints lines on standard error, escaped. Nobody may be there to read them.
pub(crate) fn note(text: impl Display) {
    let text = text.to_string();
    let text = format!("{}\n", escape(&text, keeps_layout));
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

/// A name or label as one word of a line: with all characters escaped that are not plain text, line breaks too.
pub(crate) struct Plain<'a>(pub &'a str);

impl Display for Plain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&escape(self.0, |_| false))
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

/// Characters that lay text out without moving over what is there.
fn keeps_layout(c: char) -> bool {
    matches!(c, '\n' | '\t')
}

/// Control characters, and those that change in which order others are shown.
fn is_harmful(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

fn escape(text: &str, is_kept: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_harmful = |c: char| is_harmful(c) && !is_kept(c);
    if !text.contains(is_harmful) {
        return text.into();
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_harmful(c) {
            escaped.extend(c.escape_default());
        } else {
            escaped.push(c);
        }
    }
    escaped.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_printed_as_it_is_and_what_acts_on_a_terminal_as_escapes() {
        assert_eq!(escape("a\tb\nÄ→ \u{1f600}", keeps_layout), "a\tb\nÄ→ \u{1f600}");
        assert_eq!(
            escape("\x1b[31m\r\u{9b}x\u{7f}", keeps_layout),
            "\\u{1b}[31m\\r\\u{9b}x\\u{7f}"
        );
        assert_eq!(escape("a\u{202e}b", keeps_layout), "a\\u{202e}b");
        assert_eq!(Plain("a\nb").to_string(), "a\\nb");
        assert_eq!(format!("{:<5}|", Plain("ab")), "ab   |");
    }
}
