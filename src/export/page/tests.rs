use super::*;
use crate::img::{Setup, build};
use base64::prelude::{BASE64_STANDARD, Engine};
use std::path::Path as FilePath;
use std::sync::Arc;

fn shown(problem: &Problem, roadmap: &Roadmap, paths: &[NamedPath]) -> Option<String> {
    Viewer { problem, roadmap, paths, live: None, clearance: false }.page()
}

/// The page of a problem's build, with the path that the first evaluator found.
fn page_of(name: &str, text: &str) -> (Arc<Setup>, Roadmap, String) {
    let problem = Problem::parse(FilePath::new(name), text).expect("it is sound");
    let setup = Arc::new(Setup::new(problem));
    let grown = build(&setup);
    let answer = grown.judgement.as_ref().and_then(|it| it.verdicts[0].answer.as_ref());
    let path = answer.and_then(|answer| answer.path.as_ref()).expect("a path is found");
    let paths = [NamedPath { name: "path", path }];
    let page = shown(&setup.problem, &grown.roadmap, &paths).expect("it can be drawn");
    (setup, grown.roadmap, page)
}

/// The data of a page as they are written.
fn data_of(page: &str) -> &str {
    let (_, rest) = page.split_once("id=\"data\">").expect("data");
    rest.split_once("</script>").expect("their end").0
}

/// What follows a key of the data.
fn at<'a>(data: &'a str, key: &str) -> &'a str {
    data.split_once(&format!("\"{key}\":")).unwrap_or_else(|| panic!("{key}")).1
}

/// A number that follows a key.
fn number(data: &str, key: &str) -> usize {
    let text = at(data, key);
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    text[..end].parse().unwrap_or_else(|_| panic!("{key}"))
}

/// The column that follows a key, as words of four bytes.
fn words(data: &str, key: &str) -> Vec<[u8; 4]> {
    let text = at(data, key).split('"').nth(1).unwrap_or_else(|| panic!("{key}"));
    let bytes = BASE64_STANDARD.decode(text).expect("base64");
    bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]).collect()
}

fn integers(data: &str, key: &str) -> Vec<u32> {
    words(data, key).into_iter().map(u32::from_le_bytes).collect()
}

fn floats(data: &str, key: &str) -> Vec<f32> {
    words(data, key).into_iter().map(f32::from_le_bytes).collect()
}

#[test]
fn a_page_holds_the_roadmap_and_the_path() {
    let (setup, roadmap, page) = page_of("maze.toml", include_str!("../../../problems/maze.toml"));
    let data = data_of(&page);
    assert!(data.contains("\"name\":\"maze\",\n\"planar\":true,"));
    let of_roadmap = at(data, "roadmap");
    let (nodes, edges) = (roadmap.configs().len(), roadmap.edges().len());
    assert_eq!((number(of_roadmap, "nodes"), number(of_roadmap, "edges")), (nodes, edges));
    assert_eq!(integers(of_roadmap, "ids"), (0..nodes as u32).collect::<Vec<_>>());
    let pairs: Vec<u32> =
        roadmap.edges().iter().flat_map(|edge| [edge.low.0, edge.high.0]).collect();
    assert_eq!(integers(of_roadmap, "pairs"), pairs);
    let configs: Vec<f32> = roadmap.configs().values().map(|value| value as f32).collect();
    assert_eq!(floats(of_roadmap, "configs"), configs);
    let degrees = integers(of_roadmap, "degrees");
    assert_eq!(degrees.iter().sum::<u32>() as usize, 2 * edges);
    let names: Vec<u32> =
        roadmap.nodes().map(|node| roadmap.components().of_node(node).name.0).collect();
    assert_eq!(integers(of_roadmap, "components"), names);
    let figure = setup.problem.model.description().figure().expect("it can be drawn");
    let (markers, poses) = (floats(of_roadmap, "markers"), floats(of_roadmap, "poses"));
    assert_eq!((markers.len(), poses.len()), (3 * nodes, 7 * nodes));
    for node in roadmap.nodes() {
        let marker = figure.marker(roadmap.configs().get(node.index()));
        let found = &markers[3 * node.index()..][..3];
        assert_eq!(found, marker.map(|value| value as f32));
    }
    let stops = at(of_roadmap, "stops");
    assert_eq!(stops.matches('[').count(), 1 + roadmap.rounds().len());
    let last = format!(",{nodes},{edges},{},{nodes},{edges}]]", roadmap.components().count());
    assert!(stops.contains(&last), "{stops}");
    assert!(page.len() < 250_000, "{} bytes", page.len());
}

/// Of an energy over the plane the page has the grid, cut off above the highest contour.
#[test]
fn a_landscape_comes_with_its_energies() {
    let text =
        include_str!("../../../problems/muller-brown.toml").replace("nodes = 5000", "nodes = 500");
    let (_, roadmap, page) = page_of("muller-brown.toml", &text);
    let data = data_of(&page);
    let energies = floats(at(data, "energy"), "energies");
    let columns = number(data, "columns");
    assert!(columns > 100 && energies.len().is_multiple_of(columns));
    let highest = energies.iter().copied().fold(f32::MIN, f32::max);
    let lowest = energies.iter().copied().fold(f32::MAX, f32::min);
    assert!(highest == 0.0 && at(data, "lowest").starts_with("-140,"));
    assert!((-147.0..-140.0).contains(&lowest), "{lowest}");
    let values = at(at(data, "roadmap"), "values");
    assert!(values.starts_with("[{\"name\":\"energy\","));
    let recorded: Vec<f32> = roadmap.values().iter().map(|value| *value as f32).collect();
    assert_eq!(floats(values, "numbers"), recorded);
}

/// Whatever a problem is called, nothing of it becomes markup or script.
#[test]
fn names_are_text() {
    let name = "</script><script>alert(1)</script>ROADMILL_DATA\u{2028}\"'&";
    let problem =
        Problem::parse(FilePath::new("maze.toml"), include_str!("../../../problems/maze.toml"));
    let mut problem = problem.expect("it is sound");
    problem.name = name.to_owned();
    let empty = Roadmap::new(&problem.space());
    let page = shown(&problem, &empty, &[]).expect("it can be drawn");
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(data_of(&page).contains("\\u003c/script\\u003e\\u003cscript\\u003ealert(1)"));
    assert!(page.contains("<title>&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert_eq!(page, shown(&problem, &empty, &[]).expect("it can be drawn"));
    // The number that lets scripts run follows from the data.
    let key = |page: &str| {
        let (_, rest) = page.split_once("script-src 'nonce-").expect("a policy");
        rest.split_once('\'').expect("its end").0.to_owned()
    };
    assert_eq!(page.matches(&key(&page)).count(), 4);
    problem.name = "another".to_owned();
    assert_ne!(key(&page), key(&shown(&problem, &empty, &[]).expect("it can be drawn")));
}

#[test]
fn every_part_of_the_page_is_put_in_once() {
    let page = page("a", "{}");
    assert!(!page.contains("ROADMILL_"));
    for part in SCRIPT.iter().chain([&STYLE]) {
        assert_eq!(page.matches(part).count(), 1);
    }
    for reference in ["http:", "https:", "src=", "url(", "import "] {
        assert!(!page.contains(reference), "{reference}");
    }
}
