//! Inputs of a host. Every value is checked, holds until it is set again, and is part of saved states.
//!
//! A value that is set acts from the start of the next communication step on, or is reached at its end by
//! [`Interpolation::Linear`](super::Interpolation) (Eq. 32). In the ramp of a first static stage all inputs grow with
//! gravity.

use enmm_case::keys::Plain;
use std::fmt::Display;

use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::state::{Input, Inputs, PortKind};

use super::limits::{ACCELERATION_MAX, FACTOR_MAX, LEVEL_MAX, RAIN_MAX, VALUE_MAX, VELOCITY_MAX};
use super::{Cosimulation, CosimulationError, Named};

impl Cosimulation {
    /// Sets gravity (m/s², y up: the standard is (0, −9.81)).
    ///
    /// # Errors
    /// A value that is not finite or too large.
    pub fn set_gravity(&mut self, gravity: impl Into<Vector>) -> Result<(), CosimulationError> {
        let gravity = gravity.into();
        vector(&"gravity", gravity, ACCELERATION_MAX, "m/s²")?;
        self.set(|inputs| replace(&mut inputs.gravity, gravity));
        Ok(())
    }

    /// Sets the acceleration of the base (m/s²). Displacements and velocities are relative to the base, and all rock
    /// feels the opposite acceleration. It is no part of the initial equilibrium and begins at time 0.
    ///
    /// # Errors
    /// A value that is not finite or too large.
    pub fn set_base_acceleration(&mut self, acceleration: impl Into<Vector>) -> Result<(), CosimulationError> {
        let acceleration = acceleration.into();
        vector(&"base_acceleration", acceleration, ACCELERATION_MAX, "m/s²")?;
        self.set(|inputs| replace(&mut inputs.base_acceleration, acceleration));
        Ok(())
    }

    /// Sets the height y of the water surface (m); the case must have `[water]`.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a case without water.
    pub fn set_water_level(&mut self, level: f64) -> Result<(), CosimulationError> {
        number(&"water_level", level, LEVEL_MAX, "m")?;
        if self.simulation.model().water.is_none() {
            let remedy = "add `[water]` with `level` to the case";
            return Err(CosimulationError::value("water_level", level, "that of a case with water", remedy));
        }
        self.set(|inputs| replace(&mut inputs.water_level, level));
        Ok(())
    }

    /// Sets the level (m) of a `[[head]]`, by its place in the case. It acts wherever the flow in the joints is found:
    /// at the start of static stages, and in dynamic ones with `flow = "steady"` or `"transient"`.
    ///
    /// # Errors
    /// A value that is not finite or too large, a head that does not exist, or flow that is held from now on.
    pub fn set_head(&mut self, head: usize, level: f64) -> Result<(), CosimulationError> {
        self.check_named(Named::Head, head)?;
        number(&format_args!("level of head {:?}", self.case().heads[head].name), level, LEVEL_MAX, "m")?;
        self.check_follows("head")?;
        self.set(|inputs| replace(&mut inputs.head[head], level));
        Ok(())
    }

    /// Sets the rate (m/s, that is m³/s on each m² in plan) of a `[[rain]]`, by its place in the case. It acts as
    /// [`Cosimulation::set_head`] does.
    ///
    /// # Errors
    /// A value that is negative or too large, a rain that does not exist, or flow that is held from now on.
    pub fn set_rain(&mut self, rain: usize, rate: f64) -> Result<(), CosimulationError> {
        self.check_named(Named::Rain, rain)?;
        if !(0.0..=RAIN_MAX).contains(&rate) {
            let name = format!("rate of rain {:?}", self.case().rains[rain].name);
            let limit = format!("at least 0 and at most {RAIN_MAX:e} m/s");
            let value = format!("{} m/s", Plain(rate));
            return Err(CosimulationError::value(name, value, &limit, "10 mm in an hour are 2.8e-6 m/s"));
        }
        self.check_follows("rain")?;
        self.set(|inputs| replace(&mut inputs.rain[rain], rate));
        Ok(())
    }

    /// Lets a `[[drain]]` act or not, by its place in the case. It is a switch, which is not interpolated, and acts as
    /// [`Cosimulation::set_head`] does.
    ///
    /// # Errors
    /// A drain that does not exist, or flow that is held from now on.
    pub fn set_drain(&mut self, drain: usize, is_active: bool) -> Result<(), CosimulationError> {
        self.check_named(Named::Drain, drain)?;
        self.check_follows("drain")?;
        self.set(|inputs| replace(&mut inputs.drain[drain], is_active));
        Ok(())
    }

