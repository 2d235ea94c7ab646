//! What the FMI 2 and FMI 3 exports share: one table of variables, the resource inside an FMU.
#![forbid(unsafe_code)]

pub mod resource;
pub mod table;
