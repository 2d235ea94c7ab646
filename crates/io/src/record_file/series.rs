//! Values of a record as a file has them, and what its head says of them.

use enmm::model::case::keys::Plain;
use enmm::model::case::record::{BaseMotionKind, TimeUnit};

use super::numbers::{Layout, numbers};
use super::units::Unit;
use super::wanted::Fault;

/// Lines in which a head says what it is the head of.
pub const HEAD_LINES: usize = 120;

/// Times and values in the units of a file.
#[derive(Debug, Clone, Default)]
pub struct Series {
    pub times: Vec<f64>,
    pub values: Vec<f64>,
    /// Line of each value, counted from 1.
    pub lines: Vec<usize>,
    /// Quantity and unit that the head names.
    pub kind: Option<BaseMotionKind>,
    pub unit: Option<Unit>,
    pub time_unit: Option<TimeUnit>,
    /// Columns or channel that were read, behind the name of the format.
    pub taken: String,
    pub warnings: Vec<String>,
}

/// A section of equally spaced values.
pub struct Section<'a> {
    pub lines: &'a [&'a str],
    /// First line with values, as an index.
    pub from: usize,
    /// Number of values by the head, with its name there.
    pub count: Option<(usize, &'static str)>,
    /// Time (s) between them by the head, with the line (counted from 1) that has it.
    pub dt: (f64, usize),
    pub layout: Layout,
}

impl Section<'_> {
    /// The values up to a line that `ends` them, or to the end of the file.
    pub fn read(&self, ends: impl Fn(&str) -> bool) -> Result<Series, Fault> {
        let dt = step(self.dt.0, self.dt.1)?;
        let mut series = Series { time_unit: Some(TimeUnit::Second), ..Series::default() };
        let mut last = self.from;
        for (k, line) in self.lines.iter().enumerate().skip(self.from) {
            if ends(line) {
                break;
            }
            let found = numbers(line, self.layout).map_err(|message| Fault::Line(k + 1, message))?;
            series.lines.resize(series.lines.len() + found.len(), k + 1);
            series.values.extend(found);
            last = if line.trim().is_empty() { last } else { k + 1 };
        }
        let read = series.values.len();
        match self.count {
            Some((count, name)) if read < count => {
                let message =
                    format!("the file ends after {read} values of {count} ({name}): it is cut off; download it again");
                return Err(Fault::Line(last.max(1), message));
            }
            Some((count, name)) if read > count => {
                let line = series.lines[count];
                let message = format!(
                    "here is value {} of {count} ({name}); correct the head or remove what is too much",
                    count + 1
                );
                return Err(Fault::Line(line, message));
            }
            _ if read < 2 => {
                let message = format!("the record has {read} values, at least 2 are needed; download it again");
                return Err(Fault::Line(last.max(1), message));
            }
            _ => {}
        }
        series.times = (0..read).map(|k| k as f64 * dt).collect();
        Ok(series)
    }
}

/// A time (s) between values that can be used.
pub fn step(dt: f64, line: usize) -> Result<f64, Fault> {
    if dt.is_finite() && dt > 0.0 && dt <= 1e6 {
        return Ok(dt);
    }
    Err(Fault::Line(
        line,
        format!("the time between values is {} s, must be above 0 and at most 1e6 s; correct the head", Plain(dt)),
    ))
}

/// Checks that the case gives no other time between values than the head.
pub fn same_step(given: Option<f64>, head: f64) -> Result<(), Fault> {
    match given {
        Some(dt) if (dt - head).abs() > 1e-6 * head => Err(Fault::Key(
            "record.dt",
            format!("is {} s, and the head of the file says {} s; remove it", Plain(dt), Plain(head)),
        )),
        _ => Ok(()),
    }
}

/// The channel of `count` that the case asks for, as an index.
pub fn channel(asked: Option<usize>, count: usize, what: &str) -> Result<usize, Fault> {
    match asked {
        Some(channel) if (1..=count).contains(&channel) => Ok(channel - 1),
        Some(channel) => Err(Fault::Key(
            "record.channel",
            format!("is {channel}, must be at least 1 and at most {count}; the file has {count} channels of {what}"),
        )),
        None if count == 1 => Ok(0),
        None => Err(Fault::File(format!(
            "has {count} channels of {what}; choose one, such as `record = {{ channel = 1 }}`"
        ))),
    }
}
