//! Types of `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`.

use std::ffi::{c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use enmm_fmi::handle::{Handle, Host, Live};
use enmm_fmi::instance::Instance;
use enmm_fmi::log::Message;
pub use enmm_fmi::log::Status;

use enmm_fmi::raw;
pub use enmm_fmi::raw::states::FmuState;

pub type InstancePointer = *mut c_void;
pub type Environment = *mut c_void;
pub type ValueReference = u32;
pub type Text = *const c_char;
pub type Binary = *const u8;

/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(Environment, Status, Text, Text);

/// `fmi3IntermediateUpdateCallback`: time, whether setting is requested, whether getting is allowed, whether the
/// internal step is finished, whether to return early is possible; then whether it is wanted, and when.
pub type IntermediateUpdate = unsafe extern "C" fn(Environment, f64, bool, bool, bool, bool, *mut bool, *mut f64);

/// The importer of an instance.
pub(crate) struct Importer {
    pub(crate) log_message: Option<LogMessage>,
    pub(crate) intermediate_update: Option<IntermediateUpdate>,
    /// Address of its environment, which is only passed back.
    environment: usize,
}

impl Importer {
    pub(crate) fn new(
        environment: Environment,
        log_message: Option<LogMessage>,
        intermediate_update: Option<IntermediateUpdate>,
    ) -> Self {
        Self { log_message, intermediate_update, environment: environment.expose_provenance() }
    }

    pub(crate) fn environment(&self) -> Environment {
        std::ptr::with_exposed_provenance_mut(self.environment)
    }
}

impl Host for Importer {
    /// In FMI 3 messages, `#` stands around value references.
    fn log(&self, message: &Message) {
        let Some(log) = self.log_message else { return };
        let category = raw::c_text(message.category.name());
        let text = raw::c_text(&message.text.replace('#', "##"));
        // SAFETY: the importer gave this function for this use; all texts live until it returns.
        unsafe { log(self.environment(), message.status, category.as_ptr(), text.as_ptr()) };
    }
}

/// All instances of this library.
pub(crate) static LIVE: Live<Importer> = Live::new(0x40);

/// Does `work` on the importer's instance.
pub(crate) fn call(pointer: InstancePointer, name: &str, work: impl FnOnce(&mut Instance) -> Status) -> Status {
    with_handle(pointer, |handle| handle.call(name, work))
}

pub(crate) fn with_handle(pointer: InstancePointer, work: impl FnOnce(&Arc<Handle<Importer>>) -> Status) -> Status {
    guarded(Status::Fatal, || LIVE.find(pointer.addr()).map_or(Status::Error, |handle| work(&handle)))
}

/// Keeps a panic from the importer.
pub(crate) fn guarded<T>(lost: T, work: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(lost)
}
