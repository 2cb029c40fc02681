//! Robots as MoveIt has them: groups, named states, pairs that may touch and virtual joints of an SRDF, joints that
//! follow others, locked joints, and ends by name.

use roadmill::Build;
use roadmill::math;
use roadmill::model::SceneOptions;
use roadmill::model::bodies::foreign::read_srdf;
use roadmill::model::bodies::robot::{JointKind, Limits, Robot};
use roadmill::model::bodies::{BodiesSpec, RobotSpec, SpaceSpec};
use roadmill::problem::{ConfigurationSpec, Problem, configuration};
use roadmill::space::BaseJoint;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Two arms of two joints on a post, and on the left one a hand whose second finger follows the first.
const URDF: &str = r#"<robot name="two arms">
  <link name="post"><collision><geometry><box size="0.2 0.2 1"/></geometry></collision></link>
  <link name="left upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="left_lower"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="right_upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="right_lower"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="palm"><collision><geometry><box size="0.1 0.2 0.1"/></geometry></collision></link>
  <link name="finger"><collision><geometry><box size="0.2 0.02 0.02"/></geometry></collision></link>
  <link name="thumb"><collision><geometry><box size="0.2 0.02 0.02"/></geometry></collision></link>
  <joint name="left shoulder" type="revolute"><parent link="post"/><child link="left upper"/><origin xyz="0 0.5 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="left_elbow" type="revolute"><parent link="left upper"/><child link="left_lower"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="0.5" upper="2" effort="1" velocity="1"/></joint>
  <joint name="right_shoulder" type="continuous"><parent link="post"/><child link="right_upper"/><origin xyz="0 -0.5 0"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="right_elbow" type="revolute"><parent link="right_upper"/><child link="right_lower"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="fixed"><parent link="left_lower"/><child link="palm"/><origin xyz="1 0 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="palm"/><child link="finger"/><origin xyz="0.2 0.1 0"/>
    <axis xyz="0 1 0"/><limit lower="-0.05" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="opposite" type="prismatic"><parent link="palm"/><child link="thumb"/><origin xyz="0.2 -0.1 0"/>
    <axis xyz="0 1 0"/><limit lower="-0.08" upper="0.1" effort="1" velocity="1"/>
    <mimic joint="grip" multiplier="-1"/></joint>
</robot>
"#;
const SRDF: &str = r#"<?xml version="1.0"?>
<!-- The second line is a comment. -->
<robot name="two arms">
  <virtual_joint name="world" type="floating" parent_frame="odom" child_link="post"/>
  <group name="left"><chain base_link="post" tip_link="palm"/></group>
  <group name="right"><joint name="right_shoulder"/><link name="right_lower"/></group>
  <group name="hand"><joint name="grip"/><joint name="opposite"/><joint name="lost"/></group>
  <group name="left and hand"><group name="left"/><group name="hand"/></group>
  <group name="flying"><joint name="world"/><group name="left"/></group>
  <group_state name="home" group="left">
    <joint name="left shoulder" value="0.25"/><joint name="left_elbow" value="0.75"/>
  </group_state>
  <group_state name="home" group="right">
    <joint name="right_shoulder" value="3"/><joint name="right_elbow" value="-2.5"/>
  </group_state>
  <group_state name="open" group="hand"><joint name="grip" value="0.05"/></group_state>
  <group_state name="folded"><joint name="left shoulder" value="1"/><joint name="left_elbow" value="2"/></group_state>
  <end_effector name="gripper" parent_link="palm" group="hand"/>
  <disable_collisions link1="palm" link2="left upper" reason="Never"/>
  <disable_collisions link1="left upper" link2="palm" reason="Never"/>
  <disable_collisions link1="palm" link2="camera" reason="Never"/>
  <gripper name="other programs'"/>
</robot>
"#;

fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("arms.urdf"), URDF).unwrap();
    fs::write(folder.path().join("arms.srdf"), SRDF).unwrap();
    let path = folder.path().to_owned();
    (folder, path)
}

fn parse(folder: &Path, text: &str) -> Result<Problem, String> {
    Problem::parse(&folder.join("arms.toml"), text).map_err(|error| error.to_string())
}

