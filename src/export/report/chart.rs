//! Charts of numbers over numbers: SVG elements, the same bytes for the same numbers.

use super::super::markup::escaped;
use crate::math;
use std::fmt::Write;

/// Width and height of a chart, and the room around its frame: left, top, right, bottom. In pixels.
const SIZE: [f64; 2] = [400.0, 260.0];
const MARGINS: [f64; 4] = [62.0, 12.0, 12.0, 44.0];

/// About so many rules divide an axis.
const RULES: f64 = 5.0;

/// A line of a chart has at most so many points; of more, some at even distances in the list are left out.
const POINTS_MAX: usize = 1500;

/// A line through points.
pub(in crate::export) struct Series {
    /// What it is; empty where the chart's title says so.
    pub name: String,
    pub colour: &'static str,
    pub dashed: bool,
    /// Abscissa and ordinate. The line is broken where one of them is not finite.
    pub points: Vec<[f64; 2]>,
}

/// A chart.
pub(in crate::export) struct Chart {
    pub title: String,
    /// What the horizontal axis is, and what the vertical.
    pub axes: [String; 2],
    pub series: Vec<Series>,
    /// Level lines across the chart: where, and what they are.
    pub levels: Vec<(f64, String)>,
}

/// What an axis spans, and where its rules are.
pub(in crate::export) struct Axis {
    low: f64,
    high: f64,
    step: f64,
    /// Whether `low` and `high` are [logarithms with a sign](signed_log).
    is_log: bool,
}

impl Axis {
    /// An axis with all finite values on it, and some room beyond them.
    pub fn over(values: impl Iterator<Item = f64>) -> Axis {
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        // Values too much alike to be told apart get an axis around them.
        let least = 1e-9 * low.abs().max(high.abs());
        let (low, high) = if high - low > least {
            let room = 0.04 * (high - low);
            (low - room, high + room)
        } else {
            let room = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            (low - room, high + room)
        };
        Axis { low, high, step: round_step((high - low) / RULES), is_log: false }
    }

    /// An axis on which a value beyond ±10 goes with its logarithm, and one near 0 with itself, so that both −50 and 10⁹ can be
    /// read off.
    pub fn signed_log_over(values: impl Iterator<Item = f64>) -> Axis {
        Axis { is_log: true, ..Axis::over(values.map(signed_log)) }
    }

    /// Where a value is on the axis, from 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        let value = if self.is_log { signed_log(value) } else { value };
        (value - self.low) / (self.high - self.low)
    }

    /// The rules: where they are, and what stands beside them.
    pub fn rules(&self) -> Vec<(f64, String)> {
        if self.is_log {
            return self.decades();
        }
        let (first, last) = ((self.low / self.step).ceil(), (self.high / self.step).floor());
        if !(first <= last && last - first < 100.0) {
            return Vec::new();
        }
        let count = (last - first) as usize;
        let values = (0..=count).map(|index| (first + index as f64) * self.step);
        values.map(|value| (value, self.label(value))).collect()
    }

    /// The rules of an axis of logarithms: 0 and powers of ten on both sides; of many, every second power, every third, and so on.
    fn decades(&self) -> Vec<(f64, String)> {
        let mut values = vec![(0.0, "0".to_owned())];
        let mut value = 10.0;
        for power in 1..=300 {
            let label = match power {
                1..=3 => format!("{value}"),
                _ => format!("1e{power}"),
            };
            values.push((-value, format!("-{label}")));
            values.push((value, label));
            value *= 10.0;
        }
        values.retain(|(value, _)| (0.0..=1.0).contains(&self.share(*value)));
        let power = |value: f64| (math::ln(value.abs().max(1.0)) / std::f64::consts::LN_10).round();
        let highest = values.iter().fold(1.0, |most: f64, (value, _)| most.max(power(*value)));
        let every = (highest / RULES).ceil().max(1.0);
        values.retain(|(value, _)| power(*value) % every == 0.0);
        values
    }

    fn label(&self, value: f64) -> String {
        let value = value + 0.0;
        if self.step >= 1e15 || self.step < 1e-6 {
            return format!("{value:e}");
        }
        if self.step >= 1000.0 && value != 0.0 {
            return format!("{}k", value / 1000.0);
        }
        let mut decimals = 0;
        let mut unit = 1.0;
        while unit > 1.000_001 * self.step && decimals < 9 {
            (unit, decimals) = (unit / 10.0, decimals + 1);
        }
        format!("{value:.decimals$}")
    }
}

/// The inverse hyperbolic sine of a fifth of a value: a logarithm with a sign where the value is large, proportional to the value
/// where it is small.
fn signed_log(value: f64) -> f64 {
    let size = 0.2 * value.abs();
    let log = if size < 1e100 {
        math::ln(size + (size * size + 1.0).sqrt())
    } else {
        math::ln(size) + math::ln(2.0)
    };
    if value < 0.0 { -log } else { log }
}

