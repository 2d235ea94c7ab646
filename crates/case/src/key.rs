//! Keys: how a place in a case is written in messages, the error there, and which known name is nearest
//! to a wrong one.

use std::fmt;

use thiserror::Error;

/// A value of a case that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key}: {message}")]
pub struct Invalid {
    /// Place in the case, such as `rock.granite.young` or `joint[3].points[1]`.
    pub key: String,
    /// The fault, the value, the limit and the remedy.
    pub message: String,
}

/// Outcome of a check.
pub type Check = Result<(), Invalid>;

/// Returns the error at `key`.
pub fn invalid(key: &Key, message: impl Into<String>) -> Invalid {
    Invalid { key: key.to_string(), message: message.into() }
}

/// Fails at `key`.
///
/// # Errors
/// Always.
pub fn fail(key: &Key, message: impl Into<String>) -> Check {
    Err(invalid(key, message))
}

/// A place in a case, written as in messages: `rock.granite.young`, `joint[3].points[1]`.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key(String);

impl Key {
    /// Returns the key of the whole case, which is empty.
    pub fn root() -> Self {
        Self::default()
    }

    /// Returns the key of a field, quoted if it is no bare TOML key.
    pub fn field(&self, name: &str) -> Self {
        let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
        let name = if bare { name.to_string() } else { format!("{name:?}") };
        if self.0.is_empty() { Self(name) } else { Self(format!("{}.{name}", self.0)) }
    }

    /// Returns the key of an element of a list, counted from 0.
    pub fn index(&self, index: usize) -> Self {
        Self(format!("{}[{index}]", self.0))
    }

    /// Returns the key as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Longest name that takes part in a comparison (characters); the rest of a longer one is not looked at.
const COMPARED_LENGTH: usize = 64;

/// Returns the candidate that begins with `name`, which was cut short, or else that with the smallest edit distance to
/// it; the first of equals, or none if there is none.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let is_cut = |candidate: &str| candidate.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    candidates.into_iter().min_by_key(|candidate| (!is_cut(candidate), edit_distance(name, candidate)))
}

/// Returns the number of insertions, deletions and replacements that turn `a` into `b`, letter case ignored.
pub fn edit_distance(a: &str, b: &str) -> usize {
    let letters = |text: &str| text.chars().take(COMPARED_LENGTH).map(|c| c.to_ascii_lowercase()).collect::<Vec<_>>();
    let (a, b) = (letters(a), letters(b));
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

/// Joins names for a message: `a, b, c`, or `none`.
pub fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    if names.is_empty() { "none".to_string() } else { names.join(", ") }
}
