//! Whether two triangle meshes meet: parry's trees, walked together, and an exact test at the leaves.
//!
//! parry's own test walks the second tree anew from its root for every triangle of the first, and tests
//! triangles by an iterative method; this is several times faster and has no iteration to end early.

use parry3d_f64::math::{Matrix, Pose, Vector};
use parry3d_f64::partitioning::BvhNode;
use parry3d_f64::shape::TriMesh;

/// Whether any triangles of the two meshes meet; touching counts. `pos12` is the second mesh's frame in
/// the first's.
pub(super) fn meshes_meet(pos12: &Pose, mesh1: &TriMesh, mesh2: &TriMesh) -> bool {
    let turn = Matrix::from_quat(pos12.rotation);
    let abs_turn = Matrix::from_cols(turn.x_axis.abs(), turn.y_axis.abs(), turn.z_axis.abs());
    let back = turn.transpose();
    let abs_back = abs_turn.transpose();
    // A box of either tree against one of the other, along the axes of both. The margin outweighs
    // rounding: a pair of boxes that meet is never passed over.
    let boxes_meet = |node1: &BvhNode, node2: &BvhNode| {
        let (min1, max1, min2, max2) = (node1.mins(), node1.maxs(), node2.mins(), node2.maxs());
        let (half1, half2) = ((max1 - min1) * 0.5, (max2 - min2) * 0.5);
        let (centre1, centre2) = ((max1 + min1) * 0.5, turn * ((max2 + min2) * 0.5));
        let apart = centre2 + pos12.translation - centre1;
        let margin =
            1e-12 * (centre1.abs() + centre2.abs() + pos12.translation.abs() + half1 + half2);
        let reach = half1 + abs_turn * half2 + margin;
        if apart.abs().cmpgt(reach).any() {
            return false;
        }
        let reach = half2 + abs_back * (half1 + margin) + Vector::splat(margin.max_element());
        !(back * apart).abs().cmpgt(reach).any()
    };
    let corners = |mesh: &TriMesh, index: u32| {
        let [a, b, c] = mesh.indices()[index as usize];
        [a, b, c].map(|corner| mesh.vertices()[corner as usize])
    };
    mesh1.bvh().leaf_pairs(mesh2.bvh(), boxes_meet).any(|(leaf1, leaf2)| {
        let second = corners(mesh2, leaf2).map(|corner| turn * corner + pos12.translation);
        triangles_meet(&corners(mesh1, leaf1), &second)
    })
}

/// Whether two triangles meet, by the separating axis theorem: two triangles are apart exactly if they
/// are so along one of 17 directions, the normals, the products of edges, and, for those in one plane,
/// the normals of the edges within it.
fn triangles_meet(first: &[Vector; 3], second: &[Vector; 3]) -> bool {
    // Near the origin, where differences are exact to more digits.
    let origin = second[0];
    let first = first.map(|corner| corner - origin);
    let second = second.map(|corner| corner - origin);
    let apart = |axis: Vector| {
        let [a, b, c] = first.map(|corner| axis.dot(corner));
        let [d, e, f] = second.map(|corner| axis.dot(corner));
        a.min(b).min(c) > d.max(e).max(f) || d.min(e).min(f) > a.max(b).max(c)
    };
    let edges = |t: &[Vector; 3]| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (edges1, edges2) = (edges(&first), edges(&second));
    let (normal1, normal2) = (edges1[0].cross(edges1[1]), edges2[0].cross(edges2[1]));
    !(apart(normal1)
        || apart(normal2)
        || edges1.iter().any(|edge1| edges2.iter().any(|edge2| apart(edge1.cross(*edge2))))
        || edges1.iter().any(|edge| apart(edge.cross(normal1)))
        || edges2.iter().any(|edge| apart(edge.cross(normal2))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use parry3d_f64::query::intersection_test;
    use parry3d_f64::shape::Triangle;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vector> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vector::new(x, y, z))
    }

    proptest! {
        /// Against parry's test of convex shapes, and against moving one triangle along the axis.
        #[test]
        fn triangles_meet_when_parry_says_so(corners in proptest::collection::vec(point(), 6)) {
            let first = [corners[0], corners[1], corners[2]];
            let second = [corners[3], corners[4], corners[5]];
            let parry = |t: [Vector; 3]| Triangle::new(t[0], t[1], t[2]);
            let still = Pose::IDENTITY;
            let expected = intersection_test(&still, &parry(first), &still, &parry(second));
            let expected = expected.unwrap().intersecting;
            prop_assert_eq!(triangles_meet(&first, &second), expected);
            prop_assert_eq!(triangles_meet(&second, &first), expected);
            // Triangles that share a corner or an edge meet.
            prop_assert!(triangles_meet(&first, &[corners[0], corners[4], corners[5]]));
            prop_assert!(triangles_meet(&first, &[corners[0], corners[1], corners[5]]));
        }

        #[test]
        fn triangles_in_one_plane_are_told_apart(x in -4.0f64..4.0, y in -4.0f64..4.0) {
            let first = [Vector::ZERO, Vector::X, Vector::Y];
            let second = first.map(|corner| corner + Vector::new(x, y, 0.0));
            // Two equal triangles shifted in their plane overlap where |shift| is small in the norm of
            // the hexagon that their difference spans.
            let norm = x.abs().max(y.abs()).max((x + y).abs());
            prop_assume!((norm - 1.0).abs() > 1e-9);
            prop_assert_eq!(triangles_meet(&first, &second), norm < 1.0);
        }

        #[test]
        fn meshes_meet_when_any_of_their_triangles_do(
            points in proptest::collection::vec(point(), 24), far in point(), turn in point(),
        ) {
            let mesh = |points: &[Vector]| {
                let triangles = (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
                TriMesh::new(points.to_vec(), triangles.collect()).unwrap()
            };
            let (mesh1, mesh2) = (mesh(&points[..12]), mesh(&points[12..]));
            let pos12 = Pose::new(far * 2.0, turn * 3.0);
            let any = (0..4).any(|i| (0..4).any(|j| {
                let first = [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
                let second = [12, 13, 14].map(|k| pos12.transform_point(points[3 * j + k]));
                triangles_meet(&first, &second)
            }));
            prop_assert_eq!(meshes_meet(&pos12, &mesh1, &mesh2), any);
        }
    }
}
