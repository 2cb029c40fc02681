//! Which level is tried next.

use super::Settings;

/// A level to be tried, and what helps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt {
    /// The level: 1 is the problem itself, 0 the most relaxed.
    pub level: f64,
    /// What helps.
    pub guide: Guide,
}

/// What helps to solve a level: something of an earlier level that was solved. It is named by that level's place among those that
/// were tried, the first of which is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guide {
    /// Nothing but the strategies of the problem.
    Nothing,
    /// Its path and its roadmap.
    Path(usize),
    /// Its roadmap, and several paths through it that keep apart from one another.
    Dissimilar(usize),
    /// Its roadmap, and several paths through it that pass obstacles differently: a path of a relaxed problem may go where none of the
    /// problem itself can follow (the dissertation, III E, Figure 9).
    Distinct(usize),
}

impl Guide {
    /// The earlier level, by its place.
    pub fn of(self) -> Option<usize> {
        match self {
            Guide::Nothing => None,
            Guide::Path(of) | Guide::Dissimilar(of) | Guide::Distinct(of) => Some(of),
        }
    }

    /// One word for it.
    pub fn name(self) -> &'static str {
        match self {
            Guide::Nothing => "nothing",
            Guide::Path(_) => "path",
            Guide::Dissimilar(_) => "dissimilar-paths",
            Guide::Distinct(_) => "distinct-paths",
        }
    }
}

/// What a level came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A path was found.
    Solved,
    /// None was found within the limits.
    Unsolved,
    /// There is nothing to be built: an end of the query is not valid at this level, and nothing near it is. Scaled shapes may reach where
    /// the problem's own do not.
    InvalidEnds,
}

impl Outcome {
    /// One word for it.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Solved => "solved",
            Outcome::Unsolved => "unsolved",
            Outcome::InvalidEnds => "invalid-ends",
        }
    }
}

/// A level that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    /// The level and what helped.
    pub attempt: Attempt,
    /// What it came to.
    pub outcome: Outcome,
}

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// This level is to be tried.
    Try(Attempt),
    /// Nothing more.
    End(Ended),
}

/// How the loop ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// The problem itself is solved, by the level of this place.
    Solved(usize),
    /// No level is solved, not even the most relaxed one.
    NothingSolved,
    /// The level `solved` is solved and the level `failed` is not, whatever helps; smaller steps are not made.
    Stuck {
        /// The highest level that is solved.
        solved: f64,
        /// The next level above it that was tried.
        failed: f64,
    },
    /// As many levels were tried as the settings allow.
    TooMany,
}

/// Below this level no half of a level is tried any more while none is solved: the most relaxed one follows, by which it shows whether
/// relaxing helps at all.
const LOWEST_HALF: f64 = 0.25;

/// Which level is tried next, after these.
///
/// *The first level that is solved.* The problem itself is tried first ([`Settings::start`]): what is solved without relaxing anything
/// must not pay for it, and how hard a problem is nobody knows before. The dissertation begins its binary search at the other end, with
/// a very small robot; that costs little and always finds a path, but by its own Figure 9 such a path may go where none of the problem
/// can follow. So the search begins at the strict end: level 1, then a half, a quarter, and the most relaxed level last.
///
/// *Strengthening.* From the level that is solved the next one above it that failed is tried again, now with the path of the solved one:
/// from a half that is the problem itself at once. Where that fails, too, the level half way between the two comes first. Once
/// half the way would be a step of less than [`Settings::finest`], more help is tried at the same level: several paths that keep apart;
/// then paths that pass obstacles differently; at last nothing of the levels before but new random numbers, since all their
/// paths may lead astray. Where that does not help either, the loop ends.
pub fn next(settings: &Settings, tried: &[Tried]) -> Step {
    let mut ladder = Ladder::new(settings);
    for (place, tried) in tried.iter().enumerate() {
        ladder.take(settings, place, tried);
    }
    match ladder.step(settings) {
        Step::Try(_) if tried.len() >= settings.levels as usize => Step::End(Ended::TooMany),
        step => step,
    }
}

/// Whether each of these levels is the one that follows from those before it; the place of the first that is not.
pub fn follows(settings: &Settings, tried: &[Tried]) -> Result<(), usize> {
    let differs =
        |place: &usize| next(settings, &tried[..*place]) != Step::Try(tried[*place].attempt);
    (0..tried.len()).find(differs).map_or(Ok(()), Err)
}

/// Where the loop is.
struct Ladder {
    /// The level that the next step starts from, with its place; none before one is solved.
    solved: Option<(usize, f64)>,
    /// Levels above it that are still to be solved, the nearest last; the first is 1. While none is solved, those that failed.
    above: Vec<f64>,
    /// How many kinds of help have failed at the nearest of these, since the last level was solved.
    helps: u32,
}

impl Ladder {
    fn new(settings: &Settings) -> Ladder {
        let above = if settings.start < 1.0 { vec![1.0] } else { Vec::new() };
        Ladder { solved: None, above, helps: 0 }
    }

    fn take(&mut self, settings: &Settings, place: usize, tried: &Tried) {
        let Tried { attempt: Attempt { level, .. }, outcome } = *tried;
        match (outcome == Outcome::Solved, self.solved) {
            (true, None) => self.solved = Some((place, level)),
            (false, None) => self.above.push(level),
            (true, Some(_)) => {
                (self.solved, self.helps) = (Some((place, level)), 0);
                self.above.pop();
            }
            (false, Some((_, from))) => {
                let half_way = from + (level - from) / 2.0;
                if half_way - from >= settings.finest {
                    self.above.push(half_way);
                    self.helps = 0;
                } else {
                    self.helps += 1;
                }
            }
        }
    }

    fn step(&self, settings: &Settings) -> Step {
        let nearest = self.above.last().copied();
        let Some((place, solved)) = self.solved else {
            return match nearest.filter(|lowest| *lowest <= settings.start) {
                None => Step::Try(Attempt { level: settings.start, guide: Guide::Nothing }),
                Some(failed) if failed <= 0.0 => Step::End(Ended::NothingSolved),
                Some(failed) => {
                    let level = if failed > LOWEST_HALF { failed / 2.0 } else { 0.0 };
                    Step::Try(Attempt { level, guide: Guide::Nothing })
                }
            };
        };
        let Some(level) = nearest else { return Step::End(Ended::Solved(place)) };
        let guide = match self.helps {
            0 => Guide::Path(place),
            1 => Guide::Dissimilar(place),
            2 => Guide::Distinct(place),
            3 => Guide::Nothing,
            _ => return Step::End(Ended::Stuck { solved, failed: level }),
        };
        Step::Try(Attempt { level, guide })
    }
}
