//! Common parts of the FMI 2 and FMI 3 exports: one table of variables, the resource inside an FMU, how an FMU is
//! packed, and the safe instance behind the C entry points.
#![deny(unsafe_code)]

mod description;
pub mod description2;
pub mod description3;
pub mod handle;
pub mod instance;
pub mod library;
pub mod location;
pub mod log;
pub mod naming;
pub mod pack;
mod page;
pub mod phase;
mod picture;
pub mod platform;
#[allow(unsafe_code, reason = "it reads and writes through pointers of the importer")]
pub mod raw;
pub mod resource;
pub mod table;
mod terminals;
mod unit;
pub mod values;
mod xml;

pub use description::Facts;
