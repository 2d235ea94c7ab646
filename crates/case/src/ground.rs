//! Ground motion and boundaries for waves: base motion, quiet boundaries, free-field columns.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{Axes, Case, StageKind, TimeTable};

/// One direction of the plane.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Horizontal.
    #[default]
    X,
    /// Vertical.
    Y,
}

/// Quantity in the rows of a base motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BaseMotionKind {
    /// Acceleration (m/s²).
    #[default]
    Acceleration,
    /// Velocity (m/s).
    Velocity,
}

/// Motion of the base that carries the model; the model lives in the frame of the base, so that its rock feels the
/// opposite acceleration.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BaseMotion {
    /// Quantity in the rows.
    #[serde(default)]
    pub kind: BaseMotionKind,
    /// Direction.
    #[serde(default)]
    pub axis: Axis,
    /// Rows of time (s) since the start of the stage and value; linear between. Outside them the acceleration is zero:
    /// a velocity must start at 0 and keeps its last value. This or `file`.
    #[serde(default)]
    pub table: Option<TimeTable>,
    /// CSV file with time (s) and value in its first two columns, relative to the case file.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// Factor on the values, such as 9.81 for a record in g.
    #[serde(default = "one")]
    pub scale: f64,
    /// Dynamic stage at whose start the table begins; default: the first one. It acts in dynamic stages from there on.
    #[serde(default)]
    pub stage: Option<String>,
}

/// A boundary that lets waves leave (viscous, after Lysmer and Kuhlemeyer) and may send one in. In static stages it
/// holds like a fixity; in dynamic stages its static reactions stay as constant forces.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Quiet {
    /// The parts of the rock boundary on this segment (m).
    pub edge: [[f64; 2]; 2],
    /// Directions that it holds in static stages.
    #[serde(default)]
    pub axes: Axes,
    /// Direction and amplitude (m/s, global axes) of the incident wave's particle velocity.
    #[serde(default)]
    pub wave: Option<[f64; 2]>,
    /// Rows of time (s) since the start of the stage and factor on `wave`; linear between, zero outside. This or
    /// `file`.
    #[serde(default)]
    pub table: Option<TimeTable>,
    /// CSV file with time (s) and factor in its first two columns, relative to the case file.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// Factor on the values.
    #[serde(default = "one")]
    pub scale: f64,
    /// Dynamic stage at whose start the table begins; default: the first one. It acts in dynamic stages from there on.
    #[serde(default)]
    pub stage: Option<String>,
}

/// A column of rock beside a vertical side of the model that moves as the free field does; the side is coupled to it by
/// a quiet boundary. Its foot moves as the boundary below it: with the base, or as a quiet boundary with its wave.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FreeField {
    /// The vertical side (m).
    pub edge: [[f64; 2]; 2],
    /// Directions that the side holds in static stages.
    #[serde(default = "horizontal")]
    pub axes: Axes,
}

impl Case {
    /// The stage at whose start a ground motion begins: the named one, or the first dynamic one.
    pub fn motion_stage(&self, name: Option<&str>) -> Option<usize> {
        match name {
            Some(name) => self.stages.iter().position(|stage| stage.name == name),
            None => self.stages.iter().position(|stage| stage.kind == StageKind::Dynamic),
        }
    }

    /// Whether a ground motion acts in a stage, by its index.
    pub fn is_shaken(&self, stage: usize) -> bool {
        let motions = self.base_motions.iter().map(|motion| &motion.stage);
        let waves = self.quiets.iter().filter(|quiet| quiet.wave.is_some()).map(|quiet| &quiet.stage);
        let has_begun = |name: &Option<String>| self.motion_stage(name.as_deref()).is_some_and(|first| first <= stage);
        self.stages[stage].kind == StageKind::Dynamic && motions.chain(waves).any(has_begun)
    }
}

fn horizontal() -> Axes {
    Axes::X
}

fn one() -> f64 {
    1.0
}
