//! The way in which rock fails, in a word, follows from the motion of its blocks alone.

use enmm::geometry::{Point, Vector};
use enmm::model::mechanism::mechanism;
use enmm::model::{Mechanism, RigidMotion};

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
        RigidMotion { turn, ..moved([1.0, 5.0], Point::new(along * cosine, along * sine), Vector::new(-cosine, -sine)) }
    };
    let blocks: Vec<RigidMotion> = (0..100).map(block).collect();
    assert_eq!(mechanism(&blocks, GRAVITY), Some(Mechanism::Slides));
}

/// Ten layers on a plane of 45°, of which the lower ones slide without turning, and the upper ones tumble forward.
#[test]
fn blocks_that_tumble_on_a_slide_do_not_make_it_topple() {
    let layer = |k: usize| RigidMotion {
        turn: if k > 5 { 1.0 } else { 0.0 },
        ..moved([2.0, 2.0], Point::new(0.0, 2.0 * k as f64), Vector::new(-10.0, -10.0))
    };
    let blocks: Vec<RigidMotion> = (0..10).map(layer).collect();
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
