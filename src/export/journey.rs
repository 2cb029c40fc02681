//! Obstacles, the robot at poses along the path, and the path itself.

use super::drawing::{Drawing, INK, PAPER, STONE, WARM, WAY, blend};
use super::paint_order::paint_order;
use super::solid::{Solid, solids};
use super::union::join;
use crate::query;
use crate::scene::{Body, Pose};
use crate::space::Space;
use std::fmt::Write;

/// Poses of the robot drawn along a path, both ends included.
const POSES: usize = 18;
/// The length of a path is summed over this many steps of each of its motions.
const STEPS: usize = 32;
/// Pieces into which a path in 3D is cut, each painted in its own turn, so that walls can hide parts of the path.
const CUTS: usize = 160;

/// How a solid is painted.
#[derive(Clone, Copy)]
struct Look<'a> {
    /// The colours of surfaces in the shade and in the light: red, green and blue, from 0 to 255.
    shades: [[f64; 3]; 2],
    /// Opacity of the surfaces, from 0 to 1.
    opacity: &'a str,
    /// Colour of the edges.
    edge: &'a str,
    /// Width of the edges.
    width: &'a str,
}

/// The configurations at these fractions of a path's length, ascending from 0 to 1.
fn along(space: &Space, path: &query::Path, fractions: &[f64]) -> Vec<Vec<f64>> {
    let mut fine = vec![(0.0, path.configs.get(0).to_vec())];
    for i in 1..path.configs.len() {
        let (a, b) = (path.configs.get(i - 1), path.configs.get(i));
        for step in 1..=STEPS {
            let mut q = vec![0.0; space.len()];
            space.interpolate(a, b, step as f64 / STEPS as f64, &mut q);
            let (before, last) = &fine[fine.len() - 1];
            let length = before + space.distance(last, &q);
            fine.push((length, q));
        }
    }
    let whole = fine[fine.len() - 1].0;
    fractions
        .iter()
        .map(|fraction| {
            let place = fine.partition_point(|(length, _)| *length < fraction * whole);
            fine[place.min(fine.len() - 1)].1.clone()
        })
        .collect()
}

