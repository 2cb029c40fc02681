use super::free_form::FreeForm;
use super::*;
use crate::model::deformable::{ChainMailOrder, LatticeInterpolation};
use crate::numbers::Ordinal;
use crate::scene::{Body, Mesh, Shape, box_surface};
use crate::seed::{Purpose, Seed};
use proptest::prelude::*;

fn settings() -> BoundingBoxSettings {
    BoundingBoxSettings {
        lattice: [7, 6, 5],
        least: [0.3; 3],
        greatest: [2.0; 3],
        shear: 0.8,
        order: ChainMailOrder::Queue,
        relaxation: 3,
        interpolation: LatticeInterpolation::Trilinear,
    }
}

/// The triangles of a mesh divided into four each, some times, with the corners moved by `place`.
fn divided(mut mesh: Mesh, times: u32, place: impl Fn([f64; 3]) -> [f64; 3]) -> SoftBody {
    for _ in 0..times {
        let mut middles = std::collections::BTreeMap::new();
        let Mesh { vertices, triangles } = &mut mesh;
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (one, other) = (vertices[a as usize], vertices[b as usize]);
                vertices.push([0, 1, 2].map(|k| (one[k] + other[k]) / 2.0));
                vertices.len() as u32 - 1
            })
        };
        let mut parts = Vec::new();
        for [a, b, c] in triangles.iter().copied() {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            parts.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        *triangles = parts;
    }
    mesh.vertices.iter_mut().for_each(|vertex| *vertex = place(*vertex));
    SoftBody::new(mesh).unwrap()
}

fn brick(size: [f64; 3]) -> SoftBody {
    let (corners, triangles) = box_surface(size);
    divided(Mesh { vertices: corners.to_vec(), triangles }, 3, |p| p)
}

fn ball(radius: f64) -> SoftBody {
    let (corners, triangles) = box_surface([1.0; 3]);
    divided(Mesh { vertices: corners.to_vec(), triangles }, 3, |p| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length * radius)
    })
}

fn at(translation: [f64; 3]) -> Pose {
    Pose { translation, ..Pose::IDENTITY }
}

fn obstacle(shape: Shape, translation: [f64; 3]) -> Body {
    Body { shape, pose: at(translation), solid: true }
}

/// A plate across x with a square hole of width 1.6.
fn plate() -> Vec<Body> {
    let part = |size, translation| obstacle(Shape::Box { size }, translation);
    [-1.0, 1.0]
        .into_iter()
        .flat_map(|side| {
            let beside = part([0.2, 2.0, 4.0], [0.0, 1.8 * side, 0.0]);
            [beside, part([0.2, 1.6, 1.2], [0.0, 0.0, 1.4 * side])]
        })
        .collect()
}

fn four_spheres() -> Vec<Body> {
    let sphere = |radius, translation| obstacle(Shape::Sphere { radius }, translation);
    vec![
        sphere(1.0, [0.0, 1.7, 0.0]),
        sphere(0.9, [0.0, -1.6, 0.2]),
        sphere(1.1, [0.1, 0.0, 1.8]),
        sphere(0.8, [-0.1, 0.1, -1.5]),
    ]
}

fn deformer(body: &SoftBody, settings: &BoundingBoxSettings, bodies: &[Body]) -> BoundingBox {
    let obstacles = Arc::new(Obstacles::new(bodies));
    BoundingBox::new(body, settings, f64::INFINITY, 0.01, obstacles).unwrap()
}

/// Along a way through each scene: shapes are free at half the clearance as a surface in the world, rest where that is free, and are
/// deformed somewhere, with either rule and either order.
#[test]
fn balls_and_bricks_give_way_to_a_ball_a_plate_and_spheres() {
    let small = vec![obstacle(Shape::Sphere { radius: 0.5 }, [0.0, 0.0, 1.15])];
    for bodies in [small, plate(), four_spheres()] {
        let judge = Obstacles::new(&bodies);
        for body in [ball(0.9), brick([1.4, 1.2, 1.7])] {
            for rays in [Rays::FromBox, Rays::FromRobot] {
                let queue = deformer(&body, &settings(), &bodies).with_rays(rays);
                let order = ChainMailOrder::MostReached;
                let revised = BoundingBoxSettings { order, ..settings() };
                let revised = deformer(&body, &revised, &bodies).with_rays(rays);
                let mut deformed = 0;
                for i in 0..9 {
                    let pose = at([-1.6 + 0.4 * f64::from(i), 0.03, 0.02]);
                    let found = queue.deform(&pose);
                    assert_eq!(found, revised.deform(&pose));
                    let place = |vertices: &[[f64; 3]]| -> Vec<[f64; 3]> {
                        vertices.iter().map(|vertex| pose.apply(*vertex)).collect()
                    };
                    let free = |vertices: &[[f64; 3]], clearance| {
                        judge.is_free(&place(vertices), body.triangles(), clearance)
                    };
                    let Ok(Deformed { vertices, energy }) = found else { continue };
                    assert!(free(&vertices, 0.009));
                    assert_eq!(energy == 0.0, free(body.vertices(), 0.01));
                    deformed += u32::from(energy > 0.0);
                }
                assert!(deformed > 0, "{rays:?}");
            }
        }
    }
}

