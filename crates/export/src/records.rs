//! Tables of a record: one of its single values, and one of each list of objects, also of lists within rows. The input
//! of the case (`input`) is left out: it is no result.

use std::path::Path;

use serde_json::{Map, Value};

use crate::table::{Cell, Table};
use crate::units::unit;

/// Input of the case in records.
const INPUT: &str = "input";
/// Head of the column that names the row to which the rows of a list within a row belong, from 1.
const OF: &str = "of row";
/// Least whole number that a double need not hold.
const WHOLE_MAX: u64 = 1 << 53;

type Object = Map<String, Value>;
/// An object of a list, with the row of another table that it belongs to.
type Row<'a> = (Option<usize>, &'a Object);

/// The table of the single values of a record and those of its lists.
pub fn tables(path: &Path, name: &str, record: &Value) -> Vec<Table> {
    let mut builder = Builder { path, name, tables: Vec::new() };
    let mut parts = Parts::default();
    if let Value::Object(record) = record {
        record.iter().filter(|(key, _)| *key != INPUT).for_each(|(key, value)| parts.take(key, key, value));
    }
    let columns = ["name", "value", "unit"].map(str::to_owned).into();
    let rows = parts.leaves.iter().map(Leaf::row).collect();
    builder.tables.push(Table { name: name.to_owned(), source: path.to_owned(), columns, rows });
    for (key, objects) in parts.lists {
        builder.list(&key, objects.into_iter().map(|object| (None, object)).collect());
    }
    builder.tables.retain(|table| !table.rows.is_empty());
    builder.tables
}

struct Builder<'a> {
    path: &'a Path,
    name: &'a str,
    tables: Vec<Table>,
}

impl Builder<'_> {
    /// Adds the table of a list, each object with the row of another table that it belongs to, and those of lists in
    /// its rows.
    fn list(&mut self, key: &str, objects: Vec<Row>) {
        let mut columns: Vec<(&'static str, String)> = Vec::new();
        let mut rows: Vec<Vec<(usize, Cell)>> = Vec::new();
        let mut inner: Vec<(String, Vec<Row>)> = Vec::new();
        let is_inner = objects.iter().any(|(of, _)| of.is_some());
        for (k, (of, object)) in objects.into_iter().enumerate() {
            let mut parts = Parts::default();
            object.iter().for_each(|(name, value)| parts.take(&format!("{key}.{name}"), name, value));
            let mut row = Vec::new();
            for leaf in parts.leaves {
                let known = columns.iter().position(|(_, name)| *name == leaf.shown);
                let column = known.unwrap_or_else(|| {
                    columns.push(("", leaf.shown.clone()));
                    columns.len() - 1
                });
                if leaf.value.is_number() {
                    columns[column].0 = unit(&leaf.key);
                }
                row.push((column, cell(leaf.value)));
            }
            row.extend(of.map(|of| (usize::MAX, Cell::Number(of as f64))));
            rows.push(row);
            for (key, objects) in parts.lists {
                let of_row = objects.into_iter().map(|object| (Some(k + 1), object));
                match inner.iter_mut().find(|(known, _)| *known == key) {
                    Some((_, all)) => all.extend(of_row),
                    None => inner.push((key, of_row.collect())),
                }
            }
        }
        let shift = usize::from(is_inner);
        let full = |row: Vec<(usize, Cell)>| {
            let mut cells = vec![Cell::Empty; columns.len() + shift];
            row.into_iter().for_each(|(column, cell)| cells[column.wrapping_add(shift)] = cell);
            cells
        };
        let rows = rows.into_iter().map(full).collect();
        let heads = columns.iter().map(|(unit, name)| head(name, unit));
        let columns = is_inner.then(|| OF.to_owned()).into_iter().chain(heads).collect();
        let name = format!("{}.{key}", self.name);
        self.tables.push(Table { name, source: self.path.to_owned(), columns, rows });
        inner.into_iter().for_each(|(key, objects)| self.list(&key, objects));
    }
}

/// A single value: its name in the record, which has a unit, its name with the places in lists, and itself.
struct Leaf<'a> {
    key: String,
    shown: String,
    value: &'a Value,
}

impl Leaf<'_> {
    /// Its row among single values.
    fn row(&self) -> Vec<Cell> {
        let unit = if self.value.is_number() { unit(&self.key) } else { "" };
        let unit = if unit.is_empty() { Cell::Empty } else { Cell::Text(unit.to_owned()) };
        vec![Cell::Text(self.shown.clone()), cell(self.value), unit]
    }
}

/// Parts of a value: single values, and lists of objects by their names.
#[derive(Default)]
struct Parts<'a> {
    leaves: Vec<Leaf<'a>>,
    lists: Vec<(String, Vec<&'a Object>)>,
}

impl<'a> Parts<'a> {
    fn take(&mut self, key: &str, shown: &str, value: &'a Value) {
        match value {
            Value::Object(object) => {
                object.iter().for_each(|(name, value)| {
                    self.take(&format!("{key}.{name}"), &format!("{shown}.{name}"), value);
                });
            }
            Value::Array(list) if !list.is_empty() && list.iter().all(Value::is_object) => {
                self.lists.push((key.to_owned(), list.iter().filter_map(Value::as_object).collect()));
            }
            Value::Array(list) => {
                let is_place = list.len() == 2 && list.iter().all(Value::is_number);
                for (k, value) in list.iter().enumerate() {
                    let part = if is_place { ["x", "y"][k].to_owned() } else { (k + 1).to_string() };
                    self.take(key, &format!("{shown}_{part}"), value);
                }
            }
            _ => self.leaves.push(Leaf { key: key.to_owned(), shown: shown.to_owned(), value }),
        }
    }
}

fn head(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

fn cell(value: &Value) -> Cell {
    match value {
        Value::Null => Cell::Empty,
        Value::Bool(flag) => Cell::Flag(*flag),
        Value::String(text) => Cell::Text(text.clone()),
        Value::Number(number) if is_double(number) => number.as_f64().map_or(Cell::Empty, Cell::Number),
        other => Cell::Text(other.to_string()),
    }
}

/// Whether double precision holds a number, unlike large seeds.
fn is_double(number: &serde_json::Number) -> bool {
    number.is_f64() || number.as_i64().is_some_and(|whole| whole.unsigned_abs() < WHOLE_MAX)
}
