//! A stereonet: great circles of joint sets, the face, the friction circle, and what the kinematic checks find.

use enmm_stability::kinematics::{Failures, Joints, Limits, Line, Plane, azimuth, failures};

use super::Picture;
use super::colour::{ACCENT, Colour, GREY, INK, LINES, PALE, SLIP};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle};

/// Size of the sheet (px), and centre and radius of the net on it.
const SIZE: [f64; 2] = [1180.0, 760.0];
const CENTRE: Pixel = [380.0, 410.0];
const RADIUS: f64 = 310.0;
/// Pieces of a great circle.
const PIECES: u32 = 90;
/// Left edge of the list beside the net.
const LIST: f64 = 740.0;
/// Texts of the list (px).
const TEXT: f64 = 17.0;
const SMALL: f64 = 14.0;
const ROW: f64 = 24.0;
/// Longest name (signs) that stands beside marks.
const LABEL: usize = 4;
/// Most sets in the list.
const LISTED: usize = 14;

/// How directions in space become places in the net; both show the lower hemisphere.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Projection {
    /// Equal areas stay equal (Schmidt).
    #[default]
    EqualArea,
    /// Angles between great circles are kept (Wulff).
    EqualAngle,
}

/// A net to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Stereonet {
    /// Title of the case.
    pub title: String,
    /// The face.
    pub face: Plane,
    /// Sets, each with what to say of it beside its plane.
    pub sets: Vec<Joints>,
    /// Second line of each set in the list.
    pub remarks: Vec<String>,
    /// Limits of the checks.
    pub limits: Limits,
    /// Projection.
    pub projection: Projection,
    /// Lines below the list.
    pub notes: Vec<String>,
}

impl Projection {
    /// Place of a line in a net of radius 1, x to the east and y to the south.
    pub fn place(self, line: &Line) -> Pixel {
        // Angle from the vertical.
        let off = (90.0 - line.plunge).to_radians();
        let radius = match self {
            Self::EqualArea => std::f64::consts::SQRT_2 * libm::sin(off / 2.0),
            Self::EqualAngle => libm::tan(off / 2.0),
        };
        let (sin, cos) = libm::sincos(line.trend.to_radians());
        [radius * sin, -radius * cos]
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::EqualArea => "equal area (Schmidt), lower hemisphere",
            Self::EqualAngle => "equal angle (Wulff), lower hemisphere",
        }
    }
}

impl Stereonet {
    /// The checks of the sets against the face.
    pub fn failures(&self) -> Failures {
        failures(&self.face, &self.sets, self.limits)
    }

    /// The least friction angle of the sets (degrees), that of the circle.
    pub fn friction(&self) -> Option<f64> {
        self.sets.iter().map(|set| set.friction).min_by(f64::total_cmp)
    }

    fn at(&self, line: &Line) -> Pixel {
        let [x, y] = self.projection.place(line);
        [CENTRE[0] + RADIUS * x, CENTRE[1] + RADIUS * y]
    }

    /// Draws the net.
    pub fn picture(&self) -> Picture {
        let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
        let found = self.failures();
        sheet.text([30.0, 40.0], &self.title, TextStyle::new(24.0));
        sheet.text([30.0, 66.0], self.projection.name(), TextStyle::new(SMALL).colour(GREY));
        self.net(&mut sheet);
        self.zone(&mut sheet);
        self.planes(&mut sheet, &found);
        self.wedges(&mut sheet, &found);
        self.list(&mut sheet, &found);
        sheet.finish()
    }

    /// Rim, ticks each 10° and points of the compass.
    fn net(&self, sheet: &mut Sheet) {
        sheet.circle(CENTRE, RADIUS, Style::line(INK, 1.6));
        for trend in (0..360).step_by(10) {
            let [x, y] = self.at(&Line { plunge: 0.0, trend: f64::from(trend) });
            let out = [x - CENTRE[0], y - CENTRE[1]].map(|part| part * if trend % 90 == 0 { 1.03 } else { 1.015 });
            sheet.line([x, y], [CENTRE[0] + out[0], CENTRE[1] + out[1]], Style::line(INK, 1.2));
        }
        for (trend, name, off) in [(0.0, "N", 0.0), (90.0, "E", 6.0), (180.0, "S", 18.0), (270.0, "W", 6.0)] {
            let (sin, cos) = libm::sincos(f64::to_radians(trend));
            let at = [CENTRE[0] + 1.06 * RADIUS * sin, CENTRE[1] - 1.045 * RADIUS * cos + off];
            sheet.text(at, name, TextStyle::new(TEXT).anchor(Anchor::Middle));
        }
        sheet.line([CENTRE[0] - 5.0, CENTRE[1]], [CENTRE[0] + 5.0, CENTRE[1]], Style::line(PALE, 1.2));
        sheet.line([CENTRE[0], CENTRE[1] - 5.0], [CENTRE[0], CENTRE[1] + 5.0], Style::line(PALE, 1.2));
    }

