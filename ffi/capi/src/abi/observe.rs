//! Outputs for hosts.

use engine::geometry::Point;
use libc::c_char;

use super::pointers;
use crate::numbers::*;
use crate::safe::enter::with_model;
use crate::safe::failure::Failure;
use crate::types::*;

/// Returns the number of blocks, excavated ones included. It grows when rock breaks and when a stage parts blocks, and
/// falls only with a return to an earlier state; without `fracture` and cuts in the case it never changes. Blocks keep
/// their ids.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_block_count(model: *mut enmm_model, count: *mut usize) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe { pointers::write("count", count, model.block_count()) }
    })
}

/// Writes the state of every block, by id.
///
/// `out` holds `capacity` structures; `out[0].struct_size` must be set and is the distance from one to the next.
/// `*written` gets their number. With `out` NULL and `capacity` 0 the call returns only that number.
///
/// Errors: ENMM_BUFFER_TOO_SMALL, ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_block_states(
    model: *mut enmm_model,
    out: *mut enmm_block_state,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        pointers::fill_made(model.block_count(), || model.block_states(), out, capacity, written)
    })
}

/// Returns the states of all blocks, by id, in the memory of the model: nothing is copied.
///
/// `*first` gets the address of the first one, `*stride` the distance (bytes) from one to the next, which is
/// sizeof(enmm_block_state) of the library and so may be more than that of the header, and `*count` their number. The
/// values are worked out at the first look after a step. They may be read until the next call with the model, by
/// whatever thread, and must not be changed.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_view_block_states(
    model: *mut enmm_model,
    first: *mut *const enmm_block_state,
    stride: *mut usize,
    count: *mut usize,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let states = model.view_block_states();
        // SAFETY: promised by the host.
        unsafe {
            pointers::write("first", first, states.as_ptr())?;
            pointers::write("stride", stride, size_of::<enmm_block_state>())?;
            pointers::write("count", count, states.len())
        }
    })
}

/// Writes energies and works. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_energies(model: *mut enmm_model, out: *mut enmm_energies) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.energies(), out) })
}

/// Writes sums and extremes over the model. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_totals(model: *mut enmm_model, out: *mut enmm_totals) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.totals(), out) })
}

/// Writes the contacts of the last internal step with its forces, at their places now, those without force included.
/// Before the first step of a stage they are those that this step will find, without forces.
///
/// Buffer and errors as enmm_get_block_states.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_contacts(
    model: *mut enmm_model,
    out: *mut enmm_contact,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        pointers::fill_made(model.inner.contact_count(), || model.contacts(), out, capacity, written)
    })
}

/// Writes the events from index `first` on (0: all since the start), in the order of time. A return to a saved state
/// restores its events. An event does not change between reads, its time included.
///
/// Buffer and errors as enmm_get_block_states.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_events(
    model: *mut enmm_model,
    first: usize,
    out: *mut enmm_event,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_structs(&model.events(first), out, capacity, written) })
}

/// Returns the most blocks that the model can have: those of its last stage, and fracture.parts_max more where rock can
/// break.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_blocks_max(model: *mut enmm_model, count: *mut usize) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe { pointers::write("count", count, model.inner.blocks_max()) }
    })
}

/// Writes the sections of rock that have broken, in order. A return to a saved state restores its own.
///
/// Buffer and errors as enmm_get_block_states.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_cuts(
    model: *mut enmm_model,
    out: *mut enmm_cut,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        pointers::fill_made(model.cuts().len(), || model.cuts(), out, capacity, written)
    })
}

/// Writes the current outer outline of a block, counter-clockwise, as x, y, x, y, ... (m).
///
/// `xy` holds `capacity` points, that is twice as many numbers; `*written` gets the number of points. With `xy` NULL
/// and `capacity` 0 the call returns only that number. Cracks that end in the block are part of its outline. For holes
/// see enmm_get_block_hole.
///
/// Errors: ENMM_BUFFER_TOO_SMALL; ENMM_INVALID_ARGUMENT for a block that does not exist; ENMM_NOT_FOUND for one that
/// has been excavated; ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_block_polygon(
    model: *mut enmm_model,
    block: u32,
    xy: *mut f64,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { outline(&model.block_loops(block)?, 0, xy, capacity, written) })
}

/// Returns the number of holes of a block.
///
/// Errors: as enmm_get_block_polygon.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_block_hole_count(model: *mut enmm_model, block: u32, count: *mut usize) -> enmm_status {
    with_model(model.addr(), |model| {
        let holes = model.block_loops(block)?.len().saturating_sub(1);
        // SAFETY: promised by the host.
        unsafe { pointers::write("count", count, holes) }
    })
}

/// Writes the current outline of hole `hole` (from 0) of a block, clockwise; buffer as enmm_get_block_polygon.
///
/// Errors: as enmm_get_block_polygon; ENMM_INVALID_ARGUMENT for a hole that does not exist.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_block_hole(
    model: *mut enmm_model,
    block: u32,
    hole: u32,
    xy: *mut f64,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let loops = model.block_loops(block)?;
        // SAFETY: promised by the host.
        unsafe { outline(&loops, hole as usize + 1, xy, capacity, written) }
    })
}

unsafe fn outline(
    loops: &[Vec<Point>],
    k: usize,
    xy: *mut f64,
    capacity: usize,
    written: *mut usize,
) -> Result<(), Failure> {
    let Some(points) = loops.get(k) else {
        let holes = loops.len().saturating_sub(1);
        let message = format!("hole: is {}, must be less than the number of holes, {holes}", k.saturating_sub(1));
        return Err(Failure::invalid(message));
    };
    let points: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
    // SAFETY: promised by the host; a pair has the size and alignment of two numbers.
    unsafe { pointers::fill(&points, xy.cast(), capacity, written) }
}

/// Returns the block at a position (m) now; the lowest id where blocks meet.
///
/// Errors: ENMM_NOT_FOUND where there is no rock; ENMM_INVALID_ARGUMENT for values that are not finite;
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_find_block_at(model: *mut enmm_model, x: f64, y: f64, block: *mut u32) -> enmm_status {
    with_model(model.addr(), |model| {
        let found = model.block_at(Point::new(x, y))?;
        // SAFETY: promised by the host.
        unsafe { pointers::write("block", block, found) }
    })
}

/// Returns the number of ports that the case names by `[[port]]`.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_port_count(model: *mut enmm_model, count: *mut usize) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("count", count, model.inner.ports().len()) })
}

/// Returns the port with a name.
///
/// Errors: ENMM_NOT_FOUND, ENMM_INVALID_ARGUMENT, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_find_port(model: *mut enmm_model, name: *const c_char, port: *mut u32) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe {
        let found = model.find_port(pointers::text("name", name)?)?;
        pointers::write("port", port, found)
    })
}

/// Writes the name of a port in UTF-8.
///
/// `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
/// that number.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_port_name(
    model: *mut enmm_model,
    port: u32,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_text(model.port_name(port)?, out, capacity, written) })
}

/// Returns the kind of a port.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_port_kind(model: *mut enmm_model, port: u32, kind: *mut enmm_port_type) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("kind", kind, model.port_kind(port)?) })
}

/// Returns the block of a port: its own, or that of the first edge of a boundary or joint.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_port_block(model: *mut enmm_model, port: u32, block: *mut u32) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("block", block, model.port_block(port)?) })
}

/// Writes the state of a port. `out->struct_size` must be set.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or a struct_size that no version had,
/// ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_port_state(
    model: *mut enmm_model,
    port: u32,
    out: *mut enmm_port_state,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.port_state(port)?, out) })
}
