//! What every page of results is: styles, a policy by which nothing is ever fetched, and the library that draws molecules.

use super::super::markup::escaped;

/// The page without its contents.
const PAGE: &str = include_str!("page.html");

/// The library that draws molecules, with its licence.
pub(in crate::export) const MOLECULES: &str = include_str!("3Dmol-min.js");
pub(in crate::export) const LICENCE: &str = include_str!("3Dmol-LICENSE.txt");

/// What plays frames in any of the pages.
pub(in crate::export) const PLAYER: &str = include_str!("player.js");

/// The page of this name, with styles beside those of all pages, and a body.
pub(in crate::export) fn page(name: &str, style: &str, body: &str) -> String {
    // A text that comes from files is put in last, so that nothing is looked for in it.
    let (before, rest) = PAGE.split_once("ROADMILL_NAME").expect("the page has a title");
    let (between, after) = rest.split_once("ROADMILL_BODY").expect("the page has a body");
    let (styles, rest) = between.split_once("</style>").expect("the page has styles");
    [before, &escaped(name), styles, style, "</style>", rest, body, after].concat()
}

/// The scripts of a viewer: the library with its licence, the data as a JSON text, and what shows them.
pub(in crate::export) fn viewer(data: &str, script: &str) -> String {
    debug_assert!(!MOLECULES.contains("</script") && !MOLECULES.contains("<!--"));
    let licence = LICENCE.replace("*/", "* /");
    format!(
        "<script type=\"application/json\" id=\"data\">{data}</script>\n\
         <script>/*! 3Dmol.js 2.5.5\n{licence}*/\n{MOLECULES}</script>\n<script>{PLAYER}{script}</script>\n"
    )
}
