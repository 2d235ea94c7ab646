//! A small typed builder of SVG. Knows pixels, not metres.

use std::fmt::{self, Write as _};

use super::Picture;
use super::colour::{Colour, INK, WHITE};

/// Family of the embedded font.
pub const FONT: &str = "DejaVu Sans";

/// A position in the picture (px), y down.
pub type Pixel = [f64; 2];

/// A rectangle of the picture (px).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Size from left to right.
    pub width: f64,
    /// Size from top to bottom.
    pub height: f64,
}

impl Rect {
    /// Right edge (px).
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Lower edge (px).
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Whether the position lies inside or on the edge.
    pub fn contains(&self, [x, y]: Pixel) -> bool {
        (self.left..=self.right()).contains(&x) && (self.top..=self.bottom()).contains(&y)
    }

    /// Whether the two share more than an edge.
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.left < other.right() && other.left < self.right() && self.top < other.bottom() && other.top < self.bottom()
    }

    /// The rectangle grown by `margin` on all sides.
    pub fn grown(&self, margin: f64) -> Rect {
        Rect {
            left: self.left - margin,
            top: self.top - margin,
            width: self.width + 2.0 * margin,
            height: self.height + 2.0 * margin,
        }
    }
}

/// How a shape is painted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Style {
    fill: Option<Colour>,
    stroke: Option<(Colour, f64)>,
    opacity: Option<f64>,
    dashed: bool,
    crisp: bool,
}

impl Style {
    /// An area without an edge.
    pub fn fill(colour: Colour) -> Self {
        Self { fill: Some(colour), ..Self::default() }
    }

    /// A line of the given width (px).
    pub fn line(colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..Self::default() }
    }

    /// The same with an edge of the given width (px).
    pub fn edged(self, colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..self }
    }

    /// The same, let through: 0 invisible, 1 solid.
    pub fn opacity(self, opacity: f64) -> Self {
        Self { opacity: Some(opacity), ..self }
    }

    /// The same with a broken line.
    pub fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    /// Without smoothing, so that neighbours meet without a seam.
    pub fn crisp(self) -> Self {
        Self { crisp: true, ..self }
    }
}

