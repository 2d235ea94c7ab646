//! Saved states.

use std::ffi::c_void;

use crate::raw::{self, MISSING};
use crate::types::{FmuState, InstancePointer, Status, call};

/// The number of a saved state at a pointer to it; a NULL state has none.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned may be read.
unsafe fn number(state: *const FmuState) -> Option<Option<usize>> {
    // SAFETY: by the contract of this function.
    let state = unsafe { raw::slice(state, 1) }?.first()?;
    Some((!state.is_null()).then(|| state.addr()))
}

/// Ends a call that makes a saved state.
///
/// # Safety
/// The pointer may be written to.
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

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: InstancePointer, state: *mut FmuState) -> Status {
    call(instance, "fmi3GetFMUState", |instance| {
        // SAFETY: the importer gives a pointer that can be read and written.
        unsafe {
            match number(state) {
                Some(old) => give(state, instance.save_state(old)),
                None => instance.refuse_state(MISSING),
            }
        }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: InstancePointer, state: FmuState) -> Status {
    call(instance, "fmi3SetFMUState", |instance| instance.restore_state(state.addr()))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: InstancePointer, state: *mut FmuState) -> Status {
    call(instance, "fmi3FreeFMUState", |instance| {
        // SAFETY: the importer gives a pointer that can be read and written.
        unsafe {
            let Some(Some(old)) = number(state) else { return Status::Ok };
            let status = instance.free_state(old);
            if status == Status::Ok {
                raw::put(state, std::ptr::null_mut());
            }
            status
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: InstancePointer,
    state: FmuState,
    size: *mut usize,
) -> Status {
    call(instance, "fmi3SerializedFMUStateSize", |instance| {
        let length = match instance.serialize_state(state.addr()) {
            Ok(bytes) => bytes.len(),
            Err(status) => return status,
        };
        // SAFETY: the importer gives a pointer that can be written.
        if unsafe { raw::put(size, length) } { Status::Ok } else { instance.refuse_state(MISSING) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: InstancePointer,
    state: FmuState,
    out: *mut u8,
    size: usize,
) -> Status {
    call(instance, "fmi3SerializeFMUState", |instance| {
        let bytes = match instance.serialize_state(state.addr()) {
            Ok(bytes) => bytes,
            Err(status) => return status,
        };
        if bytes.len() != size {
            let reason = format!("the size is {size}, must be {}, that of the serialized state", bytes.len());
            return instance.refuse_state(&reason);
        }
        // SAFETY: the importer gives room for `size` bytes.
        match unsafe { raw::room(out, size) } {
            Some(out) => {
                raw::fill(out, bytes.iter().copied());
                Status::Ok
            }
            None => instance.refuse_state(MISSING),
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: InstancePointer,
    bytes: *const u8,
    size: usize,
    state: *mut FmuState,
) -> Status {
    call(instance, "fmi3DeserializeFMUState", |instance| {
        // SAFETY: the importer gives `size` bytes and a pointer that can be read and written.
        unsafe {
            match (raw::slice(bytes, size), number(state)) {
                (Some(bytes), Some(old)) => give(state, instance.deserialize_state(bytes, old)),
                _ => instance.refuse_state(MISSING),
            }
        }
    })
}
