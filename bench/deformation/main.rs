//! Deformable robots: the three experiments of O. B. Bayazit's dissertation (2003), chapter VI E, and its Tables VII and VIII.
//!
//! ```text
//! cargo bench --bench deformation -- sliding | narrow | stamping [--method bounding-box|geometric] [--seeds 1] [--out FOLDER]
//! cargo bench --bench deformation -- table1 [--csv FILE] [--seeds 1-3] [--nodes 1000] [--vectors 20] [--limit 600] [SCENE …]
//! cargo bench --bench deformation -- table2 [--csv FILE] [--seeds 1-3] [--nodes 350] [--vectors 20] [--limit 600] [2-scales|6-scales|depth-25r|depth-15r …]
//! cargo bench --bench deformation -- speed | lattice
//! ```
//!
//! The first three write the scene as a problem file with its meshes to FOLDER (default: in the target folder), build a roadmap of scaled robots, deform the robot along a
//! path, and write the path as a page, as a table of energies and as OBJ files; in `sliding` the path of D is given to the
//! other letters. `table1` is the dissertation's Table VII: 1000 nodes by scaled robots and by penetration, both methods. `table2` is its
//! Table VIII: 350 nodes in the narrow passage, two and six scales, depths of 25 and 15 times the resolution, with `--vectors` vectors. A query ends when
//! deforming has taken `--limit` CPU seconds. `speed` times single deformations by the lattice of 13 × 9 × 7 points in the narrow passage, and `lattice`
//! compares settings of the lattice in scenes of its own. With `--csv` a run's row is appended as it ends, and
//! runs that stand there are not made again. Times are CPU seconds of this thread, and medians over the seeds.

mod experiment;
mod lattice;
mod nets;
#[path = "../support/rows.rs"]
mod rows;
mod scenes;
mod shapes;
mod show;
mod speed;
mod tables;
#[allow(dead_code, reason = "rows have a median of their own")]
#[path = "../support/timing.rs"]
mod timing;

use rows::Rows;
use std::path::PathBuf;

/// What is asked for.
pub struct Asked {
    /// The scenes, of Table VIII how configurations are feasible; none: all.
    pub scenes: Vec<String>,
    /// The base seeds.
    pub seeds: std::ops::RangeInclusive<u64>,
    /// The name of a method of deformation; `None`: all of the study.
    pub method: Option<String>,
    /// The nodes of a roadmap; `None`: those of the study.
    pub nodes: Option<usize>,
    /// How many vectors a configuration may be moved by, of roadmaps by penetration.
    pub vectors: u32,
    /// CPU seconds after which a query's deforming ends.
    pub limit: f64,
    /// Where scenes and paths are written.
    pub out: PathBuf,
    /// Where rows are kept.
    pub rows: Rows,
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let study = arguments.next().unwrap_or_default();
    let mut asked = Asked {
        scenes: Vec::new(),
        seeds: 1..=3,
        method: None,
        nodes: None,
        vectors: 20,
        limit: 600.0,
        out: PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("deformation"),
        rows: Rows::open(None),
    };
    while let Some(argument) = arguments.next() {
        let mut next = || arguments.next().expect("a value follows an option");
        match argument.as_str() {
            "--csv" => asked.rows = Rows::open(Some(&next())),
            "--method" => asked.method = Some(next()),
            "--nodes" => asked.nodes = Some(next().parse().expect("a number of nodes")),
            "--vectors" => asked.vectors = next().parse().expect("a number of vectors"),
            "--limit" => asked.limit = next().parse().expect("seconds"),
            "--out" => asked.out = PathBuf::from(next()),
            "--seeds" => {
                let text = next();
                let (first, last) = text.split_once('-').unwrap_or((&text, &text));
                asked.seeds = first.parse().expect("a seed")..=last.parse().expect("a seed");
            }
            _ => asked.scenes.push(argument),
        }
    }
    match study.as_str() {
        "sliding" | "narrow" | "stamping" => show::run(&study, &asked),
        "table1" => tables::table1(asked),
        "table2" => tables::table2(asked),
        "speed" => speed::run(&asked),
        "lattice" => lattice::run(),
        other => {
            eprintln!(
                "study `{other}` found; sliding, narrow, stamping, table1, table2, speed or lattice expected"
            );
            std::process::exit(2);
        }
    }
}
