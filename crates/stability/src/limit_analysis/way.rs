//! The way in which the blocks of a mechanism move, and what that says of its bound.

use std::f64::consts::PI;

use enmm::geometry::{Point, Vector};
use enmm::model::tables::{BlockId, Outlines};
use enmm::model::{Mechanism, RigidMotion};

use super::MovingBlock;
use super::program::Program;

/// Share of the greatest speed by which blocks that move as one may differ, their turning at their own radius included.
const AS_ONE: f64 = 0.1;
/// Share of a block's weight that counts as no force.
const NONE: f64 = 1e-6;

/// The way in which a mechanism moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Way {
    /// In a word.
    pub mechanism: Mechanism,
    /// Whether all its blocks move alike and do not turn.
    pub is_one: bool,
}

impl Way {
    /// The way of blocks whose boxes and whether something bears them are known by their numbers.
    pub fn of(blocks: &[MovingBlock], boxes: &[[Point; 2]], borne: &[bool], gravity: Vector) -> Option<Self> {
        let motion = |b: &MovingBlock| RigidMotion {
            mass: b.mass,
            centroid: b.position,
            bounds: boxes[b.block as usize],
            motion: b.velocity,
            turn: b.spin,
            is_borne: borne[b.block as usize],
        };
        let motions: Vec<RigidMotion> = blocks.iter().map(motion).collect();
        let mechanism = enmm::model::mechanism::mechanism(&motions, gravity)?;
        let mass: f64 = blocks.iter().map(|b| b.mass).sum();
        let mean = blocks.iter().map(|b| b.velocity * b.mass).sum::<Vector>() / mass;
        let differs = |b: &MovingBlock| (b.velocity - mean).norm() + b.spin.abs() * (b.area / PI).sqrt();
        Some(Self { mechanism, is_one: blocks.iter().all(|b| differs(b) <= AS_ONE) })
    }

    /// As a verb, with whether blocks move as one.
    pub fn name(self) -> &'static str {
        match (self.mechanism, self.is_one) {
            (Mechanism::Slides, true) => "slides as one",
            (Mechanism::Falls, true) => "falls as one",
            (mechanism, _) => mechanism.verb(),
        }
    }

    /// In words, with how far bounds by such mechanisms lie above the factor.
    pub fn words(self) -> String {
        let name = self.name();
        match (self.mechanism, self.is_one) {
            (Mechanism::Slides | Mechanism::Falls, true) => {
                format!("{name}: such bounds lie close to the factor")
            }
            (Mechanism::Slides, false) => {
                format!("{name}, and blocks turn or cross each other: such bounds may be 1.5 times too high")
            }
            _ => format!("{name}: such bounds may be 1.5 times too high"),
        }
    }
}

/// Boxes round the outlines of blocks.
pub fn boxes(outlines: &Outlines, element_block: &[BlockId], blocks: usize) -> Vec<[Point; 2]> {
    let mut boxes = vec![[Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY)]; blocks];
    for piece in &outlines.pieces {
        let [low, high] = &mut boxes[element_block[piece.element].number() as usize];
        (*low, *high) = (low.inf(&piece.a), high.sup(&piece.a));
    }
    boxes
}

/// Whether contacts, bolts or fixities bear each block.
pub fn borne(program: &Program, normals: &[f64]) -> Vec<bool> {
    let mut borne: Vec<bool> = program.bodies.iter().map(|body| !body.holds.is_empty()).collect();
    let pressed = program.contacts.iter().zip(normals);
    let pressed =
        pressed.filter(|(contact, force)| contact.blocks.iter().any(|&b| **force > NONE * program.bodies[b].weight));
    let blocks = pressed.map(|(contact, _)| contact.blocks).chain(program.bars.iter().map(|bar| bar.blocks));
    blocks.flatten().for_each(|b| borne[b.number() as usize] = true);
    borne
}