impl Drawing<'_> {
    pub(super) fn obstacles(&mut self) {
        for solid in self.stand(self.figure.obstacles()) {
            let text = self.obstacle(&solid);
            self.put(format_args!("{text}"));
        }
    }

    /// Bodies given in the world's frame, as they are drawn; boxes that touch are drawn as one.
    pub(super) fn stand(&self, bodies: &[Body]) -> Vec<Solid> {
        let mut standing: Vec<Solid> =
            bodies.iter().flat_map(|body| solids(body, &Pose::IDENTITY, &self.view)).collect();
        join(&mut standing);
        standing
    }

    fn obstacle(&self, solid: &Solid) -> String {
        let edge = blend(STONE, 0.0);
        let look = match self.planar {
            true => Look { shades: STONE, opacity: "1", edge: &edge, width: "1" },
            false => Look { shades: STONE, opacity: "0.6", edge: INK, width: "0.9" },
        };
        self.solid(solid, "obstacle", look)
    }

    /// A solid, lighter where it faces the light, with its edges on top.
    fn solid(&self, solid: &Solid, class: &str, look: Look) -> String {
        let Look { shades, opacity, edge, width } = look;
        let mut text = format!("<g class=\"{class}\">");
        for patch in &solid.patches {
            let mut outline = String::new();
            for polygon in &patch.polygons {
                outline.push_str(&self.line(polygon.iter().copied()));
                outline.push('Z');
            }
            // The light comes from the upper left, from behind the eye.
            let view = &self.view;
            let light: f64 = (0..3)
                .map(|i| {
                    let toward = 0.5 * view.toward[i] - 0.35 * view.right[i] + 0.75 * view.up[i];
                    toward * patch.normal[i]
                })
                .sum();
            let share = if self.planar { 0.0 } else { light.clamp(0.0, 1.0) };
            let fill = blend(shades, share);
            write!(text, "<path d=\"{outline}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"/>")
                .expect("writing to memory cannot fail");
        }
        let edges: String = solid.edges.iter().map(|edge| self.line(edge.ends)).collect();
        write!(
            text,
            "<path d=\"{edges}\" stroke=\"{edge}\" stroke-width=\"{width}\" fill=\"none\"/></g>"
        )
        .expect("writing to memory cannot fail");
        text
    }

    /// The configurations at which the robot is drawn, each with its share of the path: evenly along the path, or,
    /// without a path, the query's start and goal.
    fn poses(&self, path: Option<&query::Path>) -> Vec<(f64, Vec<f64>)> {
        match (path, &self.problem.query) {
            (Some(path), _) if path.configs.len() == 1 => {
                vec![(0.0, path.configs.get(0).to_vec())]
            }
            (Some(path), _) => {
                let fractions: Vec<f64> =
                    (0..POSES).map(|i| i as f64 / (POSES - 1) as f64).collect();
                let configs = along(&self.problem.space(), path, &fractions);
                fractions.into_iter().zip(configs).collect()
            }
            (None, Some(ends)) => {
                vec![(0.0, ends.start.clone()), (1.0, ends.goal.clone())]
            }
            (None, None) => Vec::new(),
        }
    }

    fn robot(&self, share: f64, q: &[f64]) -> Vec<(Solid, String)> {
        let full = blend(WARM, share);
        let tone = [0, 1, 2].map(|i| WARM[0][i] + (WARM[1][i] - WARM[0][i]) * share);
        let shades =
            [tone.map(|value| value * 0.86), tone.map(|value| value + (255.0 - value) * 0.35)];
        let ends = share == 0.0 || share == 1.0;
        let (opacity, width) = match (self.planar, ends) {
            (true, true) => ("0.9", "1.6"),
            (true, false) => ("0.22", "1.3"),
            (false, true) => ("0.92", "1"),
            (false, false) => ("0.5", "0.8"),
        };
        let edge = if ends { INK } else { &full };
        let parts = self.stand(&self.figure.bodies_at(q));
        parts
            .into_iter()
            .map(|solid| {
                let shades = if self.planar { [tone; 2] } else { shades };
                let look = Look { shades, opacity, edge, width };
                let text = self.solid(&solid, "robot", look);
                (solid, text)
            })
            .collect()
    }

    /// The path of a planar problem: poses, then the line on top.
    pub(super) fn journey(&mut self, path: Option<&query::Path>) {
        for (share, q) in self.poses(path) {
            for (_, text) in self.robot(share, &q) {
                self.put(format_args!("{text}"));
            }
        }
        let Some(path) = path else { return };
        let line = self.line(path.configs.iter().map(|q| self.figure.marker(q)));
        for (class, colour, width) in [("casing", PAPER, "6.5"), ("way", WAY, "3.2")] {
            self.put(format_args!(
                "<path class=\"{class}\" d=\"{line}\" fill=\"none\" stroke=\"{colour}\" \
                 stroke-width=\"{width}\"/>"
            ));
        }
    }

    /// Obstacles, poses and the path of a 3D problem, what is hidden first.
    pub(super) fn solids_and_journey(&mut self, path: Option<&query::Path>) {
        let mut items: Vec<(Solid, String)> = Vec::new();
        // The whole path, painted faintly over everything, so that hidden parts of it show through.
        let mut through = String::new();
        for solid in self.stand(self.figure.obstacles()) {
            let text = self.obstacle(&solid);
            items.push((solid, text));
        }
        for (share, q) in self.poses(path) {
            items.extend(self.robot(share, &q));
        }
        if let Some(path) = path {
            let fractions: Vec<f64> = (0..=CUTS).map(|i| i as f64 / CUTS as f64).collect();
            let way: Vec<[f64; 3]> = along(&self.problem.space(), path, &fractions)
                .iter()
                .map(|q| self.figure.marker(q))
                .collect();
            // The path's shadow on the floor shows where in depth the path is.
            let floor = self.extent.floor[0][2];
            let shadow = self.line(way.iter().map(|p| [p[0], p[1], floor]));
            self.put(format_args!(
                "<path class=\"shadow\" d=\"{shadow}\" fill=\"none\" stroke=\"{INK}\" \
                 stroke-opacity=\"0.18\" stroke-width=\"5\"/>"
            ));
            for pair in way.windows(2) {
                let line = self.line(pair.iter().copied());
                let text = format!(
                    "<path d=\"{line}\" fill=\"none\" stroke=\"{WAY}\" stroke-width=\"3.4\"/>"
                );
                items.push((Solid::thread(pair), text));
            }
            let line = self.line(way.iter().copied());
            through = format!(
                "<path class=\"way\" d=\"{line}\" fill=\"none\" stroke=\"{WAY}\" \
                 stroke-opacity=\"0.55\" stroke-width=\"2\"/>"
            );
        }
        let solids: Vec<&Solid> = items.iter().map(|(solid, _)| solid).collect();
        for index in paint_order(&self.view, &solids) {
            self.put(format_args!("{}", items[index].1));
        }
        self.put(format_args!("{through}"));
    }
}
