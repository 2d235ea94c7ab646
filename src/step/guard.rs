//! Checks after every step: a run that has gone wrong stops with block, place and cause.

use crate::geometry::Point;
use crate::state::Slope;

use super::Step;

/// What went wrong.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Failure {
    /// A velocity is not a number.
    #[error("the velocity is not finite")]
    NotFinite,
    /// The matrix of an implicit step is not positive definite.
    #[error("the matrix of the implicit step is not positive definite (take a smaller solver.implicit_step)")]
    Singular,
    /// A velocity exceeds the wave speed of the rock.
    #[error("the speed {speed:.3e} m/s exceeds the wave speed {limit:.3e} m/s of the rock (runaway)")]
    Runaway {
        /// Speed (m/s).
        speed: f64,
        /// Limit (m/s).
        limit: f64,
    },
    /// A node has gone too deep into another block.
    #[error("the penetration {depth:.3e} m exceeds the limit {limit:.3e} m (solver.penetration_limit)")]
    Penetration {
        /// Penetration (m).
        depth: f64,
        /// Limit (m).
        limit: f64,
    },
}

/// A numerical failure with its block, place and time.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("block {block} at ({:.3}, {:.3}) m, t = {time:.6} s: {failure}", place.x, place.y)]
pub struct StepError {
    /// Block.
    pub block: u32,
    /// Where (m).
    pub place: Point,
    /// Simulated time (s).
    pub time: f64,
    /// Cause.
    pub failure: Failure,
}

/// Speed (m/s) beyond which a cover has run away: the fastest wave of any rock.
pub(super) fn speed_limit(slope: &Slope) -> f64 {
    slope.rocks.iter().map(|r| (r.confined_modulus() / r.density).sqrt()).fold(0.0, f64::max)
}

impl Step<'_> {
    /// Fails when a velocity is not finite or beyond the wave speed, or a node is too deep in another block.
    pub(super) fn guard(&self) -> Result<(), StepError> {
        let slope = self.slope;
        if self.singular {
            let (place, failure) = (slope.covers.star_position[0], Failure::Singular);
            return Err(StepError { block: 0, place, time: self.time, failure });
        }
        if !self.is_sound {
            self.guard_speeds()?;
        }
        let limit = slope.penetration_limit;
        let scratch = &*self.scratch;
        if scratch.outcomes.iter().all(|outcome| outcome.penetration <= limit) {
            return Ok(());
        }
        match scratch.contacts.iter().find(|contact| contact.loaded_penetration() > limit) {
            Some(contact) => Err(StepError {
                block: contact.pair.blocks[0],
                place: scratch.place[slope.boundary.node_point[contact.history.node as usize] as usize],
                time: self.time,
                failure: Failure::Penetration { depth: contact.loaded_penetration(), limit },
            }),
            None => Ok(()),
        }
    }

    /// Fails when a velocity is not finite or beyond the wave speed.
    fn guard_speeds(&self) -> Result<(), StepError> {
        let slope = self.slope;
        let limit = speed_limit(slope);
        let square = limit * limit;
        if let Some(i) =
            self.state.velocity.iter().position(|v| v.norm_squared().partial_cmp(&square).is_none_or(|o| o.is_gt()))
        {
            let speed = self.state.velocity[i].norm();
            let failure = if speed.is_finite() { Failure::Runaway { speed, limit } } else { Failure::NotFinite };
            let block = slope.covers.cover_block[i];
            let place = slope.covers.star_position[i] + self.state.displacement[i];
            let place = if place.iter().all(|x| x.is_finite()) { place } else { slope.covers.star_position[i] };
            return Err(StepError { block, place, time: self.time, failure });
        }
        Ok(())
    }
}
