//! Histogram of the outputs of an ensemble, with the limit below which a sample fails.

use super::Picture;
use super::axes::{LABEL_SIZE, TICK_SIZE, Ticks, draw_grid_line, draw_left_number, number_text};
use super::colour::{ACCENT, GREY, INK, LINES};
use super::sheet::{Anchor, Rect, Sheet, Style, TextStyle};
use super::slope::{BELOW_FRAME, LEFT, LINE_HEIGHT, MARGIN, TOP, WIDTH, draw_title};

/// Height (px) of the frame.
const HEIGHT: f64 = 560.0;
/// Most bins.
const BINS_MAX: f64 = 100.0;

/// Draws how often outputs occur; those below `limit` in another colour. `name` stands at the axis. Outputs that are
/// not finite are left out.
pub fn histogram_picture(title: &str, caption: &str, name: &str, outputs: &[f64], limit: f64) -> Picture {
    let mut sheet = Sheet::new(WIDTH, TOP + HEIGHT + BELOW_FRAME + LINE_HEIGHT + MARGIN);
    draw_title(&mut sheet, title, caption);
    let frame = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - MARGIN, height: HEIGHT };
    let mut sorted: Vec<f64> = outputs.iter().copied().filter(|output| output.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    match Bins::of(&sorted, limit) {
        Some(bins) => bins.draw(&mut sheet, &frame, limit),
        None => sheet.text([0.5 * WIDTH, TOP + 0.5 * HEIGHT], "no outputs", middle),
    }
    sheet.rect(&frame, Style::line(INK, 1.2));
    sheet.text([0.5 * WIDTH, frame.bottom() + 45.0], name, middle);
    let place = [LEFT - 76.0, TOP + 0.5 * HEIGHT];
    sheet.text(place, "samples", TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward());
    let y = frame.bottom() + BELOW_FRAME + LINE_HEIGHT;
    let below = format!("below {}", number_text(limit));
    for (k, (colour, text)) in [(ACCENT, below.as_str()), (LINES[0], "at or above")].into_iter().enumerate() {
        let x = LEFT + 260.0 * k as f64;
        sheet.rect(&Rect { left: x, top: y - 13.0, width: 18.0, height: 16.0 }, Style::fill(colour));
        sheet.text([x + 28.0, y], text, TextStyle::new(LABEL_SIZE));
    }
    sheet.finish()
}

/// Bins of equal width; one edge is the limit where it lies among the outputs, so that no bin has both colours.
#[derive(Debug, PartialEq)]
struct Bins {
    start: f64,
    width: f64,
    counts: Vec<usize>,
}

impl Bins {
    /// Bins of sorted outputs by the rule of D. Freedman and P. Diaconis (1981), but no fewer than by that of Sturges;
    /// none without outputs.
    fn of(sorted: &[f64], limit: f64) -> Option<Self> {
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len();
        let quarter = |k: usize| sorted[(k * (n - 1)) / 4];
        let span = last - first;
        let by_spread = 2.0 * (quarter(3) - quarter(1)) / libm::cbrt(n as f64);
        let by_count = span / (libm::log2(n as f64) + 1.0).ceil();
        let least = (span / BINS_MAX).max(1e-9 * first.abs().max(last.abs())).max(f64::MIN_POSITIVE);
        let width = if by_spread > 0.0 { by_spread.min(by_count) } else { by_count }.max(least);
        let from = if (first..=last).contains(&limit) { limit } else { first };
        let start = from - ((from - first) / width).ceil() * width;
        let place = |output: f64| ((output - start) / width).floor().max(0.0) as usize;
        let mut counts = vec![0; place(last) + 1];
        sorted.iter().for_each(|&output| counts[place(output)] += 1);
        Some(Self { start, width, counts })
    }

    fn draw(&self, sheet: &mut Sheet, frame: &Rect, limit: f64) {
        let end = self.start + self.width * self.counts.len() as f64;
        let margin = 0.03 * (end - self.start);
        let (low, high) = (self.start - margin, end + margin);
        let most = self.counts.iter().copied().max().unwrap_or(1).max(1) as f64 * 1.05;
        let x = |output: f64| frame.left + (output - low) / (high - low) * frame.width;
        let y = |count: f64| frame.bottom() - count / most * frame.height;
        let across = Ticks::new(low, high, 10.0);
        for &output in &across.values {
            draw_grid_line(sheet, [x(output), frame.top], [x(output), frame.bottom()]);
            let style = TextStyle::new(TICK_SIZE).anchor(Anchor::Middle);
            sheet.text([x(output), frame.bottom() + 4.0 + TICK_SIZE], &across.label(output), style);
        }
        let up = Ticks::new(0.0, most, 8.0);
        for &count in up.values.iter().filter(|count| count.fract() == 0.0) {
            draw_grid_line(sheet, [frame.left, y(count)], [frame.right(), y(count)]);
            draw_left_number(sheet, [frame.left, y(count)], &format!("{count}"));
        }
        for (k, &count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let left = self.start + self.width * k as f64;
            let colour = if left + 0.5 * self.width < limit { ACCENT } else { LINES[0] };
            let (from, to, top) = (x(left), x(left + self.width), y(count as f64));
            let bar = Rect { left: from, top, width: to - from, height: frame.bottom() - top };
            sheet.rect(&bar, Style::fill(colour).edged(INK, 0.6));
        }
        if (low..=high).contains(&limit) {
            sheet.line([x(limit), frame.top], [x(limit), frame.bottom()], Style::line(ACCENT, 2.5));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_output_is_in_one_bin_and_the_limit_is_an_edge() {
        let outputs: Vec<f64> = (0..200).map(|k| 0.8 + 0.002 * f64::from(k)).collect();
        let bins = Bins::of(&outputs, 1.0).expect("bins");
        assert_eq!(bins.counts.iter().sum::<usize>(), 200);
        let place = (1.0 - bins.start) / bins.width;
        assert!((place - place.round()).abs() < 1e-9, "{bins:?}");
        assert!(bins.counts.len() >= 8);
    }

    #[test]
    fn equal_outputs_and_none_are_drawn() {
        for outputs in [&[][..], &[1.3], &[1.3; 7], &[0.0; 3], &[f64::NAN, 1.0, f64::INFINITY]] {
            let svg = histogram_picture("t", "c", "factor of safety", outputs, 1.0);
            assert!(!svg.svg().contains("NaN") && !svg.svg().contains("inf"), "{}", svg.svg());
        }
    }
}
