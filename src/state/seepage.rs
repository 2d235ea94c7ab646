//! Water that flows in the joints: what the last static stage found at its start.

use serde::{Deserialize, Serialize};

/// Steady flow in the net of joints of a model.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seepage {
    /// Unknown (m) of each node: the pressure head above 0, the filling of the film below.
    pub unknowns: Vec<f64>,
    /// Whether each piece of joint conducted.
    pub conducts: Vec<bool>,
    /// Whether each block has been dug out and water of the reservoir is in its place.
    pub flooded: Vec<bool>,
    /// Flow through the net in each stage that has found it.
    pub balances: Vec<FlowBalance>,
}

clone_without_allocating! {
    Seepage { unknowns conducts flooded balances }
}

/// Water that went through a net of joints in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlowBalance {
    /// Stage.
    pub stage: u32,
    /// Water (m²/s) that enters and leaves at each head, from the reservoir and from the air.
    pub sums: Vec<[f64; 2]>,
    /// Greatest imbalance of a node (m²/s).
    pub residual: f64,
}
