//! Pictures of the end of a stage: displacement since its start, velocity, principal stresses, joints.

use std::collections::BTreeMap;

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, Ticks, View, is_drawable, number_text, si_text, three_digits};
use super::bar::{BAR_ROOM, draw_bar};
use super::colour::{BRIDGE, BROKEN, GREY, INK, LOCK, PALE, ROCK, SCALE_STEPS, SLIP, WHITE, scale, scale_step};
use super::displacement::draw_length;
use super::legend::{self, Entry, Legend, Sign};
use super::model::{BoltMark, draw_tensions, draw_water};
use super::sheet::{Path, Pixel, Rect, Sheet, Style, TextStyle};
use super::signs::{OPEN_WIDTH, draw_cross, push_arrow};
use super::slope::{
    BELOW_FRAME, LEFT, MARGIN, TOP, WIDTH, block_outlines, corners, draw_absence, draw_block_outlines, draw_filled,
    draw_title,
};
use enmm::geometry::{Point, Vector};
use enmm_observe::{BoltCondition, BondState, ContactState, JointPiece, Snapshot, stress};

/// Width (px) of rock bridges.
const BRIDGE_WIDTH: f64 = 5.6;
/// Height (px) of the frame at most.
const HEIGHT_MAX: f64 = 780.0;
/// Height (px) of the notes at the bottom.
const NOTES: f64 = 60.0;
/// Distance (px) of arrows, and length of the longest.
const ARROWS: [f64; 2] = [46.0, 40.0];
/// Distance (px) of crosses, and length of the longest arm.
const CROSSES: [f64; 2] = [34.0, 15.0];
/// Arms and arrows shorter than this (px) are left out.
const SHORTEST: f64 = 2.5;
/// Share of the largest value below which three quarters of the slope must stay for a logarithmic scale.
pub const FEW: f64 = 0.03;
/// Decades of a logarithmic scale.
const DECADES: f64 = 3.0;
/// Share of the values that lie below the upper end of a scale of stress: corners carry a few that are far larger.
pub const MOST: f64 = 0.98;

/// Common data of the pictures of a stage.
#[derive(Debug, Clone)]
pub struct StageEnd<'a> {
    /// Title of the case.
    pub title: &'a str,
    /// Stage and time.
    pub caption: String,
    /// The slope at the end of the stage.
    pub snapshot: &'a Snapshot,
    /// Bolts with their forces.
    pub bolts: &'a [BoltMark],
    /// Surface of the water (m); empty without water.
    pub water: &'a [Point],
}

/// Draws the displacement (m) of each point of the elements since the start of the stage: colours and arrows.
pub fn stage_displacement_picture(stage: &StageEnd, since: &[Vector]) -> Picture {
    let units = [("m", 1.0, 0.1), ("mm", 1e-3, 1e-4), ("µm", 1e-6, 0.0)];
    vectors_picture(stage, "displacement since the start of the stage", "displacement", since, &units)
}

/// Draws the velocity of each point of the elements: colours and arrows.
pub fn velocity_picture(stage: &StageEnd) -> Picture {
    let units = [("m/s", 1.0, 0.1), ("mm/s", 1e-3, 0.0)];
    vectors_picture(stage, "velocity", "velocity", &stage.snapshot.velocity, &units)
}

