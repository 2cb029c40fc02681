//! `.dae`, COLLADA 1.4 and 1.5: the triangles of the instantiated visual scene, each node's
//! transformation applied. Materials, cameras, lights and textures say nothing about the shape.
//!
//! The XML itself is read by `roxmltree`, which knows each node's line and refuses document type
//! definitions, so that no entity can make a small file large.
//!
//! Vertices are stored the way that importers store them, since their mean may become the origin: a vertex is
//! repeated for every group of triangles or lines that uses it and for every normal that it has there. Lines give
//! vertices but no triangles.

mod affine;
mod geometry;
mod nodes;

use super::raw::{MeshError, RawMesh, UpAxis};
use crate::source::{too_many_attributes, xml_text};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;
use std::path::Path;

/// A file that is being read, and its elements by their ids.
struct Dae<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    by_id: BTreeMap<&'a str, Node<'a, 'a>>,
}

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<RawMesh, MeshError> {
    let text = xml_text(bytes).map_err(|error| {
        let message = format!("{}; a COLLADA .dae expected", error.found);
        MeshError::line(path, error.line, message)
    })?;
    if let Some((line, message)) = too_many_attributes(&text) {
        return Err(MeshError::line(path, line, message));
    }
    let document = Document::parse(&text).map_err(|error| {
        MeshError::line(path, error.pos().row as usize, format!("not COLLADA: {error}"))
    })?;
    let mut by_id = BTreeMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            by_id.entry(id).or_insert(node);
        }
    }
    let dae = Dae { path, document: &document, by_id };
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        let found = root.tag_name().name();
        return Err(dae.error(root, format!("<{found}> found; <COLLADA> expected")));
    }
    let mut mesh = RawMesh::default();
    dae.asset(root, &mut mesh)?;
    let scene = dae.visual_scene(root)?;
    nodes::walk_scene(&dae, scene, &mut mesh)?;
    Ok(mesh)
}

impl<'a> Dae<'a> {
    fn error(&self, node: Node, message: impl Into<String>) -> MeshError {
        let line = self.document.text_pos_at(node.range().start).row;
        MeshError::line(self.path, line as usize, message)
    }

    fn asset(&self, root: Node, mesh: &mut RawMesh) -> Result<(), MeshError> {
        let Some(asset) = child(root, "asset") else { return Ok(()) };
        if let Some(node) = child(asset, "up_axis") {
            mesh.up = Some(match node.text().unwrap_or_default().trim() {
                "X_UP" => UpAxis::X,
                "Y_UP" => UpAxis::Y,
                "Z_UP" => UpAxis::Z,
                other => {
                    let expected = "X_UP, Y_UP or Z_UP expected";
                    return Err(self.error(node, format!("`{other}` found; {expected}")));
                }
            });
        }
        if let Some(node) = child(asset, "unit")
            && let Some(word) = node.attribute("meter")
        {
            mesh.unit_metres = match word.trim().parse::<f64>() {
                Ok(metres) if metres.is_finite() && metres > 0.0 => Some(metres),
                _ => {
                    let message = format!("meter = `{word}` found; a positive length expected");
                    return Err(self.error(node, message));
                }
            };
        }
        Ok(())
    }

    /// The scene that the file asks for, or its first.
    fn visual_scene(&self, root: Node<'a, 'a>) -> Result<Node<'a, 'a>, MeshError> {
        let asked = child(root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
        if let Some(instance) = asked {
            return self.target(instance, "url", "visual_scene");
        }
        let first = children(root, "library_visual_scenes")
            .find_map(|library| child(library, "visual_scene"));
        first.ok_or_else(|| self.error(root, "no visual scene found; one expected"))
    }

    /// The element that an attribute `#ID` names.
    fn target(&self, node: Node, key: &str, tag: &str) -> Result<Node<'a, 'a>, MeshError> {
        let url = self.attribute(node, key)?;
        let Some(id) = url.strip_prefix('#') else {
            let message =
                format!("{key} = `{url}` found; `#ID` of an element of this file expected");
            return Err(self.error(node, message));
        };
        match self.by_id.get(id) {
            Some(found) if found.tag_name().name() == tag => Ok(*found),
            Some(found) => {
                let message =
                    format!("`{url}` is a <{}>; a <{tag}> expected", found.tag_name().name());
                Err(self.error(node, message))
            }
            None => Err(self.error(node, format!("`{url}` does not exist; a <{tag}> expected"))),
        }
    }

    fn attribute<'n>(&self, node: Node<'n, '_>, key: &str) -> Result<&'n str, MeshError> {
        node.attribute(key).ok_or_else(|| {
            self.error(node, format!("<{}> without `{key}`", node.tag_name().name()))
        })
    }

    /// An attribute that is a count, or its default.
    fn count(&self, node: Node, key: &str, default: Option<usize>) -> Result<usize, MeshError> {
        match (node.attribute(key), default) {
            (None, Some(default)) => Ok(default),
            _ => {
                let word = self.attribute(node, key)?;
                word.trim().parse().map_err(|_| {
                    self.error(node, format!("{key} = `{word}` found; a count expected"))
                })
            }
        }
    }

    /// The numbers in an element's text.
    fn floats(&self, node: Node) -> Result<Vec<f64>, MeshError> {
        let mut numbers = Vec::new();
        for word in node.text().unwrap_or_default().split_ascii_whitespace() {
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => numbers.push(number),
                _ => {
                    let tag = node.tag_name().name();
                    let message = format!("`{word}` found in <{tag}>; a finite number expected");
                    return Err(self.error(node, message));
                }
            }
        }
        Ok(numbers)
    }
}

fn child<'a>(node: Node<'a, 'a>, tag: &'static str) -> Option<Node<'a, 'a>> {
    children(node, tag).next()
}

fn children<'a>(node: Node<'a, 'a>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| child.tag_name().name() == tag)
}

#[cfg(test)]
mod tests;
