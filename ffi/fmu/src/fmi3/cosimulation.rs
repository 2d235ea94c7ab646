//! Steps.

use enmm_fmi::instance::Update;
use enmm_fmi::log::Status;
use enmm_fmi::phase::Call;
use enmm_fmi::table::Type;

use super::types::{Importer, InstancePointer, ValueReference, call, with_handle};
use enmm_fmi::raw::{self, MISSING};

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: InstancePointer,
    t: f64,
    h: f64,
    _no_set_state_before_now: bool,
    event_handling_needed: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    last_successful_time: *mut f64,
) -> Status {
    with_handle(instance, |handle| {
        let flags = [event_handling_needed, terminate, early_return];
        if !(flags.into_iter().all(raw::is_place) && raw::is_place(last_successful_time)) {
            return handle.call("fmi3DoStep", |instance| instance.refuse(MISSING));
        }
        let mut update = |update| intermediate_update(handle.host(), update);
        let wants_updates = handle.host().intermediate_update.is_some();
        let update: Option<&mut dyn FnMut(Update) -> Option<f64>> =
            if wants_updates { Some(&mut update) } else { None };
        let ended = handle.do_step("fmi3DoStep", (t, h), update);
        // SAFETY: the importer gives room for four values.
        let written = unsafe {
            raw::put(event_handling_needed, false)
                && raw::put(terminate, false)
                && raw::put(early_return, ended.early)
                && raw::put(last_successful_time, ended.time)
        };
        if written { ended.status } else { Status::Error }
    })
}

/// Reports the progress of the model to the importer; returns the time of an early return if it wants one.
fn intermediate_update(importer: &Importer, update: Update) -> Option<f64> {
    let callback = importer.intermediate_update?;
    let (mut wanted, mut time) = (0_u8, update.time);
    let can_return = update.can_return_early;
    // SAFETY: the importer gave this function for this use; a C `bool` is a byte.
    unsafe {
        let environment = importer.environment();
        callback(environment, update.time, false, true, true, can_return, (&raw mut wanted).cast(), &raw mut time);
    }
    (wanted != 0).then_some(if time.is_finite() { time } else { update.time })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    orders: *const i32,
    values: *mut f64,
    n_values: usize,
) -> Status {
    call(instance, "fmi3GetOutputDerivatives", |instance| {
        // SAFETY: the importer gives `n` references, `n` orders and room for `n_values` values.
        match unsafe { (raw::slice(references, n), raw::slice(orders, n), raw::room(values, n_values)) } {
            (Some(references), Some(orders), Some(values)) => {
                let status = instance.expects(Call::GetDerivative, references, Type::Real, n_values);
                if status != Status::Ok {
                    return status;
                }
                let mut numbers = vec![0.0; n_values];
                let status = instance.get_derivatives(references, orders, &mut numbers);
                if status == Status::Ok {
                    raw::fill(values, numbers);
                }
                status
            }
            _ => instance.refuse(MISSING),
        }
    })
}
