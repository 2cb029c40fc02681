//! The scene's tree of nodes: which geometries are instantiated, and under which transformations.

use super::affine::Affine;
use super::geometry::{Geometry, Sources};
use super::{Dae, child};
use crate::scene::raw::{MeshError, RawMesh};
use roxmltree::Node;
use std::collections::BTreeMap;

/// The deepest nesting of nodes, so that nodes that instantiate each other in a circle are an error.
const DEPTH_MAX: usize = 64;
/// The most nodes and geometries visited, so that a small file of instances of instances cannot take for ever.
const VISITS_MAX: usize = 1 << 20;

struct Walk<'d, 'a> {
    dae: &'d Dae<'a>,
    geometries: BTreeMap<usize, Geometry>,
    sources: Sources,
    visits: usize,
}

pub(super) fn walk_scene<'a>(
    dae: &Dae<'a>,
    scene: Node<'a, 'a>,
    mesh: &mut RawMesh,
) -> Result<(), MeshError> {
    let mut walk = Walk { dae, geometries: BTreeMap::new(), sources: Sources::new(), visits: 0 };
    for node in scene.children().filter(|node| node.tag_name().name() == "node") {
        walk.node(node, &Affine::IDENTITY, 1, mesh)?;
    }
    Ok(())
}

impl<'a> Walk<'_, 'a> {
    fn node(
        &mut self,
        node: Node<'a, 'a>,
        parent: &Affine,
        depth: usize,
        mesh: &mut RawMesh,
    ) -> Result<(), MeshError> {
        self.visit(node)?;
        if depth > DEPTH_MAX {
            let message = format!("nodes nested or instantiated more than {DEPTH_MAX} deep");
            return Err(self.dae.error(node, message));
        }
        // The transformations of a node compose in the order of the file: the last one acts first on its points.
        let mut frame = *parent;
        for element in node.children().filter(Node::is_element) {
            match element.tag_name().name() {
                "matrix" => {
                    let v = self.numbers::<16>(element)?;
                    let rows = [0, 4, 8].map(|i| [v[i], v[i + 1], v[i + 2], v[i + 3]]);
                    if v[12..] != [0.0, 0.0, 0.0, 1.0] {
                        let message = "last row other than 0 0 0 1 found; an affine map expected";
                        return Err(self.dae.error(element, message));
                    }
                    frame = frame.then(&Affine { rows });
                }
                "translate" => {
                    frame = frame.then(&Affine::translation(self.numbers(element)?));
                }
                "scale" => frame = frame.then(&Affine::scaling(self.numbers(element)?)),
                "rotate" => {
                    let [x, y, z, degrees] = self.numbers(element)?;
                    let rotation = Affine::rotation([x, y, z], degrees).ok_or_else(|| {
                        self.dae.error(element, "an axis other than zero expected")
                    })?;
                    frame = frame.then(&rotation);
                }
                tag @ ("lookat" | "skew") => {
                    let message =
                        format!("<{tag}> found; matrix, translate, rotate or scale expected");
                    return Err(self.dae.error(element, message));
                }
                _ => {}
            }
        }
        for element in node.children().filter(Node::is_element) {
            match element.tag_name().name() {
                "node" => self.node(element, &frame, depth + 1, mesh)?,
                "instance_node" => {
                    let target = self.dae.target(element, "url", "node")?;
                    self.node(target, &frame, depth + 1, mesh)?;
                }
                "instance_geometry" => {
                    self.visit(element)?;
                    let target = self.dae.target(element, "url", "geometry")?;
                    self.geometry(element, target, &frame, mesh)?;
                }
                "instance_controller" => {
                    let message =
                        "a skinned or morphed mesh found; a plain <instance_geometry> expected";
                    return Err(self.dae.error(element, message));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn visit(&mut self, node: Node) -> Result<(), MeshError> {
        self.visits += 1;
        if self.visits > VISITS_MAX {
            return Err(self
                .dae
                .error(node, format!("more than {VISITS_MAX} nodes and instances")));
        }
        Ok(())
    }

    fn geometry(
        &mut self,
        instance: Node,
        target: Node<'a, 'a>,
        frame: &Affine,
        mesh: &mut RawMesh,
    ) -> Result<(), MeshError> {
        let Some(described) = child(target, "mesh") else {
            return Err(self.dae.error(target, "a geometry without <mesh>"));
        };
        let key = target.range().start;
        if !self.geometries.contains_key(&key) {
            self.geometries.insert(key, Geometry::read(self.dae, described, &mut self.sources)?);
        }
        let geometry = &self.geometries[&key];
        geometry.append_to(frame, mesh).map_err(|message| self.dae.error(instance, message))
    }

    fn numbers<const N: usize>(&self, node: Node) -> Result<[f64; N], MeshError> {
        let numbers = self.dae.floats(node)?;
        let found = numbers.len();
        numbers.try_into().map_err(|_| {
            let tag = node.tag_name().name();
            self.dae.error(node, format!("<{tag}> of {found} numbers found; {N} expected"))
        })
    }
}
