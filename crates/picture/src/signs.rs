//! Signs of the engineer: supports, arrows, bolts, water, monitors, crosses of principal stress. They know pixels only.

use super::colour::{ACCENT, Colour, INK, SLIP, WATER, WHITE};
use super::sheet::{Path, Pixel, Sheet, Style};

/// Width (px) of the two lines of an open joint.
pub const OPEN_WIDTH: f64 = 5.0;
/// Ink of boundaries that let waves leave.
pub const QUIET: Colour = Colour(0, 114, 178);

/// How a part of the rock is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Held {
    /// Along both axes.
    Pinned,
    /// Along one axis; free along the other.
    Roller,
    /// By springs at rest, by dashpots when waves leave.
    Quiet,
    /// By dashpots to a column of rock beside the model.
    FreeField,
}

/// Draws a sign whose tip touches the rock at `tip`, on its outer side along the unit vector `out` (px, y down).
pub fn draw_held(sheet: &mut Sheet, held: Held, tip: Pixel, out: [f64; 2]) {
    let side = [-out[1], out[0]];
    // `along` the outer side, `away` from the rock.
    let at = |along: f64, away: f64| [0, 1].map(|k| tip[k] + along * side[k] + away * out[k]);
    let is_fixity = matches!(held, Held::Pinned | Held::Roller);
    let ink = if is_fixity { Style::line(INK, 1.3) } else { Style::line(QUIET, 1.7) };
    let (mut solid, mut lines) = (Path::default(), Path::default());
    match held {
        Held::Pinned => {
            solid.polygon([tip, at(-6.0, 10.0), at(6.0, 10.0)]);
            lines.line([at(-9.0, 10.0), at(9.0, 10.0)]);
            [-6.0, 0.0, 6.0].into_iter().for_each(|x| lines.line([at(x, 10.0), at(x - 4.0, 14.0)]));
        }
        Held::Roller => {
            solid.polygon([tip, at(-6.0, 9.0), at(6.0, 9.0)]);
            lines.line([at(-9.0, 14.5), at(9.0, 14.5)]);
            for x in [-3.5, 3.5] {
                sheet.circle(at(x, 11.8), 2.4, Style::fill(WHITE).edged(INK, 1.1));
            }
        }
        Held::Quiet => {
            lines.line([tip, at(0.0, 8.0)]);
            lines.line([at(-4.0, 8.0), at(4.0, 8.0)]);
            lines.line([at(-6.0, 4.5), at(-6.0, 12.0), at(6.0, 12.0), at(6.0, 4.5)]);
            lines.line([at(0.0, 12.0), at(0.0, 16.0)]);
        }
        Held::FreeField => {
            lines.line([at(-13.0, 14.0), at(13.0, 14.0)]);
            lines.line([at(-13.0, 19.0), at(13.0, 19.0)]);
            lines.line([tip, at(0.0, 5.0)]);
            lines.line([at(-4.0, 3.0), at(-4.0, 8.0), at(4.0, 8.0), at(4.0, 3.0)]);
            lines.line([at(0.0, 8.0), at(0.0, 14.0)]);
        }
    }
    sheet.path(solid, Style::fill(WHITE).edged(INK, 1.3));
    sheet.path(lines, ink);
}

/// Draws an arrow with its head at `to`.
pub fn draw_arrow(sheet: &mut Sheet, from: Pixel, to: Pixel, style: Style) {
    let mut path = Path::default();
    push_arrow(&mut path, from, to, 8.0);
    sheet.path(path, style);
}

/// Adds an arrow with its head, at most `head` px long, at `to`.
pub fn push_arrow(path: &mut Path, from: Pixel, to: Pixel, head: f64) {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = libm::hypot(way[0], way[1]);
    if length > 0.5 {
        let head = head.min(0.6 * length);
        let unit = way.map(|part| part / length);
        let barb = |sign: f64| {
            [
                to[0] - head * unit[0] - sign * 0.45 * head * unit[1],
                to[1] - head * unit[1] + sign * 0.45 * head * unit[0],
            ]
        };
        path.line([from, to]);
        path.line([barb(1.0), to, barb(-1.0)]);
    }
}

/// Draws an arrow round a point, counter-clockwise or clockwise.
pub fn draw_moment(sheet: &mut Sheet, centre: Pixel, counter_clockwise: bool, style: Style) {
    let turn = if counter_clockwise { -1.0 } else { 1.0 };
    let at = |k: i32| {
        let angle = turn * f64::from(k) * 15f64.to_radians();
        [centre[0] + 16.0 * libm::cos(angle), centre[1] + 16.0 * libm::sin(angle)]
    };
    let mut path = Path::open((0..=17).map(at));
    push_arrow(&mut path, at(17), at(19), 8.0);
    sheet.path(path, style);
}

/// Draws a bolt with a plate at its head, the first end.
pub fn draw_bolt(sheet: &mut Sheet, [[x, y], [u, v]]: [Pixel; 2], style: Style) {
    let length = libm::hypot(u - x, v - y).max(f64::MIN_POSITIVE);
    let plate = [5.0 * (v - y) / length, -5.0 * (u - x) / length];
    let mut path = Path::open([[x, y], [u, v]]);
    path.line([[x + plate[0], y + plate[1]], [x - plate[0], y - plate[1]]]);
    sheet.path(path, style);
}

/// Draws the triangle that stands on the surface of water.
pub fn draw_water_mark(sheet: &mut Sheet, [x, y]: Pixel) {
    let corners = [[x, y - 1.0], [x - 6.0, y - 11.0], [x + 6.0, y - 11.0]];
    sheet.path(Path::closed(corners), Style::fill(WHITE).edged(WATER, 1.8));
}

/// Draws the triangle of an outcrop through which water seeps out of the rock.
pub fn draw_seep(sheet: &mut Sheet, [x, y]: Pixel) {
    let corners = [[x, y - 7.0], [x + 6.0, y + 4.0], [x - 6.0, y + 4.0]];
    sheet.path(Path::closed(corners), Style::fill(WATER).edged(INK, 1.2));
}

/// Draws the mark of a monitor.
pub fn draw_monitor(sheet: &mut Sheet, position: Pixel) {
    sheet.circle(position, 6.0, Style::fill(WHITE).edged(ACCENT, 2.2));
    sheet.circle(position, 2.0, Style::fill(ACCENT));
}

/// Draws the mark of a port.
pub fn draw_port(sheet: &mut Sheet, [x, y]: Pixel) {
    let corners = [[x, y - 8.0], [x + 8.0, y], [x, y + 8.0], [x - 8.0, y]];
    sheet.path(Path::closed(corners), Style::fill(WHITE).edged(ACCENT, 2.2));
}

/// Draws two principal stresses as lines through `centre`: half of each is `half` (px); tension has heads that point
/// outwards.
pub fn draw_cross(sheet: &mut Sheet, centre: Pixel, half: [[f64; 2]; 2], tension: [bool; 2]) {
    for ([x, y], tension) in half.into_iter().zip(tension) {
        let ends = [[centre[0] - x, centre[1] - y], [centre[0] + x, centre[1] + y]];
        let mut path = Path::default();
        if tension {
            push_arrow(&mut path, centre, ends[0], 6.0);
            push_arrow(&mut path, centre, ends[1], 6.0);
        } else {
            path.line(ends);
        }
        sheet.path(path, Style::line(if tension { SLIP } else { INK }, 1.5));
    }
}
