//! Parameters of the case by name.

use engine::cosimulation::Parameter;
use libc::c_char;

use super::pointers;
use crate::safe::enter::with_model;
use crate::types::{enmm_model, enmm_status};

/// Returns the number of parameters: properties of the case that have a name and can be set. It never changes.
///
/// Names are such as "joint_law.weak.friction", "rock.granite.young", "damping", "water.density" and
/// "bolt.anchor.active". Values are in SI units, angles in radians. enmm_parameter_range returns which of them may
/// change after the start.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_parameter_count(model: *mut enmm_model, count: *mut usize) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("count", count, model.inner.parameters().len()) })
}

/// Returns the index of the parameter of this name.
///
/// Errors: ENMM_NOT_FOUND, with the names that there are; ENMM_INVALID_ARGUMENT for a text that is not UTF-8,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_find_parameter(
    model: *mut enmm_model,
    name: *const c_char,
    parameter: *mut u32,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe {
            let found = model.find_parameter(pointers::text("name", name)?)?;
            pointers::write("parameter", parameter, found)
        }
    })
}

/// Writes the name of a parameter in UTF-8.
///
/// `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
/// that number.
///
/// Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_parameter_name(
    model: *mut enmm_model,
    parameter: u32,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    unsafe { write_text(model, parameter, |parameter| &parameter.name, (out, capacity, written)) }
}

/// Writes the SI unit of a parameter, such as "Pa" or "rad"; an empty text for a number without one.
///
/// Buffer and errors as enmm_parameter_name.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_parameter_unit(
    model: *mut enmm_model,
    parameter: u32,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    unsafe { write_text(model, parameter, |parameter| parameter.unit, (out, capacity, written)) }
}

/// Writes what a parameter means, in words.
///
/// Buffer and errors as enmm_parameter_name.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_parameter_description(
    model: *mut enmm_model,
    parameter: u32,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    unsafe { write_text(model, parameter, |parameter| &parameter.description, (out, capacity, written)) }
}

/// Writes a text of a parameter into a buffer: place, capacity, number of bytes written.
///
/// # Safety
/// As [`pointers::fill_text`].
unsafe fn write_text(
    model: *mut enmm_model,
    parameter: u32,
    text: fn(&Parameter) -> &str,
    (out, capacity, written): (*mut c_char, usize, *mut usize),
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the caller.
        unsafe { pointers::fill_text(text(model.parameter(parameter)?), out, capacity, written) }
    })
}

/// Returns the least and the greatest value of a parameter, and whether it is tunable: 1 for one that may change at any
/// time, 0 for one that is fixed after the start. Pointers may be NULL where the value is of no interest.
///
/// Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_parameter_range(
    model: *mut enmm_model,
    parameter: u32,
    low: *mut f64,
    high: *mut f64,
    tunable: *mut i32,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let own = model.parameter(parameter)?;
        // SAFETY: promised by the host.
        unsafe {
            pointers::write_if_wanted(low, own.low)?;
            pointers::write_if_wanted(high, own.high)?;
            pointers::write_if_wanted(tunable, i32::from(own.is_tunable))
        }
    })
}

/// Returns the value of a parameter now. Strengths are those at time 0 until then, and after it those that hold.
///
/// Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_parameter(model: *mut enmm_model, parameter: u32, value: *mut f64) -> enmm_status {
    with_model(model.addr(), |model| {
        let own = model.parameter_value(parameter)?;
        // SAFETY: promised by the host.
        unsafe { pointers::write("value", value, own) }
    })
}

/// Sets a parameter.
///
/// Before the start the model is rebuilt with the value, and inputs stay; the initial equilibrium is then that of
/// the value. After the start a tunable parameter acts from the next step on, until a stage of the case changes it.
/// Values are part of saved states. Friction angle and cohesion are peak and residual ones alike. A bolt that is made
/// active is installed at its length of now with its pretension.
///
/// Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, a value out of its range, or one that is fixed
/// after the start; ENMM_INVALID_CASE when no model can be built with the value. Nothing has changed then.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_parameter(model: *mut enmm_model, parameter: u32, value: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_parameter(parameter as usize, value)?))
}

/// Sets `n` parameters at once: all, or none when one value is refused. Before the start they cost one build.
///
/// Errors: as enmm_set_parameter, for the first one that is refused; ENMM_NULL_ARGUMENT when `n` is not 0.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_set_parameters(
    model: *mut enmm_model,
    parameters: *const u32,
    n: usize,
    values: *const f64,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe {
            let parameters = pointers::slice("parameters", parameters, n)?;
            model.set_parameters(parameters, pointers::slice("values", values, n)?)
        }
    })
}
