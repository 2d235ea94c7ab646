//! Parameters of a model in the hands of a host. Before the start every one of them may change, by another build of the
//! model; after it those that are tunable, from the next step on. Values are part of the state.

use crate::model::case::{Case, Invalid};
use crate::state::State;

use super::{Cosimulation, CosimulationError, Parameter, apply, initial_stages, parameters};

/// Parameters of a model and their values.
#[derive(Debug, Clone)]
pub(super) struct Parameters {
    /// The parameters; their start values are those of the case as the model was built.
    pub list: Vec<Parameter>,
    /// Values now, in the same order.
    pub values: Vec<f64>,
    /// Fingerprint of the case without the values of its parameters.
    pub family: String,
}

impl Parameters {
    pub fn of(case: &Case) -> Result<Self, Invalid> {
        let list = parameters(case);
        let mut bare = case.clone();
        for parameter in &list {
            // The least value is always allowed.
            let _ = apply(&mut bare, parameter, parameter.low);
        }
        let values = list.iter().map(|parameter| parameter.start).collect();
        Ok(Self { list, values, family: bare.fingerprint()? })
    }
}

impl Cosimulation {
    /// Parameters of the case: rocks and joint laws by name, damping, tolerance, water, bolts.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters.list
    }

    /// Values of the parameters now, in their order; angles in radians.
    pub fn parameter_values(&self) -> &[f64] {
        &self.parameters.values
    }

    /// Index of the parameter of this name.
    ///
    /// # Errors
    /// No parameter has the name.
    pub fn find_parameter(&self, name: &str) -> Result<usize, CosimulationError> {
        let found = self.parameters.list.iter().position(|parameter| parameter.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = self.parameters.list.iter().map(|parameter| parameter.name.as_str()).collect();
            let limit = format!("one of {}", names.join(", "));
            CosimulationError::value("name of a parameter", format!("{name:?}"), &limit, "use one of these")
        })
    }

    /// Gives a parameter another value. Before the start the model is built anew with it, and inputs stay; after it the
    /// value acts from the next step on, until a stage of the case changes it.
    ///
    /// # Errors
    /// An index or a value out of range; after the start a parameter that is fixed; a value with which no model can be
    /// built. Nothing has changed then.
    pub fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), CosimulationError> {
        self.set_parameters(&[(index, value)])
    }

    /// Gives several parameters other values, or none of them when one is refused; before the start by one build.
    ///
    /// # Errors
    /// The first value that [`Cosimulation::set_parameter`] would refuse.
    pub fn set_parameters(&mut self, values: &[(usize, f64)]) -> Result<(), CosimulationError> {
        for &(index, value) in values {
            self.check_parameter(index, value)?;
        }
        let changes: Vec<(usize, f64)> = values
            .iter()
            .copied()
            .filter(|&(index, value)| value.to_bits() != self.parameters.values[index].to_bits())
            .collect();
        if changes.is_empty() {
            return Ok(());
        }
        if !self.progress.started {
            return self.build_with(&changes);
        }
        changes.into_iter().for_each(|(index, value)| self.tune(index, value));
        Ok(())
    }

    fn check_parameter(&self, index: usize, value: f64) -> Result<(), CosimulationError> {
        let Some(parameter) = self.parameters.list.get(index) else {
            let limit = format!("less than the number of parameters, {}", self.parameters.list.len());
            return Err(CosimulationError::value("parameter", index, &limit, "find it by its name"));
        };
        parameter.check(value).map_err(CosimulationError::Parameter)?;
        if self.progress.started && !parameter.is_tunable {
            let limit = "left as it is once the model has started";
            let remedy = "set it before the start, or give it in the case";
            return Err(CosimulationError::value(&parameter.name, value, limit, remedy));
        }
        Ok(())
    }

    /// Builds the model of the case with changed parameters and takes over the inputs.
    fn build_with(&mut self, changes: &[(usize, f64)]) -> Result<(), CosimulationError> {
        let mut case = self.case().clone();
        for &(index, value) in changes {
            apply(&mut case, &self.parameters.list[index], value).map_err(CosimulationError::Parameter)?;
        }
        let mut other = Self::new(case).map_err(CosimulationError::Stage)?;
        other.simulation.drive().clone_from(&self.simulation.state().drive);
        other.simulation.set_serial(self.pool.is_none());
        (other.progress, other.pool, other.serial) = (self.progress, self.pool.take(), self.serial + 1);
        other.watcher = std::mem::take(&mut self.watcher);
        *self = other;
        Ok(())
    }

    /// Gives a tunable parameter another value.
    fn tune(&mut self, index: usize, value: f64) {
        for tunable in self.parameters.list[index].tunables(self.simulation.case()) {
            self.simulation.tune(tunable, value);
        }
        self.parameters.values[index] = value;
        self.progress.changed = true;
    }

    /// Notes the values that the stage in progress has given to parameters.
    pub(super) fn note_stage(&mut self) {
        let (case, state) = (self.simulation.case(), self.simulation.state());
        let is_damped_otherwise = state.damping.is_some();
        for (parameter, value) in self.parameters.list.iter().zip(&mut self.parameters.values) {
            if let Some(new) = parameter.in_stage(case, state.stage as usize)
                && !(is_damped_otherwise && parameter.name == "damping")
            {
                *value = new;
            }
        }
    }

    /// Values that the parameters have in a stage of the case.
    pub(super) fn parameters_in(&self, stage: usize) -> Vec<f64> {
        let case = self.case();
        let reached = initial_stages(case) + 1..=stage.min(case.stages.len() - 1);
        let of_case = |parameter: &Parameter| {
            let last = reached.clone().rev().find_map(|stage| parameter.in_stage(case, stage));
            last.unwrap_or(parameter.start)
        };
        self.parameters.list.iter().map(of_case).collect()
    }

    /// Gives a state of this model, or of one that differs from it in parameters alone, the parameters that hold here.
    pub(super) fn give_parameters(&self, state: &mut State) {
        let (case, Parameters { list, values, .. }) = (self.case(), &self.parameters);
        let of_case = self.parameters_in(state.stage as usize);
        let others = list.iter().zip(values).zip(&of_case).filter(|((parameter, value), of_case)| {
            parameter.is_tunable && (parameter.is_switch() || value.to_bits() != of_case.to_bits())
        });
        let tunables = others
            .flat_map(|((parameter, value), _)| parameter.tunables(case).into_iter().map(move |what| (what, *value)));
        self.simulation.give_parameters(state, tunables);
    }
}
