use crate::evaluate::{EvaluatorKind, Verdict};

/// What a build came to at the end of a round.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundOutcome {
    /// Nodes of the roadmap.
    pub nodes: u64,
    /// Its connected components.
    pub components: u64,
    /// What the evaluators said of it; nothing of a round that was not judged.
    pub numbers: Vec<RoundValue>,
    /// Whether each criterion is met, in their order; nothing of a round that was not judged.
    pub satisfied: Vec<bool>,
}

/// A number that an evaluator gave.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundValue {
    /// The evaluator, and of its further numbers which: `flow-ratio, flow back`.
    pub name: String,
    /// The number, which may be infinite.
    pub value: f64,
    /// What an evaluator's own value is compared with.
    pub threshold: Option<f64>,
}

impl RoundValue {
    /// The numbers of evaluators in their order, with those of which they are made; a second evaluator of one name is told
    /// apart by a number behind it.
    pub fn of(evaluators: &[EvaluatorKind], verdicts: &[Verdict]) -> Vec<RoundValue> {
        let mut numbers: Vec<RoundValue> = Vec::new();
        collect(evaluators, verdicts, &mut numbers);
        numbers
    }
}

fn collect(evaluators: &[EvaluatorKind], verdicts: &[Verdict], numbers: &mut Vec<RoundValue>) {
    for (evaluator, verdict) in evaluators.iter().zip(verdicts) {
        let method = evaluator.method();
        // What is made of others only counts them.
        if method.parts().is_empty() {
            let is_taken = |name: &str| numbers.iter().any(|number| number.name == name);
            let mut name = method.name().to_owned();
            let mut ordinal = 1;
            while is_taken(&name) {
                ordinal += 1;
                name = format!("{} {ordinal}", method.name());
            }
            let threshold = Some(verdict.threshold);
            numbers.push(RoundValue { name: name.clone(), value: verdict.value, threshold });
            numbers.extend(method.measures().iter().zip(&verdict.measures).map(
                |(measure, value)| RoundValue {
                    name: format!("{name}, {measure}"),
                    value: *value,
                    threshold: None,
                },
            ));
        }
        collect(method.parts(), &verdict.parts, numbers);
    }
}
