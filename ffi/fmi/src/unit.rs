//! The units of the table in the terms of a model description.

use crate::table::{Type, Variable};

/// A unit: exponents of kg, m, s and rad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit {
    /// Name in the table.
    pub name: &'static str,
    /// Physical quantity.
    pub quantity: &'static str,
    /// Exponents of kg, m, s, rad.
    pub exponents: [i8; 4],
}

const fn unit(name: &'static str, quantity: &'static str, exponents: [i8; 4]) -> Unit {
    Unit { name, quantity, exponents }
}

/// All units of the table. Forces, moments and energies are per metre of depth.
pub const UNITS: [Unit; 13] = [
    unit("1", "Ratio", [0; 4]),
    unit("s", "Time", [0, 0, 1, 0]),
    unit("m", "Length", [0, 1, 0, 0]),
    unit("m/s", "Velocity", [0, 1, -1, 0]),
    unit("m/s2", "Acceleration", [0, 1, -2, 0]),
    unit("rad", "Angle", [0, 0, 0, 1]),
    unit("rad/s", "AngularVelocity", [0, 0, -1, 1]),
    unit("kg/m3", "Density", [1, -3, 0, 0]),
    unit("N/m", "ForcePerLength", [1, 0, -2, 0]),
    unit("N.m/m", "MomentPerLength", [1, 1, -2, 0]),
    unit("J/m", "EnergyPerLength", [1, 1, -2, 0]),
    unit("Pa", "Pressure", [1, -1, -2, 0]),
    unit("Pa/m", "Stiffness", [1, -2, -2, 0]),
];

/// The unit of a variable; none for counts, marks and bytes.
pub fn of(variable: &Variable) -> Option<&'static Unit> {
    let name = if variable.unit.is_empty() && variable.kind == Type::Real { "1" } else { variable.unit };
    UNITS.iter().find(|unit| unit.name == name)
}

/// Name and factor of the unit in which people read a unit: shown value = factor × value.
pub fn display(name: &str) -> Option<(&'static str, f64)> {
    (name == "rad").then_some(("deg", 180.0 / std::f64::consts::PI))
}
