//! Newmark's rigid block (1965): the ground carries it along up to a yield acceleration, beyond which it slides.

use crate::accelerogram::{Accelerogram, Motion, Piece};

impl Accelerogram {
    /// Way (m) of a rigid block on the ground that slides in one sense alone: where the acceleration exceeds that at
    /// which it yields (m/s², above 0), until block and ground have one velocity again, also after the last point.
    pub fn sliding_block(&self, yields: f64) -> f64 {
        let mut motion = Motion::default();
        for piece in self.pieces() {
            motion = slide(Piece { first: piece.first - yields, ..piece }, motion);
        }
        motion.displacement + 0.5 * motion.velocity * motion.velocity / yields
    }
}

/// Follows a block through a piece of its acceleration relative to the ground. It rests while that is negative.
fn slide(mut piece: Piece, mut motion: Motion) -> Motion {
    loop {
        if motion.velocity <= 0.0 {
            motion.velocity = 0.0;
            if piece.first <= 0.0 {
                // It stays until the acceleration is above 0 again.
                let Some(turn) = (piece.rate > 0.0).then(|| -piece.first / piece.rate) else { return motion };
                if turn >= piece.length {
                    return motion;
                }
                piece = Piece { first: 0.0, length: piece.length - turn, ..piece };
            }
        }
        let Some(stop) = piece.stops(motion).next() else { return piece.moved(motion, piece.length) };
        motion = Motion { velocity: 0.0, ..piece.moved(motion, stop) };
        // It stops where it is slowed down.
        piece = Piece { first: piece.at(stop).min(0.0), length: piece.length - stop, ..piece };
    }
}
