//! Life cycle and logging.

use std::ffi::c_void;
use std::path::Path;

use enmm_fmi::handle::{Host, enter};
use enmm_fmi::instance::{Instance, Plan};
use enmm_fmi::log::Message;
use enmm_fmi::phase::Call;
use enmm_fmi::table::Version;

use super::types::{
    Environment, Importer, InstancePointer, IntermediateUpdate, LIVE, LogMessage, Status, Text, ValueReference, call,
    guarded,
};
use enmm_fmi::raw::{self, MISSING};

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: InstancePointer,
    on: bool,
    n: usize,
    categories: *const Text,
) -> Status {
    call(instance, "fmi3SetDebugLogging", |instance| {
        // SAFETY: the importer gives `n` texts.
        match unsafe { raw::texts(categories, n) } {
            Some(names) => instance.set_logging(on, &names),
            None => instance.refuse_state(MISSING),
        }
    })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: bool,
    _logging: bool,
    environment: Environment,
    log_message: Option<LogMessage>,
) -> InstancePointer {
    refuse_kind("fmi3InstantiateModelExchange", environment, log_message)
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: bool,
    _logging: bool,
    environment: Environment,
    log_message: Option<LogMessage>,
    _clock_update: Option<unsafe extern "C" fn(Environment)>,
    _lock_preemption: Option<unsafe extern "C" fn()>,
    _unlock_preemption: Option<unsafe extern "C" fn()>,
) -> InstancePointer {
    refuse_kind("fmi3InstantiateScheduledExecution", environment, log_message)
}

fn refuse_kind(function: &str, environment: Environment, log_message: Option<LogMessage>) -> InstancePointer {
    guarded(std::ptr::null_mut(), || {
        let reason = "this FMU is for co-simulation only; use fmi3InstantiateCoSimulation";
        Importer::new(environment, log_message, None).log(&Message::error(format!("{function}: {reason}")));
        std::ptr::null_mut()
    })
}

/// # Safety
/// Pointers are as FMI 3 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: Text,
    token: Text,
    resources: Text,
    _visible: bool,
    logging: bool,
    event_mode: bool,
    early_return: bool,
    required: *const ValueReference,
    n_required: usize,
    environment: Environment,
    log_message: Option<LogMessage>,
    intermediate_update: Option<IntermediateUpdate>,
) -> InstancePointer {
    guarded(std::ptr::null_mut(), || {
        let importer = Importer::new(environment, log_message, intermediate_update);
        // SAFETY: the importer gives texts and `n_required` references.
        let (texts, required) =
            unsafe { ([raw::text(name), raw::text(token), raw::text(resources)], raw::slice(required, n_required)) };
        match instance(texts, (event_mode, early_return, logging), required) {
            Ok(mut instance) => {
                instance.take_messages().iter().for_each(|message| importer.log(message));
                std::ptr::without_provenance_mut::<c_void>(enter(&LIVE, instance, importer))
            }
            Err(reason) => {
                importer.log(&Message::error(format!("fmi3InstantiateCoSimulation: {reason}")));
                std::ptr::null_mut()
            }
        }
    })
}

fn instance(
    [name, token, resources]: [Option<&str>; 3],
    (event_mode, early_return, logging): (bool, bool, bool),
    required: Option<&[ValueReference]>,
) -> Result<Instance, String> {
    let (Some(name), Some(token)) = (name, token) else {
        return Err("the name of the instance or its token is missing or no UTF-8: give both".to_owned());
    };
    let resources = Path::new(resources.ok_or("the resource path is missing: give the folder `resources`")?);
    let built = std::panic::catch_unwind(|| {
        Instance::new(Plan { version: Version::Three, name, token, resources, logging, early_return, event_mode })
    });
    let instance = built.unwrap_or_else(|_| Err("the model cannot be built: panic".to_owned()))?;
    let required = required.ok_or("the intermediate variables are missing: give them or the number 0")?;
    match required.iter().find(|&&reference| instance.table().get(reference).is_none()) {
        Some(reference) => {
            let count = instance.table().variables.len();
            Err(format!("the intermediate variable {reference} is unknown: references are less than {count}"))
        }
        None => Ok(instance),
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: InstancePointer) {
    let free = call(instance, "fmi3FreeInstance", |instance| instance.permits(Call::Free));
    if free != Status::Error {
        guarded((), || {
            let _ = LIVE.remove(instance.addr());
        });
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: InstancePointer,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    stop_defined: bool,
    stop: f64,
) -> Status {
    call(instance, "fmi3EnterInitializationMode", |instance| {
        instance.enter_initialization(Some((start, stop_defined.then_some(stop))))
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: InstancePointer) -> Status {
    call(instance, "fmi3ExitInitializationMode", Instance::exit_initialization)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: InstancePointer) -> Status {
    call(instance, "fmi3Terminate", Instance::terminate)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: InstancePointer) -> Status {
    call(instance, "fmi3Reset", Instance::reset)
}
