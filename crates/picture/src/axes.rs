//! From metres to pixels: bounds, views with equal axes, ticks and the numbers beside them.

use super::colour::{GREY, INK, PALE};
use super::sheet::{Anchor, Pixel, Rect, Sheet, Style, TextStyle, text_width};
use enmm::geometry::{Point, Vector};
use enmm_io::numbers::{self, superscript, with_minus};

/// Size (px) of numbers on axes.
pub const TICK_SIZE: f64 = 17.0;
/// Size (px) of axis titles, legends and notes.
pub const LABEL_SIZE: f64 = 19.0;
/// Length (px) of a tick.
const TICK_LENGTH: f64 = 6.0;
/// Distance (px) of the ticks that are aimed at, along x and y.
const TICK_DISTANCE: [f64; 2] = [90.0, 60.0];
/// Coordinates beyond this (m) are taken for numerical failures and left out.
const FARTHEST: f64 = 1e9;
/// The shorter side of a view is at least this part of the longer one.
const THINNEST: f64 = 0.12;

/// Whether a point can be drawn.
pub fn is_drawable(point: &Point) -> bool {
    // A comparison with NaN is false.
    point.x.abs() <= FARTHEST && point.y.abs() <= FARTHEST
}

/// A box in the plane (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub min: Point,
    /// Upper right corner.
    pub max: Point,
}

impl Bounds {
    /// The box of the drawable points; none without one.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<Self> {
        let mut drawable = points.into_iter().filter(|point| is_drawable(point));
        let first = *drawable.next()?;
        let grow = |bounds: Self, point: &Point| Self { min: bounds.min.inf(point), max: bounds.max.sup(point) };
        Some(drawable.fold(Self { min: first, max: first }, grow))
    }

    /// The square about `centre`.
    pub fn square(centre: Point, half_width: f64) -> Self {
        let half = Vector::repeat(half_width);
        Self { min: centre - half, max: centre + half }
    }

    /// Width and height (m).
    pub fn size(&self) -> Vector {
        self.max - self.min
    }

    /// Distance (m) of opposite corners.
    pub fn diagonal(&self) -> f64 {
        self.size().norm()
    }

    /// Whether the point lies inside or on the edge.
    pub fn contains(&self, point: &Point) -> bool {
        (self.min.x..=self.max.x).contains(&point.x) && (self.min.y..=self.max.y).contains(&point.y)
    }

    /// Whether the two share a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x <= other.max.x && other.min.x <= self.max.x && self.min.y <= other.max.y && other.min.y <= self.max.y
    }

    /// The box with room around it, and with neither side vanishing.
    fn with_margin(&self) -> Self {
        let size = self.size();
        let longest = size.max();
        // A single point far from the origin still gets a box that floating point can divide.
        let longest = if longest > 0.0 { longest } else { 1.0_f64.max(self.max.abs().max() * 1e-6) };
        let wanted = size.map(|side| side.max(THINNEST * longest)) + Vector::repeat(0.06 * longest);
        let grow = 0.5 * (wanted - size);
        Self { min: self.min - grow, max: self.max + grow }
    }
}

/// A part of the plane shown in a part of the picture, with equal axes.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Bounds shown (m).
    pub world: Bounds,
    /// Where it is shown (px).
    pub area: Rect,
    /// Pixels per metre.
    pub scale: f64,
}

impl View {
    /// Shows `bounds` with a margin as large as `area` allows, at the left of it; the view is then as high as needed.
    pub fn fit(bounds: Option<Bounds>, area: Rect) -> Self {
        let world = bounds.unwrap_or_else(|| Bounds::square(Point::zeros(), 0.5)).with_margin();
        let size = world.size();
        let scale = (area.width / size.x).min(area.height / size.y);
        let area = Rect { width: size.x * scale, height: size.y * scale, ..area };
        Self { world, area, scale }
    }

    /// Shows exactly `world`, a box of the proportions of `area`.
    pub fn exact(world: Bounds, area: Rect) -> Self {
        Self { world, area, scale: area.width / world.size().x }
    }

    /// Where a point appears.
    pub fn pixel(&self, point: &Point) -> Pixel {
        let from_corner = (point - self.world.min) * self.scale;
        [self.area.left + from_corner.x, self.area.bottom() - from_corner.y]
    }

    /// Draws the frame with ticks and coordinates in metres.
    pub fn draw_axes(&self, sheet: &mut Sheet) {
        self.draw_horizontal_axis(sheet);
        self.draw_vertical_axis(sheet);
        sheet.rect(&self.area, Style::line(INK, 1.2));
    }

    fn draw_horizontal_axis(&self, sheet: &mut Sheet) {
        let bottom = self.area.bottom();
        let most = (self.area.width / TICK_DISTANCE[0]).max(2.0);
        let ticks = Ticks::new(self.world.min.x, self.world.max.x, most);
        for &value in &ticks.values {
            let x = self.area.left + (value - self.world.min.x) * self.scale;
            sheet.line([x, bottom], [x, bottom + TICK_LENGTH], Style::line(INK, 1.2));
            let style = TextStyle::new(TICK_SIZE).anchor(Anchor::Middle);
            sheet.text([x, bottom + TICK_LENGTH + TICK_SIZE], &ticks.label(value), style);
        }
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
        sheet.text([self.area.left + 0.5 * self.area.width, bottom + 48.0], "x [m]", style);
    }

