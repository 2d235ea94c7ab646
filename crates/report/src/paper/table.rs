//! Tables and text of the report as HTML.

use quick_xml::escape::escape;

use super::number::Number;

/// What stands in a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number with its unit.
    Number(Number),
    /// Numbers with words between and behind them: pairs of both.
    Mixed(Vec<(String, Number)>),
    /// Nothing.
    Empty,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<Number> for Cell {
    fn from(number: Number) -> Self {
        Self::Number(number)
    }
}

impl From<Option<Number>> for Cell {
    fn from(number: Option<Number>) -> Self {
        number.map_or(Self::Empty, Self::Number)
    }
}

impl Cell {
    /// HTML inside the cell.
    pub fn html(&self) -> String {
        match self {
            Self::Text(text) => text_html(text),
            Self::Number(number) => number.html(),
            Self::Mixed(parts) => {
                parts.iter().map(|(before, number)| text_html(before) + &number.html()).collect::<String>()
            }
            Self::Empty => "–".to_owned(),
        }
    }

    /// HTML of the cell in a column.
    fn column(&self) -> String {
        let is_long = |text: &str| text.split_whitespace().any(|word| word.chars().count() > LONG);
        let class = match self {
            Self::Number(_) => " class=\"number\"",
            Self::Text(text) if is_long(text) => " class=\"long\"",
            _ => "",
        };
        format!("<td{class}>{}</td>", self.html())
    }

    fn is_empty(&self) -> bool {
        *self == Self::Empty
    }
}

/// Text as HTML.
pub fn text_html(text: &str) -> String {
    escape(text).into_owned()
}

/// Columns that stand side by side on the paper at most; a table with more has a line for each of its columns.
const COLUMNS_MAX: usize = 7;
/// Rows that such a table has side by side.
const BESIDE: usize = 4;
/// Rows of a table that stays on one page.
const SHORT: usize = 12;
/// Letters of a word that is broken anywhere.
const LONG: usize = 18;

/// A table with a head; empty without rows. Columns that are empty in all rows are left out. One with many columns is
/// turned: its rows stand side by side, four at a time.
pub fn table(head: &[&str], rows: &[Vec<Cell>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let used = |k: usize| rows.iter().any(|row| row.get(k).is_some_and(|cell| !cell.is_empty()));
    let columns: Vec<usize> = (0..head.len()).filter(|&k| used(k)).collect();
    if columns.len() > COLUMNS_MAX {
        return rows.chunks(BESIDE).map(|rows| turned(head, rows, &columns)).collect();
    }
    let titles: String = columns.iter().map(|&k| format!("<th scope=\"col\">{}</th>", text_html(head[k]))).collect();
    let line = |row: &Vec<Cell>| {
        let cells: String = columns
            .iter()
            .map(|&k| {
                let cell = row.get(k).unwrap_or(&Cell::Empty);
                cell.column()
            })
            .collect();
        format!("<tr>{cells}</tr>\n")
    };
    let body: String = rows.iter().map(line).collect();
    // A short table stays on one page.
    let class = if rows.len() <= SHORT { " class=\"short\"" } else { "" };
    format!("<table{class}>\n<thead><tr>{titles}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n")
}

/// A table with a line for each column.
fn turned(head: &[&str], rows: &[Vec<Cell>], columns: &[usize]) -> String {
    let line = |&k: &usize| {
        let cells: String = rows.iter().map(|row| row.get(k).unwrap_or(&Cell::Empty).column()).collect();
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", text_html(head[k]))
    };
    let body: String = columns.iter().map(line).collect();
    let class = if columns.len() <= SHORT { "turned short" } else { "turned" };
    format!("<table class=\"{class}\">\n<tbody>\n{body}</tbody>\n</table>\n")
}

/// Names with their values, one below the other; those without a value are left out.
pub fn facts(rows: &[(&str, Cell)]) -> String {
    let there = rows.iter().filter(|(_, cell)| !cell.is_empty());
    let line = |(name, cell): &(&str, Cell)| {
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", text_html(name), cell.html())
    };
    let body: String = there.clone().map(line).collect();
    let class = if there.count() <= SHORT { "facts short" } else { "facts" };
    if body.is_empty() { body } else { format!("<table class=\"{class}\">\n<tbody>\n{body}</tbody>\n</table>\n") }
}

/// A paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", text_html(text))
}

/// A list of texts; empty without any.
pub fn list(texts: &[String]) -> String {
    let items: String = texts.iter().map(|text| format!("<li>{}</li>\n", text_html(text))).collect();
    if items.is_empty() { items } else { format!("<ul>\n{items}</ul>\n") }
}
