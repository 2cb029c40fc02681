use super::*;
use crate::digest::Digest;
use proptest::prelude::*;

/// Tries levels until the loop ends, each of which `solves` says whether it is solved.
fn run(settings: &Settings, mut solves: impl FnMut(&Attempt) -> bool) -> (Vec<Tried>, Ended) {
    let mut tried = Vec::new();
    loop {
        match next(settings, &tried) {
            Step::End(ended) => return (tried, ended),
            Step::Try(attempt) => {
                let outcome = if solves(&attempt) { Outcome::Solved } else { Outcome::Unsolved };
                tried.push(Tried { attempt, outcome });
            }
        }
    }
}

fn levels(tried: &[Tried]) -> Vec<f64> {
    tried.iter().map(|tried| tried.attempt.level).collect()
}

#[test]
fn what_is_solved_at_once_is_not_relaxed() {
    let (tried, ended) = run(&Settings::default(), |_| true);
    assert_eq!((levels(&tried), ended), (vec![1.0], Ended::Solved(0)));
}

#[test]
fn the_first_solved_level_is_sought_from_the_strict_end_and_all_levels_follow_it_upward() {
    // Without help a quarter is solved; with the path of a level a quarter above it is.
    let mut solved = vec![0.0];
    let (tried, ended) = run(&Settings::default(), |Attempt { level, guide }| {
        let from = match guide {
            Guide::Nothing => 0.0,
            _ => solved[solved.len() - 1],
        };
        let is_solved = level - from <= 0.25;
        if is_solved {
            solved.push(*level);
        }
        is_solved
    });
    assert_eq!(levels(&tried), [1.0, 0.5, 0.25, 0.5, 1.0, 0.75, 1.0]);
    assert_eq!(ended, Ended::Solved(6));
    let guides: Vec<Option<usize>> = tried.iter().map(|tried| tried.attempt.guide.of()).collect();
    assert_eq!(guides, [None, None, None, Some(2), Some(3), Some(3), Some(5)]);
}

#[test]
fn where_nothing_is_solved_the_most_relaxed_level_is_the_last() {
    let (tried, ended) = run(&Settings::default(), |_| false);
    assert_eq!((levels(&tried), ended), (vec![1.0, 0.5, 0.25, 0.0], Ended::NothingSolved));
    let settings = Settings { start: 0.3, ..Settings::default() };
    assert_eq!(levels(&run(&settings, |_| false).0), [0.3, 0.15, 0.0]);
}

#[test]
fn where_steps_become_too_small_more_help_is_tried() {
    let settings = Settings { finest: 0.25, ..Settings::default() };
    let (tried, ended) = run(&settings, |attempt| attempt.level <= 0.5);
    assert_eq!(ended, Ended::Stuck { solved: 0.5, failed: 0.75 });
    let guides: Vec<Guide> = tried[2..].iter().map(|tried| tried.attempt.guide).collect();
    let expected =
        [Guide::Path(1), Guide::Path(1), Guide::Dissimilar(1), Guide::Distinct(1), Guide::Nothing];
    assert_eq!(guides, expected);
    // What was solved with new random numbers helps from then on, and no path from before does.
    let mut count = 0;
    let (tried, ended) = run(&settings, |Attempt { level, guide }| {
        count += 1;
        let is_anew = count > 5 && *guide == Guide::Nothing;
        *level <= 0.5 || is_anew || guide.of().is_some_and(|of| of > 1)
    });
    assert_eq!(levels(&tried), [1.0, 0.5, 1.0, 0.75, 0.75, 0.75, 0.75, 1.0]);
    assert_eq!((tried[7].attempt.guide, ended), (Guide::Path(6), Ended::Solved(7)));
}

#[test]
fn no_more_levels_are_tried_than_allowed() {
    let settings = Settings { levels: 3, ..Settings::default() };
    let (tried, ended) = run(&settings, |attempt| attempt.level < 0.5);
    assert_eq!((tried.len(), ended), (3, Ended::TooMany));
    // One that ends with the last is no longer cut.
    let (tried, ended) =
        run(&settings, |attempt| attempt.level < 0.6 || attempt.guide.of().is_some());
    assert_eq!((tried.len(), ended), (3, Ended::Solved(2)));
}

