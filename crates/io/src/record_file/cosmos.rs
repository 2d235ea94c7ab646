//! COSMOS format, corrected records (V2, `.v2c`): lines of text, integers and reals, then the values of one quantity;
//! channels and quantities may follow each other in one file.
//!
//! *COSMOS Strong Motion Data Format*, version 1.20 (2001): the 34th of the reals is the time between values, and the
//! values begin behind a line such as `6000 acceleration pts, approx  60 secs, units=cm/sec2 (04),Format=(8F10.5)`.

use enmm::model::case::keys::{Plain, rounded};
use enmm::model::case::record::BaseMotionKind;

use super::numbers::{Layout, count, leading, numbers};
use super::series::{Section, Series, channel, same_step};
use super::units::known;
use super::wanted::{Fault, Wanted};

/// Index of the time between values among the reals.
const STEP: usize = 33;
const APPROXIMATELY: &str = "pts, approx";

/// Whether these lines are of such a file.
pub fn is(lines: &[&str]) -> bool {
    lines.iter().any(|line| quantity(line).is_some())
}

/// The quantity of the values that a line begins.
fn quantity(line: &str) -> Option<BaseMotionKind> {
    let line = line.to_lowercase();
    let (head, _) = line.split_once(APPROXIMATELY)?;
    let kinds = [BaseMotionKind::Acceleration, BaseMotionKind::Velocity, BaseMotionKind::Displacement];
    kinds.into_iter().find(|kind| head.contains(kind.name()))
}

/// Reads the lines of a file.
///
/// # Errors
/// It has no such quantity, or its head or its values cannot be used.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let asked = wanted.kind.unwrap_or(BaseMotionKind::Velocity);
    let found = lines.iter().enumerate().filter(|(_, line)| quantity(line) == Some(asked));
    let parts: Vec<usize> = found.map(|(k, _)| k).collect();
    if parts.is_empty() {
        return Err(Fault::File(format!(
            "has no {} (`{} pts`); name the file that has it",
            asked.name(),
            asked.name()
        )));
    }
    let chosen = channel(wanted.reading.channel, parts.len(), asked.name())?;
    let at = parts[chosen];
    let line = lines[at].to_lowercase();
    let points = count(&line).ok_or_else(|| {
        Fault::Line(at + 1, format!("the number of values is missing; must be as in `6000 {} pts`", asked.name()))
    })?;
    let (dt, dt_line) = step(lines, at, points, wanted)?;
    let layout = Layout::of(&line);
    let section =
        Section { lines, from: at + 1, count: Some((points, "points of its head")), dt: (dt, dt_line), layout };
    let mut series = section.read(|line| line.to_lowercase().contains("end-of-data") || line.starts_with('/'))?;
    same_step(wanted.reading.dt, dt)?;
    let unit = line.split_once("units=").map_or("", |(_, rest)| rest.split(['(', ',']).next().unwrap_or_default());
    series.taken = if parts.len() > 1 { format!(", channel {}", chosen + 1) } else { String::new() };
    (series.kind, series.unit) = (Some(asked), known(unit));
    if series.unit.is_none() && wanted.reading.unit.is_none() {
        let message = "the line names no unit of motion that is known: raw counts are not corrected records; download \
                       the corrected one, or state `record = { unit = \"cm/s2\" }`";
        return Err(Fault::Line(at + 1, message.to_owned()));
    }
    Ok(series)
}

/// The time between values before line `at`, and the line (counted from 1) that has it.
fn step(lines: &[&str], at: usize, points: usize, wanted: &Wanted) -> Result<(f64, usize), Fault> {
    let reals = (0..at).rev().find(|k| lines[*k].to_lowercase().contains("real-header values"));
    let mut seen = 0;
    for (k, line) in lines[..at].iter().enumerate().skip(reals.map_or(at, |k| k + 1)) {
        let layout = Layout::of(reals.map_or("", |k| lines[k]).replace("= ", "=").as_str());
        let found = numbers(line, layout).map_err(|message| Fault::Line(k + 1, message))?;
        match found.get(STEP - seen) {
            // -999 stands for what is not known.
            Some(dt) if *dt > 0.0 => return plausible(*dt, k + 1, &lines[at].to_lowercase(), points),
            Some(_) => break,
            None => seen += found.len(),
        }
    }
    match wanted.reading.dt {
        Some(dt) => Ok((dt, at + 1)),
        None => Err(Fault::File(
            "has no time between values in its head; give it, such as `record = { dt = 0.01 }`".to_owned(),
        )),
    }
}

/// A time between values by which the record lasts as long as the line before them says.
fn plausible(dt: f64, line: usize, told: &str, points: usize) -> Result<(f64, usize), Fault> {
    let seconds = told.split_once("approx").and_then(|(_, rest)| leading(rest)).filter(|seconds| *seconds > 0.0);
    let lasts = dt * points as f64;
    match seconds {
        // The line has whole seconds.
        Some(seconds) if (lasts - seconds).abs() > 1.5 + 0.02 * seconds => {
            let message = format!(
                "the time between values is {} s, by which the record lasts {} s, and it says approx {} s; correct the \
                 head",
                Plain(dt),
                rounded(lasts),
                Plain(seconds)
            );
            Err(Fault::Line(line, message))
        }
        _ => Ok((dt, line)),
    }
}
