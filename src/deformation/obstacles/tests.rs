use super::*;
use crate::deformation::SoftBody;
use crate::numbers::Ordinal;
use crate::scene::{Mesh, Pose, Surface, tessellate};
use crate::seed::{Purpose, Seed, Stream};
use parry3d_f64::query;
use parry3d_f64::shape::Triangle;
use proptest::prelude::*;

fn stream(ordinal: u64) -> Stream {
    Seed::of_set(22, "obstacles", Ordinal(ordinal)).stream(Purpose::Sampling)
}

fn drawn_point(stream: &mut Stream, size: f64) -> [f64; 3] {
    [0; 3].map(|_| size * (2.0 * stream.unit() - 1.0))
}

fn drawn_pose(stream: &mut Stream, size: f64) -> Pose {
    let q = [0; 4].map(|_| stream.normal());
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    Pose { translation: drawn_point(stream, size), rotation: q.map(|x| x / length) }
}

/// Convex shapes of all kinds.
fn drawn_shape(stream: &mut Stream) -> Shape {
    let length = |stream: &mut Stream| 0.2 + stream.unit();
    match stream.below(4) {
        0 => Shape::Box { size: [0; 3].map(|_| length(stream)) },
        1 => Shape::Sphere { radius: length(stream) },
        2 => Shape::Cylinder { radius: length(stream), height: length(stream) },
        _ => Shape::Capsule { radius: length(stream) / 2.0, height: length(stream) },
    }
}

fn drawn_body(stream: &mut Stream, size: f64) -> Body {
    Body { shape: drawn_shape(stream), pose: drawn_pose(stream, size), solid: true }
}

/// The same body as a closed mesh, of a box, whose mesh is exact.
fn as_mesh(body: &Body) -> Body {
    let Surface { vertices, triangles } = tessellate(&body.shape, 0.0);
    Body { shape: Shape::Mesh(Mesh { vertices, triangles }), ..body.clone() }
}

fn ball(radius: f64, centre: [f64; 3]) -> Mesh {
    let Surface { vertices, triangles } = tessellate(&Shape::Sphere { radius }, 0.0);
    let moved = |p: [f64; 3]| [0, 1, 2].map(|axis| p[axis] + centre[axis]);
    Mesh { vertices: vertices.into_iter().map(moved).collect(), triangles }
}

/// The shape for parry and its pose in the world.
fn for_parry(body: &Body) -> (parry3d_f64::shape::SharedShape, ParryPose) {
    let (shape, at) = body.shape.to_parry().unwrap();
    (shape, body.pose.to_parry() * at)
}

/// The distance of a triangle from a convex body, by parry.
fn distance(body: &Body, triangle: &[[f64; 3]; 3]) -> f64 {
    let [a, b, c] = triangle.map(Vector::from_array);
    let (shape, pose) = for_parry(body);
    query::distance(&pose, shape.0.as_ref(), &ParryPose::IDENTITY, &Triangle::new(a, b, c))
        .unwrap()
        .distance
}

