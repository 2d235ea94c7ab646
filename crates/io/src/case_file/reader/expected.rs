//! Type that the JSON Schema of the case expects at a key, and an example of it in TOML.

use std::fmt;

use serde_json::Value;

use enmm::model::case::key::Key;

/// A node of the schema of the case.
#[derive(Clone, Copy)]
pub struct Schema<'a> {
    root: &'a Value,
    node: &'a Value,
}

/// Expected type of a value.
pub enum Expected<'a> {
    /// A table with these keys.
    Table(Fields<'a>),
    /// A list, perhaps of fixed length.
    Array {
        /// Schema of the elements.
        items: Schema<'a>,
        /// Number of elements, if fixed.
        length: Option<usize>,
    },
    /// A finite number.
    Number,
    /// A whole number from 0 to this.
    Integer(u64),
    /// A string.
    Text,
    /// True or false.
    Boolean,
    /// One of these strings.
    Choice(Vec<&'a str>),
}

/// Keys of a table.
pub struct Fields<'a>(Schema<'a>);

impl<'a> Schema<'a> {
    /// Returns the schema of the whole case.
    pub fn new(root: &'a Value) -> Self {
        Self { root, node: root }
    }

    /// Returns the keys, for a schema that is a table.
    pub fn fields(self) -> Fields<'a> {
        Fields(self.resolved())
    }

    /// Returns the first sentence of the doc comment.
    pub fn description(&self) -> Option<&'a str> {
        let text = self.node.get("description")?.as_str()?;
        Some(text.split(['.', ';', '\n']).next().unwrap_or(text))
    }

    /// Returns a number that is usual for the key.
    fn example(&self) -> Option<f64> {
        self.node.get("examples")?.get(0)?.as_f64()
    }

    /// Returns what the schema expects.
    pub fn expected(self) -> Expected<'a> {
        let Self { node, .. } = self.resolved();
        if let Some(choices) = node.get("oneOf").and_then(Value::as_array) {
            return Expected::Choice(choices.iter().filter_map(|choice| choice.get("const")?.as_str()).collect());
        }
        match self.kind() {
            "object" => Expected::Table(self.fields()),
            "array" => Expected::Array {
                items: self.at(node.get("items").unwrap_or(&Value::Null)),
                length: node.get("minItems").and_then(Value::as_u64).and_then(|length| usize::try_from(length).ok()),
            },
            "integer" if node.get("format").and_then(Value::as_str) == Some("uint32") => {
                Expected::Integer(u64::from(u32::MAX))
            }
            "integer" => Expected::Integer(u64::MAX),
            "boolean" => Expected::Boolean,
            "string" => Expected::Text,
            _ => Expected::Number,
        }
    }

    /// Returns the alternative for a list (`array`), a table (`object`) or any other value (an empty word); the schema
    /// itself where there are none.
    pub fn fitting(self, kind: &str) -> Self {
        let alternatives = self.resolved().node.get("anyOf").and_then(Value::as_array);
        let all = alternatives.into_iter().flatten().map(|alternative| self.at(alternative));
        let fits =
            |schema: &Self| ["array", "object"].iter().all(|parts| (schema.kind() == *parts) == (kind == *parts));
        all.into_iter().find(fits).unwrap_or(self)
    }

    /// Returns all alternatives in words, such as `true or false, or a list of …`.
    pub fn words(self) -> String {
        let alternatives = self.resolved().node.get("anyOf").and_then(Value::as_array);
        let all = alternatives.into_iter().flatten().map(|alternative| self.at(alternative));
        let words: Vec<String> = all.map(|schema| schema.expected().to_string()).collect();
        if words.is_empty() { self.expected().to_string() } else { words.join(", or ") }
    }

    /// Whether it is that of a table.
    pub fn is_table(&self) -> bool {
        self.kind() == "object"
    }

    fn at(&self, node: &'a Value) -> Self {
        Self { root: self.root, node }
    }

    /// Returns the type, that of the value where it may be left out.
    fn kind(&self) -> &'a str {
        match self.resolved().node.get("type") {
            Some(Value::Array(kinds)) => kinds.iter().filter_map(Value::as_str).find(|kind| *kind != "null"),
            kind => kind.and_then(Value::as_str),
        }
        .unwrap_or_default()
    }

    /// Follows references and the first of alternatives.
    fn resolved(self) -> Self {
        let alternative = self.node.get("anyOf").and_then(|alternatives| alternatives.get(0)).unwrap_or(self.node);
        let reference = alternative.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix('#'));
        self.at(reference.and_then(|path| self.root.pointer(path)).unwrap_or(alternative))
    }
}

