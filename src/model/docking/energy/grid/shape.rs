//! The points of a grid, and where their values stand.

use super::interpolation::Map;
use super::{Grid, Lookup};
use crate::model::docking::energy::sum::PairSum;
use crate::structure::Point;

/// The least and the largest distance of neighbouring points, in Å.
pub const SPACING_RANGE: [f64; 2] = [0.1, 2.0];
/// The most values of a grid: 4 GiB of them.
pub const VALUES_MAX: usize = 1 << 30;

/// A place in a grid: the lowest of the eight points around it, and how far it is from that one along each axis, in
/// spacings, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub point: [usize; 3],
    pub part: [f64; 3],
}

impl Lookup {
    /// Whether values are energies, not reciprocals.
    pub(super) fn is_plain(self) -> bool {
        matches!(self, Lookup::Nearest | Lookup::Trilinear)
    }

    /// How many numbers an atom's kind has at a point.
    pub(super) fn numbers(self) -> usize {
        if self.is_plain() { 1 } else { 2 }
    }
}

impl Grid {
    /// A grid over the box between two opposite corners (Å, any two), its points `spacing` Å apart; the last ones lie on the
    /// box's faces or beyond them. `None` where a corner is not finite, where the spacing is not within [`SPACING_RANGE`],
    /// and where there would be more than [`VALUES_MAX`] values.
    pub fn new(sum: &PairSum, corners: [Point; 2], spacing: f64, lookup: Lookup) -> Option<Grid> {
        let [least, most] = SPACING_RANGE;
        let is_finite = corners.iter().flatten().all(|value| value.is_finite());
        if !is_finite || !(least..=most).contains(&spacing) {
            return None;
        }
        let low = corners[0].inf(&corners[1]);
        let size = corners[0].sup(&corners[1]) - low;
        let counts = [0, 1, 2].map(|axis: usize| (size[axis] / spacing).ceil().max(1.0) as usize);
        let counts = counts.map(|steps| steps.saturating_add(1));
        let kinds = sum.kinds.len();
        let has_potential = sum.charged.is_some();
        let numbers = kinds * lookup.numbers() + usize::from(has_potential);
        let values = counts.iter().fold(numbers, |all, count| all.saturating_mul(*count));
        let is_small = values <= VALUES_MAX;
        let per = 1.0 / spacing;
        is_small.then_some(Grid { low, spacing, per, counts, lookup, kinds, has_potential })
    }

    /// How energies are looked up.
    pub fn lookup(&self) -> Lookup {
        self.lookup
    }

    /// The distance of neighbouring points in Å.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// How many points there are along x, y and z.
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// How many layers there are: as many as points along z.
    pub fn layers(&self) -> usize {
        self.counts[2]
    }

    /// How many values a layer has.
    pub fn layer_len(&self) -> usize {
        let numbers = self.kinds * self.lookup.numbers() + usize::from(self.has_potential);
        self.plane() * numbers
    }

    /// How many values the grid has.
    pub fn values_len(&self) -> usize {
        self.layers() * self.layer_len()
    }

    /// Where a point of the grid is, in Å.
    pub fn point(&self, [x, y, z]: [usize; 3]) -> Point {
        self.low + Point::new(x as f64, y as f64, z as f64) * self.spacing
    }

    /// The point of the grid that is nearest to a position; `None` of a position outside of the grid.
    pub fn nearest_point(&self, at: Point) -> Option<[usize; 3]> {
        self.place(at).map(|place| place.nearest())
    }

    /// How many points a layer has.
    pub(super) fn plane(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// Where a position is; `None` outside of the grid.
    #[inline(always)]
    pub(super) fn place(&self, at: Point) -> Option<Place> {
        let mut place = Place { point: [0; 3], part: [0.0; 3] };
        for axis in 0..3 {
            let steps = (at[axis] - self.low[axis]) * self.per;
            let last = self.counts[axis] - 1;
            // Written so that NaN fails it.
            if !(steps >= 0.0 && steps <= last as f64) {
                return None;
            }
            let point = (steps as usize).min(last - 1);
            place.point[axis] = point;
            place.part[axis] = steps - point as f64;
        }
        Some(place)
    }

    /// The map of a kind of atom.
    #[inline(always)]
    pub(super) fn kind_map<'a>(&self, values: &'a [f32], kind: usize) -> Map<'a> {
        self.map(values, kind * self.lookup.numbers())
    }

    /// The map of the potential in kJ/mol per elementary charge, if charges count.
    #[inline(always)]
    pub(super) fn potential_map<'a>(&self, values: &'a [f32]) -> Option<Map<'a>> {
        self.has_potential.then(|| self.map(values, self.kinds * self.lookup.numbers()))
    }

    /// The map before which so many numbers of every point stand.
    #[inline(always)]
    fn map<'a>(&self, values: &'a [f32], before: usize) -> Map<'a> {
        let begin = before * self.plane();
        Map { values, begin, counts: self.counts, layer: self.layer_len(), per: self.per }
    }
}

impl Place {
    /// The nearest point.
    #[inline(always)]
    pub fn nearest(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis: usize| self.point[axis] + usize::from(self.part[axis] >= 0.5))
    }
}
