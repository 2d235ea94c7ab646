//! Life and time of a model.

use std::ffi::CString;
use std::sync::Arc;

use libc::{c_char, c_void};

use super::pointers;
use crate::safe::control::Progress;
use crate::safe::enter::{guard, with_model};
use crate::safe::model::{self, MODELS, Sink};
use crate::types::{
    enmm_log_callback, enmm_log_level, enmm_model, enmm_progress, enmm_progress_callback, enmm_start_info, enmm_status,
    enmm_step_info,
};

/// Builds the model of a case file. Nothing moves yet.
///
/// `case_path` is a path in UTF-8; files that the case names are relative to its directory. `*out` gets the handle,
/// which enmm_destroy frees, or NULL on failure.
///
/// Errors: ENMM_FILE_ERROR, ENMM_INVALID_CASE with file, line and key, ENMM_INVALID_ARGUMENT, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_create_from_file(case_path: *const c_char, out: *mut *mut enmm_model) -> enmm_status {
    guard(|| {
        // SAFETY: promised by the host.
        unsafe {
            pointers::write_handle("out", out, 0)?;
            let path = pointers::text("case_path", case_path)?;
            pointers::write_handle("out", out, model::create_from_file(path)?)
        }
    })
}

/// Builds the model of a case that is given as text in TOML.
///
/// `base_dir` is the directory of the files that the case names; NULL stands for the current one. `*out` gets the
/// handle, which enmm_destroy frees, or NULL on failure.
///
/// Errors: as enmm_create_from_file; the text is called "case" in messages.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_create_from_string(
    toml: *const c_char,
    base_dir: *const c_char,
    out: *mut *mut enmm_model,
) -> enmm_status {
    guard(|| {
        // SAFETY: promised by the host.
        unsafe {
            pointers::write_handle("out", out, 0)?;
            let toml = pointers::text("toml", toml)?;
            let base = if base_dir.is_null() { "" } else { pointers::text("base_dir", base_dir)? };
            pointers::write_handle("out", out, model::create_from_string(toml, base)?)
        }
    })
}

/// Checks a case that is given as text in TOML: its keys, the type and range of every value, the names that it uses,
/// and the files that it names. No model is built, so a fault of the geometry as a whole appears only when one is.
///
/// `base_dir` is the directory of the files that the case names; NULL stands for the current one.
///
/// Errors: as enmm_create_from_string.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_check_case(toml: *const c_char, base_dir: *const c_char) -> enmm_status {
    guard(|| {
        // SAFETY: promised by the host.
        unsafe {
            let toml = pointers::text("toml", toml)?;
            let base = if base_dir.is_null() { "" } else { pointers::text("base_dir", base_dir)? };
            model::check_case(toml, base)
        }
    })
}

/// Ends a model and frees its memory; ends its recording, if there is one. NULL and dead handles do nothing. When
/// another thread is in a call with the model, that call ends normally; later ones return ENMM_DEAD_HANDLE.
///
/// It never waits. After it returns, the log callback gets no further message on the calling thread. When another
/// thread is in a call with the model, the callback may still run or start there, and its `user` must not be freed
/// until that call has returned.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_destroy(model: *mut enmm_model) {
    // A handle that is NULL or dead is no reason to forget the message of the last failure.
    let _ = guard(|| {
        let _ = MODELS.remove(model.addr());
        Ok(())
    });
}

/// Computes the initial equilibrium with the inputs that have been set: runs the static stages before the first dynamic
/// one. Without this call the first enmm_do_step does so. A second call does nothing. Time 0 is the end of the
/// equilibrium. enmm_get_start_info says whether the model came to rest.
///
/// Errors: ENMM_NUMERICAL_FAILURE; ENMM_INVALID_CASE when a stage does not fit the model; ENMM_INTERRUPTED.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_start(model: *mut enmm_model) -> enmm_status {
    with_model(model.addr(), |model| model.start())
}

/// Writes how the search for the initial equilibrium ended. `info->struct_size` must be set.
///
/// A model that did not come to rest is no error: enmm_start and enmm_do_step return ENMM_OK, and the log warns.
///
/// Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_start_info(model: *mut enmm_model, info: *mut enmm_start_info) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_struct(&model.start_info(), info) })
}

/// Advances the model from `t` to exactly `t + h` (s), or not at all.
///
/// `t` must be the time of the model. Internal steps, not longer than the critical one, cover the interval. The
/// division of a time into communication steps does not change results when they are multiples of the internal step.
/// Inputs that were set before act from `t` on, or are reached at `t + h` (see enmm_set_interpolation). After its end
/// the last stage of the case continues. `info` may be NULL; otherwise its `struct_size` must be set.
///
/// Errors: ENMM_WRONG_TIME; ENMM_INVALID_ARGUMENT when `h` is not greater than 0 and finite; ENMM_NUMERICAL_FAILURE
/// with block, position and cause; ENMM_INTERRUPTED. The model is then the same as before, to the bit. Without
/// enmm_start the first step also computes the initial equilibrium, and discards it when the step fails.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_do_step(
    model: *mut enmm_model,
    t: f64,
    h: f64,
    info: *mut enmm_step_info,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe {
            if info.is_null() {
                return model.do_step(t, h).map(|_| ());
            }
            pointers::check_struct(info)?;
            pointers::fill_struct(&model.do_step(t, h)?, info)
        }
    })
}

