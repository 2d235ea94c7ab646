//! Histogram of the outputs of an ensemble, with the limit below which a sample fails.

use super::Picture;
use super::axes::{LABEL_SIZE, TICK_SIZE, Ticks, draw_level, draw_upright, three_digits};
use super::colour::{ACCENT, Colour, GREY, INK};
use super::sheet::{Anchor, Path, Rect, Sheet, Style, TextStyle, text_width};
use super::slope::{BELOW_FRAME, LEFT, LINE_HEIGHT, MARGIN, TOP, WIDTH, draw_title};

/// Height (px) of the frame.
const HEIGHT: f64 = 560.0;
/// Room (px) at the right of the frame for the shares of the cumulative curve.
const RIGHT: f64 = 96.0;
/// Most bins.
const BINS_MAX: f64 = 100.0;
/// Outputs farther above the upper quartile than so many distances of the quartiles are counted, not drawn.
const FAR: f64 = 4.0;
/// Points of the curve of a fitted density.
const CURVE: usize = 240;
/// Samples below the limit.
const FAILS: Colour = Colour(232, 150, 176);
/// Samples at or above it.
const STANDS: Colour = Colour(190, 206, 224);

/// A distribution with the mean and the standard deviation of the outputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Whether it is lognormal; else it is normal.
    pub is_lognormal: bool,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

impl Fit {
    /// Density at an output.
    fn density(&self, output: f64) -> f64 {
        let normal = |x: f64, mean: f64, sd: f64| {
            libm::exp(-0.5 * ((x - mean) / sd) * ((x - mean) / sd)) / (sd * libm::sqrt(std::f64::consts::TAU))
        };
        if !self.is_lognormal {
            return normal(output, self.mean, self.sd);
        }
        let variance = libm::log(1.0 + (self.sd / self.mean) * (self.sd / self.mean));
        let mean = libm::log(self.mean) - 0.5 * variance;
        if output > 0.0 { normal(libm::log(output), mean, libm::sqrt(variance)) / output } else { 0.0 }
    }

    /// Its name with its parameters.
    fn text(&self) -> String {
        let name = if self.is_lognormal { "lognormal" } else { "normal" };
        format!("{name}, mean {}, standard deviation {}", three_digits(self.mean), three_digits(self.sd))
    }
}

/// Draws how often outputs occur, those below `limit` hatched, with the share of the samples below each output and the
/// density of `fit`. `name` stands at the axis. Outputs that are not finite are left out; far ones are counted.
pub fn histogram_picture(
    title: &str,
    caption: &str,
    name: &str,
    outputs: &[f64],
    limit: f64,
    fit: Option<Fit>,
) -> Picture {
    let mut sheet = Sheet::new(WIDTH, TOP + HEIGHT + BELOW_FRAME + LINE_HEIGHT + MARGIN);
    draw_title(&mut sheet, title, caption);
    let frame = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - RIGHT, height: HEIGHT };
    let mut sorted: Vec<f64> = outputs.iter().copied().filter(|output| output.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let shown = &sorted[..shown(&sorted)];
    let middle = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    let [centre, height] = frame.middle();
    let fit = fit.filter(|fit| fit.sd > 0.0 && fit.mean.is_finite() && (fit.mean > 0.0 || !fit.is_lognormal));
    match Bins::of(shown, limit) {
        Some(bins) => {
            Chart::new(&frame, bins, limit, fit.zip(Some(sorted.len()))).draw(&mut sheet, &sorted, fit.as_ref())
        }
        None => sheet.text([centre, height], "no outputs", middle),
    }
    sheet.rect(&frame, Style::line(INK, 1.2));
    sheet.text([centre, frame.bottom() + 45.0], name, middle);
    sheet.text([LEFT - 76.0, height], "samples", middle.upward());
    sheet.text([frame.right() + 72.0, height], "share of the samples below", middle.upward());
    draw_legend(&mut sheet, frame.bottom() + BELOW_FRAME + LINE_HEIGHT, limit, fit, sorted.len() - shown.len());
    sheet.finish()
}

/// A point of the curve of a density between two outputs.
fn along([low, high]: [f64; 2], k: usize) -> f64 {
    low + (high - low) * k as f64 / CURVE as f64
}

