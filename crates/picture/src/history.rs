//! Histories as small multiples: one frame per quantity, a common axis with the stages.
//!
//! Dynamic stages share the axis by their true time; static stages, whose time is a path and no physics, have bands of
//! equal width without numbers.

use super::Picture;
use enmm_io::numbers::superscript;

use super::axes::{LABEL_SIZE, TICK_SIZE, Ticks, draw_level, draw_upright};
use super::colour::{BAND, Colour, GREY, INK, LINES};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted, text_width};
use super::slope::{BELOW_FRAME, LEFT, LINE_HEIGHT, MARGIN, WIDTH, draw_title};
use super::stage_axis::{FARTHEST, NAME_ROW, StageAxis, StageStart};

/// Room (px) at the right of the frames for legends.
const LEGEND_ROOM: f64 = 300.0;
/// Top of the first frame (px) below a title without names of stages.
const FRAME_TOP: f64 = 80.0;
/// Distance (px) of the frames.
const BETWEEN: f64 = 26.0;
/// Height (px) that the frames share, unless that makes them lower than `LOWEST`.
const SHARED_HEIGHT: f64 = 840.0;
/// Height (px) of a frame at least and at most.
const LOWEST: f64 = 170.0;
const HIGHEST: f64 = 520.0;
/// Distance (px) of value ticks that is aimed at.
const TICK_DISTANCE: f64 = 36.0;

/// A quantity over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Quantity, such as `displacement`; series of one quantity and unit share a frame.
    pub quantity: String,
    /// Unit, such as `m` or `J`.
    pub unit: String,
    /// Time (s) and value.
    pub points: Vec<(f64, f64)>,
}

/// Draws series over the stages, those of one quantity in one frame; a broken line and a name mark each of several
/// stages. Without stages all times are true.
pub fn history_picture(title: &str, series: &[Series], stages: &[StageStart]) -> Picture {
    let groups = by_quantity(series);
    let count = groups.len().max(1) as f64;
    let height = ((SHARED_HEIGHT - BETWEEN * (count - 1.0)) / count).clamp(LOWEST, HIGHEST);
    let times = Range::of(series.iter().flat_map(drawable).map(|(time, _)| time));
    let width = WIDTH - LEFT - LEGEND_ROOM;
    let axis = times.map(|times| StageAxis::new([times.min, times.max], stages, LEFT, width));
    let frame_top = FRAME_TOP + NAME_ROW * axis.as_ref().map_or(0, StageAxis::name_rows) as f64;
    let mut sheet = Sheet::new(WIDTH, frame_top + count * (height + BETWEEN) + BELOW_FRAME);
    draw_title(&mut sheet, title, "");
    let frame = |k: usize| {
        let top = frame_top + k as f64 * (height + BETWEEN);
        Rect { left: LEFT, top, width, height }
    };
    for (k, group) in groups.iter().enumerate() {
        let values = Range::of(group.iter().flat_map(|series| drawable(series)).map(|(_, value)| value));
        Chart { frame: frame(k), axis: axis.as_ref(), values: values.map(Range::with_margin) }.draw(&mut sheet, group);
    }
    if groups.is_empty() {
        Chart { frame: frame(0), axis: None, values: None }.draw(&mut sheet, &[]);
    }
    if let Some(axis) = &axis {
        axis.draw_names(&mut sheet, frame_top);
    }
    let title = axis.as_ref().map_or("time [s]", StageAxis::title);
    let (last, style) =
        (frame(groups.len().max(1) - 1), TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY));
    sheet.text([last.middle()[0], last.bottom() + 45.0], title, style);
    sheet.finish()
}

/// The series of each quantity and unit, in the order of their first.
fn by_quantity(series: &[Series]) -> Vec<Vec<&Series>> {
    let mut groups: Vec<Vec<&Series>> = Vec::new();
    for series in series {
        let is_alike = |other: &Series| other.unit == series.unit && other.quantity == series.quantity;
        match groups.iter_mut().find(|group| is_alike(group[0])) {
            Some(group) => group.push(series),
            None => groups.push(vec![series]),
        }
    }
    groups
}

fn is_drawable((time, value): (f64, f64)) -> bool {
    time.abs() < FARTHEST && value.abs() < FARTHEST
}

