//! Files of the PEER database (AT2, VT2, DT2): a head that ends with a line of NPTS and DT, then values line by line.
//!
//! The four lines are described in <http://peer.berkeley.edu/smcat/data.html>; the third one names quantity and unit,
//! and the fourth is written `NPTS= 4000, DT= .0050 SEC` or `4000 0.0050 NPTS, DT`.

use enmm::model::case::record::BaseMotionKind;

use super::numbers::{Layout, count, leading};
use super::series::{Section, Series, channel, same_step};
use super::units::{Unit, known};
use super::wanted::{Fault, Wanted};

/// Lines of the longest heads.
const HEAD: usize = 12;

/// Whether these lines are of such a file.
pub fn is(lines: &[&str]) -> bool {
    last_line(lines).is_some()
}

/// The last line of the head, as an index.
fn last_line(lines: &[&str]) -> Option<usize> {
    lines.iter().take(HEAD).position(|line| {
        let line = line.to_uppercase();
        line.contains("NPTS") && line.contains("DT") && !line.starts_with(['#', '%', '!'])
    })
}

/// Reads the lines of a file.
///
/// # Errors
/// Its head or its values cannot be used.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let at = last_line(lines).unwrap_or(0);
    let (points, dt) = points_and_step(&lines[at].to_uppercase()).ok_or_else(|| {
        let message = "the numbers of NPTS and DT are missing; must be as in `NPTS= 4000, DT= .0050 SEC`";
        Fault::Line(at + 1, message.to_owned())
    })?;
    channel(wanted.reading.channel, 1, "motion")?;
    let section =
        Section { lines, from: at + 1, count: Some((points, "NPTS")), dt: (dt, at + 1), layout: Layout { width: 15 } };
    let mut series = section.read(|_| false)?;
    same_step(wanted.reading.dt, dt)?;
    let told = lines[..at].iter().rev().find_map(|line| Some((quantity(line)?, *line)));
    if let Some((kind, line)) = told {
        (series.kind, series.unit) = (Some(kind), unit(line));
        if series.unit.is_none() && wanted.reading.unit.is_none() {
            let message = "has a head without a unit that is known; state it, such as `record = { unit = \"g\" }`";
            return Err(Fault::File(message.to_owned()));
        }
    }
    Ok(series)
}

fn points_and_step(line: &str) -> Option<(usize, f64)> {
    let behind = |name: &str| line.split_once(name).map(|(_, rest)| rest);
    if let (Some(points), Some(dt)) = (behind("NPTS").and_then(count), behind("DT").and_then(leading)) {
        return Some((points, dt));
    }
    let mut words = line.split([' ', '\t', ',']).filter(|word| !word.is_empty());
    Some((count(words.next()?)?, leading(words.next()?)?))
}

fn quantity(line: &str) -> Option<BaseMotionKind> {
    let line = line.to_uppercase();
    let is_of = |word: &str| line.contains(word) && (line.contains("TIME") || line.contains("UNITS"));
    let kinds = [
        ("ACCELERATION", BaseMotionKind::Acceleration),
        ("VELOCITY", BaseMotionKind::Velocity),
        ("DISPLACEMENT", BaseMotionKind::Displacement),
    ];
    kinds.into_iter().find_map(|(word, kind)| is_of(word).then_some(kind))
}

/// The unit behind `UNITS OF`, or in brackets.
fn unit(line: &str) -> Option<Unit> {
    let upper = line.to_uppercase();
    let behind = upper.split_once("UNITS OF").map(|(_, rest)| rest.trim_start());
    let word = |text: &str| text.split([' ', ',', '\t']).next().and_then(|word| known(word.trim_end_matches('.')));
    let bracket = || upper.split_once('(').and_then(|(_, rest)| known(rest.split(')').next().unwrap_or_default()));
    behind.and_then(|rest| known(rest).or_else(|| word(rest))).or_else(bracket)
}
