//! The environments of chapter 4, as far as its text and its numbers say what they were.
//!
//! The robot is a cube that translates and turns, and its base is in its middle. Where uniformity is measured (Figure 4.5) its
//! edge is [`EDGE`], small against the least distance of neighbours on a segment. In all scenes but those of motion planning a turn by
//! a radian counts as a length of 1 in the metric, much more than it moves any point of the cube: then the area of a C-obstacle's
//! surface in the metric is the area in the workspace, averaged over all rotations, to within a factor 1 + (reach / 1)² / 2, which is
//! 1.00015 for the cube of 0.02.
//!
//! *The law for a cube.* The surface of a convex body K, grown by a convex body L in all its rotations, has the mean area
//! S(K) + S(L) + M(K) M(L) / 2π (Blaschke's and Santaló's formula), with M the integral of the mean curvature: 4πr for a ball, π (a + b
//! + c) for a box. So [`grown`] says how much surface an obstacle has for the robot; for a point it is S(K).

use roadmill::problem::Problem;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

/// The edge of the robot where uniformity is measured.
pub const EDGE: f64 = 0.02;
/// The radii of the torus. The dissertation says "outer radius 2.5, inner radius 1", which is read as where the torus ends and as
/// where its hole ends: the middle of the tube is at R = 1.75 from the axis, and the tube has the radius r = 0.75.
pub const TORUS: [f64; 2] = [1.75, 0.75];
/// How many bands the torus has around its tube, and how many pieces each has around its axis: each piece is two triangles.
pub const TORUS_PIECES: [usize; 2] = [16, 32];
/// The edge of the robot in the passages.
pub const PASSAGE_EDGE: f64 = 0.4;
/// A slab of the passages: its width and height, and its thickness, a sixteenth of these. The two sides that face one another have
/// 2 · 40² of 4 · 40² + 8 · 40 · 2.5 = 7200, that is 3200 / 7200 = 4/9 = 44.44 %.
pub const SLAB: [f64; 2] = [40.0, 2.5];
/// How far apart the slabs of Passage 1, 2 and 3 are. The cube turns freely where the distance is more than 0.4 √3 = 0.693.
pub const PASSAGES: [f64; 3] = [20.0, 2.0, 0.56];

/// A convex obstacle.
#[derive(Clone, Copy)]
pub enum Solid {
    Ball { at: [f64; 3], radius: f64 },
    Block { at: [f64; 3], size: [f64; 3] },
}

impl Solid {
    pub fn unit_ball(x: f64, y: f64) -> Solid {
        Solid::Ball { at: [x, y, 0.0], radius: 1.0 }
    }

    pub fn cube(x: f64, y: f64) -> Solid {
        Solid::Block { at: [x, y, 0.0], size: [2.0; 3] }
    }

    /// The block between two corners.
    fn between(low: [f64; 3], high: [f64; 3]) -> Solid {
        let at = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
        Solid::Block { at, size: [0, 1, 2].map(|axis| high[axis] - low[axis]) }
    }

    fn surface(self) -> f64 {
        match self {
            Solid::Ball { radius, .. } => 4.0 * PI * radius * radius,
            Solid::Block { size: [a, b, c], .. } => 2.0 * (a * b + b * c + c * a),
        }
    }

    /// The integral of the mean curvature.
    fn curvature(self) -> f64 {
        match self {
            Solid::Ball { radius, .. } => 4.0 * PI * radius,
            Solid::Block { size, .. } => PI * size.iter().sum::<f64>(),
        }
    }

    fn text(self) -> String {
        match self {
            Solid::Ball { at, radius } => format!(
                "[[obstacles]]\nshape = {{ sphere = {{ radius = {radius:?} }} }}\nposition = {at:?}\n"
            ),
            Solid::Block { at, size } => format!(
                "[[obstacles]]\nshape = {{ box = {{ size = {size:?} }} }}\nposition = {at:?}\n"
            ),
        }
    }
}

