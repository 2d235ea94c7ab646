//! The model before it moves: blocks, joints and joint sets, supports, loads, water, bolts, monitors and ports.

use std::collections::HashSet;

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, View, is_drawable, si_text};
use super::colour::{ACCENT, BLOCKS, Colour, GREY, INK, LINES, POND, ROCKS, WATER, WHITE};
use super::displacement::draw_length;
use super::legend::{self, Entry, Legend, Sign};
use super::sheet::{Path, Pixel, Rect, Sheet, Style, TextStyle, fitted};
use super::signs::{self, Held, draw_held};
use super::slope::{
    BELOW_FRAME, LEFT, Labels, MARGIN, TOP, WIDTH, block_outlines, draw_absence, draw_block_outlines, draw_filled,
    draw_title, outlines, outlines_show, time_text,
};
use enmm::geometry::{Point, Vector};
use enmm_observe::{BoltCondition, Snapshot, height_at};

/// Height (px) of the frame at most.
const HEIGHT_MAX: f64 = 720.0;
/// Height (px) below the axis for the length bar.
const LENGTH_ROW: f64 = 40.0;
/// Mean element area (px²) below which the mesh would only grey the picture.
const MESH_AREA: f64 = 60.0;
/// More pieces of joint traces than this are drawn as thin lines.
const TRACES_MANY: usize = 2500;
/// Width (px) of the joints of the law of most of them.
const JOINT_WIDTH: f64 = 1.8;
/// Distance (px) of the signs of supports along an edge.
const SUPPORT_DISTANCE: f64 = 32.0;
/// Length (px) of the arrow of the largest force, and of a traction.
const ARROWS: [f64; 2] = [64.0, 26.0];
/// Distance (px) of the arrows of a traction.
const ARROW_DISTANCE: f64 = 36.0;

/// Radius (px) of the ring round a change.
const RING: f64 = 7.0;
/// Colour of rings round blocks that have joined a neighbour.
const CRUMB: Colour = INK;

/// Colour of rings round ends of joints.
fn end_colour(joined: bool) -> Colour {
    if joined { LINES[0] } else { ACCENT }
}

/// Annotations of a picture of the model besides its elements and blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelAnnotations {
    /// Title of the picture.
    pub title: String,
    /// Rows of supported points.
    pub held: Vec<HeldRow>,
    /// Boxes `[xmin, ymin, xmax, ymax]` (m) whose covers are held.
    pub held_boxes: Vec<[f64; 4]>,
    /// Name and position (m) of each monitor.
    pub monitors: Vec<(String, Point)>,
    /// Ports.
    pub ports: Vec<PortMark>,
    /// Loads with a place.
    pub loads: Vec<LoadMark>,
    /// Actions on all rock, in words.
    pub facts: Vec<String>,
    /// Direction of the section, in words; empty when the case gives none.
    pub section: String,
    /// Strength and stiffness of each rock, in the order of [`Snapshot::rocks`].
    pub rock_values: Vec<String>,
    /// Strength of each joint law, in the order of [`Snapshot::joint_laws`].
    pub law_values: Vec<String>,
    /// Lines of text about the size of the model.
    pub counts: Vec<String>,
    /// Pieces of joint traces: both ends (m), and the index of the joint law in [`Snapshot::joint_laws`].
    pub trace_segments: Vec<([Point; 2], u32)>,
    /// Joint sets.
    pub sets: Vec<SetMark>,
    /// Bolts.
    pub bolts: Vec<BoltMark>,
    /// Surface of the water from left to right (m), level beyond its ends; empty without water.
    pub water: Vec<Point>,
    /// Whether the water also stands outside the rock.
    pub pond: bool,
    /// Ends of joints that almost met a line (m), and whether they were joined to it.
    pub ends: Vec<(Point, bool)>,
    /// Places (m) of blocks that were too small and have joined a neighbour.
    pub crumbs: Vec<Point>,
}

/// Points (m) that are held alike.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldRow {
    /// How.
    pub held: Held,
    /// Unit direction away from the rock.
    pub outward: Vector,
    /// The points (m), along one edge.
    pub points: Vec<Point>,
}

/// Where hosts exchange values.
#[derive(Debug, Clone, PartialEq)]
pub struct PortMark {
    /// Name.
    pub name: String,
    /// Where.
    pub place: PortPlace,
}

