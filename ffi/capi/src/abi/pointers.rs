//! Pointers of hosts: each function says what the pointer must be and checks what can be checked.

use std::ffi::CStr;

use libc::c_char;

use crate::growing::Growing;
use crate::safe::failure::{Failure, Outcome};
use crate::types::enmm_status;

/// Text of a host.
///
/// # Safety
/// `text` is NULL or ends with a zero byte; it outlives the result.
pub unsafe fn text<'a>(name: &str, text: *const c_char) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(Failure::null(name));
    }
    // SAFETY: promised by the caller.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|error| Failure::invalid(format!("{name}: must be UTF-8, but {error}")))
}

/// Values of a host.
///
/// # Safety
/// `values` is NULL or points to `count` values, which outlive the result and are not written meanwhile.
pub unsafe fn slice<'a, T: Copy>(name: &str, values: *const T, count: usize) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check(name, values, count)?;
    // SAFETY: not NULL, aligned, of a length that memory can have; the rest is promised by the caller.
    Ok(unsafe { std::slice::from_raw_parts(values, count) })
}

/// Writes one value.
///
/// # Safety
/// `out` is NULL or points to a place for a value.
pub unsafe fn write<T: Copy>(name: &str, out: *mut T, value: T) -> Outcome {
    check(name, out, 1)?;
    // SAFETY: not NULL and aligned; the rest is promised by the caller.
    unsafe { out.write(value) };
    Ok(())
}

/// Writes a value, unless the caller has no interest in it.
///
/// # Safety
/// `out` is NULL or points to a value.
pub unsafe fn write_if_wanted<T: Copy>(out: *mut T, value: T) -> Outcome {
    if out.is_null() {
        return Ok(());
    }
    // SAFETY: promised by the caller.
    unsafe { write("out", out, value) }
}

/// Writes a handle.
///
/// # Safety
/// As [`write()`].
pub unsafe fn write_handle<T>(name: &str, out: *mut *mut T, handle: usize) -> Outcome {
    // SAFETY: promised by the caller.
    unsafe { write(name, out, std::ptr::without_provenance_mut(handle)) }
}

/// Writes the values of a buffer and their number, or the number alone.
///
/// # Safety
/// `out` is NULL or points to places for `capacity` values, `written` is NULL or points to a number.
pub unsafe fn fill<T: Copy>(items: &[T], out: *mut T, capacity: usize, written: *mut usize) -> Outcome {
    // SAFETY: promised by the caller.
    if unsafe { announce(items.len(), out.is_null(), capacity, written)? } {
        check("out", out, capacity)?;
        // SAFETY: `capacity`, which is at least the number of items, places are promised; buffers of hosts and of this
        // library do not overlap.
        unsafe { std::ptr::copy_nonoverlapping(items.as_ptr(), out, items.len()) };
    }
    Ok(())
}

/// Writes a text with its zero byte; sizes include it.
///
/// # Safety
/// As [`fill`].
pub unsafe fn fill_text(text: &str, out: *mut c_char, capacity: usize, written: *mut usize) -> Outcome {
    let bytes: Vec<c_char> = text.bytes().chain([0]).map(|byte| byte as c_char).collect();
    // SAFETY: promised by the caller.
    unsafe { fill(&bytes, out, capacity, written) }
}

/// Writes one structure, as far as the caller knows it.
///
/// # Safety
/// `out` is NULL or points to a structure whose `struct_size` is its size.
pub unsafe fn fill_struct<T: Growing>(item: &T, out: *mut T) -> Outcome {
    check(T::NAME, out, 1)?;
    // SAFETY: not NULL and aligned; the rest is promised by the caller.
    unsafe {
        let size = stride_of(out)?;
        put(item, out.cast(), size);
    }
    Ok(())
}

/// Refuses a structure that [`fill_struct`] would refuse.
///
/// # Safety
/// As [`fill_struct`].
pub unsafe fn check_struct<T: Growing>(out: *const T) -> Outcome {
    check(T::NAME, out, 1)?;
    // SAFETY: not NULL and aligned; the rest is promised by the caller.
    unsafe { stride_of(out) }.map(|_| ())
}

/// The structure of a caller, which says its size.
///
/// # Safety
/// `given` is NULL or points to a structure as large as its `struct_size` says.
pub unsafe fn read_struct<T: Growing>(given: *const T) -> Result<T, Failure> {
    check(T::NAME, given, 1)?;
    // SAFETY: promised by the caller; the size is not less than that of version 1, which is all that is read.
    unsafe {
        stride_of(given)?;
        Ok(given.read())
    }
}

/// Writes structures and their number, or the number alone; the size of the first is the stride.
///
/// # Safety
/// `out` is NULL or points to `capacity` structures as large as the first one's `struct_size` says, `written` is NULL
/// or points to a number.
pub unsafe fn fill_structs<T: Growing>(items: &[T], out: *mut T, capacity: usize, written: *mut usize) -> Outcome {
    // SAFETY: promised by the caller.
    unsafe { fill_made(items.len(), || items.iter().copied(), out, capacity, written) }
}

/// Writes `count` structures as they are made, or their number without making them.
///
/// # Safety
/// As [`fill_structs`].
pub unsafe fn fill_made<T: Growing, I: Iterator<Item = T>>(
    count: usize,
    make: impl FnOnce() -> I,
    out: *mut T,
    capacity: usize,
    written: *mut usize,
) -> Outcome {
    // SAFETY: promised by the caller.
    unsafe {
        let stride = if out.is_null() || capacity == 0 {
            0
        } else {
            check(T::NAME, out, 1)?;
            stride_of(out)?
        };
        if announce(count, out.is_null(), capacity, written)? {
            for (k, item) in make().take(count).enumerate() {
                put(&item, out.cast::<u8>().add(k * stride), stride);
            }
        }
    }
    Ok(())
}

