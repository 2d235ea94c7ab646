//! Orientations from the field: poles in a net over bands of their density, means of sets, strikes in a rosette.

use enmm_field::{Axis, CIRCLE, Fisher, density, plane_of, rosette};
use enmm_stability::kinematics::{Line, Plane};

use super::colour::{Colour, GREY, INK, LINES, PALE, SCALE_STEPS, WHITE, scale};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted, wrapped};
use super::{Picture, Projection};

/// Size of the sheet (px), centre and radius of the net.
const SIZE: [f64; 2] = [1180.0, 830.0];
const CENTRE: Pixel = [370.0, 415.0];
const RADIUS: f64 = 305.0;
/// Centre and radius of the rosette.
const ROSE: Pixel = [1010.0, 610.0];
const PETAL: f64 = 115.0;
/// Sectors of the rosette over half a turn: 10° each.
const SECTORS: usize = 18;
/// Cells of the net from its centre to its rim, and round it.
const RINGS: usize = 30;
const SPOKES: usize = 90;
/// Levels between the bands of density (% in a hundredth of the hemisphere); the first that fit are drawn.
const LEVELS: [f64; 12] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 50.0, 75.0];
/// Left edge of the list, its texts (px) and its rows at most.
const LIST: f64 = 740.0;
const TEXT: f64 = 16.0;
const SMALL: f64 = 13.5;
const ROWS: usize = 6;
/// Most letters of a label in the net.
const LABEL: usize = 6;
/// Pieces of a great circle.
const PIECES: u32 = 90;

/// A set in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldSet {
    /// Name.
    pub name: String,
    /// Mean and scatter.
    pub mean: Fisher,
    /// Trace in the section, in words; empty without a section.
    pub remark: String,
}

/// Poles of a table with their sets.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldNet {
    /// Title.
    pub title: String,
    /// Poles with their weights.
    pub poles: Vec<(Axis, f64)>,
    /// Set of each pole, if it is in one.
    pub of: Vec<Option<usize>>,
    /// Sets.
    pub sets: Vec<FieldSet>,
    /// Projection.
    pub projection: Projection,
    /// Lines below the list.
    pub notes: Vec<String>,
}

impl FieldNet {
    /// Draws the net, the list of sets and the rosette.
    pub fn picture(&self) -> Picture {
        let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
        sheet.text([30.0, 40.0], &fitted(&self.title, 24.0, SIZE[0] - 60.0), TextStyle::new(24.0));
        let circle = 100.0 * CIRCLE;
        let text = format!(
            "{} poles, {}; density by Fisher influence, % in a circle of {circle:.0} % of the hemisphere",
            self.poles.len(),
            self.projection.name()
        );
        sheet.text([30.0, 66.0], &text, TextStyle::new(SMALL).colour(GREY));
        self.bands(&mut sheet);
        self.rim(&mut sheet);
        self.marks(&mut sheet);
        self.list(&mut sheet);
        self.rose(&mut sheet);
        sheet.finish()
    }

    fn at(&self, axis: &Axis) -> Pixel {
        let [dip, direction] = plane_of(axis);
        let [x, y] = self.projection.place(&Plane { dip, direction }.pole());
        [CENTRE[0] + RADIUS * x, CENTRE[1] + RADIUS * y]
    }

    /// Bands of density, cell by cell from the centre to the rim, and the bar of their colours.
    fn bands(&self, sheet: &mut Sheet) {
        let node = |ring: usize, spoke: usize| {
            let line =
                Line { plunge: 90.0 * (1.0 - ring as f64 / RINGS as f64), trend: 360.0 * spoke as f64 / SPOKES as f64 };
            let [x, y] = self.projection.place(&line);
            let (sin, cos) = libm::sincos(line.trend.to_radians());
            let (down, flat) = libm::sincos(line.plunge.to_radians());
            let value = density(&self.poles, &[flat * sin, flat * cos, down]);
            ([CENTRE[0] + RADIUS * x, CENTRE[1] + RADIUS * y], value)
        };
        let nodes: Vec<Vec<(Pixel, f64)>> =
            (0..=RINGS).map(|ring| (0..SPOKES).map(|spoke| node(ring, spoke)).collect()).collect();
        let most = nodes.iter().flatten().map(|(_, value)| *value).fold(0.0, f64::max);
        let levels: Vec<f64> = LEVELS.into_iter().take_while(|level| *level < most).collect();
        for (band, &level) in levels.iter().enumerate() {
            let mut path = Path::default();
            for ring in 0..RINGS {
                for spoke in 0..SPOKES {
                    let next = (spoke + 1) % SPOKES;
                    let corners =
                        [nodes[ring][spoke], nodes[ring][next], nodes[ring + 1][next], nodes[ring + 1][spoke]];
                    // Cells above the next level are drawn with that.
                    if levels.get(band + 1).is_none_or(|next| corners.iter().any(|(_, value)| value < next)) {
                        let above = above(&corners, level);
                        if above.len() > 2 {
                            path.polygon(above);
                        }
                    }
                }
            }
            sheet.path(path, Style::fill(band_colour(band, levels.len())).crisp());
        }
        self.bar(sheet, &levels);
    }

