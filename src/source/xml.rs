//! A look at XML before it is parsed.

/// The most attributes of one element.
const ATTRIBUTES_MAX: usize = 64;
/// The most declarations of namespaces that an element and those around it have together.
const NAMESPACES_MAX: usize = 32;

/// Complains of an element with more attributes or namespaces than any format has, with the element's line.
///
/// The XML library compares each attribute of an element with all others, and each namespace with all those in
/// force: 200 000 attributes would take minutes. Within these bounds its time is proportional to the file's size.
/// What is no well-formed XML is left for the library to complain of.
pub(crate) fn too_many_attributes(text: &str) -> Option<(usize, String)> {
    let bytes = text.as_bytes();
    // For each element that is open: how many namespaces it declares.
    let mut open: Vec<usize> = Vec::new();
    let mut in_force = 0;
    let mut at = 0;
    while let Some(step) = bytes[at..].iter().position(|byte| *byte == b'<') {
        at += step;
        let rest = &text[at..];
        let skipped =
            [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">"), ("</", ">")];
        if let Some((begin, end)) = skipped.iter().find(|(begin, _)| rest.starts_with(begin)) {
            if *begin == "</" {
                in_force -= open.pop().unwrap_or(0);
            }
            at += begin.len() + rest[begin.len()..].find(end)? + end.len();
            continue;
        }
        let element = Element::at(&bytes[at..])?;
        let declared = in_force + element.namespaces;
        for (what, found, most) in [
            ("attributes", element.attributes, ATTRIBUTES_MAX),
            ("namespaces in force", declared, NAMESPACES_MAX),
        ] {
            if found > most {
                let line = 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count();
                let message =
                    format!("an element with {found} {what} found; at most {most} expected");
                return Some((line, message));
            }
        }
        if !element.empty {
            open.push(element.namespaces);
            in_force = declared;
        }
        at += element.length;
    }
    None
}

/// What stands between `<` and `>`.
struct Element {
    /// Bytes from `<` to after `>`.
    length: usize,
    attributes: usize,
    /// How many of the attributes declare a namespace.
    namespaces: usize,
    /// Whether it ends in `/>`.
    empty: bool,
}

impl Element {
    /// The element that begins at the first byte, `<`; `None` if it does not end.
    fn at(bytes: &[u8]) -> Option<Element> {
        let mut element = Element { length: 0, attributes: 0, namespaces: 0, empty: false };
        let mut at = 1;
        let mut word = at;
        loop {
            match *bytes.get(at)? {
                b'>' => {
                    element.length = at + 1;
                    element.empty = bytes[at - 1] == b'/';
                    return Some(element);
                }
                quote @ (b'"' | b'\'') => {
                    at += 1 + bytes[at + 1..].iter().position(|byte| *byte == quote)?;
                    element.attributes += 1;
                    element.namespaces += usize::from(bytes[word..].starts_with(b"xmlns"));
                }
                byte if byte.is_ascii_alphabetic() && bytes[at - 1].is_ascii_whitespace() => {
                    word = at
                }
                _ => {}
            }
            at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_with_very_many_attributes_are_named_by_their_line() {
        let with = |count: usize| {
            let attributes: String = (0..count).map(|i| format!(" a{i}='>'")).collect();
            format!("<?xml version='1.0'?>\n<!-- <a x='1' -->\n<b>\n<c{attributes}/></b>")
        };
        assert_eq!(too_many_attributes(&with(64)), None);
        let (line, message) = too_many_attributes(&with(200_000)).unwrap();
        assert_eq!(line, 4);
        assert!(message.starts_with("an element with 200000 attributes found"), "{message}");
    }

    #[test]
    fn namespaces_count_as_long_as_they_are_in_force() {
        let beside: String =
            (0..100).map(|i| format!("<a xmlns:n{i}='u'></a><b xmlns='u'/>")).collect();
        assert_eq!(too_many_attributes(&format!("<r>{beside}</r>")), None);
        let nested: String = (0..33).map(|i| format!("<a xmlns:n{i}='u'>\n")).collect();
        let (line, message) = too_many_attributes(&nested).unwrap();
        assert_eq!((line, message.contains("33 namespaces in force")), (33, true));
    }
}
