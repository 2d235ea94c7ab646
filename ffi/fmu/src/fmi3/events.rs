//! Event mode.

use enmm_fmi::instance::Instance;
use enmm_fmi::log::Status;
use enmm_fmi::phase::Call;

use super::types::{InstancePointer, call};
use enmm_fmi::raw::{self, MISSING};

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterEventMode(instance: InstancePointer) -> Status {
    call(instance, "fmi3EnterEventMode", Instance::enter_event_mode)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterStepMode(instance: InstancePointer) -> Status {
    call(instance, "fmi3EnterStepMode", Instance::enter_step_mode)
}

/// Nothing is left to update: inputs that are set in event mode hold at once.
///
/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    instance: InstancePointer,
    needs_update: *mut bool,
    terminate: *mut bool,
    nominals_changed: *mut bool,
    values_changed: *mut bool,
    next_event_defined: *mut bool,
    next_event: *mut f64,
) -> Status {
    call(instance, "fmi3UpdateDiscreteStates", |instance| {
        let status = instance.permits(Call::Event);
        if status != Status::Ok {
            return status;
        }
        let flags = [needs_update, terminate, nominals_changed, values_changed, next_event_defined];
        // SAFETY: the importer gives room for six values.
        let written = unsafe { flags.into_iter().all(|flag| raw::put(flag, false)) && raw::put(next_event, 0.0) };
        if written { Status::Ok } else { instance.refuse(MISSING) }
    })
}
