//! Pictures of sweeps: a factor over the values of one key or of two, and the effects of changes one by one.

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, TICK_SIZE, Ticks, View, draw_level, draw_upright, number_text, three_digits};
use super::bar::{BAR_ROOM, draw_bands};
use super::colour::{ACCENT, Colour, GREY, INK, LOCK, SCALE_STEPS, SLIP, WHITE, scale};
use super::contours::{cut, round_levels};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted};
use super::slope::{BELOW_FRAME, LEFT, MARGIN, TOP, WIDTH, draw_title};
use enmm::geometry::Point;

/// Height (px) of the frame of curves and contours.
const HEIGHT: f64 = 620.0;
/// Distance (px) of the ticks that are aimed at, along x and y.
const TICK_DISTANCE: [f64; 2] = [100.0, 60.0];
/// Width (px) of the names beside bars.
const NAMES: f64 = 480.0;
/// Room (px) for a bar, and how much of it the bar takes.
const BAR: [f64; 2] = [56.0, 30.0];
/// Least length (px) of a bar that can be seen.
const SEEN: f64 = 1.0;
/// Radius (px) of the mark of a sample.
const MARK: f64 = 4.5;

/// A factor over the values of a key.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curve {
    /// Title.
    pub title: String,
    /// Line below it.
    pub caption: String,
    /// Names of the key and of the factor.
    pub axes: [String; 2],
    /// Value and factor of each sample, in ascending order.
    pub points: Vec<[f64; 2]>,
    /// Factor at which a line is drawn, if any.
    pub limit: Option<f64>,
    /// Values at which the curve crosses that line.
    pub crossings: Vec<f64>,
}

/// A factor over the values of two keys.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grid {
    /// Title.
    pub title: String,
    /// Line below it.
    pub caption: String,
    /// Names of the keys.
    pub axes: [String; 2],
    /// Name of the factor.
    pub name: String,
    /// Values of both keys, ascending.
    pub values: [Vec<f64>; 2],
    /// Factors, those of the first key beside each other; not a number where there is none.
    pub outputs: Vec<f64>,
    /// Factor at which a thick line is drawn, if any.
    pub limit: Option<f64>,
}

/// Effects of changes one by one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bars {
    /// Title.
    pub title: String,
    /// Line below it.
    pub caption: String,
    /// Name of the factor.
    pub name: String,
    /// Factor without a change.
    pub base: Option<f64>,
    /// Factor at which a line is drawn, if any.
    pub limit: Option<f64>,
    /// Name of each key, with values and the factors that they make.
    pub bars: Vec<(String, Vec<(String, f64)>)>,
}

/// An interval of numbers along a side of a frame.
#[derive(Debug, Clone, Copy)]
struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// The interval of the finite numbers, with a share of it added at both ends.
    fn of(numbers: impl Iterator<Item = f64>, margin: f64) -> Option<Self> {
        let finite = numbers.filter(|number| number.is_finite()).map(|number| (number, number));
        let (low, high) = finite.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let span = if high > low { high - low } else { low.abs().max(1e-12) };
        let grow = if high > low { margin * span } else { 0.5 * span };
        Some(Self { low: low - grow, high: high + grow })
    }

    fn share(&self, number: f64) -> f64 {
        (number - self.low) / (self.high - self.low)
    }

    /// Ticks at round numbers, with labels.
    fn ticks(&self, length: f64, distance: f64) -> Vec<(f64, String)> {
        let ticks = Ticks::new(self.low, self.high, length / distance);
        let is_plain = self.low.abs().max(self.high.abs()) < 1e5;
        let label = |value: f64| if is_plain { ticks.label(value) } else { number_text(value) };
        ticks.values.iter().map(|&value| (value, label(value))).collect()
    }
}

/// A frame with a scale along each side.
struct Frame {
    area: Rect,
    across: Scale,
    up: Scale,
}

impl Frame {
    fn pixel(&self, [x, y]: [f64; 2]) -> Pixel {
        let Self { area, across, up } = self;
        [area.left + across.share(x) * area.width, area.bottom() - up.share(y) * area.height]
    }

