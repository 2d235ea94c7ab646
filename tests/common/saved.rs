//! Layout of the bytes of a saved state of a co-simulation, for tests that change them.

use std::collections::BTreeMap;

use enmm::cosimulation::{Input, Interpolation};
use enmm::model::State;
use serde::{Deserialize, Serialize};

/// A saved state as its bytes hold it.
#[derive(Clone, Serialize, Deserialize)]
pub struct Whole {
    pub state: State,
    pub between: Option<Box<State>>,
    pub progress: Progress,
    pub hash: String,
    pub family: String,
    pub dt: f64,
    pub parameters: Vec<f64>,
    pub aims: BTreeMap<usize, enmm::geometry::Vector>,
    pub ways: BTreeMap<Input, Interpolation>,
}

/// Where the model stands beside its state.
#[derive(Clone, Serialize, Deserialize)]
pub struct Progress {
    pub origin: u64,
    pub start: f64,
    pub started: bool,
    pub initial_residual: f64,
    pub changed: bool,
    pub interpolation: Interpolation,
    pub told: f64,
    pub forces: Option<[f64; 3]>,
}
