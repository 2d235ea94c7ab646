//! Getters and setters.

use enmm_fmi::phase::Call;
use enmm_fmi::table::Type;

use super::types::{Boolean, Component, Integer, Real, Status, Text, ValueReference, call};
use enmm_fmi::raw::{self, MISSING};

/// Getters and setters of a type: its values, those as bytes or numbers that any bits may be, its kind, and how a value
/// becomes a number and a number a value.
macro_rules! accessors {
    ($($get:ident $set:ident: $value:ty as $plain:ty, $kind:ident, $of:expr, $number:expr;)*) => {$(
        /// # Safety
        /// Pointers are as FMI 2 states.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: Component,
            references: *const ValueReference,
            n: usize,
            values: *mut $value,
        ) -> Status {
            call(instance, stringify!($get), |instance| {
                let room = (values.cast::<$plain>(), n);
                // SAFETY: the importer gives `n` references and room for `n` values.
                unsafe { raw::get(instance, Type::$kind, (references, n), room, $of) }
            })
        }

        /// # Safety
        /// Pointers are as FMI 2 states.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: Component,
            references: *const ValueReference,
            n: usize,
            values: *const $value,
        ) -> Status {
            call(instance, stringify!($set), |instance| {
                let values = (values.cast::<$plain>(), n);
                // SAFETY: the importer gives `n` references and `n` values.
                unsafe { raw::set(instance, Type::$kind, (references, n), values, $number) }
            })
        }
    )*};
}

accessors! {
    fmi2GetReal fmi2SetReal: Real as Real, Real, |number| number, |value| value;
    fmi2GetInteger fmi2SetInteger: Integer as Integer, Integer, |number| number as Integer, f64::from;
    fmi2GetBoolean fmi2SetBoolean: Boolean as Boolean, Boolean,
        |number| number as Boolean, |value| f64::from(u8::from(value != 0));
}

/// The texts belong to the instance and stay until the next call of this function.
///
/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Text,
) -> Status {
    // SAFETY: the importer gives `n` references and room for `n` values.
    call(c, "fmi2GetString", |instance| unsafe { raw::get_texts(instance, (references, n), (values, n)) })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Text,
) -> Status {
    // SAFETY: the importer gives `n` references and `n` values.
    call(c, "fmi2SetString", |instance| unsafe { raw::set_texts(instance, (references, n), (values, n)) })
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

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    call(c, "fmi2SetRealInputDerivatives", |instance| {
        // SAFETY: the importer gives `n` references, orders and values.
        match unsafe { (raw::slice(references, n), raw::slice(orders, n), raw::slice(values, n)) } {
            (Some(references), Some(orders), Some(rates)) => instance.set_derivatives(references, orders, rates),
            _ => instance.refuse(MISSING),
        }
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
