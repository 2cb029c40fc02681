use crate::exit::Failure;
use crate::run::Scan;
use roadmill::numbers::{Ordinal, RoundNumber, SetNumber};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, RoundSet};
use std::collections::BTreeSet;

/// The share that is recomputed unless something else is asked for.
const DEFAULT_SHARE: f64 = 0.01;

/// What is recomputed.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// Everything.
    All,
    /// A share of all sets and judgements, from 0 to 1, at least one set. Which follows from the ledger's hash.
    Share(f64),
    /// These sets, each as `LABEL:ORDINAL`.
    Sets(Vec<String>),
}

/// One set or judgement in a hundred.
impl Default for Selection {
    fn default() -> Selection {
        Selection::Share(DEFAULT_SHARE)
    }
}

/// What is recomputed of a run.
pub(super) enum Choice {
    All,
    /// Sets by label and ordinal.
    Named(BTreeSet<(String, Ordinal)>),
    /// A share; which follows from the ledger's hash.
    Share(f64, Digest),
    /// As the least share: this set.
    One(SetNumber),
}

impl Choice {
    pub fn new(selection: &Selection, scan: &Scan, problem: &Problem) -> Result<Choice, Failure> {
        let share = match selection {
            Selection::All => return Ok(Choice::All),
            Selection::Sets(names) => return Choice::named(names, problem),
            Selection::Share(share) => *share,
        };
        let sets = scan.last_round.as_ref().map_or(0, |end| end.sets);
        let lots = (0..sets).map(|number| (lot(&scan.end.chain, b"set", number), number));
        Ok(match lots.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((least, number)) if least >= share => Choice::One(SetNumber(number)),
            _ => Choice::Share(share, scan.end.chain),
        })
    }

    fn named(names: &[String], problem: &Problem) -> Result<Choice, Failure> {
        let known = |label: &str| problem.strategies().iter().any(|known| known.label() == label);
        let parse = |text: &String| {
            let (label, ordinal) = text.rsplit_once(':')?;
            known(label).then_some((label.to_owned(), Ordinal(ordinal.parse().ok()?)))
        };
        let parse = |text| {
            parse(text).ok_or_else(|| {
                let labels: Vec<_> = problem.strategies().iter().map(|s| s.label()).collect();
                let labels = labels.join(", ");
                let expected = format!("LABEL:ORDINAL expected, with a label of {labels}");
                Failure::usage(format!("--set: `{text}` found; {expected}"))
            })
        };
        names.iter().map(parse).collect::<Result<_, _>>().map(Choice::Named)
    }

    pub fn has_set(&self, set: &RoundSet, label: &str) -> bool {
        match self {
            Choice::All => true,
            Choice::Named(names) => names.contains(&(label.to_owned(), set.ordinal)),
            Choice::Share(share, chain) => lot(chain, b"set", set.number.0) < *share,
            Choice::One(number) => set.number == *number,
        }
    }

    /// Whether more sets are named than these.
    pub fn has_more_sets_than(&self, sets: u64) -> bool {
        matches!(self, Choice::Named(names) if sets < names.len() as u64)
    }

    /// Whether any judgement may be recomputed.
    pub fn has_judgements(&self) -> bool {
        matches!(self, Choice::All | Choice::Share(..))
    }

    pub fn has_judgement(&self, round: RoundNumber) -> bool {
        match self {
            Choice::All => true,
            Choice::Share(share, chain) => lot(chain, b"judgement", round.0) < *share,
            Choice::Named(_) | Choice::One(_) => false,
        }
    }
}

/// A number in `[0, 1)` that looks drawn by lot.
fn lot(chain: &Digest, what: &[u8], number: u64) -> f64 {
    let bytes = [&chain.0, what, &number.to_le_bytes()].concat();
    let [a, b, c, d, e, f, ..] = Digest::of(&bytes).0;
    u64::from_le_bytes([a, b, c, d, e, f, 0, 0]) as f64 / (1u64 << 48) as f64
}
