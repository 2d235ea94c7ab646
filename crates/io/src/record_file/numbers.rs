//! Numbers as programs in Fortran write them: fields of fixed width that may touch, and exponents with D.

use crate::case_error::is_nearly_numeric;

/// Width of the fields of a line; 0 where the head does not give it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Layout {
    pub width: usize,
}

impl Layout {
    /// The width in a format such as `(8F10.6)` at the end of a text.
    pub fn of(text: &str) -> Self {
        let format = text.rsplit_once('(').map_or("", |(_, format)| format);
        let digits = format.trim_start_matches(|c: char| c.is_ascii_digit());
        let digits = digits.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        Self { width: digits[..end].parse().unwrap_or(0) }
    }
}

/// The numbers of a line.
///
/// # Errors
/// A field that is no finite number; a message shows no word, which may be of any other file.
pub fn numbers(line: &str, layout: Layout) -> Result<Vec<f64>, String> {
    let free = separated(line);
    if free.iter().all(Result::is_ok) {
        return free.into_iter().collect();
    }
    if layout.width > 0 && line.is_ascii() {
        let fields: Vec<&str> = (0..line.len())
            .step_by(layout.width)
            .map(|from| line[from..line.len().min(from + layout.width)].trim())
            .filter(|field| !field.is_empty())
            .collect();
        if let Ok(values) = fields.into_iter().map(number).collect() {
            return Ok(values);
        }
    }
    free.into_iter().collect()
}

/// Fields that blanks, commas or the sign of the next one part.
fn separated(line: &str) -> Vec<Result<f64, String>> {
    let mut found = Vec::new();
    for word in line.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty()) {
        let (bytes, mut from) = (word.as_bytes(), 0);
        for k in 1..bytes.len() {
            if matches!(bytes[k], b'+' | b'-') && !matches!(bytes[k - 1], b'e' | b'E' | b'd' | b'D') {
                found.push(number(&word[from..k]));
                from = k;
            }
        }
        found.push(number(&word[from..]));
    }
    found
}

/// A finite number.
///
/// # Errors
/// Another text, which is shown where it looks like a number.
pub fn number(field: &str) -> Result<f64, String> {
    let fault = |fault: &str| match is_nearly_numeric(field) {
        true => format!("{field:?} is {fault}"),
        false => format!("a value is {fault}"),
    };
    let read = field.parse::<f64>().or_else(|_| field.replace(['d', 'D'], "e").parse::<f64>());
    match read {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(fault("not finite")),
        Err(_) => Err(fault("no number")),
    }
}

/// The first number at the beginning of a text, after blanks and signs of `=`, `:`.
pub fn leading(text: &str) -> Option<f64> {
    let text = text.trim_start_matches([' ', '\t', '=', ':']);
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eEdD".contains(c))).unwrap_or(text.len());
    let end = (0..=end).rev().find(|end| text.is_char_boundary(*end) && number(&text[..*end]).is_ok())?;
    number(&text[..end]).ok()
}

/// A count at the beginning of a text; none if it is no whole number.
pub fn count(text: &str) -> Option<usize> {
    leading(text).filter(|value| *value >= 0.0 && value.fract() == 0.0 && *value < 1e12).map(|value| value as usize)
}