/// Draws the greatest compression of each element as a colour, and crosses of the principal stresses.
pub fn stress_picture(stage: &StageEnd) -> Picture {
    let principal: Vec<Principal> = stage.snapshot.stress.iter().map(Principal::of).collect();
    let compression: Vec<f64> = principal.iter().map(|p| -p.values[1]).collect();
    let range = [quantile(&compression, 1.0 - MOST), quantile(&compression, MOST)];
    let mut sheet = StageSheet::new(stage, BAR_ROOM, "principal stresses");
    let span = (range[1] - range[0]).max(f64::MIN_POSITIVE);
    sheet.fill(|k| scale_step((compression.get(k).copied().unwrap_or(0.0) - range[0]) / span));
    sheet.draw_outlines();
    let sizes: Vec<f64> = principal.iter().map(|p| p.values[0].abs().max(p.values[1].abs())).collect();
    let longest = quantile(&sizes, MOST).max(f64::MIN_POSITIVE);
    let view = sheet.view;
    for (centre, k) in samples(stage.snapshot, &view, CROSSES[0]) {
        let Some(Principal { values, direction }) = principal.get(k) else { continue };
        let length = |value: f64| CROSSES[1] * (value.abs() / longest).min(1.4);
        let [x, y] = [direction.x, -direction.y];
        let arms = [[x * length(values[0]), y * length(values[0])], [y * length(values[1]), -x * length(values[1])]];
        if values.iter().any(|&value| length(value) >= SHORTEST) {
            draw_cross(&mut sheet.sheet, centre, arms, values.map(|value| value > 0.0));
        }
    }
    sheet.decorate();
    let (unit, size) =
        unit_of(range[1].abs().max(range[0].abs()), &[("MPa", 1e6, 1e5), ("kPa", 1e3, 1e2), ("Pa", 1.0, 0.0)]);
    let ticks = Ticks::new(range[0] / size, range[1] / size, 10.0);
    let tick = |&value: &f64| ((value * size - range[0]) / span, ticks.label(value));
    let title = format!("greatest compression [{unit}]");
    draw_bar(&mut sheet.sheet, &view.area, &title, &ticks.values.iter().map(tick).collect::<Vec<_>>());
    let note = format!(
        "crosses: principal stresses, tension with heads; the longest arms are {} or more",
        si_text(longest, "Pa")
    );
    sheet.close(&note)
}

/// Draws which joints are open, slip or lock.
pub fn joints_picture(stage: &StageEnd, joints: &[JointPiece]) -> Picture {
    let mut sheet = StageSheet::new(stage, MARGIN, "states of joints");
    sheet.draw_rock();
    let view = sheet.view;
    let states = [ContactState::Open, ContactState::Slip, ContactState::Lock];
    let states = states.map(|state| of_joints(joints, &view, |joint| joint.state == state));
    let bonds = [BondState::Holds, BondState::Broken];
    let bonds = bonds.map(|state| of_joints(joints, &view, |joint| joint.bond == state));
    let path = |state: ContactState| states[state as usize].0.clone();
    let fine = if joints.len() > 6000 { 0.6 } else { 1.0 };
    sheet.sheet.clipped(&view.area, |sheet| {
        sheet.path(path(ContactState::Lock), Style::line(LOCK, 1.8 * fine));
        sheet.path(path(ContactState::Open), Style::line(INK, OPEN_WIDTH * fine));
        sheet.path(path(ContactState::Open), Style::line(WHITE, (OPEN_WIDTH - 2.6) * fine));
        sheet.path(path(ContactState::Slip), Style::line(SLIP, 3.6 * fine));
        sheet.path(bonds[0].0.clone(), Style::line(BRIDGE, BRIDGE_WIDTH * fine));
        sheet.path(bonds[1].0.clone(), Style::line(INK, BRIDGE_WIDTH * fine));
        sheet.path(bonds[1].0.clone(), Style::line(BROKEN, (BRIDGE_WIDTH - 2.4) * fine));
    });
    sheet.decorate();
    let total = states.iter().map(|(_, length)| length).sum::<f64>().max(f64::MIN_POSITIVE);
    let entry = |state: ContactState, sign, name: &str| {
        let length = states[state as usize].1;
        Entry::new(sign, format!("{name}: {} m, {} %", number_text(length.round()), (100.0 * length / total).round()))
    };
    let entries = vec![
        entry(ContactState::Lock, Sign::Line(LOCK, 1.8), "lock"),
        entry(ContactState::Slip, Sign::Line(SLIP, 3.6), "slip"),
        entry(ContactState::Open, Sign::Hollow, "open"),
    ];
    let mut legends = vec![Legend { title: "Joints, total length", entries }];
    let signs =
        [("bridge that holds", Sign::Line(BRIDGE, BRIDGE_WIDTH)), ("broken bridge", Sign::Line(BROKEN, BRIDGE_WIDTH))];
    if bonds.iter().any(|(_, length)| *length > 0.0) {
        let entry = |((name, sign), (_, length)): ((&str, Sign), &(Path, f64))| {
            Entry::new(sign, format!("{name}: {} m", three_digits(*length)))
        };
        legends.push(Legend { title: "Rock bridges", entries: signs.into_iter().zip(&bonds).map(entry).collect() });
    }
    if stage.bolts.iter().any(|bolt| bolt.condition != BoltCondition::Absent) {
        let entries = vec![Entry::new(Sign::Bolt, "bolt with its tension")];
        legends.push(Legend { title: "Marks", entries });
    }
    sheet.close_with(&legends)
}

