//! The surface that is deformed.

use super::*;
use crate::scene::{Body, Pose, Shape};
use std::f64::consts::PI;

fn volume(mesh: &Mesh) -> f64 {
    let at = |corner: &u32| mesh.vertices[*corner as usize];
    let six = mesh.triangles.iter().map(|[a, b, c]| {
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (at(a), at(b), at(c));
        ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    });
    six.sum::<f64>() / 6.0
}

fn with_bodies(bodies: Vec<Body>, longest_edge: f64) -> Deformable {
    let mut described = deformable(&with(""));
    described.bodies.robot.links[0].bodies = bodies;
    Deformable { longest_edge, ..described }
}

fn at(shape: Shape, translation: [f64; 3]) -> Body {
    Body { shape, pose: Pose { translation, ..Pose::IDENTITY }, solid: true }
}

#[test]
fn surfaces_are_closed_fine_and_hold_the_volume() {
    let inside_out = Mesh {
        vertices: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    };
    for (shape, expected, least) in [
        (Shape::Box { size: [1.2, 0.6, 0.4] }, 0.288, 1.0 - 1e-12),
        (Shape::Sphere { radius: 0.5 }, 4.0 / 3.0 * PI * 0.125, 0.97),
        (Shape::Cylinder { radius: 0.5, height: 2.0 }, PI * 0.5, 0.97),
        (Shape::Capsule { radius: 0.5, height: 2.0 }, PI * 0.5 + 4.0 / 3.0 * PI * 0.125, 0.97),
        (Shape::Mesh(inside_out), 1.0 / 6.0, 1.0 - 1e-12),
    ] {
        for longest in [10.0, 0.2, 0.05] {
            let described = with_bodies(vec![at(shape.clone(), [3.0, -2.0, 0.5])], longest);
            let mesh = described.surface();
            assert!(mesh.is_closed(), "{shape:?}");
            assert!(!super::super::surface::has_longer_edge(&mesh, longest));
            let share = volume(&mesh) / expected;
            assert!(share >= least && share <= 1.0 + 1e-12, "{share} of {shape:?}");
        }
    }
}

/// The vertices of round shapes lie on them, so that the surface is within the shape.
#[test]
fn several_bodies_are_pieces_of_one_surface() {
    let ball = Shape::Sphere { radius: 0.3 };
    let bodies = vec![at(Shape::Box { size: [1.0; 3] }, [0.0; 3]), at(ball, [2.0, 0.0, 0.0])];
    let mesh = with_bodies(bodies, 0.25).surface();
    let pieces: Vec<usize> = mesh.pieces().into_iter().map(|piece| piece.unwrap()).collect();
    assert_eq!(pieces.iter().max(), Some(&1));
    for (vertex, piece) in mesh.vertices.iter().zip(pieces) {
        let from = [vertex[0] - 2.0, vertex[1], vertex[2]];
        let distance = from.iter().map(|value| value * value).sum::<f64>().sqrt();
        let cube = vertex.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        match piece {
            0 => assert!((cube - 0.5).abs() < 1e-12, "{vertex:?}"),
            _ => assert!(distance <= 0.3 + 1e-12, "{vertex:?}"),
        }
    }
}

/// At most as long as a 64th of the longest edge of its box: the finest that a problem may ask for is made, and is sound.
#[test]
fn the_finest_surface_is_made() {
    let described = with_bodies(vec![at(Shape::Sphere { radius: 1.0 }, [0.0; 3])], 2.0 / 64.0);
    assert_eq!(described.sound(), Ok(()));
    assert!(described.surface().triangles.len() > 10_000);
}
