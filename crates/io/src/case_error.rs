//! Errors of input files, each one line that names the file, the line and the key.

use std::io::Read;
use std::path::Path;

use thiserror::Error;

use super::files::open_input;

/// Why an input file cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CaseError {
    /// The file cannot be read at all.
    #[error("{file}: {message}")]
    Unreadable {
        /// File as the user named it.
        file: String,
        /// The fault and the remedy.
        message: String,
    },
    /// A line, or the file as a whole, is not of its format.
    #[error("{file}:{line}: {message}")]
    Syntax {
        /// File as the user named it.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// The fault and the remedy.
        message: String,
    },
    /// A value that the command line sets cannot be used.
    #[error("--set {setting}: {message}")]
    Setting {
        /// Key and value as the user wrote them.
        setting: String,
        /// The fault, the value, the limit and the remedy.
        message: String,
    },
    /// A value cannot be used.
    #[error("{file}:{line}: {key}: {message}")]
    Value {
        /// File as the user named it.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Position in the file, such as `rock.granite.young`.
        key: String,
        /// The fault, the value, the limit and the remedy.
        message: String,
    },
}

impl CaseError {
    /// Returns the error at a line and a key; an empty key means the line or the file as a whole.
    pub(super) fn at(file: &str, line: usize, key: &str, message: impl Into<String>) -> Self {
        let (file, key, message) = (file.to_string(), key.to_string(), message.into());
        if key.is_empty() { Self::Syntax { file, line, message } } else { Self::Value { file, line, key, message } }
    }
}

/// A text as a message may show it: in quotes if it `looks` like what was asked for, else by a word alone, since the
/// file may be any file of the user, such as one with passwords.
pub(super) fn shown(text: &str, looks: bool) -> String {
    if looks { format!("{text:?}") } else { "the line".to_owned() }
}

/// Whether a text is made of the signs of numbers alone.
pub(super) fn is_numeric(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | ';' | 'e' | 'E' | ' ' | '\t'))
}

/// Whether a text is a number with a slip in it, such as `0.1g`, or too short to give anything away.
pub(super) fn is_nearly_numeric(text: &str) -> bool {
    text.len() <= 3 || text.len() <= 24 && text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// Largest input file (bytes).
const SIZE_MAX: u64 = 1 << 28;

/// Reads a text file.
///
/// # Errors
/// A message without the file's name: the file cannot be opened, is too large, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, String> {
    let unreadable = |error: std::io::Error| format!("cannot read the file ({error}); check its path and permissions");
    let mut bytes = Vec::new();
    let file = open_input(path).map_err(unreadable)?;
    file.take(SIZE_MAX + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > SIZE_MAX {
        return Err(format!("the file has more than {SIZE_MAX} bytes, the limit; split or thin it"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let position = error.utf8_error().valid_up_to();
        format!("byte {position} is not UTF-8 text, which input files must be; save the file as UTF-8 text")
    })
}
