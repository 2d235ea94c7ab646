//! The blocks of a model that can break, with what is found out about each once.

use std::sync::OnceLock;

use crate::cover::BlockId;
use crate::state::Model;

use super::chord::Chord;
use super::cores::Cores;
use super::outline::Outline;

/// The blocks of a model that can break.
#[derive(Debug, Clone)]
pub struct BreakableBlocks {
    /// Of each block; none of one that cannot break.
    blocks: Vec<Option<BreakableBlock>>,
}

/// A block that can break.
#[derive(Debug, Clone)]
pub struct BreakableBlock {
    /// Its outline.
    pub outline: Outline,
    /// Sections from its nodes and the middles between them along the normals of its faces.
    chords: OnceLock<Vec<Chord>>,
    /// Its cores.
    pub cores: Cores,
}

impl BreakableBlocks {
    /// Those of a model.
    pub fn new(model: &Model) -> Self {
        let mut edges = vec![Vec::new(); model.covers.block_count()];
        model.boundary.edges().for_each(|k| edges[model.boundary.block[k].index()].push(k));
        let mut supported = vec![Vec::new(); model.covers.block_count()];
        for support in &model.supports {
            let star = |k: usize| model.covers.star_position[support.covers[k]] * support.weights[k];
            supported[support.block.index()].push(star(0) + star(1) + star(2));
        }
        let of = |block: BlockId| {
            let outline = Outline::new(model, block, &edges[block.index()], &supported[block.index()])?;
            Some(BreakableBlock { outline, chords: OnceLock::new(), cores: Cores::default() })
        };
        Self { blocks: model.covers.blocks().map(of).collect() }
    }

    /// A block that can break.
    pub fn of(&self, block: BlockId) -> Option<&BreakableBlock> {
        self.blocks[block.index()].as_ref()
    }

    /// All blocks that can break.
    pub fn all(&self) -> impl Iterator<Item = BlockId> {
        self.blocks.iter().flatten().map(|of| of.outline.block)
    }
}

impl BreakableBlock {
    /// Sections along the normals of its faces, found once.
    pub fn chords(&self, model: &Model) -> &[Chord] {
        self.chords.get_or_init(|| {
            let starts = self.outline.starts(model);
            let ways = starts.iter().flat_map(|&start| self.outline.normals(start).map(move |way| (start, way)));
            ways.filter_map(|(start, way)| Chord::along(model, &self.outline, start, way)).collect()
        })
    }
}
