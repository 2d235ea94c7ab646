//! Units of the numbers of a case, and the slips that people make in them.

/// A unit.
#[derive(Debug, Clone, Copy)]
pub struct Unit {
    /// Its name in messages, such as `degrees`; empty for pure numbers.
    pub name: &'static str,
    /// Its sign behind a number, such as `°`.
    pub sign: &'static str,
    /// What a number may have been meant in, and by what it must be multiplied then.
    pub slips: &'static [(&'static str, f64)],
}

const fn unit(name: &'static str, slips: &'static [(&'static str, f64)]) -> Unit {
    Unit { name, sign: name, slips }
}

pub const NUMBER: Unit = unit("", &[]);
pub const PASCAL: Unit = unit("Pa", &[("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("Pa times 1000", 1e-3)]);
pub const NEWTON: Unit = unit("N", &[("kN", 1e3), ("MN", 1e6), ("mN", 1e-3)]);
pub const NEWTON_PER_METRE: Unit = unit("N/m", &[("kN/m", 1e3), ("MN/m", 1e6), ("mN/m", 1e-3)]);
pub const MOMENT: Unit = unit("N·m/m", &[]);
pub const METRE: Unit = unit("m", &[("mm", 1e-3), ("cm", 1e-2), ("km", 1e3)]);
pub const SQUARE_METRE: Unit = unit("m²", &[("mm²", 1e-6), ("cm²", 1e-4), ("mm² divided by 1000", 1e-3)]);
pub const DEGREE: Unit = Unit { name: "degrees", sign: "°", slips: &[] };
pub const DENSITY: Unit = unit("kg/m³", &[("t/m³", 1e3), ("kN/m³", 1e3 / 9.81), ("N/m³", 1.0 / 9.81), ("g/m³", 1e-3)]);
pub const PASCAL_PER_METRE: Unit = unit("Pa/m", &[("kPa/m", 1e3), ("MPa/m", 1e6), ("GPa/m", 1e9)]);
pub const ACCELERATION: Unit = unit("m/s²", &[("cm/s²", 1e-2), ("mm/s²", 1e-3), ("km/s²", 1e3)]);
pub const SPEED: Unit = unit("m/s", &[("cm/s", 1e-2), ("mm/s", 1e-3)]);
pub const TURN: Unit = unit("rad/s", &[]);
pub const SECOND: Unit = unit("s", &[("ms", 1e-3), ("hours", 3600.0)]);
pub const ENERGY: Unit = unit("J/m²", &[("kJ/m²", 1e3), ("N/mm", 1e3)]);
pub const VISCOSITY: Unit = unit("Pa s", &[("mPa s", 1e-3)]);
pub const BYTE: Unit = unit("bytes", &[]);
/// Stiffness of a support: of one at a point, or of one along an edge.
pub const SUPPORT: Unit = unit("N/m per metre or Pa/m", &[]);
