use super::Edge;
use crate::shelf::{self, Block, BlockName, Shelf};
use bytemuck::{cast_slice, cast_slice_mut};

/// Number of edges in a block that is kept on a shelf.
const BLOCK: usize = if cfg!(test) { 1 << 5 } else { 1 << 12 };
/// Bytes of an edge in a block.
const BYTES: usize = size_of::<f64>() + 2 * size_of::<u32>() + 1;

/// A roadmap's edges in a row.
#[derive(Clone, Debug, Default)]
pub struct Edges {
    /// The first ones, as far as they are on a shelf, [`BLOCK`] in each: all weights, then all lower ids,
    /// all higher ids, all planners.
    blocks: Vec<Block>,
    /// The others.
    rest: Vec<Edge>,
}

impl Edges {
    /// Number of edges.
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.rest.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Edge `index`.
    pub fn get(&self, index: usize) -> Edge {
        match self.blocks.get(index / BLOCK) {
            None => self.rest[index - self.blocks.len() * BLOCK],
            Some(block) => Columns::of(block).edge(index % BLOCK),
        }
    }

    /// All edges in order.
    pub fn iter(&self) -> impl Iterator<Item = Edge> {
        let shared = self.blocks.iter().flat_map(|block| {
            let columns = Columns::of(block);
            (0..BLOCK).map(move |index| columns.edge(index))
        });
        shared.chain(self.rest.iter().copied())
    }

    pub(super) fn extend(&mut self, edges: impl IntoIterator<Item = Edge>) {
        self.rest.extend(edges);
    }

    /// Moves what fills whole blocks to the shelf, which replicas of the roadmap share.
    pub(super) fn share_full_blocks(&mut self, shelf: &dyn Shelf) {
        let shared = self.rest.len() / BLOCK * BLOCK;
        for edges in self.rest[..shared].chunks_exact(BLOCK) {
            let name = BlockName::Edges(self.blocks.len() as u32);
            let mut fill = |block: &mut [u8]| write(edges, block);
            self.blocks.push(shelf::kept(shelf, name, BLOCK * BYTES, &mut fill));
        }
        self.rest.drain(..shared);
    }
}

/// The parts of a block.
struct Columns<'a> {
    weights: &'a [f64],
    ids: [&'a [u32]; 2],
    planners: &'a [u8],
}

impl Columns<'_> {
    fn of(block: &[u8]) -> Columns<'_> {
        let (weights, rest) = block.split_at(BLOCK * size_of::<f64>());
        let (low, rest) = rest.split_at(BLOCK * size_of::<u32>());
        let (high, planners) = rest.split_at(BLOCK * size_of::<u32>());
        Columns { weights: cast_slice(weights), ids: [low, high].map(cast_slice), planners }
    }

    fn edge(&self, index: usize) -> Edge {
        let [low, high] = self.ids.map(|ids| ids[index]);
        Edge { low, high, planner: self.planners[index], weight: self.weights[index] }
    }
}

fn write(edges: &[Edge], block: &mut [u8]) {
    let (weights, rest) = block.split_at_mut(BLOCK * size_of::<f64>());
    let (low, rest) = rest.split_at_mut(BLOCK * size_of::<u32>());
    let (high, planners) = rest.split_at_mut(BLOCK * size_of::<u32>());
    let [low, high] = [low, high].map(cast_slice_mut::<u8, u32>);
    let weights = cast_slice_mut::<u8, f64>(weights);
    for (index, edge) in edges.iter().enumerate() {
        (weights[index], low[index], high[index]) = (edge.weight, edge.low, edge.high);
        planners[index] = edge.planner;
    }
}
