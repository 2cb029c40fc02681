//! Paths deformed by methods so simple that what must come out is known.

use super::bounds::sides;
use super::edge::{Unfinished, deform_motion};
use super::path::movement;
use super::robot::{Shapes, placed};
use super::search::Search;
use super::*;
use crate::cancel::Cancel;
use crate::math;
use crate::model::bodies::validity::{Bounds, BoundsMeaning};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, Graph};
use crate::scene::{Body, Mesh, Pose, Shape, box_surface};
use crate::space::{BaseJoint, Configs, Space, rigid_factors};
use std::cell::RefCell;

fn space(motion: BaseJoint) -> Space {
    let (factors, dofs) = rigid_factors(motion, [-10.0; 3], [10.0; 3], 1.0);
    Space::new(factors, dofs, motion.translations())
}

/// The pose of a robot of three or seven values.
fn pose(q: &[f64]) -> Pose {
    let rotation = match q.get(3..7) {
        Some(four) => [four[0], four[1], four[2], four[3]],
        None => Pose::IDENTITY.rotation,
    };
    Pose { translation: [q[0], q[1], q[2]], rotation }
}

/// A box of edge lengths `size` about the origin.
fn body(size: [f64; 3]) -> SoftBody {
    let (vertices, triangles) = box_surface(size);
    SoftBody::new(Mesh { vertices: vertices.to_vec(), triangles }).unwrap()
}

fn obstacle(size: [f64; 3], at: [f64; 3]) -> Body {
    let pose = Pose { translation: at, ..Pose::IDENTITY };
    Body { shape: Shape::Box { size }, pose, solid: true }
}

fn configs(all: &[&[f64]]) -> Configs {
    let mut configs = Configs::new(all[0].len());
    all.iter().for_each(|q| configs.push(q));
    configs
}

/// A method that moves every vertex in the world's frame; `None` refuses.
struct Moving<F> {
    body: SoftBody,
    moves: F,
    /// Where the method was asked.
    asked: RefCell<Vec<[f64; 3]>>,
}

impl<F: Fn(&Pose, [f64; 3]) -> Option<[f64; 3]>> Moving<F> {
    fn new(body: &SoftBody, moves: F) -> Moving<F> {
        Moving { body: body.clone(), moves, asked: RefCell::default() }
    }
}

impl<F: Fn(&Pose, [f64; 3]) -> Option<[f64; 3]>> Deform for Moving<F> {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        self.asked.borrow_mut().push(pose.translation);
        let back = pose.to_parry().inverse();
        let mut energy = 0.0;
        let mut moved = |vertex: &[f64; 3]| {
            let from = pose.apply(*vertex);
            let to = (self.moves)(pose, from).ok_or(Refusal::Collides)?;
            energy += movement(&[from], &[to]);
            Ok(if to == from { *vertex } else { back.transform_point(to.into()).to_array() })
        };
        let vertices: Result<Vec<_>, Refusal> =
            self.body.vertices().iter().map(&mut moved).collect();
        Ok(Deformed { vertices: vertices?, energy })
    }
}

/// A robot among obstacles.
fn robot<'a>(
    (space, body): (&'a Space, &'a SoftBody),
    method: &'a dyn Deform,
    obstacles: &'a Obstacles,
    [clearance, step]: [f64; 2],
) -> DeformableRobot<'a> {
    DeformableRobot {
        space,
        pose: &pose,
        body,
        method,
        obstacles,
        highest_energy: f64::INFINITY,
        clearance,
        step,
    }
}

/// A vertex at a wall whose surface is x = 1 stays this far from it.
fn before_wall(clearance: f64) -> impl Fn(&Pose, [f64; 3]) -> Option<[f64; 3]> {
    move |pose, [x, y, z]| {
        let nearest = 1.0 - clearance;
        (pose.translation[0] < nearest).then(|| [x.min(nearest), y, z])
    }
}

