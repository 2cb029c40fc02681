use super::Exact;
use crate::space::Space;

/// What of a motion since the last exact answer is projected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The translation of the robot's base alone, as in the dissertation. A robot whose base stands still is then never expected to
    /// collide.
    Translation,
    /// The motion of the robot's nearest point, to first order: turns and joints count by their lever. Among colliding configurations all
    /// degrees of freedom count, as in the metric.
    #[default]
    NearestPoint,
}

/// What an answer rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The exact answer for this very configuration.
    Exact,
    /// The last exact answer, extrapolated by the projection rule.
    Projected,
    /// Nothing: there is no exact answer yet, or one that nothing can be extrapolated from. The answer is that nothing collides.
    Unknown,
}

/// Whether a configuration collides, approximately, and where a device has to push.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Whether it does.
    pub collides: bool,
    /// If it does and a direction is known: the force, per number of [`Space::moved`], so of a free body first the force in the world's frame
    /// and then the torque in the body's own (lengths). At the robot's nearest point, or after a collision by the metric,
    /// it has size 1; how strong it should be is the device's business.
    pub force: Option<Vec<f64>>,
    /// What the answer rests on.
    pub basis: Basis,
}

/// The projection rule: exact answers, extrapolated to other configurations (dissertation, chapter IV, section B.1).
///
/// - After a *free* configuration, whose nearest obstacle lies `md` away: a collision is expected if the motion since then, projected on
///   `md`, is longer than `md`. The force is opposite to `md`.
/// - After a *colliding* configuration, which lies `xd` away from the last one known to be free: a collision is expected if the motion from that
///   free one, projected on `xd`, is at least as long as `xd`. The force is opposite to `xd`. Where no free one is
///   known, everything is expected to collide, without a force.
///
/// For a convex robot that only translates and a single convex obstacle the first rule never misses a collision. Apart from that nothing is guaranteed.
#[derive(Clone, Debug)]
pub struct Projection {
    space: Space,
    rule: Rule,
    last: Option<Exact>,
    last_free: Option<Vec<f64>>,
}

impl Projection {
    /// A rule that has been told nothing yet.
    pub fn new(space: Space, rule: Rule) -> Projection {
        Projection { space, rule, last: None, last_free: None }
    }

    /// Takes note of an exact answer, which takes the place of the one before.
    pub fn learn(&mut self, exact: Exact) {
        if let Exact::Free { q, .. } = &exact {
            self.last_free = Some(q.clone());
        }
        self.last = Some(exact);
    }

    /// The last exact answer.
    pub fn last(&self) -> Option<&Exact> {
        self.last.as_ref()
    }

    /// Whether `q` collides: exact where the last exact answer is that of `q`, else extrapolated from it.
    ///
    /// # Errors
    /// Says what is wrong with `q`: the number of values, or a value.
    pub fn ask(&self, q: &[f64]) -> Result<Answer, String> {
        Ok(self.answer(&self.stored(q)?))
    }

    /// A configuration in stored form.
    pub(super) fn stored(&self, q: &[f64]) -> Result<Vec<f64>, String> {
        if q.len() != self.space.len() {
            return Err(format!("{} values found, {} expected", q.len(), self.space.len()));
        }
        let mut q = q.to_vec();
        self.space.canonicalize(&mut q)?;
        Ok(q)
    }

    /// The answer for a configuration in stored form.
    pub(super) fn answer(&self, q: &[f64]) -> Answer {
        let nothing = Answer { collides: false, force: None, basis: Basis::Unknown };
        let Some(last) = &self.last else { return nothing };
        if last.q() == q {
            let force = if last.collides() { self.force_back(q) } else { None };
            return Answer { collides: last.collides(), force, basis: Basis::Exact };
        }
        let (collides, force) = match last {
            Exact::Free { nearest: None, .. } => return nothing,
            Exact::Free { q: free, nearest: Some(nearest) } => {
                let mut rates = nearest.rates.clone();
                self.keep_projected(&mut rates);
                let collides =
                    dot(&rates, &self.space.tangent(free, q)) > nearest.clearance.distance;
                let is_known = rates.iter().any(|rate| *rate != 0.0);
                (collides, is_known.then(|| rates.iter().map(|rate| 0.0 - rate).collect()))
            }
            Exact::Colliding { q: colliding } => match &self.last_free {
                None => (true, None),
                Some(free) => {
                    let [way_in, way] = [&colliding[..], q].map(|to| self.motion(free, to));
                    (dot(&way, &way_in) >= dot(&way_in, &way_in), self.force_back(colliding))
                }
            },
        };
        Answer { collides, force: force.filter(|_| collides), basis: Basis::Projected }
    }

    /// The motion from one configuration to another, as far as it is projected, in lengths of the metric.
    fn motion(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let (tangent, weights) = (self.space.tangent(from, to), self.space.tangent_weights());
        let mut motion: Vec<f64> =
            tangent.iter().zip(weights).map(|(x, weight)| x * weight).collect();
        self.keep_projected(&mut motion);
        motion
    }

    /// The force that leads from a colliding configuration back to the last free one, if one is known.
    fn force_back(&self, colliding: &[f64]) -> Option<Vec<f64>> {
        let way_in = self.motion(self.last_free.as_ref()?, colliding);
        let length = dot(&way_in, &way_in).sqrt();
        let weights = self.space.tangent_weights();
        let back = way_in.iter().zip(weights).map(|(x, weight)| 0.0 - x * weight / length);
        (length > 0.0).then(|| back.collect())
    }

    /// Sets what the rule does not project to 0.
    fn keep_projected(&self, numbers: &mut [f64]) {
        if self.rule == Rule::Translation {
            // The base's position comes first.
            numbers.iter_mut().skip(self.space.translations()).for_each(|number| *number = 0.0);
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
