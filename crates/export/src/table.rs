//! A table of results.

use std::path::PathBuf;

/// One cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Nothing.
    Empty,
    /// A finite number.
    Number(f64),
    /// A text, or a number that is none in double precision.
    Text(String),
    /// True or false.
    Flag(bool),
}

/// A table with one row of heads.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Name, such as `history` or `summary.json.stages`.
    pub name: String,
    /// The file that it is from.
    pub source: PathBuf,
    /// Heads of the columns, with units in brackets.
    pub columns: Vec<String>,
    /// Rows, as long as the heads.
    pub rows: Vec<Vec<Cell>>,
}
