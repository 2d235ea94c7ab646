//! Joint traces cut by others and divided by regions.

use super::grid::{CellGrid, Groups};
use super::polygon::{bounds, contains, sides};
use super::{Point, cross};

/// Where a segment crosses the sides of a polygon, as shares of its length, ascending, with its ends 0 and 1.
pub(super) fn crossings(region: &[Point], a: Point, b: Point) -> Vec<f64> {
    let along = b - a;
    let mut cuts = vec![0.0, 1.0];
    for (c, d) in sides(region) {
        let (side_c, side_d) = (cross(along, c - a), cross(along, d - a));
        if (side_c <= 0.0) != (side_d <= 0.0) {
            let crossing = c + (d - c) * (side_c / (side_c - side_d));
            cuts.push((crossing - a).dot(&along) / along.norm_squared());
        }
    }
    cuts.retain(|cut| (0.0..=1.0).contains(cut));
    cuts.sort_unstable_by(f64::total_cmp);
    cuts
}

/// Divides a polyline at the border of a polygon into pieces, from its start to its end, each with whether it lies
/// inside. A polyline that the border does not cross comes back as it is.
pub fn divide(line: &[Point], region: &[Point]) -> Vec<(Vec<Point>, bool)> {
    let mut pieces: Vec<(Vec<Point>, bool)> = Vec::new();
    for pair in line.windows(2).filter(|pair| pair[0] != pair[1]) {
        let (a, along) = (pair[0], pair[1] - pair[0]);
        for cut in crossings(region, a, pair[1]).windows(2).filter(|cut| cut[0] < cut[1]) {
            let inside = contains(region, a + along * (0.5 * (cut[0] + cut[1])));
            let [from, to] = [cut[0], cut[1]].map(|share| if share == 1.0 { pair[1] } else { a + along * share });
            match pieces.last_mut().filter(|(_, was)| *was == inside) {
                Some((points, _)) => {
                    // A border that is touched divides nothing.
                    if cut[0] > 0.0 {
                        points.pop();
                    }
                    points.push(to);
                }
                None => pieces.push((vec![from, to], inside)),
            }
        }
    }
    pieces
}

/// Lines on which traces end, in a grid.
pub struct Stops {
    sides: Vec<[Point; 2]>,
    grid: CellGrid,
    near: Groups,
    /// How near a side comes to the cells that name it (m): far above round-off.
    radius: f64,
}

impl Stops {
    /// Lays polylines into a grid.
    pub fn new<'a>(lines: impl Iterator<Item = &'a [Point]>) -> Self {
        let sides: Vec<[Point; 2]> = lines.flat_map(|line| line.windows(2)).map(|pair| [pair[0], pair[1]]).collect();
        let edges = || sides.iter().map(|&[c, d]| (c, d));
        let (low, high) = bounds(sides.as_flattened());
        let radius = if sides.is_empty() { 1.0 } else { 1e-9 * (high - low).norm() };
        let grid = CellGrid::for_edges(edges(), 1e3 * radius);
        let near = Groups::of_edges(&grid, edges(), radius);
        Self { grid, near, radius, sides }
    }

    /// The part of a trace about its middle that ends where it meets the first of the lines on both sides.
    pub fn end(&self, [a, b]: [Point; 2]) -> [Point; 2] {
        let mut shares = [0.0, 1.0];
        self.grid.visit_edge(a, b, self.radius, |cell| {
            for &side in self.near.get(cell) {
                stop([a, b], self.sides[side as usize], &mut shares);
            }
        });
        let at = |share: f64, end: Point| if share == 0.0 || share == 1.0 { end } else { a + (b - a) * share };
        [at(shares[0], a), at(shares[1], b)]
    }
}

/// Narrows the shares of a trace from `a` to `b` between which it lies about its middle, where a side crosses it.
fn stop([a, b]: [Point; 2], [c, d]: [Point; 2], [from, to]: &mut [f64; 2]) {
    let along = b - a;
    let (side_c, side_d) = (cross(along, c - a), cross(along, d - a));
    let (side_a, side_b) = (cross(d - c, a - c), cross(d - c, b - c));
    if (side_c <= 0.0) == (side_d <= 0.0) || side_a == side_b {
        return;
    }
    let share = side_a / (side_a - side_b);
    if share <= 0.5 {
        *from = from.max(share);
    } else {
        *to = to.min(share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that look random within a square of 100 m (multiplicative congruential).
    fn scattered(count: usize, mut seed: u64) -> Vec<Point> {
        let mut roll = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 * 100.0
        };
        (0..count).map(|_| Point::new(roll(), roll())).collect()
    }

    /// The grid leaves out only sides that do not meet a trace: the bits are those of all pairs.
    #[test]
    fn a_trace_ends_where_all_pairs_say() {
        let lines: Vec<Vec<Point>> = scattered(300, 1).chunks(3).map(<[Point]>::to_vec).collect();
        let stops = Stops::new(lines.iter().map(Vec::as_slice));
        let mut ended = 0;
        for ends in scattered(600, 2).chunks(2) {
            // Some traces reach far beyond the lines.
            let trace = [ends[0], ends[0] + (ends[1] - ends[0]) * 3.0];
            let mut shares = [0.0, 1.0];
            stops.sides.iter().for_each(|&side| stop(trace, side, &mut shares));
            let found = stops.end(trace);
            let at = |share: f64, end: Point| {
                if share == 0.0 || share == 1.0 { end } else { trace[0] + (trace[1] - trace[0]) * share }
            };
            assert_eq!(found, [at(shares[0], trace[0]), at(shares[1], trace[1])]);
            ended += usize::from(shares != [0.0, 1.0]);
        }
        assert!(ended > 250, "{ended} of 300 meet a line");
    }

    #[test]
    fn without_lines_a_trace_stays_as_it_is() {
        let trace = [Point::new(0.0, 0.0), Point::new(5.0, 1.0)];
        assert_eq!(Stops::new(std::iter::empty()).end(trace), trace);
    }
}
