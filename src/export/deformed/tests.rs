//! What files and page have of a path, and what texts cannot do to the page.

use super::*;
use crate::deformation::Frame;
use crate::scene::{Mesh, Pose, Shape, box_surface};
use base64::prelude::{BASE64_STANDARD, Engine};
use std::sync::Arc;

/// A cube of side 2.
fn cube() -> SoftBody {
    let (corners, triangles) = box_surface([2.0; 3]);
    SoftBody::new(Mesh { vertices: corners.to_vec(), triangles }).expect("a cube is closed")
}

/// A cube that goes along x from 0 to 1 and is flattened along z the more the nearer it is to the middle.
fn path(frames: usize) -> DeformedPath {
    let body = cube();
    let frame = |index: usize| {
        let share = index as f64 / (frames - 1) as f64;
        let flat = 1.0 - 2.0 * share * (1.0 - share);
        let vertices: Arc<[[f64; 3]]> =
            body.vertices().iter().map(|[x, y, z]| [*x, *y, flat * z]).collect();
        Frame {
            configuration: vec![share, 0.0, 0.0],
            pose: Pose { translation: [share, 0.0, 0.0], ..Pose::IDENTITY },
            volume: body.volume_share(&vertices),
            vertices,
            energy: 8.0 * (1.0 - flat),
            share,
            edge: usize::from(share > 0.5),
            is_blend: index == 1,
        }
    };
    let frames = (0..frames).map(frame).collect();
    DeformedPath { frames, edges: 2, between: Between::Proved { clearance: 0.125 } }
}

fn wall() -> Vec<Body> {
    let pose = Pose { translation: [0.5, 0.0, 2.0], ..Pose::IDENTITY };
    vec![Body { shape: Shape::Box { size: [0.5, 2.0, 1.0] }, pose, solid: true }]
}

fn page_of(path: &DeformedPath, title: &str) -> String {
    deformed_page(&DeformedPage {
        title,
        facts: &[("method", "a & b".to_owned())],
        body: &cube(),
        obstacles: &wall(),
        path,
    })
}

/// What follows a key of the data, to the end of the data.
fn at<'a>(page: &'a str, key: &str) -> &'a str {
    let (_, data) = page.split_once("id=\"data\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("their end");
    data.split_once(&format!("\"{key}\":")).unwrap_or_else(|| panic!("{key}")).1
}

fn bytes(page: &str, key: &str) -> Vec<u8> {
    let text = at(page, key).split('"').nth(1).expect("a text");
    BASE64_STANDARD.decode(text).expect("base64")
}

#[test]
fn files_of_shapes_read_back_as_they_are_in_the_world() {
    let path = path(5);
    let obj = frame_obj(&cube(), &path.frames[2]);
    let numbers = |kind: &str| -> Vec<Vec<f64>> {
        let lines = obj.lines().filter_map(|line| line.strip_prefix(kind));
        lines
            .map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect())
            .collect()
    };
    let vertices = numbers("v ");
    let expected: Vec<Vec<f64>> =
        path.frames[2].in_world().iter().map(|point| point.to_vec()).collect();
    assert_eq!(vertices, expected);
    assert!(vertices.iter().all(|point| point[2].abs() == 0.5), "flattened to half");
    let triangles = numbers("f ");
    assert_eq!(triangles.len(), 12);
    assert!(triangles.iter().flatten().all(|number| (1.0..=8.0).contains(number)));
    // Two obstacles: the vertices of the second are counted on.
    let two = obstacles_obj(&[wall(), wall()].concat());
    assert_eq!(two.matches("o obstacle-").count(), 2);
    let largest = two.lines().filter_map(|line| line.strip_prefix("f "));
    let largest =
        largest.flat_map(|line| line.split(' ')).map(|word| word.parse().expect("a number"));
    assert_eq!(largest.max(), Some(16u32));
    assert_eq!(two.matches("v ").count(), 16);
    assert_eq!(frame_name(0, 7), "frame-0001.obj");
    assert_eq!(frame_name(9998, 9999), "frame-9999.obj");
    assert_eq!(frame_name(0, 10_000), "frame-00001.obj");
}

