//! Where the parts of a model that a stage has cut come from.

use crate::contact::{BoltSegment, EdgeId, NodeId, Section, SideId, Support};
use crate::cover::BlockId;
use crate::geometry::{Point, segment};
use crate::state::{Model, PortKind};

use super::parents::Parents;
use super::places::{nodes, sides};

/// For each part of a model after a cut that of the model before: blocks and covers always have one.
#[derive(Debug)]
pub struct Lineage {
    /// Of elements, covers and blocks.
    pub parents: Parents,
    /// Block as which each block before goes on.
    pub heirs: Vec<BlockId>,
    /// Support that each support was; a cut leaves them as they are.
    pub supports: Vec<usize>,
    /// Segment that each segment of a bolt was; none where a cut crosses the bar.
    pub bolts: Vec<Option<usize>>,
    /// Section of a rock bridge of which each section is a part.
    pub sections: Vec<Option<usize>>,
    /// Node that each boundary node was; none where a cut has moved or made it.
    pub nodes: Vec<Option<NodeId>>,
    /// The same of the sides.
    pub sides: Vec<Option<SideId>>,
    /// Number of joint traces before.
    pub traces: usize,
}

impl Lineage {
    /// That of a model which has more cuts than an old one; points within `tolerance` (m) are one.
    ///
    /// # Errors
    /// Why the cuts cannot be made in the middle of a run.
    pub fn new(old: &Model, new: &Model, tolerance: f64) -> Result<Self, String> {
        let parents = Parents::of(&old.covers, &new.covers).map_err(|place| {
            format!(
                "changes joints beside it at ({:.6}, {:.6}) m, which it may not in the middle of a run: lead it \
                 farther away from their ends and corners",
                place.x, place.y
            )
        })?;
        Ok(Self {
            heirs: parents.heirs(&old.covers, &new.covers, &of_ports(old, new)),
            supports: supports(old, new, &parents, tolerance)?,
            bolts: new
                .bolts
                .iter()
                .map(|bolt| old.bolts.iter().position(|was| is_same(was, bolt, tolerance)))
                .collect(),
            sections: sections(old, new, tolerance),
            nodes: nodes(&old.boundary, &new.boundary, &parents.blocks, tolerance),
            sides: sides(&old.boundary, &new.boundary, &parents.blocks, tolerance),
            traces: old.trace_law.len(),
            parents,
        })
    }

    /// Numbers of the blocks after the cut, as hosts see them.
    pub fn labels(&self, old: &Model) -> Vec<u32> {
        self.parents.labels(&old.labels, &self.heirs)
    }
}

/// The blocks of ports before, and the parts that hold the points by which the case names them.
fn of_ports(old: &Model, new: &Model) -> Vec<(BlockId, BlockId)> {
    let ports = old.ports.iter().zip(&new.ports).filter(|(port, _)| port.kind == PortKind::Block);
    ports.map(|(was, port)| (was.block, port.block)).collect()
}

/// Where a support holds the rock (m).
fn place(support: &Support, model: &Model) -> Point {
    let star = |k: usize| model.covers.star_position[support.covers[k]] * support.weights[k];
    star(0) + star(1) + star(2)
}

/// The support that each was.
fn supports(old: &Model, new: &Model, parents: &Parents, tolerance: f64) -> Result<Vec<usize>, String> {
    let of = |support: &Support| {
        let at = place(support, new);
        let is_same = |was: &Support| {
            was.fix == support.fix
                && was.block == parents.blocks[support.block]
                && was.direction == support.direction
                && was.resistance == support.resistance
                && (place(was, old) - at).norm() <= tolerance
        };
        old.supports.iter().position(is_same).ok_or(at)
    };
    let found: Result<Vec<usize>, Point> = new.supports.iter().map(of).collect();
    let message = |at: Point| {
        format!(
            "meets a fixed or quiet edge of the rock at ({:.6}, {:.6}) m, whose supports carry the rock already: end \
             the cut before it",
            at.x, at.y
        )
    };
    found.map_err(message)
}

/// Whether two segments of bolts are one.
fn is_same(was: &BoltSegment, bolt: &BoltSegment, tolerance: f64) -> bool {
    was.bolt == bolt.bolt && (0..2).all(|k| (was.points[k] - bolt.points[k]).norm() <= tolerance)
}

/// The section of which each is a part.
fn sections(old: &Model, new: &Model, tolerance: f64) -> Vec<Option<usize>> {
    let ends = |model: &Model, section: &Section| section.ends.map(|end: EdgeId| model.boundary.reference[end]);
    let of = |section: &Section| {
        let [a, b] = ends(new, section);
        let middle = a + (b - a) * 0.5;
        old.sections.list.iter().position(|was| {
            let [a, b] = ends(old, was);
            was.law == section.law && segment::distance(middle, a, b) <= tolerance
        })
    };
    new.sections.list.iter().map(of).collect()
}
