//! Checks of base motions, quiet boundaries and free-field columns.

use super::checks::{Names, each, segment, table};
use crate::key::{Check, Key, fail};
use crate::limits::{ACCELERATION_MAX, VELOCITY_MAX};
use crate::record::RecordReading;
use crate::{BaseMotion, BaseMotionKind, Case, FreeField, Quiet, TimeTable};

/// The error about a key of a quiet boundary without a wave.
const NO_WAVE: &str = "belongs to a wave, and the boundary has none; add `wave = [1.0, 0.0]` or remove it";

/// Slope of a side, relative to its length, up to which it is vertical.
const VERTICAL: f64 = 1e-9;

/// Checks the motions of the base.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_base_motions(key: &Key, case: &Case) -> Check {
    each(key, &case.base_motions, |key, base| validate_base_motion(key, base, case))
}

fn validate_base_motion(key: &Key, base: &BaseMotion, case: &Case) -> Check {
    base.check(key)?;
    validate_reading(key, base.record.as_ref())?;
    let Some(rows) = &base.table else { return missing_table(key, base.file.is_some()) };
    belongs_to_a_file(key, base.record.is_some())?;
    let most = if base.kind == BaseMotionKind::Acceleration { ACCELERATION_MAX } else { VELOCITY_MAX };
    rows_within(key, rows, base.scale, most, base.kind.unit())?;
    if base.kind == BaseMotionKind::Velocity && rows[0][1] != 0.0 {
        let message = format!(
            "starts with {} m/s, must start with 0, as the base is at rest before; let the first row be `[{}, 0.0]`",
            rows[0][1], rows[0][0]
        );
        return fail(&key.field("table").index(0), message);
    }
    stage_is_dynamic(key, base.stage.as_deref(), case)
}

/// Checks the quiet boundaries.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_quiets(key: &Key, case: &Case) -> Check {
    each(key, &case.quiets, |key, quiet| validate_quiet(key, quiet, case))
}

fn validate_quiet(key: &Key, quiet: &Quiet, case: &Case) -> Check {
    quiet.check(key)?;
    segment(&key.field("edge"), &quiet.edge)?;
    validate_reading(key, quiet.record.as_ref())?;
    let Some(wave) = quiet.wave else {
        let given = [
            ("table", quiet.table.is_some()),
            ("file", quiet.file.is_some()),
            ("scale", quiet.scale != 1.0),
            ("stage", quiet.stage.is_some()),
            ("record", quiet.record.is_some()),
        ];
        let given = given.iter().find(|(_, there)| *there);
        return given.map_or(Ok(()), |(name, _)| fail(&key.field(name), NO_WAVE));
    };
    let Some(rows) = &quiet.table else { return missing_table(key, quiet.file.is_some()) };
    belongs_to_a_file(key, quiet.record.is_some())?;
    rows_within(key, rows, quiet.scale * libm::hypot(wave[0], wave[1]), VELOCITY_MAX, "m/s")?;
    stage_is_dynamic(key, quiet.stage.as_deref(), case)
}

/// Checks the free-field columns.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_free_fields(key: &Key, sides: &[FreeField]) -> Check {
    each(key, sides, |key, side| {
        side.check(key)?;
        let key = key.field("edge");
        segment(&key, &side.edge)?;
        let [a, b] = side.edge;
        if (b[0] - a[0]).abs() <= VERTICAL * (b[1] - a[1]).abs() {
            return Ok(());
        }
        let message = format!(
            "runs from ({}, {}) to ({}, {}), must be vertical: its column stands upright; give a side with one x",
            a[0], a[1], b[0], b[1]
        );
        fail(&key, message)
    })
}

fn validate_reading(key: &Key, reading: Option<&RecordReading>) -> Check {
    reading.map_or(Ok(()), |reading| reading.check(&key.field("record")))
}

/// Rows of the case need no reading.
fn belongs_to_a_file(key: &Key, is_given: bool) -> Check {
    let message = "says how a file is read, and the rows are in `table`; name a `file`, or remove it";
    if is_given { fail(&key.field("record"), message) } else { Ok(()) }
}

/// Fails for a ground motion without rows.
///
/// # Errors
/// Always.
pub(crate) fn missing_table(key: &Key, file: bool) -> Check {
    if file {
        let message = "the file is not read into the case; load the case through `io::load_case`, or give `table`";
        return fail(&key.field("file"), message);
    }
    fail(&key.field("table"), "is missing; add `table = [[0.0, 0.0], [1.0, 1.0]]` or `file = \"record.csv\"`")
}

/// Checks rows, their factor, and that no product of both is beyond `most`.
fn rows_within(key: &Key, rows: &TimeTable, scale: f64, most: f64, unit: &str) -> Check {
    at_least_two(key, rows)?;
    for (i, row) in rows.iter().enumerate() {
        if (row[1] * scale).abs() > most {
            let value = row[1] * scale;
            let message = format!("times `scale` is {value:e} {unit}, must be at most {most:e} in magnitude; scale it");
            return fail(&key.field("table").index(i), message);
        }
    }
    Ok(())
}

/// Checks times and values of a ground motion, of which there must be two.
///
/// # Errors
/// The first row that cannot be used.
pub(crate) fn at_least_two(key: &Key, rows: &TimeTable) -> Check {
    table(&key.field("table"), rows)?;
    if rows.len() < 2 {
        let message = "has 1 row, at least 2 are needed: values are zero outside the rows; add a row";
        return fail(&key.field("table"), message);
    }
    Ok(())
}

fn stage_is_dynamic(key: &Key, name: Option<&str>, case: &Case) -> Check {
    if let Some(name) = name {
        return Names::of_dynamic_stages(case).must_hold(&key.field("stage"), name);
    }
    match case.motion_stage(None) {
        Some(_) => Ok(()),
        None => fail(key, "the case has no dynamic stage, and waves and motions need one; add one or remove this"),
    }
}
