//! Life cycle, logging and saved states.

use std::ffi::c_int;
use std::path::PathBuf;

use enmm_fmi::handle::{Host, enter};
use enmm_fmi::instance::{Instance, Plan};
use enmm_fmi::location;
use enmm_fmi::log::Message;
use enmm_fmi::phase::Call;
use enmm_fmi::table::Version;

use super::types::{
    Boolean, Byte, CO_SIMULATION, CallbackFunctions, Component, FmuState, Importer, LIVE, Real, Status, Text, call,
    guarded,
};
use enmm_fmi::raw::states;
use enmm_fmi::raw::{self, MISSING};

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(c: Component, on: Boolean, n: usize, categories: *const Text) -> Status {
    call(c, "fmi2SetDebugLogging", |instance| {
        // SAFETY: the importer gives `n` texts.
        match unsafe { raw::texts(categories, n) } {
            Some(names) => instance.set_logging(on != 0, &names),
            None => instance.refuse_state(MISSING),
        }
    })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: Text,
    kind: c_int,
    guid: Text,
    location: Text,
    functions: *const CallbackFunctions,
    _visible: Boolean,
    logging: Boolean,
) -> Component {
    guarded(std::ptr::null_mut(), || {
        // SAFETY: the importer gives its functions, which are read once, and texts.
        let (functions, name, guid, location) = unsafe {
            let functions = raw::slice(functions, 1).and_then(|one| one.first().copied());
            (functions, raw::text(name), raw::text(guid), raw::text(location))
        };
        let Some(functions) = functions else { return std::ptr::null_mut() };
        let importer = Importer::new(&functions, name.unwrap_or_default());
        match instance(name, kind, guid, location, logging != 0) {
            Ok(mut instance) => {
                instance.take_messages().iter().for_each(|message| importer.log(message));
                std::ptr::without_provenance_mut(enter(&LIVE, instance, importer))
            }
            Err(reason) => {
                importer.log(&Message::error(format!("fmi2Instantiate: {reason}")));
                std::ptr::null_mut()
            }
        }
    })
}

fn instance(
    name: Option<&str>,
    kind: c_int,
    guid: Option<&str>,
    location: Option<&str>,
    logging: bool,
) -> Result<Instance, String> {
    if kind != CO_SIMULATION {
        return Err("only co-simulation is possible: give fmi2CoSimulation".to_owned());
    }
    let (Some(name), Some(token)) = (name, guid) else {
        return Err("the name of the instance or its GUID is missing or no UTF-8: give both".to_owned());
    };
    let location = location.ok_or("the resource location is missing: give the URI of the folder `resources`")?;
    let resources: PathBuf = location::resolve(location)?;
    let guarded = std::panic::catch_unwind(|| {
        Instance::new(Plan {
            version: Version::Two,
            name,
            token,
            resources: &resources,
            logging,
            early_return: false,
            event_mode: false,
        })
    });
    guarded.unwrap_or_else(|_| Err("the model cannot be built: panic".to_owned()))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(c: Component) {
    let free = call(c, "fmi2FreeInstance", |instance| instance.permits(Call::Free));
    if free != Status::Error {
        guarded((), || {
            let _ = LIVE.remove(c.addr());
        });
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    c: Component,
    _tolerance_defined: Boolean,
    _tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    call(c, "fmi2SetupExperiment", |instance| instance.set_up(start, (stop_defined != 0).then_some(stop)))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(c: Component) -> Status {
    call(c, "fmi2EnterInitializationMode", |instance| instance.enter_initialization(None))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(c: Component) -> Status {
    call(c, "fmi2ExitInitializationMode", Instance::exit_initialization)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(c: Component) -> Status {
    call(c, "fmi2Terminate", Instance::terminate)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(c: Component) -> Status {
    call(c, "fmi2Reset", Instance::reset)
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Component, state: *mut FmuState) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(c, "fmi2GetFMUstate", |instance| unsafe { states::save(instance, state) })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(c: Component, state: FmuState) -> Status {
    call(c, "fmi2SetFMUstate", |instance| instance.restore_state(state.addr()))
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Component, state: *mut FmuState) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(c, "fmi2FreeFMUstate", |instance| unsafe { states::free(instance, state) })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Component, state: FmuState, size: *mut usize) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(c, "fmi2SerializedFMUstateSize", |instance| unsafe { states::size(instance, state, size) })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(c: Component, state: FmuState, out: *mut Byte, size: usize) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(c, "fmi2SerializeFMUstate", |instance| unsafe { states::serialize(instance, state, out.cast(), size) })
}

/// # Safety
/// Pointers are as FMI 2 states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: Component,
    bytes: *const Byte,
    size: usize,
    state: *mut FmuState,
) -> Status {
    // SAFETY: the importer gives pointers that can be read and written, for `size` bytes where there is one.
    call(c, "fmi2DeSerializeFMUstate", |instance| unsafe { states::deserialize(instance, bytes.cast(), size, state) })
}
