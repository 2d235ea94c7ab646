//! The nearest edge of every near side, and which near sides the node cannot enter: eight at once. The vertex rule
//! decides on all others. `tests/vertex_rule.rs` holds both together.

use enmm_lanes::{Kernel, LANES, Lanes, Pair, Places, dispatch};

use crate::contact::constants::SQUARES_ROUND_OFF;
use crate::contact::vertex_rule::distance;
use crate::contact::{ContactState, FoundContact, VertexRule};

use super::near_sides::{Batch, NearRun, NearSides};

/// No contact of the last step.
const NONE: u32 = u32::MAX;

/// Results for the near sides of a run.
#[derive(Debug, Clone, Default)]
pub(super) struct Nearest {
    /// The nearest edge, counted from the first near edge of the side.
    pub edge: Vec<u32>,
    /// Whether the node may enter it: 0 or 1. Before the edges are found: whether the contact carried force.
    pub may_enter: Vec<u8>,
    /// Contact of the last step, or [`NONE`].
    known: Vec<u32>,
    /// Gap (m) at which its spring is unloaded.
    rest: Vec<f64>,
}

impl Nearest {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let numbers = size_of_val(self.edge.as_slice()) + size_of_val(self.known.as_slice());
        numbers + size_of_val(self.rest.as_slice()) + self.may_enter.len()
    }

    /// The contact of the last step of a near side.
    #[inline(always)]
    pub fn held(&self, k: usize) -> Option<u32> {
        (self.known[k] != NONE).then_some(self.known[k])
    }

    /// Finds the nearest edges of a run, which of them nodes may enter, and their contacts of the last step, which were
    /// found as `last` says, as a rule; near sides of nodes that stay are left out.
    pub fn fill(&mut self, rule: &VertexRule, run: NearRun, stays: &[bool], last: &[FoundContact]) {
        let (count, Self { edge, may_enter, known, rest }) = (run.near_sides.len(), &mut *self);
        edge.resize(count, 0);
        known.clear();
        known.resize(count, NONE);
        may_enter.clear();
        may_enter.resize(count, 0);
        rest.clear();
        rest.resize(count, 0.0);
        for k in rule.cache.of_nodes(run.nodes()) {
            let contact = &rule.history[k];
            let guess = last.get(k).map_or(usize::MAX, |known| (known.near_side as usize).wrapping_sub(run.first));
            if let Some(at) = run.of(contact, guess).filter(|&at| !stays[at]) {
                known[at] = k as u32;
                may_enter[at] = u8::from(contact.state != ContactState::Open);
                rest[at] = contact.unloaded_gap();
            }
        }
        dispatch(Prefilter { rule, run, stays, nearest: self });
    }
}

/// Whether each near side is left to the vertex rule.
pub fn prefiltered(rule: &VertexRule, near_sides: &NearSides) -> Vec<bool> {
    let (mut nearest, mut left) = (Nearest::default(), Vec::new());
    for k in 0..near_sides.runs() {
        let run = near_sides.run(k);
        nearest.fill(rule, run, &vec![false; run.near_sides.len()], &[]);
        left.extend(nearest.may_enter.iter().map(|&may_enter| may_enter != 0));
    }
    left
}

/// Finds the nearest edges of a run: compiled for every kind of lanes.
pub(super) struct Prefilter<'a> {
    pub rule: &'a VertexRule<'a>,
    pub run: NearRun<'a>,
    pub stays: &'a [bool],
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
    gap: L::F,
    beyond: L::F,
}

impl Kernel for Prefilter<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let mut places = self.run.places;
        for batch in self.run.batches {
            let (edges, others) = places.split_at(batch.edges as usize);
            places = others;
            if batch.near_sides.iter().all(|&k| self.stays[k as usize]) {
                continue;
            }
            self.batch(lanes, batch, edges);
        }
    }
}

