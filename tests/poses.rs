//! Ends of a query given by the pose of a link, attached bodies, padding, and links that touch in all configurations or in
//! none.

use roadmill::math;
use roadmill::model::bodies::{
    AttachSpec, BodiesSpec, BodySpec, FrameSpec, JointSpec, LinkSpec, RobotSpec, ShapeSpec,
    SpaceSpec,
};
use roadmill::problem::{PoseSpec, Problem};
use std::path::Path;

type Matrix = [[f64; 4]; 4];

/// Forward kinematics of its own: products of matrices, nothing of the library's poses.
fn turned_about(axis: usize, angle: f64, shift: [f64; 3]) -> Matrix {
    let (sine, cosine) = (math::sin(angle), math::cos(angle));
    let mut matrix = [[0.0; 4]; 4];
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    matrix[axis][axis] = 1.0;
    (matrix[next][next], matrix[last][last]) = (cosine, cosine);
    (matrix[next][last], matrix[last][next]) = (-sine, sine);
    for i in 0..3 {
        matrix[i][3] = shift[i];
    }
    matrix[3][3] = 1.0;
    matrix
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// An arm of six joints about z, y, y, x, y and x, its links a unit or less long.
const ARM: [(usize, [f64; 3]); 6] = [
    (2, [0.0, 0.0, 0.4]),
    (1, [0.1, 0.0, 0.2]),
    (1, [0.0, 0.0, 1.0]),
    (0, [0.6, 0.0, 0.1]),
    (1, [0.4, 0.0, 0.0]),
    (0, [0.3, 0.0, 0.0]),
];

fn hand_at(q: &[f64]) -> Matrix {
    ARM.iter().zip(q).fold(turned_about(0, 0.0, [0.0; 3]), |pose, ((axis, shift), value)| {
        product(&pose, &turned_about(*axis, *value, *shift))
    })
}

fn arm() -> RobotSpec {
    let ball = |radius: f64| BodySpec::new(ShapeSpec::Sphere { radius });
    let mut robot = RobotSpec::new().body(ball(0.1));
    for (index, (axis, shift)) in ARM.iter().enumerate() {
        let mut direction = [0.0; 3];
        direction[*axis] = 1.0;
        let joint =
            JointSpec::revolute_in_radians(direction, [-2.8, 2.8]).before(FrameSpec::at(*shift));
        robot = robot.link(LinkSpec::new(format!("link{index}"), joint).body(ball(0.05)));
    }
    robot
}

/// How far a hand is from a pose: a length, and the angle of the turn between.
fn away(hand: &Matrix, position: [f64; 3], [w, x, y, z]: [f64; 4]) -> (f64, f64) {
    let squared = |x: f64| x * x;
    let length = (0..3).map(|i| squared(hand[i][3] - position[i])).sum::<f64>().sqrt();
    let goal = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    // Twice the arc sine of half the distance of the rotations, which is exact where the angle is small.
    let square: f64 = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .map(|(i, j)| squared(hand[i][j] - goal[i][j]))
        .sum();
    (length, {
        let sine = (square / 8.0).sqrt().min(1.0);
        2.0 * math::atan2(sine, (1.0 - sine * sine).sqrt())
    })
}

#[test]
fn the_hand_comes_to_the_pose_that_is_asked_for() {
    let start = [0.0, 0.3, 0.4, 0.1, 0.2, 0.0];
    let mut most = 0;
    for (index, position) in [[0.9, 0.2, 0.9], [0.5, -0.7, 1.1], [-0.4, 0.6, 1.6], [0.7, 0.7, 0.5]]
        .into_iter()
        .enumerate()
    {
        let half = 0.2 * (1.0 + index as f64);
        let orientation = [math::cos(half), 0.0, math::sin(half), 0.0];
        let pose = PoseSpec::new("link5", position)
            .orientation(orientation)
            .position_tolerance(1e-5)
            .orientation_tolerance(1e-4);
        let build = || {
            Problem::builder("arm", BodiesSpec::new(SpaceSpec::fixed(), arm()))
                .query(start, pose.clone())
                .build()
                .unwrap_or_else(|error| panic!("{error}"))
        };
        let problem = build();
        let query = problem.query().unwrap();
        assert_eq!(query.start, start);
        let (length, angle) = away(&hand_at(&query.goal), position, orientation);
        assert!(length <= 1e-5 && angle <= 1e-4, "{length} and {angle} away");
        assert!(query.goal.iter().all(|value| value.abs() <= 2.8));
        // The same again, bit for bit, and several were found.
        assert_eq!(build().query(), problem.query());
        let note = problem.notes().iter().find(|note| note.starts_with("query.goal: ")).unwrap();
        let count: usize = note.split(' ').nth(1).unwrap().parse().unwrap();
        assert!(count >= 1, "{note}");
        most = most.max(count);
    }
    assert!(most > 2, "several configurations have the same pose: {most}");
}

/// Without an orientation any will do, and a wide tolerance is used.
#[test]
fn tolerances_are_what_is_kept() {
    let position = [0.6, 0.6, 0.9];
    let pose = PoseSpec::new("link5", position).position_tolerance(0.05);
    let model = || BodiesSpec::new(SpaceSpec::fixed(), arm());
    let problem = Problem::builder("arm", model()).query([0.0; 6], pose).build().unwrap();
    let (length, _) =
        away(&hand_at(&problem.query().unwrap().goal), position, [1.0, 0.0, 0.0, 0.0]);
    assert!(length <= 0.05, "{length}");
    // Both ends by poses.
    let ends = [[0.8, 0.0, 1.0], [0.0, 0.8, 1.0]].map(|at| PoseSpec::new("link5", at));
    let [first, last] = ends;
    let problem = Problem::builder("arm", model()).query(first, last).build().unwrap();
    for (q, at) in [
        (&problem.query().unwrap().start, [0.8, 0.0, 1.0]),
        (&problem.query().unwrap().goal, [0.0, 0.8, 1.0]),
    ] {
        let (length, _) = away(&hand_at(q), at, [1.0, 0.0, 0.0, 0.0]);
        assert!(length <= 1e-3, "{length}");
    }
    // Where nothing is valid, and where nothing reaches.
    let wall = BodySpec::new(ShapeSpec::Box { size: [0.4; 3] }).at(position);
    let pose = || PoseSpec::new("link5", position);
    let error = Problem::builder("arm", model().obstacle(wall)).query([0.0; 6], pose()).build();
    let error = error.unwrap_err().to_string();
    assert!(error.starts_with("query.goal.pose: `link5` comes to the pose from"), "{error}");
    assert!(
        error.contains("is valid, the last one since link `")
            && error.contains(" collides with obstacles[0]"),
        "{error}"
    );
    let far = PoseSpec::new("link5", [9.0, 0.0, 0.0]);
    let error =
        Problem::builder("arm", model()).query([0.0; 6], far).build().unwrap_err().to_string();
    assert!(
        error.starts_with("query.goal.pose: `link5` comes no nearer to the pose than"),
        "{error}"
    );
}

const SLIDE: &str = "[space]\nmotion = \"fixed\"\n[robot]\nbodies = [{ shape = { box = { size = [0.2, 0.2, 0.2] } } }]\n\
    [[robot.links]]\nname = \"cart\"\nbodies = [{ shape = { box = { size = [0.2, 0.2, 0.2] } } }]\n\
    joint = { kind = { prismatic = { axis = [1, 0, 0], range = [0.5, 3] } } }\n\
    [[robot.links]]\nname = \"arm\"\nbodies = [{ shape = { box = { size = [0.6, 0.1, 0.1] } }, position = [0.4, 0, 0] }]\n\
    joint = { kind = { revolute = { axis = [0, 0, 1], radians = [-1.5, 1.5] } } }\n";

fn parse(text: &str) -> Result<Problem, String> {
    Problem::parse(Path::new("slide.toml"), text).map_err(|error| error.to_string())
}

#[test]
fn poses_of_problem_files_name_their_line_and_key() {
    let with = |goal: &str| parse(&format!("{SLIDE}[query]\nstart = [1, 0]\ngoal = {goal}\n"));
    let problem = with("{ pose = { link = \"arm\", position = [2, 0, 0] } }").unwrap();
    assert!((problem.query().unwrap().goal[0] - 2.0).abs() < 1e-3);
    for (goal, expected) in [
        (
            "{ pose = { link = \"leg\", position = [2, 0, 0] } }",
            "slide.toml:15: query.goal.pose.link: `leg` found",
        ),
        (
            "{ pose = { link = \"arm\", position = [nan, 0, 0] } }",
            "query.goal.pose.position: [NaN, 0.0, 0.0] found",
        ),
        (
            "{ pose = { link = \"arm\", position = [2, 0, 0], orientation = [0, 0, 0, 0] } }",
            "query.goal.pose.orientation: ",
        ),
        (
            "{ pose = { link = \"arm\", position = [2, 0, 0], position_tolerance = 0 } }",
            "query.goal.pose.position_tolerance: 0 found",
        ),
        (
            "{ pose = { link = \"arm\", position = [2, 0, 0], orientation_tolerance = -1 } }",
            "query.goal.pose.orientation_tolerance: -1",
        ),
        ("{ pose = { link = \"arm\" } }", "slide.toml:15: missing field `position`"),
        (
            "{ pose = { link = \"arm\", position = [2, 0, 0], rotation = 1 } }",
            "slide.toml:15: unknown field `rotation`",
        ),
        (
            "{ pose = { link = \"arm\", position = [2, 0, 0] }, cart = 1 }",
            "slide.toml:15: `pose` found beside others",
        ),
        (
            "{ cart = { link = \"arm\", position = [2, 0, 0] }, arm = 1 }",
            "slide.toml:15: `cart` = { … } found; a number expected",
        ),
    ] {
        let error = with(goal).unwrap_err();
        assert!(error.contains(expected), "{goal}: {error}");
    }
    let error = parse(
        "[landscape]\nmin = [-1, -1]\nmax = [1, 1]\nenergy = { muller-brown = {} }\n[query]\nstart = [0, 0]\ngoal = { pose = { link = \"arm\", position = [2, 0, 0] } }\n",
    );
    assert!(
        error
            .unwrap_err()
            .contains("query.goal.pose.link: `arm` found, but the model has no links")
    );
}

/// A query may have several goals: a list of configurations, or all of those that are found at a pose.
#[test]
fn several_goals_are_listed_or_found_at_a_pose() {
    let with = |goal: &str| parse(&format!("{SLIDE}[query]\nstart = [1, 0]\ngoal = {goal}\n"));
    let goals = |problem: &Problem| {
        problem.query().unwrap().goals().map(<[f64]>::to_vec).collect::<Vec<_>>()
    };
    let one = with("[2, 0]").unwrap();
    assert_eq!(with("[[2, 0]]").unwrap().query(), one.query());
    assert_eq!(with("[[2, 0], [2, 0]]").unwrap().query(), one.query());
    let several = with("[[2, 0], { cart = 2.5, arm = 0.5 }, [1, 1]]").unwrap();
    assert_eq!(goals(&several), [vec![2.0, 0.0], vec![2.5, 0.5], vec![1.0, 1.0]]);
    // Only growing sets read the query, and here they do.
    assert_ne!(several.digest(), one.digest());
    let again = parse(&several.to_toml("meshes").text).unwrap();
    assert_eq!((again.query(), again.digest()), (several.query(), several.digest()));
    assert_eq!(several.to_builder().build().unwrap().query(), several.query());
    let (layout, bytes) = several.to_bytes();
    assert_eq!(Problem::from_bytes(layout, &bytes).unwrap(), several);
    let told = several.describe();
    assert!(told.contains("goal 2 of 3      [2.5, 0.5]"), "{told}");
    let ends = several.query().unwrap();
    assert_eq!(ends.goal_number([&[1.0, 0.0][..], &[2.5, 0.5]]), Some(2));
    assert_eq!(one.query().unwrap().goal_number([&[2.0, 0.0][..]]), None);

    // An arm of six joints reaches a pose in several ways. The nearest is the first that a pose alone takes.
    let asked = |all: bool| {
        let pose = PoseSpec::new("link5", [0.9, 0.2, 0.9]);
        let pose = if all { pose.all() } else { pose };
        Problem::builder("arm", BodiesSpec::new(SpaceSpec::fixed(), arm()))
            .query([0.0, 0.3, 0.4, 0.1, 0.2, 0.0], pose)
            .build()
            .unwrap_or_else(|error| panic!("{error}"))
    };
    let (nearest, all) = (asked(false), asked(true));
    assert!(goals(&all).len() > 1 && goals(&all).contains(&goals(&nearest)[0]));
    for goal in goals(&all) {
        let (length, _) = away(&hand_at(&goal), [0.9, 0.2, 0.9], [1.0, 0.0, 0.0, 0.0]);
        assert!(length < 1e-3, "{length}");
    }
    assert!(all.describe().contains("starts; all are goals"));

    let different: Vec<String> =
        (0..101).map(|i| format!("[{}, 0]", 1.0 + f64::from(i) / 100.0)).collect();
    for (goal, expected) in [
        ("[[2, 0], [9, 0]]", "slide.toml:15: query.goal[1]: "),
        ("[[2, 0], 1]", "slide.toml:15: numbers beside configurations found"),
        ("[[2, 0], [[1, 0]]]", "slide.toml:15: "),
        ("[]", "query.goal: 0 values found, 2 expected"),
        ("[\"home\", [1, 0]]", "query.goal[0]: `home` found; the name of a state expected"),
        (
            &format!("[{}]", different.join(", ")),
            "query.goal: 101 goals found; at most 100 expected",
        ),
        (
            "[[2, 0], [1, 1]]\n[[evaluators]]\nmax-flow = { flow = 1 }",
            "the max-flow evaluator found beside several goals; one goal expected",
        ),
    ] {
        let error = with(goal).unwrap_err();
        assert!(error.contains(expected), "{goal}: {error}");
    }
    let pose = "{ pose = { link = \"arm\", position = [2, 0, 0], all = true } }";
    let error = parse(&format!("{SLIDE}[query]\nstart = {pose}\ngoal = [1, 0]\n")).unwrap_err();
    assert!(error.contains("slide.toml:14: query.start.pose.all: true found"), "{error}");
}

#[test]
fn attached_bodies_move_with_their_link_and_are_tested() {
    let attach = "[[robot.attach]]\nname = \"rod\"\nlink = \"arm\"\nbodies = [{ shape = { box = { size = [0.1, 2, 0.1] } }, position = [0.17, 0, 0] }]\n";
    let problem = parse(&format!("{SLIDE}{attach}")).unwrap_or_else(|error| panic!("{error}"));
    let robot = problem.model().bodies().unwrap().robot();
    assert_eq!(problem.space().len(), 2);
    let pairs: Vec<_> = robot.self_pairs().collect();
    // The rod is no neighbour of what the arm's neighbours are: it must touch neither the base nor the cart.
    assert_eq!(pairs, [(0, 2), (0, 3), (1, 3)]);
    let valid = |q: [f64; 2]| {
        let cx = problem.context();
        cx.accept(&mut q.to_vec()).is_ok()
    };
    assert!(valid([0.5, 0.0]));
    // Turned by an eighth, the rod meets a corner of the cart, which the arm may touch.
    let alone = parse(SLIDE).unwrap();
    assert!(alone.context().accept(&mut [0.5, 0.785]).is_ok());
    assert!(!valid([0.5, 0.785]));
    // It is written out and read again to the bit.
    let again = parse(&problem.to_toml("meshes").text).unwrap();
    assert_eq!(again.digest(), problem.digest());
    assert_eq!(problem.to_builder().build().unwrap().digest(), problem.digest());
    let spec =
        AttachSpec::new("rod", "link5").body(BodySpec::new(ShapeSpec::Sphere { radius: 0.1 }));
    let problem =
        Problem::builder("arm", BodiesSpec::new(SpaceSpec::fixed(), arm().attach(spec))).build();
    assert_eq!(problem.unwrap().model().bodies().unwrap().robot().links.len(), 8);
    for (from, to, expected) in [
        (
            "name = \"rod\"",
            "name = \"arm\"",
            "slide.toml:14: robot.attach[0].name: `arm` found; a name of its own",
        ),
        (
            "link = \"arm\"",
            "link = \"leg\"",
            "robot.attach[0].link: `leg` found; the name of a link",
        ),
        (
            "size = [0.1, 2, 0.1]",
            "size = [0.1, 0, 0.1]",
            "robot.attach[0].bodies[0].shape: size = 0 found",
        ),
        ("bodies =", "body =", "unknown field `body`"),
    ] {
        let error = parse(&format!("{SLIDE}{}", attach.replacen(from, to, 1))).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn padding_is_read_written_and_part_of_the_digest() {
    let wall = "[[obstacles]]\nshape = { box = { size = [0.2, 2, 2] } }\nposition = [4, 0, 0]\n";
    let with = |padding: &str| {
        parse(&format!("{}{wall}", SLIDE.replace("[robot]\n", &format!("[robot]\n{padding}\n"))))
    };
    let lengths = |problem: &Problem| {
        let robot = problem.model().bodies().unwrap().robot().clone();
        (0..robot.links.len()).map(|link| robot.padding_of(link)).collect::<Vec<f64>>()
    };
    let bare = with("").unwrap();
    for (padding, expected) in [
        ("padding = 0.25", [0.25; 3]),
        ("padding = { arm = 0.5 }", [0.0, 0.0, 0.5]),
        ("padding = { \"*\" = 0.125, arm = 0 }", [0.125, 0.125, 0.0]),
    ] {
        let problem = with(padding).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(lengths(&problem), expected, "{padding}");
        assert_ne!(problem.digest(), bare.digest());
        let again = parse(&problem.to_toml("meshes").text).unwrap();
        assert_eq!((again.digest(), lengths(&again)), (problem.digest(), expected.to_vec()));
        assert_eq!(problem.to_builder().build().unwrap().digest(), problem.digest());
        let (layout, bytes) = problem.to_bytes();
        assert_eq!(Problem::from_bytes(layout, &bytes).unwrap(), problem);
        let told = problem.describe();
        assert!(told.contains("(padding)") && !bare.describe().contains("(padding)"), "{told}");
    }
    // No padding at all is none.
    for padding in ["padding = 0", "padding = {}", "padding = { arm = -0.0 }"] {
        assert_eq!(with(padding).unwrap().digest(), bare.digest(), "{padding}");
    }
    // The arm reaches 0.7 from the cart's middle, and the wall begins at 3.9: valid up to 3.2, with padding up to 2.95.
    let padded = with("padding = { arm = 0.25 }").unwrap();
    let valid = |problem: &Problem, cart: f64| problem.context().accept(&mut [cart, 0.0]).is_ok();
    assert!(valid(&bare, 2.96) && !valid(&padded, 2.96) && valid(&padded, 2.94));
    let error = padded.context().accept(&mut [2.96, 0.0]).unwrap_err();
    assert!(
        error.contains("link `arm` with its padding of 0.250 collides with obstacles[0]"),
        "{error}"
    );
    let robot = arm().padding(0.25).padding_of("link5", 0.5);
    let problem = Problem::builder("arm", BodiesSpec::new(SpaceSpec::fixed(), robot));
    let problem = problem.build().unwrap();
    assert_eq!(lengths(&problem), [0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.5]);
    for (padding, expected) in [
        ("padding = -1", "slide.toml:4: robot.padding: -1 found; a length from 0 to"),
        ("padding = { arm = nan }", "slide.toml:4: robot.padding.arm: NaN found; a length"),
        (
            "padding = { leg = 1 }",
            "slide.toml:4: robot.padding.leg: `leg` found; the name of a link, or \"*\" for all others",
        ),
        ("padding = \"wide\"", "slide.toml:4: expected a length, or a table of links"),
    ] {
        let error = with(padding).unwrap_err();
        assert!(error.contains(expected), "{padding}: {error}");
    }
}

#[test]
fn links_that_always_or_never_touch_are_found_by_drawing() {
    // A stub on the arm that lies in the cart whatever the joints do, by way of a link between.
    let stub = "[[robot.links]]\nname = \"mount\"\nbodies = [{ shape = { sphere = { radius = 0.01 } } }]\n\
        joint = { kind = { revolute = { axis = [0, 0, 1], radians = [-1, 1] } } }\n\
        [[robot.links]]\nname = \"stub\"\nbodies = [{ shape = { sphere = { radius = 0.02 } } }]\n\
        joint = { kind = { revolute = { axis = [0, 1, 0], radians = [-1, 1] } } }\n";
    let problem = parse(&format!("{SLIDE}{stub}")).unwrap();
    let lines = problem.model().bodies().unwrap().may_touch_lines(500, 7);
    assert_eq!(lines, problem.model().bodies().unwrap().may_touch_lines(500, 7));
    let (always, never) = lines.split_once("touch in none").expect("two lists");
    for pair in ["[\"cart\", \"mount\"]", "[\"cart\", \"stub\"]"] {
        assert!(always.contains(pair), "{lines}");
    }
    assert!(
        never.contains("[\"base\", \"mount\"]") && never.contains("[\"base\", \"stub\"]"),
        "{lines}"
    );
    // The lines are those of a problem file, and with them something is valid.
    let free = SLIDE.replace("[robot]\n", &format!("[robot]\n{lines}"));
    let free = parse(&format!("{free}{stub}")).unwrap_or_else(|error| panic!("{error}\n{lines}"));
    assert!(problem.context().accept(&mut [2.0, 0.0, 0.0, 0.0]).is_err());
    assert!(free.context().accept(&mut [2.0, 0.0, 0.0, 0.0]).is_ok());
}
