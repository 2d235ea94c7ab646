//! Flow of water with a free surface in a network of joints, steady or in implicit steps of time.
//!
//! A [`Net`] has nodes with heights, and pipes between two nodes each. It stands for the joints of a section, one
//! metre deep: flows are in m²/s, which is m³/s per metre of depth, and conductances in m²/s per metre of head.
//!
//! Each node has one unknown `u` (m). Above 0 it is the pressure head of the water there. Below 0 there is no pressure,
//! and `1 + u/DELTA`, limited to 0 and 1, is the share of its capacity with which a pipe that leads down from there is
//! filled by the film that runs in it. So free surfaces, seepage faces, dry joints, perched water, rain and its run-off
//! are one system of equations, which is monotone and has one solution apart from stagnant pools.
//!
//! ```
//! use enmm_seepage::{Condition, Net, law};
//!
//! // A joint of 0.1 mm that drops by 5 m over 10 m, between a pool and the air, with a node halfway.
//! let net = Net::new(&[5.0, 2.5, 0.0], &[[0, 1], [1, 2]])?;
//! let conductance = [law::conductance(1e-4, 1e-4, 5.0, 9810.0, 1e-3); 2];
//! let conditions = [Condition::Held { head: 7.0 }, Condition::Free { source: 0.0 }, Condition::Air];
//! let flow = net.steady(&conductance, &conditions)?;
//! assert!((flow.u[1] - 1.0).abs() < 1e-12);
//! # Ok::<(), enmm_seepage::Failure>(())
//! ```
//!
//! Results are serial sums in a fixed order without fused operations: they have the same bits on any machine.

mod advance;
mod balance;
mod descent;
mod error;
pub mod law;
mod lu;
mod net;
mod newton;
mod pieces;
mod problem;
mod steady;

pub use error::{Failure, Refused, Unsolved};
pub use law::DELTA;
pub use net::{Condition, Flow, Net, Storage};
