//! The sheet on which all pictures are drawn: shapes and texts one over another. Knows pixels, not metres.

use std::mem;

use super::Picture;
use super::colour::{Colour, INK};

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

    /// Its middle.
    pub fn middle(&self) -> Pixel {
        [self.left + 0.5 * self.width, self.top + 0.5 * self.height]
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
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Style {
    /// Colour of the area.
    pub fill: Option<Colour>,
    /// Colour and width (px) of the line.
    pub stroke: Option<(Colour, f64)>,
    /// 0 invisible, 1 solid.
    pub opacity: Option<f64>,
    /// A broken line.
    pub dashed: bool,
    /// Without smoothing.
    pub crisp: bool,
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

/// Which end of a text sits at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextStyle {
    /// Size of the font (px).
    pub size: f64,
    /// Which end sits at the place.
    pub anchor: Anchor,
    /// Colour of the letters.
    pub colour: Colour,
    /// A white rim.
    pub halo: bool,
    /// Turned to read upwards.
    pub upward: bool,
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
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Path {
    steps: Vec<PathStep>,
}

/// A step of the pen; positions in hundredths of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathStep {
    /// Begins an outline.
    Move([i32; 2]),
    /// Draws a straight line.
    Line([i32; 2]),
    /// Draws a line back to where the outline began.
    Close,
}

impl Path {
    /// An open line.
    pub fn open(positions: impl IntoIterator<Item = Pixel>) -> Self {
        let mut path = Self::default();
        path.line(positions);
        path
    }

    /// A closed outline.
    pub fn closed(corners: impl IntoIterator<Item = Pixel>) -> Self {
        let mut path = Self::default();
        path.polygon(corners);
        path
    }

    /// Whether nothing would be drawn.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The steps of the pen.
    pub fn steps(&self) -> &[PathStep] {
        &self.steps
    }

    /// Adds the outlines of another shape.
    pub fn append(&mut self, other: Path) {
        self.steps.extend(other.steps);
    }

    /// Adds a closed outline.
    pub fn polygon(&mut self, corners: impl IntoIterator<Item = Pixel>) {
        let before = self.steps.len();
        self.line(corners);
        if self.steps.len() > before {
            self.steps.push(PathStep::Close);
        }
    }

    /// Adds an open line.
    pub fn line(&mut self, positions: impl IntoIterator<Item = Pixel>) {
        for (k, position) in positions.into_iter().enumerate() {
            let at = position.map(hundredths);
            self.steps.push(if k == 0 { PathStep::Move(at) } else { PathStep::Line(at) });
        }
    }
}

/// A coordinate (px) in hundredths; those far outside any picture are moved to its surroundings.
fn hundredths(value: f64) -> i32 {
    (value.clamp(-1e5, 1e5) * 100.0).round() as i32
}

/// A thing on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A rectangle.
    Rect(Rect, Style),
    /// A circle of the given radius (px).
    Circle(Pixel, f64, Style),
    /// Outlines.
    Path(Path, Style),
    /// Slanting lines across a shape.
    Hatched(Path, Colour),
    /// A text with its base line at its place.
    Text(Pixel, String, TextStyle),
    /// The part of other marks inside a rectangle.
    Clipped(Rect, Vec<Mark>),
}

/// A picture under construction.
#[derive(Debug)]
pub struct Sheet {
    size: [f64; 2],
    marks: Vec<Mark>,
}

impl Sheet {
    /// A white sheet (px).
    pub fn new(width: f64, height: f64) -> Self {
        Self { size: [width, height.ceil()], marks: Vec::new() }
    }

    /// The same sheet with another height (px).
    pub fn cut(self, height: f64) -> Self {
        Self { size: [self.size[0], height.ceil()], ..self }
    }

    /// Draws a rectangle.
    pub fn rect(&mut self, area: &Rect, style: Style) {
        self.marks.push(Mark::Rect(*area, style));
    }

    /// Draws a circle of the given radius (px).
    pub fn circle(&mut self, centre: Pixel, radius: f64, style: Style) {
        self.marks.push(Mark::Circle(centre, radius, style));
    }

    /// Draws gathered outlines; none if there are none.
    pub fn path(&mut self, path: Path, style: Style) {
        if !path.is_empty() {
            self.marks.push(Mark::Path(path, style));
        }
    }

    /// Draws slanting lines across a shape.
    pub fn hatched(&mut self, path: Path, colour: Colour) {
        if !path.is_empty() {
            self.marks.push(Mark::Hatched(path, colour));
        }
    }

    /// Draws a straight line.
    pub fn line(&mut self, from: Pixel, to: Pixel, style: Style) {
        self.path(Path::open([from, to]), style);
    }

    /// Sets a text with its base line at `y`.
    pub fn text(&mut self, at: Pixel, text: &str, style: TextStyle) {
        self.marks.push(Mark::Text(at, text.chars().map(printable).collect(), style));
    }

    /// Shows of what `draw` adds only the part inside `area`.
    pub fn clipped(&mut self, area: &Rect, draw: impl FnOnce(&mut Self)) {
        let before = mem::take(&mut self.marks);
        draw(self);
        let inside = mem::replace(&mut self.marks, before);
        self.marks.push(Mark::Clipped(*area, inside));
    }

    /// The finished sheet.
    pub fn finish(self) -> Picture {
        Picture { size: self.size, marks: self.marks }
    }
}

/// The letter, or another where XML forbids it.
fn printable(letter: char) -> char {
    match letter {
        '\t' | '\n' | '\r' => ' ',
        '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER,
        _ => letter,
    }
}

/// Advance of the embedded font for the characters from space to tilde, in thousandths of the size.
const ADVANCES: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
    636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863,
    748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635,
    615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636,
    337, 636, 838,
];

/// Advance of a letter in sizes of the font; one beyond ASCII counts as a wide one.
fn advance(letter: char) -> f64 {
    ADVANCES.get((letter as usize).wrapping_sub(32)).map_or(0.84, |advance| f64::from(*advance) / 1e3)
}

/// Width (px) of a text of the given size (px).
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

/// The text, cut with an ellipsis to be at most `width` px wide at the given size (px).
pub fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut sum = 0.0;
    let fits = |letter: &char| {
        sum += advance(*letter);
        sum * size + size <= width
    };
    text.chars().take_while(fits).chain(['…']).collect()
}

/// The words of a text in lines of at most `width` px at the given size (px); longer words are cut.
pub fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fitted(word, size, width)),
        }
    }
    lines
}