    /// Ticks and the names of both axes.
    fn draw_axes(&self, sheet: &mut Sheet, [x, y]: &[String; 2]) {
        let area = &self.area;
        for (value, label) in self.across.ticks(area.width, TICK_DISTANCE[0]) {
            draw_upright(sheet, area, self.pixel([value, self.up.low])[0], &label, 4.0);
        }
        for (value, label) in self.up.ticks(area.height, TICK_DISTANCE[1]) {
            draw_level(sheet, area, self.pixel([self.across.low, value])[1], &label);
        }
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
        let [centre, height] = area.middle();
        sheet.text([centre, area.bottom() + 45.0], &fitted(x, LABEL_SIZE, area.width), style);
        sheet.text([LEFT - 84.0, height], &fitted(y, LABEL_SIZE, area.height), style.upward());
    }
}

/// A sheet with title and caption.
fn titled(title: &str, caption: &str, height: f64) -> Sheet {
    let mut sheet = Sheet::new(WIDTH, TOP + height + BELOW_FRAME + MARGIN);
    draw_title(&mut sheet, title, caption);
    sheet
}

/// Says that there is nothing to draw.
fn draw_nothing(sheet: &mut Sheet, area: &Rect) {
    sheet.text(area.middle(), "no factors", TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY));
}

/// Draws a factor over a key, the line of the limit and where both cross.
pub fn curve_picture(curve: &Curve) -> Picture {
    let mut sheet = titled(&curve.title, &curve.caption, HEIGHT);
    let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - MARGIN, height: HEIGHT };
    let points = || curve.points.iter().filter(|point| point.iter().all(|number| number.is_finite()));
    let up = Scale::of(points().map(|point| point[1]).chain(curve.limit), 0.08);
    match (Scale::of(points().map(|point| point[0]), 0.03), up) {
        (Some(across), Some(up)) => {
            let frame = Frame { area, across, up };
            frame.draw_axes(&mut sheet, &curve.axes);
            if let Some(limit) = curve.limit {
                let height = frame.pixel([across.low, limit])[1];
                sheet.line([area.left, height], [area.right(), height], Style::line(ACCENT, 2.5));
            }
            sheet.path(Path::open(points().map(|point| frame.pixel(*point))), Style::line(LOCK, 2.6));
            for point in points() {
                sheet.circle(frame.pixel(*point), MARK, Style::fill(WHITE).edged(LOCK, 2.0));
            }
            for (limit, &value) in
                curve.limit.iter().flat_map(|limit| curve.crossings.iter().map(move |at| (limit, at)))
            {
                draw_crossing(&mut sheet, &frame, *limit, value);
            }
        }
        _ => draw_nothing(&mut sheet, &area),
    }
    sheet.rect(&area, Style::line(INK, 1.2));
    sheet.finish()
}

/// A crossing with its value.
fn draw_crossing(sheet: &mut Sheet, frame: &Frame, limit: f64, value: f64) {
    let at = frame.pixel([value, limit]);
    sheet.line(at, [at[0], frame.area.bottom()], Style::line(ACCENT, 2.0).dashed());
    sheet.circle(at, 1.6 * MARK, Style::fill(ACCENT));
    let is_right = at[0] > frame.area.middle()[0];
    let (side, anchor) = if is_right { (-12.0, Anchor::End) } else { (12.0, Anchor::Start) };
    let text = format!("F = {} at {}", three_digits(limit), number_text(value));
    sheet.text([at[0] + side, frame.area.bottom() - 14.0], &text, TextStyle::new(LABEL_SIZE).anchor(anchor).halo());
}

