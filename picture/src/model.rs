//! The model before it moves: blocks, mesh, joints, supports, monitors and the covers of the stars.

use std::collections::HashSet;

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, View, is_drawable};
use super::colour::{ACCENT, BLOCKS, COVERS, Colour, GREY, INK, LINES, WHITE};
use super::slope::{
    BELOW_FRAME, LEFT, LINE_HEIGHT, Labels, MARGIN, TOP, WIDTH, block_outlines, draw_absence, draw_block_outlines,
    draw_filled, draw_title, outlines, outlines_show, time_text,
};
use super::svg::{Anchor, Path, Pixel, Rect, Style, Svg, TextStyle, fitted};
use enmm::geometry::Point;
use enmm::model::Snapshot;

/// Side (px) of the detail.
const DETAIL: f64 = 440.0;
/// Height (px) of the main frame at most.
const HEIGHT_MAX: f64 = 680.0;
/// More stars than this are shown in the detail only.
const STARS_MAX: usize = 3000;
/// Stars along a side of the detail, about.
const STARS_ACROSS: f64 = 9.0;
/// Mean element area (px²) below which the mesh would only grey the picture.
const MESH_AREA: f64 = 60.0;
/// More pieces of joint traces than this are drawn as thin lines.
const TRACES_MANY: usize = 2500;
/// Distance (px) of marks of supports at least.
const SUPPORT_DISTANCE: f64 = 11.0;
/// Lines of a legend at most.
const LINES_MAX: usize = 9;

/// What a picture of the model shows besides its elements and blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelAnnotations {
    /// Title of the picture.
    pub title: String,
    /// Position (m) of each star and the number of its physical covers.
    pub stars: Vec<(Point, u32)>,
    /// Points (m) that are held.
    pub fixed: Vec<Point>,
    /// Name and position (m) of each monitor.
    pub monitors: Vec<(String, Point)>,
    /// Lines of text about the size of the model.
    pub counts: Vec<String>,
    /// Pieces of joint traces: both ends (m), and the index of the joint law in [`Snapshot::joint_laws`].
    pub trace_segments: Vec<([Point; 2], u32)>,
    /// Head and far end (m) of each bolt.
    pub bolts: Vec<[Point; 2]>,
}

/// Draws the model: blocks in soft colours, mesh, joints by law, supports and monitors, and, enlarged, the position
/// where the stars have most covers.
pub fn model_picture(snapshot: &Snapshot, annotations: &ModelAnnotations) -> Picture {
    let model = Model { snapshot, annotations, spacing: star_spacing(annotations) };
    let detail = model.detail();
    let right = if detail.is_some() { WIDTH - MARGIN - DETAIL - LEFT } else { WIDTH - MARGIN };
    let area = Rect { left: LEFT, top: TOP, width: right - LEFT, height: HEIGHT_MAX };
    let view = View::fit(model.bounds(), area);
    let bottom = view.area.bottom().max(detail.map_or(0.0, |detail| detail.area.bottom()));
    let legends = model.legends();
    let lines = legends.iter().map(|legend| legend.entries.len()).max().unwrap_or(0);
    let legend_top = bottom + BELOW_FRAME + 30.0;
    let mut sheet = Svg::new(WIDTH, legend_top + LINE_HEIGHT * (lines as f64 + 0.5) + MARGIN);
    draw_title(&mut sheet, &annotations.title, &time_text(snapshot.time));
    model.draw(&mut sheet, &view);
    if let Some(detail) = detail {
        model.draw_detail(&mut sheet, &view, &detail);
    }
    draw_legends(&mut sheet, &legends, legend_top);
    sheet.finish()
}

struct Model<'a> {
    snapshot: &'a Snapshot,
    annotations: &'a ModelAnnotations,
    /// Distance (m) of neighbouring stars, about.
    spacing: f64,
}

