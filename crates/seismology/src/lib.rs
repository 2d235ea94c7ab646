//! Measures of a ground motion: peaks, Arias intensity, significant duration, response spectrum, and the way of a rigid
//! block that it lets slide (Newmark).
//!
//! An [`Accelerogram`] is acceleration over time, straight between its points and 0 before and after them. All
//! measures are exact for such a motion, so that they do not hang on steps.
//!
//! ```
//! use enmm_seismology::Accelerogram;
//!
//! // 3 m/s² for half a second, on a block that begins to slide at 1 m/s².
//! let pulse = Accelerogram::new(vec![[0.0, 3.0], [0.5, 3.0]])?;
//! let way = 0.5 * 3.0 * (3.0 - 1.0) / 1.0 * 0.5 * 0.5;
//! assert!((pulse.sliding_block(1.0) - way).abs() < 1e-12);
//! # Ok::<(), enmm_seismology::Unusable>(())
//! ```
#![forbid(unsafe_code)]

mod accelerogram;
mod measures;
mod newmark;
mod spectrum;

pub use accelerogram::{Accelerogram, Unusable};
pub use measures::Measures;
pub use spectrum::{DAMPING, periods};
