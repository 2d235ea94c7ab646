//! Explicit numerical manifold method (ENMM) for jointed rock.
//!
//! Rooms, each importing only from those above it: [`geometry`], `cover`, `mechanics`, `contact`, `state`, `step`,
//! [`model`], [`cosimulation`]. `ARCHITECTURE.md` draws the graph; `docs/theory.md` numbers the equations that the code
//! cites. The crate `enmm-case` holds the case that a user writes. This crate reads and writes no files: `enmm-io`
//! reads cases, `enmm-run` runs them and writes results.
//!
//! # API boundary
//!
//! [`model`], [`cosimulation`] and [`geometry`] are the interface of the engine; `CHANGELOG.md` announces its changes.
//! The other rooms are public for the tests and tools of this repository alone. They are hidden from the documentation,
//! and they change without notice.
#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod contact;
pub mod cosimulation;
#[doc(hidden)]
pub mod cover;
pub mod geometry;
#[doc(hidden)]
pub mod mechanics;
pub mod model;
#[doc(hidden)]
pub mod state;
#[doc(hidden)]
pub mod step;

pub use state::bytes::engine_version;
