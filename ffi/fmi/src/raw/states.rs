//! Saved states behind pointers. A state is a number in the form of a pointer and is never followed.
//!
//! The safety contract of all functions: a pointer that is neither NULL nor misaligned may be read and written, for as
//! many values as the size beside it tells.

use std::ffi::c_void;

use crate::instance::Instance;
use crate::log::Status;

use crate::raw::{self, MISSING};

/// A saved state as the importer holds it.
pub type FmuState = *mut c_void;

/// Saves the state of an instance, over an older one if there is one.
///
/// # Safety
/// See the top of this file.
pub unsafe fn save(instance: &mut Instance, state: *mut FmuState) -> Status {
    // SAFETY: by the contract of this function.
    unsafe {
        match number(state) {
            Some(old) => give(state, instance.save_state(old)),
            None => instance.refuse_state(MISSING),
        }
    }
}

/// Frees a state; the importer's pointer becomes NULL. Nothing is to be done for a NULL.
///
/// # Safety
/// See the top of this file.
pub unsafe fn free(instance: &mut Instance, state: *mut FmuState) -> Status {
    // SAFETY: by the contract of this function.
    unsafe {
        let Some(Some(old)) = number(state) else { return Status::Ok };
        let status = instance.free_state(old);
        if status == Status::Ok {
            raw::put(state, std::ptr::null_mut());
        }
        status
    }
}

/// Tells how many bytes a state has.
///
/// # Safety
/// See the top of this file.
pub unsafe fn size(instance: &mut Instance, state: FmuState, size: *mut usize) -> Status {
    let length = match instance.serialize_state(state.addr()) {
        Ok(bytes) => bytes.len(),
        Err(status) => return status,
    };
    // SAFETY: by the contract of this function.
    if unsafe { raw::put(size, length) } { Status::Ok } else { instance.refuse_state(MISSING) }
}

/// Writes the bytes of a state to room for exactly so many.
///
/// # Safety
/// See the top of this file.
pub unsafe fn serialize(instance: &mut Instance, state: FmuState, out: *mut u8, size: usize) -> Status {
    let bytes = match instance.serialize_state(state.addr()) {
        Ok(bytes) => bytes,
        Err(status) => return status,
    };
    if bytes.len() != size {
        let reason = format!("the size is {size}, must be {}, that of the serialized state", bytes.len());
        return instance.refuse_state(&reason);
    }
    // SAFETY: by the contract of this function.
    match unsafe { raw::room(out, size) } {
        Some(out) => {
            raw::fill(out, bytes.iter().copied());
            Status::Ok
        }
        None => instance.refuse_state(MISSING),
    }
}

/// Makes a state of bytes, over an older one if there is one.
///
/// # Safety
/// See the top of this file.
pub unsafe fn deserialize(instance: &mut Instance, bytes: *const u8, size: usize, state: *mut FmuState) -> Status {
    // SAFETY: by the contract of this function.
    unsafe {
        match (raw::slice(bytes, size), number(state)) {
            (Some(bytes), Some(old)) => give(state, instance.deserialize_state(bytes, old)),
            _ => instance.refuse_state(MISSING),
        }
    }
}

/// The number of a saved state at a pointer to it; a NULL state has none.
///
/// # Safety
/// See the top of this file.
unsafe fn number(state: *const FmuState) -> Option<Option<usize>> {
    // SAFETY: by the contract of this function.
    let state = unsafe { raw::slice(state, 1) }?.first()?;
    Some((!state.is_null()).then(|| state.addr()))
}

/// Ends a call that makes a saved state.
///
/// # Safety
/// See the top of this file.
unsafe fn give(state: *mut FmuState, made: Result<usize, Status>) -> Status {
    match made {
        Ok(number) => {
            let pointer: *mut c_void = std::ptr::without_provenance_mut(number);
            // SAFETY: by the contract of this function.
            if unsafe { raw::put(state, pointer) } { Status::Ok } else { Status::Error }
        }
        Err(status) => status,
    }
}
