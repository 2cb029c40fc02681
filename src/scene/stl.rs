//! `.stl`, binary and text. Stored normals are passed over, since the corners determine the triangles.
//!
//! Written here for the same reason as the `.obj` reader: an error must name its line or byte.

use super::raw::{MESH_ITEMS_MAX, MeshError, RawMesh};
use std::path::Path;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    // A binary file may begin with "solid" too; its length gives it away.
    if let Some(count) = stated_count(bytes)
        && bytes.len() == HEADER_BYTES + count * TRIANGLE_BYTES
    {
        return read_binary(path, bytes, count);
    }
    if bytes.trim_ascii_start().starts_with(b"solid")
        && let Ok(text) = std::str::from_utf8(bytes)
    {
        return read_text(path, text);
    }
    let message = match stated_count(bytes) {
        Some(count) => format!(
            "cut off or no .stl: {} bytes found, {} expected for the {count} triangles it states",
            bytes.len(),
            HEADER_BYTES + count * TRIANGLE_BYTES
        ),
        None => format!("{} bytes found; at least {HEADER_BYTES} expected", bytes.len()),
    };
    Err(MeshError::whole(path, message))
}

fn stated_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER_BYTES - 4..HEADER_BYTES)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

fn read_binary(path: &Path, bytes: &[u8], count: usize) -> Result<RawMesh, MeshError> {
    if count > MESH_ITEMS_MAX {
        return Err(MeshError::whole(path, format!("more than {MESH_ITEMS_MAX} triangles")));
    }
    let mut mesh = RawMesh::default();
    for (index, record) in bytes[HEADER_BYTES..].chunks_exact(TRIANGLE_BYTES).enumerate() {
        for corner in 1..4 {
            let mut vertex = [0.0; 3];
            for (axis, value) in vertex.iter_mut().enumerate() {
                let at = 12 * corner + 4 * axis;
                let word = [record[at], record[at + 1], record[at + 2], record[at + 3]];
                *value = f64::from(f32::from_le_bytes(word));
                if !value.is_finite() {
                    let place = format!(" byte {}", HEADER_BYTES + index * TRIANGLE_BYTES + at);
                    let message = format!("{value} found; a finite coordinate expected");
                    return Err(MeshError { path: path.to_owned(), place, message });
                }
            }
            mesh.vertices.push(vertex);
        }
        let first = 3 * index as u32;
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    Ok(mesh)
}

fn read_text(path: &Path, text: &str) -> Result<RawMesh, MeshError> {
    let mut mesh = RawMesh::default();
    let mut corners = 0;
    let mut ended = false;
    for (index, line) in text.lines().enumerate() {
        let fail = |message: String| Err(MeshError::line(path, index + 1, message));
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let mut vertex = [0.0; 3];
                for value in &mut vertex {
                    let word = words.next().unwrap_or_default();
                    match word.parse::<f64>() {
                        Ok(number) if number.is_finite() => *value = number,
                        _ => return fail(format!("`{word}` found; a finite coordinate expected")),
                    }
                }
                mesh.vertices.push(vertex);
                corners += 1;
            }
            Some("endloop") => {
                if corners != 3 {
                    return fail(format!("a facet with {corners} corners; 3 expected"));
                }
                let end = mesh.vertices.len() as u32;
                mesh.triangles.push([end - 3, end - 2, end - 1]);
                corners = 0;
            }
            Some("endsolid") => ended = true,
            Some("solid" | "facet" | "outer" | "endfacet") | None => {}
            Some(word) => return fail(format!("`{word}` found; a line of a text .stl expected")),
        }
    }
    if !ended {
        return Err(MeshError::line(path, text.lines().count(), "cut off; `endsolid` expected"));
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n";

    fn binary() -> Vec<u8> {
        let mut bytes = vec![0; 80];
        bytes[..5].copy_from_slice(b"solid");
        bytes.extend(1u32.to_le_bytes());
        for value in [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn both_kinds_hold_the_same_triangle() {
        for bytes in [TEXT.as_bytes(), &binary()] {
            let mesh = read(Path::new("m.stl"), bytes).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(mesh.vertices, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
            assert_eq!(mesh.triangles, [[0, 1, 2]]);
        }
    }

    #[test]
    fn cut_off_files_are_errors_at_every_byte() {
        for end in 0..binary().len() {
            assert!(read(Path::new("m.stl"), &binary()[..end]).is_err());
        }
        for end in 0..TEXT.len() - "endsolid t\n".len() {
            assert!(read(Path::new("m.stl"), &TEXT.as_bytes()[..end]).is_err());
        }
        let mut stated = binary();
        stated[80..84].copy_from_slice(&1_000_000_000u32.to_le_bytes());
        let error = read(Path::new("m.stl"), &stated).err().unwrap().to_string();
        assert!(error.contains("134 bytes found, 50000000084 expected"), "{error}");
        let error = read(Path::new("m.stl"), TEXT.replace("vertex 1 0 0\n", "").as_bytes());
        assert!(error.err().unwrap().to_string().starts_with("m.stl:6: a facet with 2 corners"));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300), at in 0usize..134, byte in any::<u8>()) {
            let _ = read(Path::new("m.stl"), &bytes);
            for mut good in [TEXT.as_bytes().to_vec(), binary()] {
                let at = at % good.len();
                good[at] = byte;
                let _ = read(Path::new("m.stl"), &good);
            }
        }
    }
}
