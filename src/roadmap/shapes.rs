//! The shapes of a graph's nodes, kept so that searches by shape need not compute them anew.

use super::components::Components;
use super::indices::read;
use crate::structure::measure::CentredPoints;
use std::sync::{Arc, RwLockReadGuard};

/// At most about so many points are kept of a graph, which take 100 MB. A chain of 150 residues has as many in 28 000
/// nodes.
const POINTS_MAX: usize = 1 << 22;

/// The shapes of nodes as far as they are kept: of all nodes the radius, of the first also the points.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// Per node; NaN of one without a shape.
    radii: Vec<f64>,
    /// Of the first nodes. Clones of a graph share them.
    points: Vec<Arc<CentredPoints>>,
    /// How many points that are.
    count: usize,
}

impl Shapes {
    /// The radius of gyration of a node's shape, in Å.
    pub fn radius(&self, node: u32) -> f64 {
        self.radii[node as usize]
    }

    /// The points of a node's shape, if they are kept.
    pub fn points(&self, node: u32) -> Option<&CentredPoints> {
        self.points.get(node as usize).map(|points| &**points)
    }

    /// Takes in the shapes of the nodes up to `end`.
    fn extend(
        &mut self,
        end: u32,
        most: usize,
        shape_of: impl FnMut(u32) -> Option<CentredPoints>,
    ) {
        for shape in (self.radii.len() as u32..end).map(shape_of) {
            self.radii.push(shape.as_ref().map_or(f64::NAN, CentredPoints::radius_of_gyration));
            // Kept are the first without a gap.
            if let Some(shape) = shape
                && self.points.len() + 1 == self.radii.len()
                && self.count + shape.points().len() <= most
            {
                self.count += shape.points().len();
                self.points.push(Arc::new(shape));
            }
        }
    }
}

impl Components {
    /// The shapes of all nodes. `shape_of` computes a node's shape: a function of its configuration, the same at every
    /// call for this graph. It is asked for nodes that came since the last call.
    pub fn shapes(
        &self,
        shape_of: impl FnMut(u32) -> Option<CentredPoints>,
    ) -> RwLockReadGuard<'_, Shapes> {
        let shapes = read(&self.indices.shapes);
        if shapes.radii.len() >= self.nodes() as usize {
            return shapes;
        }
        drop(shapes);
        let mut shapes = self.indices.shapes.write().expect("no search panics");
        shapes.extend(self.nodes(), POINTS_MAX, shape_of);
        drop(shapes);
        read(&self.indices.shapes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Point;

    #[test]
    fn radii_are_kept_of_all_nodes_and_points_of_as_many_as_there_is_room_for() {
        let shape = |node: u32| {
            let reach = f64::from(node) * 3.0;
            CentredPoints::new(&[Point::x() * reach, Point::x() * -reach])
        };
        let (mut shapes, mut asked) = (Shapes::default(), Vec::new());
        for end in [3, 8, 8] {
            shapes.extend(end, 9, |node| {
                asked.push(node);
                Some(shape(node))
            });
        }
        assert_eq!(asked, [0, 1, 2, 3, 4, 5, 6, 7]);
        for node in 0..8 {
            assert_eq!(shapes.radius(node), f64::from(node) * 3.0);
            assert_eq!(shapes.points(node), (node < 4).then(|| shape(node)).as_ref());
        }
        // After a node without a shape no points are kept, since they stand by node.
        shapes = Shapes::default();
        shapes.extend(3, 9, |node| (node != 1).then(|| shape(node)));
        assert!(shapes.radius(1).is_nan() && shapes.radius(2) == 6.0);
        assert!(shapes.points(0).is_some() && shapes.points(1).or(shapes.points(2)).is_none());
    }
}
