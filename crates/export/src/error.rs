//! Why results cannot be exported.

use std::path::{Path, PathBuf};

/// Why results cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The folder is not there.
    #[error("{} is no directory: name that of the results, as `enmm run -o` does", .0.display())]
    NoFolder(PathBuf),
    /// The folder holds nothing to export.
    #[error("{}: {message}", path.display())]
    Nothing {
        /// The folder.
        path: PathBuf,
        /// Missing files, and the remedy.
        message: String,
    },
    /// A result cannot be read.
    #[error("{}: {message}; run the command that wrote it again", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// The folder has no such instant.
    #[error("{}: {message}", path.display())]
    NoInstant {
        /// The folder.
        path: PathBuf,
        /// Those that there are, and the remedy.
        message: String,
    },
    /// A result that the format cannot hold.
    #[error("{}: {message}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Number, limit and remedy.
        message: String,
    },
}

impl ExportError {
    /// An error of a file that cannot be read.
    pub(crate) fn unreadable(path: &Path, message: impl ToString) -> Self {
        Self::Unreadable { path: path.to_owned(), message: message.to_string() }
    }
}
