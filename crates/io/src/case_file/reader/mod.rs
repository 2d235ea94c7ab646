//! TOML to [`Case`]: walks the parsed text beside the schema of the case, so that every unknown key, missing key and
//! wrong type is an error with its line and a remedy.

mod broken;
mod expected;
mod setting;

use std::collections::BTreeMap;

use serde_json::{Map, Number, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use self::expected::{Expected, Fields, Schema, assigned, example, literal};
use crate::case_error::CaseError;
use crate::lines::{LineMap, LineStarts};
use enmm::model::Case;
use enmm::model::case::key::{Key, edit_distance, list, nearest};

/// A case with the lines of its keys, and the settings by their keys.
type Read = (Case, LineMap, BTreeMap<String, String>);

/// Reads a case and puts the values of `settings` into it.
///
/// # Errors
/// The text is not TOML, or the first unknown key, missing key, wrong type or number that is not finite, in the text or
/// in a setting.
pub fn read(text: &str, file: &str, settings: &[impl AsRef<str>]) -> Result<Read, CaseError> {
    let starts = LineStarts::new(text);
    let syntax = |line, message: String| CaseError::at(file, line, "", message);
    let document = DeTable::parse(text).map_err(|error| {
        if let Some((line, message)) = broken::cause(text) {
            return syntax(line, message);
        }
        let line = error.span().map_or(1, |span| starts.line(span.start));
        if let Some(key) = error.span().and_then(|span| text.get(span)).filter(|_| error.message() == "duplicate key") {
            return syntax(line, format!("not TOML: `{key}` stands twice in its table; remove one"));
        }
        syntax(line, format!("not TOML: {}; correct the line", one_line(error.message())))
    })?;
    let schema = crate::schema();
    let mut reader = Reader { file, starts, lines: LineMap::default() };
    let schema = Schema::new(&schema);
    let mut value = reader.table(document.get_ref(), &schema.fields(), &Key::root())?;
    let settings = setting::put_all(&mut value, schema, settings)?;
    let case = serde_json::from_value(value).map_err(|error| syntax(1, one_line(&error.to_string())))?;
    Ok((case, reader.lines, settings))
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Context of a walk.
struct Reader<'a> {
    file: &'a str,
    starts: LineStarts,
    lines: LineMap,
}

impl Reader<'_> {
    fn fail<T>(&self, key: &Key, message: String) -> Result<T, CaseError> {
        Err(CaseError::at(self.file, self.lines.line(key.as_str()), key.as_str(), message))
    }

    fn value(&mut self, value: &DeValue, schema: &Schema, key: &Key) -> Result<Value, CaseError> {
        let any = schema;
        let schema = &schema.fitting(kind(value));
        match (schema.expected(), value) {
            (Expected::Table(fields), DeValue::Table(table)) => self.table(table, &fields, key),
            (Expected::Array { items, length }, DeValue::Array(array)) => self.array(array, (&items, length), key),
            (Expected::Number, DeValue::Float(text)) => self.number(text.as_str(), key),
            (Expected::Number, DeValue::Integer(text)) if text.radix() == 10 => self.number(text.as_str(), key),
            (Expected::Integer(max), DeValue::Integer(text)) => {
                match u64::from_str_radix(text.as_str(), text.radix()).ok().filter(|value| *value <= max) {
                    Some(value) => Ok(Value::from(value)),
                    None => self.fail(key, format!("is {text}, must be at least 0 and at most {max}; correct it")),
                }
            }
            (Expected::Text, DeValue::String(text)) => Ok(Value::from(text.as_ref())),
            (Expected::Boolean, DeValue::Boolean(value)) => Ok(Value::from(*value)),
            (Expected::Choice(names), DeValue::String(text)) => self.choice(text, &names, key),
            (expected, found) => {
                let remedy =
                    meant(&expected, found).map_or_else(|| example(key, schema), |value| assigned(key, &value));
                self.fail(key, format!("is {}, must be {}; write {remedy}", shown(found), any.words()))
            }
        }
    }

    fn table(&mut self, table: &DeTable, fields: &Fields, key: &Key) -> Result<Value, CaseError> {
        let mut values = Map::new();
        for (name, value) in table {
            let child = key.field(name.get_ref());
            self.lines.insert(&child, self.starts.line(name.span().start));
            let Some(schema) = fields.get(name.get_ref()) else { return self.unknown(name.get_ref(), fields, &child) };
            if fields.are_free() && schema.is_table() && !value.get_ref().is_table() {
                let remedy = example(key, &fields.schema());
                return self.fail(&child, format!("is {}, must be a table; write {remedy}", shown(value.get_ref())));
            }
            values.insert(name.get_ref().to_string(), self.value(value.get_ref(), &schema, &child)?);
        }
        for name in fields.required().filter(|name| !table.contains_key(*name)) {
            let child = key.field(name);
            let Some(schema) = fields.get(name) else { continue };
            let meaning = schema.description().unwrap_or_default();
            let others: Vec<&str> =
                fields.required().filter(|other| *other != name && !table.contains_key(*other)).collect();
            let others =
                if others.is_empty() { String::new() } else { format!("; also missing: {}", others.join(", ")) };
            return self.fail(&child, format!("is missing ({meaning}); add {}{others}", example(&child, &schema)));
        }
        Ok(Value::Object(values))
    }

    fn unknown<T>(&self, name: &str, fields: &Fields, key: &Key) -> Result<T, CaseError> {
        let near = nearest(name, fields.names()).unwrap_or_default();
        let known = list(fields.names());
        self.fail(key, format!("unknown key {name:?}, did you mean `{near}`? Known keys: {known}; rename or remove it"))
    }

    fn array(
        &mut self,
        array: &[Spanned<DeValue>],
        (items, length): (&Schema, Option<usize>),
        key: &Key,
    ) -> Result<Value, CaseError> {
        if let Some(length) = length.filter(|length| *length != array.len()) {
            let sample = vec![literal(items); length].join(", ");
            return self.fail(key, format!("has {} values, must have {length}; write `[{sample}]`", array.len()));
        }
        let mut values = Vec::with_capacity(array.len());
        for (i, value) in array.iter().enumerate() {
            let child = key.index(i);
            self.lines.insert(&child, self.starts.line(value.span().start));
            values.push(self.value(value.get_ref(), items, &child)?);
        }
        Ok(Value::Array(values))
    }

    fn number(&self, text: &str, key: &Key) -> Result<Value, CaseError> {
        match text.parse().ok().and_then(Number::from_f64) {
            Some(number) => Ok(Value::Number(number)),
            None => self.fail(key, format!("is {text}, must be a finite number of at most 1.8e308; correct it")),
        }
    }

    fn choice(&self, text: &str, names: &[&str], key: &Key) -> Result<Value, CaseError> {
        if names.contains(&text) {
            return Ok(Value::from(text));
        }
        let near = nearest(text, names.iter().copied()).unwrap_or_default();
        let known = list(names.iter().copied());
        // Half of the letters are not alike by chance alone.
        if 2 * edit_distance(text, near) >= text.chars().count().max(1) {
            return self.fail(key, format!("is {text:?}, must be one of {known}"));
        }
        self.fail(key, format!("is {text:?}, did you mean {near:?}? It must be one of {known}"))
    }
}

