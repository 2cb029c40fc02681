//! Tables VII and VIII of the dissertation, beside the dissertation's numbers.

use super::Asked;
use super::experiment::{built, query};
use super::rows::median;
use super::scenes::{Ways, scene};

/// The head of the rows.
const HEAD: &str = "study,scene,feasibility,vectors,method,nodes,seed,components,generation,connection,solved,query,deforming,tried,failed,mean_deformation,frames,highest_energy,removed";
const METHODS: [&str; 2] = ["bounding-box", "geometric"];

/// The medians of a row's columns over the seeds.
struct Row {
    components: f64,
    generation: f64,
    connection: f64,
    /// At how many seeds of how many the query was answered.
    solved: [usize; 2],
    query: f64,
    deforming: f64,
    tried: f64,
    failed: f64,
    /// CPU milliseconds of a deformation that found a shape.
    mean: f64,
}

/// The runs of one combination.
fn row(asked: &mut Asked, study: &str, name: &str, ways: &Ways, labels: [&str; 2]) -> Row {
    let [feasibility, method] = labels;
    let nodes = ways.nodes;
    let limit = asked.limit;
    let rows: Vec<Vec<f64>> = (asked.seeds.clone())
        .flat_map(|seed| {
            let vectors = asked.vectors;
            let key = format!("{study},{name},{feasibility},{vectors},{method},{nodes},{seed}");
            let folder = asked.out.join(format!("{study}-{name}-{feasibility}-{method}"));
            asked.rows.of(HEAD, &key, || {
                eprintln!("{key}");
                vec![measured(&built(&scene(name), &folder, ways, seed), limit)]
            })
        })
        .collect();
    let of = |column: usize| median(rows.iter().map(|row| row[column]).collect());
    // Where no deformation succeeded there is no mean.
    let means = rows.iter().map(|row| row[8]).filter(|mean| *mean > 0.0).collect();
    Row {
        components: of(0),
        generation: of(1),
        connection: of(2),
        solved: [rows.iter().filter(|row| row[3] == 1.0).count(), rows.len()],
        query: of(4),
        deforming: of(5),
        tried: of(6),
        failed: of(7),
        mean: 1e3 * median(means),
    }
}

/// The numbers of a run's row.
fn measured(built: &super::experiment::Built, limit: f64) -> Vec<f64> {
    let outcome = query(built, limit);
    let count = outcome.deformed.len();
    let mean = if count == 0 { 0.0 } else { outcome.deformed.iter().sum::<f64>() / count as f64 };
    let took = outcome.answer.deformations;
    let path = outcome.answer.path.as_ref();
    if let Err(why) = path {
        eprintln!("  {why}");
    }
    vec![
        built.roadmap.components().count() as f64,
        built.seconds[0],
        built.seconds[1],
        f64::from(u8::from(path.is_ok())),
        outcome.seconds,
        outcome.deforming,
        took.tried as f64,
        took.failed as f64,
        mean,
        path.map_or(0.0, |path| path.frames.len() as f64),
        path.map_or(0.0, |path| path.highest_energy()),
        outcome.answer.removed.len() as f64,
    ]
}

