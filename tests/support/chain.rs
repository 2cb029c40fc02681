//! A long serial chain as a problem file.

use std::fmt::Write;

/// A chain of `links` boxes, the base among them, that stand in a row along x, each turning about the z axis
/// of its near end. The query bends all joints a little, and an obstacle stands beside the row.
pub fn serial_chain(links: usize) -> String {
    let reach = 2 * links;
    let bodies =
        "bodies = [{ shape = { box = { size = [0.8, 0.2, 0.2] } }, position = [0.5, 0.0, 0.0] }]";
    let mut text = format!(
        "[space]\nmotion = \"fixed\"\nbounds = \"body\"\n\
         min = [-{reach}, -{reach}, -1]\nmax = [{reach}, {reach}, 1]\n\
         [robot]\n{bodies}\n\
         [[obstacles]]\nshape = {{ box = {{ size = [1.0, 1.0, 1.0] }} }}\nposition = [0.0, 5.0, 0.0]\n\
         [query]\nstart = {:?}\ngoal = {:?}\n",
        vec![0.0; links - 1],
        vec![1e-4; links - 1],
    );
    for link in 1..links {
        let axis = "axis = [0.0, 0.0, 1.0], degrees = [-170.0, 170.0]";
        write!(
            text,
            "[[robot.links]]\nname = \"link-{link}\"\n{bodies}\n\
             joint = {{ kind = {{ revolute = {{ {axis} }} }}, before = {{ position = [1.0, 0.0, 0.0] }} }}\n"
        )
        .expect("writing to memory cannot fail");
    }
    text
}