/// The mean area of an obstacle's surface for a cube in all its rotations.
pub fn grown(solid: Solid, edge: f64) -> f64 {
    let robot = Solid::Block { at: [0.0; 3], size: [edge; 3] };
    solid.surface() + robot.surface() + solid.curvature() * robot.curvature() / TAU
}

/// A scene of convex obstacles in a box around the origin, with what moves in it.
#[derive(Clone)]
pub struct Scene {
    pub name: &'static str,
    /// Half the edges of the bounds, which hold the robot's base.
    pub half: [f64; 3],
    pub solids: Vec<Solid>,
    /// The edge of the cube that moves.
    pub edge: f64,
}

impl Scene {
    /// Its `[space]`, `[robot]` and obstacles, as a problem file has them.
    pub fn text(&self) -> String {
        let Scene { half, edge, .. } = self;
        let low = half.map(|end| -end);
        let mut text = format!(
            "[space]\nmotion = \"rigid-3d\"\nmin = {low:?}\nmax = {half:?}\nbounds = \"reference\"\nrotation_length = 1.0\n\
             [robot]\nbodies = [{{ shape = {{ box = {{ size = [{edge:?}, {edge:?}, {edge:?}] }} }} }}]\n"
        );
        self.solids.iter().for_each(|solid| text += &solid.text());
        text
    }

    pub fn problem(&self) -> Problem {
        parse(self.name, &self.text())
    }
}

