//! `.ply`, text and binary of either byte order: of the element `vertex` the properties x, y and z, of
//! the element `face` the list `vertex_indices` (or `vertex_index`). All else is passed over.
//!
//! Written here for the same reason as the `.obj` reader: an error must name its line or byte. No memory is
//! reserved by the counts that a header states, which may be wrong.

use super::raw::{MESH_ITEMS_MAX, MeshError, RawMesh};
use crate::source::{NoText, text_of};
use std::path::Path;

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    // The byte order mark of a text file.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let (header, body) = Header::read(path, bytes)?;
    let text;
    let mut values = match header.format {
        Format::Text => {
            let lines_before = header.lines;
            text = text_of(&bytes[body..]).map_err(|NoText { line, found }| {
                let message = format!("{found}; text expected, as the header says `format ascii`");
                MeshError::line(path, lines_before + line, message)
            })?;
            Values::Text { lines: text.lines(), line: header.lines, words: "".split_whitespace() }
        }
        Format::Binary { big } => Values::Binary { bytes, at: body, big },
    };
    let mut mesh = RawMesh::default();
    let mut corners = Vec::new();
    for element in header.elements.iter().filter(|element| !element.properties.is_empty()) {
        let vertices = mesh.vertices.len();
        for _ in 0..element.count {
            let fail = |values: &Values, message: String| Err(values.error(path, message));
            let mut vertex = [0.0; 3];
            values.begin_item();
            for property in &element.properties {
                match &property.role {
                    Role::Coordinate(axis) => {
                        let value = values.number(path, property.kind)?;
                        if !value.is_finite() {
                            return fail(
                                &values,
                                format!("{value} found; a finite coordinate expected"),
                            );
                        }
                        vertex[*axis] = value;
                    }
                    Role::Passed => drop(values.number(path, property.kind)?),
                    Role::List { count, corners: wanted } => {
                        let length = values.number(path, *count)?;
                        if !(length >= 0.0 && length.fract() == 0.0) {
                            return fail(
                                &values,
                                format!("{length} found; the length of a list expected"),
                            );
                        }
                        corners.clear();
                        // Each item takes a byte or a word at least: the file's size is the bound.
                        for _ in 0..length as u64 {
                            let value = values.number(path, property.kind)?;
                            if !wanted {
                                continue;
                            }
                            if !(value >= 0.0 && value.fract() == 0.0 && value < vertices as f64) {
                                let there = format!("does not exist; there are {vertices}");
                                return fail(&values, format!("vertex {value} of a face {there}"));
                            }
                            corners.push(value as u32);
                        }
                        if *wanted && let Err(message) = mesh.push_face(&corners) {
                            return fail(&values, message);
                        }
                    }
                }
            }
            values.end_item(path)?;
            if element.name == "vertex" {
                mesh.vertices.push(vertex);
            }
        }
    }
    values.end(path)?;
    Ok(mesh)
}

#[derive(Clone, Copy)]
enum Format {
    Text,
    Binary { big: bool },
}

#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(word: &str) -> Option<Kind> {
        Some(match word {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::F64 => 8,
        }
    }
}

/// What the reader does with a property.
enum Role {
    Coordinate(usize),
    Passed,
    List { count: Kind, corners: bool },
}

struct Property {
    kind: Kind,
    role: Role,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    format: Format,
    elements: Vec<Element>,
    lines: usize,
}

