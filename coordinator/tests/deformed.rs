//! The page that plays a deformed robot, looked at in a browser.

mod support;

use roadmill::deformation::{Between, DeformedPath, Frame, SoftBody};
use roadmill::export::{DeformedPage, deformed_page};
use roadmill::scene::{Body, Mesh, Pose, Shape, box_surface};
use std::sync::Arc;
use support::Scratch;
use support::browser::{Window, has_browser};

/// A cube that goes along x and is flattened on its way under a block.
fn page() -> String {
    let (corners, triangles) = box_surface([2.0; 3]);
    let body = SoftBody::new(Mesh { vertices: corners.to_vec(), triangles }).expect("closed");
    let frame = |index: usize| {
        let share = index as f64 / 20.0;
        let flat = 1.0 - 2.0 * share * (1.0 - share);
        let vertices: Arc<[[f64; 3]]> =
            body.vertices().iter().map(|[x, y, z]| [*x, *y, flat * z]).collect();
        Frame {
            configuration: vec![4.0 * share, 0.0, 0.0],
            pose: Pose { translation: [4.0 * share, 0.0, 0.0], ..Pose::IDENTITY },
            volume: body.volume_share(&vertices),
            vertices,
            energy: 8.0 * (1.0 - flat),
            share,
            edge: 0,
            is_blend: false,
        }
    };
    let frames = (0..=20).map(frame).collect();
    let path = DeformedPath { frames, edges: 1, between: Between::Sampled };
    let pose = Pose { translation: [2.0, 0.0, 1.5], ..Pose::IDENTITY };
    let block = Body { shape: Shape::Box { size: [0.5, 2.0, 1.0] }, pose, solid: true };
    deformed_page(&DeformedPage {
        title: "a cube",
        facts: &[],
        body: &body,
        obstacles: &[block],
        path: &path,
    })
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
  const of = (id) => document.getElementById(id);
  const drawn = () => {
    paint();
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [canvas.width, canvas.height];
    const context = flat.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return context.getImageData(0, 0, flat.width, flat.height).data;
  };
  const differ = (a, b) => {
    let count = 0;
    for (let i = 0; i < a.length; i += 4) if (Math.abs(a[i] - b[i]) > 8) count++;
    return count;
  };
  told.playing = of("play").textContent;
  of("play").click();
  of("frame").value = 0;
  of("frame").oninput();
  const start = drawn();
  told.seen = differ(start, start.map(() => start[0]));
  told.said = of("told").textContent;
  const mark = document.querySelector(".cursor").getAttribute("cx");
  of("frame").value = 10;
  of("frame").oninput();
  const middle = drawn();
  told.moved = differ(start, middle);
  told.mark = document.querySelector(".cursor").getAttribute("cx") !== mark;
  of("show-mesh").click();
  told.mesh = differ(middle, drawn());
  of("show-mesh").click();
  of("show-obstacles").click();
  told.obstacles = differ(middle, drawn());
  of("view").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
  told.turned = differ(middle, drawn());
  of("home").click();
  told.wide = document.documentElement.scrollWidth > innerWidth;
});
</script>"##;

/// In light and in dark, wide and narrow: nothing goes wrong, and what the controls do is seen.
#[test]
fn a_deformed_robot_is_played() {
    if !has_browser() {
        return;
    }
    let scratch = Scratch::new();
    let watched = page().replacen("<style>", &format!("{WATCH}<style>"), 1);
    for (width, is_dark) in [(1280, false), (420, true)] {
        let marks =
            Window { is_dark, ..Window::new(width, 900) }.open(&scratch, &watched, "squeeze");
        let said = |name: &str| marks.said(name);
        assert_eq!(said("errors"), "", "{width}");
        assert_eq!((said("mark"), said("wide"), said("playing")), ("true", "false", "pause"));
        assert!(said("said").starts_with("frame 1 of 21, 0 % of the path, energy 0"), "{marks:?}");
        for name in ["seen", "moved", "mesh", "obstacles", "turned"] {
            assert!(marks.count(name) > 100, "{width}: {name} of {marks:?}");
        }
    }
}