    /// Refuses inputs of a flow that is held from now on.
    fn check_follows(&self, name: &str) -> Result<(), CosimulationError> {
        if self.simulation.follows_flow() {
            return Ok(());
        }
        let remedy =
            "add `flow = \"steady\"` or `flow = \"transient\"` to the dynamic stage, or set it before the start";
        let stage = self.simulation.stage().name.as_str();
        Err(CosimulationError::value(name, format!("set in stage {stage:?}"), "set where the flow is found", remedy))
    }

    /// Sets the factor by which cohesion, tan φ and tensile strength of all joints, and of rock that yields or breaks,
    /// are multiplied (1 at the start).
    ///
    /// # Errors
    /// A value that is not finite, negative or too large.
    pub fn set_strength_factor(&mut self, factor: f64) -> Result<(), CosimulationError> {
        if !(0.0..=FACTOR_MAX).contains(&factor) {
            let remedy = "1 leaves the strength as in the case";
            let limit = format!("at least 0 and at most {FACTOR_MAX:e}");
            return Err(CosimulationError::value("strength_factor", factor, &limit, remedy));
        }
        self.set(|inputs| replace(&mut inputs.strength_factor, factor));
        Ok(())
    }

    /// Sets force (N/m) through the centroid of a block and moment about it (N·m/m, counter-clockwise); they take the
    /// position of those that a port of the case has at the start. The block is given by its number, such as that of
    /// [`Cosimulation::port_block`], which its part with the reference point keeps when rock breaks.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a block that does not exist.
    pub fn set_block_force(
        &mut self,
        block: impl Into<BlockId>,
        force: impl Into<Vector>,
        moment: f64,
    ) -> Result<(), CosimulationError> {
        let (block, force) = (block.into(), force.into());
        self.set_block_forces(std::iter::once((block, force, moment)))
    }

    /// Sets forces and moments on blocks, all or none of them.
    ///
    /// # Errors
    /// The first value that [`Cosimulation::set_block_force`] would refuse.
    pub fn set_block_forces<B: Into<BlockId>, V: Into<Vector>>(
        &mut self,
        forces: impl Iterator<Item = (B, V, f64)> + Clone,
    ) -> Result<(), CosimulationError> {
        let forces = forces.map(|(block, force, moment)| (block.into(), force.into(), moment));
        for (block, force, moment) in forces.clone() {
            self.own_block(block)?;
            vector(&format_args!("force on block {block}"), force, VALUE_MAX, "N/m")?;
            number(&format_args!("moment on block {block}"), moment, VALUE_MAX, "N·m/m")?;
        }
        let built = self.simulation.shared_model();
        self.set(|inputs| {
            forces.fold(false, |changed, (block, force, moment)| {
                let block = built.model.block_labelled(block.number()).unwrap_or(block);
                let force = replace(&mut inputs.block_force[block], force);
                changed | force | replace(&mut inputs.block_moment[block], moment)
            })
        });
        Ok(())
    }

    /// Force (N/m) and moment (N·m/m) that are set on a block.
    ///
    /// # Errors
    /// A block that does not exist.
    pub fn block_force(&self, block: impl Into<BlockId>) -> Result<(Vector, f64), CosimulationError> {
        let (block, inputs) = (self.own_block(block)?, self.inputs());
        Ok((inputs.block_force[block], inputs.block_moment[block]))
    }

    /// Sets traction (Pa, global axes, per reference length) on the boundary of a port.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a port that does not exist or is no boundary.
    pub fn set_boundary_traction(&mut self, port: usize, traction: impl Into<Vector>) -> Result<(), CosimulationError> {
        let traction = traction.into();
        let name = self.check_port(port, &[PortKind::Boundary], "a port of a boundary")?;
        vector(&format_args!("traction on port {name}"), traction, VALUE_MAX, "Pa")?;
        self.set(|inputs| replace(&mut inputs.port_traction[port], traction));
        Ok(())
    }

    /// Sets fluid pressure (Pa, pushing into the rock) on the boundary, or on both faces of the joints, of a port.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a port that does not exist or is a block.
    pub fn set_pressure(&mut self, port: usize, pressure: f64) -> Result<(), CosimulationError> {
        let kinds = [PortKind::Boundary, PortKind::Joint];
        let name = self.check_port(port, &kinds, "a port of a boundary or of joints")?;
        number(&format_args!("pressure on port {name}"), pressure, VALUE_MAX, "Pa")?;
        self.set(|inputs| replace(&mut inputs.port_pressure[port], pressure));
        Ok(())
    }

    /// Sets the particle velocity (m/s) of the wave that comes in through a quiet boundary, or the velocity with which
    /// the supports of a fixity move. It acts in dynamic stages, beside what the case says.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a port that does not exist or is of another kind.
    pub fn set_port_velocity(&mut self, port: usize, velocity: Vector) -> Result<(), CosimulationError> {
        let kinds = [PortKind::Quiet, PortKind::Fix];
        let name = self.check_port(port, &kinds, "a port of a quiet boundary or of a fixity")?;
        vector(&format_args!("velocity of port {name}"), velocity, VELOCITY_MAX, "m/s")?;
        self.aims.remove(&port);
        self.set(|inputs| replace(&mut inputs.port_velocity[port], velocity));
        Ok(())
    }