impl Header {
    /// The header, and the byte where it ends.
    fn read(path: &Path, bytes: &[u8]) -> Result<(Header, usize), MeshError> {
        let mut format = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut at = 0;
        for number in 1.. {
            let fail = |message: String| Err(MeshError::line(path, number, message));
            let Some(length) = bytes[at..].iter().position(|byte| *byte == b'\n') else {
                return fail("cut off; `end_header` expected".to_owned());
            };
            let line = String::from_utf8_lossy(&bytes[at..at + length]);
            at += length + 1;
            let words: Vec<&str> = line.split_whitespace().collect();
            if number == 1 {
                if words != ["ply"] {
                    return fail("`ply` expected, the first line of a .ply".to_owned());
                }
                continue;
            }
            match words[..] {
                ["format", "ascii", "1.0"] => format = Some(Format::Text),
                ["format", "binary_little_endian", "1.0"] => {
                    format = Some(Format::Binary { big: false });
                }
                ["format", "binary_big_endian", "1.0"] => {
                    format = Some(Format::Binary { big: true })
                }
                ["element", name, count] => {
                    let count = match count.parse::<usize>() {
                        Ok(count) if count <= MESH_ITEMS_MAX => count,
                        _ => {
                            let expected = format!("at most {MESH_ITEMS_MAX} expected");
                            return fail(format!("{count} elements `{name}` found; {expected}"));
                        }
                    };
                    elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
                }
                ["property", ref rest @ ..] => {
                    let Some(element) = elements.last_mut() else {
                        return fail("a property before any element".to_owned());
                    };
                    let Some(property) = property_of(&element.name, rest) else {
                        return fail(format!("`{}` found; a property expected", line.trim()));
                    };
                    element.properties.push(property);
                }
                ["comment" | "obj_info", ..] | [] => {}
                ["end_header"] => {
                    let Some(format) = format else {
                        return fail("a `format` line, version 1.0, expected before it".to_owned());
                    };
                    let axes = elements.iter().filter(|element| element.name == "vertex");
                    let axes = axes.flat_map(|element| &element.properties);
                    let axes = axes.filter(|property| matches!(property.role, Role::Coordinate(_)));
                    if axes.count() != 3 {
                        return fail("an element `vertex` with x, y and z expected".to_owned());
                    }
                    return Ok((Header { format, elements, lines: number }, at));
                }
                _ => {
                    return fail(format!(
                        "`{}` found; a line of a .ply header expected",
                        line.trim()
                    ));
                }
            }
        }
        unreachable!("the loop ends with the bytes")
    }
}

fn property_of(element: &str, words: &[&str]) -> Option<Property> {
    match *words {
        ["list", count, item, name] => {
            let corners = element == "face" && matches!(name, "vertex_indices" | "vertex_index");
            let role = Role::List { count: Kind::of(count)?, corners };
            Some(Property { kind: Kind::of(item)?, role })
        }
        [kind, name] => {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
            let role = match axis {
                Some(axis) if element == "vertex" => Role::Coordinate(axis),
                _ => Role::Passed,
            };
            Some(Property { kind: Kind::of(kind)?, role })
        }
        _ => None,
    }
}

/// The numbers after the header.
enum Values<'a> {
    Text { lines: std::str::Lines<'a>, line: usize, words: std::str::SplitWhitespace<'a> },
    Binary { bytes: &'a [u8], at: usize, big: bool },
}