#[test]
fn a_robot_that_flattens_against_a_wall_stays_free_between_the_frames_by_what_is_promised() {
    let (space, body) = (space(BaseJoint::Rigid3d), body([1.0; 3]));
    let wall = Obstacles::new(&[obstacle([2.0, 20.0, 20.0], [2.0, 0.0, 0.0])]);
    let clearance = 0.04;
    let method = Moving::new(&body, before_wall(clearance));
    let half = math::sin(0.5);
    let path = configs(&[
        &[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        &[0.7, 0.3, 0.0, math::cos(0.5), 0.0, half, 0.0],
        &[0.9, 1.0, 0.2, math::cos(0.5), half, 0.0, 0.0],
    ]);
    let asked = robot((&space, &body), &method, &wall, [clearance, 0.5]);
    let answer = deform_path(&path, asked, &Cancel::new());
    let found = answer.path.unwrap();
    let Between::Proved { clearance: kept } = found.between else { panic!("{:?}", found.between) };
    assert_eq!(kept, clearance - found.largest_movement() / 2.0);
    assert!((clearance / 20.0..clearance).contains(&kept), "{kept}");
    // Judged without the library: at 20 times finer steps no point is nearer to the wall.
    let mut least = f64::INFINITY;
    for pair in found.frames.windows(2) {
        let (from, to) = (pair[0].in_world(), pair[1].in_world());
        for share in (0..=20).map(|step| f64::from(step) / 20.0) {
            let reached = from.iter().zip(&to).map(|(a, b)| a[0] + (b[0] - a[0]) * share);
            least = reached.fold(least, |least, x| least.min(1.0 - x));
        }
    }
    assert!(least >= kept - 1e-12 && least < clearance + 1e-9, "{least}");
    // The ends are the path's own, the shares go from 0 to 1, and energies and volumes say that the robot was flattened.
    let (first, last) = (&found.frames[0], &found.frames[found.frames.len() - 1]);
    assert_eq!((&first.configuration[..], first.share, first.edge), (path.get(0), 0.0, 0));
    assert_eq!((&last.configuration[..], last.share, last.edge), (path.get(2), 1.0, 1));
    assert!(found.frames.is_sorted_by(|a, b| a.share < b.share && a.edge <= b.edge));
    assert_eq!((first.energy, first.volume), (0.0, 1.0));
    let [least, greatest] = found.volumes();
    assert!(found.highest_energy() > 0.5 && least < 0.8 && greatest == 1.0, "{least} {greatest}");
    // Every configuration was deformed once, and each frame that is no blend is one of them.
    let Deformations { tried, failed, at_rest, .. } = answer.deformations;
    let of_method = found.frames.iter().filter(|frame| !frame.is_blend);
    let (rest, moved): (Vec<_>, Vec<_>) = of_method.partition(|frame| frame.energy == 0.0);
    assert_eq!([rest.len(), moved.len()], [at_rest as usize, tried as usize]);
    assert_eq!(failed, 0);
    assert_eq!(method.asked.borrow().len(), (tried + at_rest) as usize);
    let shared =
        rest.iter().all(|frame| std::sync::Arc::ptr_eq(&frame.vertices, &rest[0].vertices));
    assert!(shared, "frames at rest share one list");
}

#[test]
fn without_a_clearance_frames_are_a_step_apart_and_nothing_is_promised() {
    let (space, body) = (space(BaseJoint::Translation3d), body([1.0; 3]));
    let wall = Obstacles::new(&[obstacle([2.0, 20.0, 20.0], [2.0, 0.0, 0.0])]);
    let method = Moving::new(&body, before_wall(0.0));
    let path = configs(&[&[-1.0, 0.0, 0.0], &[0.75, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &wall, [0.0, 0.25]);
    let found = deform_path(&path, asked, &Cancel::new()).path.unwrap();
    assert_eq!(found.between, Between::Sampled);
    // 1.75 in halves of halves of 0.21875.
    assert_eq!((found.frames.len(), found.largest_movement()), (9, 0.21875));
    // With a clearance its movements are shorter than a long step.
    assert_eq!(robot((&space, &body), &method, &wall, [0.1, 5.0]).longest_movement(), 0.19);
    assert_eq!(robot((&space, &body), &method, &wall, [0.1, 0.01]).longest_movement(), 0.01);
}

/// Where x > 0 the shape leaps: its vertices are pushed up by 1, all of them.
fn leap(pose: &Pose, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    Some(if pose.translation[0] > 0.0 { [x, y, z + 1.0] } else { [x, y, z] })
}

#[test]
fn shapes_that_leap_in_free_space_are_blended_and_the_blends_are_free() {
    let (space, body) = (space(BaseJoint::Translation3d), body([0.2; 3]));
    let nothing = Obstacles::new(&[]);
    let method = Moving::new(&body, leap);
    let path = configs(&[&[-1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &nothing, [0.05, 1.0]);
    let answer = deform_path(&path, asked, &Cancel::new());
    let found = answer.path.unwrap();
    assert!(found.largest_movement() <= asked.longest_movement());
    assert!(matches!(found.between, Between::Proved { .. }));
    let blends: Vec<&Frame> = found.frames.iter().filter(|frame| frame.is_blend).collect();
    // 1 up, and the way along x meanwhile, in eleven movements of at most 0.095.
    assert_eq!((blends.len(), answer.deformations.blends), (10, 10));
    assert!(blends.is_sorted_by(|a, b| a.energy < b.energy && a.vertices[0][2] < b.vertices[0][2]));
    // The energy of a blend of shapes that are moved alike is the sum of the displacements itself.
    for blend in &blends {
        let displacements = blend.vertices.iter().zip(body.vertices());
        let sum: f64 = displacements.map(|(to, from)| movement(&[*from], &[*to])).sum();
        assert!((sum - blend.energy).abs() < 1e-12);
    }
    // A method that does not accept blends: the shape jumps.
    struct Unblended<'a>(&'a dyn Deform);
    impl Deform for Unblended<'_> {
        fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
            self.0.deform(pose)
        }

        fn accepts_blend(&self, _pose: &Pose, _vertices: &[[f64; 3]]) -> bool {
            false
        }
    }
    let asked = DeformableRobot { method: &Unblended(&method), ..asked };
    let answer = deform_path(&path, asked, &Cancel::new());
    assert_eq!(answer.path, Err(NoDeformedPath::Refused));
    assert!(matches!(answer.removed[0].refusal, Refusal::Jump(moved) if moved > 1.0));
}

/// The sides of a box from -2 to 2 along all three axes, or two of them.
fn sides_of(axes: usize, clearance: f64, meaning: BoundsMeaning) -> Vec<Body> {
    let bounds = Bounds { min: [-2.0; 3], max: [2.0; 3], meaning };
    sides(&bounds, axes, clearance, 1.0)
}

#[test]
fn the_sides_of_bounds_are_obstacles_that_a_shape_may_come_up_to() {
    let body = body([1.0; 3]);
    let at = |x: f64, y: f64, z: f64| {
        placed(body.vertices(), &Pose { translation: [x, y, z], ..Pose::IDENTITY })
    };
    for (axes, clearance) in [(3, 0.25), (2, 0.25), (3, 0.0)] {
        let sides = Obstacles::new(&sides_of(axes, clearance, BoundsMeaning::Body));
        let is_free = |shape: &[[f64; 3]]| sides.is_free(shape, body.triangles(), clearance);
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let moved = |by: f64| {
                    let mut place = [0.0; 3];
                    place[axis] = sign * by;
                    at(place[0], place[1], place[2])
                };
                // The box of edge length 1 touches the bounds at 1.5.
                assert!(is_free(&moved(1.5 - 1e-9)));
                let is_bounded = axis < axes;
                assert_eq!(is_free(&moved(1.5 + 1e-9)), !is_bounded);
                // As far as a robot goes whose reference point is within the bounds.
                assert_eq!(is_free(&moved(2.0)), !is_bounded);
            }
        }
        // Nothing is free in the corners, either.
        assert!(!is_free(&at(2.0, 2.0, 0.0)) && is_free(&at(1.4, 1.4, 0.0)));
    }
    assert_eq!(sides_of(3, 0.1, BoundsMeaning::Reference), []);
}

