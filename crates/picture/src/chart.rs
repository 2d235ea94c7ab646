//! One quantity over another: lines and marks in a frame with linear or logarithmic axes, and a legend.

use super::Picture;
use enmm_io::numbers::superscript;

use super::axes::{LABEL_SIZE, Ticks, draw_level, draw_upright};
use super::colour::{GREY, INK, LINES, WHITE};
use super::history::thinned;
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted, wrapped};

/// Size of the picture (px).
const SIZE: [f64; 2] = [860.0, 440.0];
/// The frame (px); the legend stands at its right.
const FRAME: Rect = Rect { left: 96.0, top: 52.0, width: 500.0, height: 320.0 };
/// Distance (px) of the ticks that are aimed at.
const TICK_DISTANCE: [f64; 2] = [70.0, 40.0];
/// Distance (px) of the lines of the legend.
const LINE_HEIGHT: f64 = 24.0;
/// Radius (px) of a mark.
const MARK: f64 = 4.2;
/// Most decades that get a tick each.
const DECADES_MAX: i32 = 8;
/// Values beyond this are taken for numerical failures and left out.
const FARTHEST: f64 = 1e300;

/// A line, or marks, of a chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChartSeries {
    /// Name in the legend.
    pub name: String,
    /// Points; those that are not finite, or not above zero on a logarithmic axis, are left out.
    pub points: Vec<[f64; 2]>,
    /// Marks instead of a line.
    pub marks: bool,
}

/// Content of a chart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// Names of both axes with their units.
    pub axes: [String; 2],
    /// Whether each axis is logarithmic.
    pub logarithmic: [bool; 2],
    /// Lines and marks, in the order in which they are drawn.
    pub series: Vec<ChartSeries>,
}

/// Draws a chart.
pub fn chart_picture(chart: &Chart) -> Picture {
    let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
    let title = fitted(&chart.title, 20.0, SIZE[0] - FRAME.left - 16.0);
    sheet.text([FRAME.left, 32.0], &title, TextStyle::new(20.0));
    let scales = [0, 1].map(|axis| Scale::of(chart, axis));
    match scales {
        [Some(x), Some(y)] => {
            draw_ticks(&mut sheet, &x, &y);
            sheet.clipped(&FRAME.grown(MARK + 1.0), |sheet| draw_series(sheet, chart, &x, &y));
        }
        _ => sheet.text(FRAME.middle(), "no data", TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY)),
    }
    sheet.rect(&FRAME, Style::line(INK, 1.2));
    draw_names(&mut sheet, &chart.axes);
    draw_legend(&mut sheet, &chart.series);
    sheet.finish()
}

/// The values that one axis shows; of a logarithmic one their decimal logarithms.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scale {
    min: f64,
    max: f64,
    logarithmic: bool,
}

