//! An FMU of either version and its instances, as an importer has them.

use std::ffi::{CString, c_void};
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut};

use enmm_fmi::log::Status;
use enmm_fmi::resource;
use enmm_fmi::table::{Causality, Table, Type, Version};
use enmm_fmu::{fmi2, fmi3};
use enmm_io::{LoadedCase, parse_case};

use crate::buffer::Buffer;

/// Case, folder and variables of an FMU; the folder goes away with it.
pub struct Fmu {
    /// Version of the standard.
    pub version: Version,
    /// Its variables.
    pub table: Table,
    /// Internal step of its model (s).
    pub dt: f64,
    folder: PathBuf,
}

impl Drop for Fmu {
    fn drop(&mut self) {
        // A folder of temporary files may stay.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

impl Fmu {
    /// The model of a case.
    pub fn new(case: &str, version: Version) -> Result<Self, String> {
        let loaded: LoadedCase = parse_case(case, "case.toml", Path::new("")).map_err(|error| error.to_string())?;
        let model = loaded.cosimulation().map_err(|error| error.to_string())?;
        let table = Table::new(&loaded.case, model.blocks_max(), &loaded.hash, version);
        let folder = std::env::temp_dir().join(format!("enmm-host-{}-{version:?}", std::process::id()));
        let resources = folder.join("resources");
        let text = resource::encode(&loaded, "case").map_err(|error| error.to_string())?;
        let written =
            std::fs::create_dir_all(&resources).and_then(|()| std::fs::write(resources.join(resource::FILE), text));
        written.map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self { version, table, dt: model.internal_step(), folder })
    }

    /// A new instance.
    pub fn instance(&self) -> Result<Instance, String> {
        self.instance_with(false)
    }

    /// A new instance, in FMI 3 with event mode or without.
    pub fn instance_with(&self, event_mode: bool) -> Result<Instance, String> {
        let token = CString::new(self.table.token.as_str()).map_err(|error| error.to_string())?;
        let folder = self.folder.display();
        let (name, no) = (c"fuzz".as_ptr(), false);
        let pointer = match self.version {
            Version::Two => {
                let uri = CString::new(format!("file://{folder}/resources")).map_err(|error| error.to_string())?;
                let functions = fmi2::CallbackFunctions::NONE;
                let (kind, token, uri) = (fmi2::CO_SIMULATION, token.as_ptr(), uri.as_ptr());
                // SAFETY: texts and functions are there.
                unsafe { fmi2::fmi2Instantiate(name, kind, token, uri, &raw const functions, 0, 0) }
            }
            Version::Three => {
                let path = CString::new(format!("{folder}/resources/")).map_err(|error| error.to_string())?;
                let (token, path, at) = (token.as_ptr(), path.as_ptr(), null_mut());
                // SAFETY: texts are there.
                unsafe {
                    fmi3::fmi3InstantiateCoSimulation(
                        name,
                        token,
                        path,
                        no,
                        no,
                        event_mode,
                        no,
                        null(),
                        0,
                        at,
                        None,
                        None,
                    )
                }
            }
        };
        if pointer.is_null() { Err("no instance".to_owned()) } else { Ok(Instance { version: self.version, pointer }) }
    }

    /// The time of an instance, where it tells one.
    pub fn time(&self, instance: Instance) -> Option<f64> {
        let reference = self.table.variables.iter().find(|v| v.name == "time").map_or(0, |v| v.reference);
        let mut buffer = Buffer::new(1);
        let is_told = instance.get(Type::Real, &[reference], &mut buffer, 1) == Status::Ok;
        is_told.then(|| buffer.numbers(1)[0])
    }

    /// Outputs that must be finite: all but the net force over an applied one that may be next to nothing.
    pub fn outputs(&self) -> Vec<(u32, usize)> {
        let list = self.table.variables.iter();
        let list =
            list.filter(|v| v.causality == Causality::Output && v.kind == Type::Real && v.name != "unbalanced_ratio");
        list.map(|v| (v.reference, v.size())).collect()
    }
}

/// The call of the version of an instance.
macro_rules! by_version {
    ($instance:ident, $two:expr, $three:expr) => {
        match $instance.version {
            Version::Two => $two,
            Version::Three => $three,
        }
    };
}

/// An instance; it may be used when it is dead.
#[derive(Clone, Copy)]
pub struct Instance {
    version: Version,
    /// State of the importer.
    pub pointer: *mut c_void,
}

impl Instance {
    /// Sets the experiment up, which FMI 3 does on entering the initialization mode.
    pub fn set_up(self, start: f64, stop: Option<f64>) -> Status {
        let (is, stop) = (i32::from(stop.is_some()), stop.unwrap_or_default());
        by_version!(self, fmi2::fmi2SetupExperiment(self.pointer, 0, 0.0, start, is, stop), Status::Ok)
    }

