//! The regular equilateral lattice that carries the mathematical covers.

use crate::geometry::{Label, MeshEdgeId, Point, Segment, Vector};

use super::Weights;

/// One triangle of the lattice: up = nodes (i,j), (i+1,j), (i,j+1); down = nodes (i+1,j+1), (i,j+1), (i+1,j).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Triangle {
    /// Column of the lattice cell.
    pub i: i32,
    /// Row of the lattice cell.
    pub j: i32,
    /// Gradient set: 0 for the up triangle, 1 for the down triangle.
    pub set: u8,
}

impl Triangle {
    /// Lattice nodes (stars) of the triangle, counter-clockwise.
    pub fn nodes(self) -> [[i32; 2]; 3] {
        let (i, j) = (self.i, self.j);
        if self.set == 0 { [[i, j], [i + 1, j], [i, j + 1]] } else { [[i + 1, j + 1], [i, j + 1], [i + 1, j]] }
    }
}

/// Equilateral lattice: node(i, j) = origin + i·a1 + j·a2; a hexagon of six triangles round a node is a
/// mathematical cover.
#[doc(alias = "mathematical cover")]
#[derive(Debug, Clone, PartialEq)]
pub struct RegularMesh {
    /// Side of a triangle (m).
    pub size: f64,
    origin: Point,
    a1: Vector,
    a2: Vector,
    first: [i32; 2],
    count: [i32; 2],
}

impl RegularMesh {
    /// Lays a lattice of side `size` (m), direction `angle` (rad) and node (0, 0) at `origin` over a box.
    pub fn new(size: f64, angle: f64, origin: Point, low: Point, high: Point) -> Self {
        let turn = angle + std::f64::consts::FRAC_PI_3;
        let mut mesh = Self {
            size,
            origin,
            a1: Vector::new(libm::cos(angle), libm::sin(angle)) * size,
            a2: Vector::new(libm::cos(turn), libm::sin(turn)) * size,
            first: [0, 0],
            count: [0, 0],
        };
        mesh.reach(low, high);
        mesh
    }

    /// Upper estimate of the number of lattice cells (two triangles each) over a box.
    pub fn cell_estimate(size: f64, low: Point, high: Point) -> f64 {
        let extent = high - low;
        (extent.x / size + 6.0) * (extent.y / (size * 0.75f64.sqrt()) + 6.0)
    }

    /// Greatest lattice number of a lattice over a box, without its sign, and the number of cells of the parallelogram
    /// that holds the box; the arguments are those of [`RegularMesh::new`].
    pub fn numbers(size: f64, angle: f64, origin: Point, low: Point, high: Point) -> [f64; 2] {
        let mesh = Self::new(size, angle, origin, low, high);
        let ranges = [0, 1].map(|axis| mesh.range(axis, low, high));
        let farthest = ranges.iter().flatten().fold(0.0f64, |most, number| most.max(number.abs()));
        [farthest, ranges.iter().map(|[least, most]| most - least + 1.0).product()]
    }