#[test]
fn the_page_has_every_frame_in_sixteen_bits() {
    let path = path(5);
    let page = page_of(&path, "cube");
    let places: Vec<u16> = bytes(&page, "places")
        .chunks_exact(2)
        .map(|two| u16::from_le_bytes([two[0], two[1]]))
        .collect();
    assert_eq!(places.len(), 5 * 8 * 3);
    // The box around the path: x from −1 to 2, y and z from −1 to 1.
    for (frame, of_page) in path.frames.iter().zip(places.chunks_exact(24)) {
        for (point, of_page) in frame.in_world().iter().zip(of_page.chunks_exact(3)) {
            for axis in 0..3 {
                let side = [3.0, 2.0, 2.0][axis];
                let found = -1.0 + side * f64::from(of_page[axis]) / 65535.0;
                assert!((found - point[axis]).abs() <= side / 131_000.0, "{found} {point:?}");
            }
        }
    }
    let moved = bytes(&page, "moved");
    assert_eq!(moved.len(), 5 * 8);
    assert!(moved[..8].iter().all(|part| *part == 0), "at rest");
    assert!(moved[16..24].iter().all(|part| *part == 255), "displaced most: by half of its height");
    assert!(at(&page, "largest").starts_with("0.5,"));
    assert!(at(&page, "told").starts_with("[[1,0,0,100],[2,25,3,62.5],[3,50,4,50],"), "{page}");
    assert!(page.contains("Proved: ") && page.contains("1.250e-1") && !page.contains("Sampled: "));
    let (_, marks) = page.split_once("data-places=\"").expect("a mark");
    assert_eq!(marks.split_once('"').expect("its end").0.split(' ').count(), 5);
    let sampled = DeformedPath { between: Between::Sampled, ..path };
    let page = page_of(&sampled, "cube");
    assert!(page.contains("Sampled: ") && !page.contains("Proved: "));
}

#[test]
fn of_many_frames_the_page_has_some_at_even_distances_and_says_so() {
    let page = page_of(&path(1000), "cube");
    assert!(page.contains("The page has 301 of the 1000 frames"));
    assert_eq!(bytes(&page, "moved").len(), 301 * 8);
    assert!(at(&page, "all").starts_with("1000,"));
    assert!(!page_of(&path(301), "cube").contains("The page has"));
    let kept = data::kept(1000, 8);
    assert_eq!((kept[0], kept[300]), (0, 999));
    assert!(kept.windows(2).all(|two| (3..=4).contains(&(two[1] - two[0]))));
    // 300 frames of 600 vertices have room, of 30 000 vertices fewer, and both ends in any case.
    assert_eq!(data::kept(300, 600).len(), 300);
    assert_eq!(data::kept(300, 30_000).len(), 13);
    assert_eq!(data::kept(300, usize::MAX / 64), [0, 299]);
    assert_eq!(data::kept(1, 600), [0]);
}

#[test]
fn energies_are_a_table_of_all_frames() {
    use crate::space::{Dof, Factor, FactorKind, Space};
    let factor = |at| Factor { kind: FactorKind::Real { min: 0.0, max: 1.0 }, at, weight: 1.0 };
    let dof = |name: &&str| Dof { name: (*name).to_owned(), unit: "length" };
    let dofs = ["x", "y", "z"].iter().map(dof).collect();
    let space = Space::new((0..3).map(factor).collect(), dofs, 3);
    let csv = energies_csv(&space, &path(3));
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(
        lines,
        [
            "frame,share [1],edge,x [length],y [length],z [length],energy [length],volume [1],blend",
            "1,0,1,0,0,0,0,1,0",
            "2,0.5,1,0.5,0,0,4,0.5,1",
            "3,1,2,1,0,0,0,1,0",
        ]
    );
}

#[test]
fn texts_cannot_break_the_page_and_nothing_is_fetched() {
    let bad = "</script><script>alert(1)</script><!-- \"'&\u{2028}";
    let mut path = path(2);
    let page = page_of(&path, bad);
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(page.contains("default-src 'none'") && page.contains("<dd>a &amp; b</dd>"));
    for reference in ["http:", "https:", "src=", "@import", "url("] {
        assert!(!page.contains(reference), "{reference}");
    }
    assert_eq!(page, page_of(&path, bad), "the same bytes");
    // Numbers that are none do not break it either.
    path.frames[1].energy = f64::NAN;
    path.frames[1].vertices = vec![[f64::NAN, f64::INFINITY, 1e300]; 8].into();
    let page = page_of(&path, "cube");
    assert!(at(&page, "told").starts_with("[[1,0,0,100],[2,100,null,"), "{}", at(&page, "told"));
}
