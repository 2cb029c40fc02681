use super::shell::{LICENCE, MOLECULES};
use super::*;
use crate::build::{Build, Built};
use crate::model::ModelKind;
use crate::pathways::{Dissimilar, Rank, dissimilar};
use crate::{Cancel, Ends};
use std::path::Path;

fn built(name: &str, text: &str) -> Built {
    // Files that a problem names are looked for beside it.
    let problem = Problem::parse(&Path::new("problems").join(name), text);
    Build::new(problem.unwrap_or_else(|error| panic!("{error}"))).run().expect("it is built")
}

/// Chignolin from end to end in a few sets.
fn chignolin() -> Built {
    let text = std::fs::read_to_string("problems/chignolin.toml").expect("it ships");
    built("chignolin.toml", &text)
}

/// The report on what was built, from one end of the query to the other; `change` may change the problem that it shows.
fn page(built: &Built, angles: &[DomainAngle], change: impl Fn(&mut Problem)) -> String {
    let (cx, scratch) = (built.context(), &mut Scratch::new());
    let ends = cx.query().expect("a query");
    let spacing = if angles.is_empty() { 1.0 } else { 3.0 };
    let asked =
        Dissimilar { count: 2, rank: Rank::Cost, distance: 0.2, spacing, tries: 3, shortcuts: 2 };
    let attachment = built.problem().attachment();
    let pathways =
        dissimilar(cx, built.roadmap(), ends, &attachment, &asked, &Cancel::new(), scratch)
            .expect("few frames");
    let mut problem = built.problem().clone();
    change(&mut problem);
    let rounds: Vec<RoundOutcome> = [(50, 7, f64::INFINITY), (100, 2, 12.5), (200, 1, 9.0)]
        .map(|(nodes, components, value)| RoundOutcome {
            nodes,
            components,
            numbers: vec![RoundValue {
                name: "lowest-barrier".to_owned(),
                value,
                threshold: Some(10.0),
            }],
            satisfied: vec![value <= 10.0],
        })
        .into();
    report(
        &Report {
            problem: &problem,
            cx,
            roadmap: built.roadmap(),
            ends: &Ends::new(ends.start.clone(), ends.goal.clone()),
            pathways: &pathways,
            asked: "Two paths were asked for & <found>.",
            angles,
            folding: None,
            rounds: &rounds,
            program: "roadmill 0",
            end: "all criteria are met",
        },
        scratch,
    )
}

/// The sections of a page, in their order.
fn sections(page: &str) -> Vec<&str> {
    let ids = page.split("<section id=\"").skip(1);
    ids.map(|rest| rest.split('"').next().unwrap_or_default()).collect()
}

/// The page without the library that shows molecules, in which addresses stand that are never used.
fn own(page: &str) -> String {
    page.replacen(MOLECULES, "", 1).replacen(LICENCE, "", 1)
}

#[test]
fn a_protein_has_every_section_and_the_same_bytes_again() {
    let built = chignolin();
    let first = page(&built, &[], |_| ());
    let expected = ["paths", "structures", "map", "profiles", "residues", "contacts", "growth"];
    assert_eq!(sections(&first), expected);
    assert!(first == page(&built, &[], |_| ()), "another page");
    assert!(first.contains("model kJ/mol") && first.contains("no rates follow"));
    assert!(first.contains(&built.roadmap().digest().to_string()));
    assert!(first.contains("asked for: 10") && first.contains("lowest-barrier"));
    assert!(first.contains("&amp; &lt;found&gt;"));
    assert!(first.contains("Cα RMSD from the start [Å]"), "the axes of the map");
    assert!(!own(&first).contains("NaN"), "every number that is drawn is one");
}

#[test]
fn nothing_is_fetched() {
    let page = page(&chignolin(), &[], |_| ());
    let own = own(&page);
    assert!(own.len() + MOLECULES.len() + LICENCE.len() == page.len(), "the library is there once");
    assert!(own.contains("content=\"default-src 'none'; "), "the browser is told so, too");
    for fetching in ["http:", "https:", " src=", "url(", "@import", "fetch(", "XMLHttp", "import("]
    {
        assert!(!own.contains(fetching), "{fetching}");
    }
    let links: Vec<&str> = own.split("href=").skip(1).map(|rest| &rest[..6]).collect();
    assert_eq!(links, ["\"data:"], "no link but the empty icon");
}

#[test]
fn names_from_files_are_text_and_never_markup() {
    let hostile = "</title><script>alert(1)</script>\"&ROADMILL_BODY";
    // From the stretched chain to the hairpin, so that contacts form.
    let text = std::fs::read_to_string("problems/chignolin.toml").expect("it ships");
    let text = text.replace("start = [", "end = [").replace("goal = [", "start = [");
    let folding = built("folding.toml", &text.replace("end = [", "goal = ["));
    let page = page(&folding, &[], |problem| {
        problem.name = hostile.to_owned();
        let ModelKind::Protein(protein) = &mut problem.model else { panic!("a protein") };
        for residue in &mut protein.source {
            residue.name = "<b>".to_owned();
        }
    });
    assert!(!page.contains("<script>alert") && !page.contains("</title><script"));
    assert_eq!(page.matches("&lt;/title&gt;").count(), 2, "the title and the heading");
    assert!(!own(&page).contains("<b>") && page.contains("&lt;b&gt; "), "in the contacts");
    assert!(page.contains("\\u003cb\\u003e"), "in the structures");
    assert_eq!(page.matches("</script>").count(), 3);
}

#[test]
fn two_angles_are_the_axes_of_the_map() {
    let angle = |name: &str, ranges: [std::ops::RangeInclusive<i32>; 3]| DomainAngle {
        name: name.to_owned(),
        ranges,
    };
    let angles = [angle("bend", [1..=3, 4..=6, 7..=10]), angle("twist", [1..=2, 3..=5, 6..=9])];
    let page = page(&chignolin(), &angles, |_| ());
    for text in [">bend [°]<", ">twist [°]<", "Angle bend", "Angle twist"] {
        assert!(page.contains(text), "{text}");
    }
}

#[test]
fn other_models_have_what_there_is_to_show() {
    let landscape = std::fs::read_to_string("tests/problems/landscape.toml").expect("it is there");
    let hill = page(&built("hill.toml", &landscape), &[], |_| ());
    assert_eq!(sections(&hill), ["paths", "map", "profiles", "growth"]);
    assert!(hill.contains("Nodes by energy") && !hill.contains("<script"));
    let room = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [4, 4]\nbounds = \"reference\"\n\
        [robot]\nbodies = [{ shape = { point = {} } }]\n[query]\nstart = [1, 2]\ngoal = [3, 2]\n\
        [[strategies]]\nlabel = \"u\"\nnodes = 20\nsampler = { uniform = {} }\n[limits]\nsets = 2\n";
    let walls = "[[obstacles]]\nshape = { box = { size = [0.5, 4, 1] } }\nposition = [2, 2, 0]\n";
    let open = page(&built("room.toml", room), &[], |_| ());
    assert_eq!(sections(&open), ["paths", "map", "profiles", "growth"]);
    assert!(open.contains("The model has no energies") && !open.contains("Nodes by energy"));
    let closed = page(&built("rooms.toml", &format!("{walls}{room}")), &[], |_| ());
    assert_eq!(sections(&closed), ["paths", "map", "growth"]);
    assert!(closed.contains("No path: nothing joins the start and the goal yet"));
}