/// The extent of a port (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PortPlace {
    /// The block that holds a point.
    Block(Point),
    /// A segment of the outer boundary.
    Boundary([Point; 2]),
    /// A segment along a joint.
    Joint([Point; 2]),
}

/// A load with a place (m).
#[derive(Debug, Clone, PartialEq)]
pub enum LoadMark {
    /// Force (N/m) and moment (N·m/m, counter-clockwise).
    Point {
        /// Where.
        point: Point,
        /// Force (N/m).
        force: Vector,
        /// Moment (N·m/m).
        moment: f64,
        /// Name and value.
        label: String,
    },
    /// Traction along an edge.
    Traction {
        /// The edge.
        edge: [Point; 2],
        /// Traction (Pa).
        traction: Vector,
        /// Name and value.
        label: String,
    },
    /// Pressure (Pa) that pushes into the rock.
    Pressure {
        /// The edge.
        edge: [Point; 2],
        /// Pressure (Pa).
        pressure: f64,
        /// Name and value.
        label: String,
    },
    /// Fluid pressure in joints along a segment.
    Joint {
        /// The segment.
        edge: [Point; 2],
        /// Name and value.
        label: String,
    },
}

/// A bolt of the case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BoltMark {
    /// Name.
    pub name: Option<String>,
    /// Head and far end (m).
    pub ends: [Point; 2],
    /// Largest tension (N per metre of depth) along it.
    pub force: f64,
    /// Kind.
    pub condition: BoltCondition,
}

impl BoltMark {
    /// Its tension, and whether it yields or is broken.
    pub fn tension_text(&self) -> String {
        let state = match self.condition {
            BoltCondition::Broken => " broken",
            BoltCondition::Yielded => " yields",
            _ => "",
        };
        si_text(self.force, "N/m") + state
    }
}

/// A joint set of the case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SetMark {
    /// Name, such as `set 1`.
    pub name: String,
    /// Angle and spacing.
    pub detail: String,
    /// Unit direction of its joints.
    pub direction: Vector,
    /// A point of one of its joints (m); none when it cuts no rock.
    pub place: Option<Point>,
}

/// Draws the model: rocks in soft colours, joints by law, joint sets, supports by kind, loads, water, bolts, monitors
/// and ports; the legend has the strengths.
pub fn model_picture(snapshot: &Snapshot, annotations: &ModelAnnotations) -> Picture {
    let model = Model { snapshot, annotations };
    let wide = Rect { left: LEFT, top: TOP, width: WIDTH - MARGIN - LEFT, height: HEIGHT_MAX };
    let view = View::fit(model.bounds(), wide);
    let beside = WIDTH - MARGIN - legend::BESIDE - view.area.right() >= legend::COLUMN;
    let left = if beside { view.area.right() + legend::BESIDE } else { LEFT };
    let legends = legend::wrapped_columns(model.legends(), left, beside);
    let below = view.area.bottom() + BELOW_FRAME + LENGTH_ROW;
    let bottom = if beside {
        below.max(TOP + legend::height_beside(&legends))
    } else {
        below + 30.0 + legend::height_below(&legends)
    };
    let mut sheet = Sheet::new(WIDTH, bottom + MARGIN);
    draw_title(&mut sheet, &annotations.title, &caption(snapshot, &annotations.section));
    model.draw(&mut sheet, &view);
    draw_length(&mut sheet, &view, view.area.bottom() + BELOW_FRAME + 0.6 * LENGTH_ROW);
    if beside {
        legend::draw_beside(&mut sheet, &legends, [left, TOP]);
    } else {
        legend::draw_below(&mut sheet, &legends, left, below + 30.0);
    }
    sheet.finish()
}

/// A model to be drawn.
pub(super) struct Model<'a> {
    /// Its blocks and elements.
    pub snapshot: &'a Snapshot,
    /// Annotations.
    pub annotations: &'a ModelAnnotations,
}

