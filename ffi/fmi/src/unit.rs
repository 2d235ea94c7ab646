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
pub const UNITS: [Unit; 15] = [
    unit("1", "Ratio", [0; 4]),
    unit("s", "Time", [0, 0, 1, 0]),
    unit("m", "Length", [0, 1, 0, 0]),
    unit("m2", "Area", [0, 2, 0, 0]),
    unit("m2/s", "FlowPerLength", [0, 2, -1, 0]),
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

/// A unit in which people read another: shown value = factor × value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    /// Name.
    pub name: &'static str,
    /// The unit that it stands for.
    pub of: &'static str,
    /// Factor.
    pub factor: f64,
}

/// All units in which people read others.
pub const DISPLAYS: [Display; 7] = [
    Display { name: "deg", of: "rad", factor: 180.0 / std::f64::consts::PI },
    Display { name: "mm", of: "m", factor: 1e3 },
    Display { name: "kPa", of: "Pa", factor: 1e-3 },
    Display { name: "MPa", of: "Pa", factor: 1e-6 },
    Display { name: "kN/m", of: "N/m", factor: 1e-3 },
    Display { name: "kN.m/m", of: "N.m/m", factor: 1e-3 },
    Display { name: "kJ/m", of: "J/m", factor: 1e-3 },
];

/// Least start value (Pa) of moduli, which people read in MPa.
const MODULUS: f64 = 1e7;

/// The unit in which people read a variable, if it is another than its own.
pub fn display(variable: &Variable) -> Option<&'static Display> {
    let is_large = variable.start.is_some_and(|start| start.abs() >= MODULUS);
    let name = match variable.unit {
        "m" if !variable.is_motion() => return None,
        "Pa" if is_large => "MPa",
        unit => DISPLAYS.iter().find(|display| display.of == unit)?.name,
    };
    DISPLAYS.iter().find(|display| display.name == name)
}
