//! The simple push (O. B. Bayazit 2003, chapter IV D 1): from every colliding configuration toward several configurations on the straight line between
//! the last valid configuration before the stretch and the first one after it.

use super::{Pushed, Run, Search};

/// Toward how many configurations each is pushed the first time (the dissertation: *k*), and how many more each time after that.
const TARGETS: u32 = 3;
const MORE_TARGETS: u32 = 2;
const MOST_TARGETS: u32 = 15;

/// Pushes every configuration of a stretch. The line's *k · n* configurations are dealt out in their order, *k* to each of the *n* colliding ones, so that none
/// is pushed along the whole path. Where the stretch has no valid configuration on one side, the line ends at its last configuration
/// there. The search goes on beyond the line, as far as the reach.
pub(super) fn push(run: &Run, search: &mut Search) -> Vec<Pushed> {
    let (Some(first), Some(last)) = (run.colliding.first(), run.colliding.last()) else {
        return Vec::new();
    };
    let line = [run.before.unwrap_or(first), run.after.unwrap_or(last)];
    let space = search.cx.space();
    let targets = TARGETS.saturating_add(search.effort.saturating_mul(MORE_TARGETS));
    let targets = targets.min(MOST_TARGETS);
    let all = run.colliding.len() as f64 * f64::from(targets);
    let mut found = Vec::new();
    for (from, q) in run.colliding.iter().enumerate() {
        let mut target = q.clone();
        for own in 0..targets {
            let place = from as f64 * f64::from(targets) + f64::from(own) + 0.5;
            space.interpolate(line[0], line[1], place / all, &mut target);
            let direction = space.displacement(q, &target);
            // On the line itself there is no direction to it.
            if direction.length() > 0.0
                && let Some(q) = search.first_valid(q, &direction)
            {
                found.push(Pushed { from, q });
            }
        }
    }
    found
}
