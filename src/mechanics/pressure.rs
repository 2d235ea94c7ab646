//! Fluid pressure on boundary edges, as exact forces at both ends. Rock is on the left of the way from the first end to
//! the second.

use crate::geometry::{Point, Vector};

/// Forces (N/m) at both ends of the edge from `a` to `b` under a uniform pressure (Pa) that pushes into the rock.
pub fn uniform(a: Point, b: Point, pressure: f64) -> [Vector; 2] {
    [inward(a, b) * (0.5 * pressure); 2]
}

/// Forces (N/m) at both ends of the edge from `a` to `b` under still water of unit weight `weight` (N/m³) with its
/// surface at height `level` (m): the pressure is weight·(level − y) below the level and 0 above (Eq. 30).
pub fn hydrostatic(a: Point, b: Point, level: f64, weight: f64) -> [Vector; 2] {
    let depth = [level - a.y, level - b.y];
    let inward = inward(a, b) * weight;
    let share = |wet: f64, dry: f64| wet / (wet - dry);
    match depth.map(|d| d > 0.0) {
        [false, false] => [Vector::zeros(); 2],
        [true, true] => [inward * ((2.0 * depth[0] + depth[1]) / 6.0), inward * ((depth[0] + 2.0 * depth[1]) / 6.0)],
        [true, false] => {
            let s = share(depth[0], depth[1]);
            [inward * (depth[0] * s * (3.0 - s) / 6.0), inward * (depth[0] * s * s / 6.0)]
        }
        [false, true] => {
            let s = share(depth[1], depth[0]);
            [inward * (depth[1] * s * s / 6.0), inward * (depth[1] * s * (3.0 - s) / 6.0)]
        }
    }
}

/// Forces (N/m) at both ends of the edge from `a` to `b` under still water of unit weight `weight` (N/m³) below a
/// broken line from left to right, `rise` (m) above `table`: the pressure is the unit weight times the vertical depth
/// below the line, which is level beyond its ends (Eq. 38). Exact: the edge is split where the line bends and where it
/// is crossed.
pub fn under_table(a: Point, b: Point, table: &[Point], rise: f64, weight: f64) -> [Vector; 2] {
    let normal = inward(a, b) * weight;
    let position = |s: f64| a + (b - a) * s;
    let depth = |s: f64| surface(table, position(s).x) + rise - position(s).y;
    let run = b.x - a.x;
    let mut forces = [Vector::zeros(); 2];
    let mut from = 0.0;
    // Kinks in the order in which the edge passes under them.
    let kink = |k: usize| if run > 0.0 { table[k].x } else { table[table.len() - 1 - k].x };
    for k in 0..=table.len() {
        let to = if k < table.len() && run != 0.0 { ((kink(k) - a.x) / run).clamp(0.0, 1.0) } else { 1.0 };
        if to > from {
            let piece = wet_part(normal, [from, to], [depth(from), depth(to)]);
            (0..2).for_each(|end| forces[end] += piece[end]);
            from = to;
        }
    }
    forces
}

/// Height (m) of a broken line at `x` (m), level beyond its ends.
pub fn surface(table: &[Point], x: f64) -> f64 {
    let after = table.partition_point(|p| p.x <= x);
    match (after.checked_sub(1).map(|k| table[k]), table.get(after)) {
        (Some(p), Some(q)) => p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x),
        (Some(p), None) => p.y,
        (None, Some(q)) => q.y,
        (None, None) => f64::NEG_INFINITY,
    }
}

/// The part of a piece of an edge that lies below the surface, with depths linear between its ends.
fn wet_part(normal: Vector, [from, to]: [f64; 2], depth: [f64; 2]) -> [Vector; 2] {
    let crossing = from + (to - from) * depth[0] / (depth[0] - depth[1]);
    match depth.map(|d| d > 0.0) {
        [false, false] => [Vector::zeros(); 2],
        [true, true] => part(normal, [from, to], depth),
        [true, false] => part(normal, [from, crossing], [depth[0], 0.0]),
        [false, true] => part(normal, [crossing, to], [0.0, depth[1]]),
    }
}

/// Forces (N/m) at both ends of an edge, given its inward normal as long as itself, under a pressure (Pa) on the part
/// between two shares of its length that varies linearly from `ends[0]` to `ends[1]` (Eq. 39).
pub fn part(normal: Vector, [from, to]: [f64; 2], ends: [f64; 2]) -> [Vector; 2] {
    let resultant = 0.5 * (to - from) * (ends[0] + ends[1]);
    let moment = (to - from) * (from * (2.0 * ends[0] + ends[1]) + to * (ends[0] + 2.0 * ends[1])) / 6.0;
    [normal * (resultant - moment), normal * moment]
}

/// Normal into the rock, as long as the edge.
pub fn inward(a: Point, b: Point) -> Vector {
    Vector::new(a.y - b.y, b.x - a.x)
}
