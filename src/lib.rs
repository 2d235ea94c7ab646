//! Explicit numerical manifold method (ENMM) for jointed rock.
//!
//! Rooms, each importing only from those above it: [`geometry`], `cover`, `mechanics`, `contact`, `state`, `step`,
//! [`model`], [`io`], [`cosimulation`]. `ARCHITECTURE.md` draws the graph; `docs/theory.md` numbers the equations that
//! the code cites.
#![forbid(unsafe_code)]

pub mod contact;
pub mod cosimulation;
pub mod cover;
pub mod geometry;
pub mod io;
pub mod mechanics;
pub mod model;
pub mod state;
pub mod step;