/// Some of the joints, and their length (m).
fn of_joints(joints: &[JointPiece], view: &View, are: impl Fn(&JointPiece) -> bool) -> (Path, f64) {
    let mut found = (Path::default(), 0.0);
    for joint in joints.iter().filter(|joint| are(joint) && joint.ends.iter().all(is_drawable)) {
        found.0.line(joint.ends.map(|end| view.pixel(&end)));
        found.1 += (joint.ends[1] - joint.ends[0]).norm();
    }
    found
}

/// Draws the normal and the shear stress on joints, each averaged over a face.
pub fn joint_stress_pictures(stage: &StageEnd, joints: &[JointPiece]) -> [Picture; 2] {
    let normal = |joint: &JointPiece| (-joint.normal_stress).max(0.0);
    let shear = |joint: &JointPiece| joint.shear_stress.abs();
    [
        joint_stress_picture(stage, joints, "compression of joints", &normal),
        joint_stress_picture(stage, joints, "shear stress on joints", &shear),
    ]
}

fn joint_stress_picture(
    stage: &StageEnd,
    joints: &[JointPiece],
    name: &str,
    of: &dyn Fn(&JointPiece) -> f64,
) -> Picture {
    let mut sheet = StageSheet::new(stage, BAR_ROOM, &format!("{name}, averaged over faces"));
    sheet.draw_rock();
    let view = sheet.view;
    let closed: Vec<f64> = joints.iter().filter(|joint| joint.state != ContactState::Open).map(of).collect();
    let largest = quantile(&closed, MOST);
    let mut paths = vec![Path::default(); SCALE_STEPS];
    let mut open = Path::default();
    for joint in joints.iter().filter(|joint| joint.ends.iter().all(is_drawable)) {
        let step = scale_step(of(joint) / largest.max(f64::MIN_POSITIVE));
        let path = if joint.state == ContactState::Open { &mut open } else { &mut paths[step] };
        path.line(joint.ends.map(|end| view.pixel(&end)));
    }
    sheet.sheet.clipped(&view.area, |sheet| {
        sheet.path(open, Style::line(PALE, 2.0));
        for (step, path) in paths.into_iter().enumerate() {
            sheet.path(path, Style::line(scale(step), 4.6));
        }
    });
    sheet.decorate();
    let (unit, size) = unit_of(largest, &[("MPa", 1e6, 1e5), ("kPa", 1e3, 1e2), ("Pa", 1.0, 0.0)]);
    let ticks = linear_ticks(largest / size);
    draw_bar(&mut sheet.sheet, &view.area, &format!("{name} [{unit}]"), &ticks);
    let greatest = closed.iter().copied().fold(0.0, f64::max);
    sheet.close(&format!("greatest {}; open joints pale", si_text(greatest, "Pa")))
}

