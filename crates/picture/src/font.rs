//! The letters of the embedded font, DejaVu Sans, as outlines.
//!
//! Reads only what this one font holds of the format OpenType: characters in a table `cmap` of format 12, outlines of
//! TrueType, and pairs of letters that stand closer in a table `kern` of format 0. Letters stand from left to right.

use std::sync::LazyLock;

use tiny_skia::PathBuilder;

/// Units of the font in its size.
pub const UNITS: f32 = 2048.0;

/// A line of text in units of the font: base line at 0, y up.
#[derive(Debug)]
pub struct Line {
    /// The outlines of its letters.
    pub outline: PathBuilder,
    /// From its start to the start of whatever would follow.
    pub width: f32,
}

/// Sets a text in one line; spaces at its ends are left out, and those that follow one another become one, as in SVG.
pub fn line(text: &str) -> Line {
    let mut outline = PathBuilder::new();
    let mut x = 0;
    let mut last = None;
    for letter in text.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ").chars() {
        let glyph = FONT.glyph(letter);
        x += last.map_or(0, |last| FONT.kerning(last, glyph));
        FONT.draw(glyph, [x, 0], &mut outline);
        x += FONT.advance(glyph);
        last = Some(glyph);
    }
    Line { outline, width: x as f32 }
}

static FONT: LazyLock<Font> = LazyLock::new(|| Font::new(Bytes(dejavu::sans::regular())));

