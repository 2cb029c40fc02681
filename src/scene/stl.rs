//! `.stl`, binary and text. Stored normals are passed over, since the corners determine the triangles.
//!
//! Written here for the same reason as the `.obj` reader: an error must name its line or byte.

use super::raw::{MESH_ITEMS_MAX, MeshError, RawMesh};
use crate::source::text_of;
use std::path::Path;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    // A binary file may begin with "solid" too; its length gives it away.
    let stated = stated_count(bytes);
    let length = |count: usize| HEADER_BYTES + count * TRIANGLE_BYTES;
    if let Some(count) = stated
        && bytes.len() == length(count)
    {
        return read_binary(path, bytes, count);
    }
    // Some programs fill up a text with zeros.
    let zeros = bytes.iter().rev().take_while(|byte| **byte == 0).count();
    if let Ok(text) = text_of(&bytes[..bytes.len() - zeros])
        && zeros < bytes.len()
    {
        if let Some(first) = text.split_whitespace().next()
            && !first.eq_ignore_ascii_case("solid")
        {
            let first: String = first.chars().take(40).collect();
            let message = format!(
                "text that begins with `{first}` found; `solid` expected, or a binary .stl"
            );
            return Err(MeshError::line(path, 1, message));
        }
        return read_text(path, &text);
    }
    let found = bytes.len();
    let Some(count) = stated else {
        let message =
            format!("a binary file of {found} bytes found; at least {HEADER_BYTES} expected");
        return Err(MeshError::whole(path, message));
    };
    let expected = format!("{} expected for the {count} triangles that it states", length(count));
    let Some(after) = bytes.get(length(count)..) else {
        let message = format!("a binary .stl that is cut off: {found} bytes found, {expected}");
        return Err(MeshError::whole(path, message));
    };
    // Some programs end the file in a line break or fill up a block. More than that may be triangles.
    if after.len() >= TRIANGLE_BYTES && after.iter().any(|byte| *byte != 0) {
        let message = format!("a binary .stl that is too long: {found} bytes found, {expected}");
        return Err(MeshError::whole(path, message));
    }
    read_binary(path, &bytes[..length(count)], count)
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
    // Old programs end a text with the sign of its end.
    let last = text.trim_end_matches(|c: char| c == '\u{1a}' || c.is_whitespace());
    for (index, line) in last.lines().enumerate() {
        let fail = |message: String| Err(MeshError::line(path, index + 1, message));
        let mut words = line.split_whitespace();
        let word = words.next().unwrap_or_default();
        match word.to_ascii_lowercase().as_str() {
            "vertex" => {
                let mut vertex = [0.0; 3];
                for value in &mut vertex {
                    let word = words.next().unwrap_or_default();
                    match word.parse::<f64>() {
                        Ok(number) if number.is_finite() => *value = number,
                        _ => return fail(format!("`{word}` found; a finite coordinate expected")),
                    }
                }
                if let Some(word) = words.next() {
                    return fail(format!(
                        "`{word}` found after `vertex x y z`; the end of the line expected"
                    ));
                }
                mesh.vertices.push(vertex);
                corners += 1;
            }
            "endloop" => {
                if corners != 3 {
                    return fail(format!("a facet with {corners} corners; 3 expected"));
                }
                let end = mesh.vertices.len() as u32;
                mesh.triangles.push([end - 3, end - 2, end - 1]);
                corners = 0;
            }
            "endfacet" | "endsolid" if corners != 0 => {
                return fail(format!("`{word}` found after {corners} corners; `endloop` expected"));
            }
            "endsolid" => ended = true,
            "solid" => ended = false,
            "facet" | "outer" | "endfacet" | "" => {}
            _ => return fail(format!("`{word}` found; a line of a text .stl expected")),
        }
    }
    if !ended {
        return Err(MeshError::line(
            path,
            text.lines().count().max(1),
            "cut off; `endsolid` expected",
        ));
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
        let trailing = |bytes: &[u8]| [&binary(), bytes].concat();
        let named = [b"\xef\xbb\xbfsolid W\xfcrfel\x1b".as_slice(), &TEXT.as_bytes()[7..]].concat();
        for bytes in [
            TEXT.as_bytes(),
            TEXT.to_uppercase().as_bytes(),
            TEXT.replace('\n', "\r").as_bytes(),
            (TEXT.to_owned() + "\n\u{1a}\r\n").as_bytes(),
            (TEXT.to_owned() + "\0\0").as_bytes(),
            &named,
            &binary(),
            &trailing(b"\r\n"),
            &trailing(&[0; 512]),
        ] {
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
    }

    #[test]
    fn errors_tell_text_from_binary() {
        let with_count = |count: u32, more: usize| {
            let mut bytes = binary();
            bytes[80..84].copy_from_slice(&count.to_le_bytes());
            bytes.extend(vec![1; more]);
            bytes
        };
        let text = |from: &str, to: &str| TEXT.replacen(from, to, 1).into_bytes();
        for (bytes, expected) in [
            (
                with_count(1_000_000_000, 0),
                "m.stl: a binary .stl that is cut off: 134 bytes found, 50000000084",
            ),
            (
                with_count(0, 0),
                "m.stl: a binary .stl that is too long: 134 bytes found, 84 expected",
            ),
            (
                with_count(1, 50),
                "m.stl: a binary .stl that is too long: 184 bytes found, 134 expected",
            ),
            (vec![0; 40], "m.stl: a binary file of 40 bytes found"),
            (text("vertex 1 0 0\n", ""), "m.stl:6: a facet with 2 corners"),
            (text("endloop\n", ""), "m.stl:7: `endfacet` found after 3 corners"),
            (text("solid", "solids"), "m.stl:1: text that begins with `solids` found"),
            (text("vertex", "Vertx"), "m.stl:4: `Vertx` found"),
            (text("0 1 0\n", "0 1 0 1\n"), "m.stl:6: `1` found after `vertex x y z`"),
            (text("endsolid t\n", "endsolid t\nsolid u\n"), "m.stl:10: cut off"),
            (Vec::new(), "m.stl: a binary file of 0 bytes"),
        ] {
            let error = read(Path::new("m.stl"), &bytes).err().unwrap().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
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
