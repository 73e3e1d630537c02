//! Small trees: grown in halves, and then collapsed to nodes of eight children whose areas are least in sum (after Ylitie, Karras and Laine 2017,
//! section 4.1).

use super::{Bulk, Counts, MOST_HALVINGS, Word, range::Range};
use crate::bvh::node::WIDTH;
use std::array::from_fn;

/// A tree of halves.
#[derive(Default)]
struct Binary {
    /// Every node after those below it.
    nodes: Vec<Node>,
    counts: Counts,
}

struct Node {
    content: Content,
    /// What it takes to replace it by at most so many trees and one, of nodes with eight children: the sum of the areas of these nodes. Leaves
    /// take nothing: all trees have the same.
    costs: [f32; WIDTH - 1],
}

enum Content {
    /// The indices of both.
    Halves([u32; 2]),
    Leaf(Word),
}

/// The tree over a range.
pub(super) fn grow(range: Range<'_>) -> Bulk {
    let mut bulk = Bulk { first: range.first(), len: range.len(), ..Bulk::default() };
    let mut binary = Binary::default();
    let root = binary.grow(range, 0);
    bulk.counts = binary.counts;
    binary.collapse(root, &mut bulk);
    bulk.counts.nodes = bulk.nodes.len();
    bulk
}

impl Binary {
    fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    /// Adds a range after so many halvings. Returns the index of its node.
    // Unlike `clamp`, `max` makes a number of what is none.
    #[allow(clippy::manual_clamp)]
    fn grow(&mut self, mut range: Range<'_>, halvings: usize) -> u32 {
        let node = if range.fits_leaf() {
            let len = range.len() as u8;
            let leaf = Word::Leaf { first: range.finish(&mut self.counts) as u32, len };
            Node { content: Content::Leaf(leaf), costs: [0.0; WIDTH - 1] }
        } else {
            // Within these bounds sums stay finite, and where areas are nothing, or not a number, fewer nodes cost less.
            let area = range.half_area().max(f32::MIN_POSITIVE).min(1e30);
            // Deep down only splits in the middle keep within the depth.
            let halve = halvings + range.len().next_power_of_two().ilog2() as usize >= MOST_HALVINGS;
            let mut room = range.pool().room();
            let halves = range.split(halve, &mut room).map(|half| self.grow(half, halvings + 1));
            Node { content: Content::Halves(halves), costs: self.costs(halves, area) }
        };
        self.nodes.push(node);
        (self.nodes.len() - 1) as u32
    }

    fn costs(&self, halves: [u32; 2], area: f32) -> [f32; WIDTH - 1] {
        let mut least = area + self.best_share(halves, WIDTH).1;
        from_fn(|more| {
            if more > 0 {
                least = least.min(self.best_share(halves, more + 1).1);
            }
            least
        })
    }

    /// Of so many trees in place of two halves, how many the first half gets, so that they cost least, and what they cost.
    fn best_share(&self, halves: [u32; 2], trees: usize) -> (usize, f32) {
        let [low, high] = halves.map(|half| &self.node(half).costs);
        let cost = |share: usize| low[share - 1] + high[trees - share - 1];
        (2..trees)
            .fold((1, cost(1)), |best, share| if cost(share) < best.1 { (share, cost(share)) } else { best })
    }

    /// Adds a node with eight children in place of a node, and those below it.
    fn collapse(&self, root: u32, bulk: &mut Bulk) {
        let at = bulk.nodes.len();
        bulk.nodes.push([None; WIDTH]);
        let mut children = Vec::with_capacity(WIDTH);
        match self.node(root).content {
            Content::Halves(halves) => self.open(halves, WIDTH, &mut children),
            Content::Leaf(_) => children.push(root),
        }
        for (slot, child) in children.into_iter().enumerate() {
            bulk.nodes[at][slot] = Some(match self.node(child).content {
                Content::Leaf(leaf) => leaf,
                Content::Halves(_) => {
                    self.collapse(child, bulk);
                    Word::Node
                }
            });
        }
    }

