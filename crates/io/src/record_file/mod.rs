//! Readers of records of ground motion: [`FORMATS`] lists the formats, which are known by what a file holds.

mod columns;
mod cosmos;
mod esm;
mod head;
mod knet;
mod numbers;
mod peer;
mod series;
mod units;
mod volume2;
mod wanted;

use std::path::Path;

use enmm::model::case::TimeTable;
use enmm::model::case::record::{BaseMotionKind, RecordReading, TimeUnit};

use series::Series;
pub use wanted::{Fault, Wanted};

/// A record in SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Time (s) and value.
    pub rows: TimeTable,
    /// Line of each row, counted from 1.
    pub lines: Vec<usize>,
    /// Name of its format, and what of it was read.
    pub format: String,
    /// Unit of the values in the file, and who says so: `in g as its head says`.
    pub unit: String,
    /// Whether file or case name the unit of the times.
    pub time_is_stated: bool,
    /// Doubts about it.
    pub warnings: Vec<String>,
}

/// A format of records.
struct Format {
    name: &'static str,
    /// Ends of file names that stand for it, in small letters.
    endings: &'static [&'static str],
    /// Whether the first lines of a file are of it.
    is: fn(&[&str]) -> bool,
    read: fn(&[&str], &Wanted) -> Result<Series, Fault>,
}

/// Formats of agencies; a file that is none of them has columns.
const FORMATS: [Format; 5] = [
    Format { name: "PEER", endings: &["at2", "vt2", "dt2"], is: peer::is, read: peer::read },
    Format { name: "COSMOS V2", endings: &["v2c"], is: cosmos::is, read: cosmos::read },
    Format { name: "CSMIP V2", endings: &["v2"], is: volume2::is, read: volume2::read },
    Format { name: "ESM ASCII", endings: &[], is: esm::is, read: esm::read },
    Format {
        name: "K-NET ASCII",
        endings: &["ns", "ew", "ud", "ns1", "ew1", "ud1", "ns2", "ew2", "ud2"],
        is: knet::is,
        read: knet::read,
    },
];
/// Name of the format without a head of its own.
const COLUMNS: &str = "column";

/// Reads the text of a record.
///
/// # Errors
/// The first line or key that cannot be used.
pub fn parse(file: &str, text: &str, wanted: &Wanted) -> Result<Record, Fault> {
    let lines: Vec<&str> = text.lines().collect();
    let head = &lines[..lines.len().min(series::HEAD_LINES)];
    let ending = Path::new(file).extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
    let format = FORMATS.iter().find(|format| (format.is)(head));
    let claimed = FORMATS.iter().find(|format| format.endings.contains(&ending.as_str()));
    let series = match (format, claimed) {
        (Some(format), _) => {
            no_columns(wanted.reading, format.name)?;
            (format.read)(&lines, wanted)?
        }
        (None, Some(claimed)) => {
            let message = format!(
                "the file ends in .{ending} like {} files, and its head is not theirs; download it again, or rename \
                 it to .csv if it has columns of time and value",
                claimed.name
            );
            return Err(Fault::Line(1, message));
        }
        (None, None) => columns::read(&lines, wanted)?,
    };
    let name = format.map_or(COLUMNS, |format| format.name);
    converted(series, name, wanted)
}

/// Formats of agencies have no columns to choose from.
fn no_columns(reading: &RecordReading, format: &str) -> Result<(), Fault> {
    match reading.columns {
        Some(_) => Err(Fault::Key(
            "record.columns",
            format!("belongs to a file with columns, and this one is {format}; remove it"),
        )),
        None => Ok(()),
    }
}

/// Values and times in SI units, when file and case agree on them.
fn converted(series: Series, format: &str, wanted: &Wanted) -> Result<Record, Fault> {
    if let (Some(quantity), kind) = (series.kind, wanted.kind.unwrap_or(BaseMotionKind::Velocity))
        && quantity != kind
    {
        let message = format!(
            "holds {} by its head, and {} is asked for; name it by `{} = \"…\"`",
            quantity.name(),
            kind.name(),
            quantity.name()
        );
        return Err(Fault::File(message));
    }
    let (factor, unit) = units::factor(series.unit, wanted, format == COLUMNS)?;
    let (second, time_is_stated) = time_factor(series.time_unit, wanted.reading)?;
    let Series { times, values, lines, warnings, taken, .. } = series;
    let milli = if second == 1.0 { "" } else { ", times in ms" };
    let format = format!("{format}{taken}{milli}");
    let rows = times.into_iter().zip(values).map(|(time, value)| [time * second, value * factor]).collect();
    Ok(Record { rows, lines, format, unit, time_is_stated, warnings })
}

/// Seconds in the unit of the times, and whether file or case name it.
fn time_factor(of_file: Option<TimeUnit>, reading: &RecordReading) -> Result<(f64, bool), Fault> {
    let name = |unit| if unit == TimeUnit::Second { "s" } else { "ms" };
    if let (Some(head), Some(key)) = (of_file, reading.time_unit)
        && head != key
    {
        let message = format!(
            "is {:?}, and the head of the file says {:?}; remove it or correct the head",
            name(key),
            name(head)
        );
        return Err(Fault::Key("record.time_unit", message));
    }
    let unit = of_file.or(reading.time_unit);
    Ok((if unit == Some(TimeUnit::Millisecond) { 1e-3 } else { 1.0 }, unit.is_some()))
}
