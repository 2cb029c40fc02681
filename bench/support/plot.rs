//! Small plots: SVG files without references to others, the same bytes for the same numbers.

use std::fmt::Write;

pub const FONT: &str = "font-family=\"Inter, Helvetica, Arial, sans-serif\"";
pub const PAPER: &str = "#fbfaf6";
pub const RULE: &str = "#d9d5c8";
pub const INK: &str = "#33393f";
/// Of what is drawn, in order.
pub const COLOURS: [&str; 6] = ["#9d1f41", "#4f7ea8", "#3f9b6c", "#c9a21f", "#8460b5", "#2c9fa3"];

/// Room around the frame, in pixels: left, top, right, bottom.
const MARGINS_PX: [f64; 4] = [124.0, 64.0, 28.0, 56.0];

/// What an axis spans.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

impl Scale {
    /// Where a value stands, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let at = |value: f64| if self.log { libm::log(value) } else { value };
        (at(value) - at(self.low)) / (at(self.high) - at(self.low))
    }

    /// A logarithmic scale of whole powers of ten that holds all values.
    pub fn decades(values: impl Iterator<Item = f64>) -> Scale {
        let (low, high) = values
            .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
        let power = |exponent: f64| libm::pow(10.0, exponent);
        let low = power(libm::log10(low).floor());
        Scale { low, high: power(libm::log10(high).ceil()).max(10.0 * low), log: true }
    }

    /// The powers of ten on it.
    pub fn powers(&self) -> Vec<f64> {
        let exponents =
            libm::log10(self.low).round() as i32..=libm::log10(self.high).round() as i32;
        exponents.map(|exponent| libm::pow(10.0, f64::from(exponent))).collect()
    }
}

/// A plot in the making.
pub struct Plot {
    out: String,
    /// Width and height in pixels.
    size: [f64; 2],
    x: Scale,
    y: Scale,
}

impl Plot {
    /// An empty frame with its title, and what stands below and beside it.
    pub fn new(
        title: &str,
        [below, beside]: [&str; 2],
        size: [f64; 2],
        x: Scale,
        y: Scale,
    ) -> Plot {
        let [width, height] = size;
        let mut plot = Plot { out: String::new(), size, x, y };
        plot.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" {FONT} font-size=\"13\" fill=\"{INK}\">"
        ));
        plot.put(format_args!("<rect width=\"{width}\" height=\"{height}\" fill=\"{PAPER}\"/>"));
        let [left, top, _, bottom] = MARGINS_PX;
        plot.put(format_args!(
            "<text x=\"{left}\" y=\"26\" font-size=\"16\" font-weight=\"600\">{}</text>",
            escaped(title)
        ));
        let (middle, line) = (0.5 * (left + plot.right()), height - bottom + 42.0);
        plot.put(format_args!(
            "<text x=\"{middle:.1}\" y=\"{line:.1}\" text-anchor=\"middle\">{}</text>",
            escaped(below)
        ));
        if !beside.is_empty() {
            let middle = 0.5 * (top + plot.bottom());
            plot.put(format_args!(
                "<text transform=\"translate(30 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                escaped(beside)
            ));
        }
        plot
    }

    fn right(&self) -> f64 {
        self.size[0] - MARGINS_PX[2]
    }

    fn bottom(&self) -> f64 {
        self.size[1] - MARGINS_PX[3]
    }

    fn put(&mut self, text: std::fmt::Arguments) {
        self.out.write_fmt(text).expect("writing to memory cannot fail");
        self.out.push('\n');
    }

    fn px(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, ..] = MARGINS_PX;
        let (width, height) = (self.right() - left, self.bottom() - top);
        [left + width * self.x.share(x), self.bottom() - height * self.y.share(y)]
    }

    /// Upright rules with what stands below them.
    pub fn columns(&mut self, ticks: &[(f64, String)]) {
        let (top, bottom) = (MARGINS_PX[1], self.bottom());
        for (value, label) in ticks {
            let [x, _] = self.px([*value, self.y.low]);
            self.put(format_args!(
                "<path d=\"M{x:.1} {top:.1}V{bottom:.1}\" stroke=\"{RULE}\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                bottom + 18.0,
                escaped(label)
            ));
        }
    }

    /// Level rules with what stands left of them.
    pub fn rows(&mut self, ticks: &[(f64, String)]) {
        let (left, right) = (MARGINS_PX[0], self.right());
        for (value, label) in ticks {
            let [_, y] = self.px([self.x.low, *value]);
            self.put(format_args!(
                "<path d=\"M{left:.1} {y:.1}H{right:.1}\" stroke=\"{RULE}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 8.0,
                y + 4.5,
                escaped(label)
            ));
        }
    }

    /// A line through points, with a dot at each.
    pub fn line(&mut self, points: &[[f64; 2]], colour: &str) {
        let mut path = String::new();
        for (i, point) in points.iter().enumerate() {
            let [x, y] = self.px(*point);
            write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' }).expect("memory");
        }
        self.put(format_args!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>"
        ));
        self.dots(points, colour, 3.0);
    }

    /// A dot at each point, of a radius in pixels.
    pub fn dots(&mut self, points: &[[f64; 2]], colour: &str, radius: f64) {
        for point in points {
            let [x, y] = self.px(*point);
            self.put(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{colour}\" fill-opacity=\"0.7\"/>"
            ));
        }
    }

    /// A small ring around a point.
    pub fn ring(&mut self, point: [f64; 2], colour: &str) {
        let [x, y] = self.px(point);
        self.put(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"none\" stroke=\"{colour}\"/>"
        ));
    }

    /// A short upright bar, so many pixels to either side of a point.
    pub fn bar(&mut self, point: [f64; 2], reach: f64, colour: &str) {
        let [x, y] = self.px(point);
        self.put(format_args!(
            "<path d=\"M{x:.1} {:.1}V{:.1}\" stroke=\"{colour}\" stroke-width=\"3\"/>",
            y - reach,
            y + reach
        ));
    }

    /// What the colours mean, in a line below the title.
    pub fn legend(&mut self, names: &[(String, &str)]) {
        let mut x = MARGINS_PX[0] + 5.0;
        for (name, colour) in names {
            self.put(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"45\" r=\"5\" fill=\"{colour}\"/><text x=\"{:.1}\" y=\"49.5\">{}</text>",
                x + 10.0,
                escaped(name)
            ));
            x += 34.0 + 7.2 * name.chars().count() as f64;
        }
    }

    /// The file.
    pub fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}

/// A power of ten as it is written on an axis.
pub fn plain(value: f64) -> String {
    if value >= 1e4 { format!("{:.0}k", value / 1e3) } else { format!("{value}") }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
