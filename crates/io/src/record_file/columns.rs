//! Records in columns: comments, a line of names and perhaps one of units, then rows of time and value, or of a value.

use enmm::model::case::record::{BaseMotionKind, TimeUnit};

use super::head::{Head, fields};
use super::numbers::number;
use super::series::{Series, step};
use super::wanted::{Fault, Wanted};
use crate::case_error::{is_numeric, shown};

/// Rows from which on a count instead of a time is no chance.
const COUNTED: usize = 10;
/// Layout of a row.
const ROW: &str = "each line holds time (s) and value, as in `0.02, 1.5`";

/// Columns of time and value, as indices.
#[derive(Debug, Clone, Copy)]
struct Columns {
    /// None where values are equally spaced.
    time: Option<usize>,
    value: usize,
}

/// Reads the lines of a file.
///
/// # Errors
/// A row without the numbers, a file without rows, or a head that leaves open which they are.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let (head, from) = Head::read(lines)?;
    let Some(first) = lines.get(from) else {
        return Err(Fault::Line(1, format!("the file has no numbers; {ROW}")));
    };
    if wanted.reading.channel.is_some() {
        let message = "belongs to a file with channels, and this one has columns; choose them by `record.columns`";
        return Err(Fault::Key("record.channel", message.to_owned()));
    }
    let width = fields(first).count();
    let (columns, mut warnings) = choose(&head, width, wanted)?;
    let dt = match (columns.time, wanted.reading.dt, head.step) {
        (None, None, Some((dt, line))) => Some(step(dt, line)?),
        (_, dt, _) => dt,
    };
    let mut series = rows(&lines[from..], from, columns, dt)?;
    let is_stated = wanted.reading.columns.is_some() || wanted.reading.time_unit.is_some();
    if columns.time == Some(0) && !is_stated {
        warnings.extend(counted(&series.times, &head, width)?);
    }
    let is_time = columns.time.is_some();
    series.time_unit = if is_time { head.time_unit(columns.time, wanted.reading)? } else { Some(TimeUnit::Second) };
    (series.kind, series.unit) = head.quantity(columns.value, wanted)?;
    series.warnings = warnings;
    series.taken = match columns.time {
        Some(time) => format!("s {} and {}", time + 1, columns.value + 1),
        None => format!(" {}", columns.value + 1),
    };
    series.taken += &head.note;
    Ok(series)
}

fn rows(lines: &[&str], before: usize, columns: Columns, dt: Option<f64>) -> Result<Series, Fault> {
    let mut series = Series::default();
    let needed = columns.time.map_or(0, |time| time + 1).max(columns.value + 1);
    for (k, line) in lines.iter().enumerate().map(|(k, line)| (before + k + 1, line.trim())) {
        if line.is_empty() || super::head::comment(line).is_some() {
            continue;
        }
        if line.contains(';') && line.contains(',') {
            let line = shown(line, is_numeric(line));
            let message = format!("{line} has commas and semicolons; write decimal points, as in `0.02, 1.5`");
            return Err(Fault::Line(k, message));
        }
        let (mut time, mut value) = (None, None);
        for (column, field) in fields(line).take(needed).enumerate() {
            let read = || number(field).map_err(|message| Fault::Line(k, format!("{message}; {ROW}")));
            match column {
                _ if columns.time == Some(column) => time = Some(read()?),
                _ if columns.value == column => value = Some(read()?),
                _ => {}
            }
        }
        let time = time.or_else(|| dt.map(|dt| dt * series.values.len() as f64));
        let (Some(time), Some(value)) = (time, value) else {
            return Err(Fault::Line(k, format!("the line has fewer than {needed} columns; {ROW}")));
        };
        series.times.push(time);
        series.values.push(value);
        series.lines.push(k);
    }
    Ok(series)
}

