//! One model through the engine itself, the façade, the C ABI and both FMUs.

use std::ffi::{CString, c_void};
use std::path::Path;
use std::ptr::{null, null_mut};

use engine::cosimulation::Cosimulation;
use engine::geometry::Vector;
use engine::model::Simulation;
use enmm_fmi::resource;
use enmm_fmi::table::{Table, Version};
use enmm_fmi2 as fmi2;
use enmm_fmi3 as fmi3;

use crate::abi;
use crate::model::Model;
use crate::types::{enmm_model, enmm_port_state, enmm_state, enmm_status, enmm_step_info};

/// Outputs that are read.
const READ: [&str; 3] = ["block.displacement_x", "block.velocity_x", "block.rotation"];

/// Somebody who makes a model move.
pub trait Host {
    /// One communication step of one internal step.
    fn step(&mut self);
    /// Reads displacement, velocity and rotation of the port.
    fn read(&mut self) {}
    /// Sets an input to another value.
    fn write(&mut self, _value: f64) {}
    /// Saves the state and gives it free.
    fn save(&mut self) {}
}

/// The engine without a host.
pub struct Engine(pub Simulation);

impl Host for Engine {
    fn step(&mut self) {
        self.0.advance(false).expect("a step");
    }

    fn save(&mut self) {
        drop(self.0.state().clone());
    }
}

/// The façade in Rust.
pub struct Facade {
    pub model: Cosimulation,
    time: f64,
    dt: f64,
}

impl Facade {
    pub fn new(model: Cosimulation) -> Self {
        let (time, dt) = (model.time(), model.internal_step());
        Self { model, time, dt }
    }
}

impl Host for Facade {
    fn step(&mut self) {
        self.time = self.model.do_step(self.time, self.dt).expect("a step").time;
    }

    fn read(&mut self) {
        std::hint::black_box(self.model.port_state(0));
    }

    fn write(&mut self, value: f64) {
        self.model.set_gravity(Vector::new(value, -9.81)).expect("a value");
    }

    fn save(&mut self) {
        drop(self.model.save());
    }
}

/// The C ABI.
pub struct C {
    model: *mut enmm_model,
    info: enmm_step_info,
    dt: f64,
}

impl C {
    pub fn new(model: &Model) -> Self {
        let (text, mut handle, mut dt) = (CString::new(model.text).expect("a text"), null_mut(), 0.0);
        // SAFETY: text and room are there.
        unsafe {
            good(abi::model::enmm_create_from_string(text.as_ptr(), null(), &raw mut handle));
            good(abi::model::enmm_start(handle));
            good(abi::model::enmm_get_internal_step(handle, &raw mut dt));
        }
        Self { model: handle, info: sized(|info: &mut enmm_step_info, size| info.struct_size = size), dt }
    }
}

/// A structure of zeros that knows its size.
fn sized<T>(tell: impl FnOnce(&mut T, usize)) -> T {
    // SAFETY: structures of the C ABI hold numbers alone.
    let mut made: T = unsafe { std::mem::zeroed() };
    tell(&mut made, size_of::<T>());
    made
}

fn good(status: enmm_status) {
    assert_eq!(status, enmm_status::ENMM_OK);
}

impl Host for C {
    fn step(&mut self) {
        // SAFETY: the structure is there and tells its size.
        good(unsafe { abi::model::enmm_do_step(self.model, self.info.time, self.dt, &raw mut self.info) });
    }

    fn read(&mut self) {
        let mut port = sized(|port: &mut enmm_port_state, size| port.struct_size = size);
        // SAFETY: the structure is there and tells its size.
        good(unsafe { abi::observe::enmm_get_port_state(self.model, 0, &raw mut port) });
        std::hint::black_box(port);
    }

    fn write(&mut self, value: f64) {
        good(abi::inputs::enmm_set_gravity(self.model, value, -9.81));
    }

    fn save(&mut self) {
        let mut state: *mut enmm_state = null_mut();
        // SAFETY: room for a handle is there.
        good(unsafe { abi::state::enmm_state_save(self.model, &raw mut state) });
        good(abi::state::enmm_state_free(state));
    }
}

/// An FMU of either version.
pub struct Fmu {
    version: Version,
    instance: *mut c_void,
    read: [u32; 3],
    write: u32,
    time: f64,
    dt: f64,
}

