//! Getters and setters. Variables are of type Float64, Int32, Boolean and Binary; calls of other types must be empty.

use enmm_fmi::phase::Call;
use enmm_fmi::table::Type;

use crate::types::{Binary, InstancePointer, Status, Text, ValueReference, call};
use enmm_fmi::raw::{self, MISSING};

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *mut f64,
    n_values: usize,
) -> Status {
    let what = (instance, "fmi3GetFloat64", Type::Real);
    // SAFETY: the importer gives `n` references and room for `n_values` values.
    unsafe { get_as(what, (references, n), (values, n_values), |number| number) }
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *const f64,
    n_values: usize,
) -> Status {
    call(instance, "fmi3SetFloat64", |instance| {
        // SAFETY: the importer gives `n` references and `n_values` values.
        match unsafe { (raw::slice(references, n), raw::slice(values, n_values)) } {
            (Some(references), Some(values)) => instance.set(references, Type::Real, values),
            _ => instance.refuse(MISSING),
        }
    })
}

/// Reads variables of a type; `of` makes a value of a number.
///
/// # Safety
/// The importer gives `n` references and room for `n_values` values.
unsafe fn get_as<T>(
    (instance, name, kind): (InstancePointer, &str, Type),
    (references, n): (*const ValueReference, usize),
    (values, n_values): (*mut T, usize),
    of: fn(f64) -> T,
) -> Status {
    call(instance, name, |instance| {
        // SAFETY: by the contract of this function.
        match unsafe { (raw::slice(references, n), raw::room(values, n_values)) } {
            (Some(references), Some(values)) => {
                let status = instance.expects(Call::Get, references, kind, n_values);
                if status != Status::Ok {
                    return status;
                }
                let mut numbers = vec![0.0; n_values];
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

/// Sets variables of a type other than Float64; `number` makes a number of a value.
///
/// # Safety
/// The importer gives `n` references and `n_values` values.
unsafe fn set_as<T: Copy>(
    (instance, name, kind): (InstancePointer, &str, Type),
    (references, n): (*const ValueReference, usize),
    (values, n_values): (*const T, usize),
    number: fn(T) -> f64,
) -> Status {
    call(instance, name, |instance| {
        // SAFETY: by the contract of this function.
        match unsafe { (raw::slice(references, n), raw::slice(values, n_values)) } {
            (Some(references), Some(values)) => {
                let status = instance.expects(Call::Set, references, kind, n_values);
                if status != Status::Ok {
                    return status;
                }
                let numbers: Vec<f64> = values.iter().map(|&value| number(value)).collect();
                instance.set(references, kind, &numbers)
            }
            _ => instance.refuse(MISSING),
        }
    })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt32(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *mut i32,
    n_values: usize,
) -> Status {
    let what = (instance, "fmi3GetInt32", Type::Integer);
    // SAFETY: the importer gives `n` references and room for `n_values` values.
    unsafe { get_as(what, (references, n), (values, n_values), |number| number as i32) }
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt32(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *const i32,
    n_values: usize,
) -> Status {
    let what = (instance, "fmi3SetInt32", Type::Integer);
    // SAFETY: the importer gives `n` references and `n_values` values.
    unsafe { set_as(what, (references, n), (values, n_values), f64::from) }
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBoolean(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *mut bool,
    n_values: usize,
) -> Status {
    let what = (instance, "fmi3GetBoolean", Type::Boolean);
    // SAFETY: the importer gives `n` references and room for `n_values` values, each a byte.
    unsafe { get_as(what, (references, n), (values.cast::<u8>(), n_values), |number| u8::from(number != 0.0)) }
}

/// A byte of the importer need not be a `bool` of Rust.
/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBoolean(
    instance: InstancePointer,
    references: *const ValueReference,
    n: usize,
    values: *const bool,
    n_values: usize,
) -> Status {
    let what = (instance, "fmi3SetBoolean", Type::Boolean);
    let number = |byte: u8| f64::from(u8::from(byte != 0));
    // SAFETY: the importer gives `n` references and `n_values` values, each a byte.
    unsafe { set_as(what, (references, n), (values.cast::<u8>(), n_values), number) }
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
    fmi3GetString(Get; _values: *mut Text, _n_values: usize);
    fmi3GetClock(Get; _values: *mut bool);
    fmi3SetFloat32(Set; _values: *const f32, _n_values: usize);
    fmi3SetInt8(Set; _values: *const i8, _n_values: usize);
    fmi3SetUInt8(Set; _values: *const u8, _n_values: usize);
    fmi3SetInt16(Set; _values: *const i16, _n_values: usize);
    fmi3SetUInt16(Set; _values: *const u16, _n_values: usize);
    fmi3SetUInt32(Set; _values: *const u32, _n_values: usize);
    fmi3SetInt64(Set; _values: *const i64, _n_values: usize);
    fmi3SetUInt64(Set; _values: *const u64, _n_values: usize);
    fmi3SetString(Set; _values: *const Text, _n_values: usize);
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
