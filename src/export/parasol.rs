//! The files of Parasol's planners and of its viewer Vizmo, as Open-PPL writes them.
//!
//! A configuration there is a number per degree of freedom: positions as they are, every angle as a
//! fraction of π in `[-1, 1]`. A rotation in 3D is three of them, about x, y and z, which together
//! mean `Rz · Ry · Rx`. Between configurations Open-PPL interpolates each number by itself where
//! roadmill turns about one axis: nodes are the same there, motions between them nearly.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::context::Context;
use crate::local::Planner;
use crate::math;
use crate::problem::Problem;
use crate::query::Path;
use crate::roadmap::Roadmap;
use crate::space::{FactorKind, Space};
use std::f64::consts::PI;
use std::fmt::Write;

/// See [`parasol_map`].
pub(super) struct Map;

impl RoadmapFormat for Map {
    fn name(&self) -> &'static str {
        "map"
    }

    fn about(&self) -> &'static str {
        "A roadmap of Parasol's planners and of Vizmo"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, .. } = *exported;
        Ok(vec![ExportFile::named(parasol_map(problem, &problem.context(), roadmap))])
    }
}

/// A roadmap as a `.map` file. It names the environment `NAME.env`, after the problem, which is not
/// written. A node's line is `id configuration degree`, then for every edge, which stands at both its
/// ends, `target turns configurations weight`, the turns being where its motion changes direction.
pub fn parasol_map(problem: &Problem, cx: &Context, roadmap: &Roadmap) -> String {
    let (space, nodes) = (&cx.space, roadmap.configs());
    let mut adjacent: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (index, edge) in roadmap.edges().iter().enumerate() {
        adjacent[edge.low.index()].push(index);
        adjacent[edge.high.index()].push(index);
    }
    // In the file a name is a single word.
    let name: String =
        problem.name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
    let mut map = format!("#####ENVFILESTART#####\n{name}.env\n#####ENVFILESTOP#####\n");
    map.push_str("#####GRAPHSTART#####\n");
    put(&mut map, format_args!("{} {} {0}", nodes.len(), 2 * roadmap.edges().len()));
    for (node, q) in nodes.iter().enumerate() {
        put(&mut map, format_args!("\n{node} {} {} ", line(space, q), adjacent[node].len()));
        for index in &adjacent[node] {
            let edge = roadmap.edges().get(*index);
            let forwards = edge.low.index() == node;
            let target = if forwards { edge.high } else { edge.low };
            let planner = Planner::from_tag(edge.planner).expect("edges carry known planners");
            let ends = [edge.low, edge.high].map(|end| nodes.get(end.index()));
            let motion = planner.motion(cx, ends[0], ends[1]);
            let mut turns: Vec<&[f64]> = (1..motion.len() - 1).map(|i| motion.get(i)).collect();
            if !forwards {
                turns.reverse();
            }
            put(&mut map, format_args!("{target} {} ", turns.len()));
            for turn in turns {
                put(&mut map, format_args!("{} ", line(space, turn)));
            }
            put(&mut map, format_args!("{}  ", edge.weight()));
        }
    }
    map.push_str("\n#####GRAPHSTOP#####\n");
    map
}

/// A path as a `.path` file: three lines of heading, the last of which counts the configurations,
/// then a configuration per line.
pub fn parasol_path(space: &Space, path: &Path) -> String {
    let mut text = "VIZMO_PATH_FILE   Path Version 2012\n1\n".to_owned();
    put(&mut text, format_args!("{}\n", path.configs.len()));
    for q in path.configs.iter() {
        put(&mut text, format_args!("{}\n", line(space, q)));
    }
    text
}

fn put(text: &mut String, more: std::fmt::Arguments) {
    text.write_fmt(more).expect("writing to memory cannot fail");
}

/// A configuration as Parasol's programs write it.
fn line(space: &Space, q: &[f64]) -> String {
    let mut values = Vec::new();
    for part in space.factors() {
        match part.kind {
            FactorKind::Rotation => {
                let [w, x, y, z] = [0, 1, 2, 3].map(|i| q[part.at + i]);
                values.extend(euler([w, x, y, z]).map(|angle| angle / PI));
            }
            FactorKind::Angle => values.push(q[part.at] / PI),
            FactorKind::Real { .. } if space.dofs()[part.at].unit == "rad" => {
                values.push(q[part.at] / PI);
            }
            FactorKind::Real { .. } => values.push(q[part.at]),
        }
    }
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

/// The angles about x, y and z, in radians, whose `Rz · Ry · Rx` is the rotation of a unit
/// quaternion. Where y is a quarter turn, x and z turn about the same axis, and z is 0.
fn euler([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    // Entries of the rotation matrix.
    let sine = 2.0 * (w * y - x * z);
    let (r00, r10) = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z));
    let (r21, r22) = (2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y));
    let cosine = (r00 * r00 + r10 * r10).sqrt();
    let about_y = math::atan2(sine, cosine);
    if cosine < 1e-9 {
        let (r01, r11) = (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z));
        let about_x = if sine > 0.0 { math::atan2(r01, r11) } else { math::atan2(-r01, r11) };
        return [about_x, about_y, 0.0];
    }
    [math::atan2(r21, r22), about_y, math::atan2(r10, r00)]
}

#[cfg(test)]
mod tests {
    use super::euler;
    use crate::math;
    use crate::scene::Pose;
    use crate::space::canonical;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    fn turn(axis: usize, angle: f64) -> Pose {
        let mut rotation = [math::cos(angle / 2.0), 0.0, 0.0, 0.0];
        rotation[1 + axis] = math::sin(angle / 2.0);
        Pose { translation: [0.0; 3], rotation }
    }

    fn assert_same(rotation: [f64; 4]) {
        let [x, y, z] = euler(rotation);
        let again = turn(2, z).then(&turn(1, y)).then(&turn(0, x));
        let once = Pose { translation: [0.0; 3], rotation };
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let (a, b) = (once.apply(axis), again.apply(axis));
            for i in 0..3 {
                assert!((a[i] - b[i]).abs() < 1e-7, "{rotation:?}: {a:?} is not {b:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn three_turns_make_the_same_rotation(q in prop::array::uniform4(-1.0f64..1.0)) {
            if let Some(rotation) = canonical(q) {
                assert_same(rotation);
            }
        }
    }

    #[test]
    fn so_they_do_where_y_is_a_quarter_turn() {
        for sign in [1.0, -1.0] {
            assert_same([FRAC_1_SQRT_2, 0.0, sign * FRAC_1_SQRT_2, 0.0]);
            assert_same([0.5, 0.5, sign * 0.5, sign * 0.5]);
            assert_same([0.5, -0.5, sign * 0.5, -sign * 0.5]);
        }
    }
}
