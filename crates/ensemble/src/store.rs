//! The store of samples: a SQLite file in WAL mode with a row for each sample that is done, on the disk at once. The
//! Python package reads and writes the same file.

use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::{Connection, OpenFlags, OptionalExtension, params};
use serde_json::{Map, Value as Json};

use crate::draw::Value;

const TABLE: &str = "
create table if not exists sample (
    key text primary key, k integer not null, status text not null, given text not null, outputs text not null,
    message text not null, seconds real not null, version text not null, finished text not null
) without rowid
";
/// Time for which another writer is waited for.
const WAIT: Duration = Duration::from_secs(60);

/// A sample that is done.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its outputs, in the order of the columns; empty when the case itself has no answer.
    pub outputs: Vec<(String, Json)>,
    /// Why it has no answer; empty when it has one.
    pub message: String,
}

impl Row {
    /// Whether the sample has an answer.
    pub fn is_done(&self) -> bool {
        self.message.is_empty()
    }

    /// An output by name.
    pub fn output(&self, name: &str) -> Option<&Json> {
        self.outputs.iter().find(|(other, _)| other == name).map(|(_, value)| value)
    }

    /// An output that is a number; none of a sample without an answer.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.output(name).and_then(Json::as_f64).filter(|_| self.is_done())
    }

    /// An output that is a text; empty where there is none.
    pub fn text(&self, name: &str) -> &str {
        self.output(name).and_then(Json::as_str).unwrap_or_default()
    }

    /// Its outputs as an object whose entries keep their order.
    fn object(&self) -> String {
        let entries = self.outputs.iter().map(|(name, value)| format!("{}: {value}", Json::from(name.as_str())));
        format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
    }
}

/// Why the store cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("the store {path}: {message}; choose another file with --store")]
pub struct StoreError {
    path: String,
    message: String,
}

/// Samples by key. One process at a time writes; others may read.
pub struct Store {
    path: PathBuf,
    database: Connection,
}

impl Store {
    /// Opens a store, and makes it where there is none.
    ///
    /// # Errors
    /// The file cannot be made or opened, or is none of SQLite.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let open = || {
            // A path is the name of a file, also where SQLite would take it for an address or for memory.
            let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE;
            let database = Connection::open_with_flags(Path::new(".").join(path), flags)?;
            database.busy_timeout(WAIT)?;
            database.pragma_update(None, "journal_mode", "wal")?;
            database.pragma_update(None, "synchronous", "full")?;
            database.execute_batch(TABLE)?;
            Ok(database)
        };
        let database = open().map_err(|error| failure(path, &error))?;
        Ok(Self { path: path.to_owned(), database })
    }

    /// Adds a sample, in the place of an earlier one of this key; it is on the disk when this returns.
    ///
    /// `values` are the keys and values of sample `k`, `seconds` is how long it took.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(
        &self,
        key: &str,
        k: usize,
        values: &[(String, Value)],
        row: &Row,
        (seconds, version): (f64, &str),
    ) -> Result<(), StoreError> {
        let number = |value: &Value| match value {
            Value::Number(number) => Json::from(*number),
            Value::Whole(whole) => Json::from(*whole),
        };
        let given: Map<String, Json> = values.iter().map(|(name, value)| (name.clone(), number(value))).collect();
        let status = if row.is_done() { "done" } else { "failed" };
        let place = i64::try_from(k).unwrap_or(i64::MAX);
        let mut statement = self
            .database
            .prepare(
                "insert or replace into sample values (?, ?, ?, ?, ?, ?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))",
            )
            .map_err(|error| failure(&self.path, &error))?;
        let given = Json::from(given).to_string();
        let written =
            statement.execute(params![key, place, status, given, row.object(), row.message, seconds, version]);
        written.map(drop).map_err(|error| failure(&self.path, &error))
    }

    /// The sample of a key, with those of its outputs that `columns` name, in their order.
    ///
    /// # Errors
    /// The file cannot be read, or holds outputs that are no JSON.
    pub fn find(&self, key: &str, columns: &[&str]) -> Result<Option<Row>, StoreError> {
        let failed = |error: rusqlite::Error| failure(&self.path, &error);
        let mut statement =
            self.database.prepare("select status, outputs, message from sample where key = ?").map_err(failed)?;
        let texts = |row: &rusqlite::Row| Ok([row.get::<_, String>(0)?, row.get(1)?, row.get(2)?]);
        let Some([status, outputs, message]) = statement.query_row([key], texts).optional().map_err(failed)? else {
            return Ok(None);
        };
        let object: Map<String, Json> = serde_json::from_str(&outputs).map_err(|error| StoreError {
            path: self.path.display().to_string(),
            message: format!("the outputs of sample {key} are no JSON ({error})"),
        })?;
        let message = if status == "done" { String::new() } else { message };
        let output = |name: &&str| Some(((*name).to_owned(), object.get(*name)?.clone()));
        Ok(Some(Row { outputs: columns.iter().filter_map(output).collect(), message }))
    }

    /// Number of samples.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn count(&self) -> Result<usize, StoreError> {
        let count = self.database.query_row("select count(*) from sample", [], |row| row.get::<_, i64>(0));
        count.map(|count| usize::try_from(count).unwrap_or(0)).map_err(|error| failure(&self.path, &error))
    }
}

fn failure(path: &Path, error: &rusqlite::Error) -> StoreError {
    StoreError { path: path.display().to_string(), message: error.to_string() }
}
