//! The page in which a run can be walked around in, written and served.

mod support;

use roadmill::generator::{GeneratorKind, HintPath, Hints};
use roadmill::problem::{Problem, StrategySpec};
use rustix::process::Signal;
use serde_json::Value;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use support::browser::{Window, has_browser};
use support::{Scratch, wait_until};

/// What uses a page's controls and notes what comes of it.
const WALK: &str = include_str!("support/walk.js");

/// A file of the repository.
fn repository(name: &str) -> String {
    format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))
}

fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").expect("data");
    let (json, _) = rest.split_once("</script>").expect("their end");
    serde_json::from_str(json).expect("JSON")
}

fn read(scratch: &Scratch, name: &str) -> String {
    fs::read_to_string(scratch.path(name)).expect("it is written")
}

#[test]
fn a_page_is_written_where_the_user_is_with_both_paths_and_every_round() {
    let scratch = Scratch::new();
    scratch.build("runs/m", &[&repository("problems/maze.toml"), "--threads", "2"], 0);
    let done = scratch.run(&["view", "runs/m"]);
    done.assert_code(0);
    done.assert_stderr(&["m-view.html: ", " MB, to be opened in a browser"]);
    let page = read(&scratch, "m-view.html");
    let data = data(&page);
    let paths = data["paths"].as_array().expect("a list");
    let names: Vec<&str> = paths.iter().filter_map(|path| path["name"].as_str()).collect();
    assert_eq!(names, ["path shortened", "path as found"]);
    let length = |index: usize| paths[index]["length"].as_f64().expect("a number");
    assert!(length(0) < length(1));
    let summary: Value =
        serde_json::from_str(&read(&scratch, "runs/m/summary.json")).expect("JSON");
    let of_roadmap = &data["roadmap"];
    for count in ["nodes", "edges"] {
        assert_eq!(of_roadmap[count], summary[count]);
    }
    let stops = of_roadmap["stops"].as_array().expect("a list");
    assert_eq!(stops.len() as u64, of_roadmap["rounds"].as_u64().expect("a number"));
    let [sets, nodes, edges, components] = [1, 2, 3, 4].map(|i| &stops[stops.len() - 1][i]);
    assert_eq!(
        [sets, nodes, edges, components],
        ["sets", "nodes", "edges", "components"].map(|key| &summary[key])
    );
    assert!(data["live"].is_null());
    // A hint is drawn from the start of the query, where the path begins.
    let hand = &data["hand"];
    assert_eq!((hand["translations"].as_u64(), hand["turns"].as_bool()), (Some(2), Some(true)));
    let begins = |q: &Value| -> Vec<f64> {
        q.as_array().expect("a list").iter().filter_map(Value::as_f64).collect()
    };
    let (start, first) = (begins(&hand["start"]["config"]), begins(&paths[0]["configs"][0]));
    assert!(start.len() == 3 && start.iter().zip(&first).all(|(a, b)| (a - b).abs() < 1e-6));
    // The same run gives the same page, wherever it is written.
    scratch.run(&["view", "runs/m", "--no-open", "--out", "b.html"]).assert_code(0);
    assert_eq!(read(&scratch, "b.html"), page);
}

