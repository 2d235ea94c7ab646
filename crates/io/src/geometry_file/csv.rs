//! Traces by rows of a CSV file, whose first line names the columns, in any letter case:
//!
//! - `wkt` (or `geometry`): each row is one geometry as well-known text, such as QGIS writes;
//! - `x1`, `y1`, `x2`, `y2`: each row is one straight trace;
//! - `trace` (or `id`), `x`, `y`: each row is one point; rows of the same trace that follow each other are one line.
//!
//! A column `law` names the joint law of each row; `outline`, `hole` and `island` there make a loop instead of a trace.
//! Commas, semicolons or tabs separate columns; lines that begin with `#` are comments. Other columns are not used.

use super::wkt;
use super::{Geometry, Trace};
use crate::case_error::{CaseError, is_nearly_numeric};
use enmm::model::case::PointList;
use enmm::model::case::key::{Key, list};

/// Names in the column `law` that make loops.
const LOOPS: [&str; 3] = ["outline", "hole", "island"];

/// Names of columns; a file that has none of them is no such table, and no message shows a line of it.
const COLUMNS: [&str; 12] = ["wkt", "geometry", "geom", "x1", "y1", "x2", "y2", "trace", "id", "x", "y", "law"];

/// Columns by their places.
enum Columns {
    Wkt(usize),
    Ends([usize; 4]),
    Points { trace: usize, xy: [usize; 2] },
}

/// Name of rows in keys.
const ROW: &str = "row";

/// Reads the format.
///
/// # Errors
/// The first line that cannot be used.
pub fn parse(file: &str, text: &str) -> Result<Geometry, CaseError> {
    let text = text.trim_start_matches('\u{feff}');
    let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let delimiter = [b';', b'\t'].into_iter().find(|mark| head.as_bytes().contains(mark)).unwrap_or(b',');
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.delimiter(delimiter).trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let located = |error: csv::Error| {
        let line = error.position().map_or(1, |position| position.line() as usize);
        CaseError::at(file, line.max(1), "", format!("no row of the table: {error}; correct the line"))
    };
    let names: Vec<String> = reader.headers().map_err(located)?.iter().map(str::to_ascii_lowercase).collect();
    let (columns, law) = columns(&names).map_err(|message| CaseError::at(file, 1, "", message))?;
    let mut table = Table { file, reader: wkt::Reader::default(), columns, law, open: None };
    table.reader.geometry.warnings.extend(unused(&names, &table));
    for (k, row) in reader.records().enumerate() {
        let row = row.map_err(located)?;
        let line = row.position().map_or(1, |position| position.line() as usize);
        table.row(k, line, &row).map_err(|message| CaseError::at(file, line, "", message))?;
    }
    table.close()?;
    Ok(table.reader.finish())
}

/// Finds the columns of one of the three forms, and that of the law.
fn columns(names: &[String]) -> Result<(Columns, Option<usize>), String> {
    let find = |wanted: &[&str]| wanted.iter().find_map(|name| names.iter().position(|other| other == name));
    let all = |wanted: [&str; 4]| -> Option<[usize; 4]> {
        let [a, b, c, d] = wanted.map(|name| find(&[name]));
        Some([a?, b?, c?, d?])
    };
    let columns = if let Some(wkt) = find(&["wkt", "geometry", "geom"]) {
        Columns::Wkt(wkt)
    } else if let Some(ends) = all(["x1", "y1", "x2", "y2"]) {
        Columns::Ends(ends)
    } else if let (Some(trace), Some(x), Some(y)) = (find(&["trace", "id"]), find(&["x"]), find(&["y"])) {
        Columns::Points { trace, xy: [x, y] }
    } else {
        let is_table = names.iter().any(|name| COLUMNS.contains(&name.as_str()));
        let found = if is_table { list(names.iter().map(String::as_str)) } else { "none of ours".to_owned() };
        return Err(format!(
            "the columns are {found}, must be `wkt`, or `x1, y1, x2, y2`, or `trace, x, y`, and `law` if there is one; \
             name them in the first line"
        ));
    };
    Ok((columns, find(&["law"])))
}