    /// The face, the friction circle and what lies between: there dip lines and lines of wedges slide.
    fn zone(&self, sheet: &mut Sheet) {
        let face = self.face.lines(PIECES);
        if let Some(friction) = self.friction().filter(|friction| *friction < self.face.dip) {
            let inner: Vec<&Line> = face.iter().filter(|line| line.plunge >= friction).collect();
            let mut outline: Vec<Pixel> = inner.iter().map(|line| self.at(line)).collect();
            if let ([first, .., last], Some(_)) = (&inner[..], outline.first()) {
                let turn = azimuth(first.trend - last.trend + 180.0) - 180.0;
                let back = (0..=PIECES).map(|k| last.trend + turn * f64::from(k) / f64::from(PIECES));
                outline.extend(back.map(|trend| self.at(&Line { plunge: friction, trend })));
            }
            sheet.path(Path::closed(outline), Style::fill(SLIP).opacity(0.16));
        }
        if let Some(friction) = self.friction() {
            let round = (0..=4 * PIECES).map(|k| f64::from(k) * 90.0 / f64::from(PIECES));
            let circle = round.map(|trend| self.at(&Line { plunge: friction, trend }));
            sheet.path(Path::open(circle), Style::line(SLIP, 1.6).dashed());
            let at = self.at(&Line { plunge: friction, trend: azimuth(self.face.direction + 180.0) });
            let text = format!("friction {friction:.0}°");
            sheet.text([at[0], at[1] - 6.0], &text, TextStyle::new(SMALL).anchor(Anchor::Middle).colour(SLIP).halo());
        }
        self.great_circle(sheet, &self.face, Style::line(INK, 3.4));
        let at = self.at(&self.face.dip_line());
        sheet.text([at[0] + 8.0, at[1] - 8.0], "face", TextStyle::new(TEXT).halo());
    }

    fn great_circle(&self, sheet: &mut Sheet, plane: &Plane, style: Style) {
        sheet.path(Path::open(plane.lines(PIECES).iter().map(|line| self.at(line))), style);
    }

    /// Great circle, dip line and pole of each set.
    fn planes(&self, sheet: &mut Sheet, found: &Failures) {
        for (k, set) in self.sets.iter().enumerate() {
            let colour = colour(k);
            self.great_circle(sheet, &set.plane, Style::line(colour, 2.0));
            let (dip, pole) = (self.at(&set.plane.dip_line()), self.at(&set.plane.pole()));
            let mark = |fails: bool| if fails { Style::fill(colour).edged(ACCENT, 3.0) } else { Style::fill(colour) };
            sheet.circle(dip, 5.0, mark(found.planes.contains(&k)));
            let square = Rect { left: pole[0] - 5.0, top: pole[1] - 5.0, width: 10.0, height: 10.0 };
            sheet.rect(&square, mark(found.toppling.contains(&k)));
            let name = self.label(k);
            sheet.text([dip[0] + 9.0, dip[1] + 5.0], &name, TextStyle::new(SMALL).colour(colour).halo());
            sheet.text([pole[0] + 9.0, pole[1] + 5.0], &name, TextStyle::new(SMALL).colour(colour).halo());
        }
    }

    fn wedges(&self, sheet: &mut Sheet, found: &Failures) {
        for (.., line) in &found.wedges {
            let [x, y] = self.at(line);
            let corners = [[x, y - 8.0], [x + 7.0, y + 5.0], [x - 7.0, y + 5.0]];
            sheet.path(Path::closed(corners), Style::fill(ACCENT));
        }
        for (a, b, line) in &found.wedges {
            let [x, y] = self.at(line);
            let name = format!("{}+{}", self.label(*a), self.label(*b));
            sheet.text([x + 10.0, y - 6.0], &name, TextStyle::new(SMALL).colour(ACCENT).halo());
        }
    }

