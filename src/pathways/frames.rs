use super::frechet::{Decided, discrete_frechet, hausdorff};
use crate::context::Context;
use crate::model::Scratch;
use crate::query::Path;
use crate::roadmap::Configs;
use crate::space::Space;
use crate::structure::measure::CentredPoints;

/// How far apart neighbouring frames of molecules are at most, Å of Cα RMSD, unless told otherwise.
pub const SPACING: f64 = 0.5;

/// A leg of a path is looked at in parts at most this share of the spacing before frames are placed on it.
const PARTS: f64 = 8.0;

/// A leg is not looked at in more parts.
const PARTS_MAX: usize = 1 << 16;

/// A path cut into frames of about equal spacing, among them all configurations of the path.
#[derive(Clone, Debug)]
pub struct Frames {
    /// The configurations, from start to goal. Those between the path's own are not in stored form.
    pub configs: Configs,
    /// Which of them are the path's own, ascending.
    pub own: Vec<usize>,
    /// The length from the start to each frame, as the sum of the distances of neighbouring frames: Å of Cα RMSD, or in the
    /// space's metric.
    pub lengths: Vec<f64>,
    /// Where the Cα are, of models that have them.
    shapes: Option<Vec<CentredPoints>>,
}

impl Frames {
    /// Cuts a path. Neighbouring frames are at most `spacing` apart, which is more than 0.
    ///
    /// Along a motion between two configurations the Cα RMSD does not grow evenly, so that a motion is first looked at in
    /// parts of an eighth of the spacing. Frames are placed where the sum of the parts is nearest to an even share of
    /// the whole; by the triangle inequality two neighbours are no farther apart than the parts between them together.
    pub fn of(cx: &Context, path: &Path, spacing: f64, scratch: &mut Scratch) -> Frames {
        let mut frames = Frames {
            configs: Configs::new(cx.space.len()),
            own: Vec::new(),
            lengths: Vec::new(),
            shapes: None,
        };
        let mut path = path.configs.iter();
        let Some(mut before) = path.next() else { return frames };
        frames.own.push(0);
        frames.push(cx, before, scratch);
        for q in path {
            for t in places(cx, before, q, spacing, scratch) {
                let mut between = vec![0.0; cx.space.len()];
                cx.space.interpolate(before, q, t, &mut between);
                frames.push(cx, &between, scratch);
            }
            frames.own.push(frames.len());
            frames.push(cx, q, scratch);
            before = q;
        }
        frames
    }

    /// How far a configuration is from the nearest frame.
    pub fn apart(&self, cx: &Context, q: &[f64], scratch: &mut Scratch) -> f64 {
        let mut path = Path { configs: Configs::new(cx.space.len()), length: 0.0 };
        path.configs.push(q);
        let alone = Frames::of(cx, &path, 1.0, scratch);
        let apart = |frame| alone.distance(0, self, frame, &cx.space);
        (0..self.len()).map(apart).fold(f64::INFINITY, f64::min)
    }

    fn push(&mut self, cx: &Context, q: &[f64], scratch: &mut Scratch) {
        self.configs.push(q);
        if let Some(shape) = cx.model.shape(q, scratch) {
            self.shapes.get_or_insert_default().push(CentredPoints::new(&shape));
        }
        let last = self.len() - 1;
        let length = match last.checked_sub(1) {
            None => 0.0,
            Some(before) => self.lengths[before] + self.distance(before, self, last, &cx.space),
        };
        self.lengths.push(length);
    }

    /// The number of frames.
    pub fn len(&self) -> usize {
        self.configs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.configs.is_empty()
    }

    /// The length of the whole path, as the sum of the distances of neighbouring frames.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// How far frame `index` is from a frame of the same or of another path: Å of Cα RMSD after superposition, or in the
    /// space's metric.
    pub fn distance(&self, index: usize, other: &Frames, of_other: usize, space: &Space) -> f64 {
        match (&self.shapes, &other.shapes) {
            (Some(a), Some(b)) => a[index].rmsd(&b[of_other]),
            _ => space.distance(self.configs.get(index), other.configs.get(of_other)),
        }
    }

    /// The discrete Fréchet distance of two paths' frames.
    ///
    /// # Panics
    /// If one of them has no frame.
    pub fn frechet(&self, other: &Frames, space: &Space) -> Decided {
        discrete_frechet(self.len(), other.len(), |i, j| self.distance(i, other, j, space))
    }

    /// The Hausdorff distance of two paths' frames.
    ///
    /// # Panics
    /// If one of them has no frame.
    pub fn hausdorff(&self, other: &Frames, space: &Space) -> Decided {
        hausdorff(self.len(), other.len(), |i, j| self.distance(i, other, j, space))
    }
}

/// At which shares of the motion from `a` to `b`, its ends left out, frames are placed.
fn places(cx: &Context, a: &[f64], b: &[f64], spacing: f64, scratch: &mut Scratch) -> Vec<f64> {
    let mut shape_at = |q: &[f64]| Some(CentredPoints::new(&cx.model.shape(q, scratch)?));
    let even = |count: usize| (1..count).map(move |i| i as f64 / count as f64).collect();
    let count = |length: f64| (length / spacing).ceil().clamp(1.0, PARTS_MAX as f64) as usize;
    let (Some(first), Some(last)) = (shape_at(a), shape_at(b)) else {
        return even(count(cx.space.distance(a, b)));
    };
    let part = spacing / PARTS;
    let mut parts = (PARTS as usize * count(first.rmsd(&last))).min(PARTS_MAX);
    let sums = loop {
        let mut sums = vec![0.0];
        let (mut before, mut longest) = (first.clone(), 0.0f64);
        let mut q = vec![0.0; a.len()];
        for index in 1..=parts {
            cx.space.interpolate(a, b, index as f64 / parts as f64, &mut q);
            let next = if index == parts { Some(last.clone()) } else { shape_at(&q) };
            let next = next.expect("a model has as many Cα everywhere");
            let step = before.rmsd(&next);
            sums.push(sums[index - 1] + step);
            longest = longest.max(step);
            before = next;
        }
        if longest <= part || parts >= PARTS_MAX {
            break sums;
        }
        parts = (2 * parts).min(PARTS_MAX);
    };
    // Where a frame stands at the end of the part in which its place is, neighbours are at most a part farther apart.
    let whole = sums[parts];
    let frames = (whole / (spacing - part)).ceil().max(1.0) as usize;
    let place = |index: usize| {
        let at = whole * (index as f64 / frames as f64);
        sums.partition_point(|sum| *sum < at) as f64 / parts as f64
    };
    (1..frames).map(place).filter(|t| *t > 0.0 && *t < 1.0).collect()
}