/// Returns the time of the model (s): 0 at the start of the first dynamic stage.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_time(model: *mut enmm_model, time: *mut f64) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("time", time, model.inner.time()) })
}

/// Returns the internal step (s), an integer fraction of a tenth of the communication step.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_internal_step(model: *mut enmm_model, step: *mut f64) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("step", step, model.inner.internal_step()) })
}

/// Returns the communication step (s) that the case suggests; hosts may use any other.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_communication_step(model: *mut enmm_model, step: *mut f64) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("step", step, model.inner.communication_step()) })
}

/// Returns the time (s) at which the stages of the case end; hosts may continue.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_stop_time(model: *mut enmm_model, time: *mut f64) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("time", time, model.inner.stop_time()) })
}

/// Sets the number of threads that steps use, 1 to 1024; 1, the thread of the call, at the creation. Results do not
/// depend on it, not even in the last bit. Acts from the next step on. A process that is forked from this one has
/// none of the threads: a model that it uses starts the same number again at its next step.
///
/// Errors: ENMM_INVALID_ARGUMENT for another number, or more than the system grants; in a forked process enmm_do_step
/// and enmm_start can return it as well.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_threads(model: *mut enmm_model, threads: usize) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_threads(threads)?))
}

/// Sets the callback for messages of this model; NULL (as at creation) discards them. The first callback gets the
/// warnings of the case at once; later messages are delivered at the end of the calls that they belong to.
///
/// `user` is passed to the callback unchanged. After this function has replaced the callback, `user` is no longer
/// used, except by a message that is just being delivered. That happens only when a callback replaces itself: while
/// another thread delivers, this function returns ENMM_BUSY. Messages that have not been delivered yet go to the new
/// callback. For the end of the model see enmm_destroy.
///
/// Errors: ENMM_BUSY when another thread is in a call with the model, messages of the call included.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_set_log_callback(
    model: *mut enmm_model,
    callback: enmm_log_callback,
    user: *mut c_void,
) -> enmm_status {
    with_model(model.addr(), |model| {
        model.set_sink(callback.map(|callback| sink(callback, user)));
        Ok(())
    })
}

/// The pointer of a host, which is only handed back.
struct User(*mut c_void);
// SAFETY: nothing is read or written through it here; the header says on which threads the host gets it back.
unsafe impl Send for User {}
// SAFETY: as above.
unsafe impl Sync for User {}

impl User {
    fn get(&self) -> *mut c_void {
        self.0
    }
}

fn sink(callback: unsafe extern "C" fn(*mut c_void, enmm_log_level, *const c_char), user: *mut c_void) -> Sink {
    let user = User(user);
    Arc::new(move |level, message| {
        let text = CString::new(message.replace('\0', "?")).unwrap_or_default();
        // SAFETY: the host has promised that the callback can be called with its pointer until another is set, and
        // when the model is destroyed until calls in other threads have returned.
        unsafe { callback(user.get(), level, text.as_ptr()) };
    })
}

/// Ends the call of enmm_start or enmm_do_step that is in progress with this model, in any thread: it returns
/// ENMM_INTERRUPTED before its next internal step, and the model is as it was before the call, to the bit.
///
/// It never waits and needs no turn at the model. Without a call in progress it does nothing: a call forgets what came
/// before it, so that an interrupt just before a call begins has no effect, and a host that cannot know repeats it
/// until the call has returned. A call that has taken its last internal step ends as if nothing had come. It locks a
/// table for an instant and so must not be called in a signal handler: set a flag there, and return it from the
/// progress callback.
///
/// Errors: ENMM_NULL_ARGUMENT, ENMM_DEAD_HANDLE.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_interrupt(model: *mut enmm_model) -> enmm_status {
    guard(|| {
        MODELS.find(model.addr())?.interrupt.raise();
        Ok(())
    })
}

/// Sets the callback that sees the progress of calls with this model and may end them; NULL (as at creation) for none.
///
/// `user` is passed to the callback unchanged, and no longer used after this function has replaced the callback.
///
/// Errors: ENMM_BUSY when a call is in progress, as in the callback itself.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_set_progress_callback(
    model: *mut enmm_model,
    callback: enmm_progress_callback,
    user: *mut c_void,
) -> enmm_status {
    with_model(model.addr(), |model| {
        model.set_progress(callback.map(|callback| progress(callback, user)));
        Ok(())
    })
}

fn progress(callback: unsafe extern "C" fn(*const enmm_progress, *mut c_void) -> i32, user: *mut c_void) -> Progress {
    let user = User(user);
    // SAFETY: the host has promised that the callback can be called with its pointer until another is set.
    Box::new(move |progress| unsafe { callback(progress, user.get()) } != 0)
}

/// Writes the fingerprint of the case: 16 hexadecimal digits, equal for equal models, and part of every serialised
/// state.
///
/// `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
/// that number.
///
/// Errors: ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_case_hash(
    model: *mut enmm_model,
    out: *mut c_char,
    capacity: usize,
    written: *mut usize,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::fill_text(model.inner.hash(), out, capacity, written) })
}
