use super::Generator;
use super::elastic_walk::{Node, Place, Walks, complaint, complaint_of_length, residues, suits};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Interpolations between the two ends of a protein's transition that keep the chain whole.
///
/// From one end of the query the chain is drawn toward the other in steps that move the Cα straight to their places as
/// far as the springs of an elastic network and the linkage allow (see [`Elastic`](crate::model::Elastic)); straight
/// interpolation of torsions has the chain collapse on the way. The first walk of the strategy draws all residues from the start to the
/// goal, the second from the goal to the start; the others begin with a random step, half of them draw all residues at first, and every walk that does not get on goes on with a random window of
/// them: so domains move one after another, in different orders. A step that is refused is halved, and where that does not help a random one is taken.
///
/// The ends themselves are no milestones: they are attached when they are asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Interpolation {
    /// How far the Cα move in a step, RMSD in Å after superposition.
    #[serde(default = "default_length")]
    pub length: f64,
    /// A step from energy E to E′ > E is kept with the probability e^(−(E′ − E)/kT), this being kT in the model's unit of energy.
    #[serde(default = "default_kt")]
    pub kt: f64,
    /// The most steps tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for Interpolation {
    fn default() -> Interpolation {
        Interpolation { length: default_length(), kt: default_kt(), attempts: default_attempts() }
    }
}

/// A walk that is refused so many steps toward its end in a row begins anew.
const REFUSED_MAX: usize = 8;

fn default_length() -> f64 {
    0.5
}

fn default_kt() -> f64 {
    200.0
}

fn default_attempts() -> u64 {
    1000
}

impl Generator for Interpolation {
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let attempts = self.attempts;
        let (Some(residues), Some(query)) = (residues(cx), cx.query.clone()) else {
            return Err(GaveUp { attempts: 0 });
        };
        // What is refused in a problem file can still come in bytes.
        if self.complaint().is_some() {
            return Err(GaveUp { attempts: 0 });
        }
        let ends = [&query.start, &query.goal];
        let mut walks = Walks::new(cx, seed, scratch, count, (self.kt, attempts));
        for walk in seed.ordinal().0 as usize % 2.. {
            let [from, to] = [walk % 2, (walk + 1) % 2].map(|end| ends[end]);
            let mut place = Place { node: Node::None, q: from.clone() };
            let is_first = seed.ordinal().0 < 2 && walk < 2;
            let mut window = if is_first { 0..residues } else { walks.window(residues) };
            if !is_first {
                // So that no two walks are the same.
                walks.attempt(attempts)?;
                place = walks.random(&place, self.length).unwrap_or(place);
                if walks.is_full() {
                    return Ok(walks.made);
                }
            }
            let mut refused = 0;
            while refused < REFUSED_MAX {
                walks.attempt(attempts)?;
                let drawn = (&to[..], window.clone());
                let Some(next) = walks.toward(&place, drawn, self.length) else {
                    refused += 1;
                    window = walks.window(residues);
                    place = walks.random(&place, self.length).unwrap_or(place);
                    if walks.is_full() {
                        return Ok(walks.made);
                    }
                    continue;
                };
                refused = 0;
                let has_arrived = walks.has_arrived(&place, &next, self.length);
                place = next;
                if walks.is_full() {
                    return Ok(walks.made);
                }
                if has_arrived && window.len() == residues {
                    break;
                }
                if has_arrived {
                    // Some residues are where they are to be; the rest follow.
                    window = 0..residues;
                }
            }
        }
        unreachable!("walks are counted without end")
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint_of_length("length", self.length).or_else(|| complaint(self.kt, self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        suits(cx)
    }
}
