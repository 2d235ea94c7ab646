//! Traces by rows of a CSV file, whose first line names the columns, in any letter case and perhaps with a unit, `x1
//! [m]`:
//!
//! - `wkt` (or `geometry`): each row is one geometry as well-known text, such as QGIS writes;
//! - `x1`, `y1`, `x2`, `y2`: each row is one straight trace;
//! - `trace` (or `id`), `x`, `y`: each row is one point; rows of the same trace that follow each other are one line.
//!
//! With `z` beside `y` the section may stand upright. A column `law` (or `joint_law`, or `layer`) names the joint law
//! of each row; `outline`, `hole` and `island` there make a loop instead of a trace. Commas, semicolons or tabs
//! separate columns, or what a first line `sep=;` says; lines that begin with `#` are comments. Other columns are not
//! used.

use super::names::{Laws, Part, Purpose, tidy};
use super::unit::{Declared, is_unit};
use super::upright::Plane;
use super::{Geometry, wkt};
use crate::case_error::{CaseError, is_nearly_numeric};
use enmm::model::case::PointList;
use enmm::model::case::key::{Key, list};

/// Names of columns; a file that has none of them is no such table, and no message shows a line of it.
const COLUMNS: [&str; 15] =
    ["wkt", "geometry", "geom", "x1", "y1", "z1", "x2", "y2", "z2", "trace", "id", "x", "y", "z", "law"];

/// Columns by their places; a point has x, y and z.
enum Columns {
    Wkt(usize),
    Ends([[Option<usize>; 3]; 2]),
    Points { trace: usize, point: [Option<usize>; 3] },
}

impl Columns {
    /// The columns of the points of a row.
    fn points(&self) -> &[[Option<usize>; 3]] {
        match self {
            Self::Wkt(_) => &[],
            Self::Ends(ends) => ends,
            Self::Points { point, .. } => std::slice::from_ref(point),
        }
    }
}

/// Name of rows in keys.
const ROW: &str = "row";