/// Part of the file; numbers in it have their highest byte first.
#[derive(Debug, Clone, Copy)]
struct Bytes(&'static [u8]);

impl Bytes {
    fn from(self, start: usize) -> Self {
        Self(&self.0[start..])
    }

    fn byte(self, at: usize) -> usize {
        usize::from(self.0[at])
    }

    fn number(self, at: usize) -> usize {
        256 * self.byte(at) + self.byte(at + 1)
    }

    fn signed(self, at: usize) -> i32 {
        i32::from(i16::from_be_bytes([self.0[at], self.0[at + 1]]))
    }

    fn long(self, at: usize) -> usize {
        65536 * self.number(at) + self.number(at + 2)
    }
}

/// Tables of the font; a letter goes by its glyph, which is a number.
struct Font {
    groups: Bytes,
    kerning: Bytes,
    metrics: Bytes,
    places: Bytes,
    outlines: Bytes,
}

impl Font {
    fn new(file: Bytes) -> Self {
        let table = |name: &[u8; 4]| {
            let entry = (0..file.number(4)).map(|k| file.from(12 + 16 * k)).find(|entry| entry.0.starts_with(name));
            file.from(entry.expect("a table of the font").long(8))
        };
        let characters = table(b"cmap");
        let mut kinds = (0..characters.number(2)).map(|k| characters.from(characters.long(8 + 8 * k)));
        Self {
            groups: kinds.find(|kind| kind.number(0) == 12).expect("a table of all characters").from(12),
            kerning: table(b"kern").from(4),
            metrics: table(b"hmtx"),
            places: table(b"loca"),
            outlines: table(b"glyf"),
        }
    }

    /// The first glyph, an empty box, for characters that the font lacks.
    fn glyph(&self, letter: char) -> usize {
        let letter = letter as usize;
        let groups = (0..self.groups.long(0)).map(|k| self.groups.from(4 + 12 * k));
        let group = groups.into_iter().find(|group| (group.long(0)..=group.long(4)).contains(&letter));
        group.map_or(0, |group| group.long(8) + letter - group.long(0))
    }

    fn advance(&self, glyph: usize) -> i32 {
        self.metrics.number(4 * glyph) as i32
    }

    /// How much farther from the first glyph the second stands.
    fn kerning(&self, first: usize, second: usize) -> i32 {
        let wanted = 65536 * first + second;
        let pair = |k: usize| self.kerning.from(14 + 6 * k);
        let (mut low, mut high) = (0, self.kerning.number(6));
        while low < high {
            let middle = low.midpoint(high);
            if pair(middle).long(0) < wanted { low = middle + 1 } else { high = middle }
        }
        if low < self.kerning.number(6) && pair(low).long(0) == wanted { pair(low).signed(4) } else { 0 }
    }

    /// Adds the outlines of a glyph at a position.
    fn draw(&self, glyph: usize, at: [i32; 2], pen: &mut PathBuilder) {
        let [start, end] = [0, 4].map(|k| self.places.long(4 * glyph + k));
        if start == end {
            return;
        }
        let data = self.outlines.from(start);
        match usize::try_from(data.signed(0)) {
            Ok(outlines) => draw_outlines(data.from(10), outlines, at, pen),
            Err(_) => self.draw_parts(data.from(10), at, pen),
        }
    }

    /// Draws a glyph that consists of others, such as Ä; this font moves them, but does not turn or stretch them.
    fn draw_parts(&self, mut data: Bytes, [x, y]: [i32; 2], pen: &mut PathBuilder) {
        const WORDS: usize = 0x01;
        const MORE: usize = 0x20;
        loop {
            let [flags, glyph] = [0, 2].map(|k| data.number(k));
            let (size, by) = if flags & WORDS != 0 {
                (8, [4, 6].map(|k| data.signed(k)))
            } else {
                (6, [4, 5].map(|k| i32::from(data.0[k] as i8)))
            };
            self.draw(glyph, [x + by[0], y + by[1]], pen);
            if flags & MORE == 0 {
                return;
            }
            data = data.from(size);
        }
    }
}

/// A point of an outline.
#[derive(Debug, Clone, Copy)]
struct Node {
    at: [f32; 2],
    /// The outline passes through it; otherwise it pulls the outline to its side.
    on: bool,
}

fn middle(a: Node, b: Node) -> Node {
    Node { at: [0, 1].map(|k| 0.5 * (a.at[k] + b.at[k])), on: true }
}

fn draw_outlines(data: Bytes, outlines: usize, at: [i32; 2], pen: &mut PathBuilder) {
    let ends: Vec<usize> = (0..outlines).map(|k| data.number(2 * k) + 1).collect();
    let instructions = data.from(2 * outlines);
    let nodes = nodes(instructions.from(2 + instructions.number(0)), ends.last().copied().unwrap_or(0), at);
    let mut start = 0;
    for end in ends {
        draw_outline(&nodes[start..end], pen);
        start = end;
    }
}

/// The points of all outlines of a glyph: flags first, then all x, then all y, each as a difference to the one before.
fn nodes(data: Bytes, count: usize, at: [i32; 2]) -> Vec<Node> {
    const ON: usize = 0x01;
    const REPEAT: usize = 0x08;
    let mut flags = Vec::with_capacity(count);
    let mut next = 0;
    while flags.len() < count {
        let flag = data.byte(next);
        let times = if flag & REPEAT == 0 { 1 } else { 1 + data.byte(next + 1) };
        next += if flag & REPEAT == 0 { 1 } else { 2 };
        flags.extend(std::iter::repeat_n(flag, times));
    }
    let mut axis = |axis: usize| -> Vec<f32> {
        let [short, same] = [0x02 << axis, 0x10 << axis];
        let mut value = at[axis];
        let mut place = |&flag: &usize| {
            match (flag & short != 0, flag & same != 0) {
                (true, plus) => {
                    let distance = data.byte(next) as i32;
                    value += if plus { distance } else { -distance };
                    next += 1;
                }
                (false, true) => {}
                (false, false) => {
                    value += data.signed(next);
                    next += 2;
                }
            }
            value as f32
        };
        flags.iter().map(&mut place).collect()
    };
    let [xs, ys] = [axis(0), axis(1)];
    let node = |k: usize| Node { at: [xs[k], ys[k]], on: flags[k] & ON != 0 };
    (0..count).map(node).collect()
}

/// Between two points off the outline it passes through their middle.
fn draw_outline(nodes: &[Node], pen: &mut PathBuilder) {
    let [Some(&first), Some(&last)] = [nodes.first(), nodes.last()] else { return };
    let start = match (first.on, last.on) {
        (true, _) => first,
        (false, true) => last,
        (false, false) => middle(first, last),
    };
    pen.move_to(start.at[0], start.at[1]);
    let mut pull: Option<Node> = None;
    for node in nodes.iter().copied().chain([start]) {
        let to = match pull {
            Some(pull) if !node.on => middle(pull, node),
            _ => node,
        };
        match pull {
            Some(pull) => pen.quad_to(pull.at[0], pull.at[1], to.at[0], to.at[1]),
            None if node.on => pen.line_to(to.at[0], to.at[1]),
            None => {}
        }
        pull = Some(node).filter(|node| !node.on);
    }
    pen.close();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_letters_of_the_font_are_drawn() {
        let mut empty = 0;
        for letter in (' '..=char::MAX).filter(|&letter| FONT.glyph(letter) > 0) {
            let Line { outline, width } = line(&letter.to_string());
            empty += usize::from(outline.is_empty());
            assert!(outline.is_empty() || outline.finish().is_some(), "{letter}");
            assert!((0.0..=2.0 * UNITS).contains(&width), "{letter}");
        }
        assert!(empty < 40, "{empty} letters are empty");
    }

    #[test]
    fn letters_have_the_widths_of_the_font_and_pairs_stand_closer() {
        let width = |text| line(text).width;
        assert_eq!([width("A"), width("i"), width("σ"), width("²")], [1401.0, 569.0, 1298.0, 821.0]);
        assert!(width("AV") < width("A") + width("V"));
        assert_eq!(width("  a   b "), width("a b"));
        assert_eq!(width("岩"), width("\u{fffff}"));
    }

    #[test]
    fn a_letter_with_an_accent_is_that_letter_and_more() {
        let bounds = |text| line(text).outline.finish().expect("an outline").bounds();
        let (plain, accent) = (bounds("A"), bounds("Ä"));
        assert_eq!([plain.left(), plain.right(), plain.top()], [accent.left(), accent.right(), accent.top()]);
        assert!(accent.bottom() > plain.bottom());
    }
}
