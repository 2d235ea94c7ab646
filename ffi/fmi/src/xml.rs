//! A small builder of XML: elements with attributes, escaped, indented, the same bytes for the same calls.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};

/// Names and values of attributes, in order.
pub type Attributes<'a> = [(&'a str, String)];

/// A document in the making.
pub struct Xml {
    writer: Writer<Vec<u8>>,
}

impl Xml {
    /// Begins a document in UTF-8.
    pub fn new() -> io::Result<Self> {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        Ok(Self { writer })
    }

    /// Writes an element without content.
    pub fn leaf(&mut self, name: &str, attributes: &Attributes) -> io::Result<()> {
        self.writer.write_event(Event::Empty(start(name, attributes)))
    }

    /// Writes an element around what `inside` writes.
    pub fn element(
        &mut self,
        name: &str,
        attributes: &Attributes,
        inside: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        self.writer.write_event(Event::Start(start(name, attributes)))?;
        inside(self)?;
        self.writer.write_event(Event::End(BytesEnd::new(name)))
    }

    /// The finished document.
    pub fn finish(self) -> Vec<u8> {
        let mut bytes = self.writer.into_inner();
        bytes.push(b'\n');
        bytes
    }
}

fn start<'a>(name: &'a str, attributes: &Attributes) -> BytesStart<'a> {
    let mut start = BytesStart::new(name);
    for (key, value) in attributes {
        start.push_attribute((*key, clean(value).as_str()));
    }
    start
}

/// The text with every character that XML cannot hold replaced.
pub fn clean(text: &str) -> String {
    let allowed = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    text.chars().map(|c| if allowed(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// The shortest text that reads back to the same bits, in no one's local customs.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_bit() {
        for value in [0.0, -0.0, 1.0, -9.81, 1e-12, 1e15, 1.0 / 3.0, f64::MIN_POSITIVE, f64::MAX, 35f64.to_radians()] {
            assert_eq!(number(value).parse::<f64>().unwrap().to_bits(), value.to_bits(), "{value}");
        }
        assert_eq!((number(20.0).as_str(), number(0.5).as_str(), number(1e-12).as_str()), ("20", "0.5", "1e-12"));
    }

    #[test]
    fn attributes_are_escaped_and_cleaned() {
        let mut xml = Xml::new().unwrap();
        xml.leaf("a", &[("b", "<\"&'ü>\t\n\u{1}\u{ffff}".to_owned())]).unwrap();
        let text = String::from_utf8(xml.finish()).unwrap();
        assert!(text.ends_with("<a b=\"&lt;&quot;&amp;&apos;ü&gt;&#9;&#10;\u{fffd}\u{fffd}\"/>\n"), "{text}");
    }
}
