//! The letters of the embedded font, DejaVu Sans, as outlines. They stand from left to right.

use std::sync::LazyLock;

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::TableProvider;
use skrifa::raw::tables::kern::{Subtable0, SubtableKind};
use skrifa::{FontRef, GlyphId, MetadataProvider, charmap::Charmap};
use tiny_skia::PathBuilder;

/// Units of the font in its size.
pub const UNITS: f32 = 2048.0;

/// The tables of the embedded font that are used.
struct Font {
    letters: Charmap<'static>,
    outlines: OutlineGlyphCollection<'static>,
    metrics: GlyphMetrics<'static>,
    pairs: Vec<Subtable0<'static>>,
}

static FONT: LazyLock<Font> = LazyLock::new(|| {
    let font = FontRef::new(dejavu::sans::regular()).expect("the embedded font is whole");
    let pairs = font.kern().into_iter().flat_map(|kern| kern.subtables()).flatten();
    let pairs = pairs.filter_map(|table| match table.kind() {
        Ok(SubtableKind::Format0(pairs)) => Some(pairs),
        _ => None,
    });
    Font {
        letters: font.charmap(),
        outlines: font.outline_glyphs(),
        metrics: font.glyph_metrics(Size::unscaled(), LocationRef::default()),
        pairs: pairs.collect(),
    }
});

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
    let mut pen = Pen { outline: PathBuilder::new(), x: 0.0 };
    let mut last = None;
    for letter in text.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ").chars() {
        // The first glyph is an empty box, for letters that the font lacks.
        let glyph = FONT.letters.map(letter).unwrap_or_default();
        pen.x += last.map_or(0.0, |last| kerning(last, glyph));
        if let Some(outline) = FONT.outlines.get(glyph) {
            let unhinted = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
            outline.draw(unhinted, &mut pen).expect("the embedded font is whole");
        }
        pen.x += FONT.metrics.advance_width(glyph).unwrap_or_default();
        last = Some(glyph);
    }
    Line { outline: pen.outline, width: pen.x }
}

/// How much farther from the first glyph the second stands.
fn kerning(first: GlyphId, second: GlyphId) -> f32 {
    FONT.pairs.iter().filter_map(|pairs| pairs.kerning(first, second)).map(|units| units as f32).sum()
}

/// Draws the next glyph at `x`.
struct Pen {
    outline: PathBuilder,
    x: f32,
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.outline.move_to(self.x + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.outline.line_to(self.x + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.outline.quad_to(self.x + x1, y1, self.x + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.outline.cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }

    fn close(&mut self) {
        self.outline.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_the_widths_of_the_font_and_pairs_stand_closer() {
        let width = |text| line(text).width;
        let font = FontRef::new(dejavu::sans::regular()).expect("a font");
        assert_eq!(f32::from(font.head().expect("a head").units_per_em()), UNITS);
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
