//! Checks of fixities and loads: exactly one place, and what the kind needs and nothing else.

use super::checks::{each, only, segment, table, unique};
use crate::key::{Check, Key, fail, list};
use crate::keys::Plain;
use crate::{Fix, Load, LoadKind};

/// Checks the fixities of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_fixes(key: &Key, fixes: &[Fix]) -> Check {
    each(key, fixes, validate_fix)?;
    unique(key, "fixity", fixes.iter().map(|fix| fix.name.as_deref()))
}

fn validate_fix(key: &Key, fix: &Fix) -> Check {
    fix.check(key)?;
    let places = [
        ("point", fix.point.is_some()),
        ("edge", fix.edge.is_some()),
        ("box", fix.region.is_some()),
        ("block", fix.block.is_some()),
    ];
    let place = only(key, &places)?;
    fix.edge.as_ref().map_or(Ok(()), |edge| segment(&key.field("edge"), edge))?;
    fix.region.as_ref().map_or(Ok(()), |region| rectangle(&key.field("box"), region))?;
    if fix.stiffness.is_some() && (fix.region.is_some() || fix.block.is_some()) {
        let message = format!("`{place}` is held without springs; remove `stiffness`, or hold `point` or `edge`");
        return fail(&key.field("stiffness"), message);
    }
    if fix.velocity.is_some() && (fix.region.is_some() || fix.block.is_some()) {
        let message = format!("`{place}` is held without springs and cannot be moved; hold `point` or `edge`");
        return fail(&key.field("velocity"), message);
    }
    if fix.name.is_none() && !fix.active {
        return fail(
            &key.field("active"),
            "is false, and without a name no stage can activate the fixity; add `name` or remove `active`",
        );
    }
    Ok(())
}

fn rectangle(key: &Key, [x_min, y_min, x_max, y_max]: &[f64; 4]) -> Check {
    for (axis, low, high) in [("x", x_min, x_max), ("y", y_min, y_max)] {
        if low >= high {
            let message = format!(
                "{axis}min is {} m, must be less than {axis}max, which is {} m; the order is [xmin, ymin, xmax, ymax]",
                Plain(*low),
                Plain(*high)
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
        load.check(&key)?;
        load.edge.as_ref().map_or(Ok(()), |edge| segment(&key.field("edge"), edge))?;
        load.table.as_ref().map_or(Ok(()), |rows| table(&key.field("table"), rows))?;
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
