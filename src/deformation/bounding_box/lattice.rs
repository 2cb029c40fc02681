//! The points over the robot's bounding box.

use crate::scene::Mesh;

/// How far the lattice reaches beyond the robot on every side, as a share of the robot's size along the axis, so that all vertices
/// are strictly within.
const BEYOND: f64 = 1e-3;

/// Points in rows along the axes of the robot's frame, equally far apart along each.
pub(super) struct Lattice {
    /// How many there are along each axis.
    pub counts: [usize; 3],
    /// How far apart they are along each axis.
    pub spacing: [f64; 3],
    /// The point with the least coordinates.
    low: [f64; 3],
    /// Where the points rest, x fastest, then y, then z.
    pub points: Vec<[f64; 3]>,
    /// In which place along each axis each point stands: looked up for each neighbour, which is faster than dividing its index.
    places: Vec<[u32; 3]>,
}

impl Lattice {
    /// A lattice around a mesh. Along an axis along which the mesh has no extent it is as thick as a thousandth of the mesh's size.
    pub fn around(mesh: &Mesh, counts: [u32; 3]) -> Lattice {
        let (min, max) = mesh.bounding_box();
        let extent = [0, 1, 2].map(|axis| max[axis] - min[axis]);
        let size = extent.iter().fold(0.0, |most, e| f64::max(most, *e));
        let margin = extent.map(|e| BEYOND * if e > BEYOND * size { e } else { size });
        let low = [0, 1, 2].map(|axis| min[axis] - margin[axis]);
        let counts = counts.map(|count| count as usize);
        let spacing =
            [0, 1, 2].map(|axis| (extent[axis] + 2.0 * margin[axis]) / (counts[axis] as f64 - 1.0));
        let mut places = Vec::with_capacity(counts.iter().product());
        for z in 0..counts[2] as u32 {
            for y in 0..counts[1] as u32 {
                places.extend((0..counts[0] as u32).map(|x| [x, y, z]));
            }
        }
        let at = |place: &[u32; 3]| {
            [0, 1, 2].map(|axis| low[axis] + spacing[axis] * f64::from(place[axis]))
        };
        let points = places.iter().map(at).collect();
        Lattice { counts, spacing, low, points, places }
    }

    /// How far apart the indices of neighbours along each axis are.
    pub fn strides(&self) -> [usize; 3] {
        [1, self.counts[0], self.counts[0] * self.counts[1]]
    }

    /// In which place along each axis a point stands.
    pub fn place(&self, index: usize) -> [usize; 3] {
        self.places[index].map(|place| place as usize)
    }

    /// The neighbours of a point: the axis, whether it is the next one along the axis or the one before, and the index.
    #[inline]
    pub fn neighbours(&self, index: usize) -> impl Iterator<Item = (usize, bool, usize)> + use<> {
        let (place, strides, counts) = (self.place(index), self.strides(), self.counts);
        (0..6).filter_map(move |side| {
            let (axis, next) = (side / 2, side % 2 == 1);
            let is_there = if next { place[axis] + 1 < counts[axis] } else { place[axis] > 0 };
            let neighbour = || if next { index + strides[axis] } else { index - strides[axis] };
            is_there.then(|| (axis, next, neighbour()))
        })
    }

    /// Whether a point is on the surface of the box.
    pub fn is_on_surface(&self, index: usize) -> bool {
        let place = self.place(index);
        (0..3).any(|axis| place[axis] == 0 || place[axis] + 1 == self.counts[axis])
    }

    /// The middle of the box.
    pub fn centre(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            self.low[axis] + self.spacing[axis] * (self.counts[axis] as f64 - 1.0) / 2.0
        })
    }

    /// The cell that a point of the box is in, as the index of its corner with the least coordinates, and how far the point is along
    /// it, as shares from 0 to 1.
    pub fn cell(&self, point: [f64; 3]) -> (usize, [f64; 3]) {
        let strides = self.strides();
        let (mut first, mut shares) = (0, [0.0; 3]);
        for axis in 0..3 {
            let along = (point[axis] - self.low[axis]) / self.spacing[axis];
            let cell = (along.max(0.0) as usize).min(self.counts[axis] - 2);
            first += cell * strides[axis];
            shares[axis] = along - cell as f64;
        }
        (first, shares)
    }

    /// How far a point of the box is along the whole lattice, as shares from 0 to 1.
    pub fn shares(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            (point[axis] - self.low[axis]) / (self.spacing[axis] * (self.counts[axis] as f64 - 1.0))
        })
    }

    /// The eight corners of a cell, given the one with the least coordinates, x fastest.
    pub fn corners(&self, first: usize) -> [usize; 8] {
        let [x, y, z] = self.strides();
        std::array::from_fn(|i| first + (i & 1) * x + (i >> 1 & 1) * y + (i >> 2 & 1) * z)
    }
}
