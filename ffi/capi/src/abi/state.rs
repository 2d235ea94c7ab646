//! Saved states.

use super::pointers;
use crate::safe::enter::{guard, with_model};
use crate::safe::state::STATES;
use crate::types::{enmm_model, enmm_state, enmm_status};

/// Saves all data that the model needs to continue from here with the same bits: motion, contacts, stage, time, events,
/// inputs.
///
/// `*out` gets the handle, which enmm_state_free frees, or NULL on failure. The state may outlive the
/// model.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_state_save(model: *mut enmm_model, out: *mut *mut enmm_state) -> enmm_status {
    // SAFETY: promised by the host. Without a model there is no state either; a NULL is reported below.
    let _ = unsafe { pointers::write_handle("out", out, 0) };
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host. A state that cannot be handed out is not made.
        unsafe {
            pointers::write_handle("out", out, 0)?;
            pointers::write_handle("out", out, model.save()?)
        }
    })
}

/// Returns the model to a saved state of its own or of another model of the same case. The state can be used again.
///
/// Errors: ENMM_WRONG_STATE for a state of another case, ENMM_DEAD_HANDLE; the model then stays as it is.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_state_restore(model: *mut enmm_model, state: *mut enmm_state) -> enmm_status {
    enmm_state_restore_with(model, state, 0)
}

/// Returns the model to a saved state in a way that `flags` choose: 0 as enmm_state_restore does, ENMM_KEEP_PARAMETERS
/// for a state of a model that may differ in values of parameters (see enmm_parameter_count), while this one keeps its
/// own.
///
/// Errors: as enmm_state_restore; ENMM_INVALID_ARGUMENT for other flags, or when the parameters have made the internal
/// step another one.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_state_restore_with(model: *mut enmm_model, state: *mut enmm_state, flags: u32) -> enmm_status {
    with_model(model.addr(), |model| model.restore_with(state.addr(), flags))
}

/// Frees a state. NULL does nothing.
///
/// Errors: ENMM_DEAD_HANDLE.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_state_free(state: *mut enmm_state) -> enmm_status {
    guard(|| if state.is_null() { Ok(()) } else { STATES.remove(state.addr()) })
}

/// Writes a state as bytes for a file or another process; they contain version, hash of the case and checksum.
///
/// `model` is a model of the same case as the state. `*written` gets the number of bytes. With `buffer` NULL and
/// `capacity` 0 the call returns only that number.
///
/// Errors: ENMM_BUFFER_TOO_SMALL, ENMM_WRONG_STATE for a state of another case, ENMM_DEAD_HANDLE, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_state_serialize(
    model: *mut enmm_model,
    state: *mut enmm_state,
    buffer: *mut u8,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        let copy = |bytes: &[u8]| unsafe { pointers::fill(bytes, buffer, capacity, written) };
        model.serialize(state.addr(), buffer.is_null(), copy)
    })
}

/// Makes a state from bytes that enmm_state_serialize wrote, in this process or another, or from those of a
/// `checkpoint.enmm` of `enmm run` on the same case.
///
/// `*out` gets the handle, which enmm_state_free frees, or NULL on failure.
///
/// Errors: ENMM_WRONG_STATE for bytes that are damaged, of another case or version, or with an invalid value (a number
/// that is not finite or out of range, an index or a length), which the message names; ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_state_deserialize(
    model: *mut enmm_model,
    bytes: *const u8,
    size: usize,
    out: *mut *mut enmm_state,
) -> enmm_status {
    // SAFETY: promised by the host.
    unsafe { enmm_state_deserialize_with(model, bytes, size, 0, out) }
}

/// Makes a state from bytes in a way that `flags` choose: 0 as enmm_state_deserialize does, ENMM_KEEP_PARAMETERS for
/// bytes of a model that may differ in values of parameters; the state has those of this model.
///
/// Errors: as enmm_state_deserialize and enmm_state_restore_with.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_state_deserialize_with(
    model: *mut enmm_model,
    bytes: *const u8,
    size: usize,
    flags: u32,
    out: *mut *mut enmm_state,
) -> enmm_status {
    // SAFETY: promised by the host. Without a model there is no state either; a NULL is reported below.
    let _ = unsafe { pointers::write_handle("out", out, 0) };
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        pointers::write_handle("out", out, 0)?;
        let bytes = pointers::slice("bytes", bytes, size)?;
        pointers::write_handle("out", out, model.deserialize_with(bytes, flags)?)
    })
}
