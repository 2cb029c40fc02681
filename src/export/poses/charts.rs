//! The pictures: energies along ways out, the funnel, and energies before and after descent.

use super::super::markup::escaped;
use super::super::report::chart::{Axis, Frame, legend};
use super::{PosesPage, colour};
use std::fmt::Write;

/// Width and height of the pictures, in pixels.
const SIZE: [f64; 2] = [560.0, 330.0];
const WIDE: [f64; 2] = [1120.0, 230.0];

/// At most so many minima are drawn as points; of more, those at even distances in the list.
const POINTS_MAX: usize = 6000;

/// Energies above this share of all are drawn at the upper edge of the funnel.
const SHOWN: f64 = 0.95;

/// The colours of energies before descent, and after.
const BEFORE: &str = "#c1440e";
const AFTER: &str = "#0072b2";

/// The energies along the way out of every pose that has one; the page shows that of the chosen pose.
pub(super) fn ways(page: &PosesPage) -> String {
    let mut html = String::new();
    for (number, pose) in page.poses.iter().enumerate() {
        if pose.way_out.is_empty() {
            continue;
        }
        let points: Vec<[f64; 2]> =
            pose.way_out.iter().map(|frame| [frame.along, frame.energy]).collect();
        let of = |axis: usize| points.iter().map(move |point| point[axis]);
        let about = format!("Energy along the way out of {}", pose.label);
        let axes = ["way, Å", "energy, kJ/mol"].map(str::to_owned);
        let mut frame = Frame::new(&about, &axes, Axis::over(of(0)), Axis::over(of(1)), WIDE);
        let colour = colour(pose.cluster);
        frame.line(&points, "line", colour, false);
        let places: Vec<String> = (points.iter())
            .map(|point| {
                let [x, y] = frame.place(*point).map(|x| if x.is_finite() { x } else { 0.0 });
                format!("{x:.1},{y:.1}")
            })
            .collect();
        frame.put(format_args!(
            "<circle class=\"cursor\" r=\"5\" data-places=\"{}\"/>",
            places.join(" ")
        ));
        write!(
            html,
            "<figure class=\"way\" data-pose=\"{number}\"><figcaption>{}</figcaption>\n{}</figure>\n",
            escaped(&about),
            frame.finish()
        )
        .expect("writing to memory cannot fail");
    }
    html
}

/// The section of the pictures of all minima.
pub(super) fn all(page: &PosesPage) -> String {
    let pictures = [funnel(page), descent(page)].concat();
    if pictures.is_empty() {
        return pictures;
    }
    format!("<section><h2>All minima</h2>\n<div class=\"pictures\">\n{pictures}</div></section>\n")
}

