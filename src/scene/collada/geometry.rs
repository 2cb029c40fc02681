//! One `<mesh>`: sources of coordinates and the groups of triangles and lines that use them.

use super::affine::Affine;
use super::{Dae, child, children};
use crate::scene::polygon;
use crate::scene::polygon::fan;
use crate::scene::raw::{MESH_ITEMS_MAX, MeshError, RawMesh};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The sources read so far, by their place in the file, since many groups may share a large one.
pub(super) type Sources = BTreeMap<usize, Rc<[[f64; 3]]>>;

/// Vertices as importers store them, in the geometry's own frame.
#[derive(Default)]
pub(super) struct Geometry {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Geometry {
    pub(super) fn read<'a>(
        dae: &Dae<'a>,
        mesh: Node<'a, 'a>,
        sources: &mut Sources,
    ) -> Result<Geometry, MeshError> {
        let mut geometry = Geometry::default();
        for group in mesh.children().filter(Node::is_element) {
            match group.tag_name().name() {
                "triangles" | "polylist" | "polygons" | "trifans" | "tristrips" | "lines"
                | "linestrips" => geometry.group(dae, group, sources)?,
                _ => {}
            }
        }
        Ok(geometry)
    }

    /// Adds the geometry to the mesh as it stands at `frame`.
    pub(super) fn append_to(&self, frame: &Affine, mesh: &mut RawMesh) -> Result<(), String> {
        let first = mesh.vertices.len();
        let vertices = first + self.vertices.len();
        let triangles = mesh.triangles.len() + self.triangles.len();
        if vertices.max(triangles) > MESH_ITEMS_MAX {
            return Err(format!("more than {MESH_ITEMS_MAX} vertices or triangles"));
        }
        for vertex in &self.vertices {
            let placed = frame.apply(*vertex);
            if !placed.iter().all(|value| value.is_finite()) {
                return Err(format!("a vertex comes to stand at {placed:?}, which is not finite"));
            }
            mesh.vertices.push(placed);
        }
        let placed = self.triangles.iter().map(|t| t.map(|corner| first as u32 + corner));
        mesh.triangles.extend(placed);
        Ok(())
    }

    fn group<'a>(
        &mut self,
        dae: &Dae<'a>,
        group: Node<'a, 'a>,
        sources: &mut Sources,
    ) -> Result<(), MeshError> {
        let tag = group.tag_name().name();
        let inputs = Inputs::read(dae, group, sources)?;
        if child(group, "ph").is_some() {
            return Err(dae.error(group, "a polygon with holes found; one without expected"));
        }
        let mut index_of: BTreeMap<[u64; 6], u32> = BTreeMap::new();
        let mut polygons = 0;
        for list in children(group, "p") {
            let mut corners = Vec::new();
            inputs.corners(dae, list, |position, normal| {
                // Exporters write −0 for 0; adding 0 makes them the same key.
                let key = [position, normal].map(|values| values.map(|v| (v + 0.0).to_bits()));
                let key = [key[0][0], key[0][1], key[0][2], key[1][0], key[1][1], key[1][2]];
                corners.push(*index_of.entry(key).or_insert_with(|| {
                    self.vertices.push(position);
                    self.vertices.len() as u32 - 1
                }));
            })?;
            let before = self.triangles.len();
            match tag {
                "triangles" => {
                    if corners.len() % 3 != 0 {
                        let message = format!("{} corners of triangles found", corners.len());
                        return Err(dae.error(list, message));
                    }
                    self.triangles.extend(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
                    polygons += self.triangles.len() - before;
                }
                "polylist" => polygons += self.polylist(dae, group, list, &corners)?,
                "polygons" => {
                    polygon::cut(&corners, &self.vertices, &mut self.triangles)
                        .map_err(|message| dae.error(list, message))?;
                    polygons += 1;
                }
                "trifans" => {
                    self.triangles.extend(fan(&corners));
                    polygons += 1;
                }
                "tristrips" => {
                    let strip = corners.windows(3).enumerate().map(|(i, c)| {
                        if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] }
                    });
                    self.triangles.extend(strip);
                    polygons += 1;
                }
                "lines" => polygons += corners.len() / 2,
                _ => polygons += 1,
            }
        }
        let stated = dae.count(group, "count", None)?;
        if stated != polygons {
            let message = format!("<{tag}> of {polygons} found; count = {stated} says otherwise");
            return Err(dae.error(group, message));
        }
        Ok(())
    }

    fn polylist<'a>(
        &mut self,
        dae: &Dae<'a>,
        group: Node<'a, 'a>,
        list: Node,
        corners: &[u32],
    ) -> Result<usize, MeshError> {
        let Some(counts) = child(group, "vcount") else {
            return Err(dae.error(group, "<polylist> without <vcount>"));
        };
        let (mut at, mut polygons) = (0usize, 0);
        for word in counts.text().unwrap_or_default().split_ascii_whitespace() {
            let end = word.parse().ok().and_then(|count: usize| at.checked_add(count));
            let Some(polygon) = end.and_then(|end| corners.get(at..end)) else {
                let message = format!(
                    "`{word}` found; the corners of a polygon, {} left, expected",
                    corners.len() - at
                );
                return Err(dae.error(counts, message));
            };
            polygon::cut(polygon, &self.vertices, &mut self.triangles)
                .map_err(|message| dae.error(list, format!("polygon {polygons}: {message}")))?;
            at += polygon.len();
            polygons += 1;
        }
        if at != corners.len() {
            let message = format!("{} corners found; {at} expected by <vcount>", corners.len());
            return Err(dae.error(list, message));
        }
        Ok(polygons)
    }
}

