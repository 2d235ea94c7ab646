//! Result of the cut: physical covers, manifold elements and blocks.

use crate::geometry::{Point, Vector, polygon, segment};

use super::mesh::{RegularMesh, Triangle};
use super::order;
use super::{BlockId, CoverId, ElementId, Weights};

/// All covers, elements and blocks of a model in the reference configuration, ordered by block and in space.
#[derive(Debug, Clone)]
pub struct Covers {
    /// The lattice of mathematical covers.
    pub mesh: RegularMesh,
    /// Weight gradients (1/m) of the up and the down triangle.
    pub gradients: [[Vector; 3]; 2],
    /// Three physical covers of each element, counter-clockwise.
    pub element_covers: Vec<[CoverId; 3]>,
    /// Lattice triangle of each element.
    pub element_triangle: Vec<Triangle>,
    /// Cut area of each element (m²).
    pub element_area: Vec<f64>,
    /// Area centroid of each element (m).
    pub element_centroid: Vec<Point>,
    /// Polar second moment of area of each element about its centroid (m⁴).
    pub element_polar: Vec<f64>,
    /// Block of each element.
    pub element_block: Vec<BlockId>,
    /// Polygons of the elements.
    pub polygons: Polygons,
    /// Lattice node of each physical cover.
    pub star: Vec<[i32; 2]>,
    /// Position of that node (m).
    pub star_position: Vec<Point>,
    /// Block of each physical cover.
    pub cover_block: Vec<BlockId>,
    /// Elements and physical covers of the blocks.
    pub block_ranges: BlockRanges,
    /// Element whose covers carry what acts on the boundary of each element: itself, or a heavier one beside a sliver.
    pub host: Vec<ElementId>,
    /// Elements in the order of their lattice triangles, row by row, for finding them by position.
    pub(super) by_triangle: Vec<ElementId>,
}

/// Polygons of the elements, one after the other.
#[derive(Debug, Clone)]
pub struct Polygons {
    /// First point of each element's polygon, and the number of points at the end.
    pub start: Vec<u32>,
    /// Corners (m), counter-clockwise; holes are joined by bridges.
    pub points: Vec<Point>,
}

impl Polygons {
    /// Ends the polygon of the points that were pushed last; the first call begins the first one.
    pub(super) fn close(&mut self) {
        self.start.push(self.points.len() as u32);
    }

    /// Corners of a polygon.
    pub(super) fn of(&self, k: usize) -> &[Point] {
        &self.points[self.start[k] as usize..self.start[k + 1] as usize]
    }
}

/// Elements and physical covers of the blocks, of which each has a run.
#[derive(Debug, Clone)]
pub struct BlockRanges {
    /// First element of each block, and the number of elements at the end.
    pub elements: Vec<u32>,
    /// First physical cover of each block, and the number of covers at the end.
    pub covers: Vec<u32>,
}

impl Covers {
    /// Number of blocks.
    pub fn block_count(&self) -> usize {
        self.block_ranges.elements.len() - 1
    }

    /// All blocks.
    pub fn blocks(&self) -> impl ExactSizeIterator<Item = BlockId> + Clone {
        BlockId::all(self.block_count())
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.element_covers.len()
    }