/// Writes the first `size` bytes of a structure that both sides know, and `size` itself.
///
/// # Safety
/// `out` is aligned and points to `size` bytes, not less than those of version 1.
unsafe fn put<T: Growing>(item: &T, out: *mut u8, size: usize) {
    // SAFETY: both sides have so many bytes, and `T` has no padding.
    unsafe {
        std::ptr::copy_nonoverlapping(std::ptr::from_ref(item).cast::<u8>(), out, size.min(size_of::<T>()));
        out.cast::<usize>().write(size);
    }
}

/// Size of a structure of the caller.
///
/// # Safety
/// `out` is aligned and points to a structure that begins with its size.
unsafe fn stride_of<T: Growing>(out: *const T) -> Result<usize, Failure> {
    // SAFETY: promised by the caller; only the first field is read.
    let size = unsafe { out.cast::<usize>().read() };
    let most = 1 << 16;
    if (T::FIRST_SIZE..=most).contains(&size) && size.is_multiple_of(align_of::<T>()) {
        return Ok(size);
    }
    let (name, least, align) = (T::NAME, T::FIRST_SIZE, align_of::<T>());
    let limit = format!("at least {least}, at most {most} and a multiple of {align}");
    Err(Failure::invalid(format!("struct_size: is {size}, must be {limit}; set it to sizeof({name})")))
}

/// Returns the number of items to the caller, and to this library whether they are to be written.
///
/// # Safety
/// `written` is NULL or points to a number.
unsafe fn announce(count: usize, is_null: bool, capacity: usize, written: *mut usize) -> Result<bool, Failure> {
    if is_null && capacity > 0 {
        return Err(Failure::null("out"));
    }
    // SAFETY: promised by the caller.
    unsafe { write("written", written, count)? };
    if is_null {
        return Ok(false);
    }
    check_capacity(count, capacity)?;
    Ok(true)
}

/// Whether a buffer has room for so many values.
pub fn check_capacity(count: usize, capacity: usize) -> Outcome {
    if count <= capacity {
        return Ok(());
    }
    let message = format!("capacity: is {capacity}, must be at least {count}; ask for it with NULL and 0");
    Err(Failure::new(enmm_status::ENMM_BUFFER_TOO_SMALL, message))
}

fn check<T>(name: &str, pointer: *const T, count: usize) -> Outcome {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    if !pointer.is_aligned() {
        let align = align_of::<T>();
        return Err(Failure::invalid(format!(
            "{name}: is not aligned to {align} bytes; pass the address of a variable"
        )));
    }
    if count.checked_mul(size_of::<T>()).is_none_or(|size| size > isize::MAX as usize) {
        return Err(Failure::invalid(format!("{name}: {count} values do not fit into memory; correct the number")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::enmm_event;
    use crate::types::enmm_event_kind::ENMM_EVENT_FAILED;

    fn event(subject: u32) -> enmm_event {
        let struct_size = size_of::<enmm_event>();
        enmm_event { struct_size, kind: ENMM_EVENT_FAILED, subject, time: 1.5, other: 7, reserved: 0, depth: 0.25 }
    }

    #[test]
    fn a_larger_structure_keeps_what_this_library_does_not_know() {
        let mut place = [[9_u64; 7]; 2];
        place[0][0] = 56;
        let (mut written, out) = (0, place.as_mut_ptr().cast());
        // SAFETY: two structures of the size that the first one has.
        let outcome = unsafe { fill_structs(&[event(1), event(2)], out, 2, &mut written) };
        assert_eq!((outcome, written), (Ok(()), 2));
        for (k, words) in place.iter().enumerate() {
            assert_eq!([words[0], words[1] >> 32, words[2]], [56, k as u64 + 1, 1.5_f64.to_bits()]);
            assert_eq!(words[3..], [7, 0.25_f64.to_bits(), 9, 9]);
        }
    }

    #[test]
    fn a_structure_of_the_first_version_gets_what_it_has_room_for() {
        let mut place = [[9_u64; 3]; 2];
        place[0][0] = 24;
        let (mut written, out) = (0, place.as_mut_ptr().cast());
        // SAFETY: two structures of the size that the first one has.
        let outcome = unsafe { fill_structs(&[event(1), event(2)], out, 2, &mut written) };
        assert_eq!((outcome, written), (Ok(()), 2));
        for (k, words) in place.iter().enumerate() {
            assert_eq!([words[0], words[1] >> 32, words[2]], [24, k as u64 + 1, 1.5_f64.to_bits()]);
        }
    }

    #[test]
    fn sizes_that_no_version_had_are_refused() {
        let mut place = event(0);
        for size in [0, 8, 23, 25, 1 << 20] {
            place.struct_size = size;
            // SAFETY: refused by its size before anything is written.
            let outcome = unsafe { fill_struct(&event(1), &mut place) };
            assert_eq!(outcome.expect_err("refused").status, enmm_status::ENMM_INVALID_ARGUMENT, "{size}");
        }
    }

    #[test]
    fn pointers_that_are_not_aligned_are_refused() {
        let mut place = [0_u64; 2];
        let odd = place.as_mut_ptr().wrapping_byte_add(1);
        // SAFETY: refused by its alignment.
        let outcome = unsafe { write("out", odd, 1_u64) };
        assert_eq!(outcome.expect_err("refused").status, enmm_status::ENMM_INVALID_ARGUMENT);
        // SAFETY: refused by its length.
        let outcome = unsafe { slice("values", place.as_ptr(), usize::MAX) };
        assert!(outcome.is_err());
    }
}
