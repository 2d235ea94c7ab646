//! The nearest edge of every near side, and whether the node is near and faces it: eight near sides at once.

use enmm_lanes::{Kernel, LANES, Lanes, Pair, Places};

use super::NarrowPhase;
use super::near_sides::{Batch, NearRun};

/// Relative difference of squared distances above which rounding does not decide which is the larger.
const ROUNDING: f64 = 1e-12;

/// Bit of a verdict: the node is over the edge.
pub(super) const OVER: u8 = 1;
/// Bit of a verdict: the node is nearer than the reach, and may enter the edge by rule 1.
pub(super) const ENTERS: u8 = 2;
/// Bit of a verdict: the contact of the last step carried force.
pub(super) const CARRIED: u8 = 4;

/// Results for the near sides of a run.
#[derive(Debug, Clone, Default)]
pub(super) struct Nearest {
    /// Distance of each node along its nearest edge, gap, and distance beyond the end of the edge (m).
    pub along: Vec<f64>,
    pub gap: Vec<f64>,
    pub beyond: Vec<f64>,
    /// The edge, counted from the first near edge of the side.
    pub edge: Vec<u32>,
    /// [`OVER`], [`ENTERS`] and [`CARRIED`].
    pub verdict: Vec<u8>,
    /// Gap (m) of an unloaded spring; infinite where a bonded joint pulls.
    pub rest: Vec<f64>,
}

impl Nearest {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * 4 * self.gap.len() + size_of_val(self.edge.as_slice()) + self.verdict.len()
    }

    /// Sizes the buffers for so many near sides, without contacts of the last step.
    pub fn begin(&mut self, count: usize) {
        for list in [&mut self.along, &mut self.gap, &mut self.beyond] {
            list.resize(count, 0.0);
        }
        self.edge.resize(count, 0);
        self.verdict.clear();
        self.verdict.resize(count, 0);
        self.rest.clear();
        self.rest.resize(count, 0.0);
    }
}

/// Finds the nearest edges of a run: compiled for every kind of lanes.
pub(super) struct FindNearest<'a> {
    pub narrow: &'a NarrowPhase<'a>,
    pub run: NearRun<'a>,
    pub nearest: &'a mut Nearest,
}

/// Eight nodes.
struct Nodes<L: Lanes> {
    position: [L::F; 2],
    to: [[L::F; 2]; 2],
    distance: [L::F; 2],
}

/// Eight nodes over an edge each.
struct OverEdges<L: Lanes> {
    tangent: [L::F; 2],
    along: L::F,
    gap: L::F,
    beyond: L::F,
}

impl Kernel for FindNearest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let mut places = self.run.places;
        for batch in self.run.batches {
            let (edges, others) = places.split_at(batch.edges as usize);
            places = others;
            self.batch(lanes, batch, edges);
        }
    }
}

