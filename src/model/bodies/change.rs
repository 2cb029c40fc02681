//! What differs between two scenes of the same robot.

use super::Bodies;
use crate::model::{ModelKind, SceneChange};

/// How the scene `after` differs from `before`.
///
/// # Errors
/// When it is no scene of the same robot.
pub(super) fn change(before: &Bodies, after: &ModelKind) -> Result<SceneChange, String> {
    let Some(after) = after.bodies() else {
        return Err("the kind of model is not what it was".to_owned());
    };
    // Without `..`: whoever adds a field has to say here what follows from it. The rotation length is of the metric
    // alone: by it nodes are neighbours, but nothing is valid or not.
    let Bodies { bounds, resolution, edges, rotation_length: _, robot, obstacles } = before;
    if *robot != after.robot {
        return Err("the robot is not what it was; the same robot expected".to_owned());
    }
    let others = [
        ("the space's bounds", *bounds == after.bounds),
        ("the resolution", *resolution == after.resolution),
        ("what is promised of edges", *edges == after.edges),
    ];
    let different: Vec<&str> =
        others.iter().filter(|(_, same)| !same).map(|(what, _)| *what).collect();
    let beyond_obstacles = (!different.is_empty()).then(|| different.join(", "));
    Ok(SceneChange { beyond_obstacles, ..SceneChange::between(obstacles, &after.obstacles) })
}
