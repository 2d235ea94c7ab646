//! Types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`. Enumerations and Booleans that come in are integers, so
//! that every value that an importer may give is one of the type.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use enmm_fmi::handle::{Handle, Host, Live};
use enmm_fmi::instance::Instance;
use enmm_fmi::log::Message;
pub use enmm_fmi::log::Status;

use enmm_fmi::raw;
pub use enmm_fmi::raw::states::FmuState;

pub type Component = *mut c_void;
pub type ValueReference = c_uint;
pub type Real = f64;
pub type Integer = c_int;
pub type Boolean = c_int;
pub type Text = *const c_char;
pub type Byte = c_char;

/// `fmi2CoSimulation`.
pub const CO_SIMULATION: c_int = 1;

/// The logger takes a format like that of `printf`.
pub type Logger = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, ...);

/// `fmi2CallbackFunctions`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct CallbackFunctions {
    pub logger: Option<Logger>,
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    pub component_environment: *mut c_void,
}

impl CallbackFunctions {
    /// No function at all.
    pub const NONE: Self = Self {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: std::ptr::null_mut(),
    };
}

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct EventInfo {
    pub new_discrete_states_needed: Boolean,
    pub terminate_simulation: Boolean,
    pub nominals_of_continuous_states_changed: Boolean,
    pub values_of_continuous_states_changed: Boolean,
    pub next_event_time_defined: Boolean,
    pub next_event_time: Real,
}

/// The importer of an instance.
pub(crate) struct Importer {
    logger: Option<Logger>,
    /// Address of its environment, which is only passed back.
    environment: usize,
    name: CString,
}

impl Importer {
    pub(crate) fn new(functions: &CallbackFunctions, name: &str) -> Self {
        Self {
            logger: functions.logger,
            environment: functions.component_environment.expose_provenance(),
            name: raw::c_text(name),
        }
    }
}

impl Host for Importer {
    fn log(&self, message: &Message) {
        let Some(logger) = self.logger else { return };
        let (category, text) = (raw::c_text(message.category.name()), raw::c_text(&message.text));
        let environment = std::ptr::with_exposed_provenance_mut(self.environment);
        // SAFETY: the importer gave this function for this use; all texts live until it returns.
        unsafe {
            logger(environment, self.name.as_ptr(), message.status, category.as_ptr(), c"%s".as_ptr(), text.as_ptr());
        }
    }
}

/// All instances of this library.
pub(crate) static LIVE: Live<Importer> = Live::new(0x30);

/// Does `work` on the importer's instance.
pub(crate) fn call(c: Component, name: &str, work: impl FnOnce(&mut Instance) -> Status) -> Status {
    with_handle(c, |handle| handle.call(name, work))
}

pub(crate) fn with_handle(c: Component, work: impl FnOnce(&Arc<Handle<Importer>>) -> Status) -> Status {
    guarded(Status::Fatal, || LIVE.find(c.addr()).map_or(Status::Error, |handle| work(&handle)))
}

/// Keeps a panic from the importer.
pub(crate) fn guarded<T>(lost: T, work: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(lost)
}
