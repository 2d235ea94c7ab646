//! Positions that a case names, found on the built covers.

use crate::cover::{BlockId, BoundaryPiece, CoverId, Covers, ElementId, Outlines, Weights};
use crate::geometry::{Point, Vector, segment};
use crate::model::case::Invalid;

/// Finds positions of a case on the covers of its model.
pub(super) struct Locator<'a> {
    pub covers: &'a Covers,
    pub outlines: &'a Outlines,
    /// Distance (m) within which a position counts as on the rock or on a boundary.
    pub tolerance: f64,
}

/// A material point.
pub(super) struct MaterialPoint {
    pub block: BlockId,
    pub covers: [CoverId; 3],
    pub weights: Weights,
}

/// A piece of outer boundary.
pub(super) struct OuterPiece {
    pub block: BlockId,
    pub covers: [CoverId; 3],
    pub weights: [Weights; 2],
    pub piece: BoundaryPiece,
}

/// A material point with a support's stiffness (N/m per metre) and the force (N/m) that it carries from the start.
pub(super) struct Hold {
    pub block: BlockId,
    pub covers: [CoverId; 3],
    pub weights: Weights,
    pub stiffness: f64,
    pub preload: Vector,
}

impl MaterialPoint {
    pub fn support(self, stiffness: f64) -> Hold {
        let Self { block, covers, weights } = self;
        Hold { block, covers, weights, stiffness, preload: Vector::zeros() }
    }
}

impl OuterPiece {
    pub fn length(&self) -> f64 {
        (self.piece.b - self.piece.a).norm()
    }

    /// Weights at the middle of the piece.
    pub fn middle(&self) -> Weights {
        [0, 1, 2].map(|k| 0.5 * (self.weights[0][k] + self.weights[1][k]))
    }

    /// Support of the middle with a stiffness given in Pa/m, preloaded by the in-situ stress.
    pub fn support(&self, stiffness: f64, in_situ: &dyn Fn(Point) -> [f64; 3]) -> Hold {
        let along = self.piece.b - self.piece.a;
        let outward = Vector::new(along.y, -along.x);
        let [xx, yy, xy] = in_situ((self.piece.a + self.piece.b) * 0.5);
        let preload = Vector::new(xx * outward.x + xy * outward.y, xy * outward.x + yy * outward.y);
        let weights = self.middle();
        Hold { block: self.block, covers: self.covers, weights, stiffness: stiffness * self.length(), preload }
    }
}

impl Locator<'_> {
    /// The element at a point.
    pub fn element(&self, key: &str, point: [f64; 2]) -> Result<ElementId, Invalid> {
        self.covers.element_near(Point::from(point), self.tolerance).ok_or_else(|| Invalid {
            key: key.into(),
            message: format!(
                "there is no rock at ({}, {}): choose a point inside a block; the rock is nearest at {}",
                point[0],
                point[1],
                self.nearest_outer(Point::from(point))
            ),
        })
    }

    /// The block at a point.
    pub fn block(&self, key: &str, point: [f64; 2]) -> Result<BlockId, Invalid> {
        self.element(key, point).map(|e| self.covers.element_block[e])
    }

    /// The material point at a position.
    pub fn point(&self, key: &str, point: [f64; 2]) -> Result<MaterialPoint, Invalid> {
        let element = self.element(key, point)?;
        Ok(MaterialPoint {
            block: self.covers.element_block[element],
            covers: self.covers.element_covers[element],
            weights: self.covers.weights(element, Point::from(point)),
        })
    }

    /// All pieces of outer boundary on the segment `edge`.
    pub fn boundary(&self, key: &str, edge: [[f64; 2]; 2]) -> Result<Vec<OuterPiece>, Invalid> {
        let [a, b] = edge.map(Point::from);
        let on_edge = |p: &&BoundaryPiece| {
            p.opposite.is_none() && [p.a, p.b].iter().all(|&q| segment::distance(q, a, b) <= self.tolerance)
        };
        let pieces: Vec<OuterPiece> =
            self.outlines.pieces.iter().filter(on_edge).map(|p| self.outer_piece(p)).collect();
        if pieces.is_empty() {
            let near = self.nearest_outer(a + (b - a) / 2.0);
            return Err(Invalid {
                key: key.into(),
                message: format!(
                    "no outer boundary of the rock lies on the segment ({}, {})–({}, {}): give two points of one \
                     straight side of the outline, which is nearest at {near}; y points up",
                    a.x, a.y, b.x, b.y
                ),
            });
        }
        Ok(pieces)
    }

    /// Where the outer boundary is nearest to a point: a corner, or where an element ends.
    fn nearest_outer(&self, point: Point) -> String {
        let outer = self.outlines.pieces.iter().filter(|piece| piece.opposite.is_none()).map(|piece| piece.a);
        let near = outer.min_by(|p, q| (p - point).norm().total_cmp(&(q - point).norm())).unwrap_or(point);
        format!("({:.6}, {:.6})", near.x, near.y)
    }

    fn outer_piece(&self, piece: &BoundaryPiece) -> OuterPiece {
        let element = piece.element;
        OuterPiece {
            block: self.covers.element_block[element],
            covers: self.covers.element_covers[element],
            weights: [self.covers.weights(element, piece.a), self.covers.weights(element, piece.b)],
            piece: *piece,
        }
    }

    /// Physical covers whose area centroid lies in the box `[xmin, ymin, xmax, ymax]`.
    pub fn covers_in(&self, key: &str, region: [f64; 4]) -> Result<Vec<CoverId>, Invalid> {
        let covers = self.covers;
        let mut first = vec![Vector::zeros(); covers.cover_count()];
        let mut area = vec![0.0; covers.cover_count()];
        for e in covers.elements() {
            for &i in &covers.element_covers[e] {
                first[i] += covers.element_centroid[e] * covers.element_area[e];
                area[i] += covers.element_area[e];
            }
        }
        let inside = |i: &CoverId| {
            let c = first[*i] / area[*i];
            c.x >= region[0] && c.y >= region[1] && c.x <= region[2] && c.y <= region[3]
        };
        let held: Vec<CoverId> = CoverId::all(covers.cover_count()).filter(inside).collect();
        if held.is_empty() {
            return Err(Invalid {
                key: key.into(),
                message: format!(
                    "the box {region:?} holds no physical cover: enlarge it beyond the mesh size {} m or fix an edge",
                    covers.mesh.size
                ),
            });
        }
        Ok(held)
    }
}
