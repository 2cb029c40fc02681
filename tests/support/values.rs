//! Problems of `problems/` and `tests/problems/` made from values.

use roadmill::connect::{
    AmongKind, ComponentPairs, Nearest, NearestNodes, UntilJoined, WithinKind,
};
use roadmill::evaluate::{All, Coverage, EvaluatorKind, LowestBarrier, MaxFlow, Not, Query};
use roadmill::generator::{ExpansionStep, GeneratorKind};
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::model::bodies::{
    BodiesSpec, BodySpec, FrameSpec, JointSpec, LinkSpec, RobotSpec, ShapeSpec, SpaceSpec,
};
use roadmill::model::landscape::{Energy, LandscapeSpec};
use roadmill::problem::{Problem, ProblemBuilder, StrategySpec};
use roadmill::sampler::{self, Gaussian, Halton, SamplerKind, Uniform};
use roadmill::schedule::Adaptive;
use roadmill::space::BaseJoint;
use std::path::{Path, PathBuf};

pub const TETRAHEDRON: [[f64; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.4, 0.0, 0.0], [0.0, 1.4, 0.0], [0.0, 0.0, 1.4]];
pub const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

pub fn load(name: &str) -> Problem {
    Problem::load(&path(name)).unwrap_or_else(|error| panic!("{error}"))
}

pub fn cuboid(size: [f64; 3], position: [f64; 3]) -> BodySpec {
    BodySpec::new(ShapeSpec::Box { size }).at(position)
}

pub fn uniform() -> SamplerKind {
    SamplerKind::default()
}

pub fn plane(side: f64) -> SpaceSpec {
    SpaceSpec::new(BaseJoint::Rigid2d, [0.0, 0.0], [side, side], BoundsMeaning::Body)
}

pub fn not_query() -> EvaluatorKind {
    EvaluatorKind::Not(Not(Box::new(EvaluatorKind::Query(Query::default()))))
}

/// `tests/problems/planar.toml`.
pub fn planar() -> ProblemBuilder {
    let robot = RobotSpec::new().body(ShapeSpec::Box { size: [1.2, 0.2, 1.0] });
    let pillar = BodySpec::new(ShapeSpec::Cylinder { radius: 1.0, height: 2.0 });
    let bodies = BodiesSpec::new(plane(10.0), robot)
        .obstacle(pillar.at([3.0, 3.0, 0.0]))
        .obstacle(cuboid([0.3, 6.0, 2.0], [6.0, 7.0, 0.0]))
        .obstacle(BodySpec::new(ShapeSpec::Sphere { radius: 1.5 }).at([3.0, 7.5, 0.0]));
    let nearest = Nearest { neighbors: 3, ..Nearest::default() };
    let pairs = ComponentPairs { components: 2, pairs: 4, ..ComponentPairs::default() };
    Problem::builder("planar", bodies)
        .query([1.0, 1.0, 0.0], [9.0, 9.0, 1.5])
        .sets_per_round(3)
        .schedule(["few", "many", "few"])
        .strategy(
            StrategySpec::sampled("few", uniform()).nodes(7).within(WithinKind::Nearest(nearest)),
        )
        .strategy(
            StrategySpec::sampled("many", SamplerKind::Uniform(Uniform { attempts: 1000 }))
                .nodes(13)
                .among(AmongKind::ComponentPairs(pairs)),
        )
        .most_sets(15)
}

