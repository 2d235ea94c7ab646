//! Saved states.

use enmm_fmi::raw::states;

use super::types::{FmuState, InstancePointer, Status, call};

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: InstancePointer, state: *mut FmuState) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(instance, "fmi3GetFMUState", |instance| unsafe { states::save(instance, state) })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: InstancePointer, state: FmuState) -> Status {
    call(instance, "fmi3SetFMUState", |instance| instance.restore_state(state.addr()))
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: InstancePointer, state: *mut FmuState) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(instance, "fmi3FreeFMUState", |instance| unsafe { states::free(instance, state) })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: InstancePointer,
    state: FmuState,
    size: *mut usize,
) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(instance, "fmi3SerializedFMUStateSize", |instance| unsafe { states::size(instance, state, size) })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: InstancePointer,
    state: FmuState,
    out: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(instance, "fmi3SerializeFMUState", |instance| unsafe { states::serialize(instance, state, out, size) })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: InstancePointer,
    bytes: *const u8,
    size: usize,
    state: *mut FmuState,
) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(instance, "fmi3DeserializeFMUState", |instance| unsafe { states::deserialize(instance, bytes, size, state) })
}