    /// Lists the roots of so many trees in place of two halves, in order.
    fn open(&self, halves: [u32; 2], trees: usize, roots: &mut Vec<u32>) {
        let (share, _) = self.best_share(halves, trees);
        for (half, trees) in halves.into_iter().zip([share, trees - share]) {
            let Node { content, costs } = self.node(half);
            // No more than are of use.
            let trees = (1..trees).find(|fewer| costs[fewer - 1] == costs[trees - 1]).unwrap_or(trees);
            match *content {
                Content::Halves(halves) if trees > 1 => self.open(halves, trees, roots),
                _ => roots.push(half),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use tenfold_testkit::Rng;

    /// A tree over leaves of one reference each, with areas at random.
    struct Random {
        binary: Binary,
        rng: Rng,
        /// By the first leaf and the one after the last.
        areas: BTreeMap<(u32, u32), f32>,
    }

    impl Random {
        fn grow(&mut self, first: u32, end: u32) -> u32 {
            let node = if end - first == 1 {
                Node { content: Content::Leaf(Word::Leaf { first, len: 1 }), costs: [0.0; WIDTH - 1] }
            } else {
                let middle = first + 1 + self.rng.below((end - first - 1) as usize) as u32;
                let halves = [self.grow(first, middle), self.grow(middle, end)];
                // Whole numbers, so that sums are exact, and some of them are equal.
                let area = (self.rng.f32() * 20.0).floor() + 1.0;
                self.areas.insert((first, end), area);
                Node { content: Content::Halves(halves), costs: self.binary.costs(halves, area) }
            };
            self.binary.nodes.push(node);
            (self.binary.nodes.len() - 1) as u32
        }

        /// The least cost of a subtree, found by trying everything.
        fn least(&self, root: u32) -> f32 {
            match self.binary.node(root).content {
                Content::Leaf(_) => 0.0,
                Content::Halves(halves) => self.area(root) + self.least_below(&halves, WIDTH - 2),
            }
        }

        /// The least cost of some subtrees, of which so many more may be made by opening some of them.
        fn least_below(&self, roots: &[u32], more: usize) -> f32 {
            let Some((&first, rest)) = roots.split_first() else { return 0.0 };
            let closed = self.least(first) + self.least_below(rest, more);
            match self.binary.node(first).content {
                Content::Halves(halves) if more > 0 => {
                    closed.min(self.least_below(&[&halves, rest].concat(), more - 1))
                }
                _ => closed,
            }
        }

        fn leaves(&self, root: u32) -> (u32, u32) {
            match self.binary.node(root).content {
                Content::Leaf(Word::Leaf { first, .. }) => (first, first + 1),
                Content::Leaf(Word::Node) => unreachable!(),
                Content::Halves([low, high]) => (self.leaves(low).0, self.leaves(high).1),
            }
        }

        fn area(&self, root: u32) -> f32 {
            self.areas[&self.leaves(root)]
        }

        /// Reads a collapsed tree: adds the areas of its nodes to `cost`, and checks that it has the leaves from `first` on in order. Returns the
        /// one after the last.
        fn read(
            &self,
            nodes: &mut std::slice::Iter<'_, [Option<Word>; WIDTH]>,
            first: u32,
            cost: &mut f32,
        ) -> u32 {
            let mut next = first;
            for word in nodes.next().unwrap().iter().flatten() {
                next = match word {
                    Word::Node => self.read(nodes, next, cost),
                    Word::Leaf { first, .. } => {
                        assert_eq!(*first, next);
                        next + 1
                    }
                };
            }
            *cost += self.areas[&(first, next)];
            next
        }
    }

    #[test]
    fn collapsed_trees_are_the_cheapest() {
        for seed in 0..60 {
            let mut tree = Random { binary: Binary::default(), rng: Rng::new(seed), areas: BTreeMap::new() };
            let leaves = 2 + seed as u32 % 17;
            let root = tree.grow(0, leaves);
            let mut bulk = Bulk::default();
            tree.binary.collapse(root, &mut bulk);
            let (mut nodes, mut cost) = (bulk.nodes.iter(), 0.0);
            assert_eq!(tree.read(&mut nodes, 0, &mut cost), leaves);
            assert!(nodes.next().is_none());
            assert_eq!(cost, tree.least(root), "{seed}");
        }
    }
}
