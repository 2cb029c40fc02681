//! The page about a run, and the scripts for programs that show molecules.

mod support;

use rustix::process::Signal;
use serde_json::Value;
use std::fs;
use support::browser::{Window, has_browser};
use support::{Scratch, wait_until};

const CHIGNOLIN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/chignolin.toml");

/// What is looked for in a chignolin of a few sets, so that it is found in a moment.
const SEARCH: [&str; 10] = [
    "--count",
    "2",
    "--dissimilar",
    "0.3",
    "--tries",
    "2",
    "--shorten-tries",
    "2",
    "--spacing",
    "1",
];

/// The data of the page's viewer.
fn data(page: &str) -> Value {
    let (_, rest) =
        page.split_once("<script type=\"application/json\" id=\"data\">").expect("data");
    let (json, _) = rest.split_once("</script>").expect("an end");
    serde_json::from_str(json).expect("JSON")
}

#[test]
fn a_page_is_written_with_the_paths_as_structures_and_the_rounds_as_recorded() {
    let scratch = Scratch::new();
    let text = fs::read_to_string(CHIGNOLIN).expect("it ships");
    let structures = CHIGNOLIN.replace("chignolin.toml", "structures/");
    let criteria = "\n[[evaluators]]\nall = [{ flow-ratio = { ratio = 1e9 } }, { lowest-barrier = { energy = 0.0 } }]\n\
        [limits]\nsets = 8\n";
    scratch.write("c.toml", &(text.replace("structures/", &structures) + criteria));
    scratch.build("run", &["c.toml"], 3);
    let write = |out: &str| {
        let done = scratch.run(&[&["report", "run", "--out", out][..], &SEARCH].concat());
        done.assert_code(0);
        fs::read_to_string(scratch.path(out)).expect("written")
    };
    let page = write("a.html");
    assert!(page == write("b.html"), "another page");
    // Two rounds of four sets, each with the numbers of both criteria.
    for text in ["flow-ratio, flow back", "lowest-barrier", "the limit of 8 sets is reached"] {
        assert!(page.contains(text), "{text}");
    }
    let data = data(&page);
    let paths = data["paths"].as_array().expect("paths");
    assert!(!paths.is_empty());
    let atoms = data["pdb"].as_str().expect("a text").matches("ATOM  ").count();
    for path in paths {
        let frames = path["told"].as_array().expect("rows").len();
        let coordinates = path["coordinates"].as_str().expect("base64").trim_end_matches('=');
        assert_eq!(coordinates.len() * 3 / 4, frames * atoms * 3 * 2);
    }
    // The structures of the page are those of `paths`, whose PDB files have hydrogens besides.
    let done = scratch
        .run(&[&["paths", "run", "--out", "ways", "--format", "pml,cxc"][..], &SEARCH].concat());
    done.assert_code(0);
    let pdb = fs::read_to_string(scratch.path("ways").join("path-1.pdb")).expect("written");
    assert_eq!(pdb.matches("MODEL ").count(), paths[0]["told"].as_array().expect("rows").len());
    let script = |name: &str| fs::read_to_string(scratch.path("ways").join(name)).expect("written");
    for line in ["load path-1.pdb, path_1, multiplex=0", "mplay"] {
        assert!(script("paths.pml").lines().any(|found| found == line), "{line}");
    }
    assert!(script("paths.cxc").contains("open path-1.pdb id 1 coordsets true"));
    if has_browser() {
        look(&scratch, &page);
    }
}

/// A point in a room with nothing in it.
const ROOM: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [4, 4]\nbounds = \"reference\"\n\
    [robot]\nbodies = [{ shape = { point = {} } }]\n[query]\nstart = [1, 2]\ngoal = [3, 2]\n\
    [[strategies]]\nlabel = \"u\"\nnodes = 20\nsampler = { uniform = {} }\n[limits]\nsets = 1\n";

#[test]
fn what_cannot_be_reported_is_refused() {
    let scratch = Scratch::new();
    scratch.write("room.toml", ROOM);
    scratch.build("run", &["room.toml"], 0);
    for (arguments, fragment) in [
        (&["run"][..], "--out"),
        (&["run", "--out", "x.html", "--angle", "A=1-2/3-4/5-6"], "this model is no molecule"),
        (&["run", "--out", "x.html", "--by", "barrier"], "this model has no energies"),
        (&["run", "--out", "none/x.html"], "none/x.html: cannot write"),
        (&["lost", "--out", "x.html"], "lost"),
        (&["run", "--out", "."], "a folder; the name of a file expected"),
        (&["run", "--out", "run"], "a folder; the name of a file expected"),
        (&["run", "--out", "x.html", "--spacing", "0.001", "--max-time", "0"], "--max-time"),
    ] {
        let done = scratch.run(&[&["report"], arguments].concat());
        done.assert_code(2);
        done.assert_stderr(&[fragment]);
    }
    assert!(!scratch.path("x.html").exists());
    let done = scratch.run(&["paths", "run", "--format", "pml", "--out", "ways"]);
    done.assert_code(2);
    done.assert_stderr(&["pml found; this model is no molecule, csv expected"]);
    scratch.run(&["report", "run", "--out", "x.html"]).assert_code(0);
    assert!(scratch.path("x.html").is_file());
}

