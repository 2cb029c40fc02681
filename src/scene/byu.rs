//! `.g`, Movie.BYU geometry: counts of parts, vertices, faces and corners; first and last face of each
//! part; coordinates; corners counted from 1, the last of a face negative. Line breaks mean nothing.
//!
//! The mesh is made of the triangles of all parts.

use super::raw::{MESH_ITEMS_MAX, MeshError, RawMesh, text};
use std::path::Path;

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    let text = text(path, bytes, "a BYU .g file")?;
    let mut words = Words::new(path, &text);
    let parts = words.count("the number of parts")?;
    let vertices = words.count("the number of vertices")?;
    let faces = words.count("the number of faces")?;
    words.count("the number of corners")?;
    for _ in 0..parts {
        words.count("the first face of a part")?;
        words.count("the last face of a part")?;
    }
    let mut mesh = RawMesh::default();
    for _ in 0..vertices {
        let mut vertex = [0.0; 3];
        for value in &mut vertex {
            *value = words.coordinate()?;
        }
        mesh.vertices.push(vertex);
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        corners.clear();
        loop {
            let (corner, last) = words.corner(vertices)?;
            corners.push(corner);
            if last {
                break;
            }
        }
        mesh.push_face(&corners).map_err(|message| words.error(message))?;
    }
    match words.next() {
        Some(word) => {
            Err(words.error(format!("`{word}` found; the end after {faces} faces expected")))
        }
        None => Ok(mesh),
    }
}

/// The file's words, and the line of the last one.
struct Words<'a> {
    path: &'a Path,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    words: std::str::SplitWhitespace<'a>,
    line: usize,
}

impl<'a> Words<'a> {
    fn new(path: &'a Path, text: &'a str) -> Words<'a> {
        Words { path, lines: text.lines().enumerate(), words: "".split_whitespace(), line: 1 }
    }

    fn next(&mut self) -> Option<&'a str> {
        loop {
            if let Some(word) = self.words.next() {
                return Some(word);
            }
            let (index, line) = self.lines.next()?;
            self.line = index + 1;
            self.words = line.split_whitespace();
        }
    }

    fn error(&self, message: impl Into<String>) -> MeshError {
        MeshError::line(self.path, self.line, message)
    }

    fn expect(&mut self, what: &str) -> Result<&'a str, MeshError> {
        self.next().ok_or_else(|| self.error(format!("cut off; {what} expected")))
    }

    fn count(&mut self, what: &str) -> Result<usize, MeshError> {
        let word = self.expect(what)?;
        match word.parse::<usize>() {
            Ok(count) if count <= MESH_ITEMS_MAX => Ok(count),
            Ok(_) => {
                Err(self.error(format!("{word} found; {what}, at most {MESH_ITEMS_MAX}, expected")))
            }
            Err(_) => Err(self.error(format!("`{word}` found; {what} expected"))),
        }
    }

    fn coordinate(&mut self) -> Result<f64, MeshError> {
        let word = self.expect("a coordinate")?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(format!("`{word}` found; a finite coordinate expected"))),
        }
    }

    /// A corner, and whether it is its face's last.
    fn corner(&mut self, vertices: usize) -> Result<(u32, bool), MeshError> {
        let word = self.expect("a corner of a face")?;
        let index: i64 = word
            .parse()
            .map_err(|_| self.error(format!("`{word}` found; the index of a vertex expected")))?;
        let from_one = index.unsigned_abs();
        if from_one == 0 || from_one > vertices as u64 {
            let message = format!("vertex {index} of a face does not exist; there are {vertices}");
            return Err(self.error(message));
        }
        Ok((from_one as u32 - 1, index < 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SQUARE: &str = " 1 4 2 7\n 1 2\n0 0 0 1 0 0\n1 1 0\n0 1 0\n1 2 3 -4\n1 2\n-3\n";

    fn parse(text: &str) -> Result<RawMesh, String> {
        read(Path::new("m.g"), text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn faces_end_with_a_negative_corner_wherever_lines_break() {
        let mesh = parse(SQUARE).unwrap();
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    }

    #[test]
    fn faces_need_not_be_convex() {
        // The second corner is the reflex one; a fan from the first would cover what is outside.
        let dart = "1 4 1 4\n1 1\n0 0 0 1 1 0 2 0 0 1 3 0\n1 2 3 -4\n";
        assert_eq!(parse(dart).unwrap().triangles, [[3, 0, 1], [1, 2, 3]]);
        let crossing = dart.replace("1 1 0 2 0 0 1 3 0", "2 2 0 2 0 0 0 2 0");
        let error = parse(&crossing).err().unwrap();
        assert!(error.starts_with("m.g:4: a face that crosses itself"), "{error}");
    }

    #[test]
    fn errors_name_the_line() {
        for (from, to, expected) in [
            ("1 1 0", "1 nan 0", "m.g:4: `nan` found"),
            ("-4", "-5", "m.g:6: vertex -5 of a face does not exist; there are 4"),
            ("1 2\n-3", "1\n-3", "m.g:8: a face with 2 corners"),
            (
                " 1 4 2 7",
                "1 1000000000 2 7",
                "m.g:1: 1000000000 found; the number of vertices, at most",
            ),
            ("-3\n", "-3\n7\n", "m.g:9: `7` found; the end after 2 faces"),
        ] {
            let error = parse(&SQUARE.replace(from, to)).err().unwrap();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn cut_off_files_are_errors_at_every_byte() {
        for end in 0..SQUARE.len() - 1 {
            let error = parse(&SQUARE[..end]).err().unwrap();
            assert!(error.starts_with("m.g:"), "{error}");
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(bytes in proptest::collection::vec(any::<u8>(), 0..200), words in "([0-9-]{1,3}[ \n]){0,40}") {
            let _ = read(Path::new("m.g"), &bytes);
            let _ = read(Path::new("m.g"), words.as_bytes());
        }
    }
}