/// Reads the format.
///
/// # Errors
/// The first line that cannot be used.
pub fn parse(file: &str, text: &str, laws: &Laws) -> Result<Geometry, CaseError> {
    let (told, skipped, text) = separator(text);
    let mut lines = text.lines().enumerate();
    let (at, head) =
        lines.find(|(_, line)| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or((0, Default::default()));
    let head_line = skipped + at + 1;
    let found = [b';', b'\t'].into_iter().find(|mark| head.as_bytes().contains(mark)).unwrap_or(b',');
    let mut builder = csv::ReaderBuilder::new();
    let builder = builder.delimiter(told.unwrap_or(found)).trim(csv::Trim::All).comment(Some(b'#'));
    let mut reader = builder.from_reader(text.as_bytes());
    let line_of = |position: Option<&csv::Position>| position.map_or(1, |at| at.line() as usize).max(1) + skipped;
    let located = |error: csv::Error| {
        let message = format!("no row of the table: {error}; correct the line");
        CaseError::at(file, line_of(error.position()), "", message)
    };
    let heads: Vec<Head> = reader.headers().map_err(located)?.iter().map(Head::of).collect();
    let fail = |message: String| CaseError::at(file, head_line, "", message);
    let columns = columns(&heads).map_err(fail)?;
    let rows = reader.records().collect::<Result<Vec<_>, _>>().map_err(located)?;
    let [law, layer] = [Purpose::Law, Purpose::Layer].map(|purpose| {
        let mut named = (0..heads.len()).filter(|k| Purpose::named(&heads[*k].name) == Some(purpose));
        (named.next(), named.next().is_some())
    });
    if law.1 {
        return Err(fail("two columns name the joint law; remove one".to_owned()));
    }
    let plane = plane(&columns, &rows);
    let (law, layer) = (law.0, layer.0);
    let reader = wkt::Reader::default();
    let mut table = Table { file, laws, reader, plane, columns, law, layer, open: None };
    table.reader.geometry.warnings.extend(unused(&heads, &table));
    table.reader.geometry.notes.extend(plane.note());
    table.reader.geometry.declared = declared(&heads, &table, head_line).map_err(fail)?;
    for (k, row) in rows.iter().enumerate() {
        let line = line_of(row.position());
        table.row(k, line, row).map_err(|message| CaseError::at(file, line, "", message))?;
    }
    table.close()?;
    table.reader.finish(file)
}

/// The separator that a first line `sep=;` names, as spreadsheets read and write it; the number of lines that this is,
/// and the rest.
fn separator(text: &str) -> (Option<u8>, usize, &str) {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let first = first.trim_end_matches('\r').trim_matches('"');
    let mark = first.get(..4).filter(|word| word.eq_ignore_ascii_case("sep=")).map(|_| &first[4..]);
    match mark.map(str::as_bytes) {
        Some([mark]) => (Some(*mark), 1, rest),
        _ => (None, 0, text),
    }
}

/// Head of a column.
struct Head {
    /// Name in small letters, without the unit.
    name: String,
    /// Unit in brackets behind the name.
    unit: Option<String>,
}

impl Head {
    fn of(text: &str) -> Self {
        let bare = text.trim_end_matches([']', ')']);
        let parts = if bare == text { text.split_once(" / ") } else { bare.rsplit_once(['[', '(']) };
        match parts.filter(|(_, unit)| is_unit(unit)) {
            Some((name, unit)) => Self { name: tidy(name), unit: Some(unit.trim().to_owned()) },
            None => Self { name: tidy(text), unit: None },
        }
    }
}

/// Finds the columns of one of the three forms.
fn columns(heads: &[Head]) -> Result<Columns, String> {
    let find = |wanted: &[&str]| wanted.iter().find_map(|name| heads.iter().position(|head| head.name == *name));
    let point = |names: [&str; 3]| {
        let point = names.map(|name| find(&[name]));
        (point[0].is_some() && point[1].or(point[2]).is_some()).then_some(point)
    };
    if let Some(wkt) = find(&["wkt", "geometry", "geom"]) {
        Ok(Columns::Wkt(wkt))
    } else if let (Some(a), Some(b)) = (point(["x1", "y1", "z1"]), point(["x2", "y2", "z2"])) {
        Ok(Columns::Ends([a, b]))
    } else if let (Some(trace), Some(point)) = (find(&["trace", "id"]), point(["x", "y", "z"])) {
        Ok(Columns::Points { trace, point })
    } else {
        let names = heads.iter().map(|head| head.name.as_str());
        let is_table = names.clone().any(|name| COLUMNS.contains(&name));
        let found = if is_table { list(names) } else { "none of ours".to_owned() };
        Err(format!(
            "the columns are {found}, must be `wkt`, or `x1, y1, x2, y2`, or `trace, x, y`, and `law` if there is one; \
             name them in the first line"
        ))
    }
}

/// The plane of all points; a table without y stands upright.
fn plane(columns: &Columns, rows: &[csv::StringRecord]) -> Plane {
    let points = columns.points();
    let Some([_, y, _]) = points.first() else { return Plane::Flat };
    let number = |row: &csv::StringRecord, column: Option<usize>| row.get(column?)?.parse().ok();
    let of_row = |row: &csv::StringRecord| -> Vec<[Option<f64>; 3]> {
        points
            .iter()
            .map(|[x, y, z]| [number(row, *x), y.map_or(Some(0.0), |_| number(row, *y)), number(row, *z)])
            .collect()
    };
    match y {
        None => Plane::AlongX,
        Some(_) => Plane::of(rows.iter().flat_map(of_row)),
    }
}

/// A warning of columns that are not read.
fn unused(heads: &[Head], table: &Table) -> Option<String> {
    let of_points = |k: &usize| {
        table
            .columns
            .points()
            .iter()
            .any(|[x, y, z]| [*x, *y].contains(&Some(*k)) || (table.plane != Plane::Flat && *z == Some(*k)))
    };
    let used = |k: &usize| match &table.columns {
        Columns::Wkt(column) => column == k,
        Columns::Ends(_) => of_points(k),
        Columns::Points { trace, .. } => trace == k || of_points(k),
    };
    let rest = (0..heads.len()).filter(|k| !used(k) && ![table.law, table.layer].contains(&Some(*k)));
    let rest: Vec<&str> = rest.map(|k| heads[k].name.as_str()).collect();
    (!rest.is_empty()).then(|| format!("columns not used: {}", rest.join(", ")))
}

/// The unit that the heads of the columns of points name.
fn declared(heads: &[Head], table: &Table, line: usize) -> Result<Option<Declared>, String> {
    let columns = table.columns.points().iter().flatten().flatten();
    let mut units: Vec<&str> = columns.filter_map(|&k| heads[k].unit.as_deref()).collect();
    units.dedup();
    match units[..] {
        [] => Ok(None),
        [unit] => Ok(Some(Declared { text: unit.to_owned(), key: String::new(), line })),
        _ => Err(format!("the columns have the units {}, must have one", units.join(", "))),
    }
}

/// A line of points that the next row may continue.
struct Open {
    trace: String,
    part: Part,
    points: PointList,
    key: Key,
    line: usize,
}

/// Table with the rows read so far.
struct Table<'a> {
    file: &'a str,
    laws: &'a Laws<'a>,
    reader: wkt::Reader,
    plane: Plane,
    columns: Columns,
    law: Option<usize>,
    layer: Option<usize>,
    open: Option<Open>,
}

