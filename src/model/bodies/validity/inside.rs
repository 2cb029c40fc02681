//! Whether a point lies inside a closed surface.

use super::shells::{Shell, shells};
use crate::scene::Mesh;
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

/// A closed surface prepared for containment tests: its shells, of which some may be cavities.
///
/// A point is inside the surface if it is inside more solid shells than cavities, so that what lies inside two
/// shells that overlap is inside as well. Which shells are cavities depends on how they are turned beside the shells
/// around them, not on which side normals look to: a surface of which all triangles are turned round has the same inside.
#[derive(Debug)]
pub(crate) struct Inside {
    shells: Vec<Prepared>,
    /// The boxes of the shells.
    tree: Bvh,
}

/// A shell prepared for containment tests.
#[derive(Debug)]
struct Prepared {
    triangles: Vec<[[f64; 3]; 3]>,
    tree: Bvh,
    aabb: Aabb,
    /// Whether the triangles are turned consistently.
    is_oriented: bool,
    /// Whether what it encloses is taken away from what other shells enclose.
    is_cavity: bool,
}

impl Inside {
    pub(crate) fn new(mesh: &Mesh) -> Inside {
        let mut shells: Vec<Prepared> =
            shells(mesh).iter().map(|shell| Prepared::new(mesh, shell)).collect();
        let boxes: Vec<Aabb> = shells.iter().map(|shell| shell.aabb).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let cavities: Vec<usize> =
            (0..shells.len()).filter(|index| is_cavity(*index, &shells, &tree)).collect();
        cavities.into_iter().for_each(|index| shells[index].is_cavity = true);
        Inside { shells, tree }
    }

    /// Whether the surface encloses `point`.
    pub(crate) fn contains(&self, point: Vector) -> bool {
        let mut solids = 0i64;
        for index in around(&self.tree, point) {
            let shell = &self.shells[index];
            if shell.contains(point) {
                solids += if shell.is_cavity { -1 } else { 1 };
            }
        }
        solids > 0
    }
}

/// The leaves whose boxes hold a point.
fn around(tree: &Bvh, point: Vector) -> impl Iterator<Item = usize> {
    let holds = move |node: &parry3d_f64::partitioning::BvhNode| {
        let (low, high) = (node.mins(), node.maxs());
        low.cmple(point).all() && point.cmple(high).all()
    };
    tree.leaves(holds).map(|leaf| leaf as usize)
}

/// Whether a shell is a cavity: of the shells that enclose it the outermost is turned the other way. A shell encloses
/// another if its box is the larger one and the middles of all triangles of the other are inside.
fn is_cavity(index: usize, shells: &[Prepared], tree: &Bvh) -> bool {
    let shell = &shells[index];
    let [first, ..] = shell.triangles.as_slice() else { return false };
    let enclosing = around(tree, middle(first)).filter(|other| {
        let other = &shells[*other];
        other.aabb != shell.aabb
            && other.aabb.contains(&shell.aabb)
            && shell.triangles.iter().all(|triangle| other.contains(middle(triangle)))
    });
    let largest = enclosing.max_by(|one, other| {
        let size = |index: usize| shells[index].aabb.extents().element_product();
        size(*one).total_cmp(&size(*other)).then(other.cmp(one))
    });
    let Some(outermost) = largest.map(|index| &shells[index]) else { return false };
    let both = shell.is_oriented && outermost.is_oriented;
    both && shell.volume() * outermost.volume().signum() < 0.0
}

fn middle(corners: &[[f64; 3]; 3]) -> Vector {
    let [a, b, c] = corners.map(Vector::from_array);
    (a + b + c) / 3.0
}

impl Prepared {
    fn new(mesh: &Mesh, Shell { triangles, is_oriented }: &Shell) -> Prepared {
        let corners = |corners: &[u32; 3]| corners.map(|corner| mesh.vertices[corner as usize]);
        let triangles: Vec<_> = triangles.iter().map(corners).collect();
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|corners| Aabb::from_points(corners.iter().map(|p| Vector::from_array(*p))))
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let aabb = Aabb::from_points(triangles.iter().flatten().map(|p| Vector::from_array(*p)));
        Prepared { triangles, tree, aabb, is_oriented: *is_oriented, is_cavity: false }
    }

    /// Six times the volume that it encloses, negative if its triangles are clockwise as seen from outside.
    fn volume(&self) -> f64 {
        let Some([origin, ..]) = self.triangles.first() else { return 0.0 };
        let origin = Vector::from_array(*origin);
        let part = |corners: &[[f64; 3]; 3]| {
            let [a, b, c] = corners.map(|corner| Vector::from_array(corner) - origin);
            a.dot(b.cross(c))
        };
        self.triangles.iter().map(part).sum()
    }

    /// Whether the shell encloses `point`: whether its winding number there is not zero. The number is how often the
    /// ray from the point along +x leaves the shell less how often it enters it (or the other way round, if the
    /// triangles are turned so). Of a shell that is not oriented it is whether the ray crosses an odd number of triangles.
    ///
    /// An edge is judged by the same arithmetic for each triangle that it belongs to, so that a ray through an edge
    /// or a vertex is counted consistently. Flat triangles that close a seam count like all others: where rounding
    /// opens a gap between the two sides of a seam, they cover it.
    fn contains(&self, point: Vector) -> bool {
        let [x, y, z] = point.to_array();
        let ray_meets = |node: &parry3d_f64::partitioning::BvhNode| {
            let (min, max) = (node.mins(), node.maxs());
            max.x >= x && min.y <= y && y <= max.y && min.z <= z && z <= max.z
        };
        let crossings = self.tree.leaves(ray_meets);
        let winding: i64 =
            crossings.map(|leaf| crossing(&self.triangles[leaf as usize], [x, y, z])).sum();
        if self.is_oriented { winding != 0 } else { winding % 2 != 0 }
    }
}