impl Fmu {
    pub fn new(model: &Model, version: Version, folder: &Path) -> Self {
        let resources = folder.join("resources");
        std::fs::create_dir_all(&resources).expect("a folder");
        let case = resource::encode(&model.loaded, "case").expect("a case");
        std::fs::write(resources.join(resource::FILE), case).expect("a file");
        let facade = model.loaded.cosimulation().expect("a model");
        let (blocks, dt) = (facade.block_states().len(), facade.internal_step());
        let table = Table::new(&model.loaded.case, blocks, &model.loaded.hash, version);
        let of = |name: &str| table.variables.iter().find(|v| v.name == name).expect("a variable").reference;
        let token = CString::new(table.token.clone()).expect("a text");
        let instance = match version {
            Version::Two => instance2(&token, &resources),
            Version::Three => instance3(&token, folder),
        };
        assert!(!instance.is_null(), "an instance");
        Self { version, instance, read: READ.map(of), write: of("gravity_x"), time: 0.0, dt }
    }
}

fn instance2(token: &CString, resources: &Path) -> *mut c_void {
    let uri = CString::new(format!("file://{}", resources.display())).expect("a text");
    let functions = fmi2::CallbackFunctions::NONE;
    let name = c"bench".as_ptr();
    // SAFETY: texts and functions are there.
    let instance = unsafe { fmi2::fmi2Instantiate(name, 1, token.as_ptr(), uri.as_ptr(), &raw const functions, 0, 0) };
    assert_eq!(fmi2::fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0), fmi2::Status::Ok);
    assert_eq!(fmi2::fmi2EnterInitializationMode(instance), fmi2::Status::Ok);
    assert_eq!(fmi2::fmi2ExitInitializationMode(instance), fmi2::Status::Ok);
    instance
}

fn instance3(token: &CString, folder: &Path) -> *mut c_void {
    let path = CString::new(format!("{}/resources/", folder.display())).expect("a text");
    let (name, none) = (c"bench".as_ptr(), null_mut());
    // SAFETY: texts are there.
    let instance = unsafe {
        fmi3::fmi3InstantiateCoSimulation(
            name,
            token.as_ptr(),
            path.as_ptr(),
            false,
            false,
            false,
            false,
            null(),
            0,
            none,
            None,
            None,
        )
    };
    assert_eq!(fmi3::fmi3EnterInitializationMode(instance, false, 0.0, 0.0, false, 0.0), fmi3::Status::Ok);
    assert_eq!(fmi3::fmi3ExitInitializationMode(instance), fmi3::Status::Ok);
    instance
}

impl Host for Fmu {
    fn step(&mut self) {
        let status = match self.version {
            Version::Two => fmi2::fmi2DoStep(self.instance, self.time, self.dt, 1),
            Version::Three => {
                let (mut event, mut terminate, mut early, mut last) = (false, false, false, 0.0);
                // SAFETY: room for four values is there.
                unsafe {
                    fmi3::fmi3DoStep(
                        self.instance,
                        self.time,
                        self.dt,
                        true,
                        &raw mut event,
                        &raw mut terminate,
                        &raw mut early,
                        &raw mut last,
                    )
                }
            }
        };
        assert_eq!(status, fmi3::Status::Ok);
        self.time += self.dt;
    }

    fn read(&mut self) {
        let mut values = [0.0; 3];
        let (references, room) = (self.read.as_ptr(), values.as_mut_ptr());
        // SAFETY: three references and room for three values are there.
        let status = unsafe {
            match self.version {
                Version::Two => fmi2::fmi2GetReal(self.instance, references, 3, room),
                Version::Three => fmi3::fmi3GetFloat64(self.instance, references, 3, room, 3),
            }
        };
        assert_eq!(status, fmi3::Status::Ok);
        std::hint::black_box(values);
    }

    fn write(&mut self, value: f64) {
        // SAFETY: a reference and a value are there.
        let status = unsafe {
            match self.version {
                Version::Two => fmi2::fmi2SetReal(self.instance, &raw const self.write, 1, &raw const value),
                Version::Three => fmi3::fmi3SetFloat64(self.instance, &raw const self.write, 1, &raw const value, 1),
            }
        };
        assert_eq!(status, fmi3::Status::Ok);
    }

    fn save(&mut self) {
        let mut state = null_mut();
        // SAFETY: room for a state is there.
        let statuses = unsafe {
            match self.version {
                Version::Two => [
                    fmi2::fmi2GetFMUstate(self.instance, &raw mut state),
                    fmi2::fmi2FreeFMUstate(self.instance, &raw mut state),
                ],
                Version::Three => [
                    fmi3::fmi3GetFMUState(self.instance, &raw mut state),
                    fmi3::fmi3FreeFMUState(self.instance, &raw mut state),
                ],
            }
        };
        assert_eq!(statuses, [fmi3::Status::Ok; 2]);
    }
}