impl Scale {
    /// The interval of the drawable points with a margin; none without a point.
    fn of(chart: &Chart, axis: usize) -> Option<Self> {
        let logarithmic = chart.logarithmic[axis];
        let points = chart.series.iter().flat_map(|series| &series.points);
        let values = points.filter(|point| is_drawable(chart, point)).map(|point| placed(point[axis], logarithmic));
        let (min, max) = values.map(|v| (v, v)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let size = min.abs().max(max.abs());
        let lowest = if logarithmic { 0.5 } else { 1e-9 * size };
        let span = max - min;
        let margin = if span > lowest {
            0.05 * span
        } else if logarithmic || size == 0.0 {
            0.5
        } else {
            0.1 * size
        };
        Some(Self { min: min - margin, max: max + margin, logarithmic })
    }

    /// 0 at the lower end, 1 at the upper.
    fn fraction(&self, value: f64) -> f64 {
        (placed(value, self.logarithmic) - self.min) / (self.max - self.min)
    }

    /// Values and labels of the ticks.
    fn ticks(&self, most: f64) -> Vec<(f64, String)> {
        if self.logarithmic { self.decades() } else { self.round_values(most) }
    }

    fn round_values(&self, most: f64) -> Vec<(f64, String)> {
        let size = self.min.abs().max(self.max.abs());
        let exponent = if (1e-2..1e5).contains(&size) { 0 } else { 3 * (libm::log10(size) / 3.0).floor() as i32 };
        let unit = 10f64.powi(exponent);
        let ticks = Ticks::new(self.min / unit, self.max / unit, most);
        let power = if exponent == 0 { String::new() } else { format!("·10{}", superscript(exponent)) };
        let label = |value: f64| if value == 0.0 { "0".to_owned() } else { ticks.label(value) + &power };
        ticks.values.iter().map(|&value| (value * unit, label(value))).collect()
    }

    /// Whole powers of ten; within fewer than two decades also 2 and 5 times them.
    fn decades(&self) -> Vec<(f64, String)> {
        let (first, last) = (self.min.floor() as i32, self.max.ceil() as i32);
        let step = 1 + (last - first) / DECADES_MAX;
        let digits: &[f64] = if self.max - self.min < 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let within = |value: &f64| (self.min..=self.max).contains(&libm::log10(*value));
        let power = |k: i32, digit: f64| {
            let times = if digit == 1.0 { String::new() } else { format!("{digit}·") };
            (digit * 10f64.powi(k), format!("{times}10{}", superscript(k)))
        };
        let all = (first..=last).step_by(step as usize).flat_map(|k| digits.iter().map(move |&digit| (k, digit)));
        all.map(|(k, digit)| power(k, digit)).filter(|(value, _)| within(value)).collect()
    }
}

fn placed(value: f64, logarithmic: bool) -> f64 {
    if logarithmic { libm::log10(value) } else { value }
}

fn is_drawable(chart: &Chart, point: &[f64; 2]) -> bool {
    // A comparison with NaN is false.
    (0..2).all(|axis| point[axis].abs() < FARTHEST && (!chart.logarithmic[axis] || point[axis] > 0.0))
}

fn pixel(x: &Scale, y: &Scale, point: &[f64; 2]) -> Pixel {
    [FRAME.left + x.fraction(point[0]) * FRAME.width, FRAME.bottom() - y.fraction(point[1]) * FRAME.height]
}

fn draw_ticks(sheet: &mut Sheet, x: &Scale, y: &Scale) {
    for (value, label) in x.ticks(FRAME.width / TICK_DISTANCE[0]) {
        let at = FRAME.left + x.fraction(value) * FRAME.width;
        draw_upright(sheet, &FRAME, at, &label, 6.0);
    }
    for (value, label) in y.ticks(FRAME.height / TICK_DISTANCE[1]) {
        let at = FRAME.bottom() - y.fraction(value) * FRAME.height;
        draw_level(sheet, &FRAME, at, &label);
    }
}

fn draw_names(sheet: &mut Sheet, [x, y]: &[String; 2]) {
    let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    let [across, up] = FRAME.middle();
    sheet.text([across, FRAME.bottom() + 48.0], &fitted(x, LABEL_SIZE, FRAME.width), style);
    sheet.text([22.0, up], &fitted(y, LABEL_SIZE, FRAME.height), style.upward());
}

fn draw_series(sheet: &mut Sheet, chart: &Chart, x: &Scale, y: &Scale) {
    for (k, series) in chart.series.iter().enumerate() {
        let colour = LINES[k % LINES.len()];
        if series.marks {
            for point in series.points.iter().filter(|point| is_drawable(chart, point)) {
                sheet.circle(pixel(x, y, point), MARK, Style::fill(WHITE).edged(colour, 2.0));
            }
            continue;
        }
        let mut path = Path::default();
        for run in series.points.split(|point| !is_drawable(chart, point)).filter(|run| !run.is_empty()) {
            path.line(thinned(run.iter().map(|point| pixel(x, y, point))));
        }
        sheet.path(path, Style::line(colour, 2.0));
    }
}

fn draw_legend(sheet: &mut Sheet, series: &[ChartSeries]) {
    let left = FRAME.right() + 18.0;
    let (text_left, text_size) = (left + 36.0, 14.0);
    let width = SIZE[0] - text_left - 8.0;
    let mut y = FRAME.top + 10.0;
    for (k, series) in series.iter().enumerate() {
        let colour = LINES[k % LINES.len()];
        if series.marks {
            sheet.circle([left + 14.0, y], MARK, Style::fill(WHITE).edged(colour, 2.0));
        } else {
            sheet.line([left, y], [left + 28.0, y], Style::line(colour, 2.6));
        }
        let lines = wrapped(&series.name, text_size, width);
        for line in &lines {
            sheet.text([text_left, y + 5.0], line, TextStyle::new(text_size));
            y += 18.0;
        }
        y += LINE_HEIGHT - 18.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>, logarithmic: bool) -> Chart {
        let series = vec![ChartSeries { name: "a line".to_owned(), points, marks: false }];
        Chart { title: "t".to_owned(), axes: Default::default(), logarithmic: [logarithmic; 2], series }
    }

    #[test]
    fn logarithmic_axes_leave_out_what_is_not_positive_and_tick_decades() {
        let chart = chart(vec![[0.0, 1.0], [-1.0, 2.0], [0.01, 1.0], [10.0, 1000.0]], true);
        let scale = Scale::of(&chart, 0).expect("points");
        let ticks = scale.ticks(5.0);
        assert_eq!(ticks.iter().map(|t| t.0).collect::<Vec<_>>(), [0.01, 0.1, 1.0, 10.0]);
        assert_eq!(ticks[0].1, "10⁻²");
        assert!((scale.fraction(0.1) - (1.0 + 0.15) / 3.3).abs() < 1e-12);
    }

    #[test]
    fn a_chart_without_points_or_with_one_is_drawn() {
        assert!(chart_picture(&chart(vec![[f64::NAN, 1.0]], false)).svg().contains("no data"));
        for logarithmic in [false, true] {
            let svg = chart_picture(&chart(vec![[2.0, 2.0]], logarithmic));
            assert!(!svg.svg().contains("NaN") && !svg.svg().contains("no data"), "{}", svg.svg());
        }
    }

    #[test]
    fn small_numbers_carry_their_power_of_ten() {
        let scale = Scale { min: 0.0, max: 2e-3, logarithmic: false };
        let labels: Vec<String> = scale.ticks(4.0).into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["0", "0.5·10⁻³", "1.0·10⁻³", "1.5·10⁻³", "2.0·10⁻³"]);
    }
}