/// The columns by the case, else by names, else the first two; and what is to be warned of.
fn choose(head: &Head, width: usize, wanted: &Wanted) -> Result<(Columns, Vec<String>), Fault> {
    if let Some(columns) = &wanted.reading.columns {
        return asked(columns, width, wanted.reading.dt.is_some()).map(|columns| (columns, Vec::new()));
    }
    if wanted.reading.dt.is_some() && width > 1 {
        let message = format!(
            "is for values without times, and the file has {width} columns; name that of the values, such as \
             `columns = [2]`, or remove `dt`"
        );
        return Err(Fault::Key("record.dt", message));
    }
    if width == 1 {
        return match wanted.reading.dt.is_some() || head.step.is_some() {
            true => Ok((Columns { time: None, value: 0 }, Vec::new())),
            false => Err(Fault::Line(
                head.lines + 1,
                format!(
                    "the line has fewer than 2 columns; {ROW}, or give `record = {{ dt = 0.01 }}` for values alone"
                ),
            )),
        };
    }
    let names = head.names.as_slice();
    let times: Vec<usize> = (0..names.len()).filter(|k| names[*k].is_time()).collect();
    let time = match times.as_slice() {
        [] if names.first().is_some_and(|name| name.is_index()) => {
            let message = "has a first column of numbers of rows and none of times by its head; give \
                           `record = { columns = [2], dt = 0.01 }` with its time between values";
            return Err(Fault::File(message.to_owned()));
        }
        [] => 0,
        [time, ..] => *time,
    };
    let others: Vec<usize> =
        (0..width).filter(|k| *k != time && !names.get(*k).is_some_and(|n| n.is_index())).collect();
    let kind = wanted.kind.unwrap_or(BaseMotionKind::Velocity);
    let fitting: Vec<usize> =
        others.iter().copied().filter(|k| names.get(*k).and_then(|n| n.kind()) == Some(kind)).collect();
    let value = match (fitting.as_slice(), others.as_slice()) {
        ([only], _) => *only,
        (_, [first, ..]) => *others.iter().find(|k| **k > time).unwrap_or(first),
        _ => 1,
    };
    let is_open = others.len() > 1 && fitting.len() != 1;
    let warning = is_open.then(|| {
        format!(
            "the file has {width} columns, of which {} is read as time and {} as value; if others are meant, name \
             them, such as `record = {{ columns = [1, {}] }}`",
            time + 1,
            value + 1,
            others.iter().find(|k| **k != value).map_or(2, |k| k + 1)
        )
    });
    Ok((Columns { time: Some(time), value }, warning.into_iter().collect()))
}

/// The columns that the case asks for.
fn asked(columns: &[usize], width: usize, has_step: bool) -> Result<Columns, Fault> {
    let fault = |message: String| Err(Fault::Key("record.columns", message));
    if let Some(column) = columns.iter().find(|column| !(1..=width).contains(*column)) {
        return fault(format!("has {column}, must be at least 1 and at most {width}; the file has {width} columns"));
    }
    match (columns, has_step) {
        ([value], true) => Ok(Columns { time: None, value: value - 1 }),
        ([_], false) => fault(
            "has one column, and no `dt` gives the times; name columns of time and value, or give `dt`".to_owned(),
        ),
        ([time, value], false) if time != value => Ok(Columns { time: Some(time - 1), value: value - 1 }),
        ([_, _], true) => fault("has a column of times, and `dt` gives them too; leave one out".to_owned()),
        _ => fault("must be two different columns, of time and value, or with `dt` that of the value".to_owned()),
    }
}

/// Times that count 0, 1, 2, …: beside two more columns they are an index, unless the head says otherwise.
fn counted(times: &[f64], head: &Head, width: usize) -> Result<Option<String>, Fault> {
    let first = times.first().copied().unwrap_or_default();
    let counts = (first == 0.0 || first == 1.0) && times.iter().enumerate().all(|(k, time)| *time == first + k as f64);
    let is_named = head.names.first().is_some_and(|name| name.is_time());
    if !counts || times.len() < COUNTED || head.names.first().is_some_and(|name| name.time_unit().is_some()) {
        return Ok(None);
    }
    if width > 2 && !is_named {
        let message = "has a first column that counts 0, 1, 2, … beside two more: name those of time and value, such \
                       as `record = { columns = [2, 3] }`";
        return Err(Fault::File(message.to_owned()));
    }
    Ok(Some(
        "the times count 0, 1, 2, …: if they are numbers of rows, give `record = { columns = [2], dt = 0.01 }` with \
         the time between rows; if they are seconds, `record = { time_unit = \"s\" }`"
            .to_owned(),
    ))
}
