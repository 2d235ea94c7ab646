//! One model through the engine itself, the façade, the C ABI and both FMUs.

use std::ffi::CString;
use std::ptr::{null, null_mut};

use engine::cosimulation::Cosimulation;
use engine::geometry::Vector;
use engine::model::Simulation;
use enmm_fmi::log::Status;
use enmm_fmi::table::{Type, Version};
use enmm_fuzz::abi;
use enmm_fuzz::buffer::Buffer;
use enmm_fuzz::fmu::{Fmu, Instance};
use enmm_fuzz::numbers::enmm_port_state;
use enmm_fuzz::types::{enmm_model, enmm_state, enmm_status, enmm_step_info};

use crate::model::Model;

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
fn sized<T>(set: impl FnOnce(&mut T, usize)) -> T {
    // SAFETY: structures of the C ABI hold numbers alone.
    let mut made: T = unsafe { std::mem::zeroed() };
    set(&mut made, size_of::<T>());
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
pub struct Imported {
    /// Holds the folder of the instance.
    _fmu: Fmu,
    instance: Instance,
    read: [u32; 3],
    values: Buffer,
    write: u32,
    time: f64,
    dt: f64,
}

impl Imported {
    pub fn new(model: &Model, version: Version) -> Self {
        let fmu = Fmu::new(model.text, version).expect("an FMU");
        let instance = fmu.instance().expect("an instance");
        let begun = [instance.set_up(0.0, None), instance.enter(0.0), instance.exit()];
        assert_eq!(begun, [Status::Ok; 3]);
        let of = |name: &str| fmu.table.variables.iter().find(|v| v.name == name).expect("a variable").reference;
        let (read, write, dt) = (READ.map(of), of("gravity_x"), fmu.dt);
        Self { _fmu: fmu, instance, read, values: Buffer::new(read.len()), write, time: 0.0, dt }
    }
}

impl Host for Imported {
    fn step(&mut self) {
        assert_eq!(self.instance.step(self.time, self.dt).0, Status::Ok);
        self.time += self.dt;
    }

    fn read(&mut self) {
        let status = self.instance.get(Type::Real, &self.read, &mut self.values, self.read.len());
        assert_eq!(status, Status::Ok);
        std::hint::black_box(&self.values);
    }

    fn write(&mut self, value: f64) {
        assert_eq!(self.instance.set(Type::Real, &[self.write], &[value]), Status::Ok);
    }

    fn save(&mut self) {
        let mut state = null_mut();
        let statuses = [self.instance.save(&mut state), self.instance.free_state(&mut state)];
        assert_eq!(statuses, [Status::Ok; 2]);
    }
}
