//! Water that flows in the joints: what the last static stage found.

use serde::{Deserialize, Serialize};

/// Flow in the net of joints of a model.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seepage {
    /// Unknown (m) of each node: the pressure head above 0, the filling of the film below.
    pub unknowns: Vec<f64>,
    /// Whether each piece of joint conducted.
    pub conducts: Vec<bool>,
    /// Apertures (m) at both nodes of each piece, 0 where it did not conduct: as the last static stage began, or as its
    /// openings have made them.
    pub apertures: Vec<[f64; 2]>,
    /// Whether each block has been dug out and water of the reservoir is in its place.
    pub flooded: Vec<bool>,
    /// Surroundings for which it was found.
    pub surroundings: Surroundings,
    /// Flow through the net in each stage that has found it, the last one that it has found.
    pub balances: Vec<FlowBalance>,
    /// Water (m², that is m³ per metre of depth) that has entered and left in dynamic stages.
    pub passed: [f64; 2],
    /// Time (s) of the flow so far, in static stages that give it one.
    pub time: f64,
    /// The last rounds in which openings make apertures, the oldest first; none in a stage whose apertures stay.
    pub rounds: Vec<Round>,
}

clone_without_allocating! {
    Seepage { unknowns conducts apertures flooded surroundings balances passed time rounds }
}

/// Apertures with which a flow was found, and how far from them openings were when the rock was at rest.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Logarithms of the apertures (m) at both nodes of each piece; 0 where it does not conduct.
    pub logs: Vec<[f64; 2]>,
    /// Those of the apertures that openings asked for, less these.
    pub asked: Vec<[f64; 2]>,
}

clone_without_allocating!(Round { logs asked });

/// How far openings and apertures of a stage have come to terms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rounds {
    /// Flows found with apertures of openings.
    pub count: u32,
    /// Greatest change of ln e that openings ask for in wet joints, when the rock was at rest last.
    pub asked: f64,
    /// The piece of joint that asks for it.
    pub piece: u32,
    /// Whether no further round follows.
    pub is_over: bool,
    /// Whether openings and apertures agree.
    pub agree: bool,
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
    /// Water of a stage whose flow has a time; `sums` are the means of its last step then.
    pub water: Option<StageWater>,
    /// Rounds of openings and flow, of a stage whose apertures follow openings.
    pub rounds: Option<Rounds>,
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
