//! Robots in URDF: where their links stand, what is refused and where, and a problem with one.

use proptest::prelude::*;
use roadmill::img::{Setup, Stop, build_in_threads};
use roadmill::model::bodies::foreign::{ForeignError, read_urdf};
use roadmill::model::bodies::robot::{JointKind, Limits, Link, Mimic, Robot};
use roadmill::problem::Problem;
use roadmill::scene::Shape;
use roadmill::space::BaseJoint;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

const ARM: &str = r#"<?xml version="1.0"?>
<robot name="arm" version="1.2">
  <!-- The file's order is not that of the tree. -->
  <link name="hand">
    <collision><geometry><mesh filename="package://own/meshes/corner.obj" scale="2 -1 1"/></geometry></collision>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="post"><collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
  <link name="upper arm"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="ball"><collision><geometry><capsule radius="0.1" length="0.4"/></geometry></collision></link>
  <joint name="grip" type="fixed"><parent link="upper arm"/><child link="hand"/><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/></joint>
  <joint name="shoulder" type="revolute">
    <parent link="post"/><child link="upper arm"/><origin xyz="0 0 1"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="2"/>
  </joint>
  <joint name="free" type="spherical"><parent link="hand"/><child link="ball"/></joint>
</robot>
"#;
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// A folder of robots with a package's meshes beside it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for name in ["robots/arm", "meshes"] {
        fs::create_dir_all(folder.path().join(name)).expect("a folder");
    }
    fs::write(folder.path().join("meshes/corner.obj"), CORNER).expect("a mesh");
    folder
}

fn read(folder: &Path, bytes: &[u8]) -> Result<(Vec<Link>, Vec<String>), ForeignError> {
    let path = folder.join("robots/arm/arm.urdf");
    fs::write(&path, bytes).expect("a robot");
    read_urdf(&path).map(|robot| (robot.links, robot.notes))
}

fn close(a: [f64; 3], b: [f64; 3]) -> bool {
    (0..3).all(|i| (a[i] - b[i]).abs() < 1e-12)
}

#[test]
fn links_stand_where_their_joints_put_them() {
    let folder = folder();
    let (links, notes) = read(folder.path(), ARM.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<_> = links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["post", "upper arm", "hand", "ball"]);
    let kinds: Vec<_> = links[1..].iter().map(|link| link.joint.as_ref().unwrap().kind).collect();
    let limits = Some(Limits { min: -1.0, max: 2.0 });
    let shoulder = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits };
    assert_eq!(kinds, [shoulder, JointKind::Fixed, JointKind::Spherical]);

    // Scaled 2 −1 1: mirrored in y, and still closed.
    let Shape::Mesh(mesh) = &links[2].bodies[0].shape else { panic!("{:?}", links[2]) };
    assert_eq!(mesh.bounding_box(), ([0.0, -1.0, 0.0], [2.0, 0.0, 1.0]));
    assert!(links[2].bodies[0].solid);
    assert!(notes.iter().any(|note| note.contains("`upper arm` has only shapes to be looked at")));

    let robot = Robot { links, ..Robot::rigid(BaseJoint::Fixed, Vec::new()) };
    let quarter = std::f64::consts::FRAC_PI_2;
    let half = 0.5f64.sqrt();
    let mut poses = Vec::new();
    robot.link_poses(&[quarter, half, half, 0.0, 0.0], &mut poses);
    // The shoulder turns x to y, the grip once more.
    assert!(close(poses[2].apply([0.0; 3]), [0.0, 1.0, 1.0]));
    assert!(close(poses[2].apply([1.0, 0.0, 0.0]), [-1.0, 1.0, 1.0]));
    // The ball, a quarter about x: its z is the hand's −y, which is the world's y.
    assert!(close(poses[3].apply([0.0, 0.0, 1.0]), [0.0, 2.0, 1.0]));
}

