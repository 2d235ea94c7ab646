//! Ensembles of a case: samples of its random values, the store of what was worked out of them, and what follows from
//! all of them. What is worked out of a sample is up to the caller.
//!
//! The Python package `enmm.ensemble` has its samples and keys from here, by `enmm draw`, and shares the store;
//! `docs/ensembles.md` describes them for both.
#![forbid(unsafe_code)]

mod draw;
mod driver;
mod identity;
mod normal;
mod philox;
mod statistics;
mod store;
mod variable;

pub use draw::{Samples, Value, draw, draw_from, medians};
pub use driver::{Lost, work};
pub use identity::{Given, Identity, sample_key};
pub use statistics::{Interval, beta, mean, quantile, spearman, standard_deviation, wilson};
pub use store::{Row, Store, StoreError};
pub use variable::{Distribution, Variable};
