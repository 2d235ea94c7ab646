//! Orientations of joints that were measured in the field: a table of dips and dip directions ([`Table`]), weights by
//! Terzaghi ([`Scanline`]), densities of poles ([`density`]), strikes ([`rosette`]), and sets with their means
//! ([`find_sets`], [`Fisher`]).
//!
//! Poles are axes: a pole and its opposite are the same plane. Directions are unit vectors east, north and down.
#![forbid(unsafe_code)]

mod axis;
mod density;
mod error;
mod fisher;
mod scanline;
mod sets;
mod table;

pub use axis::{Axis, plane_of, pole_of};
pub use density::{CIRCLE, density, rosette};
pub use error::FieldError;
pub use fisher::Fisher;
pub use scanline::{BLIND_DEG, Scanline};
pub use sets::{SETS_MAX, Sets, find_sets, given_sets};
pub use table::{Measurement, Table};
