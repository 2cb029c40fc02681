//! Plots as SVG: panels, four to a row, each with lines or dots over two axes.

use super::plot::{FONT, INK, PAPER, RULE};
use std::fmt::Write;

/// Of a panel's frame, in pixels, with what stands around it.
const SIZE: [f64; 2] = [330.0, 300.0];
/// To the left, above, to the right, below.
const AROUND: [f64; 4] = [62.0, 44.0, 18.0, 56.0];
const PER_ROW: usize = 4;

#[derive(Clone, Copy, PartialEq)]
pub enum Look {
    Line,
    Dots,
    /// A short level stroke at each point.
    Dashes,
}

pub struct Series {
    pub name: String,
    pub colour: &'static str,
    pub look: Look,
    pub points: Vec<[f64; 2]>,
}

pub struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub log_y: bool,
    /// Words in the place of numbers along x.
    pub words: Vec<(f64, String)>,
    pub series: Vec<Series>,
}

/// Where a panel's values lie in the picture.
struct Axes {
    left: f64,
    top: f64,
    x: [f64; 2],
    y: [f64; 2],
    log_y: bool,
}

impl Axes {
    fn of(panel: &Panel, index: usize) -> Axes {
        let points = || panel.series.iter().flat_map(|series| &series.points);
        let range = |axis: usize| {
            let fold = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
            points().map(|point| point[axis]).fold([f64::INFINITY, f64::NEG_INFINITY], fold)
        };
        let mut x = range(0);
        let mut y = range(1);
        if let ([first, ..], [.., last]) = (&panel.words[..], &panel.words[..]) {
            x = [first.0 - 0.5, last.0 + 0.5];
        }
        if panel.log_y {
            y = [libm::log10(y[0]).floor(), libm::log10(y[1]).ceil()];
        } else {
            y = [y[0].min(0.0), y[1] * 1.05];
        }
        for range in [&mut x, &mut y] {
            if range[1] <= range[0] {
                range[1] = range[0] + 1.0;
            }
        }
        let [left, top, right, bottom] = AROUND;
        let (row, column) = ((index / PER_ROW) as f64, (index % PER_ROW) as f64);
        let left = left + column * (SIZE[0] + left + right);
        let top = top + row * (SIZE[1] + top + bottom);
        Axes { left, top, x, y, log_y: panel.log_y }
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let y = if self.log_y { libm::log10(y) } else { y };
        let share =
            [(x - self.x[0]) / (self.x[1] - self.x[0]), (y - self.y[0]) / (self.y[1] - self.y[0])];
        [self.left + share[0] * SIZE[0], self.top + (1.0 - share[1]) * SIZE[1]]
    }

    fn y_ticks(&self) -> Vec<f64> {
        if self.log_y {
            (self.y[0] as i32..=self.y[1] as i32)
                .map(|power| libm::exp10(f64::from(power)))
                .collect()
        } else {
            ticks(self.y)
        }
    }
}

/// Round numbers in a range, about five.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    let unit = libm::exp10(libm::log10(rough).floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|times| times * unit);
    let step = step.into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}

fn text(out: &mut String, [x, y]: [f64; 2], look: &str, words: &str) {
    writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" {FONT} fill=\"{INK}\" {look}>{words}</text>")
        .expect("memory");
}

fn stroke(out: &mut String, path: &str, colour: &str, width: f64) {
    writeln!(
        out,
        "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\" fill=\"none\"/>"
    )
    .expect("memory");
}

/// The picture of some panels; the names of the first one's series, of those that have names, stand below.
pub fn svg(panels: &[Panel]) -> String {
    let [left, top, right, bottom] = AROUND;
    let rows = panels.len().div_ceil(PER_ROW) as f64;
    let width = panels.len().min(PER_ROW) as f64 * (SIZE[0] + left + right);
    let height = rows * (top + SIZE[1] + bottom) + 34.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
         <rect width=\"{width}\" height=\"{height}\" rx=\"10\" fill=\"{PAPER}\"/>\n"
    );
    for (index, panel) in panels.iter().enumerate() {
        draw(&mut out, panel, &Axes::of(panel, index));
    }
    let mut x = left;
    let series = panels.first().map_or(&[][..], |panel| &panel.series);
    for series in series.iter().filter(|series| !series.name.is_empty()) {
        let y = height - 20.0;
        stroke(&mut out, &format!("M{x:.1} {y:.1}h18"), series.colour, 4.0);
        text(&mut out, [x + 26.0, y + 5.0], "font-size=\"14\"", &series.name);
        x += 54.0 + 8.0 * series.name.chars().count() as f64;
    }
    out + "</svg>\n"
}

fn draw(out: &mut String, panel: &Panel, axes: &Axes) {
    let [left, top, right, low] = [axes.left, axes.top, axes.left + SIZE[0], axes.top + SIZE[1]];
    let middle = left + SIZE[0] / 2.0;
    for tick in axes.y_ticks() {
        let [_, y] = axes.at([axes.x[0], tick]);
        stroke(out, &format!("M{left:.1} {y:.1}H{right:.1}"), RULE, 0.8);
        text(out, [left - 8.0, y + 4.0], "font-size=\"12\" text-anchor=\"end\"", &number(tick));
    }
    let words: Vec<(f64, String)> = match panel.words.is_empty() {
        true => ticks(axes.x).into_iter().map(|tick| (tick, number(tick))).collect(),
        false => panel.words.clone(),
    };
    for (tick, word) in words {
        let [x, _] = axes.at([tick, 1.0]);
        text(out, [x, low + 18.0], "font-size=\"12\" text-anchor=\"middle\"", &word);
    }
    stroke(out, &format!("M{left:.1} {top:.1}V{low:.1}H{right:.1}"), INK, 1.2);
    text(
        out,
        [middle, top - 16.0],
        "font-size=\"15\" font-weight=\"600\" text-anchor=\"middle\"",
        &panel.title,
    );
    text(out, [middle, low + 38.0], "font-size=\"13\" text-anchor=\"middle\"", &panel.x_label);
    let [x, y] = [left - 46.0, top + SIZE[1] / 2.0];
    let turned =
        format!("font-size=\"13\" text-anchor=\"middle\" transform=\"rotate(-90 {x:.1} {y:.1})\"");
    text(out, [x, y], &turned, &panel.y_label);
    for series in &panel.series {
        let mut path = String::new();
        for (index, point) in series.points.iter().enumerate() {
            let [x, y] = axes.at(*point);
            match (series.look, index) {
                (Look::Line, 1..) => write!(path, "L{x:.1} {y:.1}"),
                (Look::Line, 0) => write!(path, "M{x:.1} {y:.1}"),
                (Look::Dots, _) => write!(path, "M{x:.1} {y:.1}h0"),
                (Look::Dashes, _) => write!(path, "M{:.1} {y:.1}h60", x - 30.0),
            }
            .expect("memory");
        }
        let width = if series.look == Look::Dots { 5.0 } else { 2.0 };
        stroke(out, &path, series.colour, width);
    }
}
