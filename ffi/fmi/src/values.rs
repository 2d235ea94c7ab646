//! Values that an importer has set: all parameters and inputs, and how they reach the model.

use enmm::cosimulation::{Cosimulation, CosimulationError, Input, PortKind};
use enmm::geometry::Vector;
use enmm::model::case::keys::Plain;

use crate::table::{Axis, Causality, Quantity, Table, Type, Variable};

/// Values of parameters and inputs, arrays flat, in the order of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    /// First value of each variable, and one more for the end; variables without values have none.
    starts: Vec<usize>,
    /// The values.
    pub all: Vec<f64>,
    /// Folder to record results into; empty for none. It is no part of a state.
    pub results_folder: String,
}

/// Inputs that reach the model by one setter. Blocks come first: sums of forces are all that the model may still refuse
/// after every value has kept to the limits of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Forces and moments on blocks, of arrays and ports together.
    Blocks,
    /// Gravity.
    Gravity,
    /// Acceleration of the base.
    Base,
    /// Height of the water.
    Water,
    /// Factor on strengths.
    Strength,
    /// Traction of a port.
    Traction(usize),
    /// Pressure of a port.
    Pressure(usize),
    /// Velocity of a port.
    Velocity(usize),
    /// Level of a head.
    Head(usize),
    /// Rate of rain.
    Rain(usize),
    /// Whether a drain acts.
    Drain(usize),
}

impl Group {
    /// The group of an input.
    pub fn of(quantity: Quantity) -> Option<Self> {
        match quantity {
            Quantity::Gravity(_) => Some(Self::Gravity),
            Quantity::BaseAcceleration(_) => Some(Self::Base),
            Quantity::WaterLevel => Some(Self::Water),
            Quantity::StrengthFactor => Some(Self::Strength),
            Quantity::PortForce(..) | Quantity::PortMoment(_) => Some(Self::Blocks),
            Quantity::BlockForce(_) | Quantity::BlockMoment => Some(Self::Blocks),
            Quantity::PortTraction(k, _) => Some(Self::Traction(k)),
            Quantity::PortPressure(k) => Some(Self::Pressure(k)),
            Quantity::PortVelocity(k, _) => Some(Self::Velocity(k)),
            Quantity::Head(k) => Some(Self::Head(k)),
            Quantity::Rain(k) => Some(Self::Rain(k)),
            Quantity::Drain(k) => Some(Self::Drain(k)),
            _ => None,
        }
    }
}

impl Values {
    /// The start values.
    pub fn of(table: &Table) -> Self {
        let mut values = Self { starts: vec![0], all: Vec::new(), results_folder: String::new() };
        for v in &table.variables {
            if is_number(v) {
                values.all.extend(std::iter::repeat_n(v.start.unwrap_or(0.0), v.size()));
            }
            values.starts.push(values.all.len());
        }
        values
    }

    /// Other values of the same variables.
    pub fn with(&self, all: &[f64]) -> Self {
        Self { all: all.to_vec(), ..self.clone() }
    }

    /// Values of a variable; empty for outputs.
    pub fn get(&self, reference: u32) -> &[f64] {
        let k = reference as usize;
        &self.all[self.starts[k]..self.starts[k + 1]]
    }

    /// Checks all values as if they were set.
    ///
    /// # Errors
    /// The first that cannot be set.
    pub fn check(&self, table: &Table) -> Result<(), String> {
        let mut variables = table.variables.iter().filter(|v| is_number(v));
        variables.try_for_each(|v| self.get(v.reference).iter().try_for_each(|&value| v.check(value)))
    }

    /// Replaces the values of a variable.
    pub fn set(&mut self, reference: u32, values: &[f64]) {
        let k = reference as usize;
        self.all[self.starts[k]..self.starts[k + 1]].copy_from_slice(values);
    }

    /// The value of the scalar that stands for a quantity.
    fn scalar(&self, table: &Table, quantity: Quantity) -> f64 {
        let found = table.variables.iter().find(|v| v.quantity == quantity);
        found.and_then(|v| self.get(v.reference).first().copied()).unwrap_or(0.0)
    }

    /// Values of the properties of the case that are parameters, in the order of [`Table::parameters`].
    pub fn parameters(&self, table: &Table) -> Vec<f64> {
        let of_case = |v: &&Variable| matches!(v.quantity, Quantity::Parameter(_));
        table.variables.iter().filter(of_case).map(|v| self.get(v.reference)[0]).collect()
    }

    /// Number of threads.
    pub fn threads(&self, table: &Table) -> usize {
        self.scalar(table, Quantity::Threads) as usize
    }

    /// Whether inputs are interpolated.
    pub fn interpolates(&self, table: &Table) -> bool {
        self.scalar(table, Quantity::InterpolateInputs) != 0.0
    }

