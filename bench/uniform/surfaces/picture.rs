//! Small multiples: bars and dots, as SVG files without references to others.

use crate::support::plot::{FONT, INK, PAPER, RULE};
use std::fmt::Write;

/// Room for titles above and for numbers to the left of panels, and between them, in pixels.
const TOP: f64 = 74.0;
const LEFT: f64 = 46.0;
const GAP: f64 = 46.0;
/// Panels in a row.
const PER_ROW: usize = 3;

/// A panel of bars.
pub struct Bars {
    pub title: String,
    /// Heights and colours.
    pub heights: Vec<(f64, &'static str)>,
    /// A level stroke over each bar: where the law has it.
    pub ideals: Vec<f64>,
}

/// A panel of dots.
pub struct Dots {
    pub title: String,
    pub points: Vec<[f64; 2]>,
    /// Outlines that are filled behind the dots.
    pub outlines: Vec<Outline>,
}

/// An obstacle seen from above.
#[derive(Clone, Copy)]
pub enum Outline {
    Disc { at: [f64; 2], radius: f64 },
    Square { at: [f64; 2], edge: f64 },
}

struct Sheet {
    out: String,
}

impl Sheet {
    fn new(title: &str, legend: &[(&str, &str)], [width, height]: [f64; 2]) -> Sheet {
        let mut sheet = Sheet { out: String::new() };
        sheet.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" {FONT} font-size=\"12\" fill=\"{INK}\">"
        ));
        sheet.put(format_args!("<rect width=\"{width}\" height=\"{height}\" fill=\"{PAPER}\"/>"));
        sheet.put(format_args!(
            "<text x=\"{LEFT}\" y=\"24\" font-size=\"15\" font-weight=\"600\">{title}</text>"
        ));
        let mut x = LEFT;
        for (name, colour) in legend {
            sheet.put(format_args!(
                "<rect x=\"{x:.0}\" y=\"34\" width=\"10\" height=\"10\" fill=\"{colour}\"/><text x=\"{:.0}\" y=\"43.5\">{name}</text>",
                x + 15.0
            ));
            x += 36.0 + 7.0 * name.chars().count() as f64;
        }
        sheet
    }

    fn put(&mut self, text: std::fmt::Arguments) {
        self.out.write_fmt(text).expect("writing to memory cannot fail");
        self.out.push('\n');
    }

    fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}

/// Width and height of a sheet of so many panels.
fn sheet_size(panels: usize, [width, height]: [f64; 2]) -> [f64; 2] {
    let (columns, rows) = (panels.clamp(1, PER_ROW), panels.div_ceil(PER_ROW).max(1));
    let wide = LEFT + columns as f64 * (width + GAP);
    [wide.max(700.0), TOP + rows as f64 * (height + GAP) - GAP + 24.0]
}

/// The left upper corner of a panel.
fn corner(index: usize, [width, height]: [f64; 2]) -> [f64; 2] {
    let (row, column) = (index / PER_ROW, index % PER_ROW);
    [LEFT + column as f64 * (width + GAP), TOP + row as f64 * (height + GAP)]
}

/// Bars as percentages, all panels to one scale.
pub fn bars(title: &str, legend: &[(&str, &str)], panels: &[Bars]) -> String {
    let size = [260.0, 130.0];
    let mut sheet = Sheet::new(title, legend, sheet_size(panels.len(), size));
    let highest = panels
        .iter()
        .flat_map(|panel| {
            panel.heights.iter().map(|(height, _)| *height).chain(panel.ideals.iter().copied())
        })
        .fold(0.0, f64::max);
    let step = [0.01, 0.02, 0.05, 0.1, 0.2].into_iter().find(|step| highest / step <= 6.0);
    let step = step.unwrap_or(0.25);
    let most = (highest / step).ceil().max(1.0) * step;
    for (index, panel) in panels.iter().enumerate() {
        let [left, top] = corner(index, size);
        let bottom = top + size[1];
        sheet.put(format_args!(
            "<text x=\"{left:.0}\" y=\"{:.0}\" font-weight=\"600\">{}</text>",
            top - 8.0,
            panel.title
        ));
        let mut tick = 0.0;
        while tick <= most + 1e-9 {
            let y = bottom - size[1] * tick / most;
            sheet.put(format_args!(
                "<path d=\"M{left:.1} {y:.1}h{}\" stroke=\"{RULE}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{:.0} %</text>",
                size[0],
                left - 5.0,
                y + 4.0,
                100.0 * tick
            ));
            tick += step;
        }
        let pitch = size[0] / panel.heights.len() as f64;
        for (bar, (height, colour)) in panel.heights.iter().enumerate() {
            let (x, tall) = (left + bar as f64 * pitch, size[1] * height / most);
            sheet.put(format_args!(
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{tall:.1}\" fill=\"{colour}\"/>",
                x + 0.15 * pitch,
                bottom - tall,
                0.7 * pitch
            ));
            if let Some(ideal) = panel.ideals.get(bar) {
                let y = bottom - size[1] * ideal / most;
                sheet.put(format_args!(
                    "<path d=\"M{:.1} {y:.1}h{:.1}\" stroke=\"{INK}\" stroke-width=\"1.5\"/>",
                    x + 0.05 * pitch,
                    0.9 * pitch
                ));
            }
        }
    }
    sheet.finish()
}

/// Dots over a square from −4 to 4 both ways, with the rules between four by four cells.
pub fn dots(title: &str, panels: &[Dots]) -> String {
    let (size, half) = ([260.0, 260.0], 4.0);
    let mut sheet = Sheet::new(title, &[], sheet_size(panels.len(), size));
    let scale = size[0] / (2.0 * half);
    for (index, panel) in panels.iter().enumerate() {
        let [left, top] = corner(index, size);
        let at = |[x, y]: [f64; 2]| [left + scale * (x + half), top + scale * (half - y)];
        sheet.put(format_args!(
            "<text x=\"{left:.0}\" y=\"{:.0}\" font-weight=\"600\">{}</text>",
            top - 8.0,
            panel.title
        ));
        for outline in &panel.outlines {
            match *outline {
                Outline::Disc { at: middle, radius } => {
                    let [x, y] = at(middle);
                    sheet.put(format_args!(
                        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" fill=\"#e9e4d6\"/>",
                        radius * scale
                    ));
                }
                Outline::Square { at: middle, edge } => {
                    let [x, y] = at([middle[0] - 0.5 * edge, middle[1] + 0.5 * edge]);
                    let wide = edge * scale;
                    sheet.put(format_args!(
                        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{wide:.1}\" fill=\"#e9e4d6\"/>"
                    ));
                }
            }
        }
        for rule in 0..=4 {
            let across = f64::from(rule) * size[0] / 4.0;
            sheet.put(format_args!(
                "<path d=\"M{:.0} {top}v{}M{left} {:.0}h{}\" stroke=\"{RULE}\"/>",
                left + across,
                size[1],
                top + across,
                size[0]
            ));
        }
        let mut path = String::new();
        for point in &panel.points {
            let [x, y] = at(*point);
            write!(path, "M{x:.1} {y:.1}h0").expect("writing to memory cannot fail");
        }
        sheet.put(format_args!(
            "<path d=\"{path}\" stroke=\"#9d1f41\" stroke-opacity=\"0.6\" stroke-width=\"2\" stroke-linecap=\"round\"/>"
        ));
    }
    sheet.finish()
}
