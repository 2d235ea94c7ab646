//! Getters and setters of all types that variables have: values of the importer, numbers of the instance.

use std::ffi::c_char;

use super::{MISSING, fill, room, slice, texts};
use crate::instance::Instance;
use crate::log::Status;
use crate::phase::Call;
use crate::table::Type;

/// Reads variables of a type; `of` makes a value of a number.
///
/// # Safety
/// The importer gives as many references and room for as many values as it says.
pub unsafe fn get<T>(
    instance: &mut Instance,
    kind: Type,
    (references, n): (*const u32, usize),
    (values, n_values): (*mut T, usize),
    of: fn(f64) -> T,
) -> Status {
    // SAFETY: by the contract of this function.
    match unsafe { (slice(references, n), room(values, n_values)) } {
        (Some(references), Some(values)) => {
            let status = instance.expects(Call::Get, references, kind, n_values);
            if status != Status::Ok {
                return status;
            }
            let mut numbers = vec![0.0; n_values];
            let status = instance.get(references, kind, &mut numbers);
            if status == Status::Ok {
                fill(values, numbers.into_iter().map(of));
            }
            status
        }
        _ => instance.refuse(MISSING),
    }
}

/// Sets variables of a type; `number` makes a number of a value.
///
/// # Safety
/// The importer gives as many references and values as it says.
pub unsafe fn set<T: Copy>(
    instance: &mut Instance,
    kind: Type,
    (references, n): (*const u32, usize),
    (values, n_values): (*const T, usize),
    number: fn(T) -> f64,
) -> Status {
    // SAFETY: by the contract of this function.
    match unsafe { (slice(references, n), slice(values, n_values)) } {
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
}

/// Reads texts, which belong to the instance and stay until the next call of this function.
///
/// # Safety
/// The importer gives as many references and room for as many values as it says.
pub unsafe fn get_texts(
    instance: &mut Instance,
    (references, n): (*const u32, usize),
    (values, n_values): (*mut *const c_char, usize),
) -> Status {
    // SAFETY: by the contract of this function.
    match unsafe { (slice(references, n), room(values, n_values)) } {
        (Some(references), Some(values)) => {
            let status = instance.expects(Call::Get, references, Type::String, n_values);
            if status != Status::Ok {
                return status;
            }
            fill(values, std::iter::repeat(instance.text().as_ptr()));
            Status::Ok
        }
        _ => instance.refuse(MISSING),
    }
}

/// Sets texts.
///
/// # Safety
/// The importer gives as many references and texts as it says.
pub unsafe fn set_texts(
    instance: &mut Instance,
    (references, n): (*const u32, usize),
    (values, n_values): (*const *const c_char, usize),
) -> Status {
    // SAFETY: by the contract of this function.
    match unsafe { (slice(references, n), texts(values, n_values)) } {
        (Some(references), Some(values)) => instance.set_texts(references, &values),
        _ => instance.refuse("a text is missing or no UTF-8, or a pointer is NULL or misaligned; give all"),
    }
}