/// Draws contours of a factor over two keys, that of the limit thick.
pub fn grid_picture(grid: &Grid) -> Picture {
    let mut sheet = titled(&grid.title, &grid.caption, HEIGHT);
    let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - BAR_ROOM, height: HEIGHT };
    let [x, y] = &grid.values;
    let sides = Scale::of(x.iter().copied(), 0.0).zip(Scale::of(y.iter().copied(), 0.0));
    let finite = || grid.outputs.iter().copied().filter(|output| output.is_finite());
    let [low, high] = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
    match sides.filter(|_| low <= high) {
        Some((across, up)) => {
            let frame = Frame { area, across, up };
            frame.draw_axes(&mut sheet, &grid.axes);
            let (levels, labels) = round_levels([low, high], 1.0);
            let colours: Vec<Colour> =
                (0..=levels.len()).map(|band| scale((SCALE_STEPS - 1) * band / levels.len().max(1))).collect();
            Bands { grid, frame: &frame, levels: &levels, colours: &colours }.draw(&mut sheet);
            draw_bands(&mut sheet, &area, &fitted(&grid.name, LABEL_SIZE, HEIGHT), &colours, &labels);
        }
        None => draw_nothing(&mut sheet, &area),
    }
    sheet.rect(&area, Style::line(INK, 1.2));
    sheet.finish()
}

/// Contours in a frame.
struct Bands<'a> {
    grid: &'a Grid,
    frame: &'a Frame,
    levels: &'a [f64],
    colours: &'a [Colour],
}

impl Bands<'_> {
    fn draw(&self, sheet: &mut Sheet) {
        let area = self.frame.area;
        // In it a place is its distance (px) from the lower left corner of the frame.
        let world = Bounds { min: Point::zeros(), max: Point::new(area.width, area.height) };
        let view = View::exact(world, area);
        let mut bands = vec![Path::default(); self.colours.len()];
        let (mut lines, mut limit) = (Path::default(), Path::default());
        for (places, outputs) in self.triangles() {
            let least = outputs.iter().copied().fold(f64::INFINITY, f64::min);
            let base = self.levels.partition_point(|&level| level <= least);
            bands[base].polygon(places.iter().map(|place| view.pixel(place)));
            for (k, &level) in self.levels.iter().enumerate().skip(base) {
                let (above, line) = cut(&places, &outputs, level, &view);
                bands[k + 1].polygon(above);
                line.chunks_exact(2).for_each(|ends| lines.line(ends.iter().copied()));
            }
            if let Some(level) = self.grid.limit {
                let (_, line) = cut(&places, &outputs, level, &view);
                line.chunks_exact(2).for_each(|ends| limit.line(ends.iter().copied()));
            }
        }
        for (band, colour) in bands.into_iter().zip(self.colours) {
            sheet.path(band, Style::fill(*colour).crisp());
        }
        sheet.path(lines, Style::line(INK, 1.1).opacity(0.75));
        sheet.path(limit.clone(), Style::line(WHITE, 7.0));
        sheet.path(limit, Style::line(ACCENT, 4.0));
        let [x, y] = &self.grid.values;
        for (k, output) in self.grid.outputs.iter().enumerate().filter(|(_, output)| output.is_finite()) {
            let at = self.frame.pixel([x[k % x.len()], y[k / x.len()]]);
            sheet.circle(at, 0.7 * MARK, Style::fill(WHITE).edged(INK, 1.0));
            if self.grid.outputs.len() <= 60 {
                let style = TextStyle::new(TICK_SIZE).anchor(Anchor::Middle).halo();
                let inside = |low: f64, number: f64, high: f64| number.clamp(low, high);
                let [left, top] = [area.left + 26.0, area.top + 22.0];
                let place = [inside(left, at[0], area.right() - 26.0), inside(top, at[1] - 9.0, area.bottom() - 9.0)];
                sheet.text(place, &three_digits(*output), style);
            }
        }
    }

    /// Four triangles of each cell whose corners have outputs, about its middle.
    fn triangles(&self) -> Vec<([Point; 3], [f64; 3])> {
        let Frame { area, across, up } = self.frame;
        let [x, y] = &self.grid.values;
        let corner = |i: usize, j: usize| {
            let place = Point::new(across.share(x[i]) * area.width, up.share(y[j]) * area.height);
            (place, self.grid.outputs[j * x.len() + i])
        };
        let mut triangles = Vec::new();
        for (i, j) in (1..y.len()).flat_map(|j| (1..x.len()).map(move |i| (i, j))) {
            let corners = [corner(i - 1, j - 1), corner(i, j - 1), corner(i, j), corner(i - 1, j)];
            let middle = corners.iter().map(|(place, _)| place).sum::<Point>() / 4.0;
            let mean = corners.iter().map(|(_, output)| output).sum::<f64>() / 4.0;
            if mean.is_finite() {
                triangles.extend((0..4).map(|k| {
                    let ((a, of_a), (b, of_b)) = (corners[k], corners[(k + 1) % 4]);
                    ([a, b, middle], [of_a, of_b, mean])
                }));
            }
        }
        triangles
    }
}