#[test]
fn errors_name_file_line_and_joint() {
    let folder = folder();
    let mut wrong = Vec::new();
    for (from, to, expected) in [
        (
            "type=\"revolute\"",
            "type=\"floating\"",
            "arm.urdf:12: joint `shoulder`: type `floating` found",
        ),
        (
            "type=\"revolute\"",
            "type=\"screw\"",
            "arm.urdf:12: joint `shoulder`: type `screw` found",
        ),
        (
            "<axis",
            "<mimic joint=\"x\"/><axis",
            "arm.urdf:13: joint `shoulder`: <mimic>: `x` found; the name of a joint expected",
        ),
        (
            "<axis",
            "\n<mimic joint=\"shoulder\"/><axis",
            "arm.urdf:14: joint `shoulder`: <mimic>: it follows itself",
        ),
        (
            "<axis",
            "<mimic joint=\"free\"/><axis",
            "arm.urdf:13: joint `shoulder`: <mimic>: `free` found; a joint that turns about",
        ),
        ("<axis", "<mimic/><axis", "arm.urdf:13: <mimic> without `joint` found"),
        (
            "<axis",
            "<mimic joint=\"grip\" offset=\"nan\"/><axis",
            "arm.urdf:13: offset = `nan` found; a finite number",
        ),
        ("lower=\"-1\"", "lower=\"3\"", "arm.urdf:14: limits 3 to 2 found"),
        (
            " version=\"1.2\"",
            "",
            "arm.urdf:14: <limit> without `effort` found; effort=\"…\" expected",
        ),
        (
            "upper=\"2\"",
            "upper=\"2\" velocity=\"fast\"",
            "arm.urdf:14: velocity = `fast` found; a number",
        ),
        ("<link name=\"ball\">", "<link>", "arm.urdf:10: <link> without `name` found"),
        ("<parent link=\"post\"/>", "<parent/>", "arm.urdf:13: <parent> without `link` found"),
        ("<parent link=\"post\"/>", "", "arm.urdf:12: <joint> without <parent> found"),
        ("length=\"0.4\"", "", "arm.urdf:10: <capsule> without `length` found"),
        (
            "<geometry><box size=\"1 1 1\"/></geometry>",
            "",
            "arm.urdf:9: <visual> without <geometry> found",
        ),
        (
            "version=\"1.2\">\n",
            "version=\"1.2\">\n<x:include xmlns:x=\"http://www.ros.org/wiki/xacro\"/>\n",
            "arm.urdf:3: <xacro:include> found",
        ),
        (
            "lower=\"-1\" upper=\"2\"",
            "lower=\"-100\" upper=\"2\"",
            "arm.urdf:12: joint `shoulder`: limits -100 to 2",
        ),
        ("lower=\"-1\"", "lower=\"nan\"", "arm.urdf:14: lower = `nan` found"),
        (
            "<limit lower=\"-1\" upper=\"2\"/>",
            "",
            "arm.urdf:12: joint `shoulder`: type `revolute` without <limit> found; <limit lower=\"…\" upper=\"…\"/>, or the type continuous,",
        ),
        (
            "type=\"spherical\">",
            "type=\"prismatic\">",
            "arm.urdf:16: joint `free`: type `prismatic` without <limit> found; <limit lower=\"…\" upper=\"…\"/> expected",
        ),
        ("xyz=\"0 0 2\"", "xyz=\"0 0 0\"", "arm.urdf:12: joint `shoulder`: axis [0.0, 0.0, 0.0]"),
        ("xyz=\"0 0 2\"", "xyz=\"0 0 x 2\"", "arm.urdf:13: xyz = `0 0 x 2` found; three"),
        ("rpy=\"0 0 1.5707963267948966\"", "quat_xyzw=\"0 0 0 1\"", "arm.urdf:11: quat_xyzw found"),
        (
            "<parent link=\"post\"/>",
            "<parent link=\"pst\"/>",
            "arm.urdf:12: joint `shoulder`: there is no link `pst`",
        ),
        (
            "<child link=\"ball\"/>",
            "<child link=\"hand\"/>",
            "arm.urdf:16: link `hand` hangs on the joints",
        ),
        (
            "<parent link=\"post\"/>",
            "<parent link=\"ball\"/>",
            "arm.urdf:11: link `hand` does not hang on the root `post`: a closed loop",
        ),
        ("<link name=\"ball\">", "<link name=\"post\">", "arm.urdf:10: a second link `post`"),
        (
            "<parent link=\"hand\"/><child link=\"ball\"/>",
            "<parent link=\"hand\"/><child link=\"post\"/>",
            "arm.urdf:11: link `hand` does not hang on the root `ball`",
        ),
        (
            "<joint name=\"free\" type=\"spherical\"><parent link=\"hand\"/><child link=\"ball\"/></joint>",
            "",
            "arm.urdf:10: links `post` and `ball` hang on nothing",
        ),
        ("length=\"1\"", "length=\"-1\"", "arm.urdf:8: length = `-1` found; a positive number"),
        (
            "radius=\"0.1\" length=\"0.4\"",
            "radius=\"1e40\" length=\"0.4\"",
            "arm.urdf:10: radius = `1e40` found",
        ),
        (
            "corner.obj",
            "lost.obj",
            "arm.urdf:5: `package://own/meshes/lost.obj`: neither meshes/lost.obj nor own/meshes/lost.obj",
        ),
        (
            "package://own/meshes/corner.obj",
            "http://own/corner.obj",
            "arm.urdf:5: `http://own/corner.obj` found",
        ),
        ("package://own/meshes/corner.obj", "lost.obj", "lost.obj: cannot read the mesh"),
        ("scale=\"2 -1 1\"", "scale=\"2 0 1\"", "arm.urdf:5: scale = 0 found"),
        ("scale=\"2 -1 1\"", "scale=\"2 1\"", "arm.urdf:5: scale = `2 1` found; three"),
        (
            "<robot",
            "<!DOCTYPE robot [<!ENTITY a \"a\"><!ENTITY b \"&a;&a;\">]><robot",
            "arm.urdf:1: not a URDF: XML with DTD",
        ),
        (
            "<robot name=\"arm\" version=\"1.2\">",
            "<robot><robot>",
            "arm.urdf:1: not a URDF: the root node",
        ),
        ("name=\"arm\"", "nme=\"arm\"", ""),
    ] {
        let text = ARM.replacen(from, to, 1);
        assert_ne!(text, ARM, "{from}");
        let found = read(folder.path(), text.as_bytes());
        let found = found.map_or_else(|error| error.to_string(), |_| String::new());
        if expected.is_empty() != found.is_empty() || !found.contains(expected) {
            wrong.push(format!("{to}: {found}, not {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let many = format!("<robot>{}</robot>", "<link name=\"a\"/>\n".repeat(1001));
    let error = read(folder.path(), many.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("arm.urdf:1001: more than 1000 links"), "{error}");
    // Deeper than any stack.
    let deep = format!("<robot>{}", "<a>".repeat(200_000));
    assert!(read(folder.path(), deep.as_bytes()).is_err());
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(1000), "</a>".repeat(1000));
    let error = read(folder.path(), deep.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("arm.urdf:1: elements nested more than 64 deep"), "{error}");
}

#[test]
fn what_is_not_read_may_lack_what_the_format_requires() {
    let folder = folder();
    let (expected, _) = read(folder.path(), ARM.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    for (from, to) in [
        ("</geometry></visual>", "</geometry><material name=\"\"><texture/></material></visual>"),
        (
            "  <link name=\"hand\">",
            "  <material name=\"red\"><color/></material>\n  <link name=\"hand\">\n<inertial/>",
        ),
        ("<limit", "<dynamics/><calibration rising=\"x\"/><safety_controller/><limit"),
        (
            "  <joint name=\"grip\"",
            "<gazebo><link><visual><geometry><box/></geometry></visual></link></gazebo>\n  <joint name=\"grip\"",
        ),
        ("<?xml version=\"1.0\"?>", "\u{feff}<?xml version=\"1.0\"?>"),
    ] {
        let text = ARM.replacen(from, to, 1);
        assert_ne!(text, ARM, "{from}");
        let (links, _) =
            read(folder.path(), text.as_bytes()).unwrap_or_else(|e| panic!("{to}: {e}"));
        assert_eq!(links, expected, "{to}");
    }
    let latin = ARM.replace("version=\"1.0\"?>", "version=\"1.0\" encoding=\"ISO-8859-1\"?>");
    let latin: Vec<u8> =
        latin.replace("upper arm", "\u{e9}paule").chars().map(|c| c as u8).collect();
    let (links, _) = read(folder.path(), &latin).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(links[1].name, "épaule");
}

/// What a follower has of limits narrows the other joint's; one that is fixed follows none.
#[test]
fn followers_follow_the_joint_that_moves_by_itself() {
    let folder = folder();
    let wrist = "<joint name=\"wrist\" type=\"revolute\"><parent link=\"hand\"/><child link=\"ball\"/>\
                 <axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"3\"/><mimic joint=\"shoulder\" multiplier=\"2\" offset=\"0.5\"/></joint>";
    let free = "<joint name=\"free\" type=\"spherical\"><parent link=\"hand\"/><child link=\"ball\"/></joint>";
    let text = ARM.replace(free, wrist).replace(
        "rpy=\"0 0 1.5707963267948966\"/>",
        "rpy=\"0 0 1.5707963267948966\"/><mimic joint=\"shoulder\"/>",
    );
    let (links, notes) = read(folder.path(), text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let kind = |index: usize| links[index].joint.as_ref().unwrap().kind;
    let limits = Some(Limits { min: -0.25, max: 1.25 });
    assert_eq!(kind(1), JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits });
    assert_eq!(kind(2), JointKind::Fixed);
    assert!(notes.iter().any(|note| note.starts_with("joint `grip` is fixed and follows none")));
    assert!(
        notes.iter().any(|note| note.contains("`shoulder` moves from -0.25 to 1.25")),
        "{notes:?}"
    );
    let mimic = Mimic { value: 0, multiplier: 2.0, offset: 0.5 };
    assert_eq!(kind(3), JointKind::RevoluteMimic { axis: [1.0, 0.0, 0.0], mimic });
}

/// Some files write "without end" as very large limits.
#[test]
fn limits_beyond_ten_turns_are_none() {
    let folder = folder();
    let text = ARM.replace("lower=\"-1\" upper=\"2\"", "lower=\"-1e16\" upper=\"1e16\"");
    let (links, notes) = read(folder.path(), text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let endless = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: None };
    assert_eq!(links[1].joint.as_ref().unwrap().kind, endless);
    assert!(notes.iter().any(|note| note.contains("`shoulder` turns on and on")), "{notes:?}");
}

/// A root that stands for the world is none of the robot's links.
#[test]
fn a_floating_joint_on_an_empty_root_moves_the_base() {
    let folder = folder();
    let world = "<link name=\"world\"/><joint name=\"fly\" type=\"floating\"><parent link=\"world\"/>\
                 <child link=\"post\"/><origin xyz=\"0 0 1\"/></joint></robot>";
    let text = ARM.replace("</robot>", world);
    let path = folder.path().join("robots/arm/arm.urdf");
    for (kind, expected) in [("floating", BaseJoint::Rigid3d), ("planar", BaseJoint::Rigid2d)] {
        fs::write(&path, text.replace("\"floating\"", &format!("\"{kind}\""))).unwrap();
        let robot = read_urdf(&path).unwrap_or_else(|error| panic!("{error}"));
        let names: Vec<_> = robot.links.iter().map(|link| link.name.as_str()).collect();
        assert_eq!(
            (robot.base, &names[..]),
            (expected, &["post", "upper arm", "hand", "ball"][..])
        );
        assert!(robot.notes.iter().any(|note| note.starts_with("joint `fly` moves the robot")));
        let problem = Problem::load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(problem.space().len(), expected.values() + 5);
    }
    // A root with a shape is a link of the robot.
    let solid = "<link name=\"world\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>";
    let text = text.replace("<link name=\"world\"/>", solid);
    let error = read(folder.path(), text.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("arm.urdf:17: joint `fly`: type `floating` found"), "{error}");
}

#[test]
fn a_limit_without_ends_locks_the_joint_and_a_note_says_so() {
    let folder = folder();
    let text = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"revolute\">\
                <parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/><limit effort=\"1\" velocity=\"1\"/></joint></robot>";
    let (links, notes) = read(folder.path(), text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let limits = Some(Limits { min: 0.0, max: 0.0 });
    let locked = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits };
    assert_eq!(links[1].joint.as_ref().unwrap().kind, locked);
    assert!(notes.iter().any(|note| note.starts_with("joint `j` stays at 0")), "{notes:?}");
}

/// A mesh whose corners differ by rounding, named by a URI.
#[test]
fn meshes_of_robots_are_closed_where_rounding_opened_them() {
    let folder = folder();
    let corner = "solid c\n".to_owned()
        + &[
            "0 0 0,0 1 0,1 0 0",
            "1e-17 0 0,1 0 0,0 0 1",
            "1 0 0,0 1 0,1e-17 0 1",
            "0 0 1,0 1 0,0 1e-17 0",
        ]
        .map(|facet| {
            format!(
                "facet normal 0 0 0\nouter loop\nvertex {}\nendloop\nendfacet\n",
                facet.replace(',', "\nvertex ")
            )
        })
        .concat()
        + "endsolid c\n";
    fs::write(folder.path().join("meshes/a corner.stl"), corner).unwrap();
    let text = ARM.replace("package://own/meshes/corner.obj", "file://../../meshes/a%20corner.stl");
    let (links, notes) = read(folder.path(), text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    assert!(links[2].bodies[0].solid, "{notes:?}");
    assert!(notes.iter().any(|note| note.contains("apart joined, without which")), "{notes:?}");
}

#[test]
fn joints_of_one_name_have_values_of_their_own() {
    let folder = folder();
    let text =
        ARM.replace("name=\"free\" type=\"spherical\">", "name=\"shoulder\" type=\"continuous\">");
    let path = folder.path().join("robots/arm/arm.urdf");
    fs::write(&path, text).unwrap();
    let problem = Problem::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let (space, told) = (problem.space(), problem.describe());
    let names: Vec<&str> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "shoulder-2"]);
    for name in names {
        assert!(told.contains(&format!("  {name}: turns")), "{told}");
    }
}

#[test]
fn a_cut_off_robot_is_an_error() {
    let folder = folder();
    for end in 0..ARM.trim_end().len() {
        let error = read(folder.path(), &ARM.as_bytes()[..end]).unwrap_err().to_string();
        assert!(error.contains("arm.urdf:"), "{error}");
    }
}

proptest! {
    #[test]
    fn changed_robots_never_panic(
        at in 0usize..2000,
        bytes in proptest::collection::vec(any::<u8>(), 0..4),
        word in "[0-9-]{1,3}|1e30|nan|<link/>|<joint/>|[\"<>/= ]{1,3}",
    ) {
        let folder = folder();
        let at = at % ARM.len();
        for new in [bytes.as_slice(), word.as_bytes()] {
            let mut changed = ARM.as_bytes().to_vec();
            changed.splice(at..(at + new.len()).min(ARM.len()), new.iter().copied());
            if let Err(error) = read(folder.path(), &changed) {
                prop_assert!(error.to_string().contains('.'), "{}", error);
            }
        }
    }
}

/// The wrist's ball against the wall, by arithmetic of its own: nothing of the library's poses.
#[test]
fn the_gantry_lifts_its_fork_over_the_wall() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/gantry.toml");
    let problem = Problem::load(&file).unwrap_or_else(|error| panic!("{error}"));
    let setup = Arc::new(Setup::new(problem));
    let build = build_in_threads(&setup, 2);
    assert_eq!(build.stop, Stop::Satisfied);
    let verdicts = build.judgement.expect("a round was judged").verdicts;
    let path = verdicts[0].answer.as_ref().and_then(|answer| answer.path.as_ref());
    let configs: Vec<&[f64]> = path.expect("a way over").configs.iter().collect();
    let mut highest = 0.0f64;
    for ends in configs.windows(2) {
        for step in 0..=1000 {
            let t = f64::from(step) / 1000.0;
            let [slide, swing] = [0, 1].map(|i| ends[0][i] + t * (ends[1][i] - ends[0][i]));
            assert!((0.0..=4.0).contains(&slide) && (-1.4..=1.4).contains(&swing));
            let (sine, cosine) = (roadmill::math::sin(swing), roadmill::math::cos(swing));
            let (x, z) = (slide - 0.9 * sine, 1.9 - 0.9 * cosine);
            let (beside, above) = ((x - 2.0).abs() - 0.1, z - 1.2);
            let gap = (beside.max(0.0) * beside.max(0.0) + above.max(0.0) * above.max(0.0)).sqrt();
            assert!(gap > 0.0999, "the wrist at {x} {z} is in the wall");
            if beside < 0.0 {
                highest = highest.max(above);
            }
        }
    }
    assert!(highest > 0.1, "it went over the wall");
}