fn names(problem: &Problem) -> Vec<String> {
    problem.space().dofs().iter().map(|dof| dof.name.clone()).collect()
}

fn robot(problem: &Problem) -> &Robot {
    problem.model().bodies().expect("bodies").robot()
}

fn link(robot: &Robot, name: &str) -> usize {
    robot.links.iter().position(|link| link.name == name).expect(name)
}

const LEFT: &str = "[robot]\nurdf = \"arms.urdf\"\nsrdf = \"arms.srdf\"\ngroup = \"left\"\n";

#[test]
fn a_group_moves_and_the_rest_is_locked() {
    let (_keep, folder) = folder();
    let problem = parse(&folder, LEFT).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(names(&problem), ["left-shoulder", "left_elbow"]);
    let robot_of_left = robot(&problem);
    let kind = |name: &str| {
        robot_of_left.links[link(robot_of_left, name)].joint.as_ref().map(|joint| joint.kind)
    };
    for name in ["right_upper", "right_lower", "finger", "thumb"] {
        assert_eq!(kind(name), Some(JointKind::Locked), "{name}");
    }
    assert_eq!(kind("palm"), Some(JointKind::Fixed));
    // The base of a group that is not moved by the virtual joint stands still, and needs no bounds.
    assert_eq!(robot_of_left.motion, BaseJoint::Fixed);
    let bounds = problem.model().bodies().unwrap().bounds();
    assert_eq!(bounds.max, [robot_of_left.reach(); 3]);
    // Within the group's own arm and against the other arm all is tested but neighbours and what the SRDF names.
    let pairs: Vec<(usize, usize)> = robot_of_left.self_pairs().collect();
    let at = |one: &str, other: &str| {
        let (one, other) = (link(robot_of_left, one), link(robot_of_left, other));
        pairs.contains(&(one.min(other), one.max(other)))
    };
    for (one, other) in [
        ("left_lower", "right_upper"),
        ("left-upper", "right_lower"),
        ("left_lower", "post"),
        ("finger", "post"),
        ("thumb", "left-upper"),
    ] {
        assert!(at(one, other), "{one} and {other} are tested");
    }
    for (one, other) in [
        ("palm", "left-upper"),
        ("finger", "thumb"),
        ("right_lower", "post"),
        ("post", "left-upper"),
    ] {
        assert!(!at(one, other), "{one} and {other} are not tested");
    }
    let told = problem.describe();
    assert!(told.contains("1 pairs of links may touch; 1 more name links"), "{told}");
    assert!(told.contains("right_shoulder = 0, right_elbow = 0, grip = 0"), "{told}");
}

