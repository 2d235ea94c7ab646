//! Which of the near sides came into view with their own rock between them and the node.

use crate::geometry::{Vector, segment};

use super::{Candidate, Near, SearchView};

/// Depth, relative to the search cutoff, from which a side that comes into view has rock before it: deeper than
/// contacts go, but for the first search, when nothing overlaps.
const DEPTH: f64 = 0.012;
/// The same for the first search.
const DEPTH_FIRST: f64 = 4e-6;

/// What the last search found, from some node on.
pub struct Before<'a> {
    candidates: &'a [Candidate],
    behind: &'a [[u32; 2]],
    depth: f64,
}

impl<'a> Before<'a> {
    pub fn of(near: &'a Near, first_node: usize, cutoff: f64) -> Self {
        let depth = cutoff * if near.candidates.is_empty() { DEPTH_FIRST } else { DEPTH };
        let candidates = near.candidates.partition_point(|c| (c.node as usize) < first_node);
        let behind = near.behind.partition_point(|[node, _]| (*node as usize) < first_node);
        Self { candidates: &near.candidates[candidates..], behind: &near.behind[behind..], depth }
    }

    /// Keeps the pairs behind rock that are still in view of a node, and adds those that have come into view deep;
    /// `near` are its edges now. Nodes come in their order.
    pub fn renew(&mut self, view: &SearchView, node: u32, near: &[Candidate], behind: &mut Vec<[u32; 2]>) {
        let was = of_node(&mut self.behind, |pair| pair[0].cmp(&node));
        if let Some((known, rest)) = self.candidates.split_at_checked(near.len())
            && known.iter().zip(near).all(|(a, b)| a.node == b.node && a.edge == b.edge)
            && rest.first().is_none_or(|next| next.node > node)
        {
            self.candidates = rest;
            behind.extend_from_slice(was);
            return;
        }
        let known = of_node(&mut self.candidates, |c| c.node.cmp(&node));
        for edges in near.chunk_by(|a, b| a.side == b.side) {
            let side = edges[0].side;
            let is_known = known.iter().fold(false, |known, c| known | (c.side == side));
            if was.contains(&[node, side]) || !is_known && gap_over(view, edges) + self.depth < 0.0 {
                behind.push([node, side]);
            }
        }
    }
}

/// Takes from the front of a sorted list all that lies before a node, and returns what is the node's.
fn of_node<'a, T>(list: &mut &'a [T], order: impl Fn(&T) -> std::cmp::Ordering) -> &'a [T] {
    let first = list.iter().take_while(|item| order(item).is_lt()).count();
    let count = list[first..].iter().take_while(|item| order(item).is_eq()).count();
    let (own, rest) = list[first..].split_at(count);
    *list = rest;
    own
}

/// Gap (m) of a node over the nearest of some edges of one side, negative behind it; infinite where the node is beyond
/// an end of the side and outside the side round that corner.
fn gap_over(view: &SearchView, edges: &[Candidate]) -> f64 {
    let p = view.place[view.boundary.node_point[edges[0].node as usize] as usize];
    let ends = |edge: usize| (view.place[edge], view.place[view.boundary.after(edge)]);
    let gap = |e: usize| {
        let (a, b) = ends(e);
        (p - a).dot(&Vector::new(b.y - a.y, a.x - b.x)) / (b - a).norm()
    };
    let distance = |c: &&Candidate| {
        let (a, b) = ends(c.edge as usize);
        segment::distance(p, a, b)
    };
    let Some(nearest) = edges.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return f64::INFINITY };
    let (a, b) = ends(nearest.edge as usize);
    let along = (p - a).dot(&(b - a));
    let round = view.boundary.side_round(nearest.edge, along < 0.0, along > (b - a).norm_squared());
    if round.is_some_and(|e| gap(e as usize) > 0.0) { f64::INFINITY } else { gap(nearest.edge as usize) }
}
