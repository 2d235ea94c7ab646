//! The bar of a colour scale at the right of a frame.

use super::axes::{LABEL_SIZE, TICK_SIZE};
use super::colour::{Colour, GREY, INK, SCALE_STEPS, scale};
use super::sheet::{Anchor, Rect, Sheet, Style, TextStyle};

/// Room (px) at the right of a frame for the bar.
pub const BAR_ROOM: f64 = 190.0;

/// Draws the bar of contours: a colour for each band, and a label between neighbours.
pub fn draw_bands(sheet: &mut Sheet, frame: &Rect, title: &str, colours: &[Colour], labels: &[String]) {
    let fraction = |k: usize| (k + 1) as f64 / colours.len() as f64;
    let ticks: Vec<_> = labels.iter().enumerate().map(|(k, label)| (fraction(k), label.clone())).collect();
    draw_steps(sheet, frame, title, colours, &ticks);
}

/// Draws the bar with ticks: the fraction of its length and a label each.
pub fn draw_bar(sheet: &mut Sheet, frame: &Rect, title: &str, ticks: &[(f64, String)]) {
    let colours: Vec<Colour> = (0..SCALE_STEPS).map(scale).collect();
    draw_steps(sheet, frame, title, &colours, ticks);
}

fn draw_steps(sheet: &mut Sheet, frame: &Rect, title: &str, colours: &[Colour], ticks: &[(f64, String)]) {
    let bar = Rect { left: frame.right() + 34.0, width: 26.0, ..*frame };
    let step_height = bar.height / colours.len() as f64;
    for (step, &colour) in colours.iter().enumerate() {
        let top = bar.bottom() - (step + 1) as f64 * step_height;
        sheet.rect(&Rect { top, height: step_height, ..bar }, Style::fill(colour).crisp());
    }
    sheet.rect(&bar, Style::line(INK, 1.2));
    for (fraction, label) in ticks {
        let y = bar.bottom() - fraction * bar.height;
        sheet.line([bar.right(), y], [bar.right() + 6.0, y], Style::line(INK, 1.2));
        sheet.text([bar.right() + 10.0, y + 0.36 * TICK_SIZE], label, TextStyle::new(TICK_SIZE));
    }
    let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward();
    sheet.text([bar.right() + 86.0, bar.top + 0.5 * bar.height], title, style);
}