/// What makes up a run is no place for what is written about it, whatever path leads there and whether it is there yet.
#[test]
fn files_of_a_run_are_not_replaced() {
    let scratch = Scratch::new();
    scratch.write("room.toml", ROOM);
    scratch.build("run", &["room.toml"], 0);
    std::os::unix::fs::symlink("run", scratch.path("link")).expect("a link can be made");
    let before = scratch.ledger("run");
    for (folder, name) in [("run", "ledger"), ("link", "ledger.durable"), ("run", "summary.json")] {
        let out = format!("{folder}/{name}");
        for command in [
            &["report", "run", "--out", &out][..],
            &["export", "run", "--format", "graphml", "--out", &out],
            &["query", "run", "--out", &out],
            &["query", "run", "--animate", &out],
        ] {
            let done = scratch.run(command);
            done.assert_code(2);
            done.assert_stderr(&[&out, "a file of a run; the name of another file expected"]);
        }
    }
    assert_eq!(scratch.ledger("run"), before);
    // Beside them there is room for a page, and elsewhere for a file of the name.
    scratch.run(&["report", "run", "--out", "run/page.html"]).assert_code(0);
    scratch.run(&["query", "run", "--out", "ledger"]).assert_code(0);
}

/// Of paths that are shortened so often that nobody waits for the end.
const ENDLESS_SEARCH: [&str; 6] =
    ["--shorten-tries", "4294967295", "--dissimilar", "0.3", "--count", "2"];

#[test]
fn a_signal_ends_a_search_without_a_page_and_a_limit_of_time_with_one_that_says_so() {
    let scratch = Scratch::new();
    scratch.build("run", &[CHIGNOLIN, "--max-sets", "8", "--threads", "2"], 3);
    let report =
        |out: &'static str| [&["report", "run", "--out", out][..], &ENDLESS_SEARCH].concat();
    let running = scratch.start(&report("x.html"));
    wait_until("signals are listened to", || running.catches(Signal::INT));
    running.signal(Signal::INT);
    let done = running.finish();
    done.assert_code(6);
    let way = "a signal came; there is no page: `roadmill report run --out x.html` writes it";
    done.assert_stderr(&[way]);
    assert!(!scratch.path("x.html").exists());

    let done = scratch.run(&[&report("y.html")[..], &["--max-time", "0.5"]].concat());
    done.assert_code(0);
    done.assert_stderr(&["y.html: the time was up before the search for paths was over"]);
    let page = fs::read_to_string(scratch.path("y.html")).expect("it is written");
    assert!(
        page.contains("The time for the search was up before its end") && page.contains("</html>")
    );
}

/// Notes every error from the beginning; uses the controls of the page when all is loaded, and says what came of it in
/// attributes of the root element.
const WATCH: &str = r##"<script>
const told = document.documentElement.dataset;
told.errors = "";
const note = (error) => { told.errors += error + "; "; };
addEventListener("error", (event) => note(event.message));
addEventListener("securitypolicyviolation", (event) => note("fetched: " + event.blockedURI));
for (const kind of ["error", "warn"]) console[kind] = (...words) => note(words.join(" "));
addEventListener("load", () => {
  const element = (id) => document.getElementById(id);
  const coloured = () => {
    const drawn = document.querySelector("#viewer canvas");
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [drawn.width, drawn.height];
    const context = flat.getContext("2d");
    context.drawImage(drawn, 0, 0);
    const pixels = context.getImageData(0, 0, flat.width, flat.height).data;
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const [red, green, blue] = [pixels[i], pixels[i + 1], pixels[i + 2]];
      const [low, high] = [Math.min(red, green, blue), Math.max(red, green, blue)];
      if (pixels[i + 3] > 0 && high - low > 60) count++;
    }
    return count;
  };
  told.drawn = coloured();
  const first = element("told").textContent;
  element("frame").value = element("frame").max;
  element("frame").oninput();
  told.moved = element("told").textContent !== first;
  for (const style of ["trace", "stick"]) {
    element("style").value = style;
    element("style").onchange();
    told[style] = coloured();
  }
  for (const colours of ["chain", "motion"]) {
    element("colours").value = colours;
    element("colours").onchange();
  }
  element("path").selectedIndex = element("path").length - 1;
  element("path").onchange();
  told.wide = document.documentElement.scrollWidth > innerWidth;
});
</script>"##;

/// Opens the page in a browser, wide and narrow: nothing goes wrong, and structures are seen.
fn look(scratch: &Scratch, page: &str) {
    let watched = page.replacen("<style>", &format!("{WATCH}<style>"), 1);
    for width in [1280, 420] {
        let marks = Window::new(width, 900).open(scratch, &watched, "report");
        assert_eq!(marks.said("errors"), "", "{width}");
        for name in ["drawn", "trace", "stick"] {
            assert!(marks.count(name) > 100, "{width}: {name} of {marks:?}");
        }
        assert_eq!((marks.said("moved"), marks.said("wide")), ("true", "false"), "{width}");
    }
}
