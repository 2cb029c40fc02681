use crate::space::Space;

/// The configurations of a path and others between them, evenly along every leg, so that no two that follow one another are farther apart than
/// `step`. One that follows itself stands once.
pub(super) fn resampled(space: &Space, path: &[Vec<f64>], step: f64) -> Vec<Vec<f64>> {
    let mut sampled: Vec<Vec<f64>> = path.first().cloned().into_iter().collect();
    for leg in path.windows(2) {
        let parts = parts(space, leg, step);
        for part in 1..parts {
            let mut q = leg[0].clone();
            let share = f64::from(part) / f64::from(parts);
            space.interpolate(&leg[0], &leg[1], share, &mut q);
            // Between quaternions that are nearly opposite nothing has a direction.
            if space.canonicalize(&mut q).is_ok() {
                sampled.push(q);
            }
        }
        if parts > 0 {
            sampled.push(leg[1].clone());
        }
    }
    sampled
}

/// Into how many equal parts a leg is cut; none where it has no length.
fn parts(space: &Space, leg: &[Vec<f64>], step: f64) -> u32 {
    let length = space.distance(&leg[0], &leg[1]);
    // More than a path may have in all is never asked for.
    (length / step).ceil().min(1e6) as u32
}

/// [`resampled`] with the step made longer, by doubling, until there are at most `most` configurations. Of a path that has more by itself, `most` of its own, evenly by
/// their number, the first and the last among them.
pub(in crate::generator) fn fitted(
    space: &Space,
    path: &[Vec<f64>],
    step: f64,
    most: usize,
) -> Vec<Vec<f64>> {
    let of_step = |step: f64| {
        let legs = path.windows(2).map(|leg| parts(space, leg, step) as usize);
        1 + legs.sum::<usize>()
    };
    let longest = path.windows(2).map(|leg| space.distance(&leg[0], &leg[1])).fold(0.0, f64::max);
    let mut step = step;
    while of_step(step) > most && step < longest {
        step *= 2.0;
    }
    let sampled = resampled(space, path, step);
    evenly(sampled, most)
}

/// So many of a list, evenly, the first and the last among them; all where it has no more.
pub(super) fn evenly<T>(list: Vec<T>, most: usize) -> Vec<T> {
    let count = list.len();
    if count <= most {
        return list;
    }
    // Item `index` is kept where the number of those kept grows.
    let kept = |index: usize| match most {
        0 => 0,
        1 => 1,
        _ => 1 + index * (most - 1) / (count - 1),
    };
    let is_kept = |index: usize| kept(index) > index.checked_sub(1).map_or(0, kept);
    let numbered = list.into_iter().enumerate();
    numbered.filter(|(index, _)| is_kept(*index)).map(|(_, item)| item).collect()
}