/// `tests/problems/meshes.toml`, whose meshes are the one that `tetrahedron` makes for a scale.
pub fn meshes(tetrahedron: impl Fn(f64) -> ShapeSpec) -> ProblemBuilder {
    let space = SpaceSpec::new(BaseJoint::Rigid3d, [0.0; 3], [5.0; 3], BoundsMeaning::Reference)
        .resolution(0.1);
    let robot = RobotSpec::new()
        .body(BodySpec::new(tetrahedron(1.0)).at([-0.3, -0.3, -0.3]))
        .body(ShapeSpec::Box { size: [1.0, 0.1, 0.1] });
    let turned = BodySpec::new(tetrahedron(2.0)).at([1.5, 1.5, 1.5]).turn([1.0, 1.0, 0.0], 30.0);
    let surface = BodySpec::new(tetrahedron(1.5))
        .at([4.0, 4.0, 0.5])
        .orientation([1.0, 2.0, 3.0, 4.0])
        .solid(false);
    let capsule = BodySpec::new(ShapeSpec::Capsule { radius: 0.4, height: 2.0 });
    let bodies =
        BodiesSpec::new(space, robot).obstacles([turned, surface, capsule.at([4.0, 1.0, 3.0])]);
    let near = |neighbors| WithinKind::Nearest(Nearest { neighbors, ..Nearest::default() });
    let pairs = |components, pairs| {
        let method = ComponentPairs { components, pairs, ..ComponentPairs::default() };
        AmongKind::ComponentPairs(method)
    };
    Problem::builder("meshes", bodies)
        .folder(path("tests/problems"))
        .query([0.7, 0.7, 4.3, 1.0, 0.0, 0.0, 0.0], [4.3, 2.5, 4.3, 0.5, 0.5, -0.5, 0.5])
        .sets_per_round(2)
        .strategies([
            StrategySpec::sampled("near", uniform()).nodes(10).within(near(2)).among(pairs(3, 2)),
            StrategySpec::sampled("far", uniform()).nodes(10).within(near(5)).among(pairs(1, 5)),
        ])
        .most_sets(12)
}

/// Meshes in memory.
pub fn in_memory(scale: f64) -> ShapeSpec {
    ShapeSpec::Triangles {
        vertices: TETRAHEDRON.to_vec(),
        triangles: FACES.to_vec(),
        scale,
        weld: 1e-6,
    }
}

/// `tests/problems/ball.toml`: a base that stands still and two joints.
pub fn ball() -> ProblemBuilder {
    let space = SpaceSpec::new(BaseJoint::Fixed, [-2.0; 3], [2.0; 3], BoundsMeaning::Body);
    let rod = BodySpec::new(ShapeSpec::Capsule { radius: 0.05, height: 0.8 }).at([0.0, 0.0, 0.5]);
    let up = |z| FrameSpec::at([0.0, 0.0, z]);
    let fold = JointSpec::revolute_in_radians([1.0, 0.0, 0.0], [-1.5, 1.5]);
    let robot = RobotSpec::new()
        .name("pillar")
        .base(up(-1.0))
        .body(ShapeSpec::Box { size: [0.2, 0.2, 1.0] })
        .link(LinkSpec::new("rod", JointSpec::spherical().before(up(0.6))).body(rod))
        .link(
            LinkSpec::new("blade", fold.before(up(1.0)))
                .body(cuboid([0.1, 0.3, 0.4], [0.0, 0.0, 0.25])),
        );
    let bodies = BodiesSpec::new(space.resolution(0.1), robot)
        .obstacle(cuboid([0.4, 0.4, 2.0], [0.9, 0.0, -0.5]))
        .obstacle(cuboid([0.4, 0.4, 2.0], [-0.9, 0.0, -0.5]));
    let half = std::f64::consts::FRAC_1_SQRT_2;
    Problem::builder("ball", bodies)
        .query([half, half, 0.0, 0.0, 0.0], [half, -half, 0.0, 0.0, 0.5])
        .sets_per_round(2)
        .strategy(StrategySpec::sampled("near", uniform()).nodes(15))
        .most_sets(10)
}

