//! The light tree: a hierarchy of clusters of lights that is descended at random, toward the children that
//! send more light to the point in question (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights
//! with Adaptive Tree Splitting"), here with up to [`LANES`] children to a node, weighed all at once.

use super::bounds::LightBounds;
use super::clusters::{Clusters, LANES};
use super::descent::{Descents, Weights, remainder};
use super::split::split;
use tenfold_geometry::{ReferencePoint, ReferencePoints};
use tenfold_math::{Floats, Slots, prefetch};

/// Depth from which groups are halved, so that no light is very deep.
const HALVE_FROM: usize = 10;
/// Most lights a tree holds.
pub(crate) const MAX_LIGHTS: usize = 1 << 27;

/// Up to [`LANES`] clusters and what is in them: a node each, or a light. Three cache lines.
#[derive(Copy, Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub(super) clusters: Clusters,
    /// Index of a node, or with the bit `LIGHT` of a light.
    links: [u32; LANES],
}

const _: () = assert!(size_of::<Node>() == 192);

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
    /// Per node: where its parent has it.
    parents: Vec<Place>,
    /// Per light: where it is.
    places: Vec<Place>,
    /// How many lights it holds.
    len: usize,
    /// The light, where there is but one.
    only: Option<u32>,
}

/// A choice under way.
#[derive(Copy, Clone, Debug)]
struct Descent {
    node: u32,
    /// What is left of the number that chooses.
    u: f32,
    /// The probability of having come here.
    pmf: f32,
}

/// A lane of a node.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Place(u32);

impl Place {
    const NOWHERE: Self = Self(u32::MAX);

    fn new(node: usize, lane: usize) -> Self {
        Self((node * LANES + lane) as u32)
    }

    #[inline(always)]
    fn node(self) -> usize {
        self.0 as usize / LANES
    }

    #[inline(always)]
    fn lane(self) -> usize {
        self.0 as usize % LANES
    }
}

impl LightTree {
    /// A tree over `entries`, whose lights have indices below `lights`. Takes O(n log n); `entries` are reordered.
    pub(in crate::light) fn build(entries: &mut [Entry], lights: usize) -> Self {
        let only = if let [entry] = entries { Some(entry.light) } else { None };
        let mut tree =
            Self { places: vec![Place::NOWHERE; lights], len: entries.len(), only, ..Self::default() };
        if !entries.is_empty() {
            tree.fill(Place::NOWHERE, entries, 0);
        }
        tree
    }

    /// Builds the subtree over `entries`, to be had by `parent`, and returns its bounds.
    fn fill(&mut self, parent: Place, entries: &mut [Entry], depth: usize) -> LightBounds {
        let at = self.nodes.len();
        self.nodes.push(EMPTY);
        self.parents.push(parent);
        let cuts = cut(entries, depth < HALVE_FROM);
        let (mut all, mut links) = (Vec::with_capacity(LANES), [0; LANES]);
        for (lane, ends) in cuts.windows(2).enumerate() {
            let (group, place) = (&mut entries[ends[0]..ends[1]], Place::new(at, lane));
            if let [entry] = group {
                self.places[entry.light as usize] = place;
                links[lane] = LIGHT | entry.light;
                all.push(entry.bounds);
            } else {
                links[lane] = self.nodes.len() as u32;
                all.push(self.fill(place, group, depth + 1));
            }
        }
        self.nodes[at] = Node { clusters: Clusters::new(&all), links };
        all.into_iter().reduce(LightBounds::union).unwrap_or(entries[0].bounds)
    }

    /// How many lights it holds.
    #[inline]
    pub(in crate::light) fn len(&self) -> usize {
        self.len
    }

    /// Whether `light` is in the tree.
    pub(in crate::light) fn contains(&self, light: usize) -> bool {
        self.places[light] != Place::NOWHERE
    }

    /// An estimate of the irradiance from all lights at `from`, see [`Clusters::importance`].
    #[inline]
    pub(in crate::light) fn importance(&self, from: &ReferencePoint) -> f32 {
        self.nodes.first().map_or(0.0, |root| root.clusters.importance(from).iter().sum())
    }