/// Table VII.
pub fn table1(mut asked: Asked) {
    let paper = [
        ("sliding", "scaled", "65 | 5.4 (2.7 + 2.7)", "40 | 13 300"),
        ("sliding", "penetrating", "16 | 16.5 (8.4 + 8.1)", "40 | 13 300"),
        ("narrow", "scaled", "87 | 16.2 (0.5 + 15.7)", "400 | 86 000"),
        ("narrow", "penetrating", "35 | 116.9 (25.9 + 91)", "400 | 86 000"),
        ("stamping", "scaled", "9 | 5.2 (0.1 + 5.1)", "860 | 536 000"),
        ("stamping", "penetrating", "1 | 124.2 (50.5 + 73.8)", "860 | 536 000"),
    ];
    let nodes = asked.nodes.unwrap_or(1000);
    println!(
        "| scene | feasible by | #CC | paper | s (gen. + con.) | paper | solved, box | solved, geometric | ms, box | ms, geometric | paper, box | paper, geometric | geometric : box |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, feasibility, roadmap, deformation) in paper {
        if !asked.scenes.is_empty() && !asked.scenes.iter().any(|of| of == name) {
            continue;
        }
        let depth = penetration(&asked, 25.0 * scene(name).resolution);
        let text: &str =
            if feasibility == "scaled" { "{ scales = 6, least = 0.5 }" } else { &depth };
        let [boxes, geometric] = METHODS.map(|label| {
            let method = scene(name).method(label);
            let ways = Ways { feasibility: text, method: &method, nodes };
            is_asked(&asked, label)
                .then(|| row(&mut asked, "table1", name, &ways, [feasibility, label]))
        });
        let Some(first) = boxes.as_ref().or(geometric.as_ref()) else { continue };
        let solved = |row: &Option<Row>| match row {
            Some(Row { solved: [some, all], .. }) => format!("{some} of {all}"),
            None => "–".to_owned(),
        };
        let mean = |row: &Option<Row>| row.as_ref().map_or(f64::NAN, |row| row.mean);
        println!(
            "| {name} | {feasibility} | {} | {} | {:.2} ({:.2} + {:.2}) | {} | {} | {} | {:.2} | {:.2} | {} | {:.0} |",
            first.components,
            roadmap.split(" | ").next().unwrap_or_default(),
            first.generation + first.connection,
            first.generation,
            first.connection,
            roadmap.split(" | ").nth(1).unwrap_or_default(),
            solved(&boxes),
            solved(&geometric),
            mean(&boxes),
            mean(&geometric),
            deformation,
            mean(&geometric) / mean(&boxes),
        );
    }
}

/// Table VIII.
pub fn table2(mut asked: Asked) {
    let r = scene("narrow").resolution;
    let [large, small] = [25.0, 15.0].map(|times| penetration(&asked, times * r));
    let paper = [
        ("2-scales", "{ scales = [1.0, 0.5] }", "22 | 2.8", "619 | 617 | 1403 | 25", "–"),
        (
            "6-scales",
            "{ scales = 6, least = 0.5 }",
            "21 | 4.3",
            "82 | 81 | 199 | 0",
            "322 | 322 | 212 | 1",
        ),
        ("depth-25r", large.as_str(), "3 | 14.9", "144 | 144 | 328 | 4", "514 | 514 | 344 | 3"),
        ("depth-15r", small.as_str(), "14 | 25.6", "75 | 75 | 162 | 2", "255 | 255 | 174 | 1"),
    ];
    let nodes = asked.nodes.unwrap_or(350);
    println!(
        "| feasible by | method | #CC | roadmap, s | paper: #CC, s | solved | query, s | deforming, s | share | #deform | #failed | paper: query, deforming, #deform, #failed |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (label, text, roadmap, boxes, geometric) in paper {
        if !asked.scenes.is_empty() && !asked.scenes.iter().any(|of| of == label) {
            continue;
        }
        for (name, of_paper) in METHODS.into_iter().zip([boxes, geometric]) {
            if !is_asked(&asked, name) {
                continue;
            }
            let method = scene("narrow").method(name);
            let ways = Ways { feasibility: text, method: &method, nodes };
            let row = row(&mut asked, "table2", "narrow", &ways, [label, name]);
            let unit = if name == "geometric" { " (min)" } else { " (s)" };
            println!(
                "| {label} | {name} | {} | {:.2} | {} | {} of {} | {:.2} | {:.2} | {:.1} % | {} | {} | {}{unit} |",
                row.components,
                row.generation + row.connection,
                roadmap.replace(" | ", ", "),
                row.solved[0],
                row.solved[1],
                row.query,
                row.deforming,
                100.0 * row.deforming / row.query,
                row.tried,
                row.failed,
                of_paper.replace(" | ", ", "),
            );
        }
    }
}

/// The feasibility by penetration up to a depth.
fn penetration(asked: &Asked, depth: f64) -> String {
    format!("{{ depth = {depth}, vectors = {} }}", asked.vectors)
}

fn is_asked(asked: &Asked, method: &str) -> bool {
    asked.method.as_ref().is_none_or(|only| only == method)
}
