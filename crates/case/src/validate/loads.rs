//! Checks of fixities and loads: exactly one place, and what the kind needs and nothing else.

use super::checks::{Check, Range, fail, number, optional, point, segment, table, unique};
use crate::key::{Key, list};
use crate::{Fix, Load, LoadKind};

/// Checks the fixities of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_fixes(key: &Key, fixes: &[Fix]) -> Check {
    for (i, fix) in fixes.iter().enumerate() {
        validate_fix(&key.index(i), fix)?;
    }
    unique(key, "fixity", fixes.iter().map(|fix| fix.name.as_deref()))
}

fn validate_fix(key: &Key, fix: &Fix) -> Check {
    let places = [
        ("point", fix.point.is_some()),
        ("edge", fix.edge.is_some()),
        ("box", fix.region.is_some()),
        ("block", fix.block.is_some()),
    ];
    let given: Vec<&str> = places.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
    if given.len() != 1 {
        let message = format!(
            "has {} places ({}), must have exactly 1 of point, edge, box, block; keep or add one",
            given.len(),
            list(given.iter().copied())
        );
        return fail(key, message);
    }
    fix.point.as_ref().map_or(Ok(()), |place| point(&key.field("point"), place))?;
    fix.block.as_ref().map_or(Ok(()), |place| point(&key.field("block"), place))?;
    fix.edge.as_ref().map_or(Ok(()), |edge| segment(&key.field("edge"), edge))?;
    fix.region.as_ref().map_or(Ok(()), |region| rectangle(&key.field("box"), region))?;
    if fix.stiffness.is_some() && (fix.region.is_some() || fix.block.is_some()) {
        let message = format!("`{}` is held without springs; remove `stiffness`, or hold `point` or `edge`", given[0]);
        return fail(&key.field("stiffness"), message);
    }
    if fix.name.is_none() && !fix.active {
        return fail(
            &key.field("active"),
            "is false, and without a name no stage can activate the fixity; add `name` or remove `active`",
        );
    }
    optional(key, "stiffness", fix.stiffness, Range::above(0.0).to(1e20), "", "leave it out for the default")
}

fn rectangle(key: &Key, [x_min, y_min, x_max, y_max]: &[f64; 4]) -> Check {
    point(key, &[*x_min, *y_min])?;
    point(key, &[*x_max, *y_max])?;
    for (axis, low, high) in [("x", x_min, x_max), ("y", y_min, y_max)] {
        if low >= high {
            let message = format!(
                "{axis}min is {low} m, must be less than {axis}max, which is {high} m; the order is \
                 [xmin, ymin, xmax, ymax]"
            );
            return fail(key, message);
        }
    }
    Ok(())
}

/// Checks the loads of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_loads(key: &Key, loads: &[Load]) -> Check {
    for (i, load) in loads.iter().enumerate() {
        let key = key.index(i);
        validate_fields(&key, load)?;
        validate_values(&key, load)?;
    }
    unique(key, "load", loads.iter().map(|load| load.name.as_deref()))
}

/// Whether a kind of load uses a field.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    No,
    May,
    Must,
}

/// Returns the name of a kind and its use of `point`, `edge`, `force`, `moment`, `traction`, `pressure`,
/// `pressure_end` and `acceleration`.
fn fields_of(kind: LoadKind) -> (&'static str, [Use; 8]) {
    use Use::{May, Must, No};
    match kind {
        LoadKind::Point => ("point", [Must, No, Must, No, No, No, No, No]),
        LoadKind::Traction => ("traction", [No, Must, No, No, Must, No, No, No]),
        LoadKind::Pressure => ("pressure", [No, Must, No, No, No, Must, No, No]),
        LoadKind::Body => ("body", [No, No, No, No, No, No, No, Must]),
        LoadKind::Block => ("block", [Must, No, May, May, No, No, No, No]),
        LoadKind::Joint => ("joint", [No, Must, No, No, No, Must, May, No]),
    }
}

fn validate_fields(key: &Key, load: &Load) -> Check {
    let (kind, uses) = fields_of(load.kind);
    let given = [
        ("point", load.point.is_some()),
        ("edge", load.edge.is_some()),
        ("force", load.force.is_some()),
        ("moment", load.moment.is_some()),
        ("traction", load.traction.is_some()),
        ("pressure", load.pressure.is_some()),
        ("pressure_end", load.pressure_end.is_some()),
        ("acceleration", load.acceleration.is_some()),
    ];
    for ((name, there), wanted) in given.into_iter().zip(uses) {
        match (there, wanted) {
            (true, Use::No) => {
                let used = given.iter().zip(uses).filter(|(_, wanted)| *wanted != Use::No).map(|((name, _), _)| *name);
                let message = format!("a load of kind {kind} has {}, not `{name}`; remove it", list(used));
                return fail(&key.field(name), message);
            }
            (false, Use::Must) => {
                return fail(key, format!("a load of kind {kind} needs `{name}`, which is not given; add `{name}`"));
            }
            _ => {}
        }
    }
    if load.kind == LoadKind::Block && load.force.is_none() && load.moment.is_none() {
        return fail(key, "a load of kind block needs `force` or `moment`, neither is given; add one");
    }
    Ok(())
}

fn validate_values(key: &Key, load: &Load) -> Check {
    load.point.as_ref().map_or(Ok(()), |place| point(&key.field("point"), place))?;
    load.edge.as_ref().map_or(Ok(()), |edge| segment(&key.field("edge"), edge))?;
    for (name, pair, size, unit, hint) in [
        ("force", load.force, 1e15, "N/m", "up and right are positive"),
        ("traction", load.traction, 1e12, "Pa", "up and right are positive"),
        ("acceleration", load.acceleration, 1e6, "m/s²", "up and right are positive"),
    ] {
        for (i, value) in pair.into_iter().flatten().enumerate() {
            number(&key.field(name).index(i), "", value, Range::within(size), unit, hint)?;
        }
    }
    optional(key, "moment", load.moment, Range::within(1e18), "N·m/m", "counter-clockwise is positive")?;
    optional(key, "pressure", load.pressure, Range::within(1e12), "Pa", "into the rock is positive")?;
    optional(key, "pressure_end", load.pressure_end, Range::within(1e12), "Pa", "leave it out for `pressure`")?;
    load.table.as_ref().map_or(Ok(()), |rows| table(&key.field("table"), rows))
}
