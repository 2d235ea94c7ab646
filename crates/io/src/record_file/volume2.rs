//! Corrected records of the California Geological Survey (CSMIP "Volume 2"): for each channel a head, and then
//! acceleration, velocity and displacement.
//!
//! Each part begins with a line such as `3000 points of accel data equally spaced at  .020 sec, in cm/sec2. (8f10.6)`
//! and the channel ends with `/&  ----------  End of data for channel  1  ----------`.

use enmm::model::case::record::BaseMotionKind;

use super::numbers::{Layout, count, leading};
use super::series::{Section, Series, channel, same_step};
use super::units::{Unit, known};
use super::wanted::{Fault, Wanted};

const SPACED: &str = "data equally spaced at";

/// Whether these lines are of such a file.
pub fn is(lines: &[&str]) -> bool {
    lines.iter().any(|line| kind(line).is_some())
}

/// The quantity of the part that a line begins.
fn kind(line: &str) -> Option<BaseMotionKind> {
    let line = line.to_lowercase();
    let (head, _) = line.split_once(SPACED)?;
    let kinds = [
        ("accel", BaseMotionKind::Acceleration),
        ("veloc", BaseMotionKind::Velocity),
        ("displ", BaseMotionKind::Displacement),
    ];
    kinds.into_iter().find_map(|(word, kind)| head.contains(word).then_some(kind))
}

/// Reads the lines of a file.
///
/// # Errors
/// It has no such part, or the part cannot be used.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let asked = wanted.kind.unwrap_or(BaseMotionKind::Velocity);
    let found = lines.iter().enumerate().filter(|(_, line)| kind(line) == Some(asked));
    let parts: Vec<usize> = found.map(|(k, _)| k).collect();
    if parts.is_empty() {
        return Err(Fault::File(format!("has no part with {} (`points of … {SPACED}`)", asked.name())));
    }
    let chosen = channel(wanted.reading.channel, parts.len(), asked.name())?;
    let at = parts[chosen];
    let line = lines[at].to_lowercase();
    let behind = line.split_once(SPACED).map_or("", |(_, rest)| rest);
    let (Some(points), Some(dt)) = (count(&line), leading(behind)) else {
        let message =
            "the line must be as in `3000 points of accel data equally spaced at .020 sec`; download it again";
        return Err(Fault::Line(at + 1, message.to_owned()));
    };
    let section = Section {
        lines,
        from: at + 1,
        count: Some((points, "points of its head")),
        dt: (dt, at + 1),
        layout: Layout::of(&line),
    };
    let mut series = section
        .read(|line| kind(line).is_some() || line.trim_start().starts_with('/') || line.contains("End of data"))?;
    same_step(wanted.reading.dt, dt)?;
    series.taken = if parts.len() > 1 { format!(", channel {}", chosen + 1) } else { String::new() };
    (series.kind, series.unit) = (Some(asked), unit(behind));
    if series.unit.is_none() && wanted.reading.unit.is_none() {
        let message = "the line names no unit that is known; state it, such as `record = { unit = \"cm/s2\" }`";
        return Err(Fault::Line(at + 1, message.to_owned()));
    }
    Ok(series)
}

/// The unit behind `in`, as in `.020 sec, in cm/sec2. (8f10.6)`.
fn unit(behind: &str) -> Option<Unit> {
    let (_, rest) = behind.split_once(" in ")?;
    known(rest.split('(').next().unwrap_or_default())
}