impl FindNearest<'_> {
    #[inline(always)]
    fn batch<L: Lanes>(&mut self, lanes: L, batch: &Batch, edges: &[Places]) {
        let frames = self.narrow.frames;
        let (node_pairs, edge_pairs) = (frames.node_pairs(), frames.edge_pairs());
        let nodes = Nodes::<L> {
            position: lanes.gather_from(node_pairs, &batch.nodes),
            to: [lanes.gather_from(&node_pairs[1..], &batch.nodes), lanes.gather_from(&node_pairs[2..], &batch.nodes)],
            distance: lanes.gather_from(&node_pairs[3..], &batch.nodes),
        };
        let mut best = over(lanes, &nodes.position, edge_pairs, &edges[0]);
        let mut which = lanes.splat(0.0);
        for (k, edge) in edges.iter().enumerate().skip(1) {
            let other = over(lanes, &nodes.position, edge_pairs, edge);
            let bits = nearer(lanes, &other, &best);
            which = lanes.select(bits, lanes.splat(k as f64), which);
            best = OverEdges {
                tangent: [
                    lanes.select(bits, other.tangent[0], best.tangent[0]),
                    lanes.select(bits, other.tangent[1], best.tangent[1]),
                ],
                along: lanes.select(bits, other.along, best.along),
                gap: lanes.select(bits, other.gap, best.gap),
                beyond: lanes.select(bits, other.beyond, best.beyond),
            };
        }
        self.leave(lanes, batch, &nodes, &best, which);
    }

    /// Stores what has been found.
    #[inline(always)]
    fn leave<L: Lanes>(&mut self, lanes: L, batch: &Batch, nodes: &Nodes<L>, best: &OverEdges<L>, which: L::F) {
        let at = batch.near_sides.map(|k| k as usize);
        let mut rest = [0.0; LANES];
        for lane in 0..LANES {
            rest[lane] = self.nearest.rest[at[lane]];
        }
        let near = less(lanes, best.gap - lanes.load(&rest), lanes.splat(self.narrow.reach));
        let enters = near & self.enters(lanes, nodes, best.tangent);
        let is_over = self.is_over(lanes, best);
        let [mut along, mut gap, mut beyond, mut edge] = [[0.0; LANES]; 4];
        lanes.store(best.along, &mut along);
        lanes.store(best.gap, &mut gap);
        lanes.store(best.beyond, &mut beyond);
        lanes.store(which, &mut edge);
        for (lane, k) in at.into_iter().enumerate() {
            self.nearest.along[k] = along[lane];
            self.nearest.gap[k] = gap[lane];
            self.nearest.beyond[k] = beyond[lane];
            self.nearest.edge[k] = edge[lane] as u32;
            self.nearest.verdict[k] |= ((is_over >> lane & 1) * OVER) | ((enters >> lane & 1) * ENTERS);
        }
    }

    /// Lanes whose node misses the edge by little, if at all, where the boundary bends.
    #[inline(always)]
    fn is_over<L: Lanes>(&self, lanes: L, best: &OverEdges<L>) -> u8 {
        let rule = &self.narrow.rule;
        let size = lanes.max(best.gap, -best.gap);
        let held = lanes.splat(rule.held_beyond * self.narrow.size);
        lanes.at_most(best.beyond, lanes.splat(rule.wedge_ratio) * size + held)
    }

    /// Rule 1: both neighbours of the node lie outside the edge or hardly inside, and its own rock faces the edge.
    #[inline(always)]
    fn enters<L: Lanes>(&self, lanes: L, nodes: &Nodes<L>, [x, y]: [L::F; 2]) -> u8 {
        let ([previous, next], [before, after]) = (nodes.to, nodes.distance);
        let (sine, zero) = (lanes.splat(self.narrow.rule.flush_sine), lanes.splat(0.0));
        let outside = lanes.at_most(-sine * before, previous[0] * y - previous[1] * x)
            & lanes.at_most(-sine * after, next[0] * y - next[1] * x);
        let cross = next[0] * previous[1] - next[1] * previous[0];
        let dot = next[0] * previous[0] + next[1] * previous[1];
        let is_convex = less(lanes, zero, cross) & (less(lanes, zero, dot) | less(lanes, sine * before * after, cross));
        let chord = [next[0] - previous[0], next[1] - previous[1]];
        let length = lanes.sqrt(chord[0] * chord[0] + chord[1] * chord[1]);
        let faces = less(lanes, -sine * length, -(chord[0] * x) - chord[1] * y);
        outside & (is_convex | faces)
    }
}

/// Positions relative to edges.
#[inline(always)]
fn over<L: Lanes>(lanes: L, position: &[L::F; 2], edges: &[Pair], at: &Places) -> OverEdges<L> {
    let start = lanes.gather_from(edges, at);
    let tangent = lanes.gather_from(&edges[1..], at);
    let [length, zero] = lanes.gather_from(&edges[2..], at);
    let from = [position[0] - start[0], position[1] - start[1]];
    let along = from[0] * tangent[0] + from[1] * tangent[1];
    let gap = from[0] * tangent[1] - from[1] * tangent[0];
    let beyond = lanes.max(lanes.max(-along, along - length), zero);
    OverEdges { tangent, along, gap, beyond }
}

