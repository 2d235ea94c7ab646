//! Tessellations become joints: the edges of their cells in their region, and the border of the region in the rock.

use super::Expanded;
use super::cells::{polygons, triangles};
use crate::key::{Check, Key, fail};
use crate::validate::checks::region;
use crate::{Case, CellShape, JointTrace, Tessellation};

/// Most cells of a tessellation.
const CELLS_MAX: f64 = 100_000.0;
/// Area of a polygon over the square of the distance between centres: that of a regular hexagon.
const AREA: f64 = 0.866_025_403_784_438_6;
/// Pieces shorter than this part of the region are left out.
const SHORTEST: f64 = 1e-9;

type Point = [f64; 2];

/// Expands all tessellations.
///
/// # Errors
/// The first one whose size or region cannot be used.
pub fn expand(case: &mut Case, told: &mut Expanded) -> Check {
    for (k, tessellation) in std::mem::take(&mut case.tessellations).into_iter().enumerate() {
        let key = Key::root().field("tessellation").index(k);
        check(&key, case, &tessellation)?;
        for points in joints(case, &tessellation) {
            told.origins.insert(format!("joint[{}]", case.joints.len()), key.to_string());
            case.joints.push(JointTrace { points: points.to_vec(), law: tessellation.law.clone() });
        }
        told.notes.push(format!("{key}: {}", warning(tessellation.shape)));
    }
    Ok(())
}

/// How rock of such cells differs from rock.
fn warning(shape: CellShape) -> &'static str {
    match shape {
        CellShape::Voronoi => {
            "cells of Voronoi interlock: the rock is stronger than their joints, and its strength depends on size and \
             seed of the cells. Properties of joints that were published for other cells do not transfer: find them \
             by tests on these cells"
        }
        CellShape::Trigon => {
            "triangles shear too easily along their sides: the rock is weaker in shear than their joints let one \
             expect. Properties of joints that were published for other cells do not transfer: find them by tests on \
             these cells"
        }
    }
}

fn check(key: &Key, case: &Case, tessellation: &Tessellation) -> Check {
    let Tessellation { size, region: ring, .. } = tessellation;
    tessellation.check(key)?;
    case.mesh.check(&Key::root().field("mesh"))?;
    region(&key.field("region"), ring)?;
    let [low, high] = bounds(ring);
    let cells = (high[0] - low[0]) * (high[1] - low[1]) / (AREA * size * size);
    if cells > CELLS_MAX {
        let fits = size * (cells / CELLS_MAX).sqrt();
        let message = format!(
            "is {size} m, which gives {cells:.3e} cells in the box of the region, must give at most {CELLS_MAX:e}; \
             raise it to {fits:.3} m or make the region smaller"
        );
        return fail(&key.field("size"), message);
    }
    let part = if tessellation.shape == CellShape::Trigon { 0.5 } else { 1.0 };
    let (area, least) = (part * AREA * size * size, case.mesh.least_block());
    if area < 4.0 * least {
        let message = format!(
            "is {size} m: cells of {area:.3e} m² would join each other, since `mesh.least_block` is {least:.3e} m²; \
             raise it to {:.3} m, or lower `mesh.size` or `mesh.least_block`",
            size * (4.0 * least / area).sqrt()
        );
        return fail(&key.field("size"), message);
    }
    Ok(())
}

/// Edges of the cells in region and outline, and the border of the region in the rock.
fn joints(case: &Case, tessellation: &Tessellation) -> Vec<[Point; 2]> {
    let ring = &tessellation.region;
    let box_of = bounds(ring);
    let side = tessellation.size * AREA.sqrt();
    let edges = match tessellation.shape {
        CellShape::Voronoi => polygons(tessellation.seed, side, box_of),
        CellShape::Trigon => triangles(tessellation.seed, side, box_of),
    };
    let shortest = SHORTEST * (box_of[1][0] - box_of[0][0] + box_of[1][1] - box_of[0][1]);
    let inside = edges.into_iter().flat_map(|edge| parts(edge, ring, shortest));
    let border = (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]);
    let loops: Vec<&[Point]> =
        std::iter::once(&case.domain.outline).chain(&case.domain.islands).map(|ring| &ring[..]).collect();
    let in_rock =
        |edge: [Point; 2]| -> Vec<[Point; 2]> { loops.iter().flat_map(|ring| parts(edge, ring, shortest)).collect() };
    let all: Vec<[Point; 2]> = inside.filter(|edge| !in_rock(*edge).is_empty()).collect();
    all.into_iter().chain(border.flat_map(in_rock)).collect()
}