    fn draw_vertical_axis(&self, sheet: &mut Sheet) {
        let left = self.area.left;
        let most = (self.area.height / TICK_DISTANCE[1]).max(3.0);
        let ticks = Ticks::new(self.world.min.y, self.world.max.y, most);
        for &value in &ticks.values {
            let y = self.area.bottom() - (value - self.world.min.y) * self.scale;
            sheet.line([left - TICK_LENGTH, y], [left, y], Style::line(INK, 1.2));
            draw_left_number(sheet, [left, y], &ticks.label(value));
        }
        let widest = ticks.values.iter().map(|&value| text_width(&ticks.label(value), TICK_SIZE)).fold(0.0, f64::max);
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward();
        let x = left - (widest + 22.0).max(54.0);
        sheet.text([x, self.area.top + 0.5 * self.area.height], "y [m]", style);
    }
}

/// The number of a tick at the left side of a frame.
fn draw_left_number(sheet: &mut Sheet, [left, y]: Pixel, label: &str) {
    let style = TextStyle::new(TICK_SIZE).anchor(Anchor::End);
    sheet.text([left - TICK_LENGTH - 4.0, y + 0.36 * TICK_SIZE], label, style);
}

/// A pale line across a frame at a height, with its number at the left.
pub fn draw_level(sheet: &mut Sheet, frame: &Rect, y: f64, label: &str) {
    sheet.line([frame.left, y], [frame.right(), y], Style::line(PALE, 1.0));
    draw_left_number(sheet, [frame.left, y], label);
}

/// A pale upright line through a frame, with its number some way (px) below.
pub fn draw_upright(sheet: &mut Sheet, frame: &Rect, x: f64, label: &str, below: f64) {
    sheet.line([x, frame.top], [x, frame.bottom()], Style::line(PALE, 1.0));
    let style = TextStyle::new(TICK_SIZE).anchor(Anchor::Middle);
    sheet.text([x, frame.bottom() + below + TICK_SIZE], label, style);
}

/// Round values along an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Ticks {
    /// The round values, ascending.
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// About as many round values as `most` between `min` and `max`, never more; none if the two cannot be told apart.
    pub fn new(min: f64, max: f64, most: f64) -> Self {
        let step = round_above((max - min) / most);
        let (first, last) = ((min / step - 1e-9).ceil(), (max / step + 1e-9).floor());
        if !(step > 0.0 && step.is_finite() && last - first <= most + 1.0 && first.abs().max(last.abs()) < 1e12) {
            return Self { values: Vec::new(), decimals: 0 };
        }
        let values = (first as i64..=last as i64).map(|k| k as f64 * step).collect();
        Self { values, decimals: (-(libm::log10(step) + 1e-9).floor()).clamp(0.0, 12.0) as usize }
    }

    /// A value in as many decimals as the step needs.
    pub fn label(&self, value: f64) -> String {
        // Adding zero turns -0 into 0.
        with_minus(&format!("{:.*}", self.decimals, value + 0.0))
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `value`.
pub fn round_above(value: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(value).floor());
    [1.0, 2.0, 5.0]
        .map(|digit| digit * power)
        .into_iter()
        .find(|&round| round >= value * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// A number in four digits, for captions.
pub fn number_text(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        return with_minus(&format!("{}", value + 0.0));
    }
    let exponent = libm::log10(size).floor() as i32;
    if !(-4..7).contains(&exponent) {
        let mantissa = trimmed(format!("{:.3}", value / 10.0_f64.powi(exponent)));
        return with_minus(&format!("{mantissa} × 10{}", superscript(exponent)));
    }
    with_minus(&trimmed(format!("{value:.*}", (3 - exponent).max(0) as usize)))
}

/// A number in three digits, for readers: `94.6`, `1.44`, `2510`.
pub fn three_digits(value: f64) -> String {
    numbers::three_digits(value).unwrap_or_else(number_text)
}

/// A value in three digits with the prefix in which it reads well: `1.25 MPa`.
pub fn si_text(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 5] = [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m")];
    let fits = PREFIXES.into_iter().find(|(size, _)| value.abs() >= 0.9995 * size);
    let (size, prefix) = fits.filter(|_| value.is_finite()).unwrap_or((1.0, ""));
    let scaled = value / size;
    let decimals = 2 - libm::log10(scaled.abs().max(1.0)).floor().clamp(0.0, 2.0) as usize;
    with_minus(&format!("{} {prefix}{unit}", trimmed(format!("{:.decimals$}", scaled + 0.0))))
}

/// Without trailing zeros of a decimal fraction.
fn trimmed(number: String) -> String {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.').to_owned() } else { number }
}
