//! Names and monitors.

use libc::c_char;

use super::pointers;
use crate::numbers::{enmm_inlet_state, enmm_joint_monitor_state, enmm_monitor_state, enmm_monitor_stress};
use crate::safe::enter::with_model;
use crate::types::{enmm_model, enmm_status};

/// Returns the number of things of a kind, a value of enmm_name_kind. It never changes.
///
/// Errors: ENMM_INVALID_ARGUMENT for another number, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_name_count(model: *mut enmm_model, kind: i32, count: *mut usize) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("count", count, model.name_count(kind)?) })
}

/// Writes the name of a thing by its kind, a value of enmm_name_kind, and its number, from 0, in UTF-8.
///
/// Things without a name in the case get one: `joint[2]` is a joint of the case by its place there, "bedding trace 4"
/// (or `joint_set[1] trace 4`) a trace of a joint set, "rock bridge 7" a rock bridge, "trace 9" any other joint trace,
/// which a region of another law has parted or which surrounds an island, and "block 3" a block. `*written` gets the
/// number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only that number.
///
/// Errors: ENMM_INVALID_ARGUMENT for a kind or a number that does not exist, ENMM_BUFFER_TOO_SMALL,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_name(
    model: *mut enmm_model,
    kind: i32,
    index: u32,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_text(&model.name(kind, index)?, out, capacity, written) })
}

/// Returns the number of the thing of a kind, a value of enmm_name_kind, that has a name: the first one of several.
///
/// Errors: ENMM_NOT_FOUND, ENMM_INVALID_ARGUMENT for another kind, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_find_name(
    model: *mut enmm_model,
    kind: i32,
    name: *const c_char,
    index: *mut u32,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        let found = model.find_name(kind, pointers::text("name", name)?)?;
        pointers::write("index", index, found)
    })
}

/// Writes the water that enters and leaves joints at a head, in rain or at a drain: `kind` is ENMM_NAME_HEAD,
/// ENMM_NAME_RAIN or ENMM_NAME_DRAIN, `index` its place in the case. It is that of the flow that was found last.
/// `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for another kind, a place that does not exist or a struct_size that no version had,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_inlet_state(
    model: *mut enmm_model,
    kind: i32,
    index: u32,
    out: *mut enmm_inlet_state,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.inlet_state(kind, index)?, out) })
}

/// Writes the state of a monitor, by its place among the `[[monitor]]`s of the case. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or a struct_size that no version had,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_monitor_state(
    model: *mut enmm_model,
    monitor: u32,
    out: *mut enmm_monitor_state,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.monitor_state(monitor)?, out) })
}

/// Writes the stress at a monitor with `stress = true`, by its place among the `[[monitor]]`s of the case; NaN where
/// the rock has been excavated. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or reads no stress, or a struct_size that no version
/// had, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_monitor_stress(
    model: *mut enmm_model,
    monitor: u32,
    out: *mut enmm_monitor_stress,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.monitor_stress(monitor)?, out) })
}

/// Writes the state of a monitor of a joint, by its place among the `[[joint_monitor]]`s of the case; NaN where a side
/// of the joint has been excavated. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or a struct_size that no version had,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_joint_monitor_state(
    model: *mut enmm_model,
    monitor: u32,
    out: *mut enmm_joint_monitor_state,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.joint_monitor_state(monitor)?, out) })
}