impl Model<'_> {
    /// Bounds of all that is drawn (m).
    pub fn bounds(&self) -> Option<Bounds> {
        let traces = self.annotations.trace_segments.iter().flat_map(|(ends, _)| ends);
        let blocks = self.snapshot.boundaries.iter().flat_map(|boundary| &boundary.loops.points);
        let bolts = self.annotations.bolts.iter().flat_map(|bolt| &bolt.ends);
        Bounds::of(self.snapshot.elements.points.iter().chain(blocks).chain(traces).chain(bolts))
    }

    fn draw(&self, sheet: &mut Sheet, view: &View) {
        sheet.clipped(&view.area, |sheet| {
            self.draw_pond(sheet, view);
            let rock = |k: usize| self.snapshot.rock.get(k).map_or(0, |&rock| rock as usize);
            draw_filled(sheet, &self.snapshot.elements, view, &ROCKS, rock);
            self.draw_outlines(sheet, view);
            self.draw_joints(sheet, view);
            self.draw_water(sheet, view);
            self.draw_boxes(sheet, view);
        });
        let mut labels = Labels::new(view.area);
        draw_bolts(sheet, view, &self.annotations.bolts);
        draw_absence(sheet, view, &self.snapshot.elements);
        self.draw_held(sheet, view);
        self.draw_loads(sheet, view, &mut labels);
        self.draw_changes(sheet, view);
        self.draw_ports_and_monitors(sheet, view, &mut labels);
        self.draw_sets(sheet, view, &mut labels);
        view.draw_axes(sheet);
    }

    /// Joints, thinner where there are many.
    fn draw_joints(&self, sheet: &mut Sheet, view: &View) {
        let many = self.annotations.trace_segments.len() > TRACES_MANY;
        if !many || outlines_show(self.snapshot, view) {
            self.draw_traces(sheet, view, if many { 1.1 } else { JOINT_WIDTH });
        }
    }

    /// Hatched held blocks, block outlines.
    fn draw_outlines(&self, sheet: &mut Sheet, view: &View) {
        sheet.hatched(block_outlines(self.snapshot, view, |boundary| boundary.fixed), GREY);
        draw_block_outlines(sheet, self.snapshot, view);
    }

    /// Blocks, mesh and joints.
    pub fn draw_rock(&self, sheet: &mut Sheet, view: &View) {
        let elements = self.snapshot.elements.len().max(1) as f64;
        let element_area = view.area.width * view.area.height / elements;
        self.draw_blocks(sheet, view, element_area > MESH_AREA);
        self.draw_joints(sheet, view);
    }

    /// Fills, mesh, hatched held blocks, block outlines.
    pub fn draw_blocks(&self, sheet: &mut Sheet, view: &View, with_mesh: bool) {
        let snapshot = self.snapshot;
        let of = if snapshot.rocks.len() > 1 { &snapshot.rock } else { &snapshot.block };
        draw_filled(sheet, &snapshot.elements, view, &BLOCKS, |k| of.get(k).map_or(0, |&number| number as usize));
        if with_mesh {
            sheet.path(outlines(&snapshot.elements, view), Style::line(WHITE, 0.8).opacity(0.9));
        }
        self.draw_outlines(sheet, view);
    }

    /// Joints by law.
    pub fn draw_traces(&self, sheet: &mut Sheet, view: &View, width: f64) {
        let laws = self.annotations.trace_segments.iter().map(|(_, law)| *law as usize + 1).max().unwrap_or(0);
        for (law, style) in self.law_styles(laws, width).into_iter().enumerate() {
            let mut path = Path::default();
            let of_law = self.annotations.trace_segments.iter().filter(|(_, l)| *l as usize == law);
            let shows = |ends: &[Point; 2]| Bounds::of(ends).is_some_and(|bounds| bounds.overlaps(&view.world));
            for (ends, _) in of_law.filter(|(ends, _)| ends.iter().all(is_drawable) && shows(ends)) {
                path.line(ends.iter().map(|end| view.pixel(end)));
            }
            sheet.path(path, style);
        }
    }

    /// The line of each law: that of most joints is thin, those of others are wide or broken, so that they differ
    /// without colour.
    fn law_styles(&self, laws: usize, width: f64) -> Vec<Style> {
        let mut lengths = vec![0.0; laws];
        for (ends, law) in self.annotations.trace_segments.iter().filter(|(ends, _)| ends.iter().all(is_drawable)) {
            if let Some(length) = lengths.get_mut(*law as usize) {
                *length += (ends[1] - ends[0]).norm();
            }
        }
        let rank = |law: usize| lengths.iter().filter(|length| **length > lengths[law]).count();
        let style = |law: usize| {
            let wide = if matches!(rank(law) % 4, 1 | 2) { 1.9 * width } else { width };
            let style = Style::line(LINES[law % LINES.len()], wide);
            if rank(law) % 4 >= 2 { style.dashed() } else { style }
        };
        (0..laws).map(style).collect()
    }

    /// Water outside the rock, which is drawn over it afterwards.
    fn draw_pond(&self, sheet: &mut Sheet, view: &View) {
        let bounds = self.bounds().filter(|_| self.annotations.pond);
        if let (Some(bounds), false) = (bounds, self.annotations.water.is_empty()) {
            let mut corners = surface_between(&self.annotations.water, bounds.min.x, bounds.max.x);
            corners.iter_mut().for_each(|p| p.y = p.y.max(bounds.min.y));
            corners.extend([Point::new(bounds.max.x, bounds.min.y), bounds.min]);
            let mut path = Path::default();
            path.polygon(corners.iter().map(|corner| view.pixel(corner)));
            sheet.path(path, Style::fill(POND));
        }
    }

    /// The surface of the water with its triangle.
    fn draw_water(&self, sheet: &mut Sheet, view: &View) {
        draw_water(sheet, view, &self.annotations.water);
    }

    fn draw_boxes(&self, sheet: &mut Sheet, view: &View) {
        let mut path = Path::default();
        for [left, low, right, high] in &self.annotations.held_boxes {
            let corners = [[left, low], [right, low], [right, high], [left, high]];
            let corners = corners.map(|[x, y]| Point::new(*x, *y));
            if corners.iter().all(is_drawable) {
                path.polygon(corners.iter().map(|corner| view.pixel(corner)));
            }
        }
        sheet.path(path, Style::line(INK, 1.6).dashed());
    }

    /// Signs along held edges, evenly where there are supports.
    fn draw_held(&self, sheet: &mut Sheet, view: &View) {
        for row in &self.annotations.held {
            let out = [row.outward.x, -row.outward.y];
            for tip in spread(row, view) {
                draw_held(sheet, row.held, tip, out);
            }
        }
    }

    fn draw_loads(&self, sheet: &mut Sheet, view: &View, labels: &mut Labels) {
        let forces = self.annotations.loads.iter().filter_map(|load| match load {
            LoadMark::Point { force, .. } => Some(force.norm()),
            _ => None,
        });
        let largest = forces.fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let style = Style::line(INK, 2.2);
        for load in &self.annotations.loads {
            let (at, label) = match load {
                LoadMark::Point { point, force, moment, label } => {
                    let tip = view.pixel(point);
                    let tail = tail(tip, *force, ARROWS[0] * (force.norm() / largest).max(0.3));
                    signs::draw_arrow(sheet, tail, tip, style);
                    if *moment != 0.0 {
                        signs::draw_moment(sheet, tip, *moment > 0.0, style);
                    }
                    (tail, label)
                }
                LoadMark::Traction { edge, traction, label } => {
                    (draw_row_of_arrows(sheet, view, edge, *traction, style), label)
                }
                LoadMark::Pressure { edge, pressure, label } => {
                    let inward = self.inward(edge) * pressure.signum();
                    (draw_row_of_arrows(sheet, view, edge, inward, style), label)
                }
                LoadMark::Joint { edge, label } => {
                    let [a, b] = edge.map(|end| view.pixel(&end));
                    sheet.line(a, b, Style::line(WATER, 4.0).dashed());
                    ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], label)
                }
            };
            draw_label(sheet, labels, at, label);
        }
    }

    /// Unit normal of an edge into the rock.
    fn inward(&self, [a, b]: &[Point; 2]) -> Vector {
        let along = b - a;
        let normal = Vector::new(-along.y, along.x) / along.norm().max(f64::MIN_POSITIVE);
        let blocks = self.snapshot.boundaries.iter().flat_map(|boundary| &boundary.loops.points);
        let rock = Bounds::of(blocks).map_or(*a, |bounds| (bounds.min + bounds.max) * 0.5);
        if (rock - (a + b) * 0.5).dot(&normal) < 0.0 { -normal } else { normal }
    }

    /// Rings round ends of joints near a line, and round blocks that have joined a neighbour.
    fn draw_changes(&self, sheet: &mut Sheet, view: &View) {
        let ends = self.annotations.ends.iter().map(|(place, joined)| (place, end_colour(*joined)));
        let crumbs = self.annotations.crumbs.iter().map(|place| (place, CRUMB));
        for (place, colour) in ends.chain(crumbs).filter(|(place, _)| is_drawable(place)) {
            sheet.circle(view.pixel(place), RING, Style::line(colour, 1.8));
        }
    }

    /// Marks of ports and monitors with their names; one name where both share name and place.
    fn draw_ports_and_monitors(&self, sheet: &mut Sheet, view: &View, labels: &mut Labels) {
        let mut named: Vec<(&String, Pixel)> = Vec::new();
        for port in &self.annotations.ports {
            let mark = match port.place {
                PortPlace::Block(point) => point,
                PortPlace::Boundary(ends) | PortPlace::Joint(ends) => {
                    let style = Style::line(ACCENT, 4.0).opacity(0.55);
                    let style = if matches!(port.place, PortPlace::Joint(_)) { style.dashed() } else { style };
                    if ends.iter().all(is_drawable) {
                        sheet.line(view.pixel(&ends[0]), view.pixel(&ends[1]), style);
                    }
                    (ends[0] + ends[1]) * 0.5
                }
            };
            if is_drawable(&mark) {
                signs::draw_port(sheet, view.pixel(&mark));
                named.push((&port.name, view.pixel(&mark)));
            }
        }
        for (name, position) in self.annotations.monitors.iter().filter(|(_, position)| is_drawable(position)) {
            signs::draw_monitor(sheet, view.pixel(position));
            let mark = view.pixel(position);
            let near = |other: &Pixel| libm::hypot(other[0] - mark[0], other[1] - mark[1]) < 12.0;
            if !named.iter().any(|(other, place)| *other == name && near(place)) {
                named.push((name, mark));
            }
        }
        for (_, mark) in &named {
            labels.avoid(Rect { left: mark[0], top: mark[1], width: 0.0, height: 0.0 }.grown(8.0));
        }
        for (name, mark) in named {
            draw_label(sheet, labels, mark, name);
        }
    }

    fn draw_sets(&self, sheet: &mut Sheet, view: &View, labels: &mut Labels) {
        for set in &self.annotations.sets {
            if let Some(place) = set.place.filter(is_drawable) {
                let [x, y] = view.pixel(&place);
                let [u, v] = [18.0 * set.direction.x, -18.0 * set.direction.y];
                sheet.line([x - u, y - v], [x + u, y + v], Style::line(INK, 4.0));
                draw_label(sheet, labels, [x, y], &set.name);
            }
        }
    }

    fn legends(&self) -> Vec<Legend> {
        let counts = self.annotations.counts.iter().chain(&self.annotations.facts);
        let all = [
            Legend { title: "Rock", entries: self.rock_entries() },
            Legend { title: "Joints", entries: self.joint_entries() },
            Legend { title: "Supports and marks", entries: self.mark_entries() },
            Legend { title: "Model", entries: counts.map(|line| Entry::new(Sign::None, line)).collect() },
        ];
        all.into_iter().filter(|legend| !legend.entries.is_empty()).collect()
    }

    fn rock_entries(&self) -> Vec<Entry> {
        let used: HashSet<u32> = self.snapshot.rock.iter().copied().collect();
        let rocks = self.snapshot.rocks.iter().enumerate().filter(|(k, _)| used.contains(&(*k as u32)));
        rocks
            .flat_map(|(k, name)| {
                let values = self.annotations.rock_values.get(k);
                with_values(Entry::new(Sign::Fill(ROCKS[k % ROCKS.len()]), name), values)
            })
            .collect()
    }

    fn joint_entries(&self) -> Vec<Entry> {
        let used: HashSet<u32> = self.annotations.trace_segments.iter().map(|(_, law)| *law).collect();
        let laws = self.snapshot.joint_laws.iter().enumerate().filter(|(law, _)| used.contains(&(*law as u32)));
        let styles = self.law_styles(self.snapshot.joint_laws.len(), JOINT_WIDTH);
        let law = |(law, name): (usize, &String)| {
            let values = self.annotations.law_values.get(law);
            let (colour, width) = styles[law].stroke.unwrap_or((INK, JOINT_WIDTH));
            let sign = if styles[law].dashed { Sign::Dashed(colour, width) } else { Sign::Line(colour, width) };
            with_values(Entry::new(sign, name), values)
        };
        let mut entries: Vec<Entry> = laws.flat_map(law).collect();
        let sets = self.annotations.sets.iter().filter(|set| set.place.is_some());
        entries.extend(sets.flat_map(|set| with_values(Entry::new(Sign::Stroke, &set.name), Some(&set.detail))));
        entries
    }

    fn mark_entries(&self) -> Vec<Entry> {
        let annotations = self.annotations;
        let held = |held: Held| annotations.held.iter().any(|row| row.held == held);
        let place = |is: fn(&PortPlace) -> bool| annotations.ports.iter().any(|port| is(&port.place));
        let bolt =
            |later: bool| annotations.bolts.iter().any(|bolt| (bolt.condition == BoltCondition::Absent) == later);
        let end = |joined: bool| annotations.ends.iter().any(|(_, is)| *is == joined);
        let joints = annotations.loads.iter().any(|load| matches!(load, LoadMark::Joint { .. }));
        let forces = annotations.loads.iter().any(|load| !matches!(load, LoadMark::Joint { .. }));
        let all = [
            (held(Held::Pinned), Sign::Held(Held::Pinned), "held along x and y"),
            (held(Held::Roller), Sign::Held(Held::Roller), "held along one axis"),
            (held(Held::Quiet), Sign::Held(Held::Quiet), "quiet boundary"),
            (held(Held::FreeField), Sign::Held(Held::FreeField), "free field"),
            (!annotations.held_boxes.is_empty(), Sign::Dashed(INK, 1.6), "box held"),
            (self.snapshot.boundaries.iter().any(|boundary| boundary.fixed), Sign::Hatch, "block held"),
            (!annotations.water.is_empty(), Sign::Water, "water table"),
            (forces, Sign::Arrow(INK), "load"),
            (joints, Sign::Dashed(WATER, 4.0), "pressure in joints"),
            (bolt(false), Sign::Bolt, "bolt"),
            (bolt(true), Sign::Dashed(ACCENT, 2.0), "bolt installed later"),
            (end(true), Sign::Ring(end_colour(true)), "joint end joined to a line"),
            (end(false), Sign::Ring(end_colour(false)), "joint end held by rock"),
            (!annotations.crumbs.is_empty(), Sign::Ring(CRUMB), "small block joined to another"),
            (!annotations.monitors.is_empty(), Sign::Monitor, "monitor"),
            (place(|place| !matches!(place, PortPlace::Joint(_))), Sign::Port, "port"),
            (place(|place| matches!(place, PortPlace::Joint(_))), Sign::Dashed(ACCENT, 4.0), "port in joints"),
        ];
        let present = all.into_iter().filter(|(present, ..)| *present);
        present.map(|(_, sign, text)| Entry::new(sign, text)).collect()
    }
}

