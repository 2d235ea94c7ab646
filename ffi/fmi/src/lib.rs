//! What the FMI 2 and FMI 3 exports share: one table of variables, the resource inside an FMU,
//! and how an FMU is packed.
#![forbid(unsafe_code)]

mod description;
pub mod description2;
pub mod description3;
pub mod library;
pub mod log_category;
pub mod pack;
mod page;
mod picture;
pub mod resource;
pub mod table;
mod terminals;
mod unit;
mod xml;

pub use description::Facts;
