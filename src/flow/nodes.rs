//! Nodes of the net of joints: reference points by their bits.

use crate::geometry::Point;

/// Points of which equal ones, and those that are one but for round-off, have one number.
#[derive(Debug)]
pub(super) struct Nodes {
    /// Points in order of their coordinates.
    points: Vec<Point>,
    /// Node of each of them.
    node: Vec<u32>,
    /// Place (m) of each node.
    pub places: Vec<Point>,
}

impl Nodes {
    /// Of all these points, joined where a pair says that both are the same.
    pub fn of(points: impl Iterator<Item = Point>, same: &[[Point; 2]]) -> Self {
        let mut points: Vec<Point> = points.chain(same.iter().flatten().copied()).map(signless).collect();
        points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        points.dedup();
        let mut nodes = Self { node: (0..points.len() as u32).collect(), points, places: Vec::new() };
        for pair in same {
            let [a, b] = pair.map(|point| nodes.find(point).map_or(0, |k| nodes.first(k)));
            nodes.node[a.max(b)] = a.min(b) as u32;
        }
        // The first point of each node comes before the others.
        for k in 0..nodes.points.len() {
            let first = nodes.node[k] as usize;
            nodes.node[k] = if first == k {
                nodes.places.push(nodes.points[k]);
                nodes.places.len() as u32 - 1
            } else {
                nodes.node[first]
            };
        }
        nodes
    }

    /// The node of a point.
    pub fn at(&self, point: Point) -> Option<u32> {
        self.find(point).map(|k| self.node[k])
    }

    /// The first of the points that are joined with one.
    fn first(&self, mut k: usize) -> usize {
        while self.node[k] as usize != k {
            k = self.node[k] as usize;
        }
        k
    }

    fn find(&self, point: Point) -> Option<usize> {
        let point = signless(point);
        self.points.binary_search_by(|p| p.x.total_cmp(&point.x).then(p.y.total_cmp(&point.y))).ok()
    }
}

/// The same point without a sign of zeros.
fn signless(point: Point) -> Point {
    Point::new(point.x + 0.0, point.y + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_are_one_but_for_round_off_have_one_node() {
        let p = [[0.0, 0.0], [1.0, 0.0], [1.0 + 1e-15, 0.0], [2.0, -0.0], [1.0, 1e-15]].map(|[x, y]| Point::new(x, y));
        let nodes = Nodes::of(p[..4].iter().copied(), &[[p[2], p[1]], [p[4], p[2]]]);
        assert_eq!(p.map(|point| nodes.at(point)), [Some(0), Some(1), Some(1), Some(2), Some(1)]);
        assert_eq!(nodes.places, [p[0], p[1], Point::new(2.0, 0.0)]);
        assert_eq!((nodes.at(Point::new(2.0, 0.0)), nodes.at(Point::new(3.0, 0.0))), (Some(2), None));
    }
}