fn drawable(series: &Series) -> impl Iterator<Item = (f64, f64)> {
    series.points.iter().copied().filter(|&point| is_drawable(point))
}

/// An interval of times or values.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    min: f64,
    max: f64,
}

impl Range {
    /// The interval of the values, widened about a value that stays constant; none without values.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let grow = |range: Self, value: Self| Self { min: range.min.min(value.min), max: range.max.max(value.max) };
        let range = values.map(|value| Self { min: value, max: value }).reduce(grow)?;
        let size = range.min.abs().max(range.max.abs());
        if range.max - range.min > 1e-9 * size {
            return Some(range);
        }
        let half = if size > 0.0 { 0.1 * size } else { 1.0 };
        Some(Self { min: range.min - half, max: range.max + half })
    }

    fn with_margin(self) -> Self {
        let margin = 0.06 * (self.max - self.min);
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// 0 at the lower end, 1 at the upper.
    fn fraction(&self, value: f64) -> f64 {
        (value - self.min) / (self.max - self.min)
    }

    /// The power of a thousand by which numbers of this size are divided to be short.
    fn exponent(&self) -> i32 {
        let size = self.min.abs().max(self.max.abs());
        if (0.02..2e4).contains(&size) { 0 } else { 3 * (libm::log10(size) / 3.0).floor() as i32 }
    }
}

/// A frame with its scales; without data it has none.
struct Chart<'a> {
    frame: Rect,
    axis: Option<&'a StageAxis>,
    values: Option<Range>,
}

impl Chart<'_> {
    fn draw(&self, sheet: &mut Sheet, group: &[&Series]) {
        let [quantity, unit] = group.first().map_or(["", ""], |series| [&series.quantity, &series.unit]);
        match (self.axis, self.values) {
            (Some(axis), Some(values)) => {
                axis.bands().for_each(|[left, width]| {
                    sheet.rect(&Rect { left, width, ..self.frame }, Style::fill(BAND).crisp());
                });
                self.draw_time_ticks(sheet, axis);
                self.draw_value_ticks(sheet, values, quantity, unit);
                for x in axis.borders() {
                    sheet.line([x, self.frame.top], [x, self.frame.bottom()], Style::line(GREY, 1.4).dashed());
                }
                sheet.clipped(&self.frame, |sheet| self.draw_lines(sheet, group, axis, values));
            }
            _ => {
                let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
                sheet.text(self.frame.middle(), "no data", style);
                self.draw_value_title(sheet, &axis_title(quantity, unit, 0));
            }
        }
        sheet.rect(&self.frame, Style::line(INK, 1.2));
        self.draw_legend(sheet, group);
    }

    fn pixel(&self, axis: &StageAxis, values: Range, (time, value): (f64, f64)) -> Pixel {
        [axis.x(time), self.frame.bottom() - values.fraction(value) * self.frame.height]
    }

    fn draw_time_ticks(&self, sheet: &mut Sheet, axis: &StageAxis) {
        for (x, label) in axis.ticks() {
            draw_upright(sheet, &self.frame, x, &label, 4.0);
        }
        for [left, width] in axis.bands().filter(|[_, width]| *width > text_width("static", TICK_SIZE) + 8.0) {
            let middle = [left + 0.5 * width, self.frame.bottom() + 4.0 + TICK_SIZE];
            sheet.text(middle, "static", TextStyle::new(TICK_SIZE).anchor(Anchor::Middle).colour(GREY));
        }
    }

    fn draw_value_ticks(&self, sheet: &mut Sheet, values: Range, quantity: &str, unit: &str) {
        let exponent = values.exponent();
        let divisor = 10.0_f64.powi(exponent);
        let ticks =
            Ticks::new(values.min / divisor, values.max / divisor, (self.frame.height / TICK_DISTANCE).max(3.0));
        for &value in &ticks.values {
            let y = self.frame.bottom() - values.fraction(value * divisor) * self.frame.height;
            draw_level(sheet, &self.frame, y, &ticks.label(value));
        }
        self.draw_value_title(sheet, &axis_title(quantity, unit, exponent));
    }

    fn draw_value_title(&self, sheet: &mut Sheet, title: &str) {
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward();
        sheet.text([LEFT - 76.0, self.frame.top + 0.5 * self.frame.height], title, style);
    }

    fn draw_lines(&self, sheet: &mut Sheet, group: &[&Series], axis: &StageAxis, values: Range) {
        for (k, series) in group.iter().enumerate() {
            let mut path = Path::default();
            for run in series.points.split(|&point| !is_drawable(point)).filter(|run| !run.is_empty()) {
                path.line(thinned(run.iter().map(|&point| self.pixel(axis, values, point))));
            }
            sheet.path(path, line_style(k));
            if let [only] = drawable(series).take(2).collect::<Vec<_>>()[..] {
                sheet.circle(self.pixel(axis, values, only), 4.0, Style::fill(line_colour(k)));
            }
        }
    }

    fn draw_legend(&self, sheet: &mut Sheet, group: &[&Series]) {
        let room = ((self.frame.height / LINE_HEIGHT) as usize).max(1);
        let shown = if group.len() > room { room - 1 } else { group.len() };
        let left = self.frame.right() + 22.0;
        let line_y = |k: usize| self.frame.top + LINE_HEIGHT * (k as f64 + 0.6);
        let width = WIDTH - MARGIN - left - 44.0;
        for (k, series) in group.iter().take(shown).enumerate() {
            let y = line_y(k);
            sheet.line([left, y], [left + 32.0, y], line_style(k));
            sheet.text([left + 44.0, y + 6.0], &fitted(&series.name, LABEL_SIZE, width), TextStyle::new(LABEL_SIZE));
        }
        if shown < group.len() {
            let more = format!("and {} more", group.len() - shown);
            sheet.text([left + 44.0, line_y(shown) + 6.0], &more, TextStyle::new(LABEL_SIZE).colour(GREY));
        }
    }
}

