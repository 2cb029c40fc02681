//! Wavefront `.obj`: the lines `v` and `f`. Everything else (normals, textures, groups, materials)
//! says nothing about the shape and is passed over.
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

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    let text = text(path, bytes, "a Wavefront .obj")?;
    let mut mesh = RawMesh::default();
    let mut corners: Vec<u32> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh
                .vertices
                .push(vertex(words).map_err(|message| MeshError::line(path, number, message))?),
            Some("f") => {
                corners.clear();
                for word in words {
                    let corner = corner(word, mesh.vertices.len())
                        .map_err(|message| MeshError::line(path, number, message))?;
                    corners.push(corner);
                }
                mesh.push_face(&corners)
                    .map_err(|message| MeshError::line(path, number, message))?;
            }
            _ => {}
        }
        if mesh.vertices.len() > MESH_ITEMS_MAX {
            let message = format!("more than {MESH_ITEMS_MAX} vertices");
            return Err(MeshError::line(path, number, message));
        }
    }
    Ok(mesh)
}

fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut vertex = [0.0; 3];
    for value in &mut vertex {
        let word = words.next().ok_or("a vertex with fewer than 3 coordinates")?;
        *value = match word.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => return Err(format!("`{word}` found; a finite coordinate expected")),
        };
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

    #[test]
    fn errors_name_the_line() {
        for (text, expected) in [
            ("v 0 0 0\nv 0 1\n", "m.obj:2: a vertex with fewer"),
            ("v 0 0 inf\n", "m.obj:1: `inf` found"),
            ("v 0 0 0\nf 1 1 2\n", "m.obj:2: vertex 2 of a face does not exist; 1 are"),
            ("v 0 0 0\nf 1 1\n", "m.obj:2: a face with 2 corners"),
            ("v 0 0 0\n\nf 1 1 x\n", "m.obj:3: `x` found"),
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
