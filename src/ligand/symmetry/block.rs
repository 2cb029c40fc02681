//! Maps from one block of a ligand to another that keep what its atoms and bonds are.

/// A map has at most so many others beside it: fullerenes have 120.
pub(super) const SYMMETRIES_MAX: usize = 1000;

/// What an atom of a block is: its element, whether the bond to the middle of the ligand ends at it, and the bonds and
/// classes of the blocks that hang on it, in rising order.
pub(super) type Label = (u8, bool, Vec<(u8, usize)>);

/// The labels of all atoms with the numbers of their neighbours in the block, in rising order.
pub(super) type Signature = Vec<(Label, usize)>;

/// The atoms of a block, numbered from 0, and the bonds among them.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub labels: Vec<Label>,
    /// Of every atom its neighbours in the block, each with what the bond is.
    pub neighbours: Vec<Vec<(usize, u8)>>,
}

/// The search took more steps than it may, or found more than [`SYMMETRIES_MAX`] maps.
pub(super) struct TooMany;

impl Shape {
    /// What two shapes have in common if there is a map from one to the other.
    pub fn signature(&self) -> Signature {
        let mut found: Vec<_> = (self.labels.iter().zip(&self.neighbours))
            .map(|(label, of)| (label.clone(), of.len()))
            .collect();
        found.sort_unstable();
        found
    }

    /// The first `most` maps to another shape of the same signature: for every atom its image. Each step of the search takes
    /// one from `steps`.
    pub fn maps(
        &self,
        other: &Shape,
        most: usize,
        steps: &mut usize,
    ) -> Result<Vec<Vec<usize>>, TooMany> {
        const NONE: usize = usize::MAX;
        let count = self.labels.len();
        let order = self.search_order();
        let mut image = vec![NONE; count];
        let mut is_taken = vec![false; count];
        let mut maps = Vec::new();
        // For each place of the order, how many candidates were tried.
        let mut tried = vec![0];
        while let Some(next) = tried.last_mut() {
            *steps = steps.checked_sub(1).ok_or(TooMany)?;
            let place = *next;
            *next += 1;
            let depth = tried.len() - 1;
            let (atom, before) = order[depth];
            if image[atom] != NONE {
                is_taken[image[atom]] = false;
                image[atom] = NONE;
            }
            let candidate = match before {
                None => (place < count).then_some(place),
                Some(before) => other.neighbours[image[before]].get(place).map(|(to, _)| *to),
            };
            let Some(candidate) = candidate else {
                tried.pop();
                continue;
            };
            if is_taken[candidate] || !self.allows(other, atom, candidate, &image) {
                continue;
            }
            image[atom] = candidate;
            is_taken[candidate] = true;
            if tried.len() < count {
                tried.push(0);
                continue;
            }
            maps.push(image.clone());
            if maps.len() == most {
                break;
            }
        }
        Ok(maps)
    }

    /// Whether an atom may go to a candidate, given where others went.
    fn allows(&self, other: &Shape, atom: usize, candidate: usize, image: &[usize]) -> bool {
        self.labels[atom] == other.labels[candidate]
            && self.neighbours[atom].len() == other.neighbours[candidate].len()
            && self.neighbours[atom].iter().all(|(near, bond)| {
                image[*near] == usize::MAX
                    || other.neighbours[candidate].contains(&(image[*near], *bond))
            })
    }

    /// The atoms in breadth from the one with the rarest label, each with the neighbour by which it was reached.
    fn search_order(&self) -> Vec<(usize, Option<usize>)> {
        let frequency = |label: &Label| self.labels.iter().filter(|other| *other == label).count();
        let first = (0..self.labels.len()).min_by_key(|atom| frequency(&self.labels[*atom]));
        let mut order: Vec<(usize, Option<usize>)> = Vec::new();
        order.extend(first.map(|first| (first, None)));
        let mut is_seen = vec![false; self.labels.len()];
        first.into_iter().for_each(|first| is_seen[first] = true);
        let mut next = 0;
        while let Some((atom, _)) = order.get(next).copied() {
            next += 1;
            for (near, _) in &self.neighbours[atom] {
                if !is_seen[*near] {
                    is_seen[*near] = true;
                    order.push((*near, Some(atom)));
                }
            }
        }
        order
    }
}
