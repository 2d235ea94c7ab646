//! Histories as CSV: one row per output time, the unit of every column in the header.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use enmm_io::files::{at_path, open_result, write_atomic};

/// Writes one row after another; every row is in the file before [`HistoryWriter::row`] returns.
#[derive(Debug)]
pub struct HistoryWriter {
    path: PathBuf,
    header: Vec<String>,
    csv: csv::Writer<File>,
    /// The last row in the file.
    last: Option<Vec<f64>>,
    /// Rows that are kept back.
    held: Option<Vec<Vec<f64>>>,
}

impl HistoryWriter {
    /// Starts the file at `path` with a header such as `time [s],crest_ux [m]`; the first column is the time.
    ///
    /// A column is its name and its unit; an empty unit leaves the name alone.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn new(path: &Path, columns: &[(impl AsRef<str>, impl AsRef<str>)]) -> io::Result<Self> {
        Self::begin(path, header(columns))
    }

    /// Continues the file of an interrupted run: rows later than `keep_until_time` (s) are dropped, then rows follow.
    ///
    /// A last row that the interruption cut short is dropped too. A missing file is started again.
    ///
    /// # Errors
    /// `InvalidData` if the header is not that of `columns` or a kept row is not numbers; else what the file system
    /// refuses. The path is in the message.
    pub fn open_for_append(
        path: &Path,
        columns: &[(impl AsRef<str>, impl AsRef<str>)],
        keep_until_time: f64,
    ) -> io::Result<Self> {
        Self::shorten(path, header(columns), keep_until_time)
    }

    /// Drops rows later than `keep_until_time` (s).
    ///
    /// # Errors
    /// As [`HistoryWriter::open_for_append`].
    pub fn cut(&mut self, keep_until_time: f64) -> io::Result<()> {
        self.release()?;
        *self = Self::shorten(&self.path, std::mem::take(&mut self.header), keep_until_time)?;
        Ok(())
    }

    fn begin(path: &Path, header: Vec<String>) -> io::Result<Self> {
        write_atomic(path, &encode([&header]).map_err(at_path(path))?)?;
        Self::at_end(path, header, None)
    }

    fn shorten(path: &Path, header: Vec<String>, keep_until_time: f64) -> io::Result<Self> {
        let text = match open_result(path).and_then(io::read_to_string) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Self::begin(path, header),
            read => read.map_err(at_path(path))?,
        };
        let kept = rows_until(&text, &header, keep_until_time).map_err(at_path(path))?;
        write_atomic(path, &kept)?;
        let last = last_row(&kept);
        Self::at_end(path, header, last)
    }

    /// Appends one row: a value per column, the time (s) first, in digits that read back to the same number.
    ///
    /// # Errors
    /// `InvalidInput` if the number of values is not the number of columns; else what the file system refuses.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        if values.len() != self.header.len() {
            let message = format!("a row of {} values in a history of {} columns", values.len(), self.header.len());
            return Err(at_path(&self.path)(io::Error::new(ErrorKind::InvalidInput, message)));
        }
        if let Some(held) = &mut self.held {
            held.push(values.to_vec());
            return Ok(());
        }
        let written = self.csv.write_record(values.iter().map(|value| format!("{value:?}"))).map_err(io::Error::from);
        written.and_then(|()| self.csv.flush()).map_err(at_path(&self.path))?;
        self.last = Some(values.to_vec());
        Ok(())
    }

    /// The last row, written or kept back; none before the first.
    pub fn last(&self) -> Option<&[f64]> {
        let held = self.held.as_ref().and_then(|rows| rows.last());
        held.or(self.last.as_ref()).map(Vec::as_slice)
    }

    /// Keeps back the rows that follow until they are released or discarded.
    pub fn hold(&mut self) {
        self.held = Some(Vec::new());
    }

    /// Writes the rows that have been kept back; those that follow are no longer kept back.
    ///
    /// # Errors
    /// As [`HistoryWriter::row`].
    pub fn release(&mut self) -> io::Result<()> {
        self.held.take().unwrap_or_default().iter().try_for_each(|row| self.row(row))
    }

    /// Forgets the rows that have been kept back; those that follow are no longer kept back.
    pub fn discard(&mut self) {
        self.held = None;
    }

    /// Fails when the file is no longer in its place: rows then went where nobody finds them.
    ///
    /// # Errors
    /// Any error of the file system, with the path in the message.
    pub fn check_place(&self) -> io::Result<()> {
        fs::metadata(&self.path).map(|_| ()).map_err(at_path(&self.path))
    }

    fn at_end(path: &Path, header: Vec<String>, last: Option<Vec<f64>>) -> io::Result<Self> {
        let file = OpenOptions::new().append(true).open(path).map_err(at_path(path))?;
        Ok(Self { path: path.to_owned(), header, csv: csv::Writer::from_writer(file), last, held: None })
    }
}

fn header(columns: &[(impl AsRef<str>, impl AsRef<str>)]) -> Vec<String> {
    columns.iter().map(|(name, unit)| titled(name.as_ref(), unit.as_ref())).collect()
}

fn titled(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// The records as CSV, each on its line.
fn encode<R: AsRef<[u8]>>(records: impl IntoIterator<Item = impl IntoIterator<Item = R>>) -> io::Result<Vec<u8>> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for record in records {
        csv.write_record(record)?;
    }
    csv.into_inner().map_err(csv::IntoInnerError::into_error)
}

/// Header and rows of `text` up to the time `until` (s); what follows the last line end was cut short and is left out.
fn rows_until(text: &str, header: &[String], until: f64) -> io::Result<Vec<u8>> {
    let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(whole.as_bytes());
    let mut kept = Vec::new();
    for (line, record) in reader.records().enumerate() {
        let record = record?;
        if line == 0 {
            check_header(&record, header)?;
            kept.push(record);
        } else if time_of(&record, header.len()).ok_or_else(|| no_row(line + 1))? <= until {
            kept.push(record);
        }
    }
    if kept.is_empty() { encode([header]) } else { encode(&kept) }
}

/// The last of rows as they are in the file; none below a header alone.
fn last_row(kept: &[u8]) -> Option<Vec<f64>> {
    let mut reader = csv::Reader::from_reader(kept);
    let last = reader.records().last()?.ok()?;
    last.iter().map(|text| text.parse().ok()).collect()
}

fn check_header(found: &csv::StringRecord, expected: &[String]) -> io::Result<()> {
    if found.iter().eq(expected) {
        return Ok(());
    }
    // A file of that name that no run wrote may hold anything: no line of it is shown.
    let is_ours = found.get(0) == expected.first().map(String::as_str);
    let found = if is_ours { found.iter().collect::<Vec<_>>().join(",") } else { "others".to_owned() };
    let message = format!("the columns are {found}, but this run writes {}", expected.join(","));
    Err(io::Error::new(ErrorKind::InvalidData, message))
}

/// The first of `columns` numbers, if the record is such a row.
fn time_of(record: &csv::StringRecord, columns: usize) -> Option<f64> {
    let values = record.iter().map(str::parse).collect::<Result<Vec<f64>, _>>().ok()?;
    if values.len() == columns { values.first().copied() } else { None }
}

fn no_row(line: usize) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, format!("line {line} is not a row of numbers under this header"))
}