    /// Enters the initialization mode.
    pub fn enter(self, start: f64) -> Status {
        by_version!(
            self,
            fmi2::fmi2EnterInitializationMode(self.pointer),
            fmi3::fmi3EnterInitializationMode(self.pointer, false, 0.0, start, false, 0.0)
        )
    }

    /// Leaves the initialization mode.
    pub fn exit(self) -> Status {
        by_version!(
            self,
            fmi2::fmi2ExitInitializationMode(self.pointer),
            fmi3::fmi3ExitInitializationMode(self.pointer)
        )
    }

    /// Terminates.
    pub fn terminate(self) -> Status {
        by_version!(self, fmi2::fmi2Terminate(self.pointer), fmi3::fmi3Terminate(self.pointer))
    }

    /// Resets.
    pub fn reset(self) -> Status {
        by_version!(self, fmi2::fmi2Reset(self.pointer), fmi3::fmi3Reset(self.pointer))
    }

    /// Frees the instance.
    pub fn free(self) {
        by_version!(self, fmi2::fmi2FreeInstance(self.pointer), fmi3::fmi3FreeInstance(self.pointer))
    }

    /// Status, and the time that FMI 3 tells.
    pub fn step(self, t: f64, h: f64) -> (Status, f64) {
        let (mut event, mut terminate, mut early, mut last) = (false, false, false, t + h);
        let pointers = (&raw mut event, &raw mut terminate, &raw mut early, &raw mut last);
        let status = match self.version {
            Version::Two => fmi2::fmi2DoStep(self.pointer, t, h, 1),
            Version::Three => {
                // SAFETY: room for four values.
                unsafe { fmi3::fmi3DoStep(self.pointer, t, h, true, pointers.0, pointers.1, pointers.2, pointers.3) }
            }
        };
        (status, last)
    }

    /// Reads values of a type into a buffer of `n_values` words, which FMI 2 takes to be as many as the references.
    pub fn get(self, kind: Type, references: &[u32], buffer: &mut Buffer, n_values: usize) -> Status {
        let (p, r, n) = (self.pointer, references.as_ptr(), references.len());
        // SAFETY: so many references and words are there; a word holds a value of any of these types.
        unsafe {
            match (self.version, kind) {
                (Version::Two, Type::Real) => fmi2::fmi2GetReal(p, r, n, buffer.pointer()),
                (Version::Two, Type::Integer) => fmi2::fmi2GetInteger(p, r, n, buffer.pointer()),
                (Version::Two, Type::String) => fmi2::fmi2GetString(p, r, n, buffer.pointer()),
                (Version::Two, _) => fmi2::fmi2GetBoolean(p, r, n, buffer.pointer()),
                (Version::Three, Type::Real) => fmi3::fmi3GetFloat64(p, r, n, buffer.pointer(), n_values),
                (Version::Three, Type::Integer) => fmi3::fmi3GetInt32(p, r, n, buffer.pointer(), n_values),
                (Version::Three, Type::Boolean) => fmi3::fmi3GetBoolean(p, r, n, buffer.pointer(), n_values),
                (Version::Three, Type::String) => fmi3::fmi3GetString(p, r, n, buffer.pointer(), n_values),
                (Version::Three, Type::Binary) => {
                    let mut sizes = vec![0; n.max(1)];
                    fmi3::fmi3GetBinary(p, r, n, sizes.as_mut_ptr(), buffer.pointer(), n_values)
                }
            }
        }
    }

    /// Sets values of a type.
    pub fn set(self, kind: Type, references: &[u32], values: &[f64]) -> Status {
        let (p, r, n) = (self.pointer, references.as_ptr(), references.len());
        // Real values are passed on without an allocation, since `enmm-overhead` counts those of this call.
        let is_whole = matches!((self.version, kind), (_, Type::Integer) | (Version::Two, Type::Boolean));
        let whole: Vec<i32> = values.iter().filter(|_| is_whole).map(|&value| value as i32).collect();
        let truth: Vec<bool> = values.iter().filter(|_| kind == Type::Boolean).map(|&value| value != 0.0).collect();
        // SAFETY: so many references and values are there; FMI 2 is given as many values as references.
        unsafe {
            match (self.version, kind) {
                (Version::Two, Type::Integer) => fmi2::fmi2SetInteger(p, r, n, whole.as_ptr()),
                (Version::Two, Type::Boolean) => fmi2::fmi2SetBoolean(p, r, n, whole.as_ptr()),
                (Version::Two, _) => fmi2::fmi2SetReal(p, r, n, values.as_ptr()),
                (Version::Three, Type::Integer) => fmi3::fmi3SetInt32(p, r, n, whole.as_ptr(), values.len()),
                (Version::Three, Type::Boolean) => fmi3::fmi3SetBoolean(p, r, n, truth.as_ptr(), values.len()),
                (Version::Three, _) => fmi3::fmi3SetFloat64(p, r, n, values.as_ptr(), values.len()),
            }
        }
    }

