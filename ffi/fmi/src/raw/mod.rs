//! Pointers of the importer, which may be missing: all `unsafe` of this crate.
#![deny(unsafe_op_in_unsafe_fn)]

mod accessors;
pub mod states;

pub use accessors::{get, get_texts, set, set_texts};

use std::ffi::{CStr, CString, c_char};
use std::mem::MaybeUninit;

/// Reason of a call that lacks an argument.
pub const MISSING: &str = "a pointer is NULL or misaligned, or a count too large; give an array for every count but 0";

/// The array of `n` values at a pointer; empty for `n` = 0, whatever the pointer is.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned points to `n` values that live as long as the slice.
pub unsafe fn slice<'a, T>(pointer: *const T, n: usize) -> Option<&'a [T]> {
    match n {
        0 => Some(&[]),
        _ if pointer.is_null() || !pointer.is_aligned() || !fits::<T>(n) => None,
        // SAFETY: by the contract of this function.
        _ => Some(unsafe { std::slice::from_raw_parts(pointer, n) }),
    }
}

/// The room for `n` values at a pointer; empty for `n` = 0, whatever the pointer is. What is there before need not be a
/// value.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned may be written to for `n` values, and nothing else points there.
pub unsafe fn room<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [MaybeUninit<T>]> {
    match n {
        0 => Some(&mut []),
        _ if pointer.is_null() || !pointer.is_aligned() || !fits::<T>(n) => None,
        // SAFETY: by the contract of this function.
        _ => Some(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), n) }),
    }
}

/// Writes values to the room for them, from its begin.
pub fn fill<T>(room: &mut [MaybeUninit<T>], values: impl IntoIterator<Item = T>) {
    for (place, value) in room.iter_mut().zip(values) {
        place.write(value);
    }
}

/// Whether so many values can lie in memory at all: a slice must not be longer.
fn fits<T>(n: usize) -> bool {
    n.checked_mul(size_of::<T>()).is_some_and(|bytes| isize::try_from(bytes).is_ok())
}

/// Whether a value can be written to a pointer: it is neither NULL nor misaligned.
pub fn is_place<T>(pointer: *mut T) -> bool {
    !pointer.is_null() && pointer.is_aligned()
}

/// Writes a value to a pointer; false when it is missing.
///
/// # Safety
/// A pointer that is neither NULL nor misaligned may be written to.
pub unsafe fn put<T>(pointer: *mut T, value: T) -> bool {
    let there = is_place(pointer);
    if there {
        // SAFETY: by the contract of this function.
        unsafe { pointer.write(value) };
    }
    there
}

/// The text at a pointer, if there is one and it is UTF-8.
///
/// # Safety
/// A pointer that is not NULL points to a text that a zero byte ends and that lives as long as the slice.
pub unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a str> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: by the contract of this function.
    unsafe { CStr::from_ptr(pointer) }.to_str().ok()
}

/// `n` texts; none when one is missing.
///
/// # Safety
/// As for [`slice()`] and [`text`].
pub unsafe fn texts<'a>(pointer: *const *const c_char, n: usize) -> Option<Vec<&'a str>> {
    // SAFETY: by the contract of this function.
    unsafe { slice(pointer, n)?.iter().map(|&each| text(each)).collect() }
}

/// A text for the C side; a zero byte within it becomes a blank.
pub fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}
