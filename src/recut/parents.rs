//! Where elements, covers and blocks come from when more cuts part the same rock on the same mesh.

use crate::cover::{BlockId, CoverId, Covers, ElementId};
use crate::geometry::{Point, polygon};

/// For each element, cover and block of the finer covers that of the coarser ones which it was a part of.
#[derive(Debug, Clone, PartialEq)]
pub struct Parents {
    /// Of each element.
    pub elements: Vec<ElementId>,
    /// Of each physical cover.
    pub covers: Vec<CoverId>,
    /// Of each block.
    pub blocks: Vec<BlockId>,
}

impl Parents {
    /// Those of covers `fine` among covers `coarse` of the same mesh. If `fine` has not all cuts of `coarse`, a point
    /// (m) near which one is missing.
    ///
    /// # Errors
    /// See above.
    pub fn of(coarse: &Covers, fine: &Covers) -> Result<Self, Point> {
        let place = |e: ElementId| fine.element_centroid[e];
        let elements = fine.elements().map(|e| parent(coarse, fine, e).ok_or_else(|| place(e)));
        let elements = elements.collect::<Result<Vec<ElementId>, Point>>()?;
        let mut covers = vec![None; fine.cover_count()];
        let mut blocks = vec![None; fine.block_count()];
        for (e, &parent) in fine.elements().zip(&elements) {
            let corners = fine.element_covers[e].iter().zip(coarse.element_covers[parent]);
            let mut fits = takes(&mut blocks[fine.element_block[e]], coarse.element_block[parent]);
            corners.for_each(|(&cover, parent)| fits &= takes(&mut covers[cover], parent));
            if !fits {
                return Err(place(e));
            }
        }
        // Every cover and every block has an element.
        let (covers, blocks) = (covers.into_iter().flatten().collect(), blocks.into_iter().flatten().collect());
        Ok(Self { elements, covers, blocks })
    }

    /// Numbers that hosts see of the blocks `fine`, where those of the blocks `coarse` are `labels`: its heir keeps the
    /// number of a block, other parts take the next free ones.
    pub fn labels(&self, labels: &[u32], heirs: &[BlockId]) -> Vec<u32> {
        let mut own = vec![None; self.blocks.len()];
        for (&label, &heir) in labels.iter().zip(heirs) {
            own[heir] = Some(label);
        }
        let mut next = labels.len() as u32..;
        own.into_iter().map(|label| label.unwrap_or_else(|| next.next().unwrap_or_default())).collect()
    }

    /// The block `fine` that each block `coarse` goes on as: the first that is `wanted` for it, or else that with its
    /// reference point.
    pub fn heirs(&self, coarse: &Covers, fine: &Covers, wanted: &[(BlockId, BlockId)]) -> Vec<BlockId> {
        let mut heirs = vec![None; coarse.block_count()];
        for (block, &parent) in fine.blocks().zip(&self.blocks) {
            heirs[parent].get_or_insert(block);
        }
        for block in coarse.blocks() {
            let wanted = wanted.iter().find(|(of, heir)| *of == block && self.blocks[*heir] == block);
            let inside = || fine.element_at(coarse.point_inside(block)).map(|e| fine.element_block[e]);
            let holder = wanted.map(|(_, heir)| *heir).or_else(inside);
            let holder = holder.filter(|&holder| self.blocks[holder] == block);
            heirs[block] = holder.or(heirs[block]);
        }
        heirs.into_iter().flatten().collect()
    }
}

/// The element of which an element of finer covers is a part: that of the same triangle of the mesh and with the same
/// polygon, or else the one that holds a point inside.
fn parent(coarse: &Covers, fine: &Covers, e: ElementId) -> Option<ElementId> {
    let (triangle, centroid) = (fine.element_triangle[e], fine.element_centroid[e]);
    let candidates = || coarse.around(centroid, 0.0).filter(|&c| coarse.element_triangle[c] == triangle);
    let is_whole = |c: &ElementId| {
        (coarse.element_centroid[*c] - centroid).norm() <= SAME * coarse.mesh.size
            && (coarse.element_area[*c] / fine.element_area[e] - 1.0).abs() <= SAME
    };
    candidates().find(is_whole).or_else(|| {
        let area = |t: &[Point; 3]| polygon::area(t);
        let largest = polygon::triangles(fine.polygon(e)).into_iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
        let inside = largest.iter().sum::<Point>() / 3.0;
        candidates().find(|&c| polygon::contains(coarse.polygon(c), inside))
    })
}

/// Gives a part its parent; whether it has no other.
fn takes<T: Copy + PartialEq>(slot: &mut Option<T>, parent: T) -> bool {
    *slot.get_or_insert(parent) == parent
}

/// Difference, relative to the mesh size and to the area, within which two elements are the same.
const SAME: f64 = 1e-9;