impl fmt::Display for Style {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self.fill {
            Some(colour) => write!(out, " fill=\"{colour}\"")?,
            None => out.write_str(" fill=\"none\"")?,
        }
        if let Some((colour, width)) = self.stroke {
            write!(out, " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"")?;
        }
        if let Some(opacity) = self.opacity {
            write!(out, " opacity=\"{opacity}\"")?;
        }
        if self.dashed {
            out.write_str(" stroke-dasharray=\"9 6\"")?;
        }
        if self.crisp {
            out.write_str(" shape-rendering=\"crispEdges\"")?;
        }
        Ok(())
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Which end of a text sits at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub struct TextStyle {
    size: f64,
    anchor: Anchor,
    colour: Colour,
    halo: bool,
    upward: bool,
}

impl TextStyle {
    /// Dark text of the given size (px) that starts at its place.
    pub fn new(size: f64) -> Self {
        Self { size, anchor: Anchor::Start, colour: INK, halo: false, upward: false }
    }

    /// The same, held at another end.
    pub fn anchor(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// The same in another colour.
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// With a white rim, legible on any ground.
    pub fn halo(self) -> Self {
        Self { halo: true, ..self }
    }

    /// Reading upwards.
    pub fn upward(self) -> Self {
        Self { upward: true, ..self }
    }
}

/// Outlines gathered into one shape.
#[derive(Debug, Clone, Default)]
pub struct Path {
    data: String,
}

impl Path {
    /// Whether nothing would be drawn.
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Adds the outlines of another shape.
    pub fn append(&mut self, other: Path) {
        self.data.push_str(&other.data);
    }

    /// Adds a closed outline.
    pub fn polygon(&mut self, corners: impl IntoIterator<Item = Pixel>) {
        let before = self.data.len();
        self.line(corners);
        if self.data.len() > before {
            self.data.push('Z');
        }
    }

    /// Adds an open line.
    pub fn line(&mut self, positions: impl IntoIterator<Item = Pixel>) {
        for (k, [x, y]) in positions.into_iter().enumerate() {
            self.data.push(if k == 0 { 'M' } else { 'L' });
            push_number(&mut self.data, x);
            self.data.push(' ');
            push_number(&mut self.data, y);
        }
    }
}

/// Appends a coordinate (px) in hundredths; those far outside any picture are moved to its surroundings.
fn push_number(text: &mut String, value: f64) {
    let hundredths = (value.clamp(-1e5, 1e5) * 100.0).round() as i64;
    // Writing to a string cannot fail.
    let _ = match (hundredths / 100, hundredths % 100) {
        (whole, 0) => write!(text, "{whole}"),
        (whole, part) => {
            let sign = if hundredths < 0 { "-" } else { "" };
            write!(text, "{sign}{}.{:02}", whole.abs(), part.abs())
        }
    };
}

/// A picture under construction.
#[derive(Debug)]
pub struct Svg {
    width: f64,
    height: f64,
    definitions: String,
    body: String,
    ids: usize,
}

impl Svg {
    /// A white sheet (px).
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height: height.ceil(), definitions: String::new(), body: String::new(), ids: 0 }
    }

    /// The same sheet with another height (px).
    pub fn cut(self, height: f64) -> Self {
        Self { height: height.ceil(), ..self }
    }

    /// Draws a rectangle.
    pub fn rect(&mut self, area: &Rect, style: Style) {
        let Rect { left, top, width, height } = area;
        let shape =
            format!("<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{height:.2}\"{style}/>\n");
        self.body.push_str(&shape);
    }

    /// Draws a circle of the given radius (px).
    pub fn circle(&mut self, [x, y]: Pixel, radius: f64, style: Style) {
        let _ = writeln!(self.body, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\"{style}/>");
    }

    /// Draws gathered outlines; none if there are none.
    pub fn path(&mut self, path: &Path, style: Style) {
        if !path.is_empty() {
            let _ = writeln!(self.body, "<path d=\"{}\"{style}/>", path.data);
        }
    }

    /// Draws slanting lines across a shape.
    pub fn hatched(&mut self, path: &Path, colour: Colour) {
        if path.is_empty() {
            return;
        }
        let id = self.next_id();
        let _ = write!(self.definitions, "<pattern id=\"id{id}\" width=\"9\" height=\"9\"");
        let _ = write!(self.definitions, " patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">");
        let _ = writeln!(self.definitions, "<rect width=\"1.4\" height=\"9\" fill=\"{colour}\"/></pattern>");
        let _ = writeln!(self.body, "<path d=\"{}\" fill=\"url(#id{id})\" fill-rule=\"evenodd\"/>", path.data);
    }

    /// Draws a straight line.
    pub fn line(&mut self, from: Pixel, to: Pixel, style: Style) {
        let mut path = Path::default();
        path.line([from, to]);
        self.path(&path, style);
    }

    /// Sets a text with its base line at `y`.
    pub fn text(&mut self, [x, y]: Pixel, text: &str, style: TextStyle) {
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let halo = if style.halo {
            " stroke=\"#ffffff\" stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\""
        } else {
            ""
        };
        let turn = if style.upward { format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"") } else { String::new() };
        let (size, colour) = (style.size, style.colour);
        let _ = write!(self.body, "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\"");
        let _ = write!(self.body, " fill=\"{colour}\"{halo}{turn}>");
        push_escaped(&mut self.body, text);
        self.body.push_str("</text>\n");
    }

    /// Shows of what `draw` adds only the part inside `area`.
    pub fn clipped(&mut self, area: &Rect, draw: impl FnOnce(&mut Self)) {
        let Rect { left, top, width, height } = area;
        let id = self.next_id();
        let _ = write!(self.definitions, "<clipPath id=\"id{id}\"><rect x=\"{left:.2}\" y=\"{top:.2}\"");
        let _ = writeln!(self.definitions, " width=\"{width:.2}\" height=\"{height:.2}\"/></clipPath>");
        let _ = writeln!(self.body, "<g clip-path=\"url(#id{id})\">");
        draw(self);
        self.body.push_str("</g>\n");
    }

    fn next_id(&mut self) -> usize {
        self.ids += 1;
        self.ids
    }

    /// The finished sheet.
    pub fn finish(self) -> Picture {
        let Self { width, height, definitions, body, .. } = self;
        let mut svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"");
        let _ = writeln!(svg, " viewBox=\"0 0 {width} {height}\" font-family=\"{FONT}, Verdana, sans-serif\">");
        let paper = format!("<rect width=\"{width}\" height=\"{height}\"{}/>", Style::fill(WHITE));
        let _ = write!(svg, "<defs>\n{definitions}</defs>\n{paper}\n{body}</svg>\n");
        Picture { svg }
    }
}

/// Appends text with the characters that XML reserves or forbids replaced.
fn push_escaped(out: &mut String, text: &str) {
    let allowed = |letter| match letter {
        '\t' | '\n' | '\r' => ' ',
        '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER,
        _ => letter,
    };
    out.push_str(&quick_xml::escape::partial_escape(text.chars().map(allowed).collect::<String>()));
}

/// Advance of the embedded font for the characters from space to tilde, in thousandths of the size.
const ADVANCES: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
    636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863,
    748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635,
    615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636,
    337, 636, 838,
];

/// Width (px) of a text of the given size (px); letters beyond ASCII count as wide ones.
pub fn text_width(text: &str, size: f64) -> f64 {
    let advance = |letter: char| ADVANCES.get((letter as usize).wrapping_sub(32)).map_or(0.84, |a| f64::from(*a) / 1e3);
    text.chars().map(advance).sum::<f64>() * size
}

/// The text, cut with an ellipsis to be at most `width` px wide at the given size (px).
pub fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut cut = text.to_owned();
    while !cut.is_empty() && text_width(&cut, size) + size > width {
        cut.pop();
    }
    cut.push('…');
    cut
}