    fn bar(&self, sheet: &mut Sheet, levels: &[f64]) {
        let (left, top, width) = (CENTRE[0] - RADIUS, SIZE[1] - 44.0, 46.0);
        for (band, level) in levels.iter().enumerate() {
            let place = Rect { left: left + width * band as f64, top, width, height: 12.0 };
            sheet.rect(&place, Style::fill(band_colour(band, levels.len())).crisp());
            sheet.text([place.left, top + 28.0], &format!("{level:.0}"), TextStyle::new(SMALL).anchor(Anchor::Middle));
        }
        let end = left + width * levels.len() as f64;
        sheet.text([end + 10.0, top + 12.0], "% and more", TextStyle::new(SMALL).colour(GREY));
    }

    /// Rim, ticks each 10° and points of the compass.
    fn rim(&self, sheet: &mut Sheet) {
        sheet.circle(CENTRE, RADIUS, Style::line(INK, 1.6));
        compass(sheet, CENTRE, RADIUS);
        for part in [[6.0, 0.0], [0.0, 6.0]] {
            let [a, b] = [-1.0, 1.0].map(|sign| [0, 1].map(|axis| CENTRE[axis] + sign * part[axis]));
            sheet.line(a, b, Style::line(PALE, 1.2));
        }
    }

    /// Poles in the colours of their sets; great circle and mean pole of each set.
    fn marks(&self, sheet: &mut Sheet) {
        let radius = if self.poles.len() > 400 { 1.8 } else { 2.8 };
        for ((pole, _), of) in self.poles.iter().zip(&self.of) {
            let colour = of.map_or(GREY, colour);
            sheet.circle(self.at(pole), radius, Style::fill(colour).edged(WHITE, 0.6));
        }
        for (k, set) in self.sets.iter().enumerate() {
            let [dip, direction] = plane_of(&set.mean.mean);
            let lines = Plane { dip, direction }.lines(PIECES);
            let places = lines.iter().map(|line| {
                let [x, y] = self.projection.place(line);
                [CENTRE[0] + RADIUS * x, CENTRE[1] + RADIUS * y]
            });
            sheet.path(Path::open(places), Style::line(colour(k), 2.0));
            let [x, y] = self.at(&set.mean.mean);
            let square = Rect { left: x - 6.0, top: y - 6.0, width: 12.0, height: 12.0 };
            sheet.rect(&square, Style::fill(colour(k)).edged(WHITE, 2.0));
        }
        for (k, set) in self.sets.iter().enumerate() {
            let [x, y] = self.at(&set.mean.mean);
            let name: String = set.name.chars().take(LABEL).collect();
            sheet.text([x + 11.0, y + 5.0], &name, TextStyle::new(TEXT).colour(colour(k)).halo());
        }
    }

