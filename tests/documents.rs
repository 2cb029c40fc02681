//! The repository's pages: every relative link leads to a file, and every anchor to a heading.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The pages of the repository: all `.md` files outside of build outputs and hidden folders.
fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).expect("a folder of the repository");
    for entry in entries.flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        let kind = entry.file_type().expect("its kind");
        let is_other = name.starts_with('.') || matches!(&*name, "target" | "node_modules");
        // A virtual environment of Python has its packages' pages.
        if kind.is_dir() && !is_other && !path.join("pyvenv.cfg").exists() {
            pages(&path, found);
        } else if kind.is_file() && name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// The lines of a page outside of code blocks, with their numbers from 1.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        (!is_code && !is_fence).then_some((index + 1, line))
    })
}

/// A line without what stands in backquotes, which is no link.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect()
}

/// The anchors of a page: its headings as GitHub names them, and the ids that it gives itself.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    for (_, line) in prose(text) {
        let ids = line.split("<a id=\"").skip(1).filter_map(|rest| rest.split('"').next());
        anchors.extend(ids.map(str::to_owned));
        let heading = line.trim_start_matches('#');
        let level = line.len() - heading.len();
        if !(1..=6).contains(&level) || !heading.starts_with(' ') {
            continue;
        }
        let letters = heading.trim().to_lowercase();
        let kept = letters.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let name: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        // A heading that is there already gets a number.
        let others = (1..).map(|number| format!("{name}-{number}"));
        let free = std::iter::once(name.clone()).chain(others).find(|name| !anchors.contains(name));
        anchors.extend(free);
    }
    anchors
}

/// Where the links of a line lead.
fn targets(line: &str) -> Vec<String> {
    let parts = line.split("](").skip(1);
    parts.filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
}

/// A path without `..` and `.`, whatever is there.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

#[test]
fn every_relative_link_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut found, mut checked, mut broken) = (Vec::new(), 0, Vec::new());
    pages(root, &mut found);
    for page in &found {
        let text = fs::read_to_string(page).expect("it is text");
        let name = page.strip_prefix(root).expect("it is of the repository").display();
        for (number, line) in prose(&text) {
            for target in targets(&without_code(line)) {
                let (path, anchor) = target.split_once('#').unwrap_or((&target, ""));
                if path.contains(':') {
                    continue;
                }
                checked += 1;
                let folder = page.parent().expect("it is in a folder");
                let to = if path.is_empty() { page.clone() } else { plain(&folder.join(path)) };
                let is_page = to.extension().is_some_and(|it| it == "md");
                let has_anchor = || {
                    let text = fs::read_to_string(&to).expect("it is text");
                    anchors(&text).contains(anchor)
                };
                if !to.exists() {
                    broken.push(format!("{name}:{number}: {target}: no such file"));
                } else if is_page && !anchor.is_empty() && !has_anchor() {
                    broken.push(format!("{name}:{number}: {target}: no such heading"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(found.len() > 20 && checked > 100, "{} pages, {checked} links", found.len());
}

#[test]
fn links_and_headings_are_read_as_browsers_read_them() {
    let text =
        "# A `b` (c), d\n```sh\n# no heading\n```\n## A `b` (c), d\n<a id=\"own\"></a>x\n#hash\n";
    let expected = ["a-b-c-d", "a-b-c-d-1", "own"].map(str::to_owned);
    assert_eq!(anchors(text), BTreeSet::from(expected));
    assert_eq!(targets(&without_code("[a](b.md#c) `[x](y)` ![p](q.png)")), ["b.md#c", "q.png"]);
    assert_eq!(plain("a/b/../c/./d".as_ref()), Path::new("a/c/d"));
    assert_eq!(prose("a\n```\nb\n```\nc").map(|(number, _)| number).collect::<Vec<_>>(), [1, 5]);
}