/// What the indices in `<p>` refer to: `stride` of them for each corner, at given offsets one into the positions and
/// one into the normals.
struct Inputs {
    stride: usize,
    positions: (usize, Rc<[[f64; 3]]>),
    normals: Option<(usize, Rc<[[f64; 3]]>)>,
}

impl Inputs {
    fn read<'a>(
        dae: &Dae<'a>,
        group: Node<'a, 'a>,
        sources: &mut Sources,
    ) -> Result<Inputs, MeshError> {
        let mut stride = 1;
        let (mut positions, mut normals) = (None, None);
        for input in children(group, "input") {
            let offset = dae.count(input, "offset", Some(0))?;
            if offset > 64 {
                return Err(
                    dae.error(input, format!("offset = {offset} found; at most 64 expected"))
                );
            }
            stride = stride.max(offset + 1);
            match dae.attribute(input, "semantic")? {
                "VERTEX" => {
                    let vertices = dae.target(input, "source", "vertices")?;
                    for own in children(vertices, "input") {
                        match dae.attribute(own, "semantic")? {
                            "POSITION" => positions = Some((offset, source(dae, own, sources)?)),
                            "NORMAL" => normals = Some((offset, source(dae, own, sources)?)),
                            _ => {}
                        }
                    }
                }
                "NORMAL" => normals = Some((offset, source(dae, input, sources)?)),
                _ => {}
            }
        }
        let Some(positions) = positions else {
            return Err(dae.error(group, "an input VERTEX with a POSITION expected"));
        };
        Ok(Inputs { stride, positions, normals })
    }

    /// Calls `each` with position and normal (zero where there is none) of every corner of `list`.
    fn corners(
        &self,
        dae: &Dae,
        list: Node,
        mut each: impl FnMut([f64; 3], [f64; 3]),
    ) -> Result<(), MeshError> {
        let mut corner = vec![0usize; self.stride];
        let mut filled = 0;
        for word in list.text().unwrap_or_default().split_ascii_whitespace() {
            corner[filled] = word
                .parse()
                .map_err(|_| dae.error(list, format!("`{word}` found; an index expected")))?;
            filled += 1;
            if filled < self.stride {
                continue;
            }
            filled = 0;
            let at = |(offset, values): &(usize, Rc<[[f64; 3]]>)| {
                let index = corner[*offset];
                values.get(index).copied().ok_or_else(|| {
                    let message =
                        format!("vertex {index} does not exist; there are {}", values.len());
                    dae.error(list, message)
                })
            };
            let normal = self.normals.as_ref().map_or(Ok([0.0; 3]), at)?;
            each(at(&self.positions)?, normal);
        }
        if filled != 0 {
            let message = format!("cut off: corners of {} indices expected", self.stride);
            return Err(dae.error(list, message));
        }
        Ok(())
    }
}

/// The triples of a `<source>`: x, y and z are the first three values of its accessor.
fn source<'a>(
    dae: &Dae<'a>,
    input: Node,
    sources: &mut Sources,
) -> Result<Rc<[[f64; 3]]>, MeshError> {
    let source = dae.target(input, "source", "source")?;
    let key = source.range().start;
    if let Some(values) = sources.get(&key) {
        return Ok(values.clone());
    }
    let accessor = child(source, "technique_common").and_then(|node| child(node, "accessor"));
    let Some(accessor) = accessor else {
        return Err(dae.error(source, "<source> without an accessor"));
    };
    let array = dae.target(accessor, "source", "float_array")?;
    let values = dae.floats(array)?;
    let stated = dae.count(array, "count", None)?;
    if stated != values.len() {
        let message = format!("{} numbers found; count = {stated} says otherwise", values.len());
        return Err(dae.error(array, message));
    }
    let count = dae.count(accessor, "count", None)?;
    let stride = dae.count(accessor, "stride", Some(1))?;
    let offset = dae.count(accessor, "offset", Some(0))?;
    let end = count.checked_mul(stride).and_then(|length| length.checked_add(offset));
    if stride < 3 || end.is_none_or(|end| end > values.len()) {
        let message = format!(
            "{count} vertices, {stride} numbers each, found; at least 3 each, {} in all, expected",
            values.len()
        );
        return Err(dae.error(accessor, message));
    }
    let triples = values[offset..].chunks_exact(stride).take(count).map(|v| [v[0], v[1], v[2]]);
    let triples: Rc<[[f64; 3]]> = triples.collect();
    sources.insert(key, triples.clone());
    Ok(triples)
}
