//! Order in space: neighbours in the plane are neighbours in memory. Blocks go along a Hilbert curve, and elements and
//! covers within a block along another, so that any run of them is one compact region of the plane. Covers of a large
//! block go row by row within square tiles of the lattice, and the curve goes from tile to tile: so elements in a row
//! of the lattice have their covers in a row in memory.

use crate::geometry::Point;

/// Lattice nodes along a side of a tile.
const TILE_SIDE: i32 = 32;
/// Lattice nodes of a tile.
pub const TILE: usize = (TILE_SIDE * TILE_SIDE) as usize;
/// Covers from which on those of one block go by tiles: smaller blocks have few whole ones.
pub const TILED: usize = 4 * TILE;

/// Tile of a lattice node.
pub fn tile(star: [i32; 2]) -> [i32; 2] {
    star.map(|v| v.div_euclid(TILE_SIDE))
}

/// Node in the middle of a tile.
pub fn tile_centre(tile: [i32; 2]) -> [i32; 2] {
    tile.map(|v| v * TILE_SIDE + TILE_SIDE / 2)
}

/// Halvings of the box: 2⁻²⁶ of its side is far below any mesh size.
const LEVELS: u32 = 26;

/// Place of a point along the Hilbert curve that fills the square over the box `low`–`high`, from its lower left to
/// its upper left corner.
pub fn hilbert(p: Point, low: Point, high: Point) -> u64 {
    let extent = (high - low).max().max(f64::MIN_POSITIVE);
    let level = |v: f64| ((v / extent).clamp(0.0, 1.0) * f64::from((1u32 << LEVELS) - 1)) as u32;
    let (mut x, mut y) = (level(p.x - low.x), level(p.y - low.y));
    let mut place = 0;
    for bit in (0..LEVELS).rev() {
        let (right, up) = (x >> bit & 1, y >> bit & 1);
        place = place << 2 | u64::from((3 * up) ^ right);
        // Of the four quarters the curve passes the first and the last, those on the left, turned.
        if right == 0 {
            if up == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a grid of cells the curve passes through every cell once, from each to one beside it.
    #[test]
    fn the_curve_goes_from_each_cell_to_one_beside_it() {
        let side = 32;
        let (low, high) = (Point::zeros(), Point::repeat(f64::from(side)));
        let mut cells: Vec<(i32, i32)> = (0..side * side).map(|k| (k % side, k / side)).collect();
        cells.sort_by_key(|&(i, j)| hilbert(Point::new(f64::from(i) + 0.5, f64::from(j) + 0.5), low, high));
        let way = cells.windows(2).map(|w| (w[1].0 - w[0].0).abs() + (w[1].1 - w[0].1).abs());
        assert!(way.into_iter().all(|step| step == 1));
        assert_eq!(cells[0], (0, 0));
    }
}
