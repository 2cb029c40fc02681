use crate::model::{Model, Reason, Scratch, Validity};
use crate::numbers::Ordinal;
use crate::space::{FactorKind, Space, stored_form};

/// The most reasons that a message names why a configuration is not valid.
const REASONS: usize = 4;

/// A problem made ready for work: what everything that samples, joins and evaluates shares.
pub struct Context {
    /// The configuration space.
    pub(crate) space: Space,
    /// What is valid, and what motions cost.
    pub(crate) model: Box<dyn Model>,
    /// The base seed of the program's random numbers.
    pub(crate) base_seed: u64,
    /// The query to be solved, if there is one.
    pub(crate) query: Option<Ends>,
    /// Whether a query tries the direct motion between its ends, and its path has no configuration twice in a row.
    pub(crate) tries_direct_motion: bool,
}

impl Context {
    /// The configuration space.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// What is valid, and what motions cost.
    pub fn model(&self) -> &dyn Model {
        &*self.model
    }

    /// The base seed of the program's random numbers.
    pub fn base_seed(&self) -> u64 {
        self.base_seed
    }

    /// The query to be solved, if there is one: valid configurations in stored form.
    pub fn query(&self) -> Option<&Ends> {
        self.query.as_ref()
    }

    /// Whether a query tries the direct motion between its ends, and its path has no configuration twice in a row. It
    /// does, but where judgements are made again that a program recorded before it did.
    pub fn try_direct_motion(&mut self, tries: bool) {
        self.tries_direct_motion = tries;
    }

    /// Brings a configuration that came from outside into stored form, and checks it.
    ///
    /// # Errors
    /// Says what is wrong with it: the number of values, a value, or that it is not valid.
    pub fn accept(&self, q: &mut [f64]) -> Result<(), String> {
        self.stored(q)?;
        if self.model.validity(q, &mut Scratch::new()) != Validity::Valid {
            let reasons = self.model.reasons(q, true);
            let why: Vec<String> = reasons.iter().take(REASONS).map(Reason::to_string).collect();
            let more = match reasons.len().saturating_sub(REASONS) {
                0 => String::new(),
                more => format!("; and {more} more reasons"),
            };
            let why = why.join("; ");
            return Err(format!("{q:?} found, where {why}{more}; a valid configuration expected"));
        }
        Ok(())
    }

    /// Brings a configuration that came from outside, valid or not, into stored form.
    ///
    /// # Errors
    /// Says what is wrong with it: the number of values, or a value.
    pub(crate) fn stored(&self, q: &mut [f64]) -> Result<(), String> {
        let space = &self.space;
        if q.len() != space.len() {
            let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
            let (found, expected) = (q.len(), space.len());
            return Err(format!("{found} values found, {expected} expected: {}", names.join(" ")));
        }
        let given = q.to_vec();
        space.canonicalize(q)?;
        // What has stored form to within rounding stays as it is written, here too.
        for part in space.factors().iter().filter(|part| part.kind == FactorKind::Rotation) {
            let four = part.at..part.at + 4;
            let quaternion = [0, 1, 2, 3].map(|i| given[part.at + i]);
            q[four].copy_from_slice(&stored_form(quaternion).expect("it has a direction"));
        }
        Ok(())
    }
}

/// The ends of a query: valid configurations in stored form.
#[derive(Clone, Debug, PartialEq)]
pub struct Ends {
    /// Where the path begins.
    pub start: Vec<f64>,
    /// Where it ends; of several goals the first.
    pub goal: Vec<f64>,
    /// The goals after the first, each as good as that.
    pub other_goals: Vec<Vec<f64>>,
}

impl Ends {
    /// A query with one goal.
    pub fn new(start: Vec<f64>, goal: Vec<f64>) -> Ends {
        Ends { start, goal, other_goals: Vec::new() }
    }

    /// All goals, in the order of the problem.
    pub fn goals(&self) -> impl Iterator<Item = &[f64]> {
        std::iter::once(&self.goal[..]).chain(self.other_goals.iter().map(Vec::as_slice))
    }

    /// The start and all goals.
    pub fn all(&self) -> impl Iterator<Item = &[f64]> {
        std::iter::once(&self.start[..]).chain(self.goals())
    }

    /// Of a query with several goals: the number of the one, from 1, at which a path with these configurations ends.
    pub fn goal_number<'q>(&self, path: impl IntoIterator<Item = &'q [f64]>) -> Option<usize> {
        let end = path.into_iter().last().filter(|_| !self.other_goals.is_empty())?;
        self.goals().position(|goal| goal == end).map(|index| index + 1)
    }

    /// How many goals there are.
    pub(crate) fn goal_count(&self) -> u64 {
        1 + self.other_goals.len() as u64
    }

    /// The start, and the goal that a set which grows between the ends grows toward: each goal in turn, for two sets at a
    /// time, as some methods begin at either end in turn.
    pub(crate) fn of_set(&self, ordinal: Ordinal) -> [&[f64]; 2] {
        let index = (ordinal.0 / 2 % self.goal_count()) as usize;
        let goal = index.checked_sub(1).map_or(&self.goal, |other| &self.other_goals[other]);
        [&self.start, goal]
    }
}