fn line_colour(k: usize) -> Colour {
    LINES[k % LINES.len()]
}

/// Every second line of a frame is broken, so that neighbours differ without colour.
fn line_style(k: usize) -> Style {
    let style = Style::line(line_colour(k), if k % 4 < 2 { 2.0 } else { 3.2 });
    if k % 2 == 1 { style.dashed() } else { style }
}

/// `displacement [mm]`, `energy [MJ/m]`; the quantity alone for a bare number.
fn axis_title(quantity: &str, unit: &str, exponent: i32) -> String {
    const PREFIXES: [(i32, &str); 6] = [(-9, "n"), (-6, "µ"), (-3, "m"), (3, "k"), (6, "M"), (9, "G")];
    let prefix = PREFIXES.iter().find(|(power, _)| *power == exponent && !unit.is_empty());
    let scale = match (exponent, prefix) {
        (0, _) => unit.to_owned(),
        (_, Some((_, prefix))) => format!("{prefix}{unit}"),
        (_, None) => format!("10{} {unit}", superscript(exponent)).trim_end().to_owned(),
    };
    let scale = if scale.is_empty() { scale } else { format!("[{scale}]") };
    [quantity, &scale].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Of the positions in one column of pixels only the first, the lowest, the highest and the last: the line looks the
/// same.
pub(super) fn thinned(positions: impl Iterator<Item = Pixel>) -> Vec<Pixel> {
    let mut thin: Vec<Pixel> = Vec::new();
    let mut column: Vec<Pixel> = Vec::new();
    for position in positions {
        if column.first().is_some_and(|first| first[0].floor() != position[0].floor()) {
            flush_column(&mut thin, &mut column);
        }
        column.push(position);
    }
    flush_column(&mut thin, &mut column);
    thin
}

fn flush_column(thin: &mut Vec<Pixel>, column: &mut Vec<Pixel>) {
    if column.len() <= 4 {
        thin.append(column);
        return;
    }
    let by_height = |&a: &usize, &b: &usize| column[a][1].total_cmp(&column[b][1]);
    let lowest = (0..column.len()).min_by(by_height);
    let highest = (0..column.len()).max_by(by_height);
    let mut kept = vec![0, column.len() - 1];
    kept.extend(lowest.into_iter().chain(highest));
    kept.sort_unstable();
    kept.dedup();
    thin.extend(kept.into_iter().map(|k| column[k]));
    column.clear();
}
