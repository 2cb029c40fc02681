//! The three experiments, each written down as a page, a table and OBJ files.

use super::Asked;
use super::experiment::{Built, Outcome, along, built, deformable, obstacles, prepared, query};
use super::scenes::{Ways, letter_file, scene};
use super::shapes::LETTERS;
use roadmill::deformation::SoftBody;
use roadmill::export::{
    DeformedPage, deformed_page, energies_csv, frame_name, frame_obj, obstacles_obj,
};
use roadmill::problem::Problem;
use roadmill::roadmap::Configs;
use std::fs;
use std::path::Path;

/// Runs an experiment with the first seed.
pub fn run(name: &str, asked: &Asked) {
    let label = asked.method.as_deref().unwrap_or("bounding-box");
    let feasibility = "{ scales = 6, least = 0.5 }";
    let scene = scene(name);
    let method = scene.method(label);
    let ways = Ways { feasibility, method: &method, nodes: asked.nodes.unwrap_or(1000) };
    let folder = asked.out.join(format!("{name}-{label}"));
    let built = built(&scene, &folder, &ways, *asked.seeds.start());
    println!(
        "{name}: {} nodes, {} components, {:.2} s + {:.2} s",
        ways.nodes,
        built.roadmap.components().count(),
        built.seconds[0],
        built.seconds[1]
    );
    let robot = prepared(&built.problem);
    let body = robot.body();
    let outcome = query(&built, asked.limit);
    let Some(path) = written(&folder, name, &built, (body, label), &outcome) else { return };
    if name != "sliding" {
        return;
    }
    for letter in LETTERS.into_iter().skip(1) {
        let text = scene.problem(&ways).replace("letter-d.obj", &letter_file(letter));
        let file = folder.join(format!("sliding-{letter}.toml"));
        fs::write(&file, text).expect("a problem can be written");
        let problem = Problem::load(&file).unwrap_or_else(|error| panic!("{error}"));
        let robot = prepared(&problem);
        let outcome = along(&problem, &path, asked.limit);
        let name = format!("sliding-{letter}");
        written(&folder.join(&name), &name, &built, (robot.body(), label), &outcome);
    }
}

/// Writes a path, and prints what it is; its configurations.
fn written(
    folder: &Path,
    name: &str,
    built: &Built,
    (body, method): (&SoftBody, &str),
    outcome: &Outcome,
) -> Option<Configs> {
    let took = outcome.answer.deformations;
    let mut times = outcome.deformed.clone();
    times.sort_by(f64::total_cmp);
    println!(
        "{name}, {} triangles: {} deformations, {} failed, {} blends, {} edges removed, {:.2} s, of which deforming {:.2} s; a deformation {:.2} ms (median)",
        body.triangles().len(),
        took.tried,
        took.failed,
        took.blends,
        outcome.answer.removed.len(),
        outcome.seconds,
        outcome.deforming,
        1e3 * times.get(times.len() / 2).copied().unwrap_or(0.0),
    );
    for removed in outcome.answer.removed.iter().take(5) {
        println!("  an edge of weight {:.2} is removed: {}", removed.weight, removed.refusal);
    }
    let path = match &outcome.answer.path {
        Ok(path) => path,
        Err(why) => {
            println!("  no path: {why}");
            return None;
        }
    };
    let [least, greatest] = path.volumes();
    println!(
        "  {} frames of {} edges, {:?}, largest movement {:.4}, highest energy {:.3}, volume {least:.3} to {greatest:.3}",
        path.frames.len(),
        path.edges,
        path.between,
        path.largest_movement(),
        path.highest_energy()
    );
    let shapes = folder.join("frames");
    fs::create_dir_all(&shapes).expect("a folder can be made");
    let write = |name: &str, text: String| {
        fs::write(folder.join(name), text).expect("a file can be written");
    };
    let around = obstacles(&built.problem);
    write("frames/obstacles.obj", obstacles_obj(around));
    for (index, frame) in path.frames.iter().enumerate() {
        let name = frame_name(index, path.frames.len());
        write(&format!("frames/{name}"), frame_obj(body, frame));
    }
    write("energies.csv", energies_csv(&built.problem.space(), path));
    let settings = deformable(&built.problem).deformation();
    let facts = [
        ("method", method.to_owned()),
        ("clearance", settings.clearance.to_string()),
        ("deformations", format!("{}, {} failed", took.tried, took.failed)),
    ];
    let page = DeformedPage { title: name, facts: &facts, body, obstacles: around, path };
    write("page.html", deformed_page(&page));
    println!("  {}", folder.join("page.html").display());
    let mut configs = Configs::new(path.frames[0].configuration.len());
    path.frames.iter().for_each(|frame| configs.push(&frame.configuration));
    Some(configs)
}
