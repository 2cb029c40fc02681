//! Contour lines of an energy over the plane.
//!
//! The energy is looked at on a grid. Where a level lies between the energies of two neighbouring grid points a
//! contour crosses the line between them, and in every cell of the grid the crossings on its sides are joined
//! (*marching squares*, the planar case of W. E. Lorensen and H. E. Cline, *Marching cubes*, 1987).
//! Beyond the grid's border the energy counts as very high, so that every contour is closed and what lies within can be
//! filled.

use super::drawing::{Drawing, INK, blend, decimal};
use super::svg::{FONT, round_length};
use super::view::MARGIN_PX;
use crate::model::Figure;
use crate::roadmap::Roadmap;
use std::collections::BTreeMap;
use std::fmt;

/// Cells of the grid along the longer side of the bounds.
const CELLS: usize = 160;
/// At most about this many contours.
const LEVELS: f64 = 20.0;
/// What the energy beyond the border counts as.
const BEYOND: f64 = 1e300;
/// Colour of the lowest and of the highest energies.
const TINTS: [[f64; 3]; 2] = [[120.0, 158.0, 158.0], [236.0, 233.0, 222.0]];

/// The energies that contours are drawn at: multiples of a step.
pub(super) struct Levels {
    step: f64,
    first: i64,
    last: i64,
}

impl Levels {
    /// Levels that a round number separates, between two energies; `None` where no level lies between.
    fn between(lowest: f64, highest: f64) -> Option<Levels> {
        let range = highest - lowest;
        if !(range > 0.0 && range.is_finite()) {
            return None;
        }
        // Of energies too near to zero to be told apart there is no level.
        let step = Some(2.0 * range / LEVELS).filter(|step| step.is_normal()).map(round_length)?;
        let (first, last) = ((lowest / step).ceil() as i64, (highest / step).floor() as i64);
        (first <= last).then_some(Levels { step, first, last })
    }

    fn at(&self, index: i64) -> f64 {
        index as f64 * self.step
    }
}

impl fmt::Display for Levels {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [first, last] = [self.first, self.last].map(|index| self.at(index));
        write!(f, "contours every {}, from {first} to {last}", self.step)
    }
}

impl Drawing<'_> {
    /// Draws contours, if the model has an energy over the plane: from the lowest energy to the highest that a
    /// milestone has, or, without milestones, to the middle one of all that the grid has.
    pub(super) fn contours(&mut self, roadmap: &Roadmap) {
        let Some((grid, levels)) = grid_and_levels(self.figure, Some(roadmap)) else { return };
        for index in (levels.first..=levels.last).rev() {
            let share = (index - levels.first + 1) as f64 / (levels.last - levels.first + 2) as f64;
            let mut loops = String::new();
            for points in grid.contours(levels.at(index)) {
                loops.push_str(&self.line(without_middles(points)));
                loops.push('Z');
            }
            self.put(format_args!(
                "<path class=\"contour\" d=\"{loops}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"{INK}\" \
                 stroke-opacity=\"0.32\" stroke-width=\"0.7\"/>",
                blend(TINTS, share)
            ));
        }
        let [low, high] = self.figure.bounds().map(|corner| self.view.px(corner));
        let [x, y] = [low[0], high[1]].map(decimal);
        let [width, height] = [high[0] - low[0], low[1] - high[1]].map(decimal);
        self.put(format_args!(
            "<rect class=\"frame\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"none\" \
             stroke=\"{INK}\" stroke-width=\"2.5\"/>"
        ));
        let (right, above) = (decimal(high[0]), decimal(MARGIN_PX - 11.0));
        self.put(format_args!(
            "<text x=\"{right}\" y=\"{above}\" text-anchor=\"end\" {FONT} font-size=\"14\" fill=\"{INK}\" \
             fill-opacity=\"0.75\">{levels}</text>"
        ));
    }
}

/// An energy over the plane as a page shows it.
pub(super) struct Relief {
    /// Points of the grid from the least x to the largest.
    pub columns: usize,
    /// Row by row, from the least y to the largest.
    pub energies: Vec<f64>,
    /// Between two contours.
    pub step: f64,
    /// The lowest contour.
    pub lowest: f64,
    /// The highest contour.
    pub highest: f64,
}

