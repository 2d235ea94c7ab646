//! Hosts: which element carries what acts on the boundary of an element that a cut has left almost nothing of.

use super::covers::Covers;
use super::{CoverId, ElementId};

/// Share of a full cover's area below which a cover is too light to carry forces of its own,
const LIGHT: f64 = 0.05;
/// and share of the heaviest one near by, in thin blocks, in which all are light.
const LIGHT_BESIDE: f64 = 0.25;
/// Relative difference below which two elements are equally heavy.
const TIE: f64 = 1e-9;
/// Rings of neighbours that are searched for a host.
const RINGS: usize = 3;

/// For each element, itself or the best neighbour within its block.
///
/// A cover that only a sliver reaches has the mass and the stiffness of the sliver: a contact that loads it would throw
/// it away. The displacement of the sliver's boundary is taken from the heavier element beside it instead, extrapolated
/// by its weights, which are affine and thus move rigidly with the block.
pub(super) fn hosts(covers: &Covers) -> Vec<ElementId> {
    let quality = covers.qualities();
    let edges = MeshEdges::new(covers);
    let host = |e: ElementId| {
        if quality[e].lightest >= LIGHT {
            return e;
        }
        let mut rings = vec![vec![e]];
        for _ in 0..RINGS {
            let last = rings.last().into_iter().flatten();
            let mut ring: Vec<ElementId> = last.flat_map(|&f| edges.neighbours(covers, f)).collect();
            ring.sort_unstable();
            ring.dedup();
            rings.push(ring);
        }
        let best = rings.iter().map(|ring| best(ring, &quality)).collect::<Vec<ElementId>>();
        let most = best.iter().map(|&f| quality[f].lightest).fold(0.0, f64::max);
        let enough = LIGHT.min(LIGHT_BESIDE * most);
        let is_enough = |f: ElementId| quality[f].lightest >= enough;
        best.into_iter().find(|&f| is_enough(f)).unwrap_or(e)
    };
    covers.elements().map(host).collect()
}

/// The heaviest element, the first of equals.
fn best(elements: &[ElementId], quality: &[Quality]) -> ElementId {
    let better = |a: ElementId, &b: &ElementId| if quality[b].exceeds(&quality[a]) { b } else { a };
    elements[1..].iter().fold(elements[0], better)
}

/// Areas of an element's covers over that of a full cover.
#[derive(Debug, Clone, Copy)]
struct Quality {
    lightest: f64,
    total: f64,
}

impl Quality {
    /// Whether the lightest cover is the heavier one; of elements that share it, all covers count.
    fn exceeds(&self, other: &Self) -> bool {
        let above = |a: f64, b: f64| a > b * (1.0 + TIE);
        above(self.lightest, other.lightest) || !above(other.lightest, self.lightest) && above(self.total, other.total)
    }
}

impl Covers {
    fn qualities(&self) -> Vec<Quality> {
        let mut area = vec![0.0; self.cover_count()];
        for (ids, a) in self.element_covers.iter().zip(&self.element_area) {
            ids.iter().for_each(|&i| area[i] += a);
        }
        let full = 6.0 * 0.25 * 3f64.sqrt() * self.mesh.size * self.mesh.size;
        let quality = |ids: &[CoverId; 3]| {
            let areas = ids.map(|i| area[i] / full);
            Quality { lightest: areas.into_iter().fold(f64::INFINITY, f64::min), total: areas.iter().sum() }
        };
        self.element_covers.iter().map(quality).collect()
    }

    /// The one of two elements that carries a point between them: the one that is no sliver, else the host of the
    /// heavier. It does not depend on their order.
    pub(crate) fn carriers(&self) -> impl Fn(ElementId, ElementId) -> ElementId {
        let quality = self.qualities();
        move |before, after| {
            let [before, after] = [before, after].map(|element| [element, self.host[element]]);
            let is_sliver = |[element, host]: [ElementId; 2]| element != host;
            let is_heavier = quality[before[1]].exceeds(&quality[after[1]]);
            let takes_before = is_sliver(after) && (!is_sliver(before) || is_heavier);
            (if takes_before { before } else { after })[1]
        }
    }
}

/// Pairs of covers with the elements that have both, sorted.
struct MeshEdges(Vec<([CoverId; 2], ElementId)>);

impl MeshEdges {
    fn new(covers: &Covers) -> Self {
        let mut edges: Vec<([CoverId; 2], ElementId)> =
            covers.elements().flat_map(|e| cover_pairs(covers, e).map(|pair| (pair, e))).collect();
        edges.sort_unstable();
        Self(edges)
    }

    /// Elements that share two covers with an element, hence a mesh edge that no joint cuts; itself as well.
    fn neighbours(&self, covers: &Covers, element: ElementId) -> impl Iterator<Item = ElementId> {
        cover_pairs(covers, element).into_iter().flat_map(move |pair| {
            let first = self.0.partition_point(|edge| edge.0 < pair);
            self.0[first..].iter().take_while(move |edge| edge.0 == pair).map(|edge| edge.1)
        })
    }
}

/// The pairs of an element's covers, the lower one first.
fn cover_pairs(covers: &Covers, element: ElementId) -> [[CoverId; 2]; 3] {
    let ids = covers.element_covers[element];
    [[0, 1], [1, 2], [2, 0]].map(|[k, l]| [ids[k].min(ids[l]), ids[k].max(ids[l])])
}
