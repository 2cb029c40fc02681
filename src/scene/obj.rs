//! Wavefront `.obj`: the lines `v` and `f`. What is known to say nothing about the shape (normals, textures, groups,
//! materials) is passed over; any other line is an error, as it may be a vertex or a face that is written wrongly.
//! A line that ends in `\` goes on in the next one.
//!
//! Written here because the published readers report neither the line of an error nor an index
//! out of range, and a user with a broken CAD export needs both.

use super::Mesh;
use super::raw::{MESH_ITEMS_MAX, MeshError, RawMesh, text};
use std::fmt::Write;
use std::path::Path;

impl Mesh {
    /// The mesh as a Wavefront `.obj`, which gives the same mesh back to the bit.
    pub fn to_obj(&self) -> String {
        let mut text = String::new();
        for [x, y, z] in &self.vertices {
            writeln!(text, "v {x} {y} {z}").expect("writing to memory cannot fail");
        }
        for [a, b, c] in self.triangles.iter().map(|corners| corners.map(|corner| corner + 1)) {
            writeln!(text, "f {a} {b} {c}").expect("writing to memory cannot fail");
        }
        text
    }
}

/// First words of lines that say nothing about the shape: normals, textures, parameters of curves, groups,
/// smoothing, materials, display, and points and lines, which have no surface.
const PASSED_OVER: &[&str] = &[
    "vn",
    "vt",
    "vp",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "p",
    "l",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
];
/// Of these, those whose line ends in a name: a path may end in `\`, which then is not the sign that the line goes on.
const NAMING: &[&str] =
    &["g", "o", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj"];

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    let text = text(path, bytes, "a Wavefront .obj")?;
    let mut mesh = RawMesh::default();
    let mut corners: Vec<u32> = Vec::new();
    let mut joined = String::new();
    let mut lines = text.lines().enumerate();
    while let Some((index, line)) = lines.next() {
        let fail = |message: String| MeshError::line(path, index + 1, message);
        let mut line = uncommented(line);
        let first = line.split_whitespace().next();
        let goes_on = |line: &str| line.trim_end().ends_with('\\');
        if goes_on(line) && !first.is_some_and(|word| NAMING.contains(&word)) {
            joined.clear();
            while goes_on(line) {
                joined += line.trim_end().trim_end_matches('\\');
                joined.push(' ');
                line = lines.next().map_or("", |(_, next)| uncommented(next));
            }
            joined += line;
            line = &joined;
        }
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh.vertices.push(vertex(words).map_err(fail)?),
            // `fo` is how the first versions wrote it.
            Some("f" | "fo") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, mesh.vertices.len()).map_err(fail)?);
                }
                mesh.push_face(&corners).map_err(fail)?;
            }
            Some(word) if PASSED_OVER.contains(&word) => {}
            None => {}
            Some("cstype" | "curv" | "curv2" | "surf") => {
                let message = "a curve or surface by formula found; a surface of polygons expected";
                return Err(fail(message.to_owned()));
            }
            Some(word) => {
                return Err(fail(format!("`{word}` found; a line of a Wavefront .obj expected")));
            }
        }
        if mesh.vertices.len() > MESH_ITEMS_MAX {
            return Err(fail(format!("more than {MESH_ITEMS_MAX} vertices")));
        }
    }
    Ok(mesh)
}

/// The line without its comment. A comment does not go on in the next line, whatever it ends in.
fn uncommented(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

/// `x y z`, and perhaps a weight or a colour, which are passed over.
fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut vertex = [0.0; 3];
    for value in &mut vertex {
        let word = words.next().ok_or("a vertex with fewer than 3 coordinates")?;
        *value = match word.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => return Err(format!("`{word}` found; a finite coordinate expected")),
        };
    }
    let mut more = 0;
    for word in words {
        if word.parse::<f64>().is_err() {
            return Err(format!(
                "`{word}` found after `x y z`; a number or the end of the line expected"
            ));
        }
        more += 1;
    }
    if !matches!(more, 0 | 1 | 3 | 4) {
        return Err(format!("a vertex of {} numbers found; `x y z` expected", 3 + more));
    }
    Ok(vertex)
}

