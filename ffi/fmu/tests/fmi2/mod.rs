//! FMI 2.

mod common;
mod fmu;