impl Prefilter<'_> {
    #[inline(always)]
    fn batch<L: Lanes>(&mut self, lanes: L, batch: &Batch, edges: &[Places]) {
        let frames = self.rule.frames;
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
        let rest = at.map(|k| self.nearest.rest[k]);
        let near = less(lanes, best.gap - lanes.load(&rest), lanes.splat(self.rule.reach));
        let is_outside = self.is_outside(lanes, nodes, best.tangent);
        let is_over = self.is_over(lanes, best);
        let mut edge = [0.0; LANES];
        lanes.store(which, &mut edge);
        for (lane, k) in at.into_iter().enumerate() {
            self.nearest.edge[k] = edge[lane] as u32;
            let is_held = self.nearest.may_enter[k];
            self.nearest.may_enter[k] = near >> lane & 1 & (is_held | is_over >> lane & is_outside >> lane & 1);
        }
    }

    /// Lanes whose node misses the edge by little, if at all, where the boundary bends.
    #[inline(always)]
    fn is_over<L: Lanes>(&self, lanes: L, best: &OverEdges<L>) -> u8 {
        let rule = &self.rule.constants;
        let size = lanes.max(best.gap, -best.gap);
        let held = lanes.splat(rule.held_beyond * self.rule.size);
        lanes.at_most(best.beyond, lanes.splat(rule.wedge_ratio) * size + held)
    }

    /// Lanes in which both neighbours of the node lie outside the edge or hardly inside.
    #[inline(always)]
    fn is_outside<L: Lanes>(&self, lanes: L, nodes: &Nodes<L>, [x, y]: [L::F; 2]) -> u8 {
        let ([previous, next], [before, after]) = (nodes.to, nodes.distance);
        let sine = lanes.splat(self.rule.constants.flush_sine);
        lanes.at_most(-sine * before, previous[0] * y - previous[1] * x)
            & lanes.at_most(-sine * after, next[0] * y - next[1] * x)
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
    OverEdges { tangent, gap, beyond }
}

/// Lanes in which the first edge is the nearer one.
#[inline(always)]
fn nearer<L: Lanes>(lanes: L, a: &OverEdges<L>, b: &OverEdges<L>) -> u8 {
    let own = a.beyond * a.beyond + a.gap * a.gap;
    let others = b.beyond * b.beyond + b.gap * b.gap;
    let difference = own - others;
    let clear = less(lanes, lanes.splat(SQUARES_ROUND_OFF) * others, lanes.max(difference, -difference));
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
            let [beyond, gap, others_beyond, others_gap] = self.0.map(|sizes| lanes.load(&sizes));
            let tangent = [lanes.splat(0.0); 2];
            let others = OverEdges::<L> { tangent, beyond: others_beyond, gap: others_gap };
            nearer(lanes, &OverEdges { tangent, beyond, gap }, &others)
        }
    }

    #[test]
    fn the_nearer_edge_is_that_of_the_smaller_distance() {
        let sizes = [0.0, 1e-17, 3e-9, 0.3, 0.4, 0.5, f64::next_up(0.5), 1e5];
        let size = |k: usize| sizes[k % sizes.len()];
        for k in 0..8 * sizes.len().pow(2) {
            let at = |shift: usize, step: usize| std::array::from_fn(|lane| size(shift + step * lane));
            let [beyond, gap, others_beyond, others_gap] =
                [at(k, 1), at(k / 8, 3).map(|gap: f64| -gap), at(k / 64, 5), at(k / 8 + k, 1)];
            let is_nearer = |k: usize| distance(beyond[k], gap[k]) < distance(others_beyond[k], others_gap[k]);
            let expected = (0..LANES).fold(0, |bits, lane| bits | u8::from(is_nearer(lane)) << lane);
            for path in Path::all() {
                let found = dispatch_on(path, Compare([beyond, gap, others_beyond, others_gap]));
                assert_eq!(found, expected, "{path:?}, case {k}");
            }
        }
    }
}