impl<'a> Fields<'a> {
    /// Returns the schema of a key, or none if the key is unknown.
    pub fn get(&self, name: &str) -> Option<Schema<'a>> {
        let node = self.0.node;
        let others = || node.get("additionalProperties").filter(|schema| schema.is_object());
        let schema = node.get("properties").and_then(|properties| properties.get(name)).or_else(others)?;
        Some(self.0.at(schema))
    }

    /// Returns the known keys.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        self.0.node.get("properties").and_then(Value::as_object).into_iter().flatten().map(|(name, _)| name.as_str())
    }

    /// Returns the keys that must be there.
    pub fn required(&self) -> impl Iterator<Item = &'a str> {
        self.0.node.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
    }

    /// Returns the schema of the table.
    pub fn schema(&self) -> Schema<'a> {
        self.0
    }

    /// Returns whether the keys are names that the user chooses.
    pub fn are_free(&self) -> bool {
        self.names().next().is_none()
    }
}

impl fmt::Display for Expected<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table(_) => f.write_str("a table"),
            Self::Array { items, .. } if items.kind() == "object" => f.write_str("an array of tables"),
            Self::Array { length: Some(length), .. } => write!(f, "an array of {length} values"),
            Self::Array { items, length: None } => match items.expected() {
                Self::Choice(names) => write!(f, "an array of some of the strings {}", names.join(", ")),
                _ => f.write_str("an array"),
            },
            Self::Number => f.write_str("a number"),
            Self::Integer(_) => f.write_str("a whole number"),
            Self::Text => f.write_str("a string"),
            Self::Boolean => f.write_str("true or false"),
            Self::Choice(names) => write!(f, "one of the strings {}", names.join(", ")),
        }
    }
}

/// Returns one line of TOML that gives `key` an acceptable value: `size = 1.0`, or the header and keys of a section.
pub fn example(key: &Key, schema: &Schema) -> String {
    let header = without_indices(key.as_str());
    let section = match schema.expected() {
        Expected::Table(fields) if fields.are_free() => {
            fields.get("NAME").filter(Schema::is_table).map(|item| (format!("[{header}.NAME]"), item))
        }
        Expected::Table(_) => Some((format!("[{header}]"), *schema)),
        Expected::Array { items, .. } if items.kind() == "object" => Some((format!("[[{header}]]"), items)),
        _ => None,
    };
    if let Some((header, table)) = section {
        let fields = table.fields();
        let needed = fields.required().filter_map(|name| Some(format!("{name} = {}", literal(&fields.get(name)?))));
        let needed = needed.collect::<Vec<_>>().join(", ");
        return if needed.is_empty() { format!("`{header}`") } else { format!("`{header}` with `{needed}`") };
    }
    assigned(key, &literal(schema))
}

/// Returns the line of TOML that gives `key` a value; of an element of a list the value alone.
pub fn assigned(key: &Key, value: &str) -> String {
    match without_indices(key.as_str()).rsplit('.').next() {
        Some(name) if !key.as_str().ends_with(']') => format!("`{name} = {value}`"),
        _ => format!("`{value}`"),
    }
}

/// Returns an acceptable value: the example of the schema, if it has one.
pub fn literal(schema: &Schema) -> String {
    if let Some(example) = schema.example() {
        return number(example);
    }
    match schema.expected() {
        Expected::Table(fields) => {
            let item = fields.get("NAME").filter(|item| fields.are_free() && !item.is_table());
            item.map_or("{ }".to_string(), |item| format!("{{ NAME = {} }}", literal(&item)))
        }
        Expected::Array { items, length } => format!("[{}]", vec![literal(&items); length.unwrap_or(1)].join(", ")),
        Expected::Number => "1.0".to_string(),
        Expected::Integer(_) => "1".to_string(),
        Expected::Text => "\"name\"".to_string(),
        Expected::Boolean => "true".to_string(),
        Expected::Choice(names) => format!("{:?}", names.first().unwrap_or(&"")),
    }
}

/// Writes a number in TOML: `2700.0`, `1e10`.
fn number(value: f64) -> String {
    if (1e-3..1e6).contains(&value.abs()) { format!("{value:?}") } else { format!("{value:e}") }
}

/// Removes the indices of a key: `stage[0].law` becomes `stage.law`.
fn without_indices(key: &str) -> String {
    key.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect()
}
