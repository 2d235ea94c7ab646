//! Broad phase: finds the edges near every node. The boundary is divided into stretches of up to eight edges in a grid.
//! The list of near pairs is valid until a node has moved too far (a Verlet list with skin); the narrow phase reads it.

mod find;
mod grid;
mod within;

use rayon::prelude::*;

use enmm_lanes::dispatch;

use crate::geometry::Point;

use super::{Boundary, EdgeId, Frames, NodeId, SideId};
use find::{Find, Run};
use grid::Grid;

/// Nodes whose near edges are found as one run, and shared between threads as one.
const RUN: usize = 1024;
/// Runs of each thread that are searched before their near pairs are listed.
const RUNS: usize = 8;

/// A node and an edge that may meet before the next search.
#[doc(alias = "candidate pair")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub struct NearPair {
    /// Node.
    pub node: NodeId,
    /// Side of the edge.
    pub side: SideId,
    /// Edge.
    pub edge: EdgeId,
}

/// Near pairs of the last search, and the positions of the nodes at that time.
#[doc(alias = "Verlet list")]
#[doc(alias = "broad phase")]
#[derive(Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NeighbourList {
    /// Near pairs, ordered by node, side and edge.
    pub pairs: Vec<NearPair>,
    found_at: Vec<Point>,
}

clone_without_allocating!(NeighbourList { pairs found_at });

impl NeighbourList {
    /// Whether a node has moved more than `slack` (m) since the last search.
    pub fn is_stale(&self, frames: &Frames, slack: f64) -> bool {
        let now = frames.node_positions();
        self.found_at.len() != now.len()
            || now.zip(&self.found_at).any(|(now, old)| (now - old).norm_squared() > slack * slack)
    }

    /// Positions of the nodes at the last search (m); empty when the next step has to search again.
    pub fn found_at(&self) -> &[Point] {
        &self.found_at
    }

    /// Bytes of the lists.
    pub fn bytes(&self) -> usize {
        size_of_val(self.pairs.as_slice()) + size_of_val(self.found_at.as_slice())
    }

    /// Makes the next step search again.
    pub fn forget(&mut self) {
        self.found_at.clear();
    }
}

/// Inputs of a search.
pub struct SearchView<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Its edges at their current positions.
    pub frames: &'a Frames,
    /// Distance (m) within which a pair is near.
    pub cutoff: f64,
    /// Blocks to leave out: they have been excavated.
    pub removed: &'a [bool],
    /// Blocks that cannot move: two of them never meet.
    pub fixed: &'a [bool],
    /// Whether to keep to the calling thread.
    pub serial: bool,
}

/// Buffers of a search.
#[doc(alias = "cell list")]
#[doc(alias = "uniform grid")]
#[derive(Debug, Clone, Default)]
pub struct SearchGrid {
    grid: Grid,
    runs: Vec<Run>,
}

impl SearchGrid {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        self.grid.bytes() + self.runs.iter().map(Run::bytes).sum::<usize>()
    }

    /// Finds all nodes within the cutoff of an edge of another block, or of the other side of a partial cut.
    pub fn search(&mut self, view: &SearchView, found: &mut NeighbourList) {
        let Self { grid, runs } = self;
        grid.lay(view);
        let nodes = view.boundary.node_count();
        // Asked outside a pool, the number of threads would start one.
        let piece = if view.serial { 1 } else { RUNS * rayon::current_num_threads() };
        runs.resize_with(nodes.div_ceil(RUN).min(piece), Run::default);
        let find = |first: usize, k: usize, run: &mut Run| {
            let from = first + k * RUN;
            dispatch(Find { grid, view, nodes: from..nodes.min(from + RUN), run });
        };
        let NeighbourList { pairs, found_at } = found;
        pairs.clear();
        // In pieces: the near pairs of all runs together would be as large as the list.
        for first in (0..nodes).step_by(piece * RUN) {
            let count = (nodes - first).div_ceil(RUN).min(piece);
            match &mut runs[..count] {
                [run] => find(first, 0, run),
                runs => runs.par_iter_mut().enumerate().for_each(|(k, run)| find(first, k, run)),
            }
            runs[..count].iter().for_each(|run| pairs.extend_from_slice(&run.near_pairs));
        }
        found_at.clear();
        found_at.extend(view.frames.node_positions());
    }
}
