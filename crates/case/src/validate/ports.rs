//! Checks of water and ports.

use super::checks::{COORDINATE_MAX, Check, Range, fail, number, optional, point, points, segment, unique};
use crate::key::{Key, list};
use crate::limits::VALUE_MAX;
use crate::{Port, Water, WaterSurface};

/// Checks the water of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_water(key: &Key, water: &Water) -> Check {
    number(key, "density", water.density, Range::above(0.0).to(1e5), "kg/m³", "1000 is the default")?;
    validate_surface(key, &water.surface())?;
    let Some(faces) = &water.faces else { return Ok(()) };
    faces.iter().enumerate().try_for_each(|(i, face)| segment(&key.field("faces").index(i), face))
}

/// Checks a surface of water.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_surface(key: &Key, surface: &WaterSurface) -> Check {
    optional(key, "level", surface.level, Range::within(COORDINATE_MAX), "m", "the height y of the water surface")?;
    match (&surface.level, &surface.table) {
        (Some(_), None) => Ok(()),
        (None, Some(table)) => validate_table(&key.field("table"), table),
        (given, _) => {
            let count = if given.is_some() { 2 } else { 0 };
            let message = format!(
                "has {count} of `level` and `table`, must have exactly 1; give `level` for a level surface, or `table` \
                 for a sloping one"
            );
            fail(key, message)
        }
    }
}

/// Checks the points of a sloping surface.
fn validate_table(key: &Key, table: &[[f64; 2]]) -> Check {
    points(key, table, 2, "a water table")?;
    for (i, pair) in table.windows(2).enumerate() {
        if pair[1][0] <= pair[0][0] {
            let message = format!(
                "x is {} m, must be greater than {} m of the point before; give the points from left to right",
                pair[1][0], pair[0][0]
            );
            return fail(&key.index(i + 1), message);
        }
    }
    Ok(())
}

/// Checks the ports of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_ports(key: &Key, ports: &[Port]) -> Check {
    for (i, port) in ports.iter().enumerate() {
        validate_port(&key.index(i), port)?;
    }
    unique(key, "port", ports.iter().map(|port| Some(port.name.as_str())))
}

fn validate_port(key: &Key, port: &Port) -> Check {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !port.name.starts_with(|c: char| c.is_ascii_alphabetic()) || !port.name.chars().all(is_word) {
        let message = format!(
            "is {:?}, must begin with a letter and go on with letters, digits and underscores: it becomes part of the \
             names of variables; rename the port",
            port.name
        );
        return fail(&key.field("name"), message);
    }
    let places =
        [("block", port.block.is_some()), ("boundary", port.boundary.is_some()), ("joint", port.joint.is_some())];
    let given: Vec<&str> = places.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
    if given.len() != 1 {
        let message = format!(
            "has {} places ({}), must have exactly 1 of block, boundary, joint; keep or add one",
            given.len(),
            list(given.iter().copied())
        );
        return fail(key, message);
    }
    port.block.as_ref().map_or(Ok(()), |place| point(&key.field("block"), place))?;
    port.boundary.as_ref().map_or(Ok(()), |edge| segment(&key.field("boundary"), edge))?;
    port.joint.as_ref().map_or(Ok(()), |edge| segment(&key.field("joint"), edge))?;
    validate_start(key, port, given[0])
}

/// Checks the values at the start: in range, and none but those of the kind of port.
fn validate_start(key: &Key, port: &Port, kind: &str) -> Check {
    let hint = "what acts from the start";
    let values = [
        ("force", port.force, "N/m", ["block", "block"]),
        ("moment", [port.moment, 0.0], "N·m/m", ["block", "block"]),
        ("traction", port.traction, "Pa", ["boundary", "boundary"]),
        ("pressure", [port.pressure, 0.0], "Pa", ["boundary", "joint"]),
    ];
    for (name, value, unit, kinds) in values {
        value.iter().try_for_each(|v| number(key, name, *v, Range::within(VALUE_MAX), unit, hint))?;
        if value != [0.0; 2] && !kinds.contains(&kind) {
            let message = format!("a port of kind `{kind}` takes no {name}; remove it, or use `{}`", kinds[0]);
            return fail(&key.field(name), message);
        }
    }
    Ok(())
}