/// Colours by the length of a vector at the points of the elements, and arrows.
fn vectors_picture(
    stage: &StageEnd,
    what: &str,
    name: &str,
    values: &[Vector],
    units: &[(&'static str, f64, f64)],
) -> Picture {
    let elements = &stage.snapshot.elements;
    let mean = |k: usize| -> Vector {
        let own = corners(elements, k).and_then(|_| values.get(elements.range(k)));
        let own = own.unwrap_or_default();
        own.iter().filter(|v| is_drawable(v)).sum::<Vector>() / own.len().max(1) as f64
    };
    let means: Vec<Vector> = (0..elements.len()).map(mean).collect();
    let sizes: Vec<f64> = means.iter().map(Vector::norm).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let logarithmic = largest > 0.0 && quantile(&sizes, 0.75) < FEW * largest;
    let fraction = |size: f64| match (largest > 0.0, logarithmic) {
        (false, _) => 0.0,
        (true, false) => size / largest,
        (true, true) => 1.0 + libm::log10(size / largest).max(-DECADES) / DECADES,
    };
    let mut sheet = StageSheet::new(stage, BAR_ROOM, what);
    sheet.fill(|k| scale_step(fraction(sizes[k])));
    sheet.draw_outlines();
    let view = sheet.view;
    let mut arrows = Path::default();
    for (centre, k) in samples(stage.snapshot, &view, ARROWS[0]) {
        let length = ARROWS[1] * fraction(sizes[k]);
        if length >= SHORTEST && sizes[k] > 0.0 {
            let way = means[k] * (length / sizes[k]);
            push_arrow(&mut arrows, centre, [centre[0] + way.x, centre[1] - way.y], 8.0);
        }
    }
    sheet.sheet.clipped(&view.area, |sheet| {
        sheet.path(arrows.clone(), Style::line(WHITE, 3.4).opacity(0.8));
        sheet.path(arrows, Style::line(INK, 1.5));
    });
    sheet.decorate();
    let (unit, size) = unit_of(largest, units);
    let decade = |value: f64| (1.0 + (libm::log10(value) - libm::log10(largest / size)) / DECADES, number_text(value));
    let ticks = if logarithmic { decades(largest / size).map(decade).collect() } else { linear_ticks(largest / size) };
    draw_bar(&mut sheet.sheet, &view.area, &format!("{name} [{unit}]"), &ticks);
    let scale = if logarithmic { ", logarithmic scale" } else { "" };
    sheet.close(&format!("longest arrow {} {unit}{scale}; slope true to scale", three_digits(largest / size)))
}

/// Ticks from zero to `largest`.
fn linear_ticks(largest: f64) -> Vec<(f64, String)> {
    let ticks = Ticks::new(0.0, largest, 10.0);
    if ticks.values.is_empty() {
        return vec![(0.0, "0".to_owned())];
    }
    ticks.values.iter().map(|&value| (value / largest, ticks.label(value))).collect()
}

/// 1, 2 and 5 times the powers of ten in the decades below `largest`.
pub fn decades(largest: f64) -> impl Iterator<Item = f64> {
    let top = libm::log10(largest);
    let powers = (top - DECADES).floor() as i32..=top.floor() as i32;
    let values = powers.flat_map(|k| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(k)));
    values.filter(move |value| (0.0..=1.0).contains(&(1.0 + (libm::log10(*value) - top) / DECADES)))
}

/// Name and size of the first unit whose least value a value reaches.
pub fn unit_of(value: f64, units: &[(&'static str, f64, f64)]) -> (&'static str, f64) {
    let fits = units.iter().find(|(_, _, least)| value >= *least).or(units.last());
    fits.map_or(("", 1.0), |(name, size, _)| (*name, *size))
}

/// The value that a share of the values does not exceed; 0 without a finite one.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values.get((share * last).round() as usize).copied().unwrap_or_default()
}

/// One element in each square of `distance` px that has one: its centre (px) and its number.
fn samples(snapshot: &Snapshot, view: &View, distance: f64) -> Vec<(Pixel, usize)> {
    let mut nearest: BTreeMap<[i64; 2], (f64, Pixel, usize)> = BTreeMap::new();
    for k in 0..snapshot.elements.len() {
        let Some(corners) = corners(&snapshot.elements, k) else { continue };
        let centre = view.pixel(&(corners.iter().sum::<Point>() / corners.len() as f64));
        let cell = centre.map(|part| (part / distance).floor());
        let off = [0, 1].map(|k| centre[k] - (cell[k] + 0.5) * distance);
        let off = libm::hypot(off[0], off[1]);
        let best = nearest.entry(cell.map(|part| part as i64)).or_insert((off, centre, k));
        if off < best.0 {
            *best = (off, centre, k);
        }
    }
    nearest.into_values().map(|(_, centre, k)| (centre, k)).collect()
}

/// Principal stresses in the plane.
struct Principal {
    /// The greatest and the least (Pa, tension positive).
    values: [f64; 2],
    /// Unit direction of the greatest.
    direction: Vector,
}

impl Principal {
    fn of(of: &stress::Stress) -> Self {
        let &[xx, yy, xy] = of;
        let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
        Self { values: stress::principal(of), direction: Vector::new(libm::cos(angle), libm::sin(angle)) }
    }
}

/// A picture of a stage under construction.
pub struct StageSheet<'a> {
    stage: &'a StageEnd<'a>,
    /// Drawing so far.
    pub sheet: Sheet,
    /// Where the slope is drawn.
    pub view: View,
}

impl<'a> StageSheet<'a> {
    /// A sheet with its titles, and so much room (px) at the right of the slope.
    pub fn new(stage: &'a StageEnd, room: f64, what: &str) -> Self {
        let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - room, height: HEIGHT_MAX };
        let view = View::fit(Bounds::of(&stage.snapshot.elements.points), area);
        let mut sheet = Sheet::new(WIDTH, view.area.bottom() + BELOW_FRAME + NOTES + 5.0 * 25.0);
        draw_title(&mut sheet, stage.title, &format!("{}: {what}", stage.caption));
        Self { stage, sheet, view }
    }

    /// Fills the elements by steps of the scale.
    pub fn fill(&mut self, step: impl Fn(usize) -> usize) {
        let colours: Vec<_> = (0..SCALE_STEPS).map(scale).collect();
        let (snapshot, view) = (self.stage.snapshot, self.view);
        self.sheet.clipped(&view.area, |sheet| draw_filled(sheet, &snapshot.elements, &view, &colours, step));
    }

    /// Draws the outlines of blocks.
    pub fn draw_outlines(&mut self) {
        let (snapshot, view) = (self.stage.snapshot, self.view);
        self.sheet.clipped(&view.area, |sheet| draw_block_outlines(sheet, snapshot, &view));
    }

    /// Rock behind joints.
    pub fn draw_rock(&mut self) {
        let (snapshot, view) = (self.stage.snapshot, self.view);
        self.sheet.clipped(&view.area, |sheet| {
            draw_filled(sheet, &snapshot.elements, &view, &[ROCK], |_| 0);
            sheet.path(block_outlines(snapshot, &view, |_| true), Style::line(GREY, 0.7));
        });
    }

    /// Water, bolts with their tension, and axes.
    pub fn decorate(&mut self) {
        let (stage, view) = (self.stage, self.view);
        draw_absence(&mut self.sheet, &view, &stage.snapshot.elements);
        self.sheet.clipped(&view.area, |sheet| draw_water(sheet, &view, stage.water));
        draw_tensions(&mut self.sheet, &view, stage.bolts);
        view.draw_axes(&mut self.sheet);
    }

    /// Ends with a length bar and a note.
    pub fn close(mut self, note: &str) -> Picture {
        let y = self.view.area.bottom() + BELOW_FRAME + 24.0;
        let x = draw_length(&mut self.sheet, &self.view, y);
        self.sheet.text([x, y], note, TextStyle::new(LABEL_SIZE));
        self.sheet.cut(y + MARGIN).finish()
    }

    /// Ends with legends.
    pub fn close_with(mut self, legends: &[Legend]) -> Picture {
        let top = self.view.area.bottom() + BELOW_FRAME + 24.0;
        legend::draw_below(&mut self.sheet, legends, LEFT, top);
        self.sheet.cut(top + legend::height_below(legends) + MARGIN).finish()
    }
}