/// Section and, when the model has moved, the time.
fn caption(snapshot: &Snapshot, section: &str) -> String {
    let time = if snapshot.time == 0.0 { String::new() } else { time_text(snapshot.time) };
    let parts = [section, &time].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
    if parts.is_empty() { "section".to_owned() } else { parts.join(", ") }
}

/// An entry, and below it its values.
fn with_values(entry: Entry, values: Option<&String>) -> Vec<Entry> {
    let below = values.filter(|values| !values.is_empty()).map(|values| Entry::new(Sign::Blank, values));
    std::iter::once(entry).chain(below).collect()
}

/// A text in a white rim near a position, unless there is no room.
fn draw_label(sheet: &mut Sheet, labels: &mut Labels, at: Pixel, text: &str) {
    let text = fitted(text, LABEL_SIZE, 260.0);
    if let Some(position) = labels.position(at, &text).filter(|_| !text.is_empty()) {
        sheet.text(position, &text, TextStyle::new(LABEL_SIZE).halo());
    }
}

/// Bolts with their plates; those that a stage installs later are broken lines.
fn draw_bolts(sheet: &mut Sheet, view: &View, bolts: &[BoltMark]) {
    for bolt in bolts.iter().filter(|bolt| bolt.ends.iter().all(is_drawable)) {
        let style = Style::line(ACCENT, 2.6);
        let style = if bolt.condition == BoltCondition::Absent { Style::line(ACCENT, 2.0).dashed() } else { style };
        signs::draw_bolt(sheet, bolt.ends.map(|end| view.pixel(&end)), style);
    }
}

