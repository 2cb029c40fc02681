//! Where the mesh is that a URDF names: a path, or a URI whose scheme is `file` or `package`.

use std::borrow::Cow;
use std::path::Path;

/// How many folders above the file's own are searched for a package.
const LEVELS_MAX: usize = 32;

/// The path of a mesh from the folder of the URDF at `urdf`. Packages are searched for by going up from there.
///
/// In a URI `%20` is a blank, and so with all bytes that `%` and two hexadecimal digits write. Some programs write
/// them without: where no file has the name that they stand for, the name as written is taken. In a path without
/// scheme it is the other way round.
///
/// # Errors
/// Another scheme or host, or a package that is not found.
pub(super) fn resolve(urdf: &Path, filename: &str) -> Result<String, String> {
    let folder = urdf.parent().unwrap_or(Path::new(""));
    let exists = |path: &str| folder.join(path).is_file();
    if let Some(path) = after_scheme(filename, "package") {
        return in_package(folder, filename, path, exists);
    }
    let (names, is_uri) = match after_scheme(filename, "file") {
        Some(path) => {
            let local = path.strip_prefix("localhost").filter(|rest| rest.starts_with('/'));
            (local.unwrap_or(path), true)
        }
        None if filename.contains("://") => {
            let expected = "a path, file:// or package:// expected";
            return Err(format!("`{filename}` found; {expected}"));
        }
        None => (filename, false),
    };
    let decoded = decoded(names);
    let (first, second) = if is_uri { (&*decoded, names) } else { (names, &*decoded) };
    Ok(if !exists(first) && exists(second) { second } else { first }.to_owned())
}

fn in_package(
    folder: &Path,
    filename: &str,
    path: &str,
    exists: impl Fn(&str) -> bool,
) -> Result<String, String> {
    let decoded = decoded(path);
    let within = |path: &str| path.split_once('/').map_or("", |(_, within)| within).to_owned();
    let mut up = String::new();
    for _ in 0..LEVELS_MAX {
        for name in [&*decoded, path] {
            for candidate in [within(name), name.to_owned()] {
                let file = format!("{up}{candidate}");
                if exists(&file) {
                    return Ok(file);
                }
            }
        }
        up += "../";
    }
    let folder = if folder == Path::new("") { Path::new(".") } else { folder };
    Err(format!(
        "`{filename}`: neither {} nor {decoded} found in {} or a folder above it",
        within(&decoded),
        folder.display()
    ))
}

/// What follows `SCHEME://`, in letters of either size.
fn after_scheme<'a>(filename: &'a str, scheme: &str) -> Option<&'a str> {
    let (found, rest) = filename.split_once("://")?;
    found.eq_ignore_ascii_case(scheme).then_some(rest)
}

/// The name with `%` and two hexadecimal digits replaced by the byte that they write; unchanged where that gives no
/// UTF-8 text.
fn decoded(name: &str) -> Cow<'_, str> {
    if !name.contains('%') {
        return Cow::Borrowed(name);
    }
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name.as_bytes();
    while let [first, after @ ..] = rest {
        let digits = after.get(..2).filter(|digits| digits.iter().all(u8::is_ascii_hexdigit));
        let byte = digits
            .filter(|_| *first == b'%')
            .and_then(|digits| std::str::from_utf8(digits).ok())
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(byte.unwrap_or(*first));
        rest = if byte.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).map_or(Cow::Borrowed(name), Cow::Owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_percent_signs_write_are_decoded() {
        for (name, expected) in [
            ("a%20b.stl", "a b.stl"),
            ("W%C3%BCrfel%2e", "Würfel."),
            ("100%", "100%"),
            ("%zz%2", "%zz%2"),
            ("%ff", "%ff"),
            ("a+b", "a+b"),
        ] {
            assert_eq!(decoded(name), expected);
        }
    }

    #[test]
    fn names_are_those_of_files_that_are_there() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("own")).unwrap();
        for name in ["a b.stl", "c%20d.stl", "own/e f.stl", "own/g%25.stl", "i j.stl", "i%20j.stl"]
        {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let urdf = folder.path().join("arm.urdf");
        let whole = |name: &str| format!("{}/{name}", folder.path().display());
        for (name, expected) in [
            ("file://a%20b.stl", "a b.stl".to_owned()),
            (&format!("file://{}", whole("a%20b.stl")), whole("a b.stl")),
            (&format!("FILE://localhost{}", whole("a%20b.stl")), whole("a b.stl")),
            ("file://c%20d.stl", "c%20d.stl".to_owned()),
            ("file://i%20j.stl", "i j.stl".to_owned()),
            ("i%20j.stl", "i%20j.stl".to_owned()),
            ("a%20b.stl", "a b.stl".to_owned()),
            ("lost%20.stl", "lost%20.stl".to_owned()),
            ("package://any/a%20b.stl", "a b.stl".to_owned()),
            ("package://own/e%20f.stl", "own/e f.stl".to_owned()),
            ("package://own/g%25.stl", "own/g%25.stl".to_owned()),
        ] {
            assert_eq!(resolve(&urdf, name).unwrap(), expected, "{name}");
        }
        assert!(
            resolve(&urdf, "http://a/b.stl").unwrap_err().starts_with("`http://a/b.stl` found")
        );
    }
}
