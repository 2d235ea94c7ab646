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

/// First bytes of a binary drawing.
const BINARY_DXF: &[u8] = b"AutoCAD Binary DXF";

/// Byte order mark.
const MARK: char = '\u{feff}';

/// Reads a text file.
///
/// # Errors
/// A message without the file's name: the file cannot be opened, is too large, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, String> {
    let text = String::from_utf8(read_bytes(path)?).map_err(|error| {
        let position = error.utf8_error().valid_up_to();
        format!("byte {position} is not UTF-8 text, which input files must be; save the file as UTF-8 text")
    })?;
    Ok(unmarked(text))
}

/// A text without the byte order mark that some editors and exports put before it.
fn unmarked(mut text: String) -> String {
    if text.starts_with(MARK) {
        text.drain(..MARK.len_utf8());
    }
    text
}

/// Reads a record, whose head may have names of places in the code page of Western Europe.
///
/// # Errors
/// A message without the file's name: the file cannot be opened, is too large or binary.
pub fn read_record(path: &Path) -> Result<String, String> {
    let mut bytes = read_bytes(path)?;
    let mark = MARK.to_string();
    if bytes.starts_with(mark.as_bytes()) {
        bytes.drain(..mark.len());
    }
    if bytes.contains(&0) {
        return Err("it is binary, and records are read as text; download it as ASCII or save it as CSV".to_string());
    }
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| error.into_bytes().into_iter().map(western).collect()))
}

/// Reads a DXF drawing, which before 2007 is in the code page that it names.
///
/// # Errors
/// A message without the file's name: the file cannot be opened, is too large or binary, or its code page is not read.
pub fn read_drawing(path: &Path) -> Result<String, String> {
    let bytes = read_bytes(path)?;
    if bytes.starts_with(BINARY_DXF) {
        return Err("it is a binary DXF, which is not read; save the drawing as ASCII DXF".to_string());
    }
    let bytes = match String::from_utf8(bytes) {
        Ok(text) => return Ok(unescaped(unmarked(text))),
        Err(error) => error.into_bytes(),
    };
    let page = code_page(&bytes);
    if page.is_some_and(|page| !page.eq_ignore_ascii_case("ANSI_1252")) {
        let page = page.unwrap_or_default();
        return Err(format!(
            "it is text in the code page {page:?}, and UTF-8 and ANSI_1252 are read; save it as DXF 2007"
        ));
    }
    Ok(unescaped(bytes.into_iter().map(western).collect()))
}

/// A text with the signs that DXF writes as `\\U+00E4`.
fn unescaped(text: String) -> String {
    const MARK: &str = "\\U+";
    if !text.contains(MARK) {
        return text;
    }
    let mut parts = text.split(MARK);
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let code = part.get(..4).and_then(|digits| u32::from_str_radix(digits, 16).ok());
        match code.and_then(char::from_u32).filter(|sign| !sign.is_control()) {
            Some(sign) => whole.extend([sign.to_string().as_str(), &part[4..]]),
            None => whole.extend([MARK, part]),
        }
    }
    whole
}

/// The code page that the header of a drawing names.
fn code_page(bytes: &[u8]) -> Option<&str> {
    let start = bytes.windows(12).position(|part| part == b"$DWGCODEPAGE")?;
    let line = bytes[start..].split(|byte| *byte == b'\n').nth(2)?;
    std::str::from_utf8(line).ok().map(str::trim)
}

/// Signs of ANSI_1252 between 0x80 and 0x9f, where it is not Latin-1.
const WESTERN: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

fn western(byte: u8) -> char {
    byte.checked_sub(0x80).and_then(|k| WESTERN.get(usize::from(k)).copied()).unwrap_or(char::from(byte))
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |error: std::io::Error| format!("cannot read the file ({error}); check its path and permissions");
    let mut bytes = Vec::new();
    let file = open_input(path).map_err(unreadable)?;
    file.take(SIZE_MAX + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > SIZE_MAX {
        return Err(format!("the file has more than {SIZE_MAX} bytes, the limit; split or thin it"));
    }
    Ok(bytes)
}
