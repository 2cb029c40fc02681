//! The words of a scene file, each with its line. `#` begins a comment.

use crate::model::bodies::foreign::ForeignError;
use crate::model::bodies::foreign::frames::euler;
use crate::scene::{LENGTH_MAX, Pose};
use std::path::Path;

/// The most words in one option, such as a colour's four numbers.
const OPTION_WORDS_MAX: usize = 8;

pub(super) struct Words<'a> {
    pub path: &'a Path,
    words: Vec<(usize, &'a str)>,
    at: usize,
    last_line: usize,
}

impl<'a> Words<'a> {
    pub fn new(path: &'a Path, text: &'a str) -> Words<'a> {
        let mut words = Vec::new();
        let mut last_line = 1;
        for (index, line) in text.lines().enumerate() {
            last_line = index + 1;
            let said = line.split_whitespace().take_while(|word| !word.starts_with('#'));
            words.extend(said.map(|word| (last_line, word)));
        }
        Words { path, words, at: 0, last_line }
    }

    /// The line of the last word taken.
    pub fn line(&self) -> usize {
        match self.at.checked_sub(1).and_then(|before| self.words.get(before)) {
            Some((line, _)) => *line,
            None => 1,
        }
    }

    pub fn error(&self, message: impl Into<String>) -> ForeignError {
        ForeignError::line(self.path, self.line(), message)
    }

    pub fn peek(&self) -> Option<&'a str> {
        self.words.get(self.at).map(|(_, word)| *word)
    }

    pub fn next(&mut self, what: &str) -> Result<&'a str, ForeignError> {
        match self.words.get(self.at) {
            Some((_, word)) => {
                self.at += 1;
                Ok(word)
            }
            None => {
                let message = format!("cut off; {what} expected");
                Err(ForeignError::line(self.path, self.last_line, message))
            }
        }
    }

    /// Takes a word whatever its case.
    pub fn keyword(&mut self, word: &str) -> Result<(), ForeignError> {
        let found = self.next(&format!("`{word}`"))?;
        if found.eq_ignore_ascii_case(word) {
            return Ok(());
        }
        Err(self.error(format!("`{found}` found; `{word}` expected")))
    }

    pub fn end(&mut self, what: &str) -> Result<(), ForeignError> {
        match self.words.get(self.at) {
            None => Ok(()),
            Some((_, word)) => {
                self.at += 1;
                Err(self.error(format!("`{word}` found; {what} expected")))
            }
        }
    }

    pub fn count(&mut self, what: &str) -> Result<usize, ForeignError> {
        let word = self.next(what)?;
        word.parse().map_err(|_| self.error(format!("`{word}` found; {what} expected")))
    }

    /// A finite number, no larger than a length may be.
    pub fn number(&mut self, what: &str) -> Result<f64, ForeignError> {
        let word = self.next(what)?;
        number(word).ok_or_else(|| self.error(format!("`{word}` found; {what} expected")))
    }

    /// `x y z` and degrees about X, Y and Z.
    pub fn pose(&mut self) -> Result<Pose, ForeignError> {
        let mut translation = [0.0; 3];
        for value in &mut translation {
            *value = self.number("x y z of a pose")?;
        }
        let mut half_turns = [0.0; 3];
        for value in &mut half_turns {
            *value = self.number("degrees about X, Y and Z of a pose")? / 180.0;
        }
        Ok(Pose { translation, rotation: euler(half_turns) })
    }

    /// The option that comes next, if one does: `-` and a letter, up to the closing bracket, without
    /// blanks.
    pub fn option(&mut self) -> Result<Option<String>, ForeignError> {
        let is_option = |word: &str| {
            word.strip_prefix('-')
                .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_alphabetic()))
        };
        if !self.peek().is_some_and(is_option) {
            return Ok(None);
        }
        let mut option = String::new();
        for _ in 0..OPTION_WORDS_MAX {
            let word = self.next("the `)` of an option")?;
            option += word;
            if word.ends_with(')') {
                return Ok(Some(option));
            }
        }
        Err(self.error("an option without its `)`"))
    }
}

pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.abs() <= LENGTH_MAX)
}