    /// Label beside the marks of a set: its name where that is short, else its number in the list.
    fn label(&self, set: usize) -> String {
        let name = &self.sets[set].name;
        if name.chars().count() <= LABEL { name.clone() } else { (set + 1).to_string() }
    }

    /// Sets with their labels, and what the checks find.
    fn list(&self, sheet: &mut Sheet, found: &Failures) {
        let mut y = 110.0;
        let mut say = |sheet: &mut Sheet, text: &str, style: TextStyle, step: f64| {
            sheet.text([LIST, y], text, style);
            y += step;
        };
        let Plane { dip, direction } = self.face;
        say(sheet, &format!("face {dip:.0}°/{direction:03.0}°"), TextStyle::new(TEXT), 1.4 * ROW);
        for (k, (set, remark)) in self.sets.iter().zip(&self.remarks).enumerate().take(LISTED) {
            let Plane { dip, direction } = set.plane;
            let label = self.label(k);
            let name = if label == set.name { label } else { format!("{label}  {}", set.name) };
            let text = format!("{name}  {dip:.0}°/{direction:03.0}°  φ {:.0}°", set.friction);
            say(sheet, &text, TextStyle::new(TEXT).colour(colour(k)), 18.0);
            say(sheet, remark, TextStyle::new(SMALL).colour(GREY), ROW);
        }
        if self.sets.len() > LISTED {
            say(sheet, &format!("and {} more", self.sets.len() - LISTED), TextStyle::new(SMALL).colour(GREY), ROW);
        }
        for line in self.findings(found) {
            let colour = if line.ends_with(NONE) { INK } else { ACCENT };
            for (k, part) in wrapped(&line).iter().enumerate() {
                let size = if k == 0 { TEXT } else { SMALL };
                say(sheet, part, TextStyle::new(size).colour(colour), if k == 0 { ROW } else { 18.0 });
            }
        }
        say(sheet, LEGEND, TextStyle::new(SMALL).colour(GREY), 18.0);
        for line in &self.notes {
            say(sheet, line, TextStyle::new(SMALL).colour(GREY), 18.0);
        }
    }

    /// One line for each kind of failure.
    pub fn findings(&self, found: &Failures) -> Vec<String> {
        let names = |all: Vec<String>| if all.is_empty() { NONE.to_owned() } else { all.join(", ") };
        let of = |sets: &[usize]| names(sets.iter().map(|k| self.sets[*k].name.clone()).collect());
        let wedge = |(a, b, line): &(usize, usize, Line)| {
            let (first, second) = (&self.sets[*a].name, &self.sets[*b].name);
            format!("{first} + {second} (plunge {:.0}°, trend {:03.0}°)", line.plunge, line.trend)
        };
        vec![
            format!("plane failure: {}", of(&found.planes)),
            format!("wedge failure: {}", names(found.wedges.iter().map(wedge).collect())),
            format!("toppling: {}", of(&found.toppling)),
        ]
    }
}

/// A line of findings in lines that fit the list: the first of its names, then the others.
fn wrapped(line: &str) -> Vec<String> {
    let mut parts: Vec<String> = line.split("), ").map(str::to_owned).collect();
    let last = parts.len() - 1;
    parts[..last].iter_mut().for_each(|part| part.push(')'));
    if last == 0 {
        return parts;
    }
    if parts.len() > WEDGES {
        let more = parts.len() - WEDGES;
        parts.truncate(WEDGES);
        parts.push(format!("and {more} more"));
    }
    let (head, first) = parts[0]
        .split_once(": ")
        .map_or((String::new(), parts[0].clone()), |(head, first)| (format!("{head}:"), first.to_owned()));
    parts[0] = first;
    parts.insert(0, head);
    parts
}

/// Most wedges of the list.
const WEDGES: usize = 8;
/// Meaning of the marks.
const LEGEND: &str = "dots: dip lines, squares: poles, triangles: wedges; red: fails";
/// Word for no failure.
const NONE: &str = "none";

fn colour(set: usize) -> Colour {
    LINES[set % LINES.len()]
}