/// The energy of a model that has one over the plane, with the contours that a picture has; what is above the highest of
/// them counts as one step above it.
pub(super) fn relief(figure: &dyn Figure, roadmap: Option<&Roadmap>) -> Option<Relief> {
    let (grid, levels) = grid_and_levels(figure, roadmap)?;
    let highest = levels.at(levels.last);
    let (width, height) = (grid.xs.len(), grid.ys.len());
    let inner =
        (1..height - 1).flat_map(|row| (1..width - 1).map(move |column| row * width + column));
    Some(Relief {
        columns: width - 2,
        energies: inner.map(|at| grid.energies[at].min(highest + levels.step)).collect(),
        step: levels.step,
        lowest: levels.at(levels.first),
        highest,
    })
}

/// The energies of the plane, and the levels of contours from the lowest energy to the highest of a milestone.
fn grid_and_levels(figure: &dyn Figure, roadmap: Option<&Roadmap>) -> Option<(Grid, Levels)> {
    let grid = Grid::of(figure)?;
    let at_milestones =
        roadmap.into_iter().flat_map(|roadmap| roadmap.configs().iter()).filter_map(|q| {
            let [x, y, _] = figure.marker(q);
            figure.energy_at(x, y)
        });
    let highest = at_milestones.reduce(f64::max).unwrap_or_else(|| grid.middle());
    let levels = Levels::between(grid.lowest(), highest)?;
    Some((grid, levels))
}

/// Energies at the points of a grid, with a border of points that stand where their neighbours do and count as
/// very high.
struct Grid {
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// Row by row.
    energies: Vec<f64>,
}

impl Grid {
    fn of(figure: &dyn Figure) -> Option<Grid> {
        let [low, high] = figure.bounds();
        figure.energy_at(low[0], low[1])?;
        let longer = (high[0] - low[0]).max(high[1] - low[1]);
        let [xs, ys] = [0, 1].map(|axis| {
            let extent = high[axis] - low[axis];
            let cells = (CELLS as f64 * extent / longer).ceil().max(1.0) as usize;
            let inner = (0..=cells).map(|i| low[axis] + extent * (i as f64 / cells as f64));
            [low[axis]].into_iter().chain(inner).chain([high[axis]]).collect::<Vec<f64>>()
        });
        let mut energies = Vec::with_capacity(xs.len() * ys.len());
        for (row, y) in ys.iter().enumerate() {
            for (column, x) in xs.iter().enumerate() {
                let inner = (1..ys.len() - 1).contains(&row) && (1..xs.len() - 1).contains(&column);
                let energy = if inner { figure.energy_at(*x, *y)? } else { BEYOND };
                energies.push(energy);
            }
        }
        Some(Grid { xs, ys, energies })
    }

    fn lowest(&self) -> f64 {
        self.energies.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Half of the energies are below.
    fn middle(&self) -> f64 {
        let mut inner: Vec<f64> = self.energies.iter().copied().filter(|e| *e < BEYOND).collect();
        inner.sort_by(f64::total_cmp);
        inner[inner.len() / 2]
    }

    /// The closed lines around what is not above `level`, which lies on their left.
    fn contours(&self, level: f64) -> Vec<Vec<[f64; 3]>> {
        let width = self.xs.len();
        // From one crossing to the next. A crossing lies on a side of a cell, and a side is known by its first
        // point and its direction: twice the point's index, and one more for a side that goes up.
        let mut next: BTreeMap<usize, usize> = BTreeMap::new();
        for row in 0..self.ys.len() - 1 {
            for column in 0..width - 1 {
                let at = row * width + column;
                // Corners counterclockwise, and the sides from each to the one after it.
                let corners = [at, at + 1, at + width + 1, at + width];
                let sides = [2 * at, 2 * (at + 1) + 1, 2 * (at + width), 2 * at + 1];
                let energies = corners.map(|corner| self.energies[corner]);
                let below = energies.map(|energy| energy <= level);
                let leaves = |side: usize| below[side] && !below[(side + 1) % 4];
                let enters = |side: usize| !below[side] && below[(side + 1) % 4];
                let is_saddle =
                    below[0] == below[2] && below[1] == below[3] && below[0] != below[1];
                // Two opposite corners are joined if the middle is not above the level.
                let is_apart = is_saddle && energies.iter().sum::<f64>() / 4.0 > level;
                for side in (0..4).filter(|side| leaves(*side)) {
                    let mut steps = (1..4).map(|step| (side + step) % 4);
                    let enter =
                        if is_apart { Some((side + 3) % 4) } else { steps.find(|s| enters(*s)) };
                    let enter = enter.expect("who leaves has entered");
                    next.insert(sides[side], sides[enter]);
                }
            }
        }
        let mut loops = Vec::new();
        while let Some((first, mut side)) = next.pop_first() {
            let mut points = vec![self.crossing(first, level)];
            while side != first {
                points.push(self.crossing(side, level));
                side = next.remove(&side).expect("contours are closed");
            }
            loops.push(points);
        }
        loops
    }

    /// Where the level is reached on a side.
    fn crossing(&self, side: usize, level: f64) -> [f64; 3] {
        let width = self.xs.len();
        let from = side / 2;
        let to = if side.is_multiple_of(2) { from + 1 } else { from + width };
        let energies = [from, to].map(|point| self.energies[point]);
        let share = ((level - energies[0]) / (energies[1] - energies[0])).clamp(0.0, 1.0);
        let [a, b] = [from, to].map(|point| [self.xs[point % width], self.ys[point / width]]);
        let [x, y] = [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]));
        [x, y, 0.0]
    }
}