impl Model<'_> {
    fn bounds(&self) -> Option<Bounds> {
        let traces = self.annotations.trace_segments.iter().flat_map(|(ends, _)| ends);
        let blocks = self.snapshot.boundaries.iter().flat_map(|boundary| &boundary.loops.points);
        Bounds::of(self.snapshot.elements.points.iter().chain(blocks).chain(traces))
    }

    /// The enlarged view; none without stars.
    fn detail(&self) -> Option<View> {
        let area = Rect { left: WIDTH - MARGIN - DETAIL, top: TOP, width: DETAIL, height: DETAIL };
        let half_width = 0.5 * STARS_ACROSS * self.spacing;
        let centre = busiest(&self.annotations.stars, half_width)?;
        (half_width > 0.0).then(|| View::exact(Bounds::square(centre, half_width), area))
    }

    fn draw(&self, sheet: &mut Svg, view: &View) {
        let elements = self.snapshot.elements.len().max(1) as f64;
        let element_area = view.area.width * view.area.height / elements;
        sheet.clipped(&view.area, |sheet| {
            self.draw_blocks(sheet, view, element_area > MESH_AREA);
            let many = self.annotations.trace_segments.len() > TRACES_MANY;
            if !many || outlines_show(self.snapshot, view) {
                self.draw_traces(sheet, view, if many { 1.1 } else { 1.8 });
            }
            if self.annotations.stars.len() <= STARS_MAX {
                self.draw_stars(sheet, view, (0.1 * self.spacing * view.scale).clamp(0.8, 2.2));
            }
        });
        self.draw_bolts(sheet, view);
        draw_absence(sheet, view, &self.snapshot.elements);
        self.draw_supports(sheet, view);
        self.draw_monitors(sheet, view);
        view.draw_axes(sheet);
    }

    /// Fills, mesh, hatched held blocks, block outlines.
    fn draw_blocks(&self, sheet: &mut Svg, view: &View, with_mesh: bool) {
        let snapshot = self.snapshot;
        let block = |k: usize| snapshot.block.get(k).map_or(0, |&block| block as usize);
        draw_filled(sheet, &snapshot.elements, view, &BLOCKS, block);
        if with_mesh {
            sheet.path(&outlines(&snapshot.elements, view), Style::line(WHITE, 0.8).opacity(0.9));
        }
        sheet.hatched(&block_outlines(snapshot, view, |boundary| boundary.fixed), GREY);
        draw_block_outlines(sheet, snapshot, view);
    }

    fn draw_traces(&self, sheet: &mut Svg, view: &View, width: f64) {
        for (law, &colour) in LINES.iter().enumerate() {
            let mut path = Path::default();
            let of_law = self.annotations.trace_segments.iter().filter(|(_, l)| *l as usize % LINES.len() == law);
            let shows = |ends: &[Point; 2]| Bounds::of(ends).is_some_and(|bounds| bounds.overlaps(&view.world));
            for (ends, _) in of_law.filter(|(ends, _)| ends.iter().all(is_drawable) && shows(ends)) {
                path.line(ends.iter().map(|end| view.pixel(end)));
            }
            sheet.path(&path, Style::line(colour, width));
        }
    }

    /// A line with a plate at the head for each bolt.
    fn draw_bolts(&self, sheet: &mut Svg, view: &View) {
        let mut path = Path::default();
        for ends in self.annotations.bolts.iter().filter(|ends| ends.iter().all(is_drawable)) {
            let [[x, y], [u, v]] = [view.pixel(&ends[0]), view.pixel(&ends[1])];
            let length = (u - x).hypot(v - y).max(f64::MIN_POSITIVE);
            let plate = [5.0 * (v - y) / length, -5.0 * (u - x) / length];
            path.line([[x, y], [u, v]]);
            path.line([[x + plate[0], y + plate[1]], [x - plate[0], y - plate[1]]]);
        }
        sheet.path(&path, Style::line(ACCENT, 2.6));
    }

    fn draw_stars(&self, sheet: &mut Svg, view: &View, radius: f64) {
        for (position, covers) in self.stars_in(view) {
            sheet.circle(view.pixel(position), radius, Style::fill(cover_colour(*covers)));
        }
    }

    fn stars_in(&self, view: &View) -> impl Iterator<Item = &(Point, u32)> {
        let world = view.world;
        self.annotations.stars.iter().filter(move |(position, _)| is_drawable(position) && world.contains(position))
    }

    /// Triangles below the held points, thinned where they would overlap.
    fn draw_supports(&self, sheet: &mut Svg, view: &View) {
        let mut marked = HashSet::new();
        let mut path = Path::default();
        for point in self.annotations.fixed.iter().filter(|point| is_drawable(point)) {
            let [x, y] = view.pixel(point);
            if marked.insert([x, y].map(|coordinate| (coordinate / SUPPORT_DISTANCE).floor() as i64)) {
                path.polygon(support([x, y]));
            }
        }
        sheet.path(&path, Style::fill(WHITE).edged(INK, 1.3));
    }

    fn draw_monitors(&self, sheet: &mut Svg, view: &View) {
        let mut labels = Labels::new(view.area);
        let monitors = self.annotations.monitors.iter().filter(|(_, position)| is_drawable(position));
        let marks: Vec<_> = monitors.map(|(name, position)| (name, view.pixel(position))).collect();
        for (_, mark) in &marks {
            draw_monitor(sheet, *mark);
            labels.avoid(Rect { left: mark[0], top: mark[1], width: 0.0, height: 0.0 }.grown(7.0));
        }
        for (name, mark) in marks {
            let name = fitted(name, LABEL_SIZE, 260.0);
            if let Some(position) = labels.position(mark, &name) {
                sheet.text(position, &name, TextStyle::new(LABEL_SIZE).halo());
            }
        }
    }

    /// The enlarged part, and in the main view the frame of what it enlarges.
    fn draw_detail(&self, sheet: &mut Svg, main: &View, detail: &View) {
        let [left, top] = main.pixel(&Point::new(detail.world.min.x, detail.world.max.y));
        let side = detail.world.size().x * main.scale;
        let frame = Rect { left, top, width: side, height: side };
        sheet.clipped(&main.area, |sheet| sheet.rect(&frame, Style::line(ACCENT, 2.2)));
        let radius = (0.2 * self.spacing * detail.scale).clamp(3.0, 11.0);
        sheet.clipped(&detail.area, |sheet| {
            self.draw_blocks(sheet, detail, true);
            self.draw_traces(sheet, detail, 2.6);
            for (position, covers) in self.stars_in(detail) {
                draw_star(sheet, detail.pixel(position), *covers, radius);
            }
        });
        detail.draw_axes(sheet);
        sheet.rect(&detail.area, Style::line(ACCENT, 2.2));
        let style = TextStyle::new(LABEL_SIZE).colour(ACCENT);
        sheet.text([detail.area.left, TOP - 10.0], "Detail: covers of each star", style);
    }

    fn legends(&self) -> Vec<Legend> {
        let marks = Legend { title: "Marks", entries: self.mark_entries() };
        let joints = Legend { title: "Joints", entries: self.joint_entries() };
        let stars = Legend { title: "Covers of a star", entries: self.star_entries() };
        let counts =
            self.annotations.counts.iter().map(|line| Entry { sign: Sign::None, text: line.clone() }).collect();
        let all = [joints, marks, stars, Legend { title: "Model", entries: counts }];
        all.into_iter().filter(|legend| !legend.entries.is_empty()).map(Legend::shortened).collect()
    }

    fn joint_entries(&self) -> Vec<Entry> {
        let used: HashSet<u32> = self.annotations.trace_segments.iter().map(|(_, law)| *law).collect();
        let laws = self.snapshot.joint_laws.iter().enumerate().filter(|(law, _)| used.contains(&(*law as u32)));
        laws.map(|(law, name)| Entry { sign: Sign::Line(LINES[law % LINES.len()]), text: name.clone() }).collect()
    }

    fn mark_entries(&self) -> Vec<Entry> {
        let held_blocks = self.snapshot.boundaries.iter().any(|boundary| boundary.fixed);
        let all = [
            (!self.snapshot.boundaries.is_empty(), Sign::Line(INK), "block outline"),
            (held_blocks, Sign::Hatch, "block held"),
            (!self.annotations.fixed.is_empty(), Sign::Support, "point held"),
            (!self.annotations.bolts.is_empty(), Sign::Line(ACCENT), "bolt"),
            (!self.annotations.monitors.is_empty(), Sign::Monitor, "monitor or port"),
        ];
        let present = all.into_iter().filter(|(present, ..)| *present);
        present.map(|(_, sign, text)| Entry { sign, text: text.to_owned() }).collect()
    }

    fn star_entries(&self) -> Vec<Entry> {
        let names = ["1 cover", "2 covers", "3 covers", "4 or more"];
        let count =
            |class: usize| self.annotations.stars.iter().filter(|(_, covers)| cover_class(*covers) == class).count();
        let classes = names.iter().enumerate().map(|(class, name)| (class, name, count(class)));
        let entry =
            |(class, name, count)| Entry { sign: Sign::Dot(COVERS[class]), text: format!("{name}: {count} stars") };
        classes.filter(|(_, _, count)| *count > 0).map(entry).collect()
    }
}

