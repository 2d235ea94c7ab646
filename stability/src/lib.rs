//! Factors of safety of slopes: by strength reduction, which lets the model move, and by limit analysis.
#![forbid(unsafe_code)]

pub mod limit_analysis;
pub mod strength_reduction;
