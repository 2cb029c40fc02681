use super::{Edge, EdgeCost};
use crate::model::Directed;
use crate::numbers::NodeId;
use crate::shelf::{self, Block, BlockName, Shelf};
use bytemuck::{cast_slice, cast_slice_mut};

/// Number of edges in a block that is kept on a shelf.
const BLOCK: usize = if cfg!(test) { 1 << 5 } else { 1 << 12 };

/// A roadmap's edges in a row, column by column: an edge whose cost is its length takes 17 bytes, a directed
/// one 33. All edges of a roadmap are of one of the two kinds, since they are of one model.
#[derive(Clone, Debug, Default)]
pub struct Edges {
    is_directed: bool,
    /// The first ones, as far as they are on a shelf, [`BLOCK`] in each: all weights, of directed edges then all
    /// weights back and all peaks, then all lower ids, all higher ids, all planners.
    blocks: Vec<Block>,
    /// Those after them, which fill no block yet.
    open: OpenBlock,
}

/// Edges that fill no block yet.
#[derive(Clone, Debug, Default)]
struct OpenBlock {
    weights: Vec<f64>,
    /// Of directed edges.
    back: Vec<f64>,
    peaks: Vec<f64>,
    low: Vec<u32>,
    high: Vec<u32>,
    planners: Vec<u8>,
}

impl Edges {
    /// Number of edges.
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.open.weights.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the edges' costs depend on the direction.
    pub fn is_directed(&self) -> bool {
        self.is_directed
    }

    /// Edge `index`.
    pub fn get(&self, index: usize) -> Edge {
        match self.blocks.get(index / BLOCK) {
            None => self.open.columns().edge(index - self.blocks.len() * BLOCK),
            Some(block) => Columns::of(block, self.is_directed).edge(index % BLOCK),
        }
    }

    /// All edges in order.
    pub fn iter(&self) -> impl Iterator<Item = Edge> {
        let shared = self.blocks.iter().flat_map(|block| {
            let columns = Columns::of(block, self.is_directed);
            (0..BLOCK).map(move |index| columns.edge(index))
        });
        let columns = self.open.columns();
        shared.chain((0..self.open.weights.len()).map(move |index| columns.edge(index)))
    }

    pub(super) fn extend(&mut self, edges: impl IntoIterator<Item = Edge>) {
        for edge in edges {
            if self.is_empty() {
                self.is_directed = edge.cost.directed().is_some();
            }
            let OpenBlock { weights, back, peaks, low, high, planners } = &mut self.open;
            low.push(edge.low.0);
            high.push(edge.high.0);
            planners.push(edge.planner);
            weights.push(edge.cost.forward());
            if self.is_directed {
                // A length in a model with energies would be a mistake; it is taken as it is, either way.
                back.push(edge.cost.backward());
                peaks.push(edge.cost.directed().map_or(0.0, |directed| directed.peak));
            }
        }
    }

    /// Moves what fills whole blocks to the shelf, which replicas of the roadmap share.
    pub(super) fn share_full_blocks(&mut self, shelf: &dyn Shelf) {
        let blocks = self.open.weights.len() / BLOCK;
        let columns = self.open.columns();
        let bytes = BLOCK * bytes_of(self.is_directed);
        for index in 0..blocks {
            let name = BlockName::Edges(self.blocks.len() as u32);
            let mut fill = |block: &mut [u8]| columns.write(index * BLOCK, block);
            self.blocks.push(shelf::kept(shelf, name, bytes, &mut fill));
        }
        self.open.drop_first(blocks * BLOCK);
    }
}

/// Bytes of an edge in a block.
fn bytes_of(is_directed: bool) -> usize {
    let numbers = if is_directed { 3 } else { 1 };
    numbers * size_of::<f64>() + 2 * size_of::<u32>() + 1
}

impl OpenBlock {
    fn columns(&self) -> Columns<'_> {
        let OpenBlock { weights, back, peaks, low, high, planners } = self;
        let directed = (!back.is_empty()).then_some([&back[..], peaks]);
        Columns { weights, directed, ids: [low, high], planners }
    }

    fn drop_first(&mut self, count: usize) {
        let OpenBlock { weights, back, peaks, low, high, planners } = self;
        for numbers in [weights, back, peaks] {
            numbers.drain(..count.min(numbers.len()));
        }
        for ids in [low, high] {
            ids.drain(..count);
        }
        planners.drain(..count);
    }
}

/// Edges, column by column.
#[derive(Clone, Copy)]
struct Columns<'a> {
    weights: &'a [f64],
    /// Weights back and peaks.
    directed: Option<[&'a [f64]; 2]>,
    ids: [&'a [u32]; 2],
    planners: &'a [u8],
}

impl Columns<'_> {
    /// Those of a block.
    fn of(block: &[u8], is_directed: bool) -> Columns<'_> {
        let (weights, mut rest) = block.split_at(BLOCK * size_of::<f64>());
        let mut directed = None;
        if is_directed {
            let (back, after) = rest.split_at(BLOCK * size_of::<f64>());
            let (peaks, after) = after.split_at(BLOCK * size_of::<f64>());
            directed = Some([back, peaks].map(cast_slice));
            rest = after;
        }
        let (low, rest) = rest.split_at(BLOCK * size_of::<u32>());
        let (high, planners) = rest.split_at(BLOCK * size_of::<u32>());
        let ids = [low, high].map(cast_slice);
        Columns { weights: cast_slice(weights), directed, ids, planners }
    }

    fn edge(&self, index: usize) -> Edge {
        let [low, high] = self.ids.map(|ids| NodeId(ids[index]));
        let forward = self.weights[index];
        let cost = match self.directed {
            None => EdgeCost::Metric(forward),
            Some([back, peaks]) => {
                let (backward, peak) = (back[index], peaks[index]);
                EdgeCost::Directed(Directed { forward, backward, peak })
            }
        };
        Edge { low, high, planner: self.planners[index], cost }
    }

    /// Writes the edges from `first` on that fill a block.
    fn write(&self, first: usize, block: &mut [u8]) {
        let range = first..first + BLOCK;
        let mut rest = block;
        let mut put_numbers = |numbers: &[f64]| {
            let (column, after) = std::mem::take(&mut rest).split_at_mut(BLOCK * size_of::<f64>());
            cast_slice_mut::<u8, f64>(column).copy_from_slice(&numbers[range.clone()]);
            rest = after;
        };
        put_numbers(self.weights);
        self.directed.into_iter().flatten().for_each(&mut put_numbers);
        for ids in self.ids {
            let (column, after) = std::mem::take(&mut rest).split_at_mut(BLOCK * size_of::<u32>());
            cast_slice_mut::<u8, u32>(column).copy_from_slice(&ids[range.clone()]);
            rest = after;
        }
        rest.copy_from_slice(&self.planners[range]);
    }
}