/// The pose of a hand needs no link where the SRDF names one end effector of the group.
#[test]
fn a_pose_without_a_link_is_that_of_the_end_effector() {
    let (_keep, folder) = folder();
    let path = folder.join("arms.srdf");
    let goal = |group: &str| {
        let robot = match group {
            // The virtual joint would move the base.
            "" => {
                format!("[space]\nmotion = \"fixed\"\n{}", LEFT.replace("group = \"left\"\n", ""))
            }
            _ => LEFT.replace("group = \"left\"", group),
        };
        let ends = "start = { state = \"left/home\", grip = 0, right_shoulder = 0, right_elbow = 0 }\n\
            goal = { pose = { position = [1.6, 1.2, 0.0], position_tolerance = 0.01 } }\n";
        let ends = if group.contains("left") {
            ends.replace(", grip = 0, right_shoulder = 0, right_elbow = 0", "")
        } else {
            ends.to_owned()
        };
        parse(&folder, &format!("{robot}[query]\n{ends}"))
    };
    let place = |problem: &Problem| {
        let (robot, mut poses) = (robot(problem), Vec::new());
        robot.link_poses(&problem.query().expect("a query").goal, &mut poses);
        poses[link(robot, "palm")].translation
    };
    for group in ["group = \"left\"", ""] {
        let problem = goal(group).unwrap_or_else(|error| panic!("{error}"));
        let [x, y, z] = place(&problem);
        let (dx, dy) = (x - 1.6, y - 1.2);
        assert!((dx * dx + dy * dy + z * z).sqrt() <= 0.01, "{x} {y} {z}");
        assert!(problem.describe().contains("at which `palm` is within"));
    }
    // Of another group: since its joints do not move the palm, or by the file's word.
    let right = "group = \"right\"";
    let start = "start = { right_shoulder = 0, right_elbow = 0 }\n";
    let pose = "goal = { pose = { position = [1, 0, 0] } }\n";
    let of_right = LEFT.replace("group = \"left\"", right);
    let error = parse(&folder, &format!("{of_right}[query]\n{start}{pose}")).unwrap_err();
    assert!(
        error.contains("arms.toml:7: query.goal.pose: no link found; the name of one expected"),
        "{error}"
    );
    let hand = "<end_effector name=\"gripper\" parent_link=\"palm\" group=\"hand\"";
    fs::write(&path, SRDF.replace(hand, &format!("{hand} parent_group=\"right\""))).unwrap();
    let error = goal("group = \"left\"").unwrap_err();
    assert!(error.contains("query.goal.pose: no link found"), "{error}");
    // Two of them: neither is meant more than the other.
    let two =
        format!("<end_effector name=\"tool\" parent_link=\"left_lower\" group=\"hand\"/>{hand}");
    fs::write(&path, SRDF.replace(hand, &two)).unwrap();
    let error = goal("group = \"left\"").unwrap_err();
    let expected = "one of several expected: `left_lower` of the end effector `tool`, `palm` of the end effector `gripper`";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn groups_are_joints_links_chains_and_groups() {
    let (_keep, folder) = folder();
    for (group, expected) in [
        ("left", vec!["left-shoulder", "left_elbow"]),
        ("right", vec!["right_shoulder", "right_elbow"]),
        ("hand", vec!["grip"]),
        ("left and hand", vec!["left-shoulder", "left_elbow", "grip"]),
    ] {
        let text = LEFT.replace("\"left\"", &format!("\"{group}\""));
        let problem = parse(&folder, &text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(names(&problem), expected, "{group}");
    }
    // The thumb is no joint of its own. It narrows the grip, which may close by 0.05 and open by 0.08.
    let text = LEFT.replace("\"left\"", "\"hand\"");
    let problem = parse(&folder, &text).unwrap();
    let robot_of_hand = robot(&problem);
    let joint = |name: &str| robot_of_hand.links[link(robot_of_hand, name)].joint.clone().unwrap();
    let limits = Limits { min: -0.05, max: 0.08 };
    assert_eq!(joint("finger").kind, JointKind::Prismatic { axis: [0.0, 1.0, 0.0], limits });
    let mut poses = Vec::new();
    for value in [-0.05, 0.0, 0.08] {
        robot_of_hand.link_poses(&[value], &mut poses);
        let at = |name: &str| poses[link(robot_of_hand, name)].translation;
        let palm = at("palm");
        let gap = [0, 1, 2].map(|i| at("finger")[i] - at("thumb")[i]);
        let length = gap.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - (0.2 + 2.0 * value)).abs() < 1e-12, "{value}: {palm:?}, {gap:?}");
    }
    // With the virtual joint the base moves, and needs bounds.
    let flying = LEFT.replace("\"left\"", "\"flying\"");
    let error = parse(&folder, &flying).unwrap_err();
    assert!(
        error.ends_with("space: no min found; 3 lengths expected, as the base moves"),
        "{error}"
    );
    let bounds = "[space]\nmin = [0, 0, 0]\nmax = [9, 9, 9]\nbounds = \"reference\"\n";
    let problem = parse(&folder, &format!("{bounds}{flying}")).unwrap();
    assert_eq!(robot(&problem).motion, BaseJoint::Rigid3d);
    let fixed = parse(&folder, &format!("[space]\nmotion = \"fixed\"\n{flying}")).unwrap();
    assert_eq!(names(&fixed), ["left-shoulder", "left_elbow"]);
}

