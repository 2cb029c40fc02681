use super::shapes::{ball, block, elbow};
use crate::deformation::geometric::directions::{across, uniform};
use crate::deformation::geometric::guide::{centroid, guides};
use crate::deformation::geometric::regions::{envelope, filled, regions};
use crate::deformation::geometric::self_collision::meet;
use crate::deformation::geometric::smoothing::Limits;
use crate::deformation::geometric::surface::Surface;
use crate::deformation::{Obstacles, SoftBody};
use crate::scene::{Body, Mesh, Pose, Shape};
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::intersection_test;
use parry3d_f64::shape::Triangle;
use proptest::prelude::*;

fn body(mesh: Mesh) -> (SoftBody, Surface) {
    let body = SoftBody::new(mesh).unwrap();
    let surface = Surface::new(&body);
    (body, surface)
}

fn at_rest(body: &SoftBody) -> Vec<Vector> {
    body.vertices().iter().copied().map(Vector::from_array).collect()
}

/// Distances along edges between all vertices (Floyd and Warshall).
fn all_distances(surface: &Surface, count: usize) -> Vec<Vec<f64>> {
    let mut far = vec![vec![f64::INFINITY; count]; count];
    for (vertex, row) in far.iter_mut().enumerate() {
        row[vertex] = 0.0;
    }
    for edge in &surface.edges {
        let [a, b] = edge.ends.map(|end| end as usize);
        (far[a][b], far[b][a]) = (edge.length, edge.length);
    }
    for over in 0..count {
        for a in 0..count {
            for b in 0..count {
                far[a][b] = far[a][b].min(far[a][over] + far[over][b]);
            }
        }
    }
    far
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn regions_are_what_is_near_along_the_surface(
        mut colliding in proptest::collection::vec(0u32..80, 1..12),
        neighbourhood in 0.0..2.0f64,
    ) {
        let (body, surface) = body(ball(1.0, 1));
        colliding.sort_unstable();
        colliding.dedup();
        let far = all_distances(&surface, body.vertices().len());
        let apart = |a: u32, b: u32| {
            let [a, b] = [a, b].map(|index| surface.triangles[index as usize]);
            let pairs = a.into_iter().flat_map(|a| b.into_iter().map(move |b| (a as usize, b as usize)));
            pairs.fold(f64::INFINITY, |least, (a, b)| least.min(far[a][b]))
        };
        let found = regions(&surface, &colliding, neighbourhood);
        let number = |index: u32| found.iter().position(|region| region.colliding.contains(&index)).unwrap();
        // The finest parting of which no two parts have triangles that are near: by joining them until nothing changes.
        let mut label: Vec<usize> = (0..colliding.len()).collect();
        for _ in 0..colliding.len() {
            for a in 0..colliding.len() {
                for b in 0..colliding.len() {
                    // Rounding may decide at the border.
                    let distance = apart(colliding[a], colliding[b]);
                    prop_assume!((distance - neighbourhood).abs() > 1e-9 || distance == 0.0);
                    if distance <= neighbourhood {
                        (label[a], label[b]) = (label[a].min(label[b]), label[a].min(label[b]));
                    }
                }
            }
        }
        for a in 0..colliding.len() {
            for b in 0..colliding.len() {
                prop_assert_eq!(label[a] == label[b], number(colliding[a]) == number(colliding[b]));
            }
        }
        for region in &found {
            let corners = surface.corners_of(&region.colliding);
            for (vertex, weight) in &region.vertices {
                let distance = corners.iter().fold(f64::INFINITY, |least, corner| {
                    least.min(far[*corner as usize][*vertex as usize])
                });
                let expected = if distance == 0.0 { 1.0 } else { 1.0 - distance * region.slope };
                prop_assert!((weight - expected).abs() < 1e-9, "{} {}", weight, expected);
            }
            for other in found.iter().filter(|other| other.colliding != region.colliding) {
                let others = surface.corners_of(&other.colliding);
                prop_assert!(region.vertices.iter().all(|(vertex, _)| !others.contains(vertex)));
            }
        }
    }

    #[test]
    fn an_envelope_is_the_least_that_falls_slowly(
        values in proptest::collection::vec(0.0..1.0f64, 42),
        neighbourhood in 0.3..2.0f64,
    ) {
        let (body, surface) = body(ball(1.0, 1));
        let far = all_distances(&surface, body.vertices().len());
        let region = crate::deformation::geometric::regions::whole(&surface, neighbourhood);
        let mut raised = values.clone();
        envelope(&surface, &region, &mut raised);
        for (at, value) in raised.iter().enumerate() {
            let expected = (0..42).fold(0.0f64, |most, from| most.max(values[from] - far[from][at] / neighbourhood));
            prop_assert!((value - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn triangles_meet_as_another_judge_says(points in proptest::collection::vec([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], 6)) {
        let corners = |first: usize| [points[first], points[first + 1], points[first + 2]];
        let triangle = |[a, b, c]: [[f64; 3]; 3]| {
            Triangle::new(Vector::from_array(a), Vector::from_array(b), Vector::from_array(c))
        };
        let (one, other) = (corners(0), corners(3));
        let at = ParryPose::IDENTITY;
        let expected = intersection_test(&at, &triangle(one), &at, &triangle(other)).unwrap().intersecting;
        prop_assert_eq!(meet(&one, &other), expected);
        prop_assert_eq!(meet(&other, &one), expected);
    }
}

#[test]
fn triangles_meet_where_they_touch() {
    let base = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    for (other, expected) in [
        // in the same plane: within, across, corner at a side, apart, apart in a line with a side
        ([[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, 1.5, 0.0]], true),
        ([[-1.0, 1.0, 0.0], [9.0, 1.0, 0.0], [-1.0, 1.5, 0.0]], true),
        ([[2.0, 2.0, 0.0], [5.0, 2.0, 0.0], [5.0, 5.0, 0.0]], true),
        ([[2.5, 2.0, 0.0], [5.0, 2.0, 0.0], [5.0, 5.0, 0.0]], false),
        ([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]], false),
        // a corner in it, a side in it, through it, above it by the least that there is
        ([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]], true),
        ([[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, 2.0, 1.0]], true),
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]], true),
        ([[1.0, 1.0, f64::MIN_POSITIVE], [1.0, 1.0, 1.0], [1.0, 2.0, 1.0]], false),
        // beside it
        ([[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [3.0, 4.0, 1.0]], false),
        // a line
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]], false),
    ] {
        assert_eq!(meet(&base, &other), expected, "{other:?}");
        assert_eq!(meet(&other, &base), expected, "{other:?}");
    }
}

