//! On which line of a file each key stands.

use std::collections::BTreeMap;

use enmm::model::case::key::Key;

/// Starts of the lines of a text.
pub struct LineStarts(Vec<usize>);

impl LineStarts {
    /// Finds the lines of `text`.
    pub fn new(text: &str) -> Self {
        Self(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(i, _)| i + 1).collect())
    }

    /// Returns the line of a byte offset, counted from 1.
    pub fn line(&self, offset: usize) -> usize {
        1 + self.0.partition_point(|start| *start <= offset)
    }
}

/// Lines of keys; a key on the line of its parent is not stored.
#[derive(Debug, Clone, Default)]
pub struct LineMap(BTreeMap<String, usize>);

impl LineMap {
    /// Notes the line of a key, whose parent must have been noted before.
    pub fn insert(&mut self, key: &Key, line: usize) {
        if self.line(key.as_str()) != line {
            self.0.insert(key.to_string(), line);
        }
    }

    /// Returns the line of the longest known beginning of `key`, or 1.
    pub fn line(&self, key: &str) -> usize {
        beginnings(key).find_map(|part| self.0.get(part).copied()).unwrap_or(1)
    }
}

/// Returns `key` and its beginnings that are keys, longest first: `a.b[1]`, `a.b`, `a`.
pub fn beginnings(key: &str) -> impl Iterator<Item = &str> {
    let cuts = key.char_indices().rev().filter(|(_, c)| matches!(c, '.' | '[')).map(|(i, _)| i);
    std::iter::once(key.len()).chain(cuts).map(|end| &key[..end])
}
