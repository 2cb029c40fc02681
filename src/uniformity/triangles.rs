use crate::scene::Mesh;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;
use rayon::prelude::*;

fn faces(mesh: &Mesh) -> Vec<Triangle> {
    let corner = |index: u32| Vector::from_array(mesh.vertices[index as usize]);
    mesh.faces().map(|[a, b, c]| Triangle::new(corner(a), corner(b), corner(c))).collect()
}

/// The areas of a mesh's faces, in their order, in the square of the scene's unit.
pub fn triangle_areas(mesh: &Mesh) -> Vec<f64> {
    let area = |t: &Triangle| 0.5 * (t.b - t.a).cross(t.c - t.a).length();
    faces(mesh).iter().map(area).collect()
}

/// How many points are nearest to each of a mesh's faces, in their order; the points are in the mesh's frame. Of faces that are
/// equally near the first counts, as at an edge: near convex edges that is where all points beyond the faces' own ranges
/// are, so points should be near in comparison with the faces' sizes.
pub fn triangle_counts(mesh: &Mesh, points: &[[f64; 3]]) -> Vec<usize> {
    let faces = faces(mesh);
    let nearest = |point: &[f64; 3]| {
        let point = Vector::from_array(*point);
        let distances = faces.iter().map(|face| face.distance_to_local_point(point, true));
        let least = distances.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
        least.map(|(index, _)| index)
    };
    let mut counts = vec![0; faces.len()];
    let found: Vec<Option<usize>> = points.par_iter().map(nearest).collect();
    found.into_iter().flatten().for_each(|index| counts[index] += 1);
    counts
}