/// A corner `i`, `i/t`, `i//n` or `i/t/n`: counted from 1, or backwards from −1.
fn corner(word: &str, vertices: usize) -> Result<u32, String> {
    let first = word.split('/').next().unwrap_or_default();
    let index: i64 =
        first.parse().map_err(|_| format!("`{word}` found; the index of a vertex expected"))?;
    let from_zero = if index > 0 { index - 1 } else { vertices as i64 + index };
    if index == 0 || from_zero < 0 || from_zero >= vertices as i64 {
        return Err(format!(
            "vertex {index} of a face does not exist; {vertices} are defined so far"
        ));
    }
    Ok(from_zero as u32)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    pub fn read_text(text: &str) -> RawMesh {
        parse(text).unwrap_or_else(|error| panic!("{error}"))
    }

    fn parse(text: &str) -> Result<RawMesh, String> {
        read(Path::new("m.obj"), text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn faces_of_every_spelling_become_triangles() {
        let mesh =
            parse("v 0 0 0\nv 1 0 0 # right\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3 -1\n");
        assert_eq!(mesh.unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    /// Byte order marks, line ends, lines that go on, and bytes that are not UTF-8 where they do not count.
    #[test]
    fn the_same_mesh_however_it_is_written() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
        let expected = read_text(text);
        let utf16: Vec<u8> = "\u{feff}"
            .encode_utf16()
            .chain(text.encode_utf16())
            .flat_map(u16::to_le_bytes)
            .collect();
        let commented =
            [b"# caf\xe9 C:\\\no W\xfcrfel\\\nusemtl a#b\n".as_slice(), text.as_bytes()].concat();
        for bytes in [
            [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            utf16,
            commented,
            text.replace('\n', "\r").into_bytes(),
            text.replace('\n', "\r\n").into_bytes(),
            text.replace("1 2 3 4", "1 \\\n2 3\\  \r\n 4 # all").into_bytes(),
        ] {
            let mesh = read(Path::new("m.obj"), &bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(
                (&mesh.vertices, &mesh.triangles),
                (&expected.vertices, &expected.triangles)
            );
        }
    }

    #[test]
    fn errors_name_the_line() {
        for (text, expected) in [
            ("v 0 0 0\nv 0 1\n", "m.obj:2: a vertex with fewer"),
            ("v 0 0 inf\n", "m.obj:1: `inf` found"),
            ("v 0 0 0\nf 1 1 2\n", "m.obj:2: vertex 2 of a face does not exist; 1 are"),
            ("v 0 0 0\nf 1 1\n", "m.obj:2: a face with 2 corners"),
            ("v 0 0 0\n\nf 1 1 x\n", "m.obj:3: `x` found"),
            ("v 0 0 0\nV 0 0 0\n", "m.obj:2: `V` found; a line of a Wavefront .obj expected"),
            ("\u{200b}v 0 0 0\n", "m.obj:1: `\\u{200b}v` found"),
            ("v 0 0 0 v 1 0 0\n", "m.obj:1: `v` found after `x y z`"),
            ("v 0 0 0 1 2\n", "m.obj:1: a vertex of 5 numbers"),
            ("v 0 \\\n 0 \\\n x\n", "m.obj:1: `x` found"),
            ("surf 0 1 0 1 1 2 3\n", "m.obj:1: a curve or surface by formula"),
            ("v 0 0 0\nv 0\u{0}", "m.obj:2: binary data (a byte 0) found; a Wavefront .obj"),
        ] {
            let error = parse(text).err().unwrap();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn cut_off_files_are_errors_or_smaller_meshes() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nf 1/1/1 2//1 3\nf 1 2 3\n";
        for end in 0..text.len() {
            match parse(&text[..end]) {
                Ok(mesh) => assert!(mesh.triangles.len() < 2 || end + 1 >= text.len()),
                Err(error) => assert!(error.starts_with("m.obj:"), "{error}"),
            }
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(bytes in proptest::collection::vec(any::<u8>(), 0..200), lines in "([vf]( -?[0-9]{1,2}(/[0-9])?){0,4}\n){0,9}") {
            let _ = read(Path::new("m.obj"), &bytes);
            let _ = read(Path::new("m.obj"), lines.as_bytes());
        }
    }
}
