//! Whether a conformation keeps the rules: single precision says who may be too close, double precision who is.

use super::known::Shortcut;
use super::obstacles::Obstacles;
use super::pairs::{BACKBONE, Counts, Flow, Violation};
use super::rules::{Limits, Rules};
use super::screen::Screen;
use crate::lanes::with_lanes;
use crate::model::protein::placed::{Placed, Site};
use crate::structure::Point;
use fearless_simd::prelude::*;

impl Limits {
    /// Calls `each` for every violation that a shortcut does not leave out, in an order that is the same everywhere, but no one's
    /// wish.
    fn visit(
        &self,
        placed: &Placed,
        obstacles: &Obstacles,
        screen: &mut Screen,
        Shortcut { window, from }: Shortcut,
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        let len = placed.len();
        let mut suspects = std::mem::take(&mut screen.suspects);
        suspects.clear();
        with_lanes!(screen.lanes, simd => simd.vectorize(
            #[inline(always)]
            || {
                screen.is_taken = screen.take(simd, placed, from);
                if !screen.is_taken {
                    return self.of_all(placed, &Obstacles::default(), each);
                }
                // Both closures need these; only one of them runs at a time.
                let both = std::cell::RefCell::new((&mut *each, &mut suspects));
                screen.suspects(
                    simd,
                    self,
                    window,
                    &mut |pair| {
                        let (each, suspects) = &mut *both.borrow_mut();
                        suspects.push((pair.0 as u32, pair.1 as u32));
                        self.of_backbones(placed, pair, each)
                    },
                    &mut |pair: (usize, usize)| {
                        if pair.1 >= len {
                            return Flow::Continue(());
                        }
                        let (each, suspects) = &mut *both.borrow_mut();
                        suspects.push((pair.0 as u32, pair.1 as u32));
                        self.of_side_chains(placed, pair, each)
                    },
                )
            }
        ))?;
        screen.suspects = suspects;
        self.visit_obstacles(placed, obstacles, each)
    }

    /// Calls `each` for every violation by a residue and an obstacle.
    fn visit_obstacles(
        &self,
        placed: &Placed,
        obstacles: &Obstacles,
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        let points = obstacles.points();
        let reach = self.obstacle_backbone.max(self.obstacle_side_chains);
        if points.is_empty() || reach <= 0.0 {
            return Flow::Continue(());
        }
        for residue in 0..placed.len() {
            obstacles.near(corners(placed, residue), reach, |number| {
                self.of_obstacle(placed, residue, (number, &points[number]), each)
            })?;
        }
        Flow::Continue(())
    }

    /// Whether no rule is violated. The screen remembers the last conformation for which this was so: one that differs from
    /// it in torsions that are near one another is checked in less time.
    pub fn is_valid(&self, placed: &Placed, obstacles: &Obstacles, screen: &mut Screen) -> bool {
        let shortcut = screen.shortcut(placed, self);
        let window = shortcut.window;
        let again = screen.look_again(window, &mut |pair| {
            self.of_backbones(placed, pair, &mut Flow::Break)?;
            self.of_side_chains(placed, pair, &mut Flow::Break)
        });
        let is_valid = again.is_continue()
            && self.visit(placed, obstacles, screen, shortcut, &mut Flow::Break).is_continue();
        if is_valid {
            screen.know(placed, self, window);
        }
        is_valid
    }

    /// How many pairs violate each rule; every rule is run to its end.
    pub fn count(&self, placed: &Placed, obstacles: &Obstacles, screen: &mut Screen) -> Counts {
        let (mut counts, everything) = (Counts::default(), screen.everything());
        let _ = self.visit(placed, obstacles, screen, everything, &mut |violation| {
            counts.add(violation.rule);
            Flow::Continue(())
        });
        counts
    }

    /// The first violation: that of the first residue along the chain which has any, with the first residue after it, of
    /// these first the backbones and then the side chains, or else with the first obstacle. It takes many times as long as
    /// [`is_valid`](Limits::is_valid) where there is one.
    pub fn first_violation(
        &self,
        placed: &Placed,
        obstacles: &Obstacles,
        screen: &mut Screen,
    ) -> Option<Violation> {
        if self.is_valid(placed, obstacles, screen) {
            return None;
        }
        self.of_all(placed, obstacles, &mut Flow::Break).break_value()
    }
}

/// The least and the greatest corner of the box around a residue's atoms, no numbers if a coordinate is none.
fn corners(placed: &Placed, residue: usize) -> [Point; 2] {
    let first = placed.at(Site::Centroid, residue);
    let (mut low, mut high, mut sum) = (first, first, first);
    for (_, site) in BACKBONE {
        let at = placed.at(site, residue);
        (low, high, sum) = (low.inf(&at), high.sup(&at), sum + at);
    }
    // A minimum may pass over what is no number; a sum does not.
    let is_number = sum.iter().all(|sum| sum.is_finite());
    if is_number { [low, high] } else { [Point::repeat(f64::NAN); 2] }
}

impl Rules {
    /// The first violation of a conformation without obstacles.
    pub fn first_violation(&self, placed: &Placed) -> Option<Violation> {
        self.at_nodes().first_violation(placed, &Obstacles::default(), &mut Screen::default())
    }
}
