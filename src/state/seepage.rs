//! Water that flows in the joints: what the last static stage found at its start.

use serde::{Deserialize, Serialize};

/// Steady flow in the net of joints of a model.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seepage {
    /// Unknown (m) of each node: the pressure head above 0, the filling of the film below.
    pub unknowns: Vec<f64>,
    /// Whether each piece of joint conducted.
    pub conducts: Vec<bool>,
    /// Apertures (m) at both nodes of each piece as the last static stage began, 0 where it did not conduct.
    pub apertures: Vec<[f64; 2]>,
    /// Whether each block has been dug out and water of the reservoir is in its place.
    pub flooded: Vec<bool>,
    /// Surroundings for which it was found.
    pub surroundings: Surroundings,
    /// Flow through the net in each stage that has found it, the last one that it has found.
    pub balances: Vec<FlowBalance>,
    /// Water (m², that is m³ per metre of depth) that has entered and left in dynamic stages.
    pub passed: [f64; 2],
}

clone_without_allocating! {
    Seepage { unknowns conducts apertures flooded surroundings balances passed }
}

impl Seepage {
    /// Water (m²/s) that enters and leaves now; none before a flow has been found.
    pub fn rates(&self) -> [f64; 2] {
        let sums = self.balances.last().map_or(&[][..], |balance| &balance.sums);
        [0, 1].map(|side| sums.iter().map(|sum| sum[side]).sum())
    }

    /// Lets time (s) pass.
    pub fn pass(&mut self, dt: f64) {
        let rates = self.rates();
        self.passed.iter_mut().zip(rates).for_each(|(passed, rate)| *passed += rate * dt);
    }
}

/// What the flow in a net follows in the course of a stage.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Surroundings {
    /// Level of the reservoir (m).
    pub level: f64,
    /// Unit weight of the water (N/m³).
    pub weight: f64,
    /// Level of each head (m).
    pub heads: Vec<f64>,
    /// Rate of each rain (m/s).
    pub rains: Vec<f64>,
    /// Whether each drain acts.
    pub drains: Vec<bool>,
}

clone_without_allocating! {
    Surroundings { level weight heads rains drains }
}

/// Water that went through a net of joints in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlowBalance {
    /// Stage.
    pub stage: u32,
    /// Water (m²/s) that enters and leaves at each head, at outcrops in rain, at each drain, from the reservoir and
    /// from the air, and rain that has not entered and runs off.
    pub sums: Vec<[f64; 3]>,
    /// Greatest imbalance of a node (m²/s).
    pub residual: f64,
    /// Height (m) of the highest outcrop from which water seeps; none where none does.
    pub seeps: Option<f64>,
}