    /// Sets with mean, number, scatter and confidence.
    fn list(&self, sheet: &mut Sheet) {
        let mut y = 112.0;
        let room = SIZE[0] - LIST - 20.0;
        let mut say = |sheet: &mut Sheet, text: &str, style: TextStyle, size: f64, step: f64| {
            sheet.text([LIST, y], &fitted(text, size, room), style);
            y += step;
        };
        for (k, set) in self.sets.iter().enumerate().take(ROWS) {
            let [dip, direction] = plane_of(&set.mean.mean);
            let Fisher { count, kappa, cone_deg, .. } = set.mean;
            let text = format!("{}  {dip:.1}°/{direction:05.1}°  n {count}", set.name);
            say(sheet, &text, TextStyle::new(TEXT).colour(colour(k)), TEXT, 18.0);
            let text = format!("κ {kappa:.1}; mean ± {cone_deg:.1}° (95 %)");
            say(
                sheet,
                &text,
                TextStyle::new(SMALL).colour(GREY),
                SMALL,
                if set.remark.is_empty() { 22.0 } else { 16.0 },
            );
            if !set.remark.is_empty() {
                say(sheet, &set.remark, TextStyle::new(SMALL).colour(GREY), SMALL, 22.0);
            }
        }
        if self.sets.len() > ROWS {
            let text = format!("and {} more", self.sets.len() - ROWS);
            say(sheet, &text, TextStyle::new(SMALL).colour(GREY), SMALL, 22.0);
        }
        for line in self.notes.iter().flat_map(|note| wrapped(note, SMALL, room)) {
            say(sheet, &line, TextStyle::new(SMALL).colour(GREY), SMALL, 17.0);
        }
    }

    /// Strikes in sectors, both ways; lengths are shares.
    fn rose(&self, sheet: &mut Sheet) {
        let shares = rosette(&self.poles, SECTORS);
        let most = shares.iter().copied().fold(0.0, f64::max);
        sheet.circle(ROSE, PETAL, Style::line(PALE, 1.2));
        sheet.circle(ROSE, 0.5 * PETAL, Style::line(PALE, 1.0));
        compass(sheet, ROSE, PETAL);
        let step = 180.0 / SECTORS as f64;
        let place = |azimuth: f64, share: f64| {
            let (sin, cos) = libm::sincos(azimuth.to_radians());
            let radius = PETAL * share / most;
            [ROSE[0] + radius * sin, ROSE[1] - radius * cos]
        };
        for (k, &share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            for turn in [0.0, 180.0] {
                let from = turn + step * k as f64;
                let petal = [ROSE, place(from, share), place(from + 0.5 * step, share), place(from + step, share)];
                sheet.path(Path::closed(petal), Style::fill(LINES[0]).edged(WHITE, 0.8).opacity(0.75));
            }
        }
        let text = format!("strikes in 10°; rim {:.1} %", 100.0 * most);
        let style = TextStyle::new(SMALL).anchor(Anchor::Middle).colour(GREY);
        sheet.text([ROSE[0], ROSE[1] + PETAL + 56.0], &text, style);
    }
}

/// Ticks each 10° at a rim and the points of the compass.
fn compass(sheet: &mut Sheet, [x, y]: Pixel, radius: f64) {
    for trend in (0..360).step_by(10) {
        let (sin, cos) = libm::sincos(f64::from(trend).to_radians());
        let out = radius + if trend % 90 == 0 { 9.0 } else { 5.0 };
        sheet.line([x + radius * sin, y - radius * cos], [x + out * sin, y - out * cos], Style::line(INK, 1.1));
    }
    for (trend, name, off) in [(0.0, "N", 0.0), (90.0, "E", 6.0), (180.0, "S", 13.0), (270.0, "W", 6.0)] {
        let (sin, cos) = libm::sincos(f64::to_radians(trend));
        let out = radius + 17.0;
        sheet.text([x + out * sin, y - out * cos + off], name, TextStyle::new(TEXT).anchor(Anchor::Middle));
    }
}

/// The part of a cell with values at its corners that is not below a level.
fn above(corners: &[(Pixel, f64); 4], level: f64) -> Vec<Pixel> {
    let mut above = Vec::new();
    for (k, (place, value)) in corners.iter().enumerate() {
        let (next, after) = corners[(k + 1) % 4];
        if *value >= level {
            above.push(*place);
        }
        if (*value >= level) != (after >= level) {
            let share = (level - value) / (after - value);
            above.push([0, 1].map(|axis| place[axis] + (next[axis] - place[axis]) * share));
        }
    }
    above
}

/// Colours from light to dark, so that poles stay visible in most of the net.
fn band_colour(band: usize, count: usize) -> Colour {
    scale(SCALE_STEPS - 1 - (SCALE_STEPS - 1) * band / count.max(1))
}

fn colour(set: usize) -> Colour {
    LINES[set % LINES.len()]
}