/// Index into [`COVERS`].
fn cover_class(covers: u32) -> usize {
    (covers.clamp(1, COVERS.len() as u32) - 1) as usize
}

fn cover_colour(covers: u32) -> Colour {
    COVERS[cover_class(covers)]
}

/// Distance (m) of neighbours if the stars were spread evenly over a triangular lattice.
fn star_spacing(annotations: &ModelAnnotations) -> f64 {
    let nearest = |position: &Point| {
        let others = annotations.stars.iter().map(|(other, _)| (other - position).norm_squared());
        others.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min).sqrt()
    };
    // The lattice is regular: the nearest neighbour of any star tells its size.
    let first = annotations
        .stars
        .iter()
        .map(|(position, _)| position)
        .find(|position| is_drawable(position))
        .map_or(0.0, nearest);
    if first.is_finite() { first } else { 1.0 }
}

/// The star about which, within `half_width` (m), the stars have most covers per star.
fn busiest(stars: &[(Point, u32)], half_width: f64) -> Option<Point> {
    let drawable: Vec<_> = stars.iter().filter(|(position, _)| is_drawable(position)).collect();
    let most = drawable.iter().map(|(_, covers)| *covers).max()?;
    let covers_about = |centre: &Point| {
        let near = Bounds::square(*centre, half_width);
        drawable
            .iter()
            .filter(|(position, _)| near.contains(position))
            .map(|(_, covers)| u64::from(*covers))
            .sum::<u64>()
    };
    let candidates = drawable.iter().filter(|(_, covers)| *covers == most).take(200).map(|(position, _)| *position);
    // The first of equals wins.
    candidates
        .map(|position| (covers_about(&position), position))
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map(|(_, position)| position)
}

