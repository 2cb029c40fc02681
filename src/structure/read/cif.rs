//! The syntax of CIF 1.1 (Hall, Allen & Brown 1991; IUCr): blocks of tables, as rows with their lines.

use super::super::StructureError;

/// A value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Value<'a> {
    pub text: &'a str,
    is_quoted: bool,
}

impl<'a> Value<'a> {
    /// The text; `None` where the file has `.` (none) or `?` (unknown).
    pub fn known(self) -> Option<&'a str> {
        let is_known = self.is_quoted || !matches!(self.text, "." | "?");
        is_known.then_some(self.text)
    }
}

/// A row of a table.
pub(super) struct Row<'a, 'b> {
    /// How many blocks began before this one.
    pub block: usize,
    /// How many tables began before this one.
    pub table: usize,
    /// Names of the columns with category: `_atom_site.id`.
    pub columns: &'b [&'a str],
    pub values: &'b [Value<'a>],
    /// The line on which it begins.
    pub line: usize,
}

#[derive(Clone, Copy)]
enum Token<'a> {
    Data,
    Loop,
    Tag(&'a str),
    Value(Value<'a>),
}

/// Tells `take` every row of every table, in the order of the file. Pairs of name and value that follow one another in
/// one category are a table of one row.
pub(super) fn rows<'a>(
    text: &'a str,
    mut take: impl FnMut(&Row<'a, '_>) -> Result<(), StructureError>,
) -> Result<(), StructureError> {
    let mut tokens = Tokens { text, at: 0, line: 1 };
    let (mut block, mut table) = (0, 0);
    let mut columns: Vec<&str> = Vec::new();
    let mut values: Vec<Value> = Vec::new();
    let mut row_line = 1;
    let mut next = tokens.next()?;
    while let Some((line, token)) = next {
        match token {
            Token::Data => {
                block += 1;
                next = tokens.next()?;
            }
            Token::Loop => {
                columns.clear();
                values.clear();
                next = tokens.next()?;
                while let Some((_, Token::Tag(tag))) = next {
                    columns.push(tag);
                    next = tokens.next()?;
                }
                if columns.is_empty() {
                    let message = "`loop_` without names found; names of columns expected";
                    return Err(StructureError::line(line, message));
                }
                while let Some((line, Token::Value(value))) = next {
                    if values.is_empty() {
                        row_line = line;
                    }
                    values.push(value);
                    if values.len() == columns.len() {
                        let (columns, values) = (&columns, &values);
                        take(&Row { block, table, columns, values, line: row_line })?;
                    }
                    if values.len() == columns.len() {
                        values.clear();
                    }
                    next = tokens.next()?;
                }
                if !values.is_empty() {
                    let message = format!(
                        "a row of {} values found; {} expected, one for each column of `{}`",
                        values.len(),
                        columns.len(),
                        category(columns[0])
                    );
                    return Err(StructureError::line(row_line, message));
                }
                table += 1;
            }
            Token::Tag(first) => {
                columns.clear();
                values.clear();
                row_line = line;
                let mut tag = Some((line, first));
                while let Some((line, name)) = tag.take() {
                    let Some((_, Token::Value(value))) = tokens.next()? else {
                        let message = format!("`{name}` without a value found; one expected");
                        return Err(StructureError::line(line, message));
                    };
                    columns.push(name);
                    values.push(value);
                    next = tokens.next()?;
                    if let Some((line, Token::Tag(name))) = next
                        && category(name) == category(first)
                    {
                        tag = Some((line, name));
                    }
                }
                let (columns, values) = (&columns, &values);
                take(&Row { block, table, columns, values, line: row_line })?;
                table += 1;
            }
            Token::Value(value) => {
                let shown: String = value.text.chars().take(40).collect();
                let message = format!("`{shown}` found; a name that begins with `_` expected");
                return Err(StructureError::line(line, message));
            }
        }
    }
    Ok(())
}

/// The category of a name: `_atom_site` of `_atom_site.id`.
fn category(name: &str) -> &str {
    name.split('.').next().unwrap_or(name)
}

