use super::svg;
use crate::img::{Grown, Setup, build};
use crate::problem::Problem;
use crate::query;
use std::path::Path;
use std::sync::Arc;

const SHAPES: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [4.0, 3.0, 3.0]
bounds = "reference"

[robot]
bodies = [
    { shape = { capsule = { radius = 0.1, height = 0.4 } } },
    { shape = { sphere = { radius = 0.15 } }, position = [0.0, 0.0, 0.3] },
]

[[obstacles]]
shape = { cylinder = { radius = 0.4, height = 2.0 } }
position = [2.0, 1.5, 1.0]
[[obstacles]]
shape = { box = { size = [0.5, 0.5, 0.5] } }
position = [2.0, 1.5, 2.25]

[query]
start = [0.5, 1.5, 1.0, 1.0, 0.0, 0.0, 0.0]
goal = [3.5, 1.5, 1.0, 1.0, 0.0, 0.0, 0.0]
"#;

fn built(name: &str, text: &str) -> (Arc<Setup>, Grown) {
    let problem = Problem::parse(Path::new(name), text).unwrap_or_else(|error| panic!("{error}"));
    let setup = Arc::new(Setup::new(problem));
    let build = build(&setup);
    (setup, build)
}

fn path_of(build: &Grown) -> Option<&query::Path> {
    build.judgement.as_ref()?.verdicts[0].answer.as_ref()?.path.as_ref()
}

/// Every element that is opened is closed, in order, and no number is broken.
fn assert_well_formed(picture: &str) {
    let mut open = Vec::new();
    for tag in picture.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').expect("a tag ends");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap_or_default());
        }
    }
    assert!(open.is_empty(), "{open:?} left open");
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
}

fn count(picture: &str, class: &str) -> usize {
    picture.matches(&format!("class=\"{class}\"")).count()
}

#[test]
fn a_planar_picture_holds_everything_once() {
    let (setup, build) = built("maze.toml", include_str!("../../problems/maze.toml"));
    let path = path_of(&build);
    assert!(path.is_some());
    let picture = svg(&setup.problem, &build.roadmap, path).expect("bodies can be drawn");
    assert_well_formed(&picture);
    assert_eq!(picture, svg(&setup.problem, &build.roadmap, path).expect("bodies can be drawn"));
    for (class, expected) in [
        ("bounds", 1),
        ("obstacle", setup.problem.model.bodies().map_or(0, |bodies| bodies.obstacles.len())),
        ("component", build.roadmap.components().count()),
        ("robot", 18),
        ("way", 1),
        ("start", 1),
        ("goal", 1),
    ] {
        assert_eq!(count(&picture, class), expected, "{class}");
    }
    assert!(picture.contains(&format!("{} nodes", build.roadmap.configs().len())));
}

#[test]
fn a_spatial_picture_holds_every_shape() {
    let (setup, build) = built("shapes.toml", SHAPES);
    let picture =
        svg(&setup.problem, &build.roadmap, path_of(&build)).expect("bodies can be drawn");
    assert_well_formed(&picture);
    for (class, expected) in [("obstacle", 2), ("robot", 36), ("way", 1), ("shadow", 1)] {
        assert_eq!(count(&picture, class), expected, "{class}");
    }
}

#[test]
fn without_a_path_only_the_ends_are_drawn() {
    let (setup, build) = built("sealed.toml", include_str!("../../problems/sealed.toml"));
    let picture = svg(&setup.problem, &build.roadmap, None).expect("bodies can be drawn");
    assert_well_formed(&picture);
    assert_eq!((count(&picture, "robot"), count(&picture, "way")), (2, 0));
    assert!(count(&picture, "component") >= 2);
    assert!(picture.len() < 1_000_000, "{} bytes", picture.len());
}

#[test]
fn an_empty_roadmap_of_a_point_is_drawn_too() {
    let text = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [1, 2]\n\
                bounds = \"body\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n\
                [query]\nstart = [0.1, 0.1]\ngoal = [0.9, 1.9]\n";
    let problem = Problem::parse(Path::new("p.toml"), text).unwrap();
    let mut named = problem.clone();
    named.name = "a<b>&c".to_owned();
    let empty = crate::roadmap::Roadmap::new(&problem.space());
    assert_well_formed(&svg(&named, &empty, None).expect("bodies can be drawn"));
}

/// Contours lie at multiples of ten up to the highest energy of a milestone, below the roadmap and the path.
#[test]
fn an_energy_is_drawn_by_its_contours_and_the_way_of_the_lowest_barrier() {
    let text =
        include_str!("../../problems/muller-brown.toml").replace("nodes = 5000", "nodes = 500");
    let (setup, build) = built("muller-brown.toml", &text);
    let path = path_of(&build).expect("a lowest barrier is found");
    let picture = svg(&setup.problem, &build.roadmap, Some(path)).expect("it can be drawn");
    assert_well_formed(&picture);
    for (class, expected) in [("contour", 14), ("component", 1), ("way", 1), ("start", 1)] {
        assert_eq!(count(&picture, class), expected, "{class}");
    }
    assert!(picture.contains(">contours every 10, from -140 to -10<"));
    assert!(picture.contains(&format!("path with climbs of {:.2}", path.length)));
    let place = |class: &str| picture.find(&format!("class=\"{class}\"")).expect("it is drawn");
    assert!(place("grid") < place("contour") && place("frame") < place("component"));
    // Without milestones contours go up to the middle one of all energies.
    let empty = crate::roadmap::Roadmap::new(&setup.problem.space());
    let picture = svg(&setup.problem, &empty, None).expect("it can be drawn");
    assert_well_formed(&picture);
    assert!(count(&picture, "contour") > 5);
}

#[test]
fn clearances_are_two_tables_of_bodies_among_obstacles() {
    let few = "[limits]\nnodes = 20\n[[strategies]]\nlabel = \"few\"\nnodes = 20\nsampler = { uniform = {} }\n\
               [img]\nsets_per_round = 1\n";
    let (scene, _) = SHAPES.split_once("[query]").expect("it has a query");
    let (setup, Grown { roadmap, .. }) = built("shapes.toml", &format!("{scene}{few}"));
    let format = super::FORMATS.iter().find(|format| format.name() == "clearance").expect("it is");
    let exported = super::Exported { problem: &setup.problem, roadmap: &roadmap, path: None };
    let files = format.files(&exported).expect("bodies among obstacles");
    let tables: Vec<&str> =
        files.iter().map(|file| std::str::from_utf8(&file.contents).expect("text")).collect();
    let numbers = |line: &str| -> Vec<f64> {
        line.split(',').map(|field| field.parse().expect("a number")).collect()
    };
    let nodes: Vec<Vec<f64>> = tables[0].lines().skip(1).map(numbers).collect();
    let edges: Vec<Vec<f64>> = tables[1].lines().skip(1).map(numbers).collect();
    assert_eq!((nodes.len(), edges.len()), (roadmap.configs().len(), roadmap.edges().len()));
    for edge in &edges {
        let [low, high] = [0, 1].map(|end| nodes[edge[end] as usize][1]);
        // length, least, mean
        assert!(edge[3] <= low.min(high) && edge[3] <= edge[4] + 0.1 && edge[2] > 0.0, "{edge:?}");
    }
    let open = SHAPES.split("[[obstacles]]").next().expect("a beginning");
    let problem =
        Problem::parse(Path::new("open.toml"), &format!("{open}{few}")).expect("a problem");
    let exported = super::Exported { problem: &problem, roadmap: &roadmap, path: None };
    assert!(format.files(&exported).is_err());
}
