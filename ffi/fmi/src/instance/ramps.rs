//! Time derivatives of inputs (FMI 2): inputs that move linearly through the next step from the values that were set.

use enmm::cosimulation::Interpolation;

use crate::log::Status;
use crate::phase::Call;
use crate::table::{Causality, Type};
use crate::values::{Group, inputs_of};

use super::{Failure, Instance};

/// Time derivative of an input, for one step: value reference and value per second.
pub(super) type Rate = (u32, f64);

impl Instance {
    /// Sets first time derivatives of inputs. They hold for the next step, at whose end the inputs stay.
    pub fn set_derivatives(&mut self, references: &[u32], orders: &[i32], rates: &[f64]) -> Status {
        let given = || references.iter().zip(orders).zip(rates);
        let legal = self.allow(Call::Set);
        let checked =
            legal.and_then(|()| given().try_for_each(|((&k, &order), &rate)| self.check_rate(k, order, rate)));
        if checked.is_ok() {
            for ((&reference, _), &rate) in given() {
                self.rates.retain(|(other, _)| *other != reference);
                self.rates.push((reference, rate));
            }
        }
        self.end(checked)
    }

    fn check_rate(&self, reference: u32, order: i32, rate: f64) -> Result<(), Failure> {
        let v = self.variable(reference, Type::Real)?;
        let name = &v.name;
        if v.causality != Causality::Input {
            return Err(format!("{name}: is no input; only inputs have derivatives that can be set"));
        }
        if order != 1 {
            return Err(format!("{name}: the order of the derivative is {order}, must be 1: inputs go linearly"));
        }
        if !rate.is_finite() {
            return Err(format!("{name}: the derivative is {rate}, must be a finite number"));
        }
        Ok(())
    }

    /// Whether rates that were saved can be set.
    pub(super) fn check_rates(&self, rates: &[Rate]) -> Result<(), Failure> {
        rates.iter().try_for_each(|&(reference, rate)| self.check_rate(reference, 1, rate))
    }

    /// Sends inputs that have a derivative on their way through a step over `h` (s); returns their values at its end.
    pub(super) fn begin_ramps(&mut self, h: f64) -> Result<Vec<Rate>, Failure> {
        let ends: Vec<Rate> = self.rates.iter().map(|&(k, rate)| (k, self.values.get(k)[0] + rate * h)).collect();
        for &(reference, end) in &ends {
            self.variable(reference, Type::Real)?
                .check(end)
                .map_err(|fault| format!("at the end of the step, {fault}"))?;
        }
        let mut moved = self.values.clone();
        ends.iter().for_each(|&(reference, end)| moved.set(reference, &[end]));
        for &(reference, _) in &ends {
            let quantity = self.variable(reference, Type::Real)?.quantity;
            let Some(group) = Group::of(quantity) else { continue };
            let failed = |error: enmm::cosimulation::CosimulationError| error.to_string();
            self.values.push(&self.table, group, &mut self.model).map_err(failed)?;
            for input in inputs_of(quantity, 0) {
                self.model.jump_of(input).map_err(failed)?;
                self.model.set_interpolation_of(input, Interpolation::Linear).map_err(failed)?;
            }
            moved.push(&self.table, group, &mut self.model).map_err(failed)?;
        }
        Ok(ends)
    }

    /// Leaves inputs where their ways have ended.
    pub(super) fn end_ramps(&mut self, ends: &[Rate]) {
        let common = self.model.interpolation();
        for &(reference, end) in ends {
            self.values.set(reference, &[end]);
            let inputs = self.table.get(reference).map_or_else(Vec::new, |v| inputs_of(v.quantity, 0));
            // These inputs have taken an interpolation before.
            inputs.into_iter().for_each(|input| drop(self.model.set_interpolation_of(input, common)));
        }
        self.rates.clear();
    }
}
