//! Hosts that `enmm-fuzz` and `enmm-overhead` share: the C ABI, and FMUs of both versions.

// The files of the C ABI: its library is called `enmm` as the engine is, and so cannot be a Rust library as well.
#[path = "../../../ffi/capi/src/abi/mod.rs"]
#[allow(missing_docs)]
pub mod abi;
#[path = "../../../ffi/capi/src/growing.rs"]
#[macro_use]
pub mod growing;
pub mod buffer;
#[allow(clippy::not_unsafe_ptr_arg_deref, reason = "a saved state is a number in the form of a pointer")]
pub mod fmu;
#[path = "../../../ffi/capi/src/layout.rs"]
pub mod layout;
#[path = "../../../ffi/capi/src/numbers.rs"]
#[allow(non_camel_case_types)]
pub mod numbers;
#[path = "../../../ffi/capi/src/safe/mod.rs"]
pub mod safe;
#[path = "../../../ffi/capi/src/types.rs"]
#[allow(non_camel_case_types)]
pub mod types;