/// Draws a bar for each key from the factor of the case to those of its changes.
pub fn bars_picture(bars: &Bars) -> Picture {
    let height = BAR[0] * bars.bars.len().max(1) as f64 + 20.0;
    let mut sheet = titled(&bars.title, &bars.caption, height);
    let area = Rect { left: NAMES, top: TOP, width: WIDTH - NAMES - MARGIN, height };
    let factors = bars.bars.iter().flat_map(|(_, ends)| ends.iter().map(|(_, factor)| *factor));
    match Scale::of(factors.chain(bars.base).chain(bars.limit), 0.12) {
        Some(across) => draw_bars(&mut sheet, bars, &Frame { area, across, up: Scale { low: 0.0, high: 1.0 } }),
        None => draw_nothing(&mut sheet, &area),
    }
    sheet.rect(&area, Style::line(INK, 1.2));
    let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    sheet.text([area.middle()[0], area.bottom() + 45.0], &bars.name, style);
    sheet.finish()
}

fn draw_bars(sheet: &mut Sheet, bars: &Bars, frame: &Frame) {
    let area = frame.area;
    for (value, label) in frame.across.ticks(area.width, TICK_DISTANCE[0]) {
        draw_upright(sheet, &area, frame.pixel([value, 0.0])[0], &label, 4.0);
    }
    let across = |factor: f64| frame.pixel([factor, 0.0])[0];
    if let Some(limit) = bars.limit.map(across) {
        sheet.line([limit, area.top], [limit, area.bottom()], Style::line(ACCENT, 2.5));
    }
    for (k, (name, ends)) in bars.bars.iter().enumerate() {
        let middle = area.top + 10.0 + BAR[0] * (k as f64 + 0.5);
        let style = TextStyle::new(TICK_SIZE).anchor(Anchor::End);
        sheet.text([area.left - 12.0, middle + 6.0], &fitted(name, TICK_SIZE, NAMES - 40.0), style);
        let Some(from) = bars.base.or(ends.first().map(|(_, factor)| *factor)) else { continue };
        let [least, most] = [f64::min, f64::max].map(|pick| ends.iter().map(|(_, to)| *to).fold(from, pick));
        if across(most) - across(least) < SEEN {
            let style = TextStyle::new(TICK_SIZE).colour(GREY).halo();
            sheet.text([across(from) + 6.0, middle + 6.0], "no change", style);
            continue;
        }
        for (value, to) in ends {
            let (left, right) = (across(from.min(*to)), across(from.max(*to)));
            let bar = Rect { left, top: middle - 0.5 * BAR[1], width: right - left, height: BAR[1] };
            let colour = if *to < from { SLIP } else { LOCK };
            sheet.rect(&bar, Style::fill(colour).opacity(0.55));
            sheet.line([across(*to), bar.top], [across(*to), bar.bottom()], Style::line(colour, 2.4));
            if *to > least && *to < most {
                continue;
            }
            let (side, anchor) = if *to < from { (-6.0, Anchor::End) } else { (6.0, Anchor::Start) };
            let style = TextStyle::new(TICK_SIZE).anchor(anchor).halo();
            sheet.text([across(*to) + side, middle + 6.0], value, style);
        }
    }
    if let Some(base) = bars.base.map(across) {
        sheet.line([base, area.top], [base, area.bottom()], Style::line(INK, 2.0));
    }
}