fn draw_star(sheet: &mut Svg, [x, y]: Pixel, covers: u32, radius: f64) {
    sheet.circle([x, y], radius, Style::fill(cover_colour(covers)).edged(WHITE, 1.2));
    if radius >= 8.0 {
        let size = 1.35 * radius;
        let style = TextStyle::new(size).anchor(Anchor::Middle).colour(WHITE);
        sheet.text([x, y + 0.36 * size], &covers.to_string(), style);
    }
}

/// A triangle whose top is the held point.
fn support([x, y]: Pixel) -> [Pixel; 3] {
    [[x, y], [x - 5.0, y + 9.0], [x + 5.0, y + 9.0]]
}

fn draw_monitor(sheet: &mut Svg, position: Pixel) {
    sheet.circle(position, 6.0, Style::fill(WHITE).edged(ACCENT, 2.2));
    sheet.circle(position, 2.0, Style::fill(ACCENT));
}

/// A column of explained signs.
struct Legend {
    title: &'static str,
    entries: Vec<Entry>,
}

struct Entry {
    sign: Sign,
    text: String,
}

enum Sign {
    None,
    Line(Colour),
    Dot(Colour),
    Hatch,
    Support,
    Monitor,
}

/// Width (px) kept for a sign.
const SIGN_WIDTH: f64 = 44.0;

impl Legend {
    /// With the last lines replaced by their number, if there are too many.
    fn shortened(mut self) -> Self {
        if self.entries.len() > LINES_MAX {
            let left_out = self.entries.len() - (LINES_MAX - 1);
            self.entries.truncate(LINES_MAX - 1);
            self.entries.push(Entry { sign: Sign::None, text: format!("and {left_out} more") });
        }
        self
    }
}

/// Draws the legends side by side.
fn draw_legends(sheet: &mut Svg, legends: &[Legend], top: f64) {
    let width = (WIDTH - LEFT - MARGIN) / legends.len().max(1) as f64;
    for (k, legend) in legends.iter().enumerate() {
        let left = LEFT + k as f64 * width;
        sheet.text([left, top], legend.title, TextStyle::new(LABEL_SIZE + 1.0).colour(GREY));
        for (line, entry) in legend.entries.iter().enumerate() {
            let y = top + LINE_HEIGHT * (line + 1) as f64;
            let indent = draw_sign(sheet, &entry.sign, [left, y - 5.0]);
            let text = fitted(&entry.text, LABEL_SIZE, width - indent - 20.0);
            sheet.text([left + indent, y], &text, TextStyle::new(LABEL_SIZE));
        }
    }
}

/// Draws a sign centred on the height of `y`; returns the room it takes (px).
fn draw_sign(sheet: &mut Svg, sign: &Sign, [left, y]: Pixel) -> f64 {
    let middle = left + 0.4 * SIGN_WIDTH;
    match *sign {
        Sign::None => return 0.0,
        Sign::Line(colour) => sheet.line([left, y], [left + 0.8 * SIGN_WIDTH, y], Style::line(colour, 2.4)),
        Sign::Dot(colour) => sheet.circle([middle, y], 7.0, Style::fill(colour)),
        Sign::Monitor => draw_monitor(sheet, [middle, y]),
        Sign::Support => {
            let mut path = Path::default();
            path.polygon(support([middle, y - 5.0]));
            sheet.path(&path, Style::fill(WHITE).edged(INK, 1.3));
        }
        Sign::Hatch => {
            let (right, half) = (left + 0.8 * SIGN_WIDTH, 8.0);
            let mut path = Path::default();
            path.polygon([[left, y - half], [right, y - half], [right, y + half], [left, y + half]]);
            sheet.hatched(&path, GREY);
            sheet.path(&path, Style::line(INK, 0.9));
        }
    }
    SIGN_WIDTH
}
