//! Inputs that the façade does not know in the form that hosts give them.

use engine::cosimulation::{Input, PortKind};
use engine::geometry::Vector;

use super::failure::{Failure, Outcome};
use super::model::{Model, interpolation};
use crate::types::enmm_input;

impl Model {
    /// Sets force and moment of several blocks, or of none; `loads` holds Fx, Fy and M of each block of `ids`.
    ///
    /// # Errors
    /// The first value that the façade refuses.
    pub fn set_block_forces(&mut self, ids: &[u32], loads: [&[f64]; 3]) -> Outcome {
        let [fx, fy, moment] = loads;
        let forces = (0..ids.len()).map(|k| (ids[k], Vector::new(fx[k], fy[k]), moment[k]));
        self.inner.set_block_forces(forces)?;
        Ok(())
    }

    /// Sets fluid pressure on a port of one kind.
    ///
    /// # Errors
    /// A port of another kind, or a value that the façade refuses.
    pub fn set_pressure(&mut self, port: u32, kind: PortKind, pressure: f64) -> Outcome {
        if let Some(found) = self.inner.ports().get(port as usize)
            && found.kind != kind
        {
            let must = if kind == PortKind::Joint { "a port of joints" } else { "a port of a boundary" };
            return Err(Failure::invalid(format!("port: is {:?}, must be {must}; use its own input", found.name)));
        }
        Ok(self.inner.set_pressure(port as usize, pressure)?)
    }

    /// Sets how one input goes through a communication step, by numbers of C.
    ///
    /// # Errors
    /// A number that no input and no way has, or an index that does not exist.
    pub fn set_interpolation_of(&mut self, input: i32, index: u32, mode: i32) -> Outcome {
        let of = |kind: enmm_input| kind as i32 == input;
        let own = match input {
            _ if of(enmm_input::ENMM_INPUT_GRAVITY) => Input::Gravity,
            _ if of(enmm_input::ENMM_INPUT_BASE_ACCELERATION) => Input::BaseAcceleration,
            _ if of(enmm_input::ENMM_INPUT_WATER_LEVEL) => Input::WaterLevel,
            _ if of(enmm_input::ENMM_INPUT_STRENGTH_FACTOR) => Input::StrengthFactor,
            _ if of(enmm_input::ENMM_INPUT_BLOCK) => Input::Block(index),
            _ if of(enmm_input::ENMM_INPUT_PORT) => Input::Port(index),
            _ if of(enmm_input::ENMM_INPUT_HEAD) => Input::Head(index),
            _ if of(enmm_input::ENMM_INPUT_RAIN) => Input::Rain(index),
            _ if of(enmm_input::ENMM_INPUT_DRAIN) => Input::Drain(index),
            _ => return Err(Failure::invalid(format!("input: is {input}, must be a value of enmm_input, 0 to 8"))),
        };
        Ok(self.inner.set_interpolation_of(own, interpolation(mode)?)?)
    }

    /// Force (N/m) and moment (N·m/m) that are set on a block.
    ///
    /// # Errors
    /// A block that does not exist.
    pub fn block_force(&self, block: u32) -> Result<([f64; 2], f64), Failure> {
        let (force, moment) = self.inner.block_force(block)?;
        Ok(([force.x, force.y], moment))
    }

    /// Traction (Pa), pressure (Pa) and velocity (m/s) that are set on a port.
    ///
    /// # Errors
    /// A port that does not exist.
    pub fn port_inputs(&self, port: u32) -> Result<([f64; 2], f64, [f64; 2]), Failure> {
        self.port_name(port)?;
        let (inputs, port) = (self.inner.inputs(), port as usize);
        let [traction, velocity] = [inputs.port_traction[port], inputs.port_velocity[port]].map(|v| [v.x, v.y]);
        Ok((traction, inputs.port_pressure[port], velocity))
    }
}
