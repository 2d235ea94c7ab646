//! Getters and setters.

use enmm_fmi::phase::Call;
use enmm_fmi::table::Type;

use crate::types::{Boolean, Component, Integer, Real, Status, Text, ValueReference, call};
use enmm_fmi::raw::{self, MISSING};

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Real,
) -> Status {
    // SAFETY: the importer gives `n` references and room for `n` values.
    unsafe { get_as((c, "fmi2GetReal", Type::Real), (references, n), values, |number| number) }
}

/// Reads variables of a type; `of` makes a value of a number.
///
/// # Safety
/// The importer gives `n` references and room for `n` values.
unsafe fn get_as<T>(
    (c, name, kind): (Component, &str, Type),
    (references, n): (*const ValueReference, usize),
    values: *mut T,
    of: fn(f64) -> T,
) -> Status {
    call(c, name, |instance| {
        // SAFETY: by the contract of this function.
        match unsafe { (raw::slice(references, n), raw::room(values, n)) } {
            (Some(references), Some(values)) => {
                let status = instance.expects(Call::Get, references, kind, n);
                if status != Status::Ok {
                    return status;
                }
                let mut numbers = vec![0.0; n];
                let status = instance.get(references, kind, &mut numbers);
                if status == Status::Ok {
                    raw::fill(values, numbers.into_iter().map(of));
                }
                status
            }
            _ => instance.refuse(MISSING),
        }
    })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Integer,
) -> Status {
    // SAFETY: the importer gives `n` references and room for `n` values.
    unsafe { get_as((c, "fmi2GetInteger", Type::Integer), (references, n), values, |number| number as Integer) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Boolean,
) -> Status {
    // SAFETY: the importer gives `n` references and room for `n` values.
    unsafe { get_as((c, "fmi2GetBoolean", Type::Boolean), (references, n), values, |number| number as Boolean) }
}

/// There are no variables of type String.
fn no_strings(c: Component, name: &str, call_kind: Call, n: usize) -> Status {
    call(c, name, |instance| match n {
        0 => instance.permits(call_kind),
        _ => instance.refuse("no variable of this FMU is a String; use the function of its type"),
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetString(
    c: Component,
    _references: *const ValueReference,
    n: usize,
    _values: *mut Text,
) -> Status {
    no_strings(c, "fmi2GetString", Call::Get, n)
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Real,
) -> Status {
    call(c, "fmi2SetReal", |instance| {
        // SAFETY: the importer gives `n` references and `n` values.
        match unsafe { (raw::slice(references, n), raw::slice(values, n)) } {
            (Some(references), Some(values)) => instance.set(references, Type::Real, values),
            _ => instance.refuse(MISSING),
        }
    })
}

/// Sets variables whose values are whole numbers.
///
/// # Safety
/// The importer gives `n` references and `n` values.
unsafe fn set_whole(
    c: Component,
    name: &str,
    (references, n): (*const ValueReference, usize),
    values: *const Integer,
    kind: Type,
) -> Status {
    let number = |value: &Integer| match kind {
        Type::Boolean => f64::from(u8::from(*value != 0)),
        _ => f64::from(*value),
    };
    call(c, name, |instance| {
        // SAFETY: by the contract of this function.
        match unsafe { (raw::slice(references, n), raw::slice(values, n)) } {
            (Some(references), Some(values)) => {
                instance.set(references, kind, &values.iter().map(number).collect::<Vec<_>>())
            }
            _ => instance.refuse(MISSING),
        }
    })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Integer,
) -> Status {
    // SAFETY: the importer gives `n` references and `n` values.
    unsafe { set_whole(c, "fmi2SetInteger", (references, n), values, Type::Integer) }
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Boolean,
) -> Status {
    // SAFETY: the importer gives `n` references and `n` values.
    unsafe { set_whole(c, "fmi2SetBoolean", (references, n), values, Type::Boolean) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetString(
    c: Component,
    _references: *const ValueReference,
    n: usize,
    _values: *const Text,
) -> Status {
    no_strings(c, "fmi2SetString", Call::Set, n)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetDirectionalDerivative(
    c: Component,
    _unknowns: *const ValueReference,
    _n_unknowns: usize,
    _knowns: *const ValueReference,
    _n_knowns: usize,
    _seeds: *const Real,
    _values: *mut Real,
) -> Status {
    call(c, "fmi2GetDirectionalDerivative", |instance| {
        instance.refuse("this FMU has none (providesDirectionalDerivative=false)")
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    c: Component,
    _references: *const ValueReference,
    n: usize,
    _orders: *const Integer,
    _values: *const Real,
) -> Status {
    call(c, "fmi2SetRealInputDerivatives", |instance| match n {
        0 => instance.permits(Call::Set),
        _ => instance.refuse("this FMU takes none (canInterpolateInputs=false); set interpolate_inputs instead"),
    })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    call(c, "fmi2GetRealOutputDerivatives", |instance| {
        // SAFETY: the importer gives `n` references, `n` orders and room for `n` values.
        match unsafe { (raw::slice(references, n), raw::slice(orders, n), raw::room(values, n)) } {
            (Some(references), Some(orders), Some(values)) => {
                let status = instance.expects(Call::GetDerivative, references, Type::Real, n);
                if status != Status::Ok {
                    return status;
                }
                let mut numbers = vec![0.0; n];
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
