//! Edges by the cells of a grid that they come near, kept while few of them are split.

use super::grid::Groups;

/// Place of an edge in the order of the edges: its segment, and which of its pieces it is.
pub(super) type Rank = (u32, u32);

/// Edges over those that have changed, or that have to be crossed, from which the cells are filled again.
const MANY: usize = 4;

/// The edges near each cell, in order.
pub(super) struct EdgeCells {
    /// The edges near each cell of the grid when it was filled.
    all: Groups,
    /// Edges that have been made since then, some of them in the place of another.
    pub changed: Vec<u32>,
    /// After changes: cells in which edges are to be crossed, rising, and the edges near these now.
    now: Option<(Vec<u32>, Groups)>,
}

/// Known data of the edges of a noder.
pub(super) trait Edges {
    /// Visits every cell that an edge comes near, once each.
    fn visit(&self, edge: u32, visit: impl FnMut(usize));
    /// Place of an edge in the order of the edges.
    fn rank(&self, edge: u32) -> Rank;
    /// Whether an edge has been made since the cells were filled.
    fn is_new(&self, edge: u32) -> bool;
}

impl EdgeCells {
    /// Fills `cells` cells with edges, which `order` visits in order.
    pub fn fill(cells: usize, edges: &impl Edges, order: impl Fn(&mut dyn FnMut(u32))) -> Self {
        let all = Groups::build(cells, |put| {
            order(&mut |edge| edges.visit(edge, |cell| put(cell, edge)));
        });
        Self { all, changed: Vec::new(), now: None }
    }

    /// Whether it is less work to find the edges near `untested` ones than to put all of them into the cells again.
    pub fn serves(&self, untested: usize, edges: usize) -> bool {
        MANY * (self.changed.len() + untested) <= edges
    }

    /// Finds the edges in all cells that an untested edge comes near.
    pub fn find(&mut self, untested: &[u32], edges: &impl Edges) {
        let mut wanted = Vec::new();
        untested.iter().for_each(|&edge| edges.visit(edge, |cell| wanted.push(cell as u32)));
        wanted.sort_unstable();
        wanted.dedup();
        let mut near = Vec::new();
        for (k, &cell) in wanted.iter().enumerate() {
            let old = self.all.get(cell as usize).iter().filter(|&&edge| !edges.is_new(edge));
            near.extend(old.map(|&edge| (k, edges.rank(edge), edge)));
        }
        for &edge in &self.changed {
            edges.visit(edge, |cell| {
                if let Ok(k) = wanted.binary_search(&(cell as u32)) {
                    near.push((k, edges.rank(edge), edge));
                }
            });
        }
        near.sort_unstable();
        let groups = Groups::build(wanted.len(), |put| near.iter().for_each(|&(k, _, edge)| put(k, edge)));
        self.now = Some((wanted, groups));
    }

    /// The edges near a cell, in order; none where no edge is to be crossed.
    pub fn get(&self, cell: usize) -> &[u32] {
        match &self.now {
            None => self.all.get(cell),
            Some((wanted, near)) => wanted.binary_search(&(cell as u32)).map_or(&[], |k| near.get(k)),
        }
    }
}