/// 1 or −1 if the ray from `point` along +x crosses the triangle, by the direction in which the ray sees it turn;
/// otherwise 0.
pub(crate) fn crossing(corners: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> i64 {
    // The winding number of the triangle's outline in the y–z plane, half open in z.
    let mut covered = 0;
    let mut at_height = x;
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if (a[2] > z) != (b[2] > z) {
            let upwards = a[2] < b[2];
            let (low, high) = if upwards { (a, b) } else { (b, a) };
            at_height = low[0] + (z - low[2]) / (high[2] - low[2]) * (high[0] - low[0]);
            let side = (high[1] - low[1]) * (z - low[2]) - (y - low[1]) * (high[2] - low[2]);
            if side > 0.0 {
                covered += if upwards { 1 } else { -1 };
            }
        }
    }
    if covered == 0 {
        return 0;
    }
    let [a, b, c] = corners;
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let is_ahead = if normal == [0.0; 3] {
        // A flat triangle: all of it is on a line, which crosses the ray's height at `at_height`.
        at_height > x
    } else {
        // Where the line meets the triangle's plane: normal · (p − a) = 0, solved for x.
        let ahead = normal[1] * (y - a[1]) + normal[2] * (z - a[2]) + normal[0] * (x - a[0]);
        if normal[0] > 0.0 { ahead < 0.0 } else { ahead > 0.0 }
    };
    if is_ahead { covered } else { 0 }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::math;
    use crate::model::bodies::robot::rates_tests::drawn_pose;
    use crate::numbers::Ordinal;
    use crate::seed::{Purpose, Seed, Stream};
    use proptest::prelude::*;

    /// The points whose coordinates' sizes sum up to `size`, from a centre; counter-clockwise from outside.
    pub(in crate::model::bodies::validity) fn octahedron(centre: [f64; 3], size: f64) -> Mesh {
        let corner = |axis: usize, sign: f64| {
            let mut corner = centre;
            corner[axis] += sign * size;
            corner
        };
        let vertices = (0..6).map(|i| corner(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 }));
        let mut triangles = Vec::new();
        for (i, x) in [0, 1].into_iter().enumerate() {
            for (j, y) in [2, 3].into_iter().enumerate() {
                for (k, z) in [4, 5].into_iter().enumerate() {
                    let odd = (i + j + k) % 2 == 1;
                    triangles.push(if odd { [x, z, y] } else { [x, y, z] });
                }
            }
        }
        Mesh { vertices: vertices.collect(), triangles }
    }

    /// All triangles of some meshes as one mesh.
    pub(in crate::model::bodies::validity) fn joined(meshes: &[Mesh]) -> Mesh {
        let mut all = Mesh { vertices: Vec::new(), triangles: Vec::new() };
        for mesh in meshes {
            let before = all.vertices.len() as u32;
            all.vertices.extend(&mesh.vertices);
            all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| corner + before)));
        }
        all
    }

    fn turned_round(mut mesh: Mesh) -> Mesh {
        mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        mesh
    }

    /// A block about the origin, somewhere, with the triangles of an octahedron or of a tetrahedron, counter-clockwise
    /// from outside.
    fn drawn_shell(stream: &mut Stream) -> Mesh {
        let mut mesh = octahedron([0.0; 3], 1.0);
        if stream.unit() < 0.5 {
            mesh.vertices.truncate(4);
            mesh.triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
            mesh.vertices[1..].copy_from_slice(&[
                [-0.7, 0.9, 0.0],
                [-0.7, -0.9, 0.8],
                [-0.7, -0.9, -0.8],
            ]);
        }
        let pose = drawn_pose(stream, 0.8);
        let stretch = [0; 3].map(|_| 0.3 + stream.unit());
        for vertex in &mut mesh.vertices {
            *vertex = pose.apply([0, 1, 2].map(|axis| vertex[axis] * stretch[axis]));
        }
        mesh
    }

    /// The winding number of a mesh by the solid angles of its triangles (A. van Oosterom, J. Strackee, *The
    /// solid angle of a plane triangle*, 1983), in numbers that are integers up to rounding.
    fn winding(mesh: &Mesh, point: Vector) -> f64 {
        let corner = |index: u32| Vector::from_array(mesh.vertices[index as usize]) - point;
        let angle = |[a, b, c]: [Vector; 3]| {
            let (x, y, z) = (a.length(), b.length(), c.length());
            let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
            2.0 * math::atan2(a.dot(b.cross(c)), below)
        };
        let angles = mesh.triangles.iter().map(|corners| angle(corners.map(corner)));
        angles.sum::<f64>() / (2.0 * math::TURN)
    }

    fn drawn_point(stream: &mut Stream) -> Vector {
        Vector::from_array([0; 3].map(|_| 3.0 * stream.unit() - 1.5))
    }

    proptest! {
        /// What is inside any of some shells is inside all of them together, with whichever side their
        /// triangles are turned to; judged by winding numbers of the shells as they were drawn.
        #[test]
        fn the_inside_of_shells_that_overlap_is_that_of_any(
            ordinal in any::<u64>(), count in 1usize..6, mixed in any::<bool>(),
        ) {
            let mut stream = Seed::of_set(5, "shells", Ordinal(ordinal)).stream(Purpose::Sampling);
            let shells: Vec<Mesh> = (0..count).map(|_| drawn_shell(&mut stream)).collect();
            let mut mesh = joined(&shells);
            prop_assert!(mesh.is_closed());
            let mut inside = vec![Inside::new(&mesh)];
            let all_round = turned_round(mesh.clone());
            inside.push(Inside::new(&all_round));
            if mixed {
                // Fewer than half of the triangles of each shell, so that its direction is that of the rest.
                let mut first = 0;
                for shell in &shells {
                    let one = first + (stream.unit() * shell.triangles.len() as f64) as usize;
                    mesh.triangles[one].swap(0, 1);
                    first += shell.triangles.len();
                }
                inside.push(Inside::new(&mesh));
            }
            for _ in 0..50 {
                let point = drawn_point(&mut stream);
                let expected = shells.iter().any(|shell| winding(shell, point).abs() > 0.5);
                for inside in &inside {
                    prop_assert_eq!(inside.contains(point), expected);
                }
            }
        }

        /// Shells one in the other, of which each looks to the other side than the one around it: solids and
        /// cavities by turns. With another solid that overlaps all of them.
        #[test]
        fn a_shell_turned_the_other_way_within_another_is_a_cavity(
            ordinal in any::<u64>(), count in 1usize..5, round in any::<bool>(), fused in any::<bool>(),
        ) {
            let mut stream = Seed::of_set(5, "cavities", Ordinal(ordinal)).stream(Purpose::Sampling);
            let mut meshes: Vec<Mesh> = (0..count).map(|level| {
                let mesh = octahedron([0.0; 3], 1.4 - 0.3 * level as f64);
                if (level % 2 == 1) ^ round { turned_round(mesh) } else { mesh }
            }).collect();
            let other = octahedron([1.0, 0.1, 0.2], 0.9);
            if fused {
                meshes.push(if stream.unit() < 0.5 { turned_round(other) } else { other });
            }
            let inside = Inside::new(&joined(&meshes));
            for _ in 0..50 {
                let point = drawn_point(&mut stream);
                let norm = point.abs().element_sum();
                let around = (0..count).filter(|level| norm < 1.4 - 0.3 * *level as f64).count();
                let from_other = (point - Vector::new(1.0, 0.1, 0.2)).abs().element_sum();
                let expected = around % 2 == 1 || fused && from_other < 0.9;
                prop_assert_eq!(inside.contains(point), expected, "{:?} {}", point, around);
            }
        }
    }

    /// A shell within another that is turned alike is solid, as are shells that look inwards beside each other.
    #[test]
    fn shells_that_are_turned_alike_are_solid() {
        let outer = || octahedron([0.0; 3], 1.0);
        let inner = || octahedron([0.0; 3], 0.5);
        let centre = Vector::new(0.01, 0.02, 0.03);
        assert!(Inside::new(&joined(&[outer(), inner()])).contains(centre));
        let round = joined(&[turned_round(outer()), turned_round(inner())]);
        assert!(Inside::new(&round).contains(centre));
        let hollow = joined(&[turned_round(outer()), inner()]);
        assert!(!Inside::new(&hollow).contains(centre));
        assert!(Inside::new(&hollow).contains(Vector::new(0.7, 0.02, 0.03)));
        let beside = joined(&[outer(), turned_round(octahedron([3.0, 0.0, 0.0], 1.0))]);
        assert!(Inside::new(&beside).contains(centre + Vector::X * 3.0));
        // Two cavities that overlap are both free.
        let cavity = |x: f64| turned_round(octahedron([x, 0.0, 0.0], 0.3));
        let two = joined(&[outer(), cavity(-0.1), cavity(0.1)]);
        assert!(!Inside::new(&two).contains(centre));
    }

    /// Two octahedra that overlap, a face cut out of each and the two holes joined by a tube.
    #[test]
    fn a_single_shell_is_inside_where_it_winds_twice() {
        let mut mesh = joined(&[octahedron([0.0; 3], 1.0), octahedron([0.6, 0.0, 0.0], 1.0)]);
        let (one, other) = (mesh.triangles[0], mesh.triangles[8]);
        mesh.triangles.retain(|corners| *corners != one && *corners != other);
        for i in 0..3 {
            // Both are turned alike, so that the holes are gone round in opposite directions.
            let (a, b) = (one[i], one[(i + 1) % 3]);
            let (c, d) = (other[(3 - i) % 3], other[2 - i]);
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
        assert!(mesh.is_closed());
        assert_eq!(shells(&mesh).len(), 1);
        let inside = Inside::new(&mesh);
        // The first is in both, where neither the holes nor the tube are.
        for point in [[0.3, -0.2, -0.2], [-0.7, -0.01, -0.02], [1.3, -0.01, -0.02]] {
            let point = Vector::from_array(point);
            assert!(inside.contains(point) && winding(&mesh, point).abs() > 0.5);
        }
        assert!(winding(&mesh, Vector::new(0.3, -0.2, -0.2)).abs() > 1.5);
        assert!(!inside.contains(Vector::new(0.3, -0.6, -0.6)));
    }

    /// A box 1 by 1 by `height` whose face at x = 0 is cut along its diagonal, on one side in the middle
    /// too; a flat triangle lies between.
    fn box_with_a_seam(share: f64, height: f64) -> Mesh {
        let corner = |i: usize| [(i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64 * height];
        let mut vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
        vertices.push([0.0, share, share * height]);
        let triangles = vec![
            [0, 2, 6],
            [0, 4, 8],
            [8, 4, 6],
            [0, 8, 6],
            [1, 3, 7],
            [1, 5, 7],
            [0, 1, 5],
            [0, 4, 5],
            [2, 3, 7],
            [2, 6, 7],
            [0, 1, 3],
            [0, 2, 3],
            [4, 5, 7],
            [4, 6, 7],
        ];
        Mesh { vertices, triangles }
    }

    proptest! {
        /// Rays that run along the seam, through it and beside it.
        #[test]
        fn a_seam_that_flat_triangles_close_does_not_leak(
            share in 0.01f64..0.99, height in 0.5f64..4.0, along in -0.1f64..1.1, x in -1.0f64..2.0,
            off in prop::sample::select(vec![-1e-16, 0.0, 1e-16, 1e-3]),
        ) {
            let mesh = box_with_a_seam(share, height);
            prop_assert!(mesh.is_closed());
            prop_assume!(x.abs() > 1e-9 && (x - 1.0).abs() > 1e-9);
            prop_assume!(along.abs() > 1e-9 && (along - 1.0).abs() > 1e-9);
            let point = Vector::new(x, along + off, along * height);
            let unit = 0.0..1.0;
            let expected = unit.contains(&x) && unit.contains(&point.y) && unit.contains(&along);
            prop_assert_eq!(Inside::new(&mesh).contains(point), expected);
        }

        #[test]
        fn an_octahedron_contains_what_it_should(x in -1.2f64..1.2, y in -1.2f64..1.2, z in -1.2f64..1.2) {
            let norm = x.abs() + y.abs() + z.abs();
            prop_assume!((norm - 1.0).abs() > 1e-9);
            let inside = Inside::new(&octahedron([0.0; 3], 1.0));
            prop_assert_eq!(inside.contains(Vector::new(x, y, z)), norm < 1.0);
        }

        #[test]
        fn rays_through_edges_and_corners_do_not_leak(x in -1.2f64..1.2, y in 0usize..3, z in 0usize..3) {
            let levels = [-0.5, 0.0, 0.5];
            let (y, z) = (levels[y], levels[z]);
            let norm = x.abs() + f64::abs(y) + f64::abs(z);
            prop_assume!((norm - 1.0).abs() > 1e-9);
            prop_assert_eq!(Inside::new(&octahedron([0.0; 3], 1.0)).contains(Vector::new(x, y, z)), norm < 1.0);
        }
    }
}