impl Table<'_> {
    fn row(&mut self, k: usize, line: usize, row: &csv::StringRecord) -> Result<(), String> {
        let key = Key::root().field(ROW).index(k);
        self.reader.geometry.lines.push(ROW, line, &[]);
        let name = |column: Option<usize>| {
            let name = column.and_then(|column| row.get(column)).filter(|name| !name.is_empty());
            name.map(|name| (name.to_owned(), key.to_string()))
        };
        let point = |[x, y, z]: [Option<usize>; 3]| -> Result<[f64; 2], String> {
            let at = |column: Option<usize>| column.map_or(Ok(0.0), |column| number(row, column));
            let z = if self.plane == Plane::Flat { None } else { z };
            Ok(self.plane.point([at(x)?, at(y)?, at(z)?]))
        };
        let part = Part::of(name(self.law), name(self.layer), self.laws);
        match self.columns {
            Columns::Wkt(column) => self.reader.add(row.get(column).unwrap_or_default(), key, part),
            Columns::Ends([a, b]) => {
                let points = vec![point(a)?, point(b)?];
                self.reader.geometry.put_line(&part, points, key.to_string())
            }
            Columns::Points { trace, point: columns } => {
                let (name, point) = (row.get(trace).unwrap_or_default(), point(columns)?);
                if let Some(open) = self.open.as_mut().filter(|open| open.trace == name) {
                    open.points.push(point);
                    if !open.part.is_same(&part) {
                        return Err(format!("trace {name:?} has another `law` than on line {}; write one", open.line));
                    }
                    return Ok(());
                }
                let next = Open { trace: name.to_owned(), part, points: vec![point], key, line };
                self.open.replace(next).map_or(Ok(()), |open| self.line(open))
            }
        }
    }

    fn line(&mut self, Open { part, points, key, .. }: Open) -> Result<(), String> {
        self.reader.geometry.put_line(&part, points, key.to_string())
    }

    /// Adds the last line of points.
    fn close(&mut self) -> Result<(), CaseError> {
        let Some(open) = self.open.take() else { return Ok(()) };
        let line = open.line;
        self.line(open).map_err(|message| CaseError::at(self.file, line, "", message))
    }
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
