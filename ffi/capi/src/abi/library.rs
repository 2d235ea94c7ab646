//! The library as a whole.

use libc::c_char;

use crate::safe::failure::last_message;
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
/// has failed, and valid until the next one fails on this thread or the thread ends.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_last_error() -> *const c_char {
    last_message()
}
