//! Why a table or the sets in it cannot be used.

/// Why a table or the sets in it cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FieldError {
    /// A line of the table.
    #[error("{file}:{line}: {message}")]
    Line {
        /// File as the user named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, value, limit and remedy.
        message: String,
    },
    /// The table as a whole, or what is asked of it.
    #[error("{0}")]
    Whole(String),
}