pub fn parse(name: &str, text: &str) -> Problem {
    let path = Path::new(name).with_extension("toml");
    Problem::parse(&path, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Figure 4.5a and 4.17: a unit ball, which is a ball and no mesh, in a box of 8 × 8 × 8.
pub fn one_ball() -> Scene {
    let solids = vec![Solid::unit_ball(0.0, 0.0)];
    Scene { name: "one-ball", half: [4.0; 3], solids, edge: EDGE }
}

/// Figure 4.5b: four unit balls, each in the middle of a quarter of the box.
pub fn four_balls() -> Scene {
    let at = [[-2.0, 2.0], [2.0, 2.0], [-2.0, -2.0], [2.0, -2.0]];
    let solids = at.map(|[x, y]| Solid::unit_ball(x, y)).to_vec();
    Scene { name: "four-balls", half: [4.0; 3], solids, edge: EDGE }
}

/// Figure 4.5c: two unit balls and two cubes of edge 2, at the corners of a square in turn.
pub fn mixture() -> Scene {
    let (ball, cube) = (Solid::unit_ball, Solid::cube);
    let solids = vec![ball(-2.0, 2.0), ball(2.0, -2.0), cube(2.0, 2.0), cube(-2.0, -2.0)];
    Scene { name: "mixture", half: [4.0; 3], solids, edge: EDGE }
}

/// Figure 4.13: two slabs at a distance in a box of edge 60.
pub fn passage(gap: f64) -> Scene {
    let [wide, thick] = SLAB;
    let slab = |sign: f64| Solid::Block {
        at: [0.0, 0.0, 0.5 * sign * (gap + thick)],
        size: [wide, wide, thick],
    };
    let solids = vec![slab(1.0), slab(-1.0)];
    Scene { name: "passage", half: [30.0; 3], solids, edge: PASSAGE_EDGE }
}

/// Figure 4.16a: three walls, 4 thick, with square holes of widths 4, 2.6 and 1.9, for a cube of edge 1 that can turn in all of them.
pub fn tunnel() -> Scene {
    let (half, thick) = ([20.0, 6.0, 6.0], 2.0);
    let mut solids = Vec::new();
    for (x, [y, z], width) in
        [(-12.0, [0.0, 0.0], 4.0), (0.0, [2.0, 2.0], 2.6), (12.0, [-2.0, 1.0], 1.9)]
    {
        let (w, [left, right]) = (0.5 * width, [x - thick, x + thick]);
        for (low, high) in [
            ([-6.0, -6.0], [6.0, z - w]),
            ([-6.0, z + w], [6.0, 6.0]),
            ([-6.0, z - w], [y - w, z + w]),
            ([y + w, z - w], [6.0, z + w]),
        ] {
            solids.push(Solid::between([left, low[0], low[1]], [right, high[0], high[1]]));
        }
    }
    Scene { name: "tunnel", half, solids, edge: 1.0 }
}

/// Figure 4.16b: a block with a tunnel in the form of a Z, as wide as 1.6 everywhere, for a cube of edge 0.8.
pub fn z_tunnel() -> Scene {
    let (half, w, turn) = ([10.0, 4.0, 4.0], 0.8, 2.0);
    let block = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        Solid::between([x[0], y[0], z[0]], [x[1], y[1], z[1]])
    };
    let (all, middle) = ([-6.0, 6.0], [-w, w]);
    let solids = vec![
        block(all, [-4.0, -w], [-4.0, 4.0]),
        block(all, [w, 4.0], [-4.0, 4.0]),
        block(all, middle, [turn + w, 4.0]),
        block(all, middle, [-4.0, -turn - w]),
        block([-6.0, -w], middle, [-turn - w, turn - w]),
        block([w, 6.0], middle, [w - turn, turn + w]),
    ];
    Scene { name: "z-tunnel", half, solids, edge: 0.8 }
}

/// The scene with a query between its two ends, for one sampler: sets of 20 nodes, each followed by the question whether the query is
/// met. A turn counts as usual, as far as it moves the robot's farthest point.
pub fn query(scene: &Scene, robot: &str, ends: [&str; 2], sampler: &str) -> String {
    let half = scene.half;
    let low = half.map(|end| -end);
    let mut text = format!(
        "[space]\nmotion = \"rigid-3d\"\nmin = {low:?}\nmax = {half:?}\nbounds = \"body\"\n{robot}\n"
    );
    scene.solids.iter().for_each(|solid| text += &solid.text());
    let [start, goal] = ends;
    write!(
        text,
        "[query]\nstart = {start}\ngoal = {goal}\n[img]\nsets_per_round = 1\n\
         [[strategies]]\nlabel = \"one\"\nnodes = 20\nsampler = {{ {sampler} }}\n"
    )
    .expect("writing to memory cannot fail");
    text
}

/// Vertices and triangles of the torus of Figure 4.5d. Triangles 2i and 2i + 1 are piece i, counted along the axis first.
pub fn torus() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let ([far, tube], [bands, pieces]) = (TORUS, TORUS_PIECES);
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for band in 0..bands {
        for piece in 0..pieces {
            let around = TAU * piece as f64 / pieces as f64;
            let up = TAU * band as f64 / bands as f64;
            let from_axis = far + tube * libm::cos(up);
            vertices.push([
                from_axis * libm::cos(around),
                from_axis * libm::sin(around),
                tube * libm::sin(up),
            ]);
            let corner = |b: usize, p: usize| ((b % bands) * pieces + p % pieces) as u32;
            let [a, b] = [corner(band, piece), corner(band, piece + 1)];
            let [c, d] = [corner(band + 1, piece), corner(band + 1, piece + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    (vertices, triangles)
}

/// The torus in a box of 8 × 8 × 8.
pub fn torus_problem() -> Problem {
    use roadmill::model::bodies::{BodySpec, ShapeSpec};
    let empty = Scene { name: "torus", half: [4.0; 3], solids: Vec::new(), edge: EDGE };
    let (vertices, triangles) = torus();
    let body = BodySpec::new(ShapeSpec::triangles(vertices, triangles)).solid(true);
    let builder = empty.problem().to_builder();
    let builder = builder.change_model(|model| model.change_bodies(|b| b.obstacle(body)));
    builder.build().unwrap_or_else(|error| panic!("{error}"))
}