/// Bolts that are there, each with its tension at its far end; whether there is one.
pub fn draw_tensions(sheet: &mut Sheet, view: &View, bolts: &[BoltMark]) -> bool {
    let there: Vec<BoltMark> = bolts.iter().filter(|bolt| bolt.condition != BoltCondition::Absent).cloned().collect();
    draw_bolts(sheet, view, &there);
    let mut labels = Labels::new(view.area);
    for bolt in there.iter().filter(|bolt| bolt.ends.iter().all(is_drawable)) {
        draw_label(sheet, &mut labels, view.pixel(&bolt.ends[1]), &bolt.tension_text());
    }
    !there.is_empty()
}

/// The surface of water across a view, with its triangle.
pub fn draw_water(sheet: &mut Sheet, view: &View, surface: &[Point]) {
    if surface.is_empty() || !surface.iter().all(is_drawable) {
        return;
    }
    let line = surface_between(surface, view.world.min.x, view.world.max.x);
    sheet.path(Path::open(line.iter().map(|point| view.pixel(point))), Style::line(WATER, 2.4));
    let x = view.world.min.x + 0.06 * view.world.size().x;
    signs::draw_water_mark(sheet, view.pixel(&Point::new(x, height_at(surface, x))));
}

/// A surface from `left` to `right` (m), level beyond its ends.
fn surface_between(surface: &[Point], left: f64, right: f64) -> Vec<Point> {
    let end = |x: f64| Point::new(x, height_at(surface, x));
    let inside = surface.iter().filter(|point| left < point.x && point.x < right).copied();
    std::iter::once(end(left)).chain(inside).chain(std::iter::once(end(right))).collect()
}