/// Type of a value in the words of a schema, where it is one of parts.
fn kind(value: &DeValue) -> &'static str {
    match value {
        DeValue::Array(_) => "array",
        DeValue::Table(_) => "object",
        _ => "",
    }
}

/// The value that the user meant, where a value of another type leaves no doubt.
fn meant(expected: &Expected, found: &DeValue) -> Option<String> {
    match (expected, found) {
        (Expected::Number | Expected::Integer(_), DeValue::String(text)) => {
            let text = text.trim();
            let points = if text.contains('.') { text.to_owned() } else { text.replace(',', ".") };
            let Some(value) = points.parse().ok().filter(|value: &f64| value.is_finite()) else {
                return in_si(&points).filter(|_| matches!(expected, Expected::Number));
            };
            let whole = points.parse::<u64>().is_ok();
            (matches!(expected, Expected::Number) && value.is_finite() || whole).then_some(points)
        }
        (Expected::Integer(_), DeValue::Float(text)) => {
            let value: f64 = text.as_str().parse().ok()?;
            (value >= 0.0 && value.fract() == 0.0 && value < 9e15).then(|| format!("{value}"))
        }
        (Expected::Text, DeValue::Integer(text)) => Some(format!("\"{text}\"")),
        (Expected::Text, DeValue::Float(text)) => Some(format!("\"{text}\"")),
        (Expected::Boolean, DeValue::String(text)) => {
            let text = text.trim().to_ascii_lowercase();
            matches!(text.as_str(), "true" | "false").then_some(text)
        }
        _ => None,
    }
}

/// A number with a unit as the number in SI units: `20 GPa` is `20e9`.
fn in_si(text: &str) -> Option<String> {
    const PREFIXES: [(&str, &str); 5] = [("", ""), ("k", "e3"), ("M", "e6"), ("G", "e9"), ("m", "e-3")];
    const UNITS: [&str; 5] = ["Pa", "N", "m", "s", "N/m"];
    let end = text.find(|c: char| !(c.is_ascii_digit() || ".+-".contains(c)))?;
    let (number, unit) = (&text[..end], text[end..].trim());
    number.parse::<f64>().ok().filter(|value| value.is_finite())?;
    if matches!(unit, "°" | "deg" | "degrees" | "kg/m3" | "kg/m³") {
        return Some(number.to_owned());
    }
    let power = PREFIXES.iter().find(|(prefix, _)| unit.strip_prefix(prefix).is_some_and(|unit| UNITS.contains(&unit)));
    power.map(|(_, power)| format!("{number}{power}"))
}

/// Longest text of a value that is quoted in a message (characters).
const SHOWN_LENGTH: usize = 40;

/// Returns type and value for a message.
fn shown(value: &DeValue) -> String {
    match value {
        DeValue::String(text) => {
            let short: String = text.chars().take(SHOWN_LENGTH).collect();
            format!("the string {short:?}")
        }
        DeValue::Integer(text) => format!("the integer {text}"),
        DeValue::Float(text) => format!("the number {text}"),
        DeValue::Boolean(value) => format!("the boolean {value}"),
        DeValue::Datetime(value) => format!("the date {value}"),
        DeValue::Array(array) => format!("an array of {} values", array.len()),
        DeValue::Table(table) => format!("a table of {} keys", table.len()),
    }
}