    /// All elements.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = ElementId> + Clone {
        ElementId::all(self.element_count())
    }

    /// Number of physical covers.
    pub fn cover_count(&self) -> usize {
        self.star.len()
    }

    /// Elements of a block, by their indices.
    pub fn elements_of(&self, block: BlockId) -> std::ops::Range<usize> {
        self.block_ranges.elements[block] as usize..self.block_ranges.elements[block.index() + 1] as usize
    }

    /// Physical covers of a block, by their indices.
    pub fn covers_of(&self, block: BlockId) -> std::ops::Range<usize> {
        self.block_ranges.covers[block] as usize..self.block_ranges.covers[block.index() + 1] as usize
    }

    /// Reference polygon of an element.
    pub fn polygon(&self, element: ElementId) -> &[Point] {
        self.polygons.of(element.index())
    }

    /// Weights of an element's covers at a reference point (Eq. 1).
    pub fn weights(&self, element: ElementId, p: Point) -> Weights {
        self.mesh.weights(self.element_triangle[element], p)
    }

    /// Area of a block (m²).
    pub fn block_area(&self, block: BlockId) -> f64 {
        self.element_area[self.elements_of(block)].iter().sum()
    }

    /// Area centroid of a block in the reference configuration (m).
    pub fn block_centroid(&self, block: BlockId) -> Point {
        let first: Point = self.elements_of(block).map(|e| self.element_centroid[e] * self.element_area[e]).sum();
        first / self.block_area(block)
    }

    /// A reference point inside a block: the centre of the largest triangle of its largest element.
    pub fn point_inside(&self, block: BlockId) -> Point {
        let largest = |a: &ElementId, b: &ElementId| self.element_area[*a].total_cmp(&self.element_area[*b]);
        let elements = ElementId::range(self.elements_of(block));
        let triangles = elements.max_by(largest).map(|e| polygon::triangles(self.polygon(e)));
        let area = |t: &[Point; 3]| polygon::area(t);
        let triangle = triangles.into_iter().flatten().max_by(|a, b| area(a).total_cmp(&area(b)));
        triangle.map_or_else(|| self.block_centroid(block), |t| t.iter().sum::<Point>() / 3.0)
    }

    /// The element that holds a reference point, on its boundary included; the lowest when several do.
    pub fn element_at(&self, p: Point) -> Option<ElementId> {
        self.around(p, 0.0).filter(|&e| polygon::contains(self.polygon(e), p)).min()
    }

    /// Bytes of the index by position.
    pub fn index_bytes(&self) -> usize {
        size_of_val(self.by_triangle.as_slice())
    }

    /// Elements that come within `reach` (m) of a point, and some more.
    pub fn around(&self, p: Point, reach: f64) -> impl Iterator<Item = ElementId> {
        let Triangle { i, j, .. } = self.mesh.locate(p);
        // A lattice row is 0.866 of the mesh size high.
        let rings = 1 + (1.2 * reach / self.mesh.size).min(1e6) as i32;
        let before = move |row: i32, column: i32| {
            self.by_triangle.partition_point(|&e| {
                let triangle = &self.element_triangle[e];
                (triangle.j, triangle.i) < (row, column)
            })
        };
        let rows = j.saturating_sub(rings)..=j.saturating_add(rings);
        let (first, end) = (i.saturating_sub(2 * rings), i.saturating_add(2 * rings + 1));
        rows.flat_map(move |row| self.by_triangle[before(row, first)..before(row, end)].iter().copied())
    }

    /// The element that holds a reference point, or else the nearest one within `reach` (m).
    pub fn element_near(&self, p: Point, reach: f64) -> Option<ElementId> {
        let distance = |e: ElementId| -> f64 {
            let points = self.polygon(e);
            let sides = points.iter().zip(points.iter().cycle().skip(1));
            sides.map(|(a, b)| segment::distance(p, *a, *b)).fold(f64::INFINITY, f64::min)
        };
        let nearest = |a: &(f64, ElementId), b: &(f64, ElementId)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        self.element_at(p).or_else(|| {
            let near = self.around(p, reach).map(|e| (distance(e), e)).min_by(nearest)?;
            (near.0 <= reach).then_some(near.1)
        })
    }

    /// Lattice nodes of a tile.
    pub const TILE: usize = order::TILE;

    /// Whether the covers of a block go tile by tile, and row by row within each.
    pub fn is_tiled(&self, block: BlockId) -> bool {
        self.covers_of(block).len() >= order::TILED
    }

    /// Tile of the lattice that a cover stands in.
    pub fn tile(&self, cover: CoverId) -> [i32; 2] {
        order::tile(self.star[cover])
    }

    /// Number of physical covers of each star, as (star, number), ordered by star.
    pub fn covers_by_star(&self) -> Vec<([i32; 2], u32)> {
        let mut stars = self.star.clone();
        stars.sort_unstable();
        let mut counts: Vec<([i32; 2], u32)> = Vec::new();
        for star in stars {
            match counts.last_mut() {
                Some((last, n)) if *last == star => *n += 1,
                _ => counts.push((star, 1)),
            }
        }
        counts
    }
}
