//! Which edges of blocks are free faces: those that lay on no edge of a block before the blocks moved. The states of
//! contacts do not say it, since blocks come to touch free faces, and excavated ones leave them.

use crate::scene::Block;

/// Distance of places that are one, over the size of the slope: places of a film have single precision.
const NEAR: f64 = 1e-6;

/// A box of places.
type Extent = [[f64; 2]; 2];

/// Marks the free edges of blocks.
pub fn mark(blocks: &mut [Block]) {
    let boxes: Vec<Extent> = blocks.iter().map(|block| extent(block)).collect();
    let all = boxes.iter().copied().reduce(join).unwrap_or_default();
    let near = NEAR * (all[1][0] - all[0][0]).max(all[1][1] - all[0][1]);
    let free: Vec<Vec<Vec<bool>>> = (0..blocks.len())
        .map(|k| {
            let meets = |other: &usize| {
                (0..2).all(|axis| {
                    boxes[k][0][axis] <= boxes[*other][1][axis] + near
                        && boxes[*other][0][axis] <= boxes[k][1][axis] + near
                })
            };
            let others: Vec<&Block> = (0..blocks.len()).filter(meets).map(|other| &blocks[other]).collect();
            let is_free = |edge: [[f64; 2]; 2]| {
                !others.iter().any(|other| other.outline.loops.iter().any(|points| lies_on(edge, points, near)))
            };
            blocks[k].outline.loops.iter().map(|points| edges(points).map(is_free).collect()).collect()
        })
        .collect();
    blocks.iter_mut().zip(free).for_each(|(block, free)| block.free = free);
}

fn extent(block: &Block) -> Extent {
    let points = block.outline.loops.iter().flatten().map(|point| [*point, *point]);
    points.reduce(join).unwrap_or_default()
}

fn join(a: Extent, b: Extent) -> Extent {
    [[0, 1].map(|axis| a[0][axis].min(b[0][axis])), [0, 1].map(|axis| a[1][axis].max(b[1][axis]))]
}

fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
}

/// Whether the middle of an edge lies on an edge of a loop that runs the other way, as that of rock on its other side.
fn lies_on([a, b]: [[f64; 2]; 2], points: &[[f64; 2]], near: f64) -> bool {
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    edges(points).any(|[from, to]| {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = libm::hypot(along[0], along[1]);
        let arm = [middle[0] - from[0], middle[1] - from[1]];
        let off = (along[0] * arm[1] - along[1] * arm[0]).abs();
        let at = along[0] * arm[0] + along[1] * arm[1];
        let is_against = along[0] * (b[0] - a[0]) + along[1] * (b[1] - a[1]) < 0.0;
        is_against && off <= near * length && (0.0..=length * length).contains(&at)
    })
}
