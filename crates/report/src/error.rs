//! Why a film or a page cannot be written.

use std::io;
use std::path::{Path, PathBuf};

use crate::number::single;

/// Why a film or a page cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The file system refused.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        error: io::Error,
    },
    /// A number that cannot be shown.
    #[error("{what} is {value:e} at t = {time} s: a film holds finite numbers below 3.4e38")]
    NotFinite {
        /// Quantity and the block, corner, monitor or column it belongs to.
        what: String,
        /// The number.
        value: f64,
        /// Time of the frame or row (s); 0 for what a film begins with.
        time: f64,
    },
    /// A list of the wrong length.
    #[error("{found} {what} were given, the film has {expected}")]
    Count {
        /// Content of the list.
        what: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A file that is no film.
    #[error("{}: {problem}", path.display())]
    NoFilm {
        /// The file.
        path: PathBuf,
        /// The fault.
        problem: String,
    },
}

impl FilmError {
    /// Turns an error of the system into one that names the file.
    pub fn at(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |error| Self::File { path: path.to_owned(), error }
    }
}

/// A number in single precision.
///
/// # Errors
/// A number that is not finite there, with what it is.
pub fn finite(value: f64, time: f64, what: impl FnOnce() -> String) -> Result<f32, FilmError> {
    single(value).ok_or_else(|| FilmError::NotFinite { what: what(), value, time })
}

/// Whether a list has its length.
///
/// # Errors
/// Both lengths, when it has not.
pub fn expect(what: &'static str, found: usize, expected: usize) -> Result<(), FilmError> {
    if found == expected { Ok(()) } else { Err(FilmError::Count { what, found, expected }) }
}