#[test]
fn what_cannot_give_way_is_refused() {
    let stone = vec![obstacle(Shape::Sphere { radius: 0.5 }, [0.0, 0.0, 1.2])];
    let rigid =
        BoundingBoxSettings { least: [1.0; 3], greatest: [1.0; 3], shear: 0.0, ..settings() };
    let refused = deformer(&ball(0.9), &rigid, &stone).deform(&Pose::IDENTITY);
    assert_eq!(refused, Err(Refusal::Limits));
    assert!(deformer(&ball(0.9), &settings(), &stone).deform(&Pose::IDENTITY).is_ok());
    // A rod longer than the room between two walls.
    let wall = |x: f64| obstacle(Shape::Box { size: [0.2, 9.0, 9.0] }, [x, 0.0, 0.0]);
    let rod = brick([4.0, 0.3, 0.3]);
    let refused = deformer(&rod, &settings(), &[wall(-0.5), wall(0.5)]).deform(&Pose::IDENTITY);
    assert_eq!(refused, Err(Refusal::Limits));
    let room = deformer(&rod, &settings(), &[wall(-1.8), wall(1.8)]);
    let energy = room.deform(&Pose::IDENTITY).unwrap().energy;
    let obstacles = Arc::new(Obstacles::new(&[wall(-1.8), wall(1.8)]));
    let weak = BoundingBox::new(&rod, &settings(), energy / 2.0, 0.01, obstacles).unwrap();
    assert_eq!(weak.deform(&Pose::IDENTITY), Err(Refusal::Energy(energy)));
    let buried = obstacle(Shape::Box { size: [9.0; 3] }, [0.0; 3]);
    let refused = deformer(&rod, &settings(), &[buried]).deform(&Pose::IDENTITY);
    assert_eq!(refused, Err(Refusal::NoGuide));
}

/// The centre of the box is in a thin wall: the guide is beside it.
#[test]
fn a_robot_whose_centre_is_in_an_obstacle_is_pushed_to_its_side() {
    let wall = obstacle(Shape::Box { size: [0.2, 9.0, 9.0] }, [0.75, 0.0, 0.0]);
    let beside = deformer(&ball(0.9), &settings(), &[wall]);
    for (x, expected) in [(0.0, true), (0.75, false)] {
        let found = beside.deform(&at([x, 0.0, 0.0]));
        assert_eq!(found.is_ok(), expected, "{found:?}");
    }
}

#[test]
fn settings_without_sense_are_refused() {
    let says = |change: &dyn Fn(&mut BoundingBoxSettings), what: &str| {
        let mut settings = settings();
        change(&mut settings);
        let obstacles = Arc::new(Obstacles::new(&[]));
        let made = BoundingBox::new(&ball(1.0), &settings, 1.0, 0.0, obstacles);
        assert!(made.err().is_some_and(|error| error.contains(what)), "{what}");
    };
    says(&|s| s.lattice = [1, 9, 7], "lattice: 1 found; 2 to 200");
    says(&|s| s.lattice = [33, 32, 32], "33 × 32 × 32 = 33792 found; at most 32768 points");
    says(&|s| s.lattice = [u32::MAX; 3], "lattice: 4294967295 found");
    says(&|s| s.least = [0.5, 0.0, 0.5], "least: 0 found");
    says(&|s| s.least = [0.5, 1.5, 0.5], "least: 1.5 found");
    says(&|s| s.greatest = [0.9, 1.5, 2.0], "greatest: 0.9 found");
    says(&|s| s.shear = f64::NAN, "shear: NaN found");
}

proptest! {
    /// Lattice points moved by an affine map move points within by the map.
    #[test]
    fn free_form_deformation_reproduces_affine_maps(
        ordinal in any::<u64>(), bernstein in any::<bool>(),
    ) {
        let mut stream = Seed::of_set(22, "affine", Ordinal(ordinal)).stream(Purpose::Sampling);
        let rows = [0; 3].map(|_| [0; 4].map(|_| 2.0 * stream.unit() - 1.0));
        let moved = |p: [f64; 3]| rows.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d);
        let body = ball(1.0);
        let counts = [0; 3].map(|_| 2 + stream.below(8) as u32);
        let lattice = Lattice::around(body.mesh(), counts);
        let how = if bernstein { LatticeInterpolation::Bernstein } else { LatticeInterpolation::Trilinear };
        let free_form = FreeForm::new(&lattice, how, body.vertices());
        let by: Vec<[f64; 3]> = lattice.points.iter().map(|p| {
            let to = moved(*p);
            [0, 1, 2].map(|k| to[k] - p[k])
        }).collect();
        for (index, vertex) in body.vertices().iter().enumerate() {
            let found = free_form.displacement(&lattice, &by, index);
            let expected = moved(*vertex);
            for k in 0..3 {
                prop_assert!((vertex[k] + found[k] - expected[k]).abs() < 1e-13);
            }
        }
    }
}
