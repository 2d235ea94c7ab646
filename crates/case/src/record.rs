//! Records of ground motion: what their rows are, how a file is read, and what is made of it.

use serde::{Deserialize, Serialize};

/// Standard gravity (m/s²), by which records in g are converted: exact by the 3rd CGPM (1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Quantity in the rows of a ground motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BaseMotionKind {
    /// Acceleration (m/s²).
    #[default]
    Acceleration,
    /// Velocity (m/s).
    Velocity,
    /// Displacement (m), which becomes a velocity.
    Displacement,
}

impl BaseMotionKind {
    /// Its unit in a case.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Acceleration => "m/s²",
            Self::Velocity => "m/s",
            Self::Displacement => "m",
        }
    }

    /// Its name, which is also that of the keys that name a file of it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::Velocity => "velocity",
            Self::Displacement => "displacement",
        }
    }
}

/// Part of the wave through a quiet boundary that a record shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum WaveMotion {
    /// The wave itself.
    Incident,
    /// The motion of a free surface of the same rock, which is twice the wave.
    Outcrop,
}

/// Correction of a record that does not end at rest: a polynomial is taken from its acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// Nothing is taken.
    None,
    /// A constant, by which the velocity ends at 0.
    Constant,
    /// A straight line, by which velocity and displacement end at 0.
    Linear,
}

/// Unit of the times of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum TimeUnit {
    /// Seconds.
    #[serde(rename = "s")]
    Second,
    /// Milliseconds.
    #[serde(rename = "ms")]
    Millisecond,
}

/// How the file of a record is read, where it does not say so itself.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordReading {
    /// Unit of the values, such as `g`, `gal`, `cm/s2`, `mm/s2`, `cm/s` or `mm`; default: the one that the file names,
    /// else m/s², m/s or m. The file may name no other one.
    #[serde(default)]
    pub unit: Option<String>,
    /// Unit of the times; default: the one that the file names, else seconds.
    #[serde(default)]
    pub time_unit: Option<TimeUnit>,
    /// Time (s) between values, for a file without times.
    #[serde(default)]
    pub dt: Option<f64>,
    /// Columns of time and value, or with `dt` of the value alone, counted from 1; default: the first two.
    #[serde(default)]
    pub columns: Option<Vec<usize>>,
    /// Channel of a file with more than one, counted from 1.
    #[serde(default)]
    pub channel: Option<usize>,
}

/// Where the rows of a ground motion come from, and what has been made of them: for those who show a case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordOrigin {
    /// The file of the rows; none where the case has them.
    pub file: Option<String>,
    /// Its format, and what of it was read.
    pub format: String,
    /// Unit of the values in the file, and who says so: `in g as its head says`.
    pub unit: String,
    /// Whether file or case name the unit of the times.
    pub time_is_stated: bool,
    /// Quantity and largest magnitude of the rows before they were converted; none where they stand as they were.
    pub read: Option<(BaseMotionKind, f64)>,
    /// Correction, and the final velocity and displacement without it.
    pub corrected: Option<(Baseline, [f64; 2])>,
    /// Whether the rows were halved, as those of an outcrop.
    pub halved: bool,
    /// Doubts of the reader.
    pub warnings: Vec<String>,
}