struct Tokens<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Tokens<'a> {
    /// The next token, with its line.
    fn next(&mut self) -> Result<Option<(usize, Token<'a>)>, StructureError> {
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(self.at) {
                None => return Ok(None),
                Some(b'\n') => {
                    self.line += 1;
                    self.at += 1;
                }
                Some(byte) if byte.is_ascii_whitespace() => self.at += 1,
                Some(b'#') => self.at = self.find_from(self.at, "\n").unwrap_or(bytes.len()),
                Some(_) => break,
            }
        }
        let line = self.line;
        let (start, first) = (self.at, bytes[self.at]);
        let starts_line = start == 0 || bytes[start - 1] == b'\n';
        if first == b';' && starts_line {
            let Some(end) = self.find_from(start, "\n;") else {
                let message =
                    "a text that does not end found; a line that begins with `;` expected";
                return Err(StructureError::line(line, message));
            };
            let text = &self.text[start + 1..end];
            self.line += 1 + text.bytes().filter(|byte| *byte == b'\n').count();
            self.at = end + 2;
            return Ok(Some((line, Token::Value(Value { text, is_quoted: true }))));
        }
        if matches!(first, b'\'' | b'"') {
            return self.quoted(first).map(|value| Some((line, Token::Value(value))));
        }
        let length = bytes[start..].iter().position(u8::is_ascii_whitespace);
        self.at = length.map_or(bytes.len(), |length| start + length);
        let word = &self.text[start..self.at];
        let begins = |with: &str| {
            word.get(..with.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(with))
        };
        let token = match first {
            b'_' => Token::Tag(word),
            _ if begins("data_") => Token::Data,
            _ if word.eq_ignore_ascii_case("loop_") => Token::Loop,
            // Save frames are for dictionaries, the other two words reserved.
            _ if begins("save_") || begins("stop_") || begins("global_") => {
                let message =
                    format!("`{word}` found; a structure, which has no such word, expected");
                return Err(StructureError::line(line, message));
            }
            _ => Token::Value(Value { text: word, is_quoted: false }),
        };
        Ok(Some((line, token)))
    }

    /// A value in quotes, which end where white space follows, in the same line.
    fn quoted(&mut self, quote: u8) -> Result<Value<'a>, StructureError> {
        let bytes = self.text.as_bytes();
        let start = self.at + 1;
        let end_of_line = self.find_from(start, "\n").unwrap_or(bytes.len());
        let closes = |at: &usize| {
            bytes[*at] == quote && bytes.get(at + 1).is_none_or(u8::is_ascii_whitespace)
        };
        let Some(end) = (start..end_of_line).find(closes) else {
            let message = "a quotation mark found; a second one in the same line expected";
            return Err(StructureError::line(self.line, message));
        };
        self.at = end + 1;
        Ok(Value { text: &self.text[start..end], is_quoted: true })
    }

    fn find_from(&self, at: usize, what: &str) -> Option<usize> {
        self.text.as_bytes().get(at..)?;
        self.text[at..].find(what).map(|found| at + found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every row as `block table line: column=value …`.
    fn list(text: &str) -> Result<Vec<String>, String> {
        let mut list = Vec::new();
        rows(text, |row| {
            let cells = row.columns.iter().zip(row.values);
            let cells: Vec<String> =
                cells.map(|(name, value)| format!("{name}={:?}", value.known())).collect();
            list.push(format!("{} {} {}: {}", row.block, row.table, row.line, cells.join(" ")));
            Ok(())
        })
        .map_err(|error| error.to_string())?;
        Ok(list)
    }

    #[test]
    fn values_are_words_quotes_and_texts() {
        let text = "data_x # a comment\n_a.b 'it's' _a.c \".\"\n_d.e\n;two\nlines\n;\nLOOP_\n_f.g _f.h\n1 \
                    .\nO5' ?\n";
        let expected = [
            r#"1 0 2: _a.b=Some("it's") _a.c=Some(".")"#,
            r#"1 1 3: _d.e=Some("two\nlines")"#,
            r#"1 2 9: _f.g=Some("1") _f.h=None"#,
            r#"1 2 10: _f.g=Some("O5'") _f.h=None"#,
        ];
        assert_eq!(list(text).unwrap(), expected);
    }

    #[test]
    fn what_is_cut_off_is_an_error_with_its_line() {
        for (text, error) in [
            ("data_x\nloop_\n_a.b _a.c\n1 2 3", "4: a row of 1 values found; 2 expected"),
            ("data_x\n_a.b", ":2: `_a.b` without a value"),
            ("data_x\n_a.b 'x", ":2: a quotation mark"),
            ("data_x\n_a.b\n;x\n", ":3: a text that does not end"),
            ("data_x\nloop_\n1", ":2: `loop_` without names"),
            ("data_x\n1", ":2: `1` found"),
        ] {
            let found = list(text).unwrap_err();
            assert!(found.contains(error), "{found}");
        }
    }
}
