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
pub struct LineMap {
    keys: BTreeMap<String, usize>,
    /// The one long list of a file, whose entries have no other keys: half a million keys take half a second.
    list: LineList,
}

/// Lines of a list, of its entries and of theirs: `entity[12][1]`.
#[derive(Debug, Clone, Default)]
struct LineList {
    name: String,
    /// Line of each entry.
    lines: Vec<usize>,
    /// Where the lines of the entries of each entry begin.
    starts: Vec<usize>,
    /// Lines of their entries, those of one entry after the other.
    entries: Vec<usize>,
}

impl LineMap {
    /// Notes the line of a key, whose parent must have been noted before.
    pub fn insert(&mut self, key: &Key, line: usize) {
        if self.line(key.as_str()) != line {
            self.keys.insert(key.to_string(), line);
        }
    }

    /// Notes the lines of the next entry of the list that has this name, the only one of a file, and of its entries.
    pub fn push(&mut self, name: &str, line: usize, entries: &[usize]) {
        let list = &mut self.list;
        if list.name != name {
            *list = LineList { name: name.to_owned(), ..LineList::default() };
        }
        list.lines.push(line);
        list.starts.push(list.entries.len());
        list.entries.extend(entries);
    }

    /// Returns the line of the longest known beginning of `key`, or 1.
    pub fn line(&self, key: &str) -> usize {
        let known = |part| self.keys.get(part).copied().or_else(|| self.list.line(part));
        beginnings(key).find_map(known).unwrap_or(1)
    }
}

impl LineList {
    /// Line of an entry, or of one of its entries.
    fn line(&self, key: &str) -> Option<usize> {
        let mut places = key.strip_prefix(&self.name)?.split_inclusive(']');
        let mut next = || places.next().map(|place| place.strip_prefix('[')?.strip_suffix(']')?.parse::<usize>().ok());
        let (entry, of_entry, end) = (next()??, next(), next());
        let line = *self.lines.get(entry)?;
        let Some(of_entry) = of_entry else { return Some(line) };
        let last = self.starts.get(entry + 1).copied().unwrap_or(self.entries.len());
        let own = self.entries.get(self.starts[entry]..last)?;
        if end.is_some() { None } else { own.get(of_entry?).copied() }
    }
}

/// Returns `key` and its beginnings that are keys, longest first: `a.b[1]`, `a.b`, `a`.
pub fn beginnings(key: &str) -> impl Iterator<Item = &str> {
    let cuts = key.char_indices().rev().filter(|(_, c)| matches!(c, '.' | '[')).map(|(i, _)| i);
    std::iter::once(key.len()).chain(cuts).map(|end| &key[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_a_list_have_the_longest_beginning_that_is_known() {
        let mut map = LineMap::default();
        map.insert(&Key::root().field("title"), 3);
        map.push("entity", 5, &[6, 9]);
        map.push("entity", 12, &[]);
        map.push("entity", 20, &[21]);
        let lines = [
            ("title", 3),
            ("entity", 1),
            ("entity[0]", 5),
            ("entity[0][0]", 6),
            ("entity[0][1]", 9),
            ("entity[0][2]", 5),
            ("entity[0][1][0]", 9),
            ("entity[0].law", 5),
            ("entity[1]", 12),
            ("entity[1][0]", 12),
            ("entity[2][0]", 21),
            ("entity[2][1]", 20),
            ("entity[3]", 1),
            ("entities[0]", 1),
        ];
        for (key, line) in lines {
            assert_eq!(map.line(key), line, "{key}");
        }
        assert_eq!(LineMap::default().line("[0]"), 1);
    }
}
