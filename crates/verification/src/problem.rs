//! A verification problem and the values of its parameters.

use crate::{Outcome, Setup, Trouble};

/// A number that a user may change.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Name as `--set NAME=VALUE` takes it; angles end in `_deg`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Value that it has when nobody changes it.
    pub default: f64,
    /// Least and greatest value for which the problem makes sense.
    pub range: [f64; 2],
    /// Description.
    pub doc: &'static str,
}

impl Parameter {
    /// A parameter, its default value between the ends of its range.
    pub const fn new(name: &'static str, unit: &'static str, default: f64, range: [f64; 2], doc: &'static str) -> Self {
        Self { name, unit, default, range, doc }
    }
}

/// One problem of the manual.
pub struct Problem {
    /// Name of the problem, such as `C1`.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// The closed form or table, where it comes from, and what the problem catches.
    pub source: &'static str,
    /// Parameters that may be changed.
    pub parameters: &'static [Parameter],
    /// Whether it is part of the quick set.
    pub quick: bool,
    /// Whether the implicit integrator solves it as well.
    pub implicit: bool,
    /// Solves it.
    pub run: fn(&mut Setup) -> Result<Outcome, Trouble>,
}

/// Values of a problem's parameters, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Values(Vec<(&'static str, f64)>);

impl Values {
    /// The default values of a problem.
    pub fn of(problem: &Problem) -> Self {
        Self(problem.parameters.iter().map(|p| (p.name, p.default)).collect())
    }

    /// No values: of models that have no parameters.
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// The value of a parameter.
    ///
    /// # Panics
    /// When the problem has no such parameter: a mistake of the problem's author.
    pub fn get(&self, name: &str) -> f64 {
        self.0.iter().find(|(n, _)| *n == name).unwrap_or_else(|| panic!("no parameter {name}")).1
    }

    /// All names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.0.iter().copied()
    }

    /// Sets a parameter of a problem.
    ///
    /// # Errors
    /// An unknown name, or a value outside the range: what, the value, the limit, the remedy.
    pub fn set(&mut self, problem: &Problem, name: &str, value: f64) -> Result<(), Trouble> {
        let known = || problem.parameters.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
        let place = self.0.iter().position(|(n, _)| *n == name);
        let place =
            place.ok_or_else(|| Trouble(format!("{}: no parameter {name:?}; it has {}", problem.id, known())))?;
        let Parameter { unit, range: [low, high], .. } = problem.parameters[place];
        if !(low..=high).contains(&value) {
            let message = format!("{}: {name} is {value} {unit}, must be from {low} to {high} {unit}", problem.id);
            return Err(Trouble(message));
        }
        self.0[place].1 = value;
        Ok(())
    }
}