/// How many of the sorted outputs the frame shows: all but those far above the others.
fn shown(sorted: &[f64]) -> usize {
    let n = sorted.len();
    if n == 0 {
        return 0;
    }
    let quarter = |k: usize| sorted[(k * (n - 1)) / 4];
    let spread = quarter(3) - quarter(1);
    let most = if spread > 0.0 { quarter(3) + FAR * spread } else { f64::INFINITY };
    sorted.partition_point(|&output| output <= most)
}

fn draw_legend(sheet: &mut Sheet, y: f64, limit: f64, fit: Option<Fit>, beyond: usize) {
    let mut x = LEFT;
    let mut named = |sheet: &mut Sheet, width: f64, text: &str| {
        let left = x;
        sheet.text([left + width + 10.0, y], text, TextStyle::new(LABEL_SIZE));
        x += width + 10.0 + text_width(text, LABEL_SIZE) + 34.0;
        left
    };
    let box_at = |left: f64| Rect { left, top: y - 13.0, width: 18.0, height: 16.0 };
    let left = named(sheet, 18.0, &format!("below {}", three_digits(limit)));
    fill(sheet, &box_at(left), true);
    let left = named(sheet, 18.0, "at or above");
    fill(sheet, &box_at(left), false);
    let left = named(sheet, 34.0, "share below");
    sheet.line([left, y - 5.0], [left + 34.0, y - 5.0], Style::line(INK, 2.4));
    if let Some(fit) = fit {
        let left = named(sheet, 34.0, &fit.text());
        sheet.line([left, y - 5.0], [left + 34.0, y - 5.0], Style::line(GREY, 2.4).dashed());
    }
    if beyond > 0 {
        let samples = if beyond == 1 { "sample lies" } else { "samples lie" };
        named(sheet, 0.0, &format!("{beyond} {samples} farther right"));
    }
}

/// A bar: that of samples that fail is hatched.
fn fill(sheet: &mut Sheet, bar: &Rect, fails: bool) {
    let (left, top, right, bottom) = (bar.left, bar.top, bar.right(), bar.bottom());
    let path = Path::closed([[left, top], [right, top], [right, bottom], [left, bottom]]);
    sheet.path(path.clone(), Style::fill(if fails { FAILS } else { STANDS }).edged(INK, 0.6));
    if fails {
        sheet.hatched(path, ACCENT);
    }
}

/// Bins in a frame with their scales.
struct Chart<'a> {
    frame: &'a Rect,
    bins: Bins,
    limit: f64,
    /// Outputs at the edges of the frame.
    outputs: [f64; 2],
    /// Samples at the top of the frame.
    most: f64,
}

impl<'a> Chart<'a> {
    /// `fit` is the density with the number of samples.
    fn new(frame: &'a Rect, bins: Bins, limit: f64, fit: Option<(Fit, usize)>) -> Self {
        let end = bins.start + bins.width * bins.counts.len() as f64;
        let span = end - bins.start;
        // A limit just outside the outputs is shown beside them.
        let near = |edge: f64| if (limit - edge).abs() <= span { limit } else { edge };
        let (low, high) = (near(bins.start).min(bins.start), near(end).max(end));
        let margin = 0.03 * (high - low);
        let outputs = [low - margin, high + margin];
        let counted = bins.counts.iter().copied().max().unwrap_or(1).max(1) as f64;
        let fitted = fit.map_or(0.0, |(fit, n)| {
            let at = |k: usize| fit.density(along(outputs, k)) * n as f64 * bins.width;
            (0..=CURVE).map(at).fold(0.0, f64::max)
        });
        // A narrow density must not press the bars down.
        let most = 1.08 * counted.max(fitted.min(2.0 * counted));
        Self { frame, bins, limit, outputs, most }
    }

    fn x(&self, output: f64) -> f64 {
        let [low, high] = self.outputs;
        self.frame.left + (output - low) / (high - low) * self.frame.width
    }

    fn y(&self, count: f64) -> f64 {
        self.frame.bottom() - count / self.most * self.frame.height
    }

    /// Height of a share of the samples.
    fn share_y(&self, share: f64) -> f64 {
        self.frame.bottom() - share / 1.08 * self.frame.height
    }