impl Values<'_> {
    /// In text every item has a line of its own.
    fn begin_item(&mut self) {
        if let Values::Text { lines, line, words } = self {
            *words = "".split_whitespace();
            for next in lines {
                *line += 1;
                *words = next.split_whitespace();
                if words.clone().next().is_some() {
                    return;
                }
            }
        }
    }

    /// In text nothing follows an item in its line.
    fn end_item(&mut self, path: &Path) -> Result<(), MeshError> {
        if let Values::Text { words, .. } = self
            && let Some(word) = words.next()
        {
            let message =
                format!("`{word}` found; the end of the line expected, as the header says");
            return Err(self.error(path, message));
        }
        Ok(())
    }

    /// After the last item nothing follows but blanks.
    fn end(&mut self, path: &Path) -> Result<(), MeshError> {
        let Values::Binary { bytes, at, .. } = self else {
            self.begin_item();
            return self.end_item(path);
        };
        let rest = &bytes[*at..];
        if !rest.iter().all(|byte| *byte == 0 || byte.is_ascii_whitespace()) {
            let over = rest.len();
            let message = format!("{over} more bytes found; the end expected, as the header says");
            return Err(self.error(path, message));
        }
        Ok(())
    }

    fn error(&self, path: &Path, message: impl Into<String>) -> MeshError {
        match self {
            Values::Text { line, .. } => MeshError::line(path, *line, message),
            Values::Binary { at, .. } => MeshError::byte(path, *at, message),
        }
    }

    fn number(&mut self, path: &Path, kind: Kind) -> Result<f64, MeshError> {
        match self {
            Values::Text { words, .. } => match words.next() {
                None => Err(self.error(path, "cut off; a number expected")),
                Some(word) => word
                    .parse()
                    .map_err(|_| self.error(path, format!("`{word}` found; a number expected"))),
            },
            Values::Binary { bytes, at, big } => {
                let Some(found) = bytes.get(*at..*at + kind.bytes()) else {
                    return Err(self.error(path, "cut off; a number expected"));
                };
                let mut word = [0; 8];
                for (i, byte) in found.iter().enumerate() {
                    word[if *big { found.len() - 1 - i } else { i }] = *byte;
                }
                *at += kind.bytes();
                let bits = u64::from_le_bytes(word);
                Ok(match kind {
                    Kind::I8 => f64::from(bits as i8),
                    Kind::U8 => f64::from(bits as u8),
                    Kind::I16 => f64::from(bits as i16),
                    Kind::U16 => f64::from(bits as u16),
                    Kind::I32 => f64::from(bits as i32),
                    Kind::U32 => f64::from(bits as u32),
                    Kind::F32 => f64::from(f32::from_bits(bits as u32)),
                    Kind::F64 => f64::from_bits(bits),
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n7 4 0 1 2 3\n";

    fn binary(big: bool) -> Vec<u8> {
        let kind = if big { "binary_big_endian" } else { "binary_little_endian" };
        let end = TEXT.find("0 0 0 9").unwrap();
        let mut bytes = TEXT[..end].replace("ascii", kind).into_bytes();
        let f32s = |value: f32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
        let i32s = |value: i32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            bytes.extend([f32s(x), f32s(y), f32s(0.0)].as_flattened());
            bytes.push(9);
        }
        bytes.extend([7, 4]);
        bytes.extend([i32s(0), i32s(1), i32s(2), i32s(3)].as_flattened());
        bytes
    }

    #[test]
    fn all_three_kinds_hold_the_same_square() {
        for bytes in [TEXT.as_bytes(), &binary(false), &binary(true)] {
            let mesh = read(Path::new("m.ply"), bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(
                mesh.vertices,
                [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
            );
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        }
    }

    #[test]
    fn a_mark_before_and_blanks_after_change_nothing() {
        let marked = [b"\xef\xbb\xbf", TEXT.as_bytes()].concat();
        let followed = [binary(true), b"\r\n\0".to_vec()].concat();
        for bytes in [marked, followed] {
            let mesh = read(Path::new("m.ply"), &bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(mesh.triangles.len(), 2);
        }
        let more = [binary(true), vec![1]].concat();
        let error = read(Path::new("m.ply"), &more).unwrap_err().to_string();
        let expected = format!("m.ply byte {}: 1 more bytes found", binary(true).len());
        assert!(error.starts_with(&expected), "{error}");
    }

    #[test]
    fn errors_name_the_place() {
        for (from, to, expected) in [
            ("1 1 0 9", "1 inf 0 9", "m.ply:15: inf found; a finite"),
            ("1 1 0 9", "1 one 0 9", "m.ply:15: `one` found"),
            ("2 3\n", "2 4\n", "m.ply:17: vertex 4 of a face does not exist; there are 4"),
            (
                "vertex 4",
                "vertex 1000000000",
                "m.ply:4: 1000000000 elements `vertex` found; at most",
            ),
            ("vertex 4", "vertex 60000000", "m.ply:17: "),
            ("4 0 1 2 3", "4294967295 0", "m.ply:17: cut off"),
            ("4 0 1 2 3", "2 0 1", "m.ply:17: a face with 2 corners"),
            ("2 3\n", "2 3 4\n", "m.ply:17: `4` found; the end of the line expected"),
            ("2 3\n", "2 3\n\n5\n", "m.ply:19: `5` found; the end of the line expected"),
            ("2 3\n", "2 3\u{0}\n", "m.ply:17: binary data (a byte 0) found; text expected"),
            ("1 1 0 9\n0 1 0 9", "0 1 0 9\n1 1 0 9", "m.ply:17: a face that crosses itself"),
            ("property float z\n", "", "m.ply:11: an element `vertex` with x, y and z"),
            ("float y", "float128 y", "m.ply:6: `property float128 y` found"),
        ] {
            let text = TEXT.replace(from, to);
            let error = read(Path::new("m.ply"), text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn cut_off_files_are_errors_at_every_byte() {
        for bytes in [&TEXT.as_bytes()[..TEXT.len() - 1], &binary(false), &binary(true)] {
            for end in 0..bytes.len() {
                let error = read(Path::new("m.ply"), &bytes[..end]).unwrap_err();
                assert!(!error.place.is_empty(), "{error}");
            }
        }
        let error = read(Path::new("m.ply"), &binary(true)[..290]).unwrap_err().to_string();
        assert!(error.starts_with("m.ply byte "), "{error}");
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300), at in 0usize..280, byte in any::<u8>(), big in any::<bool>()) {
            let _ = read(Path::new("m.ply"), &bytes);
            for mut good in [TEXT.as_bytes().to_vec(), binary(big)] {
                let at = at % good.len();
                good[at] = byte;
                let _ = read(Path::new("m.ply"), &good);
            }
        }
    }
}