    /// Sets derivatives of inputs of the given order (FMI 2).
    pub fn set_rates(self, references: &[u32], order: i32, rates: &[f64]) -> Status {
        let (r, n, orders) = (references.as_ptr(), references.len(), vec![order; references.len()]);
        // SAFETY: so many references, orders and rates are there.
        unsafe { fmi2::fmi2SetRealInputDerivatives(self.pointer, r, n, orders.as_ptr(), rates.as_ptr()) }
    }

    /// Enters event mode or step mode (FMI 3).
    pub fn enter_mode(self, is_event: bool) -> Status {
        if is_event { fmi3::fmi3EnterEventMode(self.pointer) } else { fmi3::fmi3EnterStepMode(self.pointer) }
    }

    /// Derivatives of outputs of the given order.
    pub fn derivatives(self, references: &[u32], order: i32, buffer: &mut Buffer) -> Status {
        let (p, r, n, orders) = (self.pointer, references.as_ptr(), references.len(), vec![order; references.len()]);
        // SAFETY: so many references, orders and words are there.
        unsafe {
            by_version!(
                self,
                fmi2::fmi2GetRealOutputDerivatives(p, r, n, orders.as_ptr(), buffer.pointer()),
                fmi3::fmi3GetOutputDerivatives(p, r, n, orders.as_ptr(), buffer.pointer(), n)
            )
        }
    }

    /// Saves; `state` may hold an older one, which is then used again.
    pub fn save(self, state: &mut *mut c_void) -> Status {
        // SAFETY: room for a state.
        unsafe {
            by_version!(self, fmi2::fmi2GetFMUstate(self.pointer, state), fmi3::fmi3GetFMUState(self.pointer, state))
        }
    }

    /// Restores a state.
    pub fn restore(self, state: *mut c_void) -> Status {
        by_version!(self, fmi2::fmi2SetFMUstate(self.pointer, state), fmi3::fmi3SetFMUState(self.pointer, state))
    }

    /// Frees a state.
    pub fn free_state(self, state: &mut *mut c_void) -> Status {
        // SAFETY: room for a state.
        unsafe {
            by_version!(self, fmi2::fmi2FreeFMUstate(self.pointer, state), fmi3::fmi3FreeFMUState(self.pointer, state))
        }
    }

    /// The bytes of a state.
    ///
    /// # Errors
    /// The status of the call that failed.
    pub fn bytes(self, state: *mut c_void) -> Result<Vec<u8>, Status> {
        let mut size = 0;
        // SAFETY: room for a size, then for so many bytes.
        unsafe {
            let (p, out) = (self.pointer, &raw mut size);
            let status = by_version!(
                self,
                fmi2::fmi2SerializedFMUstateSize(p, state, out),
                fmi3::fmi3SerializedFMUStateSize(p, state, out)
            );
            let mut bytes = vec![0_u8; size];
            let status = match self.version {
                _ if status != Status::Ok => status,
                Version::Two => fmi2::fmi2SerializeFMUstate(p, state, bytes.as_mut_ptr().cast(), size),
                Version::Three => fmi3::fmi3SerializeFMUState(p, state, bytes.as_mut_ptr(), size),
            };
            if status == Status::Ok { Ok(bytes) } else { Err(status) }
        }
    }

    /// A state of bytes.
    pub fn unpack(self, bytes: &[u8]) -> (Status, *mut c_void) {
        let (mut state, p, n) = (null_mut(), self.pointer, bytes.len());
        // SAFETY: so many bytes, and room for a state.
        let status = unsafe {
            by_version!(
                self,
                fmi2::fmi2DeSerializeFMUstate(p, bytes.as_ptr().cast(), n, &raw mut state),
                fmi3::fmi3DeserializeFMUState(p, bytes.as_ptr(), n, &raw mut state)
            )
        };
        (status, state)
    }
}
