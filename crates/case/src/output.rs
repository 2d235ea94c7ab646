//! Monitors and outputs of a case.

use crate::Pictures;
use crate::keys::shared::PLACE;
use crate::keys::unit::SECOND;
use crate::keys::{Range, Rule, keys};

/// Intervals of outputs.
const INTERVAL: Rule = Range::above(0.0).to(1e12).of(SECOND).hint("leave it out for the default");

keys! {
    /// A material point whose motion goes into the history.
    pub struct Monitor {
        /// Name; heads the columns.
        pub name: String,
        /// Place in the reference configuration (m).
        pub point: [f64; 2] => PLACE,
    }
}

keys! {
    /// Files to write and their intervals.
    pub default struct Output {
        /// Simulated time between frames (s); default: a twentieth of the duration of a dynamic stage; in a static
        /// stage, two to four each time that its number of steps doubles.
        pub frame_interval: Option<f64> => INTERVAL,
        /// Simulated time between rows of the history (s); default: a five-hundredth of the duration of a dynamic
        /// stage, and at most 0.005 s where a ground motion shakes it; in a static stage, 32 to 64 each time that its
        /// number of steps doubles.
        pub history_interval: Option<f64> => INTERVAL,
        /// Simulated time between checkpoints (s); default: one at the end.
        pub checkpoint_interval: Option<f64> => INTERVAL,
        /// Whether to write VTU frames.
        pub frames: bool = true,
        /// Which pictures to draw: `true` for the usual ones (`model`, `deformed`, `history`, and at the end of each
        /// stage `displacement_contours`, `joints`, `mean_stress_contours`, `strength` of rock that can break, and
        /// `flow` of water in joints; `spectra` of ground motions), `false` for none, or a list of exactly those to
        /// draw.
        pub pictures: Pictures = Pictures::Usual(true),
    }
}
