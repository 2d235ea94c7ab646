//! Lines of points as inclinometers are drawn: displacement across and along each line against the distance from its
//! first point, which is on top; a curve for each stage so far.

use super::Picture;
use super::axes::{LABEL_SIZE, Ticks, draw_level, draw_upright};
use super::colour::{GREY, INK, LINES};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted};
use super::slope::{LEFT, MARGIN, WIDTH, draw_title};

/// Top (px) of the first row of frames.
const FIRST: f64 = 150.0;
/// Height (px) of a frame, and of what stands above and below it.
const FRAME: [f64; 2] = [420.0, 150.0];
/// Room (px) at the right of the frames for the names of the stages.
const LEGEND_ROOM: f64 = 260.0;
/// Distance (px) of the two frames of a line.
const BETWEEN: f64 = 96.0;
/// Distance (px) of the ticks that is aimed at.
const TICK_DISTANCE: [f64; 2] = [74.0, 44.0];
/// Height (px) of a line of the legend.
const LINE_HEIGHT: f64 = 26.0;
/// Most lines of a picture.
const LINES_MAX: usize = 6;
/// Displacements (m) below this are in millimetres.
const MILLIMETRES: f64 = 1.0;
/// Share of the largest value that stays free beside it.
const FREE: f64 = 0.08;

/// A line with what its points have moved.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LineProfile {
    /// Name of the line.
    pub name: String,
    /// A curve for each stage, the last one last.
    pub curves: Vec<ProfileCurve>,
}

/// A line at the end of a stage.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ProfileCurve {
    /// Name of the stage.
    pub stage: String,
    /// Distance from the first point (m), and displacement across and along the line (m), of each point; one that is
    /// not finite is left out.
    pub points: Vec<[f64; 3]>,
}

/// Draws lines: each has a frame for the displacement across it and one for that along it.
pub fn lines_picture(title: &str, caption: &str, lines: &[LineProfile]) -> Picture {
    let shown = &lines[..lines.len().min(LINES_MAX)];
    let mut sheet = Sheet::new(WIDTH, FIRST + shown.len() as f64 * (FRAME[0] + FRAME[1]));
    draw_title(&mut sheet, title, caption);
    if shown.len() < lines.len() {
        let more = format!("the first {} of {} lines; all are in lines.csv", shown.len(), lines.len());
        sheet.text([LEFT, FIRST - 46.0], &more, TextStyle::new(LABEL_SIZE).colour(GREY));
    }
    let width = 0.5 * (WIDTH - LEFT - LEGEND_ROOM - BETWEEN);
    for (k, line) in shown.iter().enumerate() {
        let top = FIRST + k as f64 * (FRAME[0] + FRAME[1]);
        let style = TextStyle::new(LABEL_SIZE);
        sheet.text([LEFT, top - 16.0], &fitted(&line.name, LABEL_SIZE, WIDTH - LEFT - MARGIN), style);
        for (part, name) in ["across", "along"].into_iter().enumerate() {
            let left = LEFT + part as f64 * (width + BETWEEN);
            let frame = Rect { left, top, width, height: FRAME[0] };
            draw_frame(&mut sheet, &frame, line, part, name);
        }
        draw_legend(&mut sheet, line, [LEFT + 2.0 * width + BETWEEN + 22.0, top]);
    }
    sheet.finish()
}

/// Least and greatest value, zero among them.
fn interval(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    finite.fold([0.0, 0.0], |[least, most], value| [f64::min(least, value), f64::max(most, value)])
}

/// One displacement of a line: the first or the second one of its points.
fn draw_frame(sheet: &mut Sheet, frame: &Rect, line: &LineProfile, part: usize, name: &str) {
    let points = || line.curves.iter().flat_map(|curve| &curve.points);
    let [_, length] = interval(points().map(|point| point[0]));
    let [least, most] = interval(points().map(|point| point[1 + part]));
    let is_small = least.abs().max(most) < MILLIMETRES;
    let (unit, scale) = if is_small { ("mm", 1e3) } else { ("m", 1.0) };
    let span = if most > least { most - least } else { 1.0 / scale };
    let (from, to) = ((least - FREE * span) * scale, (most + FREE * span) * scale);
    let length = if length > 0.0 { length } else { 1.0 };
    let x = |value: f64| frame.left + (value - from) / (to - from) * frame.width;
    let y = |distance: f64| frame.top + distance / length * frame.height;
    let ticks = Ticks::new(from, to, frame.width / TICK_DISTANCE[0]);
    ticks.values.iter().for_each(|&value| draw_upright(sheet, frame, x(value), &ticks.label(value), 4.0));
    let ticks = Ticks::new(0.0, length, frame.height / TICK_DISTANCE[1]);
    ticks.values.iter().for_each(|&value| draw_level(sheet, frame, y(value), &ticks.label(value)));
    sheet.line([x(0.0), frame.top], [x(0.0), frame.bottom()], Style::line(GREY, 1.6));
    for (k, curve) in line.curves.iter().enumerate() {
        let is_there = |point: &[f64; 3]| point[1 + part].is_finite();
        let mut path = Path::default();
        for run in curve.points.split(|point| !is_there(point)).filter(|run| !run.is_empty()) {
            path.line(run.iter().map(|point| [x(point[1 + part] * scale), y(point[0])]));
        }
        sheet.path(path, style(k));
    }
    sheet.rect(frame, Style::line(INK, 1.2));
    let named = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    sheet.text([frame.middle()[0], frame.bottom() + 48.0], &format!("displacement {name} the line [{unit}]"), named);
    if part == 0 {
        let [_, middle] = frame.middle();
        sheet.text([frame.left - 76.0, middle], "distance from the first point [m]", named.upward());
    }
}

/// Names of the stages of a line.
fn draw_legend(sheet: &mut Sheet, line: &LineProfile, [left, top]: Pixel) {
    let room = (FRAME[0] / LINE_HEIGHT) as usize;
    let first = line.curves.len().saturating_sub(room);
    for (row, (k, curve)) in line.curves.iter().enumerate().skip(first).enumerate() {
        let y = top + LINE_HEIGHT * (row as f64 + 0.6);
        sheet.line([left, y], [left + 32.0, y], style(k));
        let name = fitted(&curve.stage, LABEL_SIZE, WIDTH - MARGIN - left - 44.0);
        sheet.text([left + 44.0, y + 6.0], &name, TextStyle::new(LABEL_SIZE));
    }
}

/// Every second curve is broken, so that neighbours differ without colour.
fn style(k: usize) -> Style {
    let style = Style::line(LINES[k % LINES.len()], 2.4);
    if k % 2 == 1 { style.dashed() } else { style }
}
