//! Errors that a host receives. The model is then as it was before the call.

use crate::model::case::Invalid;
use crate::state::bytes::BytesError;
use crate::step::StepError;
use enmm_case::keys::Plain;

use super::ParameterError;

/// Why a call did nothing.
#[derive(Debug, thiserror::Error)]
pub enum CosimulationError {
    /// A stage of the case cannot begin.
    #[error("{0}")]
    Stage(Invalid),
    /// A value is not finite or out of range, or names something that does not exist.
    #[error("{name}: is {value}, must be {limit}; {remedy}")]
    Value {
        /// Name of the value that was set.
        name: String,
        /// The value.
        value: String,
        /// Values that are allowed.
        limit: String,
        /// Remedy.
        remedy: &'static str,
    },
    /// A parameter cannot have a value.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// No port of the case has a name.
    #[error("no port is named {name:?}; ports of the case: {ports}")]
    NoPort {
        /// The name that was asked for.
        name: String,
        /// Names of the ports.
        ports: String,
    },
    /// A communication step does not begin where the model stands.
    #[error(
        "t: is {} s, must be the time of the model, {} s; step from there, or restore a saved state",
        Plain(*given), Plain(*own)
    )]
    Time {
        /// Start that the host gave (s).
        given: f64,
        /// Time of the model (s).
        own: f64,
    },
    /// The step failed numerically.
    #[error("{0}; the model has been rolled back: take a smaller load step, or look at the block")]
    Step(#[from] StepError),
    /// The watch of the model has ended the call.
    #[error("the call was interrupted; the model is as it was before the call: call again to go on")]
    Interrupted,
    /// The communication step that should go on is over.
    #[error("the communication step is over, or the model was moved to another time since: begin another")]
    Stale,
    /// A saved state cannot be used.
    #[error(transparent)]
    State(#[from] BytesError),
}

impl CosimulationError {
    /// The error of a value.
    pub(super) fn value(name: impl Into<String>, value: impl ToString, limit: &str, remedy: &'static str) -> Self {
        Self::Value { name: name.into(), value: value.to_string(), limit: limit.into(), remedy }
    }
}
