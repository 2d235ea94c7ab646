//! What commands have left in a folder of results.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use enmm_io::files::read_result;
use serde_json::Value;

/// Largest record that is read (bytes).
const RECORD_MAX: u64 = 256 << 20;
/// Largest picture that is read (bytes).
const PICTURE_MAX: u64 = 64 << 20;

/// The record of one command.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// What the command wrote.
    pub json: Value,
    /// The folder in which it lies, with its pictures.
    pub folder: PathBuf,
    /// Name of the file.
    pub name: &'static str,
}

/// The records of a folder; those of commands that were not run are none.
#[derive(Debug, Clone, PartialEq)]
pub struct Records {
    /// Of `enmm run`.
    pub run: Option<Record>,
    /// Of `enmm fos`.
    pub fos: Option<Record>,
    /// Of `enmm bound`.
    pub bound: Option<Record>,
    /// Of `enmm sample`.
    pub ensemble: Option<Record>,
    /// Of `enmm sweep`.
    pub sweep: Option<Record>,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum RecordsError {
    /// The folder is not there.
    #[error("{} is no directory: name that of the results, as `enmm run -o` does", .0.display())]
    NoFolder(PathBuf),
    /// No command has left a record.
    #[error(
        "{} holds no results: neither summary.json (enmm run), fos.json (enmm fos), bound.json (enmm bound), \
         ensemble.json (enmm sample) nor sweep.json (enmm sweep) is there or in its folders fos, bound, sample, sweep; \
         run one of them with -o {}",
        .0.display(), .0.display()
    )]
    Nothing(PathBuf),
    /// One of its folders is a link.
    #[error("{}: it is a link, which a report does not follow: put the folder itself in its place", .0.display())]
    Link(PathBuf),
    /// A record cannot be read.
    #[error("{}: {message}; run the command that wrote it again", path.display())]
    Unreadable {
        /// The record.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

impl Records {
    /// Reads the records in a folder, and in its folders `fos`, `bound`, `sample` and `sweep` what is not in itself.
    ///
    /// # Errors
    /// See [`RecordsError`].
    pub fn read(directory: &Path) -> Result<Self, RecordsError> {
        if !directory.is_dir() {
            return Err(RecordsError::NoFolder(directory.to_owned()));
        }
        let find = |name: &'static str, below: &str| match (read(directory, name)?, directory.join(below)) {
            (None, link) if link.is_symlink() => Err(RecordsError::Link(link)),
            (None, below) => read(&below, name),
            (found, _) => Ok(found),
        };
        let records = Self {
            run: find("summary.json", "run")?,
            fos: find("fos.json", "fos")?,
            bound: find("bound.json", "bound")?,
            ensemble: find("ensemble.json", "sample")?,
            sweep: find("sweep.json", "sweep")?,
        };
        if records.all().next().is_none() { Err(RecordsError::Nothing(directory.to_owned())) } else { Ok(records) }
    }

    /// The records that are there: run, factor of safety, limit analysis, ensemble, sweep.
    pub fn all(&self) -> impl Iterator<Item = &Record> {
        [&self.run, &self.fos, &self.bound, &self.ensemble, &self.sweep].into_iter().flatten()
    }

    /// The first record with the input of its case.
    pub fn with_input(&self) -> Option<&Record> {
        self.all().find(|record| record.json["input"].is_object())
    }
}

impl Record {
    /// A picture of the record, without ending, as the bytes of an SVG file; none if it is not there.
    ///
    /// # Errors
    /// It is a link, no regular file, longer than a picture, or no SVG: a report goes to others, and must not show them
    /// a file of the reader that the maker of the folder has chosen.
    pub fn picture(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        let bytes = match read_result(&self.folder.join(format!("{name}.svg")), PICTURE_MAX) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            read => read?,
        };
        if bytes.starts_with(b"<svg ") {
            Ok(Some(bytes))
        } else {
            Err(io::Error::new(ErrorKind::InvalidData, "it is no picture that enmm has drawn"))
        }
    }
}

fn read(folder: &Path, name: &'static str) -> Result<Option<Record>, RecordsError> {
    let path = folder.join(name);
    let unreadable = |message: String| RecordsError::Unreadable { path: path.clone(), message };
    let bytes = match read_result(&path, RECORD_MAX) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => return Ok(None),
        read => read.map_err(|error| unreadable(error.to_string()))?,
    };
    let json: Value = serde_json::from_slice(&bytes).map_err(|error| unreadable(error.to_string()))?;
    if !json.is_object() {
        return Err(unreadable("is no JSON object".to_owned()));
    }
    Ok(Some(Record { json, folder: folder.to_owned(), name }))
}