/// `tests/problems/arm.toml`: every other joint.
pub fn arm() -> ProblemBuilder {
    let space = SpaceSpec::new(
        BaseJoint::Translation2d,
        [-1.0, -1.0],
        [1.0, 1.0],
        BoundsMeaning::Reference,
    );
    let (z, at) = ([0.0, 0.0, 1.0], FrameSpec::at);
    let upper = BodySpec::new(ShapeSpec::Capsule { radius: 0.05, height: 0.7 });
    let robot = RobotSpec::new()
        .body(ShapeSpec::Box { size: [0.3, 0.3, 0.1] })
        .link(
            LinkSpec::new("upper", JointSpec::revolute(z).before(at([0.0, 0.0, 0.15])))
                .body(upper.at([0.45, 0.0, 0.0]).turn([0.0, 1.0, 0.0], 90.0)),
        )
        .link(
            LinkSpec::new(
                "lower",
                JointSpec::revolute_in_degrees(z, [-170.0, 170.0]).before(at([0.9, 0.0, 0.0])),
            )
            .body(cuboid([0.6, 0.1, 0.1], [0.4, 0.0, 0.0])),
        )
        .link(
            LinkSpec::new(
                "tool",
                JointSpec::prismatic([1.0, 0.0, 0.0], [0.0, 0.4]).before(at([0.6, 0.0, 0.0])),
            )
            .body(ShapeSpec::Box { size: [0.3, 0.04, 0.04] }),
        );
    let bodies = BodiesSpec::new(space.resolution(0.1), robot)
        .obstacle(BodySpec::new(ShapeSpec::Sphere { radius: 0.4 }).at([1.5, 1.5, 0.0]))
        .obstacle(cuboid([0.3, 2.0, 1.0], [-1.7, 0.0, 0.0]));
    let pairs = ComponentPairs { components: 2, pairs: 3, ..ComponentPairs::default() };
    let nearest = Nearest { neighbors: 3, ..Nearest::default() };
    Problem::builder("arm", bodies)
        .query([0.0, 0.0, -2.0, 1.0, 0.1], [0.0, 0.0, 2.0, -1.0, 0.3])
        .sets_per_round(2)
        .strategy(
            StrategySpec::sampled("near", uniform()).nodes(12).within(WithinKind::Nearest(nearest)),
        )
        .strategy(
            StrategySpec::sampled("far", uniform())
                .nodes(8)
                .among(AmongKind::ComponentPairs(pairs)),
        )
        .evaluator(not_query())
        .most_sets(10)
}

/// `tests/problems/landscape.toml`.
pub fn landscape() -> ProblemBuilder {
    let landscape = LandscapeSpec::new([-1.5, -0.5], [1.2, 2.0], Energy::MullerBrown).highest(20.0);
    let low = SamplerKind::Energy(sampler::Energy::new(-100.0, 0.0));
    let even = SamplerKind::Halton(Halton { block: 9, ..Halton::default() });
    let nearest = Nearest { neighbors: 5, ..Nearest::default() };
    let nodes = NearestNodes { neighbors: 5, ..NearestNodes::default() };
    let flow = MaxFlow { least_weight: Some(1.0), ..MaxFlow::new(1000.0) };
    Problem::builder("landscape", landscape)
        .query([-0.558, 1.442], [0.623, 0.028])
        .sets_per_round(3)
        .schedule(["low", "even", "low"])
        .strategy(
            StrategySpec::sampled("low", low)
                .nodes(12)
                .within(WithinKind::Nearest(nearest))
                .among(AmongKind::NearestNodes(nodes)),
        )
        .strategy(StrategySpec::sampled("even", even).nodes(9))
        .evaluator(EvaluatorKind::LowestBarrier(LowestBarrier::new(-41.0)))
        .evaluator(EvaluatorKind::All(All(vec![
            EvaluatorKind::Query(Query::default()),
            EvaluatorKind::MaxFlow(flow),
        ])))
        .most_sets(24)
}