/// Where an arrow of a length (px) along a force begins that ends at `tip`.
fn tail(tip: Pixel, force: Vector, length: f64) -> Pixel {
    let size = force.norm();
    if size > 0.0 { [tip[0] - length * force.x / size, tip[1] + length * force.y / size] } else { tip }
}

/// Arrows onto an edge with a line through their tails; returns the middle of that line.
fn draw_row_of_arrows(sheet: &mut Sheet, view: &View, edge: &[Point; 2], force: Vector, style: Style) -> Pixel {
    let [a, b] = edge.map(|end| view.pixel(&end));
    let at = |share: f64| [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
    let count = (libm::hypot(b[0] - a[0], b[1] - a[1]) / ARROW_DISTANCE).clamp(1.0, 60.0).round();
    let mut path = Path::default();
    for k in 0..=count as usize {
        let tip = at(k as f64 / count);
        signs::push_arrow(&mut path, tail(tip, force, ARROWS[1]), tip, 7.0);
    }
    path.line([0.0, 1.0].map(|share| tail(at(share), force, ARROWS[1])));
    sheet.path(path, style);
    // A label beside the middle keeps off the arrows.
    tail(at(0.5), force, ARROWS[1] + LABEL_SIZE)
}

/// Where signs stand along a row of supported points: evenly, where a point is near.
fn spread(row: &HeldRow, view: &View) -> Vec<Pixel> {
    let points: Vec<Pixel> = row.points.iter().filter(|p| is_drawable(p)).map(|p| view.pixel(p)).collect();
    let along = [row.outward.y, row.outward.x];
    let place = |p: &Pixel| p[0] * along[0] + p[1] * along[1];
    let (low, high) =
        points.iter().map(place).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)));
    if points.is_empty() {
        return Vec::new();
    }
    let count = ((high - low) / SUPPORT_DISTANCE).floor().max(1.0);
    let reach = 0.75 * SUPPORT_DISTANCE.max(1.5 * (high - low) / points.len() as f64);
    let targets = (0..count as usize).map(|k| low + (k as f64 + 0.5) * (high - low) / count);
    let nearest = |s: f64| {
        let distance = |p: &&Pixel| (place(p) - s).abs();
        let near = points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let shift = s - place(near);
        (shift.abs() <= reach).then(|| [near[0] + along[0] * shift, near[1] + along[1] * shift])
    };
    targets.filter_map(nearest).collect()
}
