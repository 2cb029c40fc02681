//! A robot's URDF with an SRDF on the command line.

mod support;

use support::Scratch;

const URDF: &str = r#"<robot name="arm">
  <link name="post"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="upper"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lower"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="shoulder" type="continuous"><parent link="post"/><child link="upper"/><origin xyz="1 0 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/></joint>
</robot>
"#;
const SRDF: &str =
    r#"<robot name="arm"><group name="forearm"><joint name="elbow"/></group></robot>"#;

#[test]
fn an_srdf_and_a_group_are_taken_beside_a_urdf() {
    let scratch = Scratch::new();
    scratch.write("arm.urdf", URDF);
    scratch.write("arm.srdf", SRDF);
    let all = scratch.run(&["check", "arm.urdf"]);
    assert!(all.stdout.contains("configuration    shoulder elbow"), "{}", all.stdout);
    let of_group = ["check", "arm.urdf", "--srdf", "arm.srdf", "--group", "forearm"];
    let one = scratch.run(&of_group);
    assert!(one.stdout.contains("configuration    elbow\n"), "{}", one.stdout);
    assert!(one.stdout.contains("locked: shoulder"), "{}", one.stdout);
    let lost = scratch.run(&["check", "arm.urdf", "--srdf", "arm.srdf", "--group", "hand"]);
    lost.assert_code(2);
    assert!(lost.stderr.contains("--group: `hand` found; a group of the SRDF expected: forearm"));
    let imported =
        ["import", "arm.urdf", "--srdf", "arm.srdf", "--group", "forearm", "--out", "arm.toml"];
    scratch.run(&imported).assert_code(0);
    assert!(scratch.run(&["check", "arm.toml"]).stdout.contains("configuration    elbow\n"));
}

#[test]
fn links_that_never_touch_are_lines_of_a_problem_file() {
    let scratch = Scratch::new();
    scratch.write("arm.urdf", URDF);
    // Both joints turn about the line on which the balls are, so that post and lower arm stay 2 apart.
    let told = scratch.run(&["check", "arm.urdf", "--touching", "2000"]).stdout;
    assert!(told.starts_with("# Of 1 pairs of links, in 2000 configurations"), "{told}");
    let never = told.split("touch in none").nth(1).unwrap_or_else(|| panic!("{told}"));
    assert!(told.contains("may_touch = [\n") && never.contains("[\"post\", \"lower\"],"), "{told}");
    scratch.run(&["check", "arm.urdf", "--touching", "0"]).assert_code(2);
}