fn bounds(ring: &[Point]) -> [Point; 2] {
    ring.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], p| {
        [[0, 1].map(|k| low[k].min(p[k])), [0, 1].map(|k| high[k].max(p[k]))]
    })
}

/// Parts of a straight line inside a loop; a part on the loop itself is none.
fn parts([a, b]: [Point; 2], ring: &[Point], shortest: f64) -> Vec<[Point; 2]> {
    let way = [b[0] - a[0], b[1] - a[1]];
    let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
    let at = |share: f64| match share {
        0.0 => a,
        1.0 => b,
        _ => [a[0] + way[0] * share, a[1] + way[1] * share],
    };
    let mut shares = vec![0.0, 1.0];
    for k in 0..ring.len() {
        let [from, to] = [ring[k], ring[(k + 1) % ring.len()]];
        let [p, q] = [from, to].map(|r| way[0] * (r[1] - a[1]) - way[1] * (r[0] - a[0]));
        if p == q || p.min(q) > shortest * length || p.max(q) < -shortest * length {
            continue;
        }
        let share = (p / (p - q)).clamp(0.0, 1.0);
        let [x, y] = [0, 1].map(|k| from[k] + (to[k] - from[k]) * share);
        let along = ((x - a[0]) * way[0] + (y - a[1]) * way[1]) / (length * length);
        if (0.0..=1.0).contains(&along) {
            shares.push(along);
        }
    }
    shares.sort_unstable_by(f64::total_cmp);
    let pieces = shares.windows(2).filter(|pair| (pair[1] - pair[0]) * length > shortest);
    let mut parts: Vec<[f64; 2]> = Vec::new();
    for pair in pieces.filter(|pair| is_inside(at(0.5 * (pair[0] + pair[1])), ring, shortest)) {
        match parts.last_mut().filter(|last| (pair[0] - last[1]) * length <= shortest) {
            Some(last) => last[1] = pair[1],
            None => parts.push([pair[0], pair[1]]),
        }
    }
    parts.into_iter().map(|part| part.map(at)).collect()
}

/// Whether a point lies inside a loop, and farther than a distance (m) from it.
fn is_inside(p: Point, ring: &[Point], distance: f64) -> bool {
    let mut inside = false;
    for k in 0..ring.len() {
        let [a, b] = [ring[k], ring[(k + 1) % ring.len()]];
        let (way, off) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let square = way[0] * way[0] + way[1] * way[1];
        let share = ((off[0] * way[0] + off[1] * way[1]) / square).clamp(0.0, 1.0);
        let [x, y] = [0, 1].map(|k| off[k] - way[k] * share);
        if x * x + y * y <= distance * distance {
            return false;
        }
        if (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + way[0] * (p[1] - a[1]) / way[1] {
            inside = !inside;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves_a_loop() {
        let ring = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [5.0, 1.0], [0.0, 5.0]];
        let found = parts([[-1.0, 3.0], [11.0, 3.0]], &ring, 1e-9);
        assert_eq!(found, [[[0.0, 3.0], [2.5, 3.0]], [[7.5, 3.0], [10.0, 3.0]]]);
        assert_eq!(parts([[1.0, 0.0], [2.0, 0.0]], &ring, 1e-9), [] as [[Point; 2]; 0]);
        assert_eq!(parts([[1.0, 0.5], [2.0, 0.5]], &ring, 1e-9), [[[1.0, 0.5], [2.0, 0.5]]]);
        // Along a side and beyond its end, into another loop.
        assert_eq!(
            parts([[0.0, 0.0], [10.0, 0.0]], &[[4.0, -1.0], [6.0, -1.0], [6.0, 1.0], [4.0, 1.0]], 1e-9).len(),
            1
        );
    }
}
