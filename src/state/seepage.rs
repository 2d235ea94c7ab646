//! Water that flows in the joints: what the last static stage found.

use serde::{Deserialize, Serialize};

/// Flow in the net of joints of a model.
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
    /// Time (s) of the flow so far, in stages that give it one.
    pub time: f64,
}

clone_without_allocating! {
    Seepage { unknowns conducts flooded balances time }
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
    /// Water of a stage whose flow has a time; `sums` are the means of its last step then.
    pub water: Option<StageWater>,
}

/// Water of a stage whose flow has a time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageWater {
    /// Time (s).
    pub time: f64,
    /// Water (m²) that entered and left at each inlet in this time, and rain that ran off.
    pub sums: Vec<[f64; 3]>,
    /// Water (m²) that the joints hold more at its end than at its start.
    pub stored: f64,
    /// Water (m²/s) that came out of the joints in the last step; negative: they filled.
    pub drains: f64,
}

impl StageWater {
    /// Water (m²) that entered and left at all inlets together, and rain that ran off.
    pub fn totals(&self) -> [f64; 3] {
        self.sums.iter().fold([0.0; 3], |sum, of| [0, 1, 2].map(|k| sum[k] + of[k]))
    }

    /// Water (m²) that entered and neither left nor is in the joints: rounding.
    pub fn residual(&self) -> f64 {
        let [entered, left, _] = self.totals();
        entered - left - self.stored
    }
}
