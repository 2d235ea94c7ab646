//! Reader of records: CSV files whose first two columns are time (s) and value.

use super::case_error::{CaseError, is_nearly_numeric, is_numeric, shown};
use enmm::model::case::TimeTable;

/// A record and the line of each of its rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Time (s) and value.
    pub rows: TimeTable,
    /// Line of each row, counted from 1.
    pub lines: Vec<usize>,
}

/// Reads the text of a record: lines that begin with # are comments, one line of names may stand before the numbers;
/// commas, semicolons, tabs or spaces separate columns.
///
/// # Errors
/// The first line that has no two numbers, or a file without numbers.
pub fn parse(file: &str, text: &str) -> Result<Record, CaseError> {
    let mut record = Record::default();
    let mut header = None;
    for (k, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if line.contains(';') && line.contains(',') {
            let line = shown(line, is_numeric(line));
            let message = format!("{line} has commas and semicolons; write decimal points, as in `0.02, 1.5`");
            return Err(CaseError::at(file, k, "", message));
        }
        let mut fields = line.split([',', ';', '\t', ' ']).filter(|field| !field.is_empty());
        match [fields.next(), fields.next()].map(number) {
            [Ok(time), Ok(value)] => {
                record.rows.push([time, value]);
                record.lines.push(k);
            }
            [Err(_), _] if record.rows.is_empty() && header.is_none() => header = Some(k),
            [Err(message), _] | [_, Err(message)] => {
                let message = format!("{message}; each line holds time (s) and value, as in `0.02, 1.5`");
                return Err(CaseError::at(file, k, "", message));
            }
        }
    }
    if record.rows.is_empty() {
        let message = "the file has no numbers; each line holds time (s) and value, as in `0.02, 1.5`";
        return Err(CaseError::at(file, 1, "", message));
    }
    Ok(record)
}

/// The number of a column; a message shows no word, which may be of any other file.
fn number(field: Option<&str>) -> Result<f64, String> {
    let field = field.ok_or("the line has fewer than 2 columns")?;
    let is_none = |fault: &str| match is_nearly_numeric(field) {
        true => format!("{field:?} is {fault}"),
        false => format!("a column is {fault}"),
    };
    let value = field.parse::<f64>().map_err(|_| is_none("no number"))?;
    if value.is_finite() { Ok(value) } else { Err(is_none("not finite")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_names_and_further_columns_are_skipped() {
        let text = "# station\ntime (s), a (g), b\n0.0, 0.5, 7\n\n0.02;\t-1e-3\n0.04 2\n";
        let record = parse("quake.csv", text).unwrap();
        assert_eq!(record.rows, [[0.0, 0.5], [0.02, -1e-3], [0.04, 2.0]]);
        assert_eq!(record.lines, [3, 5, 6]);
    }

    #[test]
    fn a_line_that_cannot_be_used_is_named() {
        for (text, message) in [
            ("t,a\n0,1\n0.1,x\n", "quake.csv:3: \"x\" is no number"),
            ("t,a\nunits,g\n0,1\n", "quake.csv:2: a column is no number"),
            ("0,00;0,10\n", "quake.csv:1: \"0,00;0,10\" has commas and semicolons"),
            ("0,1\n0.1\n", "quake.csv:2: the line has fewer than 2 columns"),
            ("0,1\n0.1,inf\n", "quake.csv:2: \"inf\" is not finite"),
            ("# nothing\n", "quake.csv:1: the file has no numbers"),
        ] {
            let error = parse("quake.csv", text).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