/// Energies of all minima over their RMSD from the reference or, without one, over the distance from the pose of lowest energy.
fn funnel(page: &PosesPage) -> String {
    let has_rmsd = page.minima.iter().any(|minimum| minimum.rmsd.is_some());
    let abscissa = |minimum: &super::Minimum| match has_rmsd {
        true => minimum.rmsd.unwrap_or(f64::NAN),
        false => minimum.distance,
    };
    let points: Vec<([f64; 2], Option<usize>)> = (page.minima.iter())
        .map(|minimum| ([abscissa(minimum), minimum.energy], minimum.pose))
        .filter(|(point, _)| point.iter().all(|x| x.is_finite()))
        .collect();
    if points.is_empty() {
        return String::new();
    }
    let mut energies: Vec<f64> = points.iter().map(|(point, _)| point[1]).collect();
    energies.sort_unstable_by(f64::total_cmp);
    let shown = (SHOWN * (energies.len() - 1) as f64) as usize;
    let poses = points.iter().filter(|(_, pose)| pose.is_some()).map(|(point, _)| point[1]);
    let ceiling = poses.chain(page.reference_energy).fold(energies[shown], f64::max);
    let above = energies.iter().filter(|energy| **energy > ceiling).count();

    let title = match has_rmsd {
        true => "energy and RMSD from the reference",
        false => "energy and distance from the pose of lowest energy",
    };
    let axes = [
        if has_rmsd { "RMSD, Å" } else { "distance of centres, Å" }.to_owned(),
        "energy, kJ/mol".to_owned(),
    ];
    let x = Axis::over(points.iter().map(|(point, _)| point[0]).chain([0.0]));
    let y =
        Axis::over(energies.iter().copied().filter(|e| *e <= ceiling).chain(page.reference_energy));
    let mut frame = Frame::new(title, &axes, x, y, SIZE);
    let step = points.len().div_ceil(POINTS_MAX).max(1);
    let mut cloud = String::new();
    for ([x, y], _) in points.iter().step_by(step) {
        let [x, y] = frame.place([*x, y.min(ceiling)]);
        write!(cloud, "M{x:.1} {y:.1}h0").expect("writing to memory cannot fail");
    }
    frame.put(format_args!("<path class=\"cloud\" d=\"{cloud}\"/>"));
    // The best pose is drawn last, above the others.
    let mut shown: Vec<([f64; 2], usize)> =
        points.iter().filter_map(|(point, pose)| Some((*point, (*pose)?))).collect();
    shown.sort_by_key(|(_, pose)| std::cmp::Reverse(*pose));
    for (point, number) in shown {
        let Some(pose) = page.poses.get(number) else { continue };
        let [x, y] = frame.place(point);
        frame.put(format_args!(
            "<circle class=\"pose\" data-pose=\"{number}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5.5\" fill=\"{}\"><title>{}</title></circle>",
            colour(pose.cluster),
            escaped(&pose.label)
        ));
    }
    if has_rmsd && let Some(energy) = page.reference_energy.filter(|energy| energy.is_finite()) {
        let [x, y] = frame.place([0.0, energy]);
        frame.put(format_args!(
            "<path class=\"mark\" d=\"M{:.1} {y:.1}h10M{x:.1} {:.1}v10\"><title>the reference: {energy:.1} kJ/mol</title></path>",
            x - 5.0,
            y - 5.0
        ));
    }
    let mut note =
        format!("{} minima; poses of the table in the colours of their clusters", points.len());
    if has_rmsd && page.reference_energy.is_some() {
        note += "; + the reference";
    }
    if step > 1 {
        write!(note, "; one in {step} is drawn").expect("writing to memory cannot fail");
    }
    if above > 0 {
        write!(note, "; the highest {above} are at the upper edge")
            .expect("writing to memory cannot fail");
    }
    figure(&format!("Funnel: {title}"), &escaped(&note), &frame.finish())
}

/// The energies of all configurations in rising order, before descent and after (O. B. Bayazit 2003, Figure 24).
fn descent(page: &PosesPage) -> String {
    let sorted = |energies: &[f64]| -> Vec<[f64; 2]> {
        let mut rising: Vec<f64> = energies.iter().copied().filter(|e| e.is_finite()).collect();
        rising.sort_unstable_by(f64::total_cmp);
        // Shares, so that lists of different lengths can be compared.
        let last = rising.len().saturating_sub(1).max(1) as f64;
        let share = |place: usize| 100.0 * place as f64 / last;
        rising.into_iter().enumerate().map(|(place, energy)| [share(place), energy]).collect()
    };
    let lists =
        [("before descent", BEFORE, sorted(page.before)), ("after", AFTER, sorted(page.after))];
    if lists.iter().all(|(_, _, points)| points.is_empty()) {
        return String::new();
    }
    let energies = lists.iter().flat_map(|(_, _, points)| points.iter().map(|point| point[1]));
    let axes = ["configurations in rising energy, %", "energy, kJ/mol"].map(str::to_owned);
    let title = "energies before and after descent, sorted";
    let y = Axis::signed_log_over(energies.chain([0.0]));
    let mut frame = Frame::new(title, &axes, Axis::over([0.0, 100.0].into_iter()), y, SIZE);
    let ([left, _, right, _], [_, zero]) = (frame.sides(), frame.place([0.0, 0.0]));
    frame.put(format_args!("<path class=\"level\" d=\"M{left:.1} {zero:.1}H{right:.1}\"/>"));
    for (_, colour, points) in &lists {
        frame.line(points, "line", colour, false);
    }
    let note = legend(lists.iter().map(|(name, colour, _)| (*name, *colour, false)));
    let html = format!(
        "{note}<span class=\"legend\">the axis goes with the logarithm beyond ±10 kJ/mol</span>"
    );
    figure("Energies before and after descent, sorted", &html, &frame.finish())
}

/// A picture with its title, and a note that is HTML.
fn figure(title: &str, note: &str, svg: &str) -> String {
    format!(
        "<figure><figcaption>{} <span class=\"legend\">{note}</span></figcaption>\n{svg}</figure>\n",
        escaped(title)
    )
}