/// 1, 2 or 5 times a power of ten, the first that is not below `least`, which is above 0.
fn round_step(least: f64) -> f64 {
    let mut power = 1.0;
    while power > least && power > 1e-300 {
        power /= 10.0;
    }
    while 10.0 * power <= least && power < 1e300 {
        power *= 10.0;
    }
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// A frame in which something is drawn: the two axes, and the text of the SVG element so far.
pub(in crate::export) struct Frame {
    pub x: Axis,
    pub y: Axis,
    size: [f64; 2],
    pub out: String,
}

impl Frame {
    /// An empty frame with rules and labels. `about` says for readers that cannot see what is shown.
    pub fn new(about: &str, axes: &[String; 2], x: Axis, y: Axis, size: [f64; 2]) -> Frame {
        let mut frame = Frame { x, y, size, out: String::new() };
        let [width, height] = size;
        let [left, top, right, bottom] = frame.sides();
        frame.put(format_args!(
            "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">",
            escaped(about)
        ));
        for (value, label) in frame.x.rules() {
            let [x, _] = frame.place([value, frame.y.low]);
            frame.put(format_args!(
                "<path class=\"rule\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 17.0
            ));
        }
        for (value, label) in frame.y.rules() {
            let [_, y] = frame.place([frame.x.low, value]);
            frame.put(format_args!(
                "<path class=\"rule\" d=\"M{left:.1} {y:.1}H{right:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                left - 6.0,
                y + 4.0
            ));
        }
        let (middle, line) = (0.5 * (left + right), height - 8.0);
        frame.put(format_args!(
            "<text class=\"axis\" x=\"{middle:.1}\" y=\"{line:.1}\" text-anchor=\"middle\">{}</text>",
            escaped(&axes[0])
        ));
        let middle = 0.5 * (top + bottom);
        frame.put(format_args!(
            "<text class=\"axis\" transform=\"translate(13 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            escaped(&axes[1])
        ));
        frame
    }

    /// Left, top, right and bottom of the frame, in pixels.
    pub fn sides(&self) -> [f64; 4] {
        let [left, top, right, bottom] = MARGINS;
        [left, top, self.size[0] - right, self.size[1] - bottom]
    }

    /// Where a point is drawn, in pixels.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.sides();
        [left + (right - left) * self.x.share(x), bottom - (bottom - top) * self.y.share(y)]
    }

    /// Appends a line to the element.
    pub fn put(&mut self, text: std::fmt::Arguments) {
        self.out.write_fmt(text).expect("writing to memory cannot fail");
        self.out.push('\n');
    }

    /// Draws a line of a class of the page's styles through points, broken where a number is not finite.
    pub fn line(&mut self, points: &[[f64; 2]], class: &str, colour: &str, dashed: bool) {
        let step = points.len().div_ceil(POINTS_MAX).max(1);
        let (mut path, mut is_down) = (String::new(), false);
        for (index, point) in points.iter().enumerate() {
            if index % step != 0 && index + 1 != points.len() {
                continue;
            }
            let [x, y] = self.place(*point);
            if !(x.is_finite() && y.is_finite()) {
                is_down = false;
                continue;
            }
            write!(path, "{}{x:.1} {y:.1}", if is_down { 'L' } else { 'M' }).expect("memory");
            is_down = true;
        }
        if path.is_empty() {
            return;
        }
        let dashes = if dashed { " stroke-dasharray=\"5 4\"" } else { "" };
        self.put(format_args!(
            "<path class=\"{class}\" d=\"{path}\" stroke=\"{colour}\"{dashes}/>"
        ));
    }

    /// The element.
    pub fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}

impl Chart {
    /// The chart with its title and what the lines mean, as an HTML element.
    pub fn html(&self) -> String {
        let of = |axis: usize| {
            self.series.iter().flat_map(move |series| series.points.iter().map(move |p| p[axis]))
        };
        let levels = self.levels.iter().map(|(level, _)| *level);
        let (x, y) = (Axis::over(of(0)), Axis::over(of(1).chain(levels)));
        let mut frame = Frame::new(&self.title, &self.axes, x, y, SIZE);
        for (level, name) in self.levels.iter().filter(|(level, _)| level.is_finite()) {
            let [left, top, right, _] = frame.sides();
            let [_, y] = frame.place([frame.x.low, *level]);
            let text = if y < top + 18.0 { y + 13.0 } else { y - 4.0 };
            frame.put(format_args!(
                "<path class=\"level\" d=\"M{left:.1} {y:.1}H{right:.1}\"/><text class=\"note\" x=\"{:.1}\" y=\"{text:.1}\" text-anchor=\"end\">{}</text>",
                right - 4.0,
                escaped(name)
            ));
        }
        for Series { colour, dashed, points, .. } in &self.series {
            frame.line(points, "line", colour, *dashed);
            if let [[x, y]] = points[..] {
                let [x, y] = frame.place([x, y]);
                if x.is_finite() && y.is_finite() {
                    frame.put(format_args!(
                        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
                    ));
                }
            }
        }
        let mut html = format!("<figure><figcaption>{}", escaped(&self.title));
        if self.series.len() > 1 {
            html += &legend(
                self.series
                    .iter()
                    .filter(|s| !s.name.is_empty())
                    .map(|s| (&*s.name, s.colour, s.dashed)),
            );
        }
        html += "</figcaption>\n";
        html += &frame.finish();
        html + "</figure>\n"
    }
}

