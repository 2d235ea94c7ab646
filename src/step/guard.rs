//! Checks after every step: a run that has gone wrong stops with block, position and cause.

use crate::cover::{self, BlockId, ElementId};
use crate::geometry::Point;
use crate::state::{Model, State, Workspace};
use enmm_case::keys::rounded;

use super::StepOutcome;

/// Cause of a numerical failure.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Failure {
    /// A velocity is not a number.
    #[error("the velocity is not finite")]
    NotFinite,
    /// The matrix of an implicit step is not positive definite.
    #[error("the matrix of the implicit step is not positive definite (take a smaller solver.implicit_step)")]
    Singular,
    /// Rock moves faster than its waves.
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
    /// The flow of water in joints has not been found.
    #[error("{0}; let apertures differ less, or close joints to water there by `aperture = 0`")]
    Flow(enmm_seepage::Failure),
    /// Rock has broken too often.
    #[error("the rock breaks once more than {limit} times (raise fracture.{key}, or the strength of the rock)")]
    Parts {
        /// Limit.
        limit: usize,
        /// Key of the case that sets it.
        key: &'static str,
    },
}

/// A numerical failure with its block, position and time.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("block {block} at ({:.3}, {:.3}) m, t = {} s: {failure}", position.x, position.y, rounded(*time))]
pub struct StepError {
    /// Block.
    pub block: u32,
    /// Where (m).
    pub position: Point,
    /// Simulated time (s).
    pub time: f64,
    /// Cause.
    pub failure: Failure,
}

/// Speed (m/s) beyond which rock has run away: the fastest wave of any rock.
pub(super) fn speed_limit(model: &Model) -> f64 {
    model.rocks.iter().map(|r| (r.confined_modulus() / r.density).sqrt()).fold(0.0, f64::max)
}

/// Fails when a velocity is not finite or beyond the wave speed, or a node is too deep in another block.
pub fn check(model: &Model, state: &State, workspace: &Workspace, outcome: &StepOutcome) -> Result<(), StepError> {
    let failed = |block: BlockId, position: Point, failure: Failure| {
        Err(StepError { block: model.labels[block], position, time: outcome.end, failure })
    };
    if outcome.is_singular {
        return failed(BlockId::new(0), model.covers.star_position[0], Failure::Singular);
    }
    if !outcome.is_sound
        && let Some((block, position, failure)) = unsound(model, state)
    {
        return failed(block, position, failure);
    }
    let limit = model.penetration_limit;
    if workspace.outcomes.iter().all(|outcome| outcome.penetration <= limit) {
        return Ok(());
    }
    match workspace.contacts.iter().find(|contact| contact.loaded_penetration() > limit) {
        Some(contact) => {
            let position = workspace.frames.position(contact.point);
            let failure = Failure::Penetration { depth: contact.loaded_penetration(), limit };
            failed(contact.blocks(&model.boundary)[0], position, failure)
        }
        None => Ok(()),
    }
}

/// The first velocity that is not finite, or rock beyond the wave speed. Covers may be faster: the star of one that a
/// small block has cut lies far from its rock, and turns with it.
fn unsound(model: &Model, state: &State) -> Option<(BlockId, Point, Failure)> {
    let limit = speed_limit(model);
    for (i, velocity) in state.velocity.iter().enumerate() {
        let (block, speed) = (model.covers.cover_block[i], velocity.norm());
        if !speed.is_finite() {
            return Some((block, model.covers.star_position[i], Failure::NotFinite));
        }
        if speed > limit
            && let Some((position, speed)) = rock_faster_than(model, state, limit, block)
        {
            return Some((block, position, Failure::Runaway { speed, limit }));
        }
    }
    None
}

/// Position and speed (m/s) of rock of a block that is faster than a limit: some corner of an element.
fn rock_faster_than(model: &Model, state: &State, limit: f64, block: BlockId) -> Option<(Point, f64)> {
    let covers = &model.covers;
    let corners = ElementId::range(covers.elements_of(block))
        .flat_map(|e| covers.polygon(e).iter().map(move |&corner| (e, corner)));
    let mut moving = corners.map(|(element, corner)| {
        let weights = covers.weights(element, corner);
        let sample = |field| cover::sample(&covers.element_covers[element], &weights, field);
        (corner + sample(&state.displacement), sample(&state.velocity).norm())
    });
    moving.find(|&(_, speed)| speed > limit)
}
