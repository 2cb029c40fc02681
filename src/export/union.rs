//! Boxes that touch are drawn as one: what lies against another box is not seen.

use super::solid::{Edge, Solid};
use super::vector::dot;

/// With more boxes than this each is drawn whole, since every two must be compared.
const BOXES_MAX: usize = 300;

/// A face of a box: its outward normal and offset.
type Plane = ([f64; 3], f64);
/// Whether some box holds a point.
type Occupied<'a> = dyn Fn([f64; 3]) -> bool + 'a;

/// Removes from boxes the parts of their faces and edges that lie inside another box or against it.
/// Solids of other kinds stay as they are.
pub(super) fn join(solids: &mut [Solid]) {
    let boxes: Vec<usize> = (0..solids.len()).filter(|i| solids[*i].is_box).collect();
    if boxes.len() < 2 || boxes.len() > BOXES_MAX {
        return;
    }
    let all: Vec<Vec<Plane>> = boxes.iter().map(|index| solids[*index].planes.clone()).collect();
    for (own, index) in boxes.iter().enumerate() {
        let solid = &mut solids[*index];
        let size = solid.extent();
        let beside = 1e-6 * size;
        let near: Vec<&Vec<Plane>> = all
            .iter()
            .enumerate()
            .filter(|(other, planes)| *other != own && meets(solid, planes, beside))
            .map(|(_, planes)| planes)
            .collect();
        if near.is_empty() {
            continue;
        }
        for patch in &mut solid.patches {
            for planes in &near {
                let polygons = std::mem::take(&mut patch.polygons);
                for polygon in polygons {
                    subtract(
                        polygon,
                        patch.normal.map(|v| v * beside),
                        planes,
                        &mut patch.polygons,
                    );
                }
            }
        }
        solid.patches.retain(|patch| !patch.polygons.is_empty());
        let planes = &all[own];
        let occupied = |p: [f64; 3]| holds(planes, p) || near.iter().any(|planes| holds(planes, p));
        let edges = std::mem::take(&mut solid.edges);
        solid.edges =
            edges.iter().flat_map(|edge| bare(edge, &near, 2.0 * beside, &occupied)).collect();
    }
}

/// Whether a solid touches a box or is within `margin` of it, as far as the faces of the box can tell them apart.
fn meets(solid: &Solid, planes: &[Plane], margin: f64) -> bool {
    planes.iter().all(|(normal, offset)| {
        solid.points.iter().any(|point| dot(*normal, *point) <= offset + margin)
    })
}

/// Whether a point lies in a box.
fn holds(planes: &[Plane], point: [f64; 3]) -> bool {
    planes.iter().all(|(normal, offset)| dot(*normal, point) <= *offset)
}

/// Appends to `out` the parts of a convex polygon that lie outside a box when they are moved by `outward`. The short
/// way outward makes faces that lie against the box count as inside.
fn subtract(
    polygon: Vec<[f64; 3]>,
    outward: [f64; 3],
    planes: &[Plane],
    out: &mut Vec<Vec<[f64; 3]>>,
) {
    let mut left = polygon;
    let mut outside = Vec::new();
    for (normal, offset) in planes {
        let beyond = |p: &[f64; 3]| dot(*normal, *p) + dot(*normal, outward) - offset;
        let cut = |sign: f64| {
            let mut part = Vec::new();
            for (i, p) in left.iter().enumerate() {
                let next = left[(i + 1) % left.len()];
                let (here, there) = (sign * beyond(p), sign * beyond(&next));
                if here >= 0.0 {
                    part.push(*p);
                }
                if here * there < 0.0 {
                    let t = here / (here - there);
                    part.push([0, 1, 2].map(|axis| p[axis] + (next[axis] - p[axis]) * t));
                }
            }
            part
        };
        let (far, near) = (cut(1.0), cut(-1.0));
        if far.len() >= 3 && near.len() < 3 {
            // The rest lies outside as a whole: more cuts would only leave seams.
            outside.push(left);
            out.append(&mut outside);
            return;
        }
        if far.len() >= 3 {
            outside.push(far);
        }
        left = near;
        if left.len() < 3 {
            break;
        }
    }
    out.append(&mut outside);
}

/// The parts of a box's edge that are edges of the union of all boxes. At a point of the edge the four places around
/// it, `beside` away, are tested: the union has an edge there if one or three of them are occupied, or two that lie
/// opposite each other. That can only change where a face of another box crosses the edge.
fn bare(edge: &Edge, near: &[&Vec<Plane>], beside: f64, occupied: &Occupied) -> Vec<Edge> {
    let Some([u, v]) = edge.normals else { return vec![*edge] };
    let [from, to] = edge.ends;
    let along = [0, 1, 2].map(|i| to[i] - from[i]);
    let crossing = |(normal, offset): &Plane| {
        let t = (offset - dot(*normal, from)) / dot(*normal, along);
        (t > 0.0 && t < 1.0).then_some(t)
    };
    let mut cuts: Vec<f64> =
        near.iter().flat_map(|box_| box_.iter().filter_map(crossing)).collect();
    cuts.extend([0.0, 1.0]);
    cuts.sort_by(f64::total_cmp);
    let on = |t: f64| [0, 1, 2].map(|i| from[i] + along[i] * t);
    let bends = |middle: [f64; 3]| {
        let around = |su: f64, sv: f64| {
            occupied([0, 1, 2].map(|i| middle[i] + beside * (su * u[i] + sv * v[i])))
        };
        let places = [around(-1.0, -1.0), around(1.0, -1.0), around(1.0, 1.0), around(-1.0, 1.0)];
        let count = places.iter().filter(|place| **place).count();
        count % 2 == 1 || count == 2 && places[0] == places[2]
    };
    let stretches = cuts.windows(2).map(|pair| (pair[0], pair[1]));
    stretches
        .filter(|(start, end)| end - start > 1e-9 && bends(on((start + end) / 2.0)))
        .map(|(start, end)| Edge { ends: [on(start), on(end)], normals: edge.normals })
        .collect()
}
