//! The light tree: a hierarchy of clusters of lights that is descended at random, toward the children that
//! send more light to the point in question (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights
//! with Adaptive Tree Splitting"), here with up to [`LANES`] children to a node, weighed all at once.

use super::bounds::{Clusters, LANES, LightBounds};
use super::split::split;
use tenfold_geometry::ReferencePoint;
use tenfold_math::ONE_MINUS_EPSILON;

/// Depth from which groups are halved: no light is then deeper than a trail is long.
const HALVE_FROM: usize = 10;
/// Bits of a trail for each level.
const LANE_BITS: usize = 3;
/// Most lights a tree holds.
pub(crate) const MAX_LIGHTS: usize = 1 << 27;

/// Up to [`LANES`] clusters and what is in them: a node each, or a light.
#[derive(Copy, Clone, Debug)]
struct Node {
    clusters: Clusters,
    /// Index of a node, or with the bit `LIGHT` of a light.
    links: [u32; LANES],
}

const LIGHT: u32 = 1 << 31;
const EMPTY: Node = Node { clusters: Clusters::EMPTY, links: [0; LANES] };

/// A light with its bounds, as the tree is built from it.
#[derive(Copy, Clone, Debug)]
pub(in crate::light) struct Entry {
    pub(in crate::light) bounds: LightBounds,
    pub(in crate::light) light: u32,
}

/// A light drawn from a [`LightTree`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub(in crate::light) struct TreeSample {
    /// Index of the light.
    pub(in crate::light) light: u32,
    /// Probability of this light.
    pub(in crate::light) pmf: f32,
}

/// See the module. In scenes of up to [`LANES`] lights each is weighed by itself.
#[derive(Clone, Debug, Default)]
pub(in crate::light) struct LightTree {
    nodes: Vec<Node>,
    /// Per light: which lanes lead to it from the root, [`LANE_BITS`] a level from the lowest; or `NOWHERE`.
    trails: Vec<u64>,
    /// The light, where there is but one.
    only: Option<u32>,
}

const NOWHERE: u64 = u64::MAX;

impl LightTree {
    /// A tree over `entries`, whose lights have indices below `lights`. Takes O(n log n); `entries` are reordered.
    pub(in crate::light) fn build(entries: &mut [Entry], lights: usize) -> Self {
        let only = if let [entry] = entries { Some(entry.light) } else { None };
        let mut tree = Self { nodes: Vec::new(), trails: vec![NOWHERE; lights], only };
        if !entries.is_empty() {
            tree.nodes.push(EMPTY);
            tree.fill(0, entries, 0, 0);
        }
        tree
    }

    /// Builds the subtree over `entries` at node `at` and returns its bounds.
    fn fill(&mut self, at: usize, entries: &mut [Entry], trail: u64, depth: usize) -> LightBounds {
        let cuts = cut(entries, depth < HALVE_FROM);
        let mut whole: Option<LightBounds> = None;
        for (lane, ends) in cuts.windows(2).enumerate() {
            let group = &mut entries[ends[0]..ends[1]];
            let trail = trail | (lane as u64) << (LANE_BITS * depth);
            let bounds = if let [entry] = group {
                self.trails[entry.light as usize] = trail;
                self.nodes[at].links[lane] = LIGHT | entry.light;
                entry.bounds
            } else {
                let child = self.nodes.len();
                self.nodes.push(EMPTY);
                self.nodes[at].links[lane] = child as u32;
                self.fill(child, group, trail, depth + 1)
            };
            self.nodes[at].clusters.set(lane, &bounds);
            whole = Some(whole.map_or(bounds, |w| w.union(bounds)));
        }
        whole.unwrap_or(entries[0].bounds)
    }

    /// Whether `light` is in the tree.
    pub(in crate::light) fn contains(&self, light: usize) -> bool {
        self.trails[light] != NOWHERE
    }

    /// An estimate of the irradiance from all lights at `from`, see [`Clusters::importance`].
    #[inline]
    pub(in crate::light) fn importance(&self, from: &ReferencePoint) -> f32 {
        self.nodes.first().map_or(0.0, |root| root.clusters.importance(from).iter().sum())
    }

    /// Draws a light by `u` in `[0, 1)`, for the point `from`. `None` where no light reaches it, or where the descent ends at lights that do not.
    #[inline]
    pub(in crate::light) fn sample(&self, from: &ReferencePoint, mut u: f32) -> Option<TreeSample> {
        if let Some(light) = self.only {
            return Some(TreeSample { light, pmf: 1.0 });
        }
        let mut node = self.nodes.first()?;
        let mut pmf = 1.0;
        loop {
            let weights = node.clusters.importance(from);
            let total: f32 = weights.iter().sum();
            let mut rest = u * total;
            // The last lane of positive weight takes what rounding leaves over.
            let mut chosen = None;
            for (i, &w) in weights.iter().enumerate() {
                if w > 0.0 {
                    chosen = Some((i, rest));
                    if rest < w {
                        break;
                    }
                    rest -= w;
                }
            }
            let (lane, rest) = chosen?;
            pmf *= weights[lane] / total;
            let link = node.links[lane];
            if link & LIGHT != 0 {
                return Some(TreeSample { light: link & !LIGHT, pmf });
            }
            u = (rest / weights[lane]).min(ONE_MINUS_EPSILON);
            node = &self.nodes[link as usize];
        }
    }

    /// The probability with which [`LightTree::sample`] draws `light`.
    #[inline]
    pub(in crate::light) fn pmf(&self, from: &ReferencePoint, light: usize) -> f32 {
        let mut trail = self.trails[light];
        if trail == NOWHERE {
            return 0.0;
        }
        if self.only.is_some() {
            return 1.0;
        }
        let mut node = &self.nodes[0];
        let mut pmf = 1.0;
        loop {
            let weights = node.clusters.importance(from);
            let lane = trail as usize % LANES;
            trail >>= LANE_BITS;
            if weights[lane] <= 0.0 {
                return 0.0;
            }
            pmf *= weights[lane] / weights.iter().sum::<f32>();
            let link = node.links[lane];
            if link & LIGHT != 0 {
                return pmf;
            }
            node = &self.nodes[link as usize];
        }
    }
}

/// Reorders `entries` into up to [`LANES`] groups, by cutting the largest one again and again; group `i` reaches from
/// the `i`th of the places returned to the next.
fn cut(entries: &mut [Entry], by_cost: bool) -> Vec<usize> {
    let mut cuts = vec![0, entries.len()];
    while cuts.len() <= LANES {
        let sizes = cuts.windows(2).map(|w| w[1] - w[0]).enumerate();
        // The first one of the largest.
        let Some((i, size)) = sizes.rev().max_by_key(|&(_, size)| size).filter(|&(_, size)| size > 1) else {
            break;
        };
        let group = &mut entries[cuts[i]..cuts[i + 1]];
        let middle = if by_cost { split(group) } else { size / 2 };
        cuts.insert(i + 1, cuts[i] + middle);
    }
    cuts
}