#[test]
fn a_shape_that_jumps_through_an_obstacle_is_refused() {
    let (space, body) = (space(BaseJoint::Translation3d), body([0.2; 3]));
    // A plate between the shape below and that above, which both keep away from it.
    let plate = Obstacles::new(&[obstacle([1.0, 1.0, 0.1], [0.0, 0.0, 0.5])]);
    let method = Moving::new(&body, leap);
    let path = configs(&[&[-1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &plate, [0.05, 1.0]);
    let answer = deform_path(&path, asked, &Cancel::new());
    assert_eq!(answer.path, Err(NoDeformedPath::Refused));
    assert_eq!((answer.removed.len(), answer.deformed_edges), (1, 0));
    assert_eq!(answer.removed[0].ends, [NodeId(0), NodeId(1)]);
    assert!(
        matches!(answer.removed[0].refusal, Refusal::Jump(moved) if (1.0..1.01).contains(&moved))
    );
    // At most as many halvings as it takes from 2 to a sixteenth of the longest movement, and not many more configurations.
    let Deformations { tried, at_rest, .. } = answer.deformations;
    assert!(tried + at_rest < 50, "{tried} {at_rest}");
}

#[test]
fn shapes_with_too_high_an_energy_are_refused_and_so_are_shapes_that_are_none() {
    let (space, body) = (space(BaseJoint::Translation3d), body([1.0; 3]));
    let wall = Obstacles::new(&[obstacle([2.0, 20.0, 20.0], [2.0, 0.0, 0.0])]);
    let method = Moving::new(&body, before_wall(0.1));
    let path = configs(&[&[0.0, 0.0, 0.0], &[0.8, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &wall, [0.1, 1.0]);
    // Four vertices are moved by 0.4 at the end.
    let found = deform_path(&path, asked, &Cancel::new()).path.unwrap();
    assert!((found.highest_energy() - 1.6).abs() < 1e-12);
    let asked = DeformableRobot { highest_energy: 1.59, ..asked };
    let answer = deform_path(&path, asked, &Cancel::new());
    assert!(
        matches!(answer.path, Err(NoDeformedPath::Goal(Refusal::Energy(energy))) if energy > 1.59)
    );
    assert_eq!((answer.deformations.tried, answer.deformations.failed), (1, 1));
    for bad in [f64::NAN, f64::INFINITY] {
        let method = Moving::new(&body, |_: &Pose, [x, y, _]: [f64; 3]| Some([x, y, bad]));
        let asked = DeformableRobot { method: &method, highest_energy: f64::INFINITY, ..asked };
        let answer = deform_path(&path, asked, &Cancel::new());
        assert_eq!(answer.path, Err(NoDeformedPath::Start(Refusal::Collides)));
    }
    assert!(asked.complaint().is_none());
    for (clearance, step, energy) in
        [(-1.0, 1.0, 1.0), (f64::NAN, 1.0, 1.0), (0.0, 0.0, 1.0), (0.0, 1.0, f64::NAN)]
    {
        let asked = DeformableRobot { clearance, step, highest_energy: energy, ..asked };
        assert!(asked.complaint().unwrap().contains(" found; a length"));
    }
}

#[test]
fn a_motion_with_too_many_frames_is_refused_and_a_cancelled_one_ends() {
    let (space, body) = (space(BaseJoint::Translation3d), body([1.0; 3]));
    let nothing = Obstacles::new(&[]);
    let method = Moving::new(&body, |_: &Pose, point| Some(point));
    let motion = configs(&[&[0.0, 0.0, 0.0], &[1.0, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &nothing, [0.0, 1e-6]);
    let mut shapes = Shapes::new(asked);
    let refused = deform_motion(&motion, &mut shapes, &Cancel::new());
    assert_eq!(refused.err(), Some(Unfinished::Refused(Refusal::Frames)));
    let cancel = Cancel::new();
    cancel.cancel();
    let asked = DeformableRobot { step: 0.1, ..asked };
    let answer = deform_path(&motion, asked, &cancel);
    assert_eq!(answer.path, Err(NoDeformedPath::Cancelled));
    assert_eq!(answer.deformations, Deformations::default());
    // One configuration alone is a path of one place, and no configuration is no path.
    let answer = deform_path(&configs(&[&[1.0, 0.0, 0.0]]), asked, &Cancel::new());
    assert!(answer.path.unwrap().frames.iter().all(|frame| frame.share == 0.0));
    let answer = deform_path(&Configs::new(3), asked, &Cancel::new());
    assert_eq!(answer.path, Err(NoDeformedPath::Apart));
}

/// A square of nodes 0 to 3, and a node 4 in its middle: the ways from 0 to 3 are over 1, over 2, and over 4.
struct Square {
    nodes: [[f64; 3]; 5],
    edges: Vec<Edge>,
    graph: Graph,
}

impl Square {
    fn new(weights: [f64; 6]) -> Square {
        let ends = [(0, 1), (1, 3), (0, 2), (2, 3), (0, 4), (3, 4)];
        let edge = |((low, high), weight): ((u32, u32), f64)| {
            Edge::metric(NodeId(low), NodeId(high), 0, weight)
        };
        let edges: Vec<Edge> = ends.into_iter().zip(weights).map(edge).collect();
        let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
        Square { nodes, graph: Graph::new(5, &edges), edges }
    }

    fn motion(&self, index: u32) -> Configs {
        let Edge { low, high, .. } = self.edges[index as usize];
        configs(&[&self.nodes[low.index()], &self.nodes[high.index()]])
    }

    fn answer(&self, ends: [u32; 2], robot: DeformableRobot) -> DeformingAnswer {
        let cancel = Cancel::new();
        let mut search = Search::new(robot, &cancel);
        let found = search.path(&self.graph, ends.map(NodeId), &|index| self.motion(index));
        search.answer(found)
    }
}

#[test]
fn edges_are_tried_from_the_heaviest_and_a_refused_one_is_removed_for_the_query() {
    let (space, body) = (space(BaseJoint::Translation3d), body([0.1; 3]));
    let nothing = Obstacles::new(&[]);
    // Over 1 it is lightest; its second edge is the heavier one, and cannot be deformed in the middle. Over 2 the edges are as
    // heavy as one another, and the second cannot be deformed. Over 4 all is free.
    let square = Square::new([1.0, 2.0, 2.0, 2.0, 1.0, 9.0]);
    let method = Moving::new(&body, |pose: &Pose, point| {
        let [x, y, _] = pose.translation;
        let is_middle = |a: f64, b: f64| a == 0.5 && b == 1.0;
        (!is_middle(y, x) && !is_middle(x, y)).then_some(point)
    });
    let asked = robot((&space, &body), &method, &nothing, [0.0, 0.6]);
    let answer = square.answer([0, 3], asked);
    let removed: Vec<_> = answer.removed.iter().map(|edge| (edge.ends, edge.weight)).collect();
    assert_eq!(removed, [([NodeId(1), NodeId(3)], 2.0), ([NodeId(2), NodeId(3)], 2.0)]);
    assert_eq!((answer.searches, answer.weight, answer.deformed_edges), (3, 10.0, 3));
    let asked_at = method.asked.take();
    // The lighter edge from 0 to 1 was never looked at; of equal ones that nearer to the start came first; what was known was not asked again.
    let [a, b, c, d] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, 0.0]];
    let [e, f, g] = [[0.0, 1.0, 0.0], [0.0, 0.5, 0.0], [0.5, 1.0, 0.0]];
    let [h, i, j] = [[0.5, 0.5, 0.0], [0.75, 0.75, 0.0], [0.25, 0.25, 0.0]];
    // The diagonal's halves are longer than the step.
    assert_eq!(asked_at, [a, b, c, d, e, f, g, h, i, j]);
    let Deformations { tried, failed, at_rest, blends } = answer.deformations;
    assert_eq!([tried, failed, at_rest, blends], [2, 2, 8, 0]);
    let found = answer.path.unwrap();
    let places: Vec<[f64; 3]> = found.frames.iter().map(|frame| frame.pose.translation).collect();
    assert_eq!(places, [d, j, h, i, b]);
    assert_eq!(found.frames.iter().map(|frame| frame.edge).collect::<Vec<_>>(), [0, 0, 0, 1, 1]);
    assert_eq!(found.edges, 2);
    // The way back is the same, backwards.
    let back = square.answer([3, 0], asked).path.unwrap();
    let places_back: Vec<[f64; 3]> =
        back.frames.iter().rev().map(|frame| frame.pose.translation).collect();
    assert_eq!(places_back, places);
    // Whoever refuses all of it has no path, and nodes that nothing joins never had one.
    let method =
        Moving::new(&body, |pose: &Pose, point| (pose.translation[2] > 0.0).then_some(point));
    let asked = DeformableRobot { method: &method, ..asked };
    let answer = square.answer([0, 3], asked);
    assert_eq!(answer.path, Err(NoDeformedPath::Refused));
    assert_eq!((answer.removed.len(), answer.searches), (3, 4));
    // What is found where edges meet is remembered, a refusal as well: of each of the three edges the end that is looked at first.
    assert_eq!(answer.deformations.failed, method.asked.borrow().len() as u64);
    let alone = Graph::new(5, &[]);
    let cancel = Cancel::new();
    let mut search = Search::new(asked, &cancel);
    let found = search.path(&alone, [NodeId(0), NodeId(1)], &|index| square.motion(index));
    assert_eq!(found.err(), Some(NoDeformedPath::Apart));
}

#[test]
fn a_frame_has_the_same_vertices_in_the_world_as_its_pose_says() {
    let (space, body) = (space(BaseJoint::Translation3d), body([1.0; 3]));
    let nothing = Obstacles::new(&[]);
    let method = Moving::new(&body, leap);
    let path = configs(&[&[0.5, 0.0, 0.0], &[1.0, 0.0, 0.0]]);
    let asked = robot((&space, &body), &method, &nothing, [0.0, 0.1]);
    let found = deform_path(&path, asked, &Cancel::new()).path.unwrap();
    let last = &found.frames[found.frames.len() - 1];
    let expected = Pose { translation: [1.0, 0.0, 1.0], ..Pose::IDENTITY };
    let apart = movement(&last.in_world(), &placed(body.vertices(), &expected));
    assert!(apart < 1e-12 && (last.energy - 8.0).abs() < 1e-12);
    assert!((last.volume - 1.0).abs() < 1e-12);
}

/// The surfaces of two boxes as one mesh, the second turned inside out.
fn one_turned() -> Mesh {
    let (corners, triangles) = box_surface([1.0; 3]);
    let mut mesh = Mesh { vertices: corners.to_vec(), triangles: triangles.to_vec() };
    mesh.vertices.extend(corners.map(|[x, y, z]| [x + 5.0, y, z]));
    mesh.triangles.extend(triangles.iter().map(|[a, b, c]| [a + 8, c + 8, b + 8]));
    mesh
}

#[test]
fn volumes_of_pieces_that_are_turned_opposite_ways_do_not_cancel() {
    let mesh = one_turned();
    let body = SoftBody::new(mesh.clone()).unwrap();
    assert!((body.volume(body.vertices()) - 2.0).abs() < 1e-12);
    assert_eq!(body.witnesses(), [0, 8]);
    let smaller: Vec<[f64; 3]> = body.vertices().iter().map(|p| p.map(|x| x / 2.0)).collect();
    assert!((body.volume_share(&smaller) - 0.125).abs() < 1e-12);
    // A triangle of a piece that is turned the other way than its neighbours: no inside can be told.
    let mut uneven = mesh;
    uneven.triangles[0].swap(1, 2);
    let refused = SoftBody::new(uneven).unwrap_err();
    assert!(refused.starts_with("a mesh with 3 edges along which"), "{refused}");
}

/// A method that is stopped while it works, and refuses then: no verdict of the search.
#[test]
fn what_is_refused_after_the_end_of_a_search_is_no_verdict() {
    struct Stopped(Cancel);
    impl Deform for Stopped {
        fn deform(&self, _pose: &Pose) -> Result<Deformed, Refusal> {
            self.0.cancel();
            Err(Refusal::Limits)
        }
    }
    let (body, space, cancel) = (body([1.0; 3]), space(BaseJoint::Translation3d), Cancel::new());
    let obstacles = Obstacles::new(&[]);
    let method = Stopped(cancel.clone());
    let asked = DeformableRobot {
        space: &space,
        pose: &pose,
        body: &body,
        method: &method,
        obstacles: &obstacles,
        highest_energy: f64::INFINITY,
        clearance: 0.0,
        step: 0.1,
    };
    let answer = deform_path(&configs(&[&[0.0; 3], &[1.0; 3]]), asked, &cancel);
    assert_eq!(answer.path, Err(NoDeformedPath::Cancelled));
}
