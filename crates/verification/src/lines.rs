//! JSON that is indented down to a level; what lies deeper stands on one line, so that a change of it is one of a line.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};

/// A value as text, indented down to `levels`.
pub fn json(value: &impl Serialize, levels: usize) -> String {
    let mut bytes = Vec::new();
    let lines = Lines { pretty: PrettyFormatter::new(), depth: 0, levels };
    // Memory takes every byte, and records have no keys but texts: nothing can fail to be written.
    let _ = value.serialize(&mut Serializer::with_formatter(&mut bytes, lines));
    bytes.push(b'\n');
    String::from_utf8_lossy(&bytes).into_owned()
}

struct Lines<'a> {
    pretty: PrettyFormatter<'a>,
    /// Containers that are open.
    depth: usize,
    levels: usize,
}

impl Lines<'_> {
    fn is_deep(&self) -> bool {
        self.depth > self.levels
    }
}

/// Separator in front of an entry on a line.
fn separator(first: bool) -> &'static [u8] {
    if first { b"" } else { b", " }
}

impl Formatter for Lines<'_> {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        if self.is_deep() { writer.write_all(b"[") } else { self.pretty.begin_array(writer) }
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let deep = self.is_deep();
        self.depth -= 1;
        if deep { writer.write_all(b"]") } else { self.pretty.end_array(writer) }
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        let deep = self.is_deep();
        if deep { writer.write_all(separator(first)) } else { self.pretty.begin_array_value(writer, first) }
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_deep() { Ok(()) } else { self.pretty.end_array_value(writer) }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        if self.is_deep() { writer.write_all(b"{") } else { self.pretty.begin_object(writer) }
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let deep = self.is_deep();
        self.depth -= 1;
        if deep { writer.write_all(b"}") } else { self.pretty.end_object(writer) }
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        let deep = self.is_deep();
        if deep { writer.write_all(separator(first)) } else { self.pretty.begin_object_key(writer, first) }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.pretty.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_deep() { Ok(()) } else { self.pretty.end_object_value(writer) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_deep_stands_on_one_line() {
        let value = serde_json::json!({"empty": [], "rows": [{"a": [1.5, null], "b": {}}, {"a": "x"}]});
        let text = json(&value, 2);
        assert_eq!(
            text,
            "{\n  \"empty\": [],\n  \"rows\": [\n    {\"a\": [1.5, null], \"b\": {}},\n    {\"a\": \"x\"}\n  ]\n}\n"
        );
        let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(read, value);
    }
}
