use super::bodies::body_sound;
use crate::scene::Body;
use bincode::{Decode, Encode};

/// How a scene differs from what it was, the robot being the same: what [`Description::change`](super::Description::change)
/// finds. An obstacle that moved has gone from where it was and come to where it is.
#[derive(Clone, Debug, Default, PartialEq, Encode, Decode)]
pub struct SceneChange {
    /// Obstacles that were not there before, in the order of the new scene, in the world's frame.
    pub added: Vec<Body>,
    /// Obstacles that are no longer there, in the order of the old scene, in the world's frame.
    pub removed: Vec<Body>,
    /// What else differs that decides what is valid, in words ("the space's bounds"). The obstacles that came and went
    /// then say too little, and everything has to be looked at again.
    pub beyond_obstacles: Option<String>,
}

impl SceneChange {
    /// The obstacles that came and went from one scene to another. Obstacles are the same if they are equal in shape, in
    /// pose and in whether their inside is material; of several equal ones as many stay as both scenes have.
    pub fn between(before: &[Body], after: &[Body]) -> SceneChange {
        let mut is_gone = vec![true; before.len()];
        let mut added = Vec::new();
        for (index, body) in after.iter().enumerate() {
            // Most stand where they stood in the list, too.
            let same_place = is_gone.get(index) == Some(&true) && before[index] == *body;
            let mut same = (0..before.len()).filter(|old| is_gone[*old] && before[*old] == *body);
            match if same_place { Some(index) } else { same.next() } {
                Some(old) => is_gone[old] = false,
                None => added.push(body.clone()),
            }
        }
        let gone = before.iter().zip(is_gone).filter(|(_, is_gone)| *is_gone);
        let removed = gone.map(|(body, _)| body.clone()).collect();
        SceneChange { added, removed, beyond_obstacles: None }
    }

    /// Whether the scene is what it was.
    pub fn is_none(&self) -> bool {
        self.added.is_empty() && self.removed.is_empty() && self.beyond_obstacles.is_none()
    }

    /// Whether the obstacles are ones that a problem file could give: what decoded bytes must show before anything is
    /// made of them.
    ///
    /// # Errors
    /// What is wrong with the first that is not.
    pub(crate) fn sound(&self) -> Result<(), String> {
        let mut bodies = self.added.iter().chain(&self.removed);
        bodies.try_for_each(|body| body_sound(body).map_err(|why| format!("an obstacle{why}")))
    }

    /// How many of the obstacles that came are such that went, at another pose.
    pub fn moved(&self) -> usize {
        let mut rest: Vec<&Body> = self.removed.iter().collect();
        let is_moved = |body: &&Body| {
            let same = |old: &&Body| old.shape == body.shape && old.solid == body.solid;
            rest.iter().position(same).map(|place| rest.swap_remove(place)).is_some()
        };
        self.added.iter().filter(is_moved).count()
    }
}
