//! Signs and what they stand for, in columns below a frame or at its right.

use super::axes::LABEL_SIZE;
use super::colour::{ACCENT, Colour, GREY, INK, WATER, WHITE};
use super::sheet::{Path, Pixel, Sheet, Style, TextStyle, fitted};
use super::signs::{self, Held, draw_held};
use super::slope::{LINE_HEIGHT, MARGIN, WIDTH};

/// Width (px) kept for a sign.
const SIGN_WIDTH: f64 = 44.0;
/// Lines of a column at most.
const LINES_MAX: usize = 14;
/// Room (px) between a frame and the columns at its right.
pub const BESIDE: f64 = 48.0;
/// Width (px) of columns at the right of a frame at least.
pub const COLUMN: f64 = 330.0;

/// A column of explained signs.
pub struct Legend {
    /// Common title of the signs.
    pub title: &'static str,
    /// Signs and texts.
    pub entries: Vec<Entry>,
}

/// A sign and what it stands for.
pub struct Entry {
    /// The sign.
    pub sign: Sign,
    /// Meaning.
    pub text: String,
}

impl Entry {
    /// A sign and its text.
    pub fn new(sign: Sign, text: impl Into<String>) -> Self {
        Self { sign, text: text.into() }
    }
}

/// A sign.
#[derive(Debug, Clone, Copy)]
pub enum Sign {
    /// Text alone.
    None,
    /// Text below that of the entry before.
    Blank,
    /// A line of a colour and a width (px).
    Line(Colour, f64),
    /// A broken line.
    Dashed(Colour, f64),
    /// A short stroke.
    Stroke,
    /// Two lines side by side.
    Hollow,
    /// An area.
    Fill(Colour),
    /// A dot.
    Dot(Colour),
    /// A ring.
    Ring(Colour),
    /// Slanting lines across a block.
    Hatch,
    /// A fixity or a boundary that lets waves leave.
    Held(Held),
    /// A monitor.
    Monitor,
    /// A port.
    Port,
    /// The surface of water.
    Water,
    /// A force.
    Arrow(Colour),
    /// A bolt.
    Bolt,
}

impl Legend {
    /// With the last lines replaced by their number, if there are too many.
    fn lines(&self) -> usize {
        self.entries.len().min(LINES_MAX)
    }

    fn draw(&self, sheet: &mut Sheet, [left, top]: Pixel, width: f64) {
        sheet.text([left, top], self.title, TextStyle::new(LABEL_SIZE + 1.0).colour(GREY));
        let shown = if self.entries.len() > LINES_MAX { LINES_MAX - 1 } else { self.entries.len() };
        for (line, entry) in self.entries.iter().take(shown).enumerate() {
            let y = top + LINE_HEIGHT * (line + 1) as f64;
            let indent = draw_sign(sheet, entry.sign, [left, y - 5.0]);
            let text = fitted(&entry.text, LABEL_SIZE, width - indent - 16.0);
            sheet.text([left + indent, y], &text, TextStyle::new(LABEL_SIZE));
        }
        if shown < self.entries.len() {
            let more = format!("and {} more", self.entries.len() - shown);
            sheet.text([left, top + LINE_HEIGHT * LINES_MAX as f64], &more, TextStyle::new(LABEL_SIZE).colour(GREY));
        }
    }
}

/// Height (px) of columns side by side.
pub fn height_below(legends: &[Legend]) -> f64 {
    LINE_HEIGHT * (legends.iter().map(Legend::lines).max().unwrap_or(0) as f64 + 0.5)
}

/// Height (px) of columns one below the other.
pub fn height_beside(legends: &[Legend]) -> f64 {
    legends.iter().map(|legend| LINE_HEIGHT * (legend.lines() as f64 + 2.0)).sum()
}

/// Draws the columns side by side from a height on.
pub fn draw_below(sheet: &mut Sheet, legends: &[Legend], left: f64, top: f64) {
    let width = (WIDTH - left - MARGIN) / legends.len().max(1) as f64;
    for (k, legend) in legends.iter().enumerate() {
        legend.draw(sheet, [left + k as f64 * width, top], width);
    }
}

/// Draws the columns one below the other.
pub fn draw_beside(sheet: &mut Sheet, legends: &[Legend], [left, top]: Pixel) {
    let mut y = top + LABEL_SIZE;
    for legend in legends {
        legend.draw(sheet, [left, y], WIDTH - MARGIN - left);
        y += LINE_HEIGHT * (legend.lines() as f64 + 2.0);
    }
}

/// Draws a sign centred on the height of `y`; returns the room it takes (px).
fn draw_sign(sheet: &mut Sheet, sign: Sign, [left, y]: Pixel) -> f64 {
    let (middle, right) = (left + 0.4 * SIGN_WIDTH, left + 0.8 * SIGN_WIDTH);
    let area = || {
        let mut path = Path::default();
        path.polygon([[left, y - 8.0], [right, y - 8.0], [right, y + 8.0], [left, y + 8.0]]);
        path
    };
    match sign {
        Sign::None => return 0.0,
        Sign::Blank => {}
        Sign::Stroke => sheet.line([left + 6.0, y + 6.0], [right - 6.0, y - 6.0], Style::line(INK, 4.0)),
        Sign::Line(colour, width) => sheet.line([left, y], [right, y], Style::line(colour, width)),
        Sign::Dashed(colour, width) => sheet.line([left, y], [right, y], Style::line(colour, width).dashed()),
        Sign::Hollow => {
            sheet.line([left, y], [right, y], Style::line(INK, signs::OPEN_WIDTH));
            sheet.line([left, y], [right, y], Style::line(WHITE, signs::OPEN_WIDTH - 2.6));
        }
        Sign::Fill(colour) => sheet.path(area(), Style::fill(colour).edged(INK, 0.9)),
        Sign::Ring(colour) => sheet.circle([middle, y], 7.0, Style::line(colour, 1.8)),
        Sign::Dot(colour) => sheet.circle([middle, y], 7.0, Style::fill(colour)),
        Sign::Monitor => signs::draw_monitor(sheet, [middle, y]),
        Sign::Port => signs::draw_port(sheet, [middle, y]),
        Sign::Held(held) => draw_held(sheet, held, [middle, y - 8.0], [0.0, 1.0]),
        Sign::Hatch => {
            sheet.hatched(area(), GREY);
            sheet.path(area(), Style::line(INK, 0.9));
        }
        Sign::Water => {
            sheet.line([left, y + 4.0], [right, y + 4.0], Style::line(WATER, 2.4));
            signs::draw_water_mark(sheet, [middle, y + 4.0]);
        }
        Sign::Arrow(colour) => signs::draw_arrow(sheet, [left, y], [right, y], Style::line(colour, 2.4)),
        Sign::Bolt => signs::draw_bolt(sheet, [[left + 4.0, y], [right, y]], Style::line(ACCENT, 2.6)),
    }
    SIGN_WIDTH
}
