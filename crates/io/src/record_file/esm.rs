//! ESM and ITACA ASCII (DYNA): lines of `KEY: value`, then a value on each line.
//!
//! Heads as the Engineering Strong Motion database writes them (`HEADER_FORMAT: DYNA 1.2`) have the time between
//! values in `SAMPLING_INTERVAL_S`, their number in `NDATA`, their unit in `UNITS` and `DATA_TYPE`.

use enmm::model::case::record::BaseMotionKind;

use super::numbers::{Layout, count, leading};
use super::series::{HEAD_LINES, Section, Series, channel, same_step};
use super::units::known;
use super::wanted::{Fault, Wanted};

const STEP: &str = "SAMPLING_INTERVAL_S";

/// Whether these lines are of such a file.
pub fn is(lines: &[&str]) -> bool {
    find(lines, STEP).is_some()
}

/// The value of a key and its line as an index.
fn find<'a>(lines: &[&'a str], key: &str) -> Option<(usize, &'a str)> {
    let value = |line: &'a str| {
        let (name, value) = line.split_once(':')?;
        (name.trim() == key).then_some(value.trim())
    };
    lines.iter().enumerate().take(HEAD_LINES).find_map(|(k, line)| Some((k, value(line)?)))
}

/// Reads the lines of a file.
///
/// # Errors
/// Its head or its values cannot be used.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let (at, step) = find(lines, STEP).unwrap_or((0, ""));
    let dt = leading(step).ok_or_else(|| {
        Fault::Line(at + 1, "the time between values is missing; must be as in `SAMPLING_INTERVAL_S: 0.005`".to_owned())
    })?;
    let from = lines.iter().position(|line| !line.trim().is_empty() && !line.contains(':')).unwrap_or(lines.len());
    channel(wanted.reading.channel, 1, "motion")?;
    let points = find(lines, "NDATA").and_then(|(_, text)| count(text)).map(|points| (points, "NDATA"));
    let section = Section { lines, from, count: points, dt: (dt, at + 1), layout: Layout::default() };
    let mut series = section.read(|_| false)?;
    same_step(wanted.reading.dt, dt)?;
    series.unit = find(lines, "UNITS").and_then(|(_, text)| known(text));
    if series.unit.is_none() && wanted.reading.unit.is_none() {
        let line = find(lines, "UNITS").map_or(1, |(k, _)| k + 1);
        let message = "the head has no unit that is known in UNITS; state it, such as `record = { unit = \"cm/s2\" }`";
        return Err(Fault::Line(line, message.to_owned()));
    }
    series.kind = find(lines, "DATA_TYPE").and_then(|(_, text)| match text.to_uppercase().as_str() {
        "ACCELERATION" => Some(BaseMotionKind::Acceleration),
        "VELOCITY" => Some(BaseMotionKind::Velocity),
        "DISPLACEMENT" => Some(BaseMotionKind::Displacement),
        _ => None,
    });
    Ok(series)
}