proptest! {
    /// Among several bodies, against parry's distances of all. A triangle that is wholly within a box is near no side of it.
    #[test]
    fn near_is_what_parry_says_is_near(ordinal in any::<u64>(), clearance in 0.0f64..0.3) {
        let mut stream = stream(ordinal);
        let bodies: Vec<Body> = (0..5).map(|_| drawn_body(&mut stream, 2.0)).collect();
        let obstacles = Obstacles::new(&bodies);
        for _ in 0..20 {
            let at = drawn_point(&mut stream, 2.5);
            let triangle = [0; 3].map(|_| {
                let by = drawn_point(&mut stream, 0.5);
                [0, 1, 2].map(|axis| at[axis] + by[axis])
            });
            let within = triangle.iter().any(|corner| obstacles.contains(*corner));
            let least = bodies.iter().map(|body| distance(body, &triangle)).fold(3.0, f64::min);
            prop_assume!((least - clearance).abs() > 1e-6);
            let near = obstacles.is_near(triangle, clearance);
            if !within {
                prop_assert_eq!(near, least < clearance || least == 0.0);
            }
            let mut facets = Vec::new();
            obstacles.near_triangles(triangle, clearance, &mut |facet| facets.push(facet));
            prop_assert_eq!(facets.is_empty(), !near);
            if !within && least > 1e-3 {
                // The facets are as near as the surfaces, or nearly so where a facet of a round shape ends.
                let of_facet = |facet: &[[f64; 3]; 3]| {
                    let [a, b, c] = facet.map(Vector::from_array);
                    let (facet, at) = (Triangle::new(a, b, c), ParryPose::IDENTITY);
                    let [a, b, c] = triangle.map(Vector::from_array);
                    query::distance(&at, &facet, &at, &Triangle::new(a, b, c)).unwrap().distance
                };
                let nearest = facets.iter().map(of_facet).fold(f64::INFINITY, f64::min);
                prop_assert!(!near || (nearest - least).abs() < 1e-4, "{} {}", nearest, least);
            }
        }
    }

    /// Segments against points along them that parry finds inside, for primitives and for boxes as meshes.
    #[test]
    fn hits_are_where_segments_enter_and_leave(ordinal in any::<u64>()) {
        let mut stream = stream(ordinal);
        let body = drawn_body(&mut stream, 0.5);
        let (shape, pose) = for_parry(&body);
        let mut made = vec![Obstacles::new(std::slice::from_ref(&body))];
        if matches!(body.shape, Shape::Box { .. }) {
            made.push(Obstacles::new(&[as_mesh(&body)]));
        }
        for _ in 0..30 {
            let (from, to) = (drawn_point(&mut stream, 1.5), drawn_point(&mut stream, 1.5));
            let at = |i: u32| [0, 1, 2].map(|axis| from[axis] + f64::from(i) / 500.0 * (to[axis] - from[axis]));
            let inside: Vec<bool> =
                (0..=500).map(|i| shape.contains_point(&pose, Vector::from_array(at(i)))).collect();
            let changes: Vec<f64> = (0..500)
                .filter(|i| inside[*i] != inside[*i + 1])
                .map(|i| (i as f64 + 0.5) / 500.0)
                .collect();
            for obstacles in &made {
                prop_assert_eq!(obstacles.contains(from), inside[0]);
                let hits = obstacles.first_hit(from, to).zip(obstacles.last_hit(from, to));
                match (hits, changes.as_slice()) {
                    // In and out again between two of the points.
                    (Some((first, last)), []) => prop_assert!(last - first < 1.0 / 500.0),
                    (None, []) => {}
                    (Some((first, last)), [enters, ..]) => {
                        let leaves = changes[changes.len() - 1];
                        prop_assert!((first - enters).abs() < 0.6 / 500.0, "{first} {enters}");
                        prop_assert!((last - leaves).abs() < 0.6 / 500.0, "{last} {leaves}");
                    }
                    (None, _) => prop_assert!(false, "{changes:?}"),
                }
            }
        }
    }

    /// A ball of triangles among bodies, against parry's meshes and shapes.
    #[test]
    fn a_shape_is_free_where_parry_finds_it_apart(ordinal in any::<u64>(), clearance in 0.0f64..0.2) {
        let mut stream = stream(ordinal);
        let mesh = ball(0.2 + stream.unit(), drawn_point(&mut stream, 1.0));
        let corners = |t: &[u32; 3]| t.map(|corner| mesh.vertices[corner as usize]);
        for _ in 0..5 {
            let body = drawn_body(&mut stream, 2.0);
            let obstacles = Obstacles::new(std::slice::from_ref(&body));
            let least = mesh.triangles.iter().map(|t| distance(&body, &corners(t))).fold(9.0, f64::min);
            prop_assume!((least - clearance).abs() > 1e-6);
            let within = |p: Vector| {
                let first = Vector::from_array(mesh.vertices[0]);
                let centre = mesh.vertices.iter().map(|v| Vector::from_array(*v)).sum::<Vector>()
                    / mesh.vertices.len() as f64;
                (p - centre).length() < (first - centre).length()
            };
            let inside = within(Vector::from_array(body.pose.translation))
                || obstacles.contains(mesh.vertices[0]);
            let expected = least > clearance && !inside;
            prop_assert_eq!(obstacles.is_free(&mesh.vertices, &mesh.triangles, clearance), expected);
            let robot = SoftBody::new(mesh.clone()).unwrap();
            prop_assert_eq!(robot.witnesses().len(), 1);
            prop_assert_eq!(obstacles.is_free_body(&robot, &mesh.vertices, clearance), expected);
        }
    }

    /// Rays from the middle of a ball of triangles through points of its edges and through its corners.
    #[test]
    fn no_segment_slips_between_triangles(ordinal in any::<u64>()) {
        let mut stream = stream(ordinal);
        let mesh = ball(1.0, drawn_point(&mut stream, 1.0));
        let pose = drawn_pose(&mut stream, 3.0);
        let centre = pose.apply([0, 1, 2].map(|a| (mesh.vertices[0][a] + mesh.vertices.last().unwrap()[a]) / 2.0));
        let obstacles = Obstacles::new(&[Body { shape: Shape::Mesh(mesh.clone()), pose, solid: true }]);
        for _ in 0..100 {
            let t = mesh.triangles[stream.below(mesh.triangles.len() as u64) as usize];
            let [a, b, _] = t.map(|corner| pose.apply(mesh.vertices[corner as usize]));
            let share = if stream.unit() < 0.3 { 0.0 } else { stream.unit() };
            let through = [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
            let beyond = [0, 1, 2].map(|i| centre[i] + 1.5 * (through[i] - centre[i]));
            let hit = obstacles.first_hit(centre, beyond);
            prop_assert!(hit.is_some_and(|share| (share - 1.0 / 1.5).abs() < 1e-9));
        }
    }
}

#[test]
fn what_touches_is_near_and_what_encloses_is_not_free() {
    let at = |x: f64| Pose { translation: [x, 0.0, 0.0], ..Pose::IDENTITY };
    let small = |x: f64| Body { shape: Shape::Sphere { radius: 0.1 }, pose: at(x), solid: true };
    let block = Body { shape: Shape::Box { size: [2.0; 3] }, pose: Pose::IDENTITY, solid: true };
    let shape = ball(0.5, [0.0; 3]);
    let free =
        |bodies: &[Body]| Obstacles::new(bodies).is_free(&shape.vertices, &shape.triangles, 0.0);
    assert!(!free(&[small(0.0)]), "an obstacle within the shape");
    assert!(!free(std::slice::from_ref(&block)), "the shape within an obstacle");
    assert!(!free(&[as_mesh(&block)]));
    assert!(free(&[Body { solid: false, ..as_mesh(&block) }]), "within a mere surface");
    assert!(free(&[small(0.7)]));
    assert!(free(&[]));
    let wall = Obstacles::new(&[block]);
    let beside = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 1.0, 0.0], [x + 1.0, 0.0, 1.0]];
    assert!(wall.is_near(beside(1.0), 0.0) && wall.is_near(beside(1.0 + 1e-13), 0.0));
    assert!(!wall.is_near(beside(1.0 + 1e-9), 0.0) && wall.is_near(beside(1.0 + 1e-9), 1e-8));
}

/// Shells of a mesh that are turned opposite ways, so that windings cancel out where both are.
#[test]
fn an_obstacle_within_two_pieces_of_a_shape_is_found() {
    let (mut mesh, other) = (ball(1.0, [0.0; 3]), ball(1.0, [0.5, 0.0, 0.0]));
    let before = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices);
    mesh.triangles
        .extend(other.triangles.iter().map(|[a, b, c]| [a + before, c + before, b + before]));
    let pose = Pose { translation: [0.25, 0.01, 0.02], ..Pose::IDENTITY };
    let seed = Body { shape: Shape::Sphere { radius: 0.1 }, pose, solid: true };
    assert!(!Obstacles::new(&[seed]).is_free(&mesh.vertices, &mesh.triangles, 0.0));
}