#[test]
fn a_start_below_the_problem_itself_leads_to_it() {
    let settings = Settings { start: 0.5, ..Settings::default() };
    let (tried, ended) = run(&settings, |_| true);
    assert_eq!((levels(&tried), ended), (vec![0.5, 1.0], Ended::Solved(1)));
}

#[test]
fn a_chain_tells_apart_whatever_levels_came_to() {
    let attempt = Attempt { level: 0.5, guide: Guide::Path(1) };
    let tried = Tried { attempt, outcome: Outcome::Solved };
    let (zero, one) = (Digest::of(b"0"), Digest::of(b"1"));
    let known = [
        chain(zero, &tried, Some([zero, zero])),
        chain(one, &tried, Some([zero, zero])),
        chain(zero, &tried, Some([zero, one])),
        chain(zero, &tried, None),
        chain(zero, &Tried { outcome: Outcome::Unsolved, ..tried }, Some([zero, zero])),
        chain(
            zero,
            &Tried { attempt: Attempt { guide: Guide::Path(2), ..attempt }, ..tried },
            Some([zero, zero]),
        ),
        chain(
            zero,
            &Tried { attempt: Attempt { level: 0.25, ..attempt }, ..tried },
            Some([zero, zero]),
        ),
    ];
    for (index, digest) in known.iter().enumerate() {
        assert!(!known[..index].contains(digest), "{index}");
    }
}

proptest! {
    /// Whatever levels come to: the loop ends, never goes below 0 or above 1, helps only with what is solved, climbs, and says `Solved`
    /// only of the problem itself. Every decision follows from the outcomes before it.
    #[test]
    fn every_loop_ends_and_its_decisions_follow(
        outcomes in proptest::collection::vec(0..3u8, 64),
        start in prop_oneof![Just(1.0), 0.01..1.0f64],
        finest in 0.01..0.5f64,
        most in 1..60u32,
    ) {
        let settings = Settings { start, finest, levels: most, ..Settings::default() };
        let mut tried: Vec<Tried> = Vec::new();
        let ended = loop {
            match next(&settings, &tried) {
                Step::End(ended) => break ended,
                Step::Try(attempt) => {
                    prop_assert!((0.0..=1.0).contains(&attempt.level));
                    if let Some(of) = attempt.guide.of() {
                        prop_assert_eq!(tried[of].outcome, Outcome::Solved);
                        prop_assert!(tried[of].attempt.level < attempt.level);
                        let last = tried.iter().rposition(|tried| tried.outcome == Outcome::Solved);
                        prop_assert_eq!(last, Some(of));
                    }
                    let known = [Outcome::Solved, Outcome::Unsolved, Outcome::InvalidEnds];
                    let outcome = known[usize::from(outcomes[tried.len()])];
                    tried.push(Tried { attempt, outcome });
                }
            }
        };
        prop_assert!(tried.len() <= most as usize);
        if let Ended::Solved(place) = ended {
            prop_assert_eq!(tried[place].attempt.level, 1.0);
            prop_assert_eq!(tried[place].outcome, Outcome::Solved);
        }
        prop_assert_eq!(follows(&settings, &tried), Ok(()));
        // A level that was not to be tried is found out.
        if let Some(last) = tried.last_mut() {
            last.attempt.level = 1.5;
            prop_assert_eq!(follows(&settings, &tried), Err(tried.len() - 1));
        }
    }
}

#[test]
fn settings_that_cannot_be_are_named() {
    let usual = Settings::default;
    for (settings, key) in [
        (Settings { start: 0.0, ..usual() }, "start"),
        (Settings { start: f64::NAN, ..usual() }, "start"),
        (Settings { finest: 0.6, ..usual() }, "finest"),
        (Settings { levels: 0, ..usual() }, "levels"),
        (Settings { nodes: 0, ..usual() }, "nodes"),
        (Settings { sets: Some(0), ..usual() }, "sets"),
        (Settings { paths: 101, ..usual() }, "paths"),
    ] {
        assert_eq!(settings.complaint().map(|complaint| complaint.key), Some(key));
    }
    assert_eq!(usual().complaint(), None);
}