    /// Least and greatest lattice number along an axis over a box.
    fn range(&self, axis: usize, low: Point, high: Point) -> [f64; 2] {
        let corners = [low, high, Point::new(low.x, high.y), Point::new(high.x, low.y)];
        let values = corners.map(|c| self.lattice(c)[axis]);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min).floor() - 2.0;
        [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil() + 2.0]
    }

    fn reach(&mut self, low: Point, high: Point) {
        for axis in 0..2 {
            let [least, most] = self.range(axis, low, high).map(|number| number as i32);
            self.first[axis] = least;
            self.count[axis] = most.saturating_sub(least).saturating_add(1);
        }
    }

    /// Columns of a row whose nodes come near a box.
    fn columns_near(&self, row: i32, low: Point, high: Point) -> std::ops::Range<i32> {
        let (start, room) = (self.node([self.first[0], row]), Point::repeat(2.0 * self.size));
        let (mut first, mut end) = (0.0f64, f64::from(self.count[0]));
        for axis in 0..2 {
            let [p, q] = [low - room, high + room].map(|side| side[axis] - start[axis]);
            let step = self.a1[axis];
            if step.abs() > 1e-9 * self.size {
                first = first.max((p / step).min(q / step).floor());
                end = end.min((p / step).max(q / step).ceil() + 1.0);
            }
        }
        first as i32..end.max(first) as i32
    }

    /// Lattice coordinates of a point.
    fn lattice(&self, p: Point) -> [f64; 2] {
        let d = p - self.origin;
        let det = self.a1.perp(&self.a2);
        [d.perp(&self.a2) / det, self.a1.perp(&d) / det]
    }

    /// Position of a lattice node (m).
    pub fn node(&self, star: [i32; 2]) -> Point {
        self.origin + self.a1 * f64::from(star[0]) + self.a2 * f64::from(star[1])
    }

    /// Gradients of the three weights in an up and a down triangle (1/m) (Eq. 1).
    pub fn gradients(&self) -> [[Vector; 3]; 2] {
        let double_area = self.a1.perp(&self.a2);
        let g1 = Vector::new(self.a2.y, -self.a2.x) / double_area;
        let g2 = Vector::new(-self.a1.y, self.a1.x) / double_area;
        let up = [-(g1 + g2), g1, g2];
        [up, up.map(|g| -g)]
    }

    /// Weights of the three stars of `triangle` at `p`, linear beyond it as well (Eq. 1).
    pub fn weights(&self, triangle: Triangle, p: Point) -> Weights {
        let gradients = self.gradients()[triangle.set as usize];
        let d = p - self.node(triangle.nodes()[0]);
        let (w1, w2) = (gradients[1].dot(&d), gradients[2].dot(&d));
        [1.0 - w1 - w2, w1, w2]
    }

    /// The triangle that holds a point.
    pub fn locate(&self, p: Point) -> Triangle {
        let [s, t] = self.lattice(p);
        let (i, j) = (s.floor(), t.floor());
        Triangle { i: i as i32, j: j as i32, set: u8::from(s - i + t - j > 1.0) }
    }

    /// Direction of a mesh edge, and the lattice cell at its start.
    fn direction_and_cell(&self, edge: MeshEdgeId) -> (u32, [i32; 2]) {
        let (cell, direction) = ((edge.number() / 3) as i32, edge.number() % 3);
        (direction, [self.first[0] + cell % self.count[0], self.first[1] + cell / self.count[0]])
    }

    /// The triangle to the left of mesh edge `edge` (as numbered by [`RegularMesh::segments`]), or to its right when
    /// `reversed`.
    pub fn triangle_beside(&self, edge: MeshEdgeId, reversed: bool) -> Triangle {
        let (direction, [i, j]) = self.direction_and_cell(edge);
        match (direction, reversed) {
            (0, false) | (2, false) => Triangle { i, j, set: 0 },
            (0, true) => Triangle { i, j: j - 1, set: 1 },
            (1, false) => Triangle { i: i - 1, j, set: 1 },
            (1, true) => Triangle { i, j, set: 0 },
            _ => Triangle { i, j, set: 1 },
        }
    }

    /// The two stars at the ends of mesh edge `edge`.
    pub fn edge_stars(&self, edge: MeshEdgeId) -> [[i32; 2]; 2] {
        let (direction, [i, j]) = self.direction_and_cell(edge);
        match direction {
            0 => [[i, j], [i + 1, j]],
            1 => [[i, j], [i, j + 1]],
            _ => [[i + 1, j], [i, j + 1]],
        }
    }

    /// Edges of all triangles that come near the box `low`–`high`, each once.
    pub fn segments(&self, low: Point, high: Point) -> impl Iterator<Item = Segment> {
        let margin = Vector::new(self.size, self.size) * 0.51;
        let (low, high) = (low - margin, high + margin);
        let near = move |t: Triangle| {
            let nodes = t.nodes().map(|n| self.node(n));
            let least = nodes[0].inf(&nodes[1]).inf(&nodes[2]);
            let most = nodes[0].sup(&nodes[1]).sup(&nodes[2]);
            least.x <= high.x && least.y <= high.y && most.x >= low.x && most.y >= low.y
        };
        let edges = (0..self.count[1]).flat_map(move |row| {
            let start = row as usize * self.count[0] as usize;
            let columns = self.columns_near(self.first[1] + row, low, high);
            columns
                .flat_map(move |column| (0..3).map(move |side| MeshEdgeId::new(3 * (start + column as usize) + side)))
        });
        let is_near = move |&edge: &MeshEdgeId| [false, true].iter().any(|&far| near(self.triangle_beside(edge, far)));
        edges.filter(is_near).map(|edge| {
            let [a, b] = self.edge_stars(edge).map(|star| self.node(star));
            Segment { a, b, label: Label { outline: 0, trace: None, mesh: Some(edge), mesh_reversed: false } }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_one_at_their_star_and_sum_to_one() {
        let mesh = RegularMesh::new(1.3, 0.4, Point::new(0.2, -7.0), Point::zeros(), Point::new(5.0, 5.0));
        for set in 0..2 {
            let triangle = Triangle { i: 3, j: -2, set };
            for (k, star) in triangle.nodes().into_iter().enumerate() {
                let w = mesh.weights(triangle, mesh.node(star));
                for (l, value) in w.into_iter().enumerate() {
                    assert!((value - f64::from(u8::from(k == l))).abs() < 1e-14);
                }
            }
            let centre = triangle.nodes().iter().map(|&s| mesh.node(s)).sum::<Point>() / 3.0;
            assert_eq!(mesh.locate(centre), triangle);
        }
    }

    #[test]
    fn triangles_beside_an_edge_hold_both_its_stars() {
        let mesh = RegularMesh::new(1.0, 0.0, Point::zeros(), Point::zeros(), Point::new(3.0, 3.0));
        for edge in MeshEdgeId::all(60) {
            let stars = mesh.edge_stars(edge);
            for reversed in [false, true] {
                let nodes = mesh.triangle_beside(edge, reversed).nodes();
                assert!(stars.iter().all(|s| nodes.contains(s)));
                let [a, b] = stars.map(|s| mesh.node(s));
                let centre = nodes.iter().map(|&s| mesh.node(s)).sum::<Point>() / 3.0;
                assert_eq!((b - a).perp(&(centre - a)) > 0.0, !reversed);
            }
        }
    }
}