    fn draw(&self, sheet: &mut Sheet, sorted: &[f64], fit: Option<&Fit>) {
        self.draw_ticks(sheet);
        let Bins { start, width, counts } = &self.bins;
        for (k, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let left = start + width * k as f64;
            let (from, to, top) = (self.x(left), self.x(left + width), self.y(count as f64));
            let bar = Rect { left: from, top, width: to - from, height: self.frame.bottom() - top };
            fill(sheet, &bar, left + 0.5 * width < self.limit);
        }
        sheet.clipped(self.frame, |sheet| {
            if let Some(fit) = fit {
                sheet.path(self.density(fit, sorted.len()), Style::line(GREY, 2.4).dashed());
            }
            sheet.path(self.cumulative(sorted), Style::line(INK, 2.4));
        });
        let [low, high] = self.outputs;
        if (low..=high).contains(&self.limit) {
            let x = self.x(self.limit);
            sheet.line([x, self.frame.top], [x, self.frame.bottom()], Style::line(ACCENT, 2.5));
            let text = format!("limit {}", three_digits(self.limit));
            sheet.text([x + 8.0, self.frame.top + 20.0], &text, TextStyle::new(LABEL_SIZE).halo());
        }
    }

    /// The density as the number of samples that it puts into a bin.
    fn density(&self, fit: &Fit, n: usize) -> Path {
        let place = |output: f64| [self.x(output), self.y(fit.density(output) * n as f64 * self.bins.width)];
        Path::open((0..=CURVE).map(|k| along(self.outputs, k)).map(place))
    }

    /// Steps of the share of the samples below each output.
    fn cumulative(&self, sorted: &[f64]) -> Path {
        let [low, high] = self.outputs;
        let n = sorted.len() as f64;
        let mut steps = vec![[self.x(low), self.share_y(0.0)]];
        for (k, &output) in sorted.iter().enumerate().take_while(|(_, output)| **output <= high) {
            let x = self.x(output);
            steps.extend([[x, self.share_y(k as f64 / n)], [x, self.share_y((k + 1) as f64 / n)]]);
        }
        let last = steps[steps.len() - 1][1];
        steps.push([self.x(high), last]);
        Path::open(super::history::thinned(steps.into_iter()))
    }

    fn draw_ticks(&self, sheet: &mut Sheet) {
        let (frame, [low, high]) = (self.frame, self.outputs);
        let across = Ticks::new(low, high, 12.0);
        for &output in &across.values {
            draw_upright(sheet, frame, self.x(output), &across.label(output), 4.0);
        }
        let up = Ticks::new(0.0, self.most, 8.0);
        for &count in up.values.iter().filter(|count| count.fract() == 0.0) {
            draw_level(sheet, frame, self.y(count), &format!("{count}"));
        }
        for percent in [0.0, 25.0, 50.0, 75.0, 100.0] {
            let y = self.share_y(0.01 * percent);
            sheet.line([frame.right(), y], [frame.right() + 6.0, y], Style::line(INK, 1.2));
            let label = format!("{percent} %");
            sheet.text([frame.right() + 10.0, y + 0.36 * TICK_SIZE], &label, TextStyle::new(TICK_SIZE));
        }
    }
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

    /// The area below a density is 1.
    #[test]
    fn densities_have_their_mean() {
        for is_lognormal in [false, true] {
            let fit = Fit { is_lognormal, mean: 1.3, sd: 0.2 };
            let sum = |of: &dyn Fn(f64) -> f64| (1..8000).map(|k| 5e-4 * of(5e-4 * f64::from(k))).sum::<f64>();
            assert!((sum(&|x| fit.density(x)) - 1.0).abs() < 1e-6);
            assert!((sum(&|x| x * fit.density(x)) - 1.3).abs() < 1e-6);
        }
    }

    /// Ten bins over factors from 1 to 33 once hid the samples near 1.
    #[test]
    fn outputs_far_above_the_others_are_counted_and_not_drawn() {
        let mut outputs: Vec<f64> = (0..100).map(|k| 0.9 + 0.005 * f64::from(k)).collect();
        outputs.extend([20.0, 33.0]);
        assert_eq!(shown(&outputs), 100);
        let svg = histogram_picture("t", "c", "factor of safety", &outputs, 1.0, None).svg();
        assert!(svg.contains("2 samples lie farther right"), "{svg}");
    }

    #[test]
    fn equal_outputs_and_none_are_drawn() {
        for outputs in [&[][..], &[1.3], &[1.3; 7], &[0.0; 3], &[f64::NAN, 1.0, f64::INFINITY]] {
            let fit = Fit { is_lognormal: true, mean: 1.3, sd: 0.0 };
            let svg = histogram_picture("t", "c", "factor of safety", outputs, 1.0, Some(fit));
            assert!(!svg.svg().contains("NaN") && !svg.svg().contains("inf"), "{}", svg.svg());
        }
    }
}