/// A warning of columns that are not read.
fn unused(names: &[String], table: &Table) -> Option<String> {
    let used = |k: &usize| match &table.columns {
        Columns::Wkt(column) => column == k,
        Columns::Ends(columns) => columns.contains(k),
        Columns::Points { trace, xy } => trace == k || xy.contains(k),
    };
    let rest = (0..names.len()).filter(|k| !used(k) && table.law != Some(*k));
    let rest: Vec<&str> = rest.map(|k| names[k].as_str()).collect();
    (!rest.is_empty()).then(|| format!("columns not used: {}", rest.join(", ")))
}

/// A line of points that the next row may continue.
struct Open {
    trace: String,
    law: Option<String>,
    points: PointList,
    key: Key,
    line: usize,
}

/// Table with the rows read so far.
struct Table<'a> {
    file: &'a str,
    reader: wkt::Reader,
    columns: Columns,
    law: Option<usize>,
    open: Option<Open>,
}

impl Table<'_> {
    fn row(&mut self, k: usize, line: usize, row: &csv::StringRecord) -> Result<(), String> {
        let key = Key::root().field(ROW).index(k);
        self.reader.geometry.lines.push(ROW, line, &[]);
        let law = self.law.and_then(|column| row.get(column)).filter(|law| !law.is_empty()).map(str::to_owned);
        match self.columns {
            Columns::Wkt(column) => {
                let text = row.get(column).unwrap_or_default();
                let ring = law.as_deref().and_then(loop_of);
                if ring.is_some() {
                    return Err("is a loop by its `law`; a polygon needs none, leave `law` empty".to_owned());
                }
                self.reader.add(text, &key, &law.map(|law| (law, key.to_string())))
            }
            Columns::Ends([x1, y1, x2, y2]) => {
                let points = vec![[number(row, x1)?, number(row, y1)?], [number(row, x2)?, number(row, y2)?]];
                self.line(Open { trace: String::new(), law, points, key, line })
            }
            Columns::Points { trace, xy: [x, y] } => {
                let (name, point) = (row.get(trace).unwrap_or_default(), [number(row, x)?, number(row, y)?]);
                if let Some(open) = self.open.as_mut().filter(|open| open.trace == name) {
                    open.points.push(point);
                    if open.law != law {
                        return Err(format!("trace {name:?} has another `law` than on line {}; write one", open.line));
                    }
                    return Ok(());
                }
                let next = Open { trace: name.to_owned(), law, points: vec![point], key, line };
                self.open.replace(next).map_or(Ok(()), |open| self.line(open))
            }
        }
    }

    /// Adds a line: a trace, or a loop if its law says so.
    fn line(&mut self, line: Open) -> Result<(), String> {
        let Open { law, mut points, key, .. } = line;
        let geometry = &mut self.reader.geometry;
        let Some(ring) = law.as_deref().and_then(loop_of) else {
            let law = law.map(|law| (law, key.to_string()));
            geometry.traces.push(Trace { points: (points, key.to_string()), law });
            return Ok(());
        };
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let located = (points, key.to_string());
        match ring {
            0 if geometry.outline.is_some() => {
                return Err("is a second outline, there can be 1; write `island`".to_owned());
            }
            0 => geometry.outline = Some(located),
            1 => geometry.holes.push(located),
            _ => geometry.islands.push(located),
        }
        Ok(())
    }

    /// Adds the last line of points.
    fn close(&mut self) -> Result<(), CaseError> {
        let Some(open) = self.open.take() else { return Ok(()) };
        let line = open.line;
        self.line(open).map_err(|message| CaseError::at(self.file, line, "", message))
    }
}

/// Which loop a law stands for.
fn loop_of(law: &str) -> Option<usize> {
    LOOPS.iter().position(|name| law.eq_ignore_ascii_case(name))
}

fn number(row: &csv::StringRecord, column: usize) -> Result<f64, String> {
    let text = row.get(column).unwrap_or_default();
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| {
        let comma = if text.contains(',') { "; write a decimal point" } else { "; correct it" };
        let text = if is_nearly_numeric(text) || text.is_empty() { format!("{text:?}") } else { "a column".to_owned() };
        format!("{text} is no finite number{comma}")
    })
}
