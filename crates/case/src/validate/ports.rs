//! Checks of water and ports.

use super::checks::{each, only, points, segment, unique};
use crate::key::{Check, Key, fail, list};
use crate::{Case, Fix, Port, Water, WaterSurface};

/// Checks the water of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_water(key: &Key, water: &Water) -> Check {
    water.check(key)?;
    validate_surface(key, &water.surface())?;
    let Some(faces) = &water.faces else { return Ok(()) };
    each(&key.field("faces"), faces, segment)
}

/// Checks a surface of water.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_surface(key: &Key, surface: &WaterSurface) -> Check {
    surface.check(key)?;
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
pub fn validate_ports(key: &Key, case: &Case) -> Check {
    let ports = &case.ports;
    each(key, ports, validate_port)?;
    for (k, port) in ports.iter().enumerate() {
        validate_held(&key.index(k), case, port)?;
    }
    unique(key, "port", ports.iter().map(|port| Some(port.name.as_str())))
}

fn validate_port(key: &Key, port: &Port) -> Check {
    port.check(key)?;
    word(&key.field("name"), &port.name, "port")?;
    let places = [
        ("block", port.block.is_some()),
        ("boundary", port.boundary.is_some()),
        ("joint", port.joint.is_some()),
        ("quiet", port.quiet.is_some()),
        ("fix", port.fix.is_some()),
    ];
    let place = only(key, &places)?;
    port.boundary.as_ref().map_or(Ok(()), |edge| segment(&key.field("boundary"), edge))?;
    port.joint.as_ref().map_or(Ok(()), |edge| segment(&key.field("joint"), edge))?;
    validate_start(key, port, place)
}

/// Checks that a name can be part of names of variables.
///
/// # Errors
/// It has other signs than letters, digits and underscores.
pub fn word(key: &Key, name: &str, what: &str) -> Check {
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_of_word) {
        return Ok(());
    }
    let message = format!(
        "is {name:?}, must begin with a letter and go on with letters, digits and underscores: it becomes part of the \
         names of variables; rename the {what}"
    );
    fail(key, message)
}

/// Checks that the quiet boundary or the fixity of a port is there, and can be moved.
fn validate_held(key: &Key, case: &Case, port: &Port) -> Check {
    if let Some(edge) = port.quiet
        && case.quiet_of(edge).is_none()
    {
        let edges: Vec<String> = case.quiets.iter().map(|quiet| format!("{:?}", quiet.edge)).collect();
        let message =
            format!("is {edge:?}, must be the edge of a `[[quiet]]`: {}", list(edges.iter().map(String::as_str)));
        return fail(&key.field("quiet"), message);
    }
    let Some(name) = &port.fix else { return Ok(()) };
    let named = |fix: &&Fix| fix.name.as_ref() == Some(name);
    match case.fixes.iter().find(named) {
        None => {
            let names = list(case.fixes.iter().filter_map(|fix| fix.name.as_deref()));
            fail(&key.field("fix"), format!("is {name:?}, must be the name of a `[[fix]]`: {names}"))
        }
        Some(fix) if fix.point.is_none() && fix.edge.is_none() => {
            let message =
                format!("the fixity {name:?} is held without springs and cannot be moved; hold `point` or `edge`");
            fail(&key.field("fix"), message)
        }
        Some(_) => Ok(()),
    }
}

/// Checks that no values at the start are given but those of the kind of port.
fn validate_start(key: &Key, port: &Port, kind: &str) -> Check {
    let values = [
        ("force", port.force, ["block", "block"]),
        ("moment", [port.moment, 0.0], ["block", "block"]),
        ("traction", port.traction, ["boundary", "boundary"]),
        ("pressure", [port.pressure, 0.0], ["boundary", "joint"]),
    ];
    for (name, value, kinds) in values {
        if value != [0.0; 2] && !kinds.contains(&kind) {
            let message = format!("a port of kind `{kind}` takes no {name}; remove it, or use `{}`", kinds[0]);
            return fail(&key.field(name), message);
        }
    }
    Ok(())
}