#[test]
fn what_is_no_scene_is_refused() {
    let scratch = Scratch::new();
    scratch.build(
        "run",
        &[&repository("problems/chignolin.toml"), "--max-sets", "1", "--threads", "2"],
        3,
    );
    let done = scratch.run(&["view", "run"]);
    done.assert_code(2);
    done.assert_stderr(&["a run about a protein found", "`roadmill report run --out report.html`"]);
    for (arguments, fragment) in [
        (&["lost"][..], "lost"),
        (&["run", "--out", "run"], "a folder; the name of a file expected"),
        (&["run", "--out", "run/ledger"], "a file of a run"),
        (&["run", "--out", "-"], "the name of a regular file expected"),
        (&["run", "--live", "--out", "x.html"], "cannot be used with"),
    ] {
        let done = scratch.run(&[&["view"], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(&[fragment]);
    }
    assert!(!scratch.path("run-view.html").exists());
}

/// One answer of a server on this machine: its status and its body.
fn ask(port: u16, request: &str) -> (String, String) {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("it listens");
    stream.write_all(request.as_bytes()).expect("it takes requests");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("text");
    let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
    let status = head.split("\r\n").next().and_then(|line| line.split_once(' ')).expect("a status");
    (status.1.to_owned(), body.to_owned())
}

#[test]
fn a_build_is_followed_by_who_knows_the_address_until_a_signal_comes() {
    let scratch = Scratch::new();
    let walls = repository("problems/walls.toml");
    let build = |sets: &str| {
        let limits = ["--force", "--threads", "2", "--max-sets", sets];
        scratch.run(&[&["build", &walls, "--out", "run"][..], &limits].concat()).assert_code(3);
    };
    build("5");
    let running = scratch.start(&["view", "run", "--live", "--no-open"]);
    let address = || {
        // What the second command of this test has said so far.
        let said = read(&scratch, "1.stderr");
        let (_, rest) = said.split_once("http://127.0.0.1:")?;
        let (address, _) = rest.split_once(": to be opened in a browser; Ctrl-C ends it")?;
        let (port, path) = address.split_once('/')?;
        Some((port.parse::<u16>().ok()?, format!("/{path}")))
    };
    wait_until("the page is served", || address().is_some());
    let (port, path) = address().expect("it was said");
    // Connections that say nothing, more than are kept open: they keep nobody out, and hold up no signal.
    let silent = || TcpStream::connect(("127.0.0.1", port)).expect("it listens");
    let silent: Vec<TcpStream> = (0..40).map(|_| silent()).collect();
    let get = |target: &str| {
        ask(port, &format!("GET {target} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n"))
    };
    let (status, page) = get(&path);
    assert_eq!(status, "200 OK");
    let first = data(&page);
    assert_eq!(first["live"]["version"], 0);
    assert_eq!(get(&format!("{path}data?known=0")).0, "204 No Content");
    assert_eq!(get("/").0, "404 Not Found");
    let elsewhere = format!("GET {path} HTTP/1.1\r\nHost: example.org\r\n\r\n");
    assert_eq!(ask(port, &elsewhere), ("403 Forbidden".to_owned(), "403 Forbidden".to_owned()));
    let endless = format!("GET {path} HTTP/1.1\r\nCookie: {}\r\n", "x".repeat(7 << 10));
    assert!(ask(port, &(endless + &"y".repeat(1024))).0.starts_with("431"));
    // A robot that is moved by hand: an estimate at once, the exact answer soon.
    let collides = |values: &str| get(&format!("{path}collides?q={values}"));
    let exactly = |values: &str| {
        let mut last = String::new();
        wait_until("the exact answer", || {
            last = collides(values).1;
            last.ends_with("\"exact\":true}")
        });
        last
    };
    assert_eq!(exactly("1,2,2,1,0,0,0"), "{\"collides\":false,\"exact\":true}");
    assert_eq!(exactly("2,0.3,2,1,0,0,0"), "{\"collides\":true,\"exact\":true}");
    for wrong in ["", "1,2", "1,2,2,1,0,0,x", "1,2,2,0,0,0,0", "1,2,NaN,1,0,0,0"] {
        assert_eq!(collides(wrong).0, "400 Bad Request", "{wrong}");
    }
    // Rounds that come are given to who does not know them.
    build("10");
    let newer = || get(&format!("{path}data?known=0"));
    let mut last = newer();
    wait_until("there is more", || {
        last = newer();
        last.0 == "200 OK"
    });
    let last: Value = serde_json::from_str(&last.1).expect("JSON");
    let nodes = |data: &Value| data["roadmap"]["nodes"].as_u64().expect("a number");
    assert!(nodes(&last) > nodes(&first));
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(0);
    done.assert_stderr(&["the page is no longer served"]);
    drop(silent);
}

/// Opens pages in a browser, wide and narrow, points at nodes, clicks, drags, moves the controls and draws a hint: nothing goes wrong, what is
/// asked for is seen, and nothing is painted while nothing changes.
#[test]
fn pages_can_be_walked_around_in() {
    if !has_browser() {
        return;
    }
    let scratch = Scratch::new();
    // In the plane, in space, a linkage, and a landscape: several rounds of most, none with more than 5000 edges.
    for name in ["maze", "maze3d", "gantry", "muller-brown"] {
        let text = fs::read_to_string(repository(&format!("problems/{name}.toml")));
        let text = text.expect("it ships").replace("nodes = 100\n", "nodes = 30\n");
        let text = text.replace("[img]\nsets_per_round = 5\n", "");
        let text = text.replace("gantry.urdf", &repository("problems/gantry.urdf"));
        let file = format!("{name}.toml");
        scratch.write(&file, &(text + "\n[img]\nsets_per_round = 1\n"));
        let build = ["build", &file, "--out", name, "--threads", "2", "--max-nodes", "250"];
        let done = scratch.run(&build);
        assert!([0, 3].map(Some).contains(&done.status.code()), "{name}: {}", done.stderr);
        scratch.run(&["view", name]).assert_code(0);
        let page = read(&scratch, &format!("{name}-view.html"));
        let edges = data(&page)["roadmap"]["edges"].as_u64().expect("a number");
        assert!((1..=5000).contains(&edges), "{name}: {edges}");
        let rounds = data(&page)["roadmap"]["rounds"].as_u64().expect("a number");
        assert!(rounds > 1 || name == "gantry", "{name}");
        for [width, height] in [[1280, 900], [400, 800]] {
            let what = format!("{name} {width}");
            let window = Window { runs: None, ..Window::new(width, height) };
            let drawn = walk(&scratch, &page, &what, &window, rounds > 1);
            assert_eq!(drawn.is_none(), name == "gantry", "{what}: robots with a base that moves");
            if let Some((hint, poses)) = drawn {
                is_a_hint(&scratch, &file, &hint, &poses, &what);
            }
        }
    }
}

/// Whether the hint that was drawn in a page is read as it was drawn: the links stand at its last configuration where the page showed them.
fn is_a_hint(scratch: &Scratch, problem: &str, hint: &str, poses: &str, what: &str) {
    scratch.write("drawn.csv", hint);
    let problem = Problem::load(&scratch.path(problem));
    let problem = problem.unwrap_or_else(|error| panic!("{what}: {error}"));
    let path = HintPath::of_file(scratch.path("drawn.csv").display().to_string());
    let strategy = StrategySpec::generated("hints", GeneratorKind::Hints(Hints::new(path)));
    let hinted = problem.to_builder().strategies(vec![strategy]).default_schedule().build();
    let hinted = hinted.unwrap_or_else(|error| panic!("{what}: {error}"));
    let GeneratorKind::Hints(hints) = hinted.strategies()[0].generator() else { unreachable!() };
    let path = hints.all_paths().next().expect("it has one").configurations();
    assert!(path.len() >= 5, "{what}: {hint}");
    let figure = problem.model().description().figure().expect("it was drawn");
    let expected = figure.placement(path.last().expect("it has some")).poses;
    let found: Vec<f64> =
        poses.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    assert_eq!(found.len(), 7 * expected.len(), "{what}");
    for (found, expected) in found.chunks(7).zip(expected) {
        // Of a unit quaternion and its opposite, which is the same rotation.
        let sign = (0..4).map(|i| found[3 + i] * expected.rotation[i]).sum::<f64>().signum();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-4;
        let stands = (0..3).all(|i| near(found[i], expected.translation[i]));
        let turned = (0..4).all(|i| near(sign * found[3 + i], expected.rotation[i]));
        assert!(stands && turned, "{what}: {found:?}, not {expected:?}");
    }
}

/// Walks around in one page, in a window of a size; `grows` says whether the page has several rounds. Gives the hint that was drawn there, and where
/// the links stood in the end, seven numbers each; of a robot whose base stands there is none.
fn walk(
    scratch: &Scratch,
    page: &str,
    what: &str,
    window: &Window,
    grows: bool,
) -> Option<(String, String)> {
    let watched = page.replacen("<head>", &format!("<head><script>{WALK}</script>"), 1);
    let marks = window.open(scratch, &watched, what);
    let said = |name: &str| marks.said(name);
    assert_eq!((said("errors"), said("done")), ("", "yes"), "{what}");
    let count = |name: &str| marks.count(name);
    assert!(count("drawn") > 100 && count("first") > 0, "{what}: {marks:?}");
    // The node that was pointed at stays when it is clicked.
    assert!(said("pointed").starts_with("node "), "{what}: {marks:?}");
    assert_eq!(said("clicked"), said("pointed"), "{what}");
    assert_ne!(said("robot"), said("drawn"), "{what}: {marks:?}");
    assert_eq!((said("grown"), said("turned")), (&*grows.to_string(), "true"), "{what}: {marks:?}");
    assert!(said("legend").contains(" to "), "{what}: {marks:?}");
    assert_eq!((said("idle"), said("wide")), ("0", "false"), "{what}: {marks:?}");
    if said("hint").is_empty() {
        return None;
    }
    assert_eq!((said("undone"), said("cleared")), ("true", "1 configuration"), "{what}: {marks:?}");
    assert!(said("kept").ends_with(" configurations") && !said("kept").starts_with("not"));
    assert_eq!(said("widehint"), "false", "{what}: {marks:?}");
    Some((said("hint").to_owned(), said("poses").to_owned()))
}
