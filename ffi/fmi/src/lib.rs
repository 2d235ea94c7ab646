//! What the FMI 2 and FMI 3 exports share: one table of variables, the resource inside an FMU, the safe instance behind
//! the C entry points.
#![forbid(unsafe_code)]

pub mod handle;
pub mod instance;
pub mod location;
pub mod log;
pub mod phase;
pub mod resource;
pub mod table;
pub mod values;