#[test]
fn joints_rest_and_are_locked_where_it_says() {
    let (_keep, folder) = folder();
    let text =
        format!("{LEFT}rest = [\"right/home\", \"open\"]\nlock = {{ \"left shoulder\" = 0.5 }}\n");
    let problem = parse(&folder, &text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(names(&problem), ["left_elbow"]);
    let told = problem.describe();
    // The state asks for less than the least.
    assert!(told.contains("joint `right_elbow` rests at -2 instead of -2.5, its limit"), "{told}");
    let free = parse(&folder, "[robot]\nurdf = \"arms.urdf\"\n").unwrap();
    assert_eq!(names(&free).len(), 5);
    let (mut there, mut expected) = (Vec::new(), Vec::new());
    robot(&problem).link_poses(&[0.75], &mut there);
    robot(&free).link_poses(&[0.5, 3.0, 0.75, -2.0, 0.05], &mut expected);
    for (one, other) in there.iter().zip(&expected) {
        let between = one.to_parry().inv_mul(&other.to_parry());
        assert!(between.translation.length() < 1e-12);
        assert!((between.rotation.w.abs() - 1.0).abs() < 1e-12);
    }
    for (lines, expected) in [
        (
            "lock = { elbow = 0 }",
            "arms.toml:5: robot.lock.elbow: `elbow` found; the name of a joint",
        ),
        (
            "lock = { left_elbow = 0.25 }",
            "arms.toml:5: robot.lock.left_elbow: 0.25 found; a value from 0.5 to 2",
        ),
        (
            "lock = { right_shoulder = nan }",
            "arms.toml:5: robot.lock.right_shoulder: NaN found; a value",
        ),
        ("lock = { wrist = 0 }", "arms.toml:5: robot.lock.wrist: a joint that does not move found"),
        (
            "lock = { opposite = 0 }",
            "arms.toml:5: robot.lock.opposite: a joint that follows another found",
        ),
        ("lock = { left_elbow = 1, \"left shoulder\" = 1 }", "robot: nothing moves"),
        (
            "rest = [\"closed\"]",
            "arms.toml:5: robot.rest[0]: `closed` found; the name of a state expected: left/home, right/home, hand/open, folded",
        ),
    ] {
        let error = parse(&folder, &format!("{LEFT}{lines}\n")).unwrap_err();
        assert!(error.contains(expected), "{lines}: {error}");
    }
}

#[test]
fn ends_are_named_by_joints_and_states() {
    let (_keep, folder) = folder();
    let with = |start: &str, goal: &str| {
        parse(&folder, &format!("{LEFT}[query]\nstart = {start}\ngoal = {goal}\n"))
    };
    let problem = with("\"home\"", "{ left_elbow = 2, \"left shoulder\" = -1 }").unwrap();
    let query = problem.query().unwrap();
    assert_eq!((&query.start[..], &query.goal[..]), (&[0.25, 0.75][..], &[-1.0, 2.0][..]));
    let problem = with("\"folded\"", "\"left/home\"").unwrap();
    assert_eq!(problem.query().unwrap().start, [1.0, 2.0]);
    let problem = with("[0, 1]", "{ state = \"left/home\", left-shoulder = 1 }").unwrap();
    let query = problem.query().unwrap();
    assert_eq!((&query.start[..], &query.goal[..]), (&[0.0, 1.0][..], &[1.0, 0.75][..]));
    for (goal, expected) in [
        ("{ left_elbow = 1 }", "arms.toml:7: query.goal: no value of `left-shoulder` found"),
        (
            "\"open\"",
            "arms.toml:7: query.goal: no value of `left-shoulder`, `left_elbow` found; one for each expected, as { state",
        ),
        (
            "\"shut\"",
            "arms.toml:7: query.goal: `shut` found; the name of a state expected: left/home",
        ),
        ("{ state = \"shut\", left_elbow = 1 }", "arms.toml:7: query.goal.state: `shut` found"),
        (
            "{ state = \"home\", grip = 0 }",
            "arms.toml:7: query.goal.grip: `grip` found; one of `left-shoulder`, `left_elbow` expected",
        ),
        (
            "{ left_elbow = \"home\" }",
            "arms.toml:7: `left_elbow` = \"home\" found; a number expected",
        ),
        ("{ left_elbow = [1] }", "arms.toml:7: invalid type: sequence, expected a number"),
        ("[0, \"a\"]", "arms.toml:7: numbers beside configurations found; either"),
        (
            "true",
            "arms.toml:7: invalid type: boolean `true`, expected an array of numbers, the name of a state",
        ),
        ("{ left_elbow = 3, \"left shoulder\" = 0 }", "arms.toml:7: query.goal: "),
    ] {
        let error = with("\"home\"", goal).unwrap_err();
        assert!(error.contains(expected), "{goal}: {error}");
    }
    let cx = problem.context();
    let named = configuration(&cx, "left_elbow=0.75, left-shoulder=0.25");
    assert_eq!(named, configuration(&cx, "0.25 0.75"));
    for (text, expected) in [
        ("left_elbow=1", "no value of `left-shoulder` found"),
        ("left_elbow=1 0", "0 found without a name"),
        ("left_elbow=1 left_elbow=1", "`left_elbow` found twice"),
        ("elbow=1 left_elbow=1", "`elbow` found"),
        ("left_elbow=a", "`a` found, a number expected"),
    ] {
        assert!(configuration(&cx, text).unwrap_err().contains(expected), "{text}");
    }
}

/// One file and one command: a group goes from one state to another, and the whole program takes part.
#[test]
fn a_group_is_planned_for_and_written_out() {
    let (_keep, folder) = folder();
    let text = "[robot]\nurdf = \"arms.urdf\"\nsrdf = \"arms.srdf\"\ngroup = \"left and hand\"\nrest = [\"right/home\"]\n\
                [query]\nstart = { state = \"left/home\", grip = 0 }\ngoal = { left-shoulder = -0.5, left_elbow = 1.5, grip = 0.05 }\n";
    let problem = parse(&folder, text).unwrap_or_else(|error| panic!("{error}"));
    let built = Build::new(problem.clone()).run().unwrap();
    assert!(built.path().is_some());
    // Written as a problem file of our own it is the same to the bit, with all that the files said.
    let written = problem.to_toml("meshes");
    let again =
        parse(&folder, &written.text).unwrap_or_else(|error| panic!("{error}\n{}", written.text));
    assert_eq!((again.digest(), again.query()), (problem.digest(), problem.query()));
    assert!(written.text.contains("kind = { locked = {} }"), "{}", written.text);
    assert!(
        written.text.contains("mimic = { link = \"finger\", multiplier = -1.0, offset = 0.0 }")
    );
    // And so by way of values.
    assert_eq!(problem.to_builder().build().unwrap().digest(), problem.digest());
    let spec =
        RobotSpec::urdf("arms.urdf").srdf("arms.srdf").group("left and hand").rest("right/home");
    let by_values = Problem::builder("arms", BodiesSpec::new(SpaceSpec::fixed(), spec))
        .folder(&folder)
        .query(
            ConfigurationSpec::Named {
                state: Some("left/home".to_owned()),
                values: [("grip".to_owned(), 0.0)].into(),
            },
            [("left-shoulder", -0.5), ("left_elbow", 1.5), ("grip", 0.05)],
        )
        .build()
        .unwrap();
    assert_eq!((by_values.digest(), by_values.query()), (problem.digest(), problem.query()));
}

#[test]
fn a_robot_alone_takes_an_srdf_and_a_group() {
    let (_keep, folder) = folder();
    let (urdf, srdf) = (folder.join("arms.urdf"), folder.join("arms.srdf"));
    let load = |options: &SceneOptions| {
        Problem::load_with(&urdf, options, &roadmill::generator::NoRuns).map_err(|e| e.to_string())
    };
    let with = SceneOptions { srdf: Some(&srdf), ..SceneOptions::default() };
    let problem = load(&SceneOptions { group: Some("right"), ..with }).unwrap();
    assert_eq!(names(&problem), ["right_shoulder", "right_elbow"]);
    // Without a group all joints move, the virtual one, too.
    assert_eq!(names(&load(&with).unwrap()).len(), 7 + 5);
    assert_eq!(names(&load(&SceneOptions::default()).unwrap()).len(), 5);
    let error = load(&SceneOptions { group: Some("arm"), ..with }).unwrap_err();
    let expected =
        "--group: `arm` found; a group of the SRDF expected: left, right, hand, left and hand";
    assert!(error.contains(expected), "{error}");
    let error = load(&SceneOptions { group: Some("left"), ..SceneOptions::default() }).unwrap_err();
    assert!(error.contains("--group: `left` found without an SRDF"), "{error}");
    let toml = folder.join("arms.toml");
    fs::write(&toml, LEFT).unwrap();
    let error = Problem::load_with(&toml, &with, &roadmill::generator::NoRuns).unwrap_err();
    assert!(error.to_string().contains("--srdf found; a problem file"), "{error}");
}

/// Groups that list another twice each, and groups far within one another: neither takes long, and no depth ends the process.
#[test]
fn groups_within_groups_take_no_long_time() {
    let (_keep, folder) = folder();
    let nested = |depth: usize| {
        let group = |at: usize| {
            let inner = format!("<group name=\"g{}\"/>", at + 1);
            format!("<group name=\"g{at}\">{inner}{inner}</group>")
        };
        let groups: String = (0..depth).map(group).collect();
        let last = format!("<group name=\"g{depth}\"><joint name=\"grip\"/></group>");
        fs::write(folder.join("arms.srdf"), format!("<robot>{groups}{last}</robot>")).unwrap();
        parse(&folder, &LEFT.replace("\"left\"", "\"g0\""))
    };
    assert_eq!(names(&nested(40).expect("few enough")), ["grip"]);
    let error = nested(50_000).unwrap_err();
    assert!(error.contains("`g64` found within 64 groups"), "{error}");
}

#[test]
fn errors_name_file_line_and_key() {
    let (_keep, folder) = folder();
    let path = folder.join("arms.srdf");
    for (from, to, expected) in [
        ("<robot", "<model", "arms.srdf:23: not an SRDF"),
        (
            "value=\"0.25\"",
            "value=\"much\"",
            "arms.srdf:11: value = `much` found; finite numbers expected",
        ),
        ("value=\"0.25\"", "value=\"inf\"", "arms.srdf:11: value = `inf` found"),
        ("value=\"0.25\"", "", "arms.srdf:11: <joint> without `value` found"),
        ("link2=\"camera\"", "", "arms.srdf:21: <disable_collisions> without `link2` found"),
        ("type=\"floating\"", "type=\"flying\"", "arms.srdf:4: type = `flying` found"),
        (
            "<group name=\"right\">",
            "<group name=\"left\">",
            "arms.srdf:6: a second group `left` found",
        ),
        ("base_link=\"post\"", "base=\"post\"", "arms.srdf:5: <chain> without `base_link` found"),
        (
            "base_link=\"post\" tip_link=\"palm\"",
            "base_link=\"palm\" tip_link=\"post\"",
            "arms.srdf:5: group `left`: a chain from `palm` to `post` found",
        ),
        (
            "<chain base_link=\"post\" tip_link=\"palm\"/>",
            "<group name=\"left and hand\"/>",
            "arms.srdf:8: group `left and hand`: `left` found within itself",
        ),
        (
            "<robot name",
            "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:macro/></robot><robot name",
            "arms.srdf:3: ",
        ),
        (
            "<chain base_link=\"post\" tip_link=\"palm\"/>",
            "",
            "robot.group: `left` found, a group without a joint that moves",
        ),
        (
            "tip_link=\"palm\"",
            "tip_link=\"plam\"",
            "arms.srdf: group `left`: tip link `plam` (line 5) left out, which the robot does not have)",
        ),
        (
            "base_link=\"post\"",
            "base_link=\"pots\"",
            "arms.srdf: group `left`: base link `pots` (line 5) left out",
        ),
        ("parent_link=\"palm\"", "", "<end_effector> without `parent_link` found"),
    ] {
        let text = SRDF.replacen(from, to, 1);
        assert_ne!(text, SRDF, "{from}");
        fs::write(&path, text).unwrap();
        let error = parse(&folder, LEFT).map(|_| ()).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
    fs::write(&path, format!("<robot>{}", "<a>".repeat(100_000))).unwrap();
    assert!(read_srdf(&path).is_err());
    fs::write(&path, format!("<robot>{}{}</robot>", "<a>".repeat(100), "</a>".repeat(100)))
        .unwrap();
    let error = read_srdf(&path).unwrap_err().to_string();
    assert!(error.contains("arms.srdf:1: elements nested more than 64 deep"), "{error}");
    fs::remove_file(&path).unwrap();
    let error = parse(&folder, LEFT).unwrap_err();
    assert!(
        error.contains("arms.toml:3: robot.srdf: ") && error.contains("cannot read"),
        "{error}"
    );
    for (text, expected) in [
        (
            "[space]\nmotion = \"fixed\"\n[robot]\nsrdf = \"arms.srdf\"\n",
            "arms.toml:4: robot.srdf: given without urdf",
        ),
        (
            "[robot]\nurdf = \"arms.urdf\"\ngroup = \"left\"\n",
            "arms.toml:3: robot.group: `left` found without an SRDF",
        ),
        ("[robot]\nname = \"a\"\n", "space: no motion found"),
        (
            "[space]\nmotion = \"fixed\"\nmin = [0, 0, 0]\n[robot]\nurdf = \"arms.urdf\"\n",
            "arms.toml:1: space: no max found; 3 lengths expected, or none of",
        ),
        (
            "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [1, 1]\n[robot]\nurdf = \"arms.urdf\"\n",
            "space: no bounds found; \"body\" or \"reference\"",
        ),
    ] {
        let error = parse(&folder, text).unwrap_err();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

/// Joints of problem files follow others and are locked, too.
#[test]
fn joints_of_problem_files_follow_others() {
    let text = "[space]\nmotion = \"fixed\"\n[robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n\
                lock = { spin = 1 }\n\
                [[robot.links]]\nname = \"one\"\nbodies = [{ shape = { sphere = { radius = 0.1 } }, position = [1, 0, 0] }]\n\
                joint = { kind = { revolute = { axis = [0, 0, 1], degrees = [-170, 170] } } }\n\
                [[robot.links]]\nname = \"two\"\nbodies = [{ shape = { sphere = { radius = 0.1 } }, position = [1, 0, 0] }]\n\
                joint = { parent = \"base\", kind = { revolute = { axis = [0, 0, 1] } }, mimic = { link = \"one\", multiplier = -2 } }\n\
                [[robot.links]]\nname = \"three\"\n\
                joint = { name = \"spin\", kind = { revolute = { axis = [0, 0, 1] } } }\n";
    let folder = Path::new("");
    let problem = parse(folder, text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(names(&problem), ["one"]);
    let mut poses = Vec::new();
    robot(&problem).link_poses(&[0.5], &mut poses);
    let [x, y, _] = poses[2].apply([1.0, 0.0, 0.0]);
    assert!((x - math::cos(1.0)).abs() < 1e-12 && (y + math::sin(1.0)).abs() < 1e-12);
    for (from, to, expected) in [
        (
            "link = \"one\"",
            "link = \"none\"",
            "arms.toml:13: robot.links[1].joint.mimic.link: `none` found",
        ),
        (
            "link = \"one\"",
            "link = \"two\"",
            "arms.toml:13: robot.links[1].joint.mimic: it follows itself",
        ),
        ("link = \"one\"", "link = \"base\"", "robot.links[1].joint.mimic: "),
        (
            "multiplier = -2",
            "multiplier = 1e9",
            "robot.links[1].joint.mimic: follows a value of up to",
        ),
        ("multiplier = -2", "factor = -2", "unknown field `factor`"),
        ("multiplier = -2", "multiplier = nan", "robot.links[1].joint.mimic: NaN times"),
        (
            "{ revolute = { axis = [0, 0, 1] } }, mimic",
            "{ prismatic = { axis = [0, 0, 1] } }, mimic",
            "",
        ),
        (
            "kind = { revolute = { axis = [0, 0, 1] } } }\n",
            "kind = { prismatic = { axis = [0, 0, 1] } } }\n",
            "arms.toml:16: robot.links[2].joint.kind: a prismatic joint without range found",
        ),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        let error = parse(folder, &changed).map_or_else(|error| error, |_| String::new());
        assert!(
            error.contains(expected) && expected.is_empty() == error.is_empty(),
            "{to}: {error}"
        );
    }
}
