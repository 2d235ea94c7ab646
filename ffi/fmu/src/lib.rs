//! Entry points of FMUs over `enmm_fmi`: one library serves FMI 2 and FMI 3, whose functions have other names.
#![allow(non_snake_case, reason = "names of the standards")]
#![allow(missing_docs, reason = "the standards document their functions and contracts")]

pub mod fmi2;
pub mod fmi3;
