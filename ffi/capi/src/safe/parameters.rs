//! Parameters of the case by name.

use engine::cosimulation::Parameter;

use super::failure::{Failure, Outcome};
use super::model::Model;
use crate::types::enmm_status;

impl Model {
    /// Index of the parameter of this name.
    ///
    /// # Errors
    /// No parameter has the name.
    pub fn find_parameter(&self, name: &str) -> Result<u32, Failure> {
        let found = self.inner.find_parameter(name);
        found.map(|k| k as u32).map_err(|error| Failure::new(enmm_status::ENMM_NOT_FOUND, error.to_string()))
    }

    /// A parameter.
    ///
    /// # Errors
    /// No such parameter.
    pub fn parameter(&self, parameter: u32) -> Result<&Parameter, Failure> {
        let all = self.inner.parameters();
        all.get(parameter as usize).ok_or_else(|| {
            let count = all.len();
            let remedy = "find it by its name";
            Failure::invalid(format!("parameter: is {parameter}, must be less than their number, {count}; {remedy}"))
        })
    }

    /// Value of a parameter now.
    ///
    /// # Errors
    /// No such parameter.
    pub fn parameter_value(&self, parameter: u32) -> Result<f64, Failure> {
        self.parameter(parameter)?;
        Ok(self.inner.parameter_values()[parameter as usize])
    }

    /// Sets several parameters, or none of them.
    ///
    /// # Errors
    /// The first value that the façade refuses.
    pub fn set_parameters(&mut self, parameters: &[u32], values: &[f64]) -> Outcome {
        let pairs: Vec<(usize, f64)> = parameters.iter().map(|k| *k as usize).zip(values.iter().copied()).collect();
        Ok(self.inner.set_parameters(&pairs)?)
    }
}
