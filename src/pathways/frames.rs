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

/// The most frames between the configurations of a path. Comparing two paths takes as many distances as the product of their
/// frames. A frame of a molecule holds all Cα, and each distance superposes them, so of these there are fewer.
const FRAMES_MAX: usize = 10_000;
const FRAMES_OF_MOLECULE_MAX: usize = 1_000;

/// A spacing at which a path would be cut into more frames than can be kept and compared.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{spacing} found, at which a path has more than {most} frames; a larger spacing expected")]
pub struct TooFine {
    /// The spacing, Å of Cα RMSD or in the space's metric.
    pub spacing: f64,
    /// The most frames that are placed between the configurations of a path.
    pub most: usize,
}

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
    ///
    /// # Errors
    /// There would be too many frames.
    pub fn of(
        cx: &Context,
        path: &Path,
        spacing: f64,
        scratch: &mut Scratch,
    ) -> Result<Frames, TooFine> {
        let mut frames = Frames::none(cx);
        let mut path = path.configs.iter();
        let Some(mut before) = path.next() else { return Ok(frames) };
        frames.own.push(0);
        frames.push(cx, before, scratch);
        for q in path {
            let placed = frames.len() - frames.own.len();
            for t in places(cx, [before, q], spacing, placed, scratch)? {
                let mut between = vec![0.0; cx.space.len()];
                cx.space.interpolate(before, q, t, &mut between);
                frames.push(cx, &between, scratch);
            }
            frames.own.push(frames.len());
            frames.push(cx, q, scratch);
            before = q;
        }
        Ok(frames)
    }

    fn none(cx: &Context) -> Frames {
        let configs = Configs::new(cx.space.len());
        Frames { configs, own: Vec::new(), lengths: Vec::new(), shapes: None }
    }

    /// How far a configuration is from the nearest frame.
    pub fn apart(&self, cx: &Context, q: &[f64], scratch: &mut Scratch) -> f64 {
        let mut alone = Frames::none(cx);
        alone.push(cx, q, scratch);
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

/// Refuses a spacing at which every path between two configurations has too many frames, before one is looked for.
///
/// # Errors
/// The ends are so far apart that there would be.
pub(super) fn expect_coarse(
    cx: &Context,
    ends: [&[f64]; 2],
    spacing: f64,
    scratch: &mut Scratch,
) -> Result<(), TooFine> {
    let [first, last] = ends.map(|q| {
        let mut alone = Frames::none(cx);
        alone.push(cx, q, scratch);
        alone
    });
    let most = most(first.shapes.is_some());
    let apart = first.distance(0, &last, 0, &cx.space);
    if apart / spacing > most as f64 { Err(TooFine { spacing, most }) } else { Ok(()) }
}

/// The most frames between the configurations of a path.
fn most(of_molecule: bool) -> usize {
    if of_molecule { FRAMES_OF_MOLECULE_MAX } else { FRAMES_MAX }
}

/// At which shares of the motion from `a` to `b`, its ends left out, frames are placed. On the legs before `placed` frames are.
fn places(
    cx: &Context,
    [a, b]: [&[f64]; 2],
    spacing: f64,
    placed: usize,
    scratch: &mut Scratch,
) -> Result<Vec<f64>, TooFine> {
    let mut shape_at = |q: &[f64]| Some(CentredPoints::new(&cx.model.shape(q, scratch)?));
    // How many parts of a length, or an error where their ends would be too many frames.
    let count = |length: f64, part: f64, of_molecule: bool| {
        let (parts, most) = ((length / part).ceil().max(1.0), most(of_molecule));
        let fits = parts <= (most - placed.min(most)) as f64 + 1.0;
        if fits { Ok(parts as usize) } else { Err(TooFine { spacing, most }) }
    };
    let (Some(first), Some(last)) = (shape_at(a), shape_at(b)) else {
        let count = count(cx.space.distance(a, b), spacing, false)?;
        return Ok((1..count).map(|i| i as f64 / count as f64).collect());
    };
    let part = spacing / PARTS;
    let mut parts = PARTS as usize * count(first.rmsd(&last), spacing, true)?;
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
    let frames = count(whole, spacing - part, true)?;
    let place = |index: usize| {
        let at = whole * (index as f64 / frames as f64);
        sums.partition_point(|sum| *sum < at) as f64 / parts as f64
    };
    Ok((1..frames).map(place).filter(|t| *t > 0.0 && *t < 1.0).collect())
}
