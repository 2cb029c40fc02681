//! `.query`: one configuration a line, the robot's index before it. The first is the start, the second
//! the goal.

use super::robot::Robot;
use super::words::number;
use crate::math;
use crate::model::bodies::foreign::frames::euler;
use crate::model::bodies::foreign::{Base, ForeignError};
use crate::space::BaseJoint;
use std::f64::consts::PI;
use std::path::Path;

pub(super) fn read(
    path: &Path,
    text: &str,
    robot: &Robot,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, Vec<f64>), ForeignError> {
    let mut ends = Vec::new();
    let mut last_line = 1;
    for (index, line) in text.lines().enumerate() {
        last_line = index + 1;
        let said = line.split_whitespace().take_while(|word| !word.starts_with('#'));
        let words: Vec<&str> = said.collect();
        if words.is_empty() {
            continue;
        }
        if ends.len() == 2 {
            notes.push(format!("query: line {last_line} and what follows passed over"));
            break;
        }
        let end = configuration(&words, robot)
            .map_err(|message| ForeignError::line(path, last_line, message))?;
        ends.push(end);
    }
    match <[Vec<f64>; 2]>::try_from(ends) {
        Ok([start, goal]) => Ok((start, goal)),
        Err(ends) => {
            let message =
                format!("cut off; {} configurations found, start and goal expected", ends.len());
            Err(ForeignError::line(path, last_line, message))
        }
    }
}

fn configuration(words: &[&str], robot: &Robot) -> Result<Vec<f64>, String> {
    let motion = match robot.base {
        Base::Fixed(_) => None,
        Base::Moving(motion) => Some(motion),
    };
    let base = motion.map_or(0, |motion| match (motion.translations(), motion.rotates()) {
        (2, true) => 3,
        (3, true) => 6,
        (translations, _) => translations,
    });
    let expected = 1 + base + robot.places.len();
    if words.len() != expected {
        let found = words.len();
        return Err(format!(
            "{found} numbers found; the robot's index and {} expected",
            expected - 1
        ));
    }
    if words[0] != "0" {
        return Err(format!("robot `{}` found; there is one, 0", words[0]));
    }
    let mut values = Vec::new();
    for word in &words[1..] {
        values
            .push(number(word).ok_or_else(|| format!("`{word}` found; a finite number expected"))?);
    }
    let (own, joints) = values.split_at(base);
    let mut q = own.to_vec();
    match motion {
        Some(BaseJoint::Rigid2d) => q[2] = math::wrap_angle(own[2] * PI),
        Some(BaseJoint::Rigid3d) => {
            q.truncate(3);
            q.extend(euler([own[3], own[4], own[5]]));
        }
        _ => {}
    }
    q.extend(robot.places.iter().map(|place| joints[*place] * PI));
    Ok(q)
}
