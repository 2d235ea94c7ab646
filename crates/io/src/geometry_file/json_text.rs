//! JSON text with the lines of its keys, and points read from it.

use std::collections::BTreeSet;

use serde_json::Value;

use super::upright::Plane;
use crate::case_error::CaseError;
use crate::lines::{LineMap, LineStarts};
use enmm::model::case::PointList;
use enmm::model::case::key::Key;

/// A parsed JSON file.
pub struct Document<'a> {
    /// File as the user named it.
    pub file: &'a str,
    /// Lines of the keys.
    pub lines: LineMap,
    /// The whole value.
    pub value: Value,
}

impl<'a> Document<'a> {
    /// Parses `text`.
    ///
    /// # Errors
    /// A bare `NaN` or `Infinity` stands in it, a key stands twice in one object, or it is not JSON.
    pub fn parse(file: &'a str, text: &str) -> Result<Self, CaseError> {
        let whole = one_value(text);
        let text = whole.as_deref().unwrap_or(text);
        let mut scan = Scan { starts: LineStarts::new(text), lines: LineMap::default(), open: Vec::new() };
        let refused = scan.run(text);
        let mut document = Self { file, lines: scan.lines, value: Value::Null };
        if let Err((key, message)) = refused {
            return document.fail(&key, message);
        }
        document.value = serde_json::from_str(text).map_err(|error| {
            CaseError::at(file, error.line().max(1), "", format!("not JSON: {error}; correct the line"))
        })?;
        Ok(document)
    }

    /// Returns the error at a key.
    ///
    /// # Errors
    /// Always.
    pub fn fail<T>(&self, key: &Key, message: impl Into<String>) -> Result<T, CaseError> {
        Err(CaseError::at(self.file, self.lines.line(key.as_str()), key.as_str(), message))
    }

    /// Returns the elements of an array, each with its key.
    ///
    /// # Errors
    /// The value is no array.
    pub fn elements<'v>(&self, key: &Key, value: &'v Value) -> Result<Vec<(Key, &'v Value)>, CaseError> {
        match value.as_array() {
            Some(array) => Ok(array.iter().enumerate().map(|(i, value)| (key.index(i), value)).collect()),
            None => self.fail(key, format!("is {}, must be an array; write `[…]`", shown(value))),
        }
    }

    /// Returns the points of an array of coordinates in a plane, and how many had more than two coordinates.
    ///
    /// # Errors
    /// The first value that is no point.
    pub fn points(&self, key: &Key, value: &Value, plane: Plane) -> Result<(PointList, usize), CaseError> {
        let list = self.elements(key, value)?;
        let mut points = Vec::with_capacity(list.len());
        let mut high = 0;
        for (key, value) in &list {
            let coordinates = self.elements(key, value)?;
            let [x, y, rest @ ..] = coordinates.as_slice() else {
                return self.fail(key, format!("has {} coordinates, must have 2; write `[x, y]`", coordinates.len()));
            };
            let height = rest.first().filter(|_| plane != Plane::Flat);
            let z = height.map_or(Ok(0.0), |z| self.coordinate(z))?;
            points.push(plane.point([self.coordinate(x)?, self.coordinate(y)?, z]));
            high += usize::from(!rest.is_empty());
        }
        Ok((points, high))
    }

    /// Returns a number; those that are not finite may be strings, and are judged with the rest of the case.
    fn coordinate(&self, (key, value): &(Key, &Value)) -> Result<f64, CaseError> {
        let number = match value {
            Value::String(text) => text.trim().parse::<f64>().ok().filter(|value| !value.is_finite()),
            value => value.as_f64(),
        };
        match number {
            Some(number) => Ok(number),
            None => self.fail(key, format!("is {}, must be a number; write `1.0`", shown(value))),
        }
    }
}

/// Sign before each value of a sequence (RFC 8142).
const RECORD: char = '\u{1e}';

/// Values one after the other, such as a feature a line (RFC 8142 and newline-delimited GeoJSON), as one collection on
/// the same lines; none where the text is one value, or no JSON.
fn one_value(text: &str) -> Option<String> {
    let plain = if text.contains(RECORD) { text.replace(RECORD, " ") } else { text.to_owned() };
    let mut values = serde_json::Deserializer::from_str(&plain).into_iter::<serde::de::IgnoredAny>();
    let mut whole = String::from("{\"type\": \"FeatureCollection\", \"features\": [");
    let (mut from, mut count) = (0, 0);
    while let Some(value) = values.next() {
        value.ok()?;
        whole += if count == 0 { "" } else { "," };
        whole += &plain[from..values.byte_offset()];
        (from, count) = (values.byte_offset(), count + 1);
    }
    (count > 1 || count == 1 && plain != text).then(|| whole + "]}")
}

