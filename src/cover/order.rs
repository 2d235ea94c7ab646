//! Order in space: Morton codes, so that neighbours in the plane are neighbours in memory.

use crate::geometry::Point;

/// Morton code of a point in the box `low`–`high`, 20 bits an axis.
pub fn morton(p: Point, low: Point, high: Point) -> u64 {
    let extent = (high - low).max().max(f64::MIN_POSITIVE);
    let level = |v: f64| ((v / extent).clamp(0.0, 1.0) * f64::from((1u32 << 20) - 1)) as u64;
    spread(level(p.x - low.x)) | spread(level(p.y - low.y)) << 1
}

fn spread(mut v: u64) -> u64 {
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        v = (v | v << shift) & mask;
    }
    v
}
