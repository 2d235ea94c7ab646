//! Getters and setters. Variables are of type Float64, Int32, Boolean, String and Binary; calls of other types must be
//! empty.

use enmm_fmi::phase::Call;
use enmm_fmi::table::Type;

use super::types::{Binary, InstancePointer, Status, Text, ValueReference, call};
use enmm_fmi::raw::{self, MISSING};

/// Getters and setters of a type: its values, those as bytes or numbers that any bits may be, its kind, and how a value
/// becomes a number and a number a value.
macro_rules! accessors {
    ($($get:ident $set:ident: $value:ty as $plain:ty, $kind:ident, $of:expr, $number:expr;)*) => {$(
        /// # Safety
        /// Pointers are as FMI 3 states.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: InstancePointer,
            references: *const ValueReference,
            n: usize,
            values: *mut $value,
            n_values: usize,
        ) -> Status {
            call(instance, stringify!($get), |instance| {
                let room = (values.cast::<$plain>(), n_values);
                // SAFETY: the importer gives `n` references and room for `n_values` values.
                unsafe { raw::get(instance, Type::$kind, (references, n), room, $of) }
            })
        }

        /// # Safety
        /// Pointers are as FMI 3 states.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: InstancePointer,
            references: *const ValueReference,
            n: usize,
            values: *const $value,
            n_values: usize,
        ) -> Status {
            call(instance, stringify!($set), |instance| {
                let values = (values.cast::<$plain>(), n_values);
                // SAFETY: the importer gives `n` references and `n_values` values.
                unsafe { raw::set(instance, Type::$kind, (references, n), values, $number) }
            })
        }
    )*};
}

accessors! {
    fmi3GetFloat64 fmi3SetFloat64: f64 as f64, Real, |number| number, |value| value;
    fmi3GetInt32 fmi3SetInt32: i32 as i32, Integer, |number| number as i32, f64::from;
    // A byte of the importer need not be a `bool` of Rust.
    fmi3GetBoolean fmi3SetBoolean: bool as u8, Boolean, |number| u8::from(number != 0.0), |byte| f64::from(byte.min(1));
}

/// The texts belong to the instance and stay until the next call of this function.
///
/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *mut Text,
    n_values: usize,
) -> Status {
    call(instance, "fmi3GetString", |instance| {
        // SAFETY: the importer gives `n` references and room for `n_values` values.
        unsafe { raw::get_texts(instance, (references, n), (values, n_values)) }
    })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *const Text,
    n_values: usize,
) -> Status {
    call(instance, "fmi3SetString", |instance| {
        // SAFETY: the importer gives `n` references and `n_values` values.
        unsafe { raw::set_texts(instance, (references, n), (values, n_values)) }
    })
}

/// The bytes belong to the instance and stay until the next call of this function.
/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    sizes: *mut usize,
    values: *mut Binary,
    n_values: usize,
) -> Status {
    call(instance, "fmi3GetBinary", |instance| {
        // SAFETY: the importer gives `n` references and room for `n_values` sizes and pointers.
        let room = unsafe { (raw::slice(references, n), raw::room(sizes, n), raw::room(values, n_values)) };
        let (Some(references), Some(sizes), Some(values)) = room else { return instance.refuse(MISSING) };
        if n != n_values {
            return instance.refuse("the number of values differs from that of the references; no Binary is an array");
        }
        if n == 0 {
            return instance.permits(Call::Get);
        }
        match instance.get_binary(references) {
            Ok(bytes) => {
                raw::fill(sizes, std::iter::repeat(bytes.len()));
                raw::fill(values, std::iter::repeat(bytes.as_ptr()));
                Status::Ok
            }
            Err(status) => status,
        }
    })
}

fn absent(instance: InstancePointer, name: &str, kind: Call, n: usize) -> Status {
    call(instance, name, |instance| match n {
        0 => instance.permits(kind),
        _ => instance.refuse("no variable that this function could reach; use the function of its type"),
    })
}

/// Getters and setters of types that no variable has, or that cannot be set.
macro_rules! absent {
    ($($name:ident($kind:ident; $($argument:ident: $of:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(
            instance: InstancePointer,
            _references: *const ValueReference,
            n: usize,
            $($argument: $of),*
        ) -> Status {
            absent(instance, stringify!($name), Call::$kind, n)
        }
    )*};
}

absent! {
    fmi3GetFloat32(Get; _values: *mut f32, _n_values: usize);
    fmi3GetInt8(Get; _values: *mut i8, _n_values: usize);
    fmi3GetUInt8(Get; _values: *mut u8, _n_values: usize);
    fmi3GetInt16(Get; _values: *mut i16, _n_values: usize);
    fmi3GetUInt16(Get; _values: *mut u16, _n_values: usize);
    fmi3GetUInt32(Get; _values: *mut u32, _n_values: usize);
    fmi3GetInt64(Get; _values: *mut i64, _n_values: usize);
    fmi3GetUInt64(Get; _values: *mut u64, _n_values: usize);
    fmi3GetClock(Get; _values: *mut bool);
    fmi3SetFloat32(Set; _values: *const f32, _n_values: usize);
    fmi3SetInt8(Set; _values: *const i8, _n_values: usize);
    fmi3SetUInt8(Set; _values: *const u8, _n_values: usize);
    fmi3SetInt16(Set; _values: *const i16, _n_values: usize);
    fmi3SetUInt16(Set; _values: *const u16, _n_values: usize);
    fmi3SetUInt32(Set; _values: *const u32, _n_values: usize);
    fmi3SetInt64(Set; _values: *const i64, _n_values: usize);
    fmi3SetUInt64(Set; _values: *const u64, _n_values: usize);
    fmi3SetBinary(Set; _sizes: *const usize, _values: *const Binary, _n_values: usize);
    fmi3SetClock(Set; _values: *const bool);
    fmi3GetIntervalDecimal(Get; _intervals: *mut f64, _qualifiers: *mut i32);
    fmi3GetIntervalFraction(Get; _counters: *mut u64, _resolutions: *mut u64, _qualifiers: *mut i32);
    fmi3GetShiftDecimal(Get; _shifts: *mut f64);
    fmi3GetShiftFraction(Get; _counters: *mut u64, _resolutions: *mut u64);
    fmi3SetIntervalDecimal(Set; _intervals: *const f64);
    fmi3SetIntervalFraction(Set; _counters: *const u64, _resolutions: *const u64);
    fmi3SetShiftDecimal(Set; _shifts: *const f64);
    fmi3SetShiftFraction(Set; _counters: *const u64, _resolutions: *const u64);
}
