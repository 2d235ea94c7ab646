//! Steps and their status.

use std::ffi::c_int;

use enmm_fmi::phase::{Call, Phase};

use super::types::{Boolean, Component, Integer, Real, Status, Text, call, with_handle};
use enmm_fmi::raw;

/// `fmi2DoStepStatus`, `fmi2LastSuccessfulTime`, `fmi2Terminated`.
const DO_STEP_STATUS: c_int = 0;
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(c: Component, t: Real, h: Real, _no_set_state_before_now: Boolean) -> Status {
    with_handle(c, |handle| handle.do_step("fmi2DoStep", (t, h), None).status)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(c: Component) -> Status {
    call(c, "fmi2CancelStep", |instance| instance.refuse("no step is ever pending (canRunAsynchronuously=false)"))
}

/// Answers a question for a status. One that does not apply is discarded, as the standard has it.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned may be written to.
unsafe fn tell<T>(
    c: Component,
    name: &str,
    value: *mut T,
    answer: impl FnOnce(&enmm_fmi::instance::Instance) -> Option<T>,
) -> Status {
    call(c, name, |instance| {
        let status = instance.permits(Call::Status);
        if status != Status::Ok {
            return status;
        }
        let Some(answer) = answer(instance) else { return Status::Discard };
        // SAFETY: by the contract of this function.
        if unsafe { raw::put(value, answer) } { Status::Ok } else { instance.refuse(raw::MISSING) }
    })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: Component, kind: c_int, value: *mut Status) -> Status {
    let answer = |phase| if phase == Phase::StepFailed { Status::Discard } else { Status::Ok };
    // SAFETY: the importer gives room for a value.
    unsafe { tell(c, "fmi2GetStatus", value, |i| (kind == DO_STEP_STATUS).then(|| answer(i.phase()))) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Component, kind: c_int, value: *mut Real) -> Status {
    // SAFETY: the importer gives room for a value.
    unsafe { tell(c, "fmi2GetRealStatus", value, |i| (kind == LAST_SUCCESSFUL_TIME).then(|| i.time())) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: Component, _kind: c_int, value: *mut Integer) -> Status {
    // SAFETY: the importer gives room for a value.
    unsafe { tell(c, "fmi2GetIntegerStatus", value, |_| None) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Component, kind: c_int, value: *mut Boolean) -> Status {
    // SAFETY: the importer gives room for a value.
    unsafe { tell(c, "fmi2GetBooleanStatus", value, |_| (kind == TERMINATED).then_some(0)) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(c: Component, _kind: c_int, value: *mut Text) -> Status {
    // SAFETY: the importer gives room for a value.
    unsafe { tell(c, "fmi2GetStringStatus", value, |_| None) }
}