    /// Passes a group of inputs to the model.
    ///
    /// # Errors
    /// A value that the model refuses.
    pub fn push(&self, table: &Table, group: Group, model: &mut Cosimulation) -> Result<(), CosimulationError> {
        let scalar = |quantity| self.scalar(table, quantity);
        let vector = |of: &dyn Fn(Axis) -> Quantity| Vector::new(scalar(of(Axis::X)), scalar(of(Axis::Y)));
        match group {
            Group::Gravity => model.set_gravity(vector(&Quantity::Gravity)),
            Group::Base => model.set_base_acceleration(vector(&Quantity::BaseAcceleration)),
            Group::Water => model.set_water_level(scalar(Quantity::WaterLevel)),
            Group::Strength => model.set_strength_factor(scalar(Quantity::StrengthFactor)),
            Group::Blocks => self.push_blocks(table, model),
            Group::Traction(k) => model.set_boundary_traction(k, vector(&|axis| Quantity::PortTraction(k, axis))),
            Group::Pressure(k) => model.set_pressure(k, scalar(Quantity::PortPressure(k))),
            Group::Velocity(k) => model.set_port_velocity(k, vector(&|axis| Quantity::PortVelocity(k, axis))),
            Group::Head(k) => model.set_head(k, scalar(Quantity::Head(k))),
            Group::Rain(k) => model.set_rain(k, scalar(Quantity::Rain(k))),
            Group::Drain(k) => model.set_drain(k, scalar(Quantity::Drain(k)) != 0.0),
        }
    }

    /// Passes all inputs that differ from their start values.
    ///
    /// # Errors
    /// A value that the model refuses.
    pub fn push_changed(&self, table: &Table, model: &mut Cosimulation) -> Result<(), CosimulationError> {
        let changed = |v: &&Variable| {
            let start = v.start.unwrap_or(0.0).to_bits();
            self.get(v.reference).iter().any(|value| value.to_bits() != start)
        };
        let mut groups: Vec<Group> =
            table.variables.iter().filter(changed).filter_map(|v| Group::of(v.quantity)).collect();
        groups.sort_unstable();
        groups.dedup();
        groups.into_iter().try_for_each(|group| self.push(table, group, model))
    }

    /// The force on a block is that of the arrays and of all ports on it together.
    fn push_blocks(&self, table: &Table, model: &mut Cosimulation) -> Result<(), CosimulationError> {
        let blocks = model.inputs().block_force.len();
        let (mut force, mut moment) = (vec![Vector::zeros(); blocks], vec![0.0; blocks]);
        let is_block = |k: usize| model.ports().get(k).is_some_and(|port| port.kind == PortKind::Block);
        let of_port = |k: usize| model.port_block(k).ok().filter(|_| is_block(k)).map(|block| block as usize);
        for v in &table.variables {
            let values = self.get(v.reference);
            if matches!(v.quantity, Quantity::BlockForce(_) | Quantity::BlockMoment) {
                check_parts(v, values, blocks)?;
            }
            match v.quantity {
                Quantity::BlockForce(axis) => {
                    force.iter_mut().zip(values).for_each(|(sum, value)| *component(sum, axis) += value);
                }
                Quantity::BlockMoment => moment.iter_mut().zip(values).for_each(|(sum, value)| *sum += value),
                Quantity::PortForce(k, axis) => {
                    of_port(k).into_iter().for_each(|block| *component(&mut force[block], axis) += values[0]);
                }
                Quantity::PortMoment(k) => of_port(k).into_iter().for_each(|block| moment[block] += values[0]),
                _ => {}
            }
        }
        let sums = force.into_iter().zip(moment).enumerate();
        model.set_block_forces(sums.map(|(block, (force, moment))| (block as u32, force, moment)))
    }
}

/// Refuses a load on a block into which rock has not broken yet.
fn check_parts(variable: &Variable, values: &[f64], blocks: usize) -> Result<(), CosimulationError> {
    let early = values.iter().enumerate().skip(blocks).find(|(_, value)| **value != 0.0);
    early.map_or(Ok(()), |(k, value)| {
        Err(CosimulationError::Value {
            name: format!("{}[{k}]", variable.name),
            value: Plain(*value).to_string(),
            limit: format!("0, since there are {blocks} blocks now"),
            remedy: "look at part_count before",
        })
    })
}

/// Whether a variable has numbers that can be set.
fn is_number(v: &Variable) -> bool {
    matches!(v.causality, Causality::Parameter | Causality::Input) && v.kind != Type::String
}

/// The inputs of the model, of which there are so many blocks, that a variable sets.
pub fn inputs_of(quantity: Quantity, blocks: usize) -> Vec<Input> {
    match quantity {
        Quantity::Gravity(_) => vec![Input::Gravity],
        Quantity::BaseAcceleration(_) => vec![Input::BaseAcceleration],
        Quantity::WaterLevel => vec![Input::WaterLevel],
        Quantity::StrengthFactor => vec![Input::StrengthFactor],
        Quantity::PortForce(k, _)
        | Quantity::PortMoment(k)
        | Quantity::PortTraction(k, _)
        | Quantity::PortPressure(k)
        | Quantity::PortVelocity(k, _) => vec![Input::Port(k as u32)],
        Quantity::Head(k) => vec![Input::Head(k as u32)],
        Quantity::Rain(k) => vec![Input::Rain(k as u32)],
        Quantity::Drain(k) => vec![Input::Drain(k as u32)],
        Quantity::BlockForce(_) | Quantity::BlockMoment => (0..blocks as u32).map(Input::Block).collect(),
        _ => Vec::new(),
    }
}

fn component(vector: &mut Vector, axis: Axis) -> &mut f64 {
    match axis {
        Axis::X => &mut vector.x,
        Axis::Y => &mut vector.y,
    }
}
