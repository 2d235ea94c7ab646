//! The way in which rock fails, in a word, from the motion of its blocks (theory, section 16).

use crate::geometry::{Point, Vector, cross};

/// Share of a motion that is none beside the rest of it.
const SLIGHT: f64 = 0.1;

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
/// The way of a centroid is that of the block's foot and what turning over the foot adds. Where turning adds more than
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
    let by_turning: f64 = blocks.iter().zip(feet(&blocks, down)).map(|(b, foot)| turned(b, foot, down)).sum();
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

/// What turning over a foot so far below it (m) adds to a block's way, times its mass; negative where it turns against
/// its way.
fn turned(block: &RigidMotion, foot: f64, down: Vector) -> f64 {
    let forward = cross(block.motion.try_normalize(0.0).unwrap_or_default(), down);
    block.mass * foot * block.turn * forward
}

/// How far below the centroid of each block the foot of the moving rock lies on which it stands (m): the lowest corner
/// of the blocks that are in the vertical strip with its centroid, or its own.
fn feet(blocks: &[RigidMotion], down: Vector) -> Vec<f64> {
    let aside = Vector::new(-down.y, down.x);
    let ends: Vec<[f64; 2]> = blocks.iter().map(|b| b.along(aside)).collect();
    let [low, high] = ends.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], e| [a.min(e[0]), b.max(e[1])]);
    let count = blocks.len();
    let strip = |at: f64| {
        let share = (at - low) / (high - low).max(f64::MIN_POSITIVE);
        ((share * count as f64) as usize).min(count - 1)
    };
    let mut lowest = vec![f64::NEG_INFINITY; count];
    for (block, [begin, end]) in blocks.iter().zip(&ends) {
        let bottom = block.along(down)[1];
        lowest[strip(*begin)..=strip(*end)].iter_mut().for_each(|depth| *depth = depth.max(bottom));
    }
    blocks.iter().map(|b| lowest[strip(b.centroid.dot(&aside))] - b.centroid.dot(&down)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: Vector = Vector::new(0.0, -9.81);

    /// A rectangle of these sides (m) that turns by `turn` about a point, which moves by `motion`.
    fn rectangle(sides: [f64; 2], centroid: Point, pivot: Point, turn: f64, motion: Vector) -> RigidMotion {
        let arm = centroid - pivot;
        RigidMotion {
            mass: 2700.0 * sides[0] * sides[1],
            centroid,
            bounds: [-0.5, 0.5].map(|half| centroid + Vector::from(sides) * half),
            motion: motion + Vector::new(-arm.y, arm.x) * turn,
            turn,
            is_borne: true,
        }
    }

    /// A rectangle that moves without turning.
    fn moved(sides: [f64; 2], centroid: Point, motion: Vector) -> RigidMotion {
        rectangle(sides, centroid, centroid, 0.0, motion)
    }

    /// Columns 2 m wide and 10 m high on a base that rises by 30° to the right, each of this many blocks, which turn to
    /// the left about their feet; the feet move as well.
    fn columns(parts: usize, turn: f64, of_feet: Vector) -> Vec<RigidMotion> {
        let height = 10.0 / parts as f64;
        let column = |k: usize| {
            let foot = Point::new(2.0 * k as f64, 2.0 * k as f64 * 30f64.to_radians().tan());
            (0..parts).map(move |part| {
                let centroid = foot + Vector::new(1.0, (part as f64 + 0.5) * height);
                rectangle([2.0, height], centroid, foot, turn, of_feet)
            })
        };
        (0..20).flat_map(column).collect()
    }

    #[test]
    fn what_moves_along_a_plane_slides() {
        for dip in [5f64, 35.0, 75.0] {
            let (sine, cosine) = dip.to_radians().sin_cos();
            let block = moved([8.0, 2.0], Point::new(3.0, 40.0), Vector::new(-cosine, -sine));
            assert_eq!(mechanism(&[block], GRAVITY), Some(Mechanism::Slides), "{dip}");
        }
    }

    #[test]
    fn a_column_that_turns_over_its_lower_corner_topples_whatever_its_blocks_and_its_side() {
        for turn in [-1e-6, 0.2] {
            let foot = Point::new(if turn > 0.0 { -0.5 } else { 0.5 }, 0.0);
            let column = rectangle([1.0, 10.0], Point::new(0.0, 5.0), foot, turn, Vector::zeros());
            assert_eq!(mechanism(&[column], GRAVITY), Some(Mechanism::Topples), "{turn}");
        }
        for parts in [1, 3, 10] {
            assert_eq!(mechanism(&columns(parts, 0.01, Vector::zeros()), GRAVITY), Some(Mechanism::Topples), "{parts}");
        }
    }

    /// The mean centroid of these columns turns by 5 m · turn: feet that move less leave most of the motion to turning.
    #[test]
    fn columns_whose_feet_move_farther_than_they_turn_slide() {
        for parts in [1, 4] {
            let of = |feet: f64| mechanism(&columns(parts, 0.01, Vector::new(-feet, -0.2 * feet)), GRAVITY);
            assert_eq!((of(0.03), of(0.08)), (Some(Mechanism::Topples), Some(Mechanism::Slides)), "{parts}");
        }
    }

    /// 100 m of rock, 5 m thick, on a plane of 30°: its blocks turn to and fro by 3 % of their way, and on the whole by
    /// .5 % forward, which over 5 m is nothing beside a way of 1 m, though over the 50 m of the slope it is much.
    #[test]
    fn a_long_slide_whose_blocks_shake_slides() {
        let (sine, cosine) = 30f64.to_radians().sin_cos();
        let block = |k: usize| {
            let along = 0.5 + k as f64;
            let turn = 0.005 + if k.is_multiple_of(2) { 0.03 } else { -0.03 };
            RigidMotion {
                turn,
                ..moved([1.0, 5.0], Point::new(along * cosine, along * sine), Vector::new(-cosine, -sine))
            }
        };
        let blocks: Vec<RigidMotion> = (0..100).map(block).collect();
        assert_eq!(mechanism(&blocks, GRAVITY), Some(Mechanism::Slides));
    }

    #[test]
    fn what_drops_from_a_roof_or_flies_off_a_face_falls() {
        let roof = moved([2.0, 1.0], Point::zeros(), Vector::new(0.05, -1.0));
        let flight = moved([1.0, 1.0], Point::zeros(), Vector::new(-2.0, -3.0));
        assert_eq!(mechanism(&[roof], GRAVITY), Some(Mechanism::Falls));
        assert_eq!(mechanism(&[flight], GRAVITY), Some(Mechanism::Slides));
        assert_eq!(mechanism(&[RigidMotion { is_borne: false, ..flight }], GRAVITY), Some(Mechanism::Falls));
        let lifted = RigidMotion { motion: Vector::new(0.0, 1.0), is_borne: false, ..roof };
        assert_eq!(mechanism(&[lifted], GRAVITY), Some(Mechanism::Slides));
    }

    /// A wheel on its axle, and a mass on a slip circle, whose top leans back; on a wide circle it slides.
    #[test]
    fn what_turns_about_itself_or_backward_rotates() {
        let wheel = rectangle([2.0, 2.0], Point::zeros(), Point::new(0.3, 0.1), 0.5, Vector::zeros());
        assert_eq!(mechanism(&[wheel], GRAVITY), Some(Mechanism::Rotates));
        let slip = |pivot| rectangle([14.0, 8.0], Point::zeros(), pivot, -0.1, Vector::zeros());
        for (pivot, word) in [((-2.0, 5.0), Mechanism::Rotates), ((-20.0, 50.0), Mechanism::Slides)] {
            let slip = slip(Point::new(pivot.0, pivot.1));
            assert!(slip.motion.x < 0.0 && slip.motion.y < 0.0, "down and to the left: {:?}", slip.motion);
            assert_eq!(mechanism(&[slip], GRAVITY), Some(word));
        }
    }

    #[test]
    fn neither_unit_of_time_nor_frame_nor_blocks_at_rest_change_the_word() {
        let quarter = |v: Vector| Vector::new(-v.y, v.x);
        let still = moved([50.0, 50.0], Point::new(20.0, -30.0), Vector::zeros());
        for (feet, word) in [(0.02, Mechanism::Topples), (0.2, Mechanism::Slides)] {
            let mut blocks = columns(2, 0.01, Vector::new(-feet, 0.0));
            blocks.iter_mut().for_each(|b| (b.motion, b.turn) = (b.motion * 1e-7, b.turn * 1e-7));
            assert_eq!(mechanism(&blocks, GRAVITY), Some(word));
            let turned = |b: &RigidMotion| {
                let [low, high] = b.bounds.map(quarter);
                let bounds = [low.inf(&high), low.sup(&high)];
                RigidMotion { centroid: quarter(b.centroid), motion: quarter(b.motion), bounds, ..*b }
            };
            let frame: Vec<RigidMotion> = blocks.iter().map(turned).collect();
            assert_eq!(mechanism(&frame, quarter(GRAVITY)), Some(word));
            blocks.push(still);
            assert_eq!(mechanism(&blocks, GRAVITY), Some(word), "with rock that stays");
        }
    }

    #[test]
    fn without_gravity_rock_slides_or_rotates_and_without_motion_it_does_nothing() {
        let block = moved([1.0, 1.0], Point::zeros(), Vector::new(0.0, -1.0));
        assert_eq!(mechanism(&[block], Vector::zeros()), Some(Mechanism::Slides));
        assert_eq!(mechanism(&[RigidMotion { turn: 3.0, ..block }], Vector::zeros()), Some(Mechanism::Rotates));
        assert_eq!(mechanism(&[RigidMotion { motion: Vector::zeros(), ..block }], GRAVITY), None);
        assert_eq!(mechanism(&[], GRAVITY), None);
    }
}
