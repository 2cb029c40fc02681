//! A digest for what all levels so far came to.

use super::Tried;
use super::ladder::Attempt;
use crate::digest::Digest;
use crate::wire;

/// The digest before any level: of the problem that is to be solved, its query included, and of how it is relaxed.
pub fn chain_begin(problem: Digest, query: &[u8], settings: &str) -> Digest {
    Digest::of(&wire::encode(&(
        "roadmill relaxation 1",
        problem,
        query.to_vec(),
        settings.to_owned(),
    )))
}

/// The digest after one more level: `came_to` is the digest of that level's problem and that of its roadmap, if anything was built. Both
/// are the same however often the build was interrupted, so that the chain is, too.
pub fn chain(before: Digest, tried: &Tried, came_to: Option<[Digest; 2]>) -> Digest {
    let Attempt { level, guide } = tried.attempt;
    let guide = (guide.name().to_owned(), guide.of().map(|of| of as u64));
    let outcome = tried.outcome.name().to_owned();
    let came_to = came_to.map(|[problem, roadmap]| (problem, roadmap));
    let whole = (before, level.to_bits(), guide, outcome, came_to);
    Digest::of(&wire::encode(&whole))
}
