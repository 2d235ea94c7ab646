//! Where two blocks can press on each other: the shared straight pieces of their faces, and points.

use enmm::contact::LawId;
use enmm::cover::{BlockId, BoundaryPiece, Outlines};
use enmm::geometry::{Point, Vector};

use super::model::Strengths;

/// A straight interface, or a point where a corner meets a face; forces per metre of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// First and second block.
    pub blocks: [BlockId; 2],
    /// Both ends (m), the same place for a point.
    pub ends: [Point; 2],
    /// Unit vector from the first block to the second, normal to the face.
    pub normal: Vector,
    /// tan φ.
    pub friction: f64,
    /// Shear force (N/m) that it bears without a normal force.
    pub cohesion: f64,
    /// Tensile force (N/m) that it bears.
    pub tension: f64,
}

impl Contact {
    /// Whether it is a position and not a length.
    pub fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// Unit vector along the face, the normal turned by +90°.
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }
}

/// The straight interfaces of all blocks: pieces that follow each other on one line are one interface, because a
/// rigid face bears any distribution of pressure by a force at each end (Eq. 77).
pub fn interfaces(
    outlines: &Outlines,
    element_block: &[BlockId],
    strengths: &Strengths,
    tolerance: f64,
) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for k in 0..outlines.len() {
        let mut run: Option<Run> = None;
        for piece in outlines.of_loop(k) {
            let own = element_block[piece.element];
            let other = piece.opposite.map(|element| element_block[element]);
            // Each face is seen from both sides; the block that comes first speaks.
            let blocks = other.filter(|&other| own < other).map(|other| [own, other]);
            let blocks = blocks.filter(|&blocks| strengths.can_act(blocks));
            let law = strengths.law(piece.trace);
            let goes_on = run.as_ref().zip(blocks);
            let longer = goes_on.and_then(|(run, blocks)| run.with(piece, blocks, law, tolerance));
            if longer.is_none() {
                contacts.extend(run.take().map(|run| run.contact(strengths)));
            }
            run = longer.or_else(|| blocks.map(|blocks| Run { blocks, law, points: vec![piece.a, piece.b] }));
        }
        contacts.extend(run.map(|run| run.contact(strengths)));
    }
    contacts
}

/// Pieces on one line between the same blocks under the same law.
#[derive(Clone)]
struct Run {
    blocks: [BlockId; 2],
    law: LawId,
    points: Vec<Point>,
}

impl Run {
    /// With one piece more, when it goes on straight.
    fn with(&self, piece: &BoundaryPiece, blocks: [BlockId; 2], law: LawId, tolerance: f64) -> Option<Self> {
        let (first, last) = (self.points[0], *self.points.last()?);
        let along = piece.b - first;
        let goes_on = along.dot(&(last - first)) > 0.0 && along.dot(&(piece.b - piece.a)) > 0.0;
        let straight = |p: &Point| along.perp(&(p - first)).abs() <= tolerance * along.norm();
        if self.blocks != blocks || self.law != law || last != piece.a || !goes_on || !self.points.iter().all(straight)
        {
            return None;
        }
        let mut points = self.points.clone();
        points.push(piece.b);
        Some(Self { points, ..*self })
    }

    fn contact(&self, strengths: &Strengths) -> Contact {
        let ends = [self.points[0], self.points[self.points.len() - 1]];
        strengths.face(self.blocks, ends, self.law)
    }
}

/// Normal out of rock on the left of a direction.
pub fn outward(direction: Vector) -> Vector {
    Vector::new(direction.y, -direction.x).normalize()
}
