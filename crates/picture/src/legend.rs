//! Signs and what they stand for, in columns below a frame or at its right.

use super::axes::LABEL_SIZE;
use super::colour::{ACCENT, Colour, GREY, INK, WATER, WHITE};
use super::sheet::{Path, Pixel, Sheet, Style, TextStyle, fitted, wrapped};
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
    /// A short level line.
    Tick(Colour),
    /// An outcrop that seeps.
    Seep,
    /// A force.
    Arrow(Colour),
    /// A bolt.
    Bolt,
}

impl Legend {
    /// With texts that are wider than the column in lines below each other.
    fn wrapped(self, width: f64) -> Self {
        let room = |sign: Sign| width - 16.0 - if matches!(sign, Sign::None) { 0.0 } else { SIGN_WIDTH };
        let lines = |entry: Entry| {
            let below = if matches!(entry.sign, Sign::None) { Sign::None } else { Sign::Blank };
            let lines = wrapped(&entry.text, LABEL_SIZE, room(entry.sign));
            let signs = std::iter::once(entry.sign).chain(std::iter::repeat(below));
            signs.zip(lines).map(|(sign, line)| Entry::new(sign, line)).collect::<Vec<_>>()
        };
        Self { title: self.title, entries: self.entries.into_iter().flat_map(lines).collect() }
    }

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

/// The columns with their texts wrapped to their width, side by side from `left` on or, from there, below each other.
pub fn wrapped_columns(legends: Vec<Legend>, left: f64, beside: bool) -> Vec<Legend> {
    let width = (WIDTH - left - MARGIN) / if beside { 1.0 } else { legends.len().max(1) as f64 };
    legends.into_iter().map(|legend| legend.wrapped(width)).collect()
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
    let area = || Path::closed([[left, y - 8.0], [right, y - 8.0], [right, y + 8.0], [left, y + 8.0]]);
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
        Sign::Tick(colour) => sheet.line([middle - 7.0, y], [middle + 7.0, y], Style::line(colour, 2.6)),
        Sign::Seep => signs::draw_seep(sheet, [middle, y]),
        Sign::Arrow(colour) => signs::draw_arrow(sheet, [left, y], [right, y], Style::line(colour, 2.4)),
        Sign::Bolt => signs::draw_bolt(sheet, [[left + 4.0, y], [right, y]], Style::line(ACCENT, 2.6)),
    }
    SIGN_WIDTH
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::text_width;

    #[test]
    fn long_texts_take_lines_below_each_other_and_lose_no_word() {
        let texts = ["φ 35°, c 1 GPa, t 1 GPa; residual c 0 Pa", "short"];
        let legend = |sign| Legend { title: "Joints", entries: texts.map(|text| Entry::new(sign, text)).into() };
        for (sign, indent) in [(Sign::None, 0.0), (Sign::Dot(INK), SIGN_WIDTH)] {
            let [column] = &wrapped_columns(vec![legend(sign)], WIDTH - MARGIN - 270.0, true)[..] else { panic!() };
            let lines: Vec<&str> = column.entries.iter().map(|entry| &*entry.text).collect();
            assert_eq!(lines.join(" "), texts.join(" "));
            assert!(lines.len() > 2 && lines.iter().all(|line| text_width(line, LABEL_SIZE) <= 270.0 - 16.0 - indent));
            let signs = column.entries.iter().filter(|entry| !matches!(entry.sign, Sign::None | Sign::Blank)).count();
            assert_eq!(signs, if indent > 0.0 { 2 } else { 0 }, "one sign for each text");
        }
    }
}