/// Leaves out the points of a line along the border between its first and its last.
fn without_middles(points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let mut kept: Vec<[f64; 3]> = Vec::new();
    for point in points {
        if let [.., before, last] = kept[..] {
            let is_middle =
                (0..2).any(|axis| before[axis] == last[axis] && last[axis] == point[axis]);
            if is_middle {
                kept.pop();
            }
        }
        kept.push(point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::model::ModelKind;
    use crate::problem::Problem;
    use std::path::Path;

    /// A bowl whose middle is at 0, in a rectangle that cuts off its lowest part.
    const BOWL: &str = "[landscape]\nmin = [-1, -0.25]\nmax = [1, 1]\n\
                        energy = { terms = [{ height = -1, centre = [0, 0], xx = -1, yy = -1 }] }\n";

    fn grid(text: &str) -> Grid {
        let problem = Problem::parse(Path::new("p.toml"), text).expect("a sound problem");
        let ModelKind::Landscape(landscape) = &problem.model else { panic!("a landscape") };
        Grid::of(landscape).expect("an energy")
    }

    /// Twice the area to the left of a closed line.
    fn area(points: &[[f64; 3]]) -> f64 {
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
    }

    #[test]
    fn contours_of_a_bowl_are_circles_cut_off_at_the_border() {
        let level = -math::exp(-0.25);
        let contours = grid(BOWL).contours(level);
        let [points] = &contours[..] else { panic!("one line, not {}", contours.len()) };
        // Radius 1/2, cut at -1/4: a third of the circle's angle is missing, and a triangle is added.
        let third = std::f64::consts::PI / 3.0;
        let expected = 0.25 * (2.0 * third) + 0.25 * 0.433_012_701_892_219_3;
        assert!((area(points) - expected).abs() < 1e-3, "{} not {expected}", area(points));
        for [x, y, _] in points {
            let radius = (x * x + y * y).sqrt();
            assert!((radius - 0.5).abs() < 1e-3 || (*y == -0.25 && radius < 0.501), "{x} {y}");
        }
        // What lies along the border is told by its ends, and by the point at which the line begins.
        let short = without_middles(points.clone());
        assert_eq!(short.iter().filter(|point| point[1] == -0.25).count(), 3);
        assert!((area(&short) - area(points)).abs() < 1e-12);
    }

    /// The line around what is low has it on the left, and a hole is walked the other way round.
    #[test]
    fn the_area_within_contours_is_that_of_low_energies() {
        let text = BOWL.replace("[-1, -0.25]", "[-1, -1]").replace("height = -1", "height = 1");
        let grid = grid(&text);
        let level = 0.5;
        let contours = grid.contours(level);
        assert_eq!(contours.len(), 2, "the border, and the line around the hill");
        let whole: f64 = contours.iter().map(|points| area(points)).sum();
        let expected = 4.0 - std::f64::consts::PI * math::ln(2.0);
        assert!((whole - expected).abs() < 2e-3, "{whole} not {expected}");
    }

    #[test]
    fn levels_are_round_numbers_within_the_range() {
        let levels = Levels::between(-146.7, -0.3).expect("some");
        assert_eq!((levels.at(levels.first), levels.at(levels.last)), (-140.0, -10.0));
        assert_eq!(levels.to_string(), "contours every 10, from -140 to -10");
        assert!(Levels::between(1.0, 1.0).is_none() && Levels::between(0.0, f64::NAN).is_none());
    }
}