/// Longest text of a value that is quoted in a message (characters).
const SHOWN_LENGTH: usize = 40;

/// Returns type and value for a message.
pub fn shown(value: &Value) -> String {
    match value {
        Value::Array(array) => format!("an array of {} values", array.len()),
        Value::Object(object) => format!("an object of {} keys", object.len()),
        Value::String(text) => format!("the string {:?}", text.chars().take(SHOWN_LENGTH).collect::<String>()),
        other => other.to_string(),
    }
}

/// Depth of nesting at which the scan stops; the parser refuses such text.
const DEPTH_MAX: usize = 128;

/// One pass over JSON text, valid or not, that finds the lines of keys.
struct Scan {
    starts: LineStarts,
    lines: LineMap,
    open: Vec<Frame>,
}

/// An array or object that is open.
struct Frame {
    key: Key,
    /// Key of the value that comes next.
    next: Key,
    /// Elements so far; none for an object.
    index: Option<usize>,
    /// Keys so far.
    names: BTreeSet<String>,
    /// Whether the next string is a key.
    at_key: bool,
}

impl Scan {
    /// Notes lines until the end, or returns key and message of the first thing that the parser would accept: a bare
    /// token that is a number to others but not to JSON, or a key that stands twice.
    fn run(&mut self, text: &str) -> Result<(), (Key, String)> {
        let bytes = text.as_bytes();
        let mut at = 0;
        while at < bytes.len() && self.open.len() <= DEPTH_MAX {
            let start = at;
            at += match bytes[at] {
                b'"' => string_length(&bytes[at..]),
                byte if is_delimiter(byte) => 1,
                _ => bytes[at..].iter().take_while(|byte| !is_delimiter(**byte)).count(),
            };
            let token = &text[start..at];
            if !is_delimiter(bytes[start]) {
                self.lines.insert(&self.next_key(), self.starts.line(start));
            }
            match bytes[start] {
                open @ (b'[' | b'{') => self.open(open == b'[', start),
                b']' | b'}' => drop(self.open.pop()),
                b',' => self.advance(),
                b'"' => self.name(token.trim_matches('"'), start)?,
                _ if token.parse::<f64>().is_ok_and(|value| !value.is_finite()) && !has_digit(token) => {
                    return Err((self.next_key(), format!("is {token}, must be a finite number; correct it")));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn next_key(&self) -> Key {
        self.open.last().map_or_else(Key::root, |frame| frame.next.clone())
    }

    fn open(&mut self, is_array: bool, offset: usize) {
        let key = self.next_key();
        self.lines.insert(&key, self.starts.line(offset));
        let next = if is_array { key.index(0) } else { key.clone() };
        let index = is_array.then_some(0);
        self.open.push(Frame { key, next, index, names: BTreeSet::new(), at_key: !is_array });
    }

    fn advance(&mut self) {
        let Some(frame) = self.open.last_mut() else { return };
        match &mut frame.index {
            Some(index) => {
                *index += 1;
                frame.next = frame.key.index(*index);
            }
            None => frame.at_key = true,
        }
    }

    fn name(&mut self, name: &str, offset: usize) -> Result<(), (Key, String)> {
        let Some(frame) = self.open.last_mut().filter(|frame| frame.at_key) else { return Ok(()) };
        frame.at_key = false;
        frame.next = frame.key.field(name);
        self.lines.insert(&frame.next, self.starts.line(offset));
        if !frame.names.insert(name.to_string()) {
            return Err((frame.next.clone(), "stands twice in one object; remove one".to_string()));
        }
        Ok(())
    }
}

fn is_delimiter(byte: u8) -> bool {
    matches!(byte, b'[' | b']' | b'{' | b'}' | b',' | b':' | b'"') || byte.is_ascii_whitespace()
}

fn has_digit(token: &str) -> bool {
    token.bytes().any(|byte| byte.is_ascii_digit())
}

/// Returns the length of a string with its quotes, or of the rest if it does not end.
fn string_length(bytes: &[u8]) -> usize {
    let mut escaped = false;
    for (i, byte) in bytes.iter().enumerate().skip(1) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return i + 1,
            _ => {}
        }
    }
    bytes.len()
}
