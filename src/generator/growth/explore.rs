use super::directions::Adjacency;
use super::graph_neighbors::NeighborSearch;
use super::set::GrowingSet;
use super::settings::root;
use super::tree::GrowingTree;
use crate::roadmap::Increment;
use crate::sampler::GaveUp;
use crate::seed::Seed;

/// How a tree or graph grows toward random configurations (S. K. Nath 2013, Algorithm 2; see
/// [`Mrrg`](crate::generator::Mrrg)). RRT and RRG are its cases of one direction (Lemma 1).
pub(in crate::generator) struct Exploration {
    /// Which nodes each new one is tried with; `None` in a tree.
    pub neighbors: Option<NeighborSearch>,
    /// In how many directions a node is extended.
    pub directions: u32,
    /// How many configurations are drawn for each direction after the first.
    pub trials: u32,
}

/// The configuration toward which some of the extensions go.
#[derive(Clone, Copy)]
pub(in crate::generator) struct Aim<'a> {
    /// It.
    pub goal: &'a [f64],
    /// The probability that an extension goes toward it, as long as no node lies there.
    pub bias: f64,
}

/// Grows a tree or a graph from its [root] until the set is full: what RRT, RRG and mRRG have in common. An extension goes
/// toward the goal of the query, if there is one, with the probability `goal_bias`.
///
/// # Errors
/// [`GaveUp`] where there is no root, or too many extensions since the last milestone came to nothing.
pub(in crate::generator) fn grow_from_root(
    mut set: GrowingSet,
    seed: &Seed,
    goal_bias: f64,
    exploration: &Exploration,
) -> Result<Increment, GaveUp> {
    let cx = set.cx;
    // What is refused in a problem file can still come in bytes.
    let Some(root) = root(cx) else { return Err(GaveUp { attempts: 0 }) };
    let [mut tree] = GrowingTree::of(&mut set, seed, [root]);
    let goal = cx.query.as_ref().map(|query| query.of_set(seed.ordinal())[1]);
    let aim = goal.map(|goal| Aim { goal, bias: goal_bias });
    explore(&mut set, &mut tree, aim, exploration)?;
    Ok(set.made)
}

/// Grows a tree until the set is full.
///
/// # Errors
/// [`GaveUp`] where too many extensions since the last milestone came to nothing.
pub(in crate::generator) fn explore(
    set: &mut GrowingSet,
    tree: &mut GrowingTree,
    aim: Option<Aim>,
    exploration: &Exploration,
) -> Result<(), GaveUp> {
    let mut aim = aim.filter(|aim| aim.bias > 0.0 && !tree.has(set, aim.goal));
    let hop_limit = exploration.neighbors.as_ref().and_then(|neighbors| neighbors.hop_limit);
    let reads_edges = exploration.directions > 1 || hop_limit.is_some();
    let mut adjacency = (reads_edges && !set.is_full()).then(|| Adjacency::of(set));
    while !set.is_full() {
        set.attempt()?;
        let toward_goal = aim.filter(|aim| set.decide(aim.bias));
        let mut toward = toward_goal.map_or_else(|| tree.draw(set), |aim| aim.goal.to_vec());
        let Some(mut near) = tree.nearest(set, &toward) else {
            return Err(GaveUp { attempts: 0 });
        };
        for direction in 1..=exploration.directions {
            let first = set.next_number();
            match set.extend(near, &toward).milestone() {
                Some(new) => {
                    // Those at which the way turns.
                    (first..new).for_each(|number| tree.add(set, number));
                    exploration.take_in(set, tree, adjacency.as_ref(), near.number, new);
                    aim = aim.filter(|aim| set.config(new) != aim.goal);
                    if let Some(adjacency) = &mut adjacency {
                        adjacency.grown(set, near.number, new);
                    }
                }
                // A node that cannot be extended in the first direction is not tried in others.
                None if direction == 1 => break,
                None => {}
            }
            if direction == exploration.directions || set.is_full() {
                break;
            }
            if let Some(adjacency) = &adjacency {
                toward = adjacency.dispersed(set, near.number, exploration.trials);
                near.distance = set.cx.space.distance(set.config(near.number), &toward);
            }
        }
    }
    Ok(())
}

impl Exploration {
    /// Takes the milestone `new`, which was grown from the place `from`, into the tree, and tries the motions to its
    /// neighbours in the graph as it was before. `adjacency` is that of this graph, if it is known.
    fn take_in(
        &self,
        set: &mut GrowingSet,
        tree: &mut GrowingTree,
        adjacency: Option<&Adjacency>,
        from: u32,
        new: u32,
    ) {
        if let Some(neighbors) = &self.neighbors {
            let q = set.config(new).to_vec();
            for number in neighbors.near(set, tree, adjacency, from, &q) {
                // Where it was grown from it has its edge.
                if number != from {
                    set.join(number, new);
                }
            }
        }
        tree.add(set, new);
    }
}
