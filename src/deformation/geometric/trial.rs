use super::regions::Region;
use super::surface::Surface;
use crate::deformation::Obstacles;
use parry3d_f64::math::Vector;

/// A region at places where it might go.
pub(super) struct Trial<'a> {
    pub surface: &'a Surface,
    pub region: &'a Region,
    pub obstacles: &'a Obstacles,
    /// How near to an obstacle a triangle collides.
    pub reach: f64,
    /// The vertices of the whole shape, in the world's frame, before the region is moved.
    pub shape: &'a [Vector],
    /// The same with the region where it was tried last.
    tried: Vec<Vector>,
    /// The region's triangles, those first that collided in the last trials, since they are the likeliest to collide again.
    order: Vec<u32>,
}

impl<'a> Trial<'a> {
    pub fn new(
        surface: &'a Surface,
        region: &'a Region,
        obstacles: &'a Obstacles,
        reach: f64,
        shape: &'a [Vector],
    ) -> Trial<'a> {
        let order = region.triangles.clone();
        Trial { surface, region, obstacles, reach, shape, tried: shape.to_vec(), order }
    }

    /// Whether the region is free with its vertices at these places, which are in the order of the region's vertices.
    pub fn is_free(&mut self, places: impl Iterator<Item = Vector>) -> bool {
        self.put(places);
        if let Some(at) = (0..self.order.len()).find(|at| self.is_near(self.order[*at])) {
            let triangle = self.order.remove(at);
            self.order.insert(0, triangle);
            return false;
        }
        // No triangle meets a surface now, so that each connected part of the region is within an obstacle or
        // without, and has a corner of a colliding triangle.
        let corners = match self.region.colliding.as_slice() {
            [] => self.surface.first_vertices.clone(),
            colliding => self.surface.corners_of(colliding),
        };
        let within =
            |corner: &u32| self.obstacles.contains(self.tried[*corner as usize].to_array());
        !corners.iter().any(within)
    }

    /// The region's triangles that collide with its vertices at these places, in ascending order.
    pub fn colliding(&mut self, places: impl Iterator<Item = Vector>) -> Vec<u32> {
        self.put(places);
        self.region.triangles.iter().copied().filter(|triangle| self.is_near(*triangle)).collect()
    }

    fn put(&mut self, places: impl Iterator<Item = Vector>) {
        for ((vertex, _), place) in self.region.vertices.iter().zip(places) {
            self.tried[*vertex as usize] = place;
        }
    }

    fn is_near(&self, triangle: u32) -> bool {
        let corners = self.surface.triangles[triangle as usize];
        let corners = corners.map(|corner| self.tried[corner as usize].to_array());
        self.obstacles.is_near(corners, self.reach)
    }
}
