//! Which paths pass the obstacles alike.
//!
//! Two paths with the same ends belong to one class if one can be deformed into the other without passing an obstacle. In the plane
//! that is decided, for the robot's reference point, by the [crossings](Punctures) of rays from the obstacles. In space it is not:
//! there the class is the order in which the obstacles come nearest along the path, an approximation.

mod crossings;
mod section;

pub use crossings::{Crossing, Punctures, Word, append};

use super::Frames;
use crate::context::Context;
use crate::model::{Description, Figure, Scratch};
use crate::query::Path;

/// To which class a path belongs, among those with the same ends.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PathClass {
    /// In the plane: the reduced word of crossings.
    Crossings(Word),
    /// In space: the indices of the obstacles that are nearest along the path, one after the other.
    Nearest(Vec<usize>),
}

/// How the paths of a model are told apart.
pub struct Topology<'a> {
    figure: &'a dyn Figure,
    /// In the plane.
    punctures: Option<Punctures>,
}

impl<'a> Topology<'a> {
    /// That of a model with obstacles; `None` of one that knows of none.
    ///
    /// - *In the plane*, where the robot's base moves in it: what [`Punctures`] say. Paths with different words cannot be deformed into one another
    ///   by any motion of the robot, as far as its reference point can nowhere be at a puncture, which is looked at in samples.
    ///   Paths with equal words can, if the robot is a point; a larger one may be held up by turning or by a passage too narrow.
    /// - *In space*: the obstacles nearest to the robot at the [frames](Frames) of the path, in their order, each once as long as it
    ///   stays the nearest. Paths of one class are alike in what they pass; but they may pass it on different sides, and
    ///   paths that can be deformed into one another may be of several classes.
    pub fn of(
        cx: &Context,
        description: &'a dyn Description,
        scratch: &mut Scratch,
    ) -> Option<Topology<'a>> {
        cx.model.clearances()?;
        let figure = description.figure()?;
        let punctures = figure.is_planar().then(|| Punctures::of(cx, figure, scratch));
        Some(Topology { figure, punctures })
    }

    /// The punctures by which paths in the plane are told apart.
    pub fn punctures(&self) -> Option<&Punctures> {
        self.punctures.as_ref()
    }

    /// Where the robot's reference point is, in the plane.
    pub(super) fn point(&self, q: &[f64]) -> [f64; 2] {
        let [x, y, _] = self.figure.marker(q);
        [x, y]
    }

    /// The class of a path, which was cut into these frames.
    pub fn class(
        &self,
        cx: &Context,
        path: &Path,
        frames: &Frames,
        scratch: &mut Scratch,
    ) -> PathClass {
        match (&self.punctures, cx.model.clearances()) {
            (Some(punctures), _) => {
                PathClass::Crossings(punctures.word(path.configs.iter().map(|q| self.point(q))))
            }
            (None, Some(clearances)) => {
                let nearest =
                    frames.configs.iter().filter_map(|q| clearances.clearance(q, scratch));
                let mut nearest: Vec<usize> = nearest.map(|clearance| clearance.obstacle).collect();
                nearest.dedup();
                PathClass::Nearest(nearest)
            }
            (None, None) => PathClass::Nearest(Vec::new()),
        }
    }

    /// A class as people read it; obstacles are counted from 1. See [`Punctures::text`].
    pub fn text(&self, class: &PathClass) -> String {
        match (class, &self.punctures) {
            (PathClass::Crossings(word), Some(punctures)) => punctures.text(word),
            (PathClass::Nearest(nearest), _) if !nearest.is_empty() => {
                let numbers = nearest.iter().map(|obstacle| (obstacle + 1).to_string());
                numbers.collect::<Vec<_>>().join(" ")
            }
            _ => "-".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests;
