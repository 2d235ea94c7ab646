//! Explicit numerical manifold method (ENMM) for jointed rock.
//!
//! Rooms, each importing only from those above it: [`geometry`], `cover`, `mechanics`, `contact`, `flow`, `state`,
//! `step`, `fracture`, `recut`, [`model`], [`cosimulation`]. `ARCHITECTURE.md` draws the graph; `docs/theory.md`
//! numbers the equations that the code cites. The crate `enmm-case` holds the case that a user writes. This crate
//! reads and writes no files: `enmm-io` reads cases, `enmm-run` runs them and writes results.
//!
//! # API boundary
//!
//! [`model`], [`cosimulation`] and [`geometry`] are the interface of the engine; `CHANGELOG.md` announces its changes.
//! Forces, velocities and other vectors are [`geometry::Vector`]s, points [`geometry::Point`]s; inputs take a pair
//! `[x, y]` of numbers as well. [`model::tables`] names the tables that a built model and its state hold. The other
//! rooms are private. The feature `internals` opens them for another integrator and for tests; they change without
//! notice.
#![forbid(unsafe_code)]
// Parts of the rooms serve the implicit integrator and tests alone.
#![cfg_attr(not(feature = "internals"), allow(dead_code, unused_imports))]

/// Copies a structure with its fields, into what another one has already allocated if that is given. A field that is
/// not named does not compile.
macro_rules! clone_without_allocating {
    ($type:ty { $($field:ident)* }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                let Self { $($field),* } = self;
                Self { $($field: $field.clone()),* }
            }

            fn clone_from(&mut self, other: &Self) {
                let Self { $($field),* } = other;
                $(self.$field.clone_from($field);)*
            }
        }
    };
}

mod contact;
pub mod cosimulation;
mod cover;
mod flow;
mod fracture;
pub mod geometry;
mod mechanics;
pub mod model;
mod monitor;
mod recut;
mod rock;
mod state;
mod step;

/// The rooms behind the interface, for another integrator and for tests.
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod internals {
    /// Contact of blocks.
    pub mod contact {
        pub use crate::contact::*;
    }
    /// Covers, elements and blocks.
    pub mod cover {
        pub use crate::cover::*;
    }
    /// Masses, stress, loads and motion.
    pub mod mechanics {
        pub use crate::mechanics::*;
    }
    /// The data of a simulation.
    pub mod state {
        pub use crate::state::*;
    }
    /// The stages of a step.
    pub mod step {
        pub use crate::step::*;
    }
}

pub use state::bytes::engine_version;