/// What colours and dashes mean.
pub(in crate::export) fn legend<'a>(
    entries: impl Iterator<Item = (&'a str, &'a str, bool)>,
) -> String {
    let mut html = String::from(" <span class=\"legend\">");
    for (name, colour, dashed) in entries {
        let dashes = if dashed { " stroke-dasharray=\"5 4\"" } else { "" };
        write!(
            html,
            "<span><svg viewBox=\"0 0 22 8\" class=\"key\"><path class=\"line\" d=\"M1 4H21\" stroke=\"{colour}\"{dashes}/></svg>{}</span> ",
            escaped(name)
        )
        .expect("writing to memory cannot fail");
    }
    html + "</span>"
}

#[cfg(test)]
mod tests {
    use super::super::super::palette::colour;
    use super::*;

    #[test]
    fn rules_are_round_numbers_between_the_ends() {
        for (least, step) in [(1.0, 1.0), (1.1, 2.0), (0.03, 0.05), (7.0, 10.0), (333.0, 500.0)] {
            let found = round_step(least);
            assert!((found - step).abs() < 1e-12 * step, "{least}: {found}");
        }
        let labels = |values: &[f64]| {
            let axis = Axis::over(values.iter().copied());
            axis.rules().into_iter().map(|(_, label)| label).collect::<Vec<_>>()
        };
        assert_eq!(labels(&[0.0, 1.0]), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(&[-400.0, 9600.0]), ["0", "5k", "10k"]);
        assert_eq!(labels(&[f64::NAN, f64::INFINITY]).len(), 3, "an empty chart has an axis");
        // One value alone stands in the middle.
        let axis = Axis::over([3.0].into_iter());
        assert_eq!(axis.share(3.0), 0.5);
    }

    #[test]
    fn logarithms_with_a_sign_have_zero_and_powers_of_ten() {
        let axis = Axis::signed_log_over([-60.0, 4000.0, f64::NAN].into_iter());
        let labels: Vec<String> = axis.rules().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "-10", "10", "100", "1000"]);
        let [low, zero, high] = [-60.0, 0.0, 4000.0].map(|value| axis.share(value));
        assert!(0.0 < low && low < zero && zero < high && high < 1.0);
        let wide = Axis::signed_log_over([-1e3, 1e12].into_iter());
        assert!(wide.rules().len() < 8 && wide.rules().iter().any(|(_, label)| label == "1e6"));
        assert!(signed_log(1e99) < signed_log(1e101) && signed_log(f64::NAN).is_nan());
        assert!((signed_log(-1e100) + signed_log(1.000_001e100)).abs() < 1e-5);
    }

    #[test]
    fn a_line_is_broken_where_there_is_nothing_to_draw() {
        let series = |points: Vec<[f64; 2]>| Series {
            name: "a<b".to_owned(),
            colour: colour(0),
            dashed: false,
            points,
        };
        let broken = vec![[0.0, 1.0], [1.0, 2.0], [2.0, f64::INFINITY], [3.0, 1.0], [4.0, 0.0]];
        let chart = Chart {
            title: "t".to_owned(),
            axes: ["x", "y"].map(str::to_owned),
            series: vec![series(broken), series(vec![[2.0, 1.5]])],
            levels: vec![(0.5, "<level>".to_owned()), (f64::NAN, "none".to_owned())],
        };
        let html = chart.html();
        let line = html
            .lines()
            .find(|line| line.contains("class=\"line\" d=\"M") && !line.contains("M1 4"));
        let line = line.expect("a line");
        assert_eq!((line.matches('M').count(), line.matches('L').count()), (2, 2), "{line}");
        assert!(
            html.contains("&lt;level&gt;") && !html.contains("none") && html.contains("a&lt;b")
        );
        assert!(html.contains("<circle"), "a sole point is seen");
        assert!(!html.contains("NaN") && !html.contains("inf"), "{html}");
    }

    #[test]
    fn long_lines_are_thinned_and_keep_their_end() {
        let axis = || Axis::over([0.0, 9999.0].into_iter());
        let axes = ["x", "y"].map(str::to_owned);
        let mut frame = Frame::new("t", &axes, axis(), axis(), SIZE);
        let points: Vec<[f64; 2]> = (0..10_000).map(|i| [f64::from(i), f64::from(i)]).collect();
        frame.line(&points, "line", "red", false);
        let [x, y] = frame.place(points[9999]);
        let line = frame.finish();
        assert!(line.contains(&format!("L{x:.1} {y:.1}\"")), "the last point is drawn");
        assert!(line.matches('L').count() <= POINTS_MAX);
    }
}