/// Lanes in which the first edge is the nearer one.
#[inline(always)]
fn nearer<L: Lanes>(lanes: L, a: &OverEdges<L>, b: &OverEdges<L>) -> u8 {
    let own = a.beyond * a.beyond + a.gap * a.gap;
    let others = b.beyond * b.beyond + b.gap * b.gap;
    let difference = own - others;
    let clear = less(lanes, lanes.splat(ROUNDING) * others, lanes.max(difference, -difference));
    let bits = less(lanes, own, others);
    if clear == u8::MAX {
        return bits;
    }
    let mut sizes = [[0.0; LANES]; 4];
    lanes.store(a.beyond, &mut sizes[0]);
    lanes.store(a.gap, &mut sizes[1]);
    lanes.store(b.beyond, &mut sizes[2]);
    lanes.store(b.gap, &mut sizes[3]);
    bits & clear | tied(&sizes) & !clear
}

/// The same by the distances themselves, where rounding decides which square is the larger.
#[cold]
#[inline(never)]
fn tied([beyond, gap, others_beyond, others_gap]: &[[f64; LANES]; 4]) -> u8 {
    let is_nearer = |k: usize| distance(beyond[k], gap[k]) < distance(others_beyond[k], others_gap[k]);
    (0..LANES).fold(0, |bits, k| bits | u8::from(is_nearer(k)) << k)
}

/// Distance (m) from an edge.
fn distance(beyond: f64, gap: f64) -> f64 {
    if beyond > 0.0 { libm::hypot(beyond, gap) } else { gap.abs() }
}

/// Lanes in which the first is less than the second.
#[inline(always)]
fn less<L: Lanes>(lanes: L, a: L::F, b: L::F) -> u8 {
    lanes.at_most(a, b) & !lanes.at_most(b, a)
}

#[cfg(test)]
mod tests {
    use enmm_lanes::{Path, dispatch_on};

    use super::*;

    /// Distances beyond an edge and gaps of two edges.
    struct Compare([[f64; LANES]; 4]);

    impl Kernel for Compare {
        type Output = u8;

        fn run<L: Lanes>(self, lanes: L) -> u8 {
            let zero = lanes.splat(0.0);
            let over = |k: usize| OverEdges::<L> {
                tangent: [zero; 2],
                along: zero,
                beyond: lanes.load(&self.0[k]),
                gap: lanes.load(&self.0[k + 1]),
            };
            nearer(lanes, &over(0), &over(2))
        }
    }

    #[test]
    fn the_nearer_edge_is_that_of_the_smaller_distance() {
        let sizes = [0.0, 1e-17, 3e-9, 0.3, 0.4, 0.5, f64::next_up(0.5), 1e5];
        let size = |k: usize| sizes[k % sizes.len()];
        for k in 0..8 * sizes.len().pow(2) {
            let beyond = std::array::from_fn(|lane| size(k + lane));
            let gap = std::array::from_fn(|lane| -size(k / 8 + 3 * lane));
            let others_beyond = std::array::from_fn(|lane| size(k / 64 + 5 * lane));
            let others_gap = std::array::from_fn(|lane| size(k / 8 + k + lane));
            let expected = (0..LANES).fold(0, |bits, lane| {
                let own = distance(beyond[lane], gap[lane]);
                bits | u8::from(own < distance(others_beyond[lane], others_gap[lane])) << lane
            });
            for path in Path::all() {
                let found = dispatch_on(path, Compare([beyond, gap, others_beyond, others_gap]));
                assert_eq!(found, expected, "{path:?}, case {k}");
            }
        }
    }
}
