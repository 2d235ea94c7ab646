//! Records of ground motion: what their rows are, how a file is read, and what is made of it.

use crate::keys::unit::{NUMBER, SECOND};
use crate::keys::{Range, Rule, keys, words};

/// Standard gravity (m/s²), by which records in g are converted: exact by the 3rd CGPM (1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

words! {
    /// Quantity in the rows of a ground motion.
    #[derive(Default)]
    pub enum BaseMotionKind {
        /// Acceleration (m/s²).
        #[default]
        Acceleration = "acceleration",
        /// Velocity (m/s).
        Velocity = "velocity",
        /// Displacement (m), which becomes a velocity.
        Displacement = "displacement",
    }
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
}

words! {
    /// Part of the wave through a quiet boundary that a record shows.
    pub enum WaveMotion {
        /// The wave itself.
        Incident = "incident",
        /// The motion of a free surface of the same rock, which is twice the wave.
        Outcrop = "outcrop",
    }

    /// Correction of a record that does not end at rest: a polynomial is taken from its acceleration.
    pub enum Baseline {
        /// Nothing is taken.
        None = "none",
        /// A constant, by which the velocity ends at 0.
        Constant = "constant",
        /// A straight line, by which velocity and displacement end at 0.
        Linear = "linear",
    }

    /// Unit of the times of a record.
    pub enum TimeUnit {
        /// Seconds.
        Second = "s",
        /// Milliseconds.
        Millisecond = "ms",
    }
}

/// Columns and channels of a file.
const COLUMN: Rule = Range::from(1.0).to(1000.0).of(NUMBER).hint("the first one is 1");

keys! {
    /// How the file of a record is read, where it does not say so itself.
    pub default struct RecordReading {
        /// Unit of the values, such as `g`, `gal`, `cm/s2`, `mm/s2`, `cm/s` or `mm`; default: the one that the file
        /// names, else m/s², m/s or m. The file may name no other one.
        pub unit: Option<String>,
        /// Unit of the times; default: the one that the file names, else seconds.
        pub time_unit: Option<TimeUnit>,
        /// Time (s) between values, for a file without times.
        pub dt: Option<f64> => Range::above(0.0).to(1e6).of(SECOND).hint("0.005 to 0.02 s are usual"),
        /// Columns of time and value, or with `dt` of the value alone, counted from 1; default: the first two.
        pub columns: Option<Vec<usize>> => COLUMN,
        /// Channel of a file with more than one, counted from 1.
        pub channel: Option<usize> => COLUMN,
    }
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