    /// Sets the displacement (m) that the supports of a fixity have reached at the end of the next communication step,
    /// counted from their place before a host has moved them; they go there at a steady velocity, and stay.
    ///
    /// # Errors
    /// A value that is not finite or too large, or a port that does not exist or is of another kind.
    pub fn set_port_displacement(&mut self, port: usize, displacement: Vector) -> Result<(), CosimulationError> {
        let name = self.check_port(port, &[PortKind::Fix], "a port of a fixity")?;
        vector(&format_args!("displacement of port {name}"), displacement, LEVEL_MAX, "m")?;
        self.aims.insert(port, displacement);
        self.progress.changed = true;
        Ok(())
    }

    /// Makes all inputs that have been set since the last step act at once from the start of the next one, also where
    /// inputs are interpolated: an anchor is lost. What is set after this call goes on its way from there.
    pub fn jump(&mut self) {
        self.simulation.drive().jump();
    }

    /// The same for one input alone; that of a port of a block is the input of its block.
    ///
    /// # Errors
    /// A block or a port that does not exist.
    pub fn jump_of(&mut self, input: Input) -> Result<(), CosimulationError> {
        let input = self.model_input(self.own_input(input)?);
        self.simulation.drive().jump_of(input);
        Ok(())
    }

    /// The input that exists, which for a port of a block is that of its block.
    pub(super) fn own_input(&self, input: Input) -> Result<Input, CosimulationError> {
        match input {
            Input::Block(block) => self.own_block(block).map(|_| input),
            Input::Port(port) => Ok(match self.port(port as usize)?.kind {
                PortKind::Block => Input::Block(self.port_block(port as usize)?),
                _ => input,
            }),
            Input::Head(head) => self.check_named(Named::Head, head as usize).map(|()| input),
            Input::Rain(rain) => self.check_named(Named::Rain, rain as usize).map(|()| input),
            Input::Drain(drain) => self.check_named(Named::Drain, drain as usize).map(|()| input),
            Input::Gravity | Input::BaseAcceleration | Input::WaterLevel | Input::StrengthFactor => Ok(input),
        }
    }

    /// An input that exists, with the index that its block has in the model now.
    pub(super) fn model_input(&self, input: Input) -> Input {
        let block = match input {
            Input::Block(number) => self.simulation.block_labelled(number),
            _ => None,
        };
        block.map_or(input, |block| Input::Block(block.number()))
    }

    /// The block of the model that has the number of `block`.
    ///
    /// # Errors
    /// There is none.
    pub fn own_block(&self, block: impl Into<BlockId>) -> Result<BlockId, CosimulationError> {
        let block = block.into();
        self.simulation.block_labelled(block.number()).ok_or_else(|| {
            let limit = format!("less than the number of blocks, {}", self.simulation.model().covers.block_count());
            CosimulationError::value("block", block, &limit, "ask for the states of the blocks to see their ids")
        })
    }

    fn check_port(&self, port: usize, kinds: &[PortKind], what: &str) -> Result<&str, CosimulationError> {
        let found = self.port(port)?;
        if kinds.contains(&found.kind) {
            return Ok(&found.name);
        }
        Err(CosimulationError::value("port", &found.name, what, "use the input of its own kind"))
    }

    /// Sets inputs; `change` returns whether one is new.
    fn set(&mut self, change: impl FnOnce(&mut Inputs) -> bool) {
        let drive = self.simulation.drive();
        let changed = change(&mut drive.to);
        self.progress.changed |= changed;
    }
}

/// Replaces a value and returns whether it is another.
fn replace<T: Copy + PartialEq>(old: &mut T, new: T) -> bool {
    let changed = *old != new;
    *old = new;
    changed
}

fn number(name: &dyn Display, value: f64, most: f64, unit: &str) -> Result<(), CosimulationError> {
    if value.is_finite() && value.abs() <= most {
        return Ok(());
    }
    let limit = format!("a finite number of at most {most:e} {unit} in magnitude");
    let (name, value) = (name.to_string(), format!("{} {unit}", Plain(value)));
    Err(CosimulationError::value(name, value, &limit, "correct the value; the old one still holds"))
}

fn vector(name: &dyn Display, value: Vector, most: f64, unit: &str) -> Result<(), CosimulationError> {
    number(&format_args!("{name}, x"), value.x, most, unit)?;
    number(&format_args!("{name}, y"), value.y, most, unit)
}
