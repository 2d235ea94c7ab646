//! The way in which rock fails, in a word, from the motion of its blocks (theory, section 16).

use crate::geometry::{Point, Vector, cross};

/// Share of a motion that is none beside the rest of it.
pub(super) const SLIGHT: f64 = 0.1;

/// Motion of a block as a rigid body: a displacement with a turn, or a velocity with a spin. Only ratios of motions
/// count, so that a mechanism of limit analysis has a name as well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    /// Mass (kg/m).
    pub mass: f64,
    /// Mass centroid where the motion begins (m).
    pub centroid: Point,
    /// Lowest and greatest coordinates of its corners there (m).
    pub bounds: [Point; 2],
    /// Displacement (m) or velocity (m/s) of the centroid.
    pub motion: Vector,
    /// Turn (rad) or spin (rad/s), counter-clockwise.
    pub turn: f64,
    /// Whether contacts, bolts or supports on it carry force.
    pub is_borne: bool,
}

impl RigidMotion {
    /// Half the diagonal of its box (m): how far its corners are from its middle.
    fn reach(&self) -> f64 {
        0.5 * (self.bounds[1] - self.bounds[0]).norm()
    }

    /// Motion of a point of it.
    fn motion_at(&self, point: Point) -> Vector {
        let arm = point - self.centroid;
        self.motion + Vector::new(-arm.y, arm.x) * self.turn
    }

    /// Least and greatest coordinate of its box along a direction (m).
    fn along(&self, direction: Vector) -> [f64; 2] {
        let middle = 0.5 * (self.bounds[0] + self.bounds[1]).dot(&direction);
        let half = 0.5 * (self.bounds[1] - self.bounds[0]).dot(&direction.abs());
        [middle - half, middle + half]
    }

    /// How far its corners move, at most.
    fn extent(&self) -> f64 {
        self.motion.norm() + self.reach() * self.turn.abs()
    }

    /// Mass times the way of the centroid.
    fn way(&self) -> f64 {
        self.mass * self.motion.norm()
    }
}

/// The way in which rock fails.
#[doc(alias = "failure mode")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mechanism {
    /// It moves along a surface and hardly turns.
    Slides,
    /// It turns forward over its foot.
    Topples,
    /// It drops.
    Falls,
    /// It turns about itself, or backward about a point above it.
    Rotates,
}

impl Mechanism {
    /// As a verb: `slides`.
    pub fn verb(self) -> &'static str {
        match self {
            Self::Slides => "slides",
            Self::Topples => "topples",
            Self::Falls => "falls",
            Self::Rotates => "rotates",
        }
    }

    /// As a noun: `sliding`.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Slides => "sliding",
            Self::Topples => "toppling",
            Self::Falls => "falling",
            Self::Rotates => "rotation",
        }
    }
}

/// The way in which blocks move that move together, under a gravity of this direction; none where nothing moves. Blocks
/// count by mass times way, and those not at all that move by less than a tenth of what others do.
///
/// The way of a centroid is that of the foot below it and what turning over the foot adds. Where turning adds more than
/// half, rock topples, or rotates if it turns against its way. It rotates, too, where turning moves corners farther
/// than centroids. It falls where it goes straight down, or more down than aside with nothing that bears it. All else
/// slides.
pub fn mechanism(blocks: &[RigidMotion], gravity: Vector) -> Option<Mechanism> {
    let most = blocks.iter().map(RigidMotion::extent).fold(0.0, f64::max);
    let blocks: Vec<RigidMotion> = blocks.iter().filter(|b| b.extent() > SLIGHT * most).copied().collect();
    let sum = |of: &dyn Fn(&RigidMotion) -> f64| blocks.iter().map(of).sum::<f64>();
    let way = sum(&RigidMotion::way);
    let at_corners = sum(&|b| b.mass * b.reach() * b.turn.abs());
    if blocks.is_empty() {
        return None;
    }
    let down = gravity.try_normalize(0.0).unwrap_or_default();
    let by_turning: f64 = blocks.iter().zip(feet(&blocks, down)).map(|(b, foot)| turned(b, &blocks[foot], down)).sum();
    let drop = sum(&|b| b.mass * b.motion.dot(&down));
    let aside = sum(&|b| b.mass * cross(b.motion, down).abs());
    let in_flight = sum(&|b| if drops(b, down) { b.way() } else { 0.0 });
    Some(if by_turning > 0.5 * way {
        Mechanism::Topples
    } else if by_turning < -0.5 * way || at_corners >= way {
        Mechanism::Rotates
    } else if drop > 0.0 && aside <= SLIGHT * drop || in_flight > 0.5 * way {
        Mechanism::Falls
    } else {
        Mechanism::Slides
    })
}

/// Whether nothing bears a block and it moves more down than aside.
fn drops(block: &RigidMotion, down: Vector) -> bool {
    !block.is_borne && block.motion.dot(&down) > cross(block.motion, down).abs()
}

/// What turning over the foot below it adds to a block's way, times its mass; negative where it turns against its way.
/// It is no more than what the foot has not moved itself, since blocks that tumble on others do not carry each other.
fn turned(block: &RigidMotion, lowest: &RigidMotion, down: Vector) -> f64 {
    let along = block.motion.try_normalize(0.0).unwrap_or_default();
    let foot = block.centroid + down * (lowest.along(down)[1] - block.centroid.dot(&down));
    let forward = (block.centroid - foot).norm() * block.turn * cross(along, down);
    let beyond = (block.motion - lowest.motion_at(foot)).dot(&along);
    let turned = if forward > 0.0 { forward.min(beyond.max(0.0)) } else { forward.max(beyond.min(0.0)) };
    block.mass * turned
}

/// For each block the one on whose foot it stands: that with the lowest corner of those in the vertical strip with its
/// centroid, which may be itself.
fn feet(blocks: &[RigidMotion], down: Vector) -> Vec<usize> {
    let aside = Vector::new(-down.y, down.x);
    let ends: Vec<[f64; 2]> = blocks.iter().map(|b| b.along(aside)).collect();
    let [low, high] = ends.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], e| [a.min(e[0]), b.max(e[1])]);
    let count = blocks.len();
    let strip = |at: f64| {
        let share = (at - low) / (high - low).max(f64::MIN_POSITIVE);
        ((share * count as f64) as usize).min(count - 1)
    };
    let bottoms: Vec<f64> = blocks.iter().map(|b| b.along(down)[1]).collect();
    let mut lowest: Vec<Option<usize>> = vec![None; count];
    for (k, [begin, end]) in ends.iter().enumerate() {
        for other in &mut lowest[strip(*begin)..=strip(*end)] {
            *other = Some(other.filter(|&other| bottoms[other] >= bottoms[k]).unwrap_or(k));
        }
    }
    blocks.iter().enumerate().map(|(k, b)| lowest[strip(b.centroid.dot(&aside))].unwrap_or(k)).collect()
}