/// `tests/problems/adaptive.toml`.
pub fn adaptive() -> ProblemBuilder {
    let robot = RobotSpec::new().body(ShapeSpec::Box { size: [1.0, 0.2, 0.2] });
    let bodies = BodiesSpec::new(plane(8.0), robot)
        .obstacle(cuboid([0.4, 6.0, 1.0], [4.0, 3.0, 0.0]))
        .obstacle(BodySpec::new(ShapeSpec::Sphere { radius: 0.8 }).at([2.0, 6.0, 0.0]));
    let until = UntilJoined { neighbors: 6, ..UntilJoined::default() };
    let nodes = NearestNodes { neighbors: 2, ..NearestNodes::default() };
    Problem::builder("adaptive", bodies)
        .query([1.0, 1.0, 0.0], [7.0, 1.0, 1.5])
        .sets_per_round(3)
        .adaptive(Adaptive { rounds: 4 })
        .strategy(StrategySpec::sampled("all", uniform()).nodes(8))
        .strategy(
            StrategySpec::sampled("near", SamplerKind::Gaussian(Gaussian::new(0.5)))
                .nodes(8)
                .among(AmongKind::UntilJoined(until)),
        )
        .strategy(
            StrategySpec::sampled("few", uniform()).nodes(4).among(AmongKind::NearestNodes(nodes)),
        )
        .evaluator(EvaluatorKind::All(All(vec![
            EvaluatorKind::Query(Query::default()),
            EvaluatorKind::Coverage(Coverage::default()),
        ])))
        .evaluator(not_query())
        .most_sets(36)
}

/// `tests/problems/expansion.toml`: a strategy that grows.
pub fn expansion() -> ProblemBuilder {
    let space = SpaceSpec::new(BaseJoint::Rigid2d, [0.0, 0.0], [8.0, 6.0], BoundsMeaning::Body);
    let robot = RobotSpec::new().body(ShapeSpec::Box { size: [1.0, 0.2, 0.2] });
    let bodies = BodiesSpec::new(space, robot)
        .obstacle(cuboid([0.3, 5.0, 1.0], [3.0, 2.5, 0.0]))
        .obstacle(cuboid([0.3, 5.0, 1.0], [5.0, 3.5, 0.0]));
    let step = ExpansionStep { steps: 15, bounces: 3, ..ExpansionStep::new(0.2) };
    let nodes = NearestNodes { neighbors: 4, ..NearestNodes::default() };
    Problem::builder("expansion", bodies)
        .query([1.0, 1.0, 0.0], [7.0, 5.0, 1.5])
        .sets_per_round(3)
        .schedule(["uniform", "expansion"])
        .strategy(StrategySpec::sampled("uniform", uniform()).nodes(8))
        .strategy(
            StrategySpec::generated("expansion", GeneratorKind::ExpansionStep(step))
                .nodes(6)
                .among(AmongKind::NearestNodes(nodes)),
        )
        .evaluator(EvaluatorKind::All(All(vec![
            EvaluatorKind::Query(Query::default()),
            not_query(),
        ])))
        .most_sets(24)
}

/// `problems/gantry.toml`: a robot of another file.
pub fn gantry() -> ProblemBuilder {
    let space =
        SpaceSpec::new(BaseJoint::Fixed, [-1.0, -2.0, 0.0], [5.0, 2.0, 3.0], BoundsMeaning::Body);
    let bodies = BodiesSpec::new(space, RobotSpec::urdf("gantry.urdf"))
        .obstacle(cuboid([0.2, 2.0, 1.2], [2.0, 0.0, 0.6]))
        .obstacle(cuboid([0.6, 0.2, 0.2], [3.6, 0.25, 0.75]));
    Problem::builder("gantry", bodies)
        .folder(path("problems"))
        .query([0.5, 0.0, 0.0], [3.6, 0.0, 0.0])
}

/// `problems/cage.toml`, with meshes of two formats.
pub fn cage() -> ProblemBuilder {
    let space = SpaceSpec::new(BaseJoint::Rigid3d, [0.0; 3], [8.0, 5.0, 5.0], BoundsMeaning::Body);
    let robot = RobotSpec::new().body(ShapeSpec::mesh_file("meshes/angle.stl"));
    let bars = BodySpec::new(ShapeSpec::mesh_file("meshes/cage.obj")).at([2.5, 2.5, 2.5]);
    Problem::builder("cage", BodiesSpec::new(space, robot).obstacle(bars))
        .folder(path("problems"))
        .query([2.5, 2.5, 2.5, 1.0, 0.0, 0.0, 0.0], [6.5, 2.5, 2.5, 1.0, 0.0, 0.0, 0.0])
}
