//! By what a stored sample is found again.

use std::collections::BTreeMap;
use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::draw::Value;

/// All that a sample depends on besides its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Identity {
    /// Fingerprint of the case.
    pub case: String,
    /// Version of the engine.
    pub version: String,
    /// Name of the output.
    pub output: String,
    /// Options of the search that were given.
    pub options: BTreeMap<String, Given>,
}

/// An option that was given.
#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    /// A number, such as a tolerance.
    Number(f64),
    /// A name, such as that of a stage.
    Name(String),
}

/// Key of a sample in the store, 64 hexadecimal digits: SHA-256 of lines with all that the sample depends on, numbers
/// as the hexadecimal digits of their bits, whole numbers in decimal digits.
pub fn sample_key(identity: &Identity, values: &[(String, Value)]) -> String {
    let Identity { case, version, output, options } = identity;
    let mut text = format!("enmm sample 1\ncase {case}\nversion {version}\noutput {output}\n");
    let mut line = |what: &str, name: &str, value: String| {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{what} {name} {value}");
    };
    for (name, value) in options {
        match value {
            Given::Number(number) => line("option", name, bits(*number)),
            Given::Name(text) => line("option", name, format!("{text:?}")),
        }
    }
    let sorted: BTreeMap<&String, &Value> = values.iter().map(|(key, value)| (key, value)).collect();
    for (key, value) in sorted {
        let value = match value {
            Value::Number(number) => bits(*number),
            Value::Whole(whole) => whole.to_string(),
        };
        line("value", key, value);
    }
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn bits(value: f64) -> String {
    format!("{:016x}", value.to_bits())
}