#[test]
fn what_triangles_cut_off_is_moved_with_them() {
    let (_, surface) = body(elbow(2.0, 0.2, 0.0, 10, 8));
    // All triangles between two rings near the end.
    let mesh = elbow(2.0, 0.2, 0.0, 10, 8);
    let middle = |corners: &[u32; 3]| {
        corners.iter().map(|corner| mesh.vertices[*corner as usize][0]).sum::<f64>() / 3.0
    };
    let indices = |from: f64| -> Vec<u32> {
        let chosen = (0u32..).zip(&surface.triangles).filter(|(_, corners)| middle(corners) > from);
        chosen.map(|(index, _)| index).collect()
    };
    let ring: Vec<u32> = indices(3.21)
        .into_iter()
        .filter(|index| middle(&surface.triangles[*index as usize]) < 3.39)
        .collect();
    let region = &regions(&surface, &ring, 0.3)[0];
    let filled = filled(&surface, region).unwrap();
    assert_eq!(filled.colliding, indices(3.21));
    let patch = &regions(&surface, &ring[..4], 0.3)[0];
    assert!(crate::deformation::geometric::regions::filled(&surface, patch).is_none());
}

#[test]
fn uniform_directions_cover_the_sphere() {
    let directions = uniform(200);
    let everywhere = ball(1.0, 3);
    for vertex in &everywhere.vertices {
        let vertex = Vector::from_array(*vertex);
        let nearest =
            directions.iter().fold(-1.0f64, |most, direction| most.max(direction.dot(vertex)));
        // 200 caps of 10° would just cover the sphere without overlap; these need not be twice as large.
        assert!(nearest > 0.97, "{nearest}");
    }
    let [u, v] = across(directions[7]);
    for (a, b) in [(u, v), (u, directions[7]), (v, directions[7])] {
        assert!(a.dot(b).abs() < 1e-12 && (a.length() - 1.0).abs() < 1e-12);
    }
    assert!(uniform(0).is_empty() && uniform(1)[0].is_finite());
}

#[test]
fn smoothing_brings_edges_within_their_limits() {
    let (body, surface) = body(ball(1.0, 2));
    let limits = Limits { shortest: 0.8, longest: 1.25 };
    let mut shape = at_rest(&body);
    assert!(limits.are_kept(&surface, &shape));
    shape[5] *= 1.2;
    let mut pushed = vec![0.0; shape.len()];
    pushed[5] = 1.0;
    assert!(!limits.are_kept(&surface, &shape));
    let before = shape.clone();
    limits.restore(&surface, &mut shape, &pushed);
    assert!(limits.are_kept(&surface, &shape));
    // What was pushed moves less than its neighbours do together, and what is far away stays.
    assert!((shape[5] - before[5]).length() < 0.1);
    assert!(shape.iter().zip(&before).any(|(now, before)| now == before));
}

#[test]
fn guides_are_smaller_and_the_thinner_one_is_within_the_robot() {
    let (sphere, surface) = body(ball(2.0, 3));
    for guide in guides(&sphere, &surface, 0.5, 7.0) {
        assert!(guide.iter().all(|vertex| (vertex.length() - 1.0).abs() < 0.05));
    }
    let (bent, surface) = body(elbow(2.0, 0.3, 1.5, 20, 12));
    let [thinner, scaled] = guides(&bent, &surface, 0.5, 5.0);
    let shape = Shape::Mesh(bent.mesh().clone());
    let itself = Obstacles::new(&[Body { shape, pose: Pose::IDENTITY, solid: true }]);
    let within =
        |guide: &[Vector]| guide.iter().filter(|vertex| itself.contains(vertex.to_array())).count();
    assert_eq!(within(&thinner), thinner.len());
    assert!(within(&scaled) < scaled.len());
    assert!((centroid(&sphere)).length() < 1e-12);
    let (block, _) = body(match block([1.0, 1.0, 1.0], [0.0; 3]).shape {
        Shape::Box { size } => {
            let (corners, triangles) = crate::scene::box_surface(size);
            Mesh { vertices: corners.map(|[x, y, z]| [x + 3.0, y, z]).to_vec(), triangles }
        }
        _ => unreachable!(),
    });
    assert!((centroid(&block) - Vector::new(3.0, 0.0, 0.0)).length() < 1e-12);
}
