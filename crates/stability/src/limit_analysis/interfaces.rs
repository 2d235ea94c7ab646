//! The shared straight pieces of the faces of blocks.

use enmm::geometry::Point;
use enmm::model::tables::{BlockId, BoundaryPiece, LawId, Outlines};

use super::contact::Contact;
use super::model::Strengths;

/// The straight interfaces of all blocks: pieces that follow each other on one line are one interface, because a
/// rigid face carries any distribution of pressure by a force at each end (Eq. 77).
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
