//! The library as a whole.

use libc::c_char;

use crate::safe::failure::{last_message, status_name};
use crate::types::ENMM_ABI_VERSION;

/// Version of the library, such as "0.1.0". The text is never freed.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Version of the binary interface of the library; a program can use the library when this equals ENMM_ABI_VERSION of
/// the header it was compiled with.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_abi_version() -> u32 {
    ENMM_ABI_VERSION
}

/// Message of the last call that failed on the calling thread: fault, value, limit and remedy. It is empty when none
/// has failed.
///
/// The address is the same for all calls of a thread and valid until the thread ends; the next call that fails there
/// replaces the text. A message of more than 4095 bytes ends with "...".
#[unsafe(no_mangle)]
pub extern "C" fn enmm_last_error() -> *const c_char {
    last_message()
}

/// Name of a status, such as "ENMM_BUSY"; "unknown status" for a number that is none. The text is never freed.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_status_name(status: i32) -> *const c_char {
    status_name(status).as_ptr().cast()
}
