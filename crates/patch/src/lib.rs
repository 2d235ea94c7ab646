//! Contact of faces by a potential: stiffness times penetration, integrated over the overlap of two bodies.
//!
//! The energy of two bodies that overlap is half the sum over both of them of the stiffness times the depth under the
//! surface of the one, integrated over the part of the other one that is in it. Each face owns a [`Cell`], the points
//! that lie less deep under it than under others, and the force of what lies there is along its normal and through
//! the centroid: exactly the gradient of the energy. Two [`Row`]s carry it, as springs of a contact law. A corner has a
//! spring besides ([`corner`]), since an area alone is soft where load is concentrated, and a face that a third body
//! covers is no way out ([`cover`]).
//!
//! ```
//! use enmm_patch::{Body, Contacts, Hardening, Outline, Rule, Vector};
//!
//! // A block of 1 m that lies 1 mm deep in a floor: the energy of faces is half the square of the depth, over 1 m.
//! let rule = Rule { corner: 0.0, ..Rule::default() };
//! let block = |[x0, y0]: [f64; 2], [x1, y1]: [f64; 2], is_held| {
//!     let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| Vector::new(x, y));
//!     Body::new(Outline::new(corners.to_vec()), is_held, &rule)
//! };
//! let bodies = [block([-5.0, -2.0], [5.0, 0.0], true), block([0.0, -0.001], [1.0, 0.999], false)];
//! let mut contacts = Contacts::default();
//! contacts.find(&bodies, &rule, Hardening::NONE);
//! assert!((contacts.energy - 0.5e-6).abs() < 1e-9);
//! let force: f64 = contacts.rows.iter().map(|row| row.weight * row.closure).sum();
//! assert!((force - 0.001).abs() < 2e-6);
//! ```
//!
//! It knows no time, no masses and no joint law beyond a stiffness that hardens. The engine does not use it yet: see
//! `docs/notes/faces.md`.

mod body;
pub mod cell;
pub mod chain;
mod clip;
mod contacts;
pub mod corner;
pub mod cover;
mod hardening;
pub mod history;
pub mod interval;
mod outline;
mod rule;
mod vector;

pub use body::Body;
pub use cell::{Band, Bound, Cell};
pub use contacts::{Contacts, Part, Row};
pub use cover::{Cover, Covers};
pub use hardening::Hardening;
pub use history::{History, Kept, Key};
pub use interval::{Bearing, Patch, Piece};
pub use outline::{Face, Outline};
pub use rule::Rule;
pub use vector::Vector;