    /// Draws a light by `u` in `[0, 1)`, for the point `from`. `None` where no light reaches it, or where the descent ends at lights that do not.
    #[inline]
    pub(in crate::light) fn sample(&self, from: &ReferencePoint, u: f32) -> Option<TreeSample> {
        if let Some(light) = self.only {
            return Some(TreeSample { light, pmf: 1.0 });
        }
        let mut descent = Descent { node: 0, u, pmf: 1.0 };
        loop {
            if let Some(sample) = self.descend(&mut descent, from)? {
                return Some(sample);
            }
        }
    }

    /// [`LightTree::sample`] for the points `from` in `slots`, each by its `u`: `take` is called for those that find a light.
    ///
    /// All go down together, so that their nodes are loaded side by side.
    #[inline]
    pub(in crate::light) fn samples(
        &self,
        slots: Slots,
        from: &ReferencePoints,
        u: &Floats,
        mut take: impl FnMut(usize, TreeSample),
    ) {
        if let Some(light) = self.only {
            slots.for_each(|slot| take(slot, TreeSample { light, pmf: 1.0 }));
            return;
        }
        if self.nodes.is_empty() {
            return;
        }
        let (mut descents, mut weights) = (Descents::new(u), Weights::ZERO);
        let mut under_way = slots;
        while !under_way.is_empty() {
            weights.weigh(&self.nodes, &descents.node, under_way, from);
            descents.choose(&weights);
            let mut still = Slots::NONE;
            for slot in under_way {
                let Some(lane) = descents.lane(slot, &weights) else { continue };
                let link = self.nodes[descents.node[slot] as usize].links[lane];
                if link & LIGHT != 0 {
                    take(slot, TreeSample { light: link & !LIGHT, pmf: descents.pmf[slot] });
                } else {
                    descents.node[slot] = link;
                    prefetch(&self.nodes[link as usize]);
                    still.insert(slot);
                }
            }
            under_way = still;
        }
    }

    /// One step down: the light that it ends at, if it does; `None` where it leads to none.
    #[inline(always)]
    fn descend(&self, descent: &mut Descent, from: &ReferencePoint) -> Option<Option<TreeSample>> {
        let node = self.nodes.get(descent.node as usize)?;
        let weights = node.clusters.importance(from);
        // How many lanes' sums, up to each, `x` is not below: without branches, which would go wrong as often as not.
        let (mut sums, mut total) = ([0.0; LANES], 0.0);
        for (sum, weight) in sums.iter_mut().zip(weights) {
            total += weight;
            *sum = total;
        }
        let x = descent.u * total;
        let below = sums.iter().filter(|&&sum| sum <= x).count();
        // The last lane of positive weight takes what rounding leaves over.
        let lane = if below < LANES { below } else { weights.iter().rposition(|&w| w > 0.0)? };
        let weight = weights[lane];
        let (link, pmf) = (node.links[lane], descent.pmf * (weight / total));
        if link & LIGHT != 0 {
            return Some(Some(TreeSample { light: link & !LIGHT, pmf }));
        }
        let u = remainder(x, sums[lane], weight);
        *descent = Descent { node: link, u, pmf };
        Some(None)
    }

    /// The probability with which [`LightTree::sample`] draws `light`.
    // From the light up: where the nodes are is known before what is in them, so they are loaded side by side.
    #[inline]
    pub(in crate::light) fn pmf(&self, from: &ReferencePoint, light: usize) -> f32 {
        let mut place = self.places[light];
        if place == Place::NOWHERE {
            return 0.0;
        }
        if self.only.is_some() {
            return 1.0;
        }
        let mut pmf = 1.0;
        while place != Place::NOWHERE {
            let weights = self.nodes[place.node()].clusters.importance(from);
            let weight = weights[place.lane()];
            if weight <= 0.0 {
                return 0.0;
            }
            pmf *= weight / weights.iter().sum::<f32>();
            place = self.parents[place.node()];
        }
        pmf
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
