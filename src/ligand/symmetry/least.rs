//! The least sum of squared distances over all symmetries, and a symmetry that has it.

use super::assignment::assign;
use super::tree::Tree;
use crate::structure::Point;

/// To which blocks each block can go, in rising order.
pub(super) type Images = Vec<Vec<usize>>;

/// The least sum, in Å², of the squared distances of heavy atoms of `a` from those of `b` to which a symmetry takes them.
pub(super) fn sum(tree: &Tree, images: &Images, a: &[Point], b: &[Point]) -> f64 {
    Search::new(tree, images, a, b).middle().0
}

/// A symmetry with the least sum: for every atom of the tree the one to which it goes; others stay.
pub(super) fn symmetry(tree: &Tree, images: &Images, a: &[Point], b: &[Point]) -> Vec<usize> {
    let search = Search::new(tree, images, a, b);
    let mut to: Vec<usize> = (0..a.len()).collect();
    let mut pairs = search.middle().1;
    while let Some((from, image)) = pairs.pop() {
        for (atom, goal) in search.best(from, image).1 {
            to[atom] = goal;
            search.branches(atom, goal, |from, image| pairs.push((from, image)));
        }
    }
    to
}

/// The least sums of pairs of branches that are alike.
struct Search<'a> {
    tree: &'a Tree,
    a: &'a [Point],
    b: &'a [Point],
    /// The sum of a pair, by the number of its first block and the place of its second in `images`.
    sums: Vec<Vec<f64>>,
    images: &'a Images,
}

impl<'a> Search<'a> {
    fn new(tree: &'a Tree, images: &'a Images, a: &'a [Point], b: &'a [Point]) -> Search<'a> {
        let sums = images.iter().map(|of| Vec::with_capacity(of.len())).collect();
        let mut search = Search { tree, a, b, sums, images };
        // From the leaves to the middle, so that what hangs on a block comes before it.
        for from in (0..tree.blocks.len()).rev() {
            for image in &images[from] {
                let (sum, _) = search.best(from, *image);
                search.sums[from].push(sum);
            }
        }
        search
    }

    fn sum_of(&self, from: usize, image: usize) -> f64 {
        let place = self.images[from].binary_search(&image);
        place.map_or(f64::INFINITY, |place| self.sums[from][place])
    }

    /// The least sum of all, with the images of the blocks in the middle.
    fn middle(&self) -> (f64, Vec<(usize, usize)>) {
        let each: Vec<(usize, usize)> = (0..self.tree.middle).map(|block| (block, block)).collect();
        let sum = |pairs: &[(usize, usize)]| -> f64 {
            pairs.iter().map(|(from, image)| self.sum_of(*from, *image)).sum()
        };
        let swapped = vec![(0, 1), (1, 0)];
        match self.tree.can_swap() && sum(&swapped) < sum(&each) {
            true => (sum(&swapped), swapped),
            false => (sum(&each), each),
        }
    }

    /// The least sum of two branches that are alike, with the images of the atoms of the first one's block.
    fn best(&self, from: usize, image: usize) -> (f64, Vec<(usize, usize)>) {
        let (from, image) = (&self.tree.blocks[from], &self.tree.blocks[image]);
        let maps = &self.tree.classes[from.class].maps;
        let count = from.atoms.len();
        // Sums of pairs of atoms are used in several maps.
        let mut known = vec![f64::NAN; if maps.len() > 1 { count * count } else { 0 }];
        let mut least = f64::INFINITY;
        let mut best = Vec::new();
        for map in maps {
            let atoms = map.iter().enumerate().map(|(first, to)| {
                (from.atoms[from.from_first[first]], image.atoms[image.from_first[*to]])
            });
            let mut sum = 0.0;
            for ((first, to), (atom, goal)) in map.iter().enumerate().zip(atoms.clone()) {
                sum += match known.get_mut(first * count + to) {
                    Some(known) if known.is_nan() => {
                        *known = self.pair(atom, goal);
                        *known
                    }
                    Some(known) => *known,
                    None => self.pair(atom, goal),
                };
            }
            if sum < least || best.is_empty() {
                least = sum;
                best = atoms.collect();
            }
        }
        (least, best)
    }

    /// The least sum if an atom goes to another one: its own square, and what hangs on it.
    fn pair(&self, atom: usize, goal: usize) -> f64 {
        let mut sum = match self.tree.is_heavy(atom) {
            true => (self.a[atom] - self.b[goal]).norm_squared(),
            false => 0.0,
        };
        self.branches(atom, goal, |from, image| sum += self.sum_of(from, image));
        sum
    }

    /// Gives the images of what hangs on an atom if it goes to another one.
    fn branches(&self, atom: usize, goal: usize, mut give: impl FnMut(usize, usize)) {
        for (alike, images) in self.tree.alike(atom).zip(self.tree.alike(goal)) {
            if let ([from], [image]) = (alike, images) {
                give(*from, *image);
                continue;
            }
            let cost = |row: usize, column: usize| self.sum_of(alike[row], images[column]);
            for (row, column) in assign(alike.len(), cost).into_iter().enumerate() {
                give(alike[row], images[column]);
            }
        }
    }
}

/// For every block those to which a symmetry may take it, in rising order.
pub(super) fn images(tree: &Tree) -> Images {
    let mut images: Images = vec![Vec::new(); tree.blocks.len()];
    for (block, images) in images.iter_mut().enumerate().take(tree.middle) {
        *images = if tree.can_swap() { vec![0, 1] } else { vec![block] };
    }
    // From the middle to the leaves: blocks come after that on which they hang.
    for from in 0..tree.blocks.len() {
        images[from].sort_unstable();
        images[from].dedup();
        let block = &tree.blocks[from];
        let maps = &tree.classes[block.class].maps;
        let mut goals: Vec<Vec<usize>> = vec![Vec::new(); block.atoms.len()];
        for map in maps {
            for (first, to) in map.iter().enumerate() {
                goals[first].push(*to);
            }
        }
        for (first, goals) in goals.iter_mut().enumerate() {
            goals.sort_unstable();
            goals.dedup();
            let atom = block.atoms[block.from_first[first]];
            if tree.branches[atom].is_empty() {
                continue;
            }
            let at = images[from].clone();
            for image in at.iter().map(|image| &tree.blocks[*image]) {
                for goal in goals.iter().map(|to| image.atoms[image.from_first[*to]]) {
                    for (alike, others) in tree.alike(atom).zip(tree.alike(goal)) {
                        alike.iter().for_each(|branch| images[*branch].extend_from_slice(others));
                    }
                }
            }
        }
    }
    images
}
