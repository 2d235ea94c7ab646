//! The covers of a model: the stars of its mesh, by their number of physical covers.

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, View, is_drawable};
use super::colour::{ACCENT, COVERS, Colour, WHITE};
use super::legend::{self, Entry, Legend, Sign};
use super::model::{Model, ModelAnnotations};
use super::sheet::{Anchor, Pixel, Rect, Sheet, Style, TextStyle};
use super::slope::{BELOW_FRAME, LEFT, MARGIN, TOP, WIDTH, draw_absence, draw_title};
use enmm::geometry::Point;
use enmm_observe::Snapshot;

/// Side (px) of the detail.
const DETAIL: f64 = 440.0;
/// Height (px) of the main frame at most.
const HEIGHT_MAX: f64 = 680.0;
/// More stars than this are shown in the detail only.
const STARS_MAX: usize = 3000;
/// Stars along a side of the detail, about.
const STARS_ACROSS: f64 = 9.0;

/// Draws blocks, joints and the stars of the mesh (m), each with its number of physical covers, and, enlarged, the
/// position where they have most covers.
pub fn covers_picture(snapshot: &Snapshot, annotations: &ModelAnnotations, stars: &[(Point, u32)]) -> Picture {
    let covers = Covers { model: Model { snapshot, annotations }, stars, spacing: star_spacing(stars) };
    let detail = covers.detail();
    let right = if detail.is_some() { WIDTH - MARGIN - DETAIL - LEFT } else { WIDTH - MARGIN };
    let area = Rect { left: LEFT, top: TOP, width: right - LEFT, height: HEIGHT_MAX };
    let view = View::fit(covers.model.bounds(), area);
    let top = view.area.bottom().max(detail.map_or(0.0, |detail| detail.area.bottom())) + BELOW_FRAME + 30.0;
    let legends = [Legend { title: "Covers of a star", entries: covers.entries() }];
    let mut sheet = Sheet::new(WIDTH, top + legend::height_below(&legends) + MARGIN);
    draw_title(&mut sheet, &annotations.title, "physical covers of the stars of the mesh");
    covers.draw(&mut sheet, &view);
    if let Some(detail) = detail {
        covers.draw_detail(&mut sheet, &view, &detail);
    }
    legend::draw_below(&mut sheet, &legends, LEFT, top);
    sheet.finish()
}

struct Covers<'a> {
    model: Model<'a>,
    stars: &'a [(Point, u32)],
    /// Distance (m) of neighbouring stars, about.
    spacing: f64,
}

impl Covers<'_> {
    /// The enlarged view; none without stars.
    fn detail(&self) -> Option<View> {
        let area = Rect { left: WIDTH - MARGIN - DETAIL, top: TOP, width: DETAIL, height: DETAIL };
        let half_width = 0.5 * STARS_ACROSS * self.spacing;
        let centre = busiest(self.stars, half_width)?;
        (half_width > 0.0).then(|| View::exact(Bounds::square(centre, half_width), area))
    }

    fn draw(&self, sheet: &mut Sheet, view: &View) {
        sheet.clipped(&view.area, |sheet| {
            self.model.draw_rock(sheet, view);
            if self.stars.len() <= STARS_MAX {
                let radius = (0.1 * self.spacing * view.scale).clamp(0.8, 2.2);
                for (position, covers) in self.stars_in(view) {
                    sheet.circle(view.pixel(position), radius, Style::fill(cover_colour(*covers)));
                }
            }
        });
        draw_absence(sheet, view, &self.model.snapshot.elements);
        view.draw_axes(sheet);
    }

    fn stars_in(&self, view: &View) -> impl Iterator<Item = &(Point, u32)> {
        let world = view.world;
        self.stars.iter().filter(move |(position, _)| is_drawable(position) && world.contains(position))
    }

    /// The enlarged part, and in the main view the frame of what it enlarges.
    fn draw_detail(&self, sheet: &mut Sheet, main: &View, detail: &View) {
        let [left, top] = main.pixel(&Point::new(detail.world.min.x, detail.world.max.y));
        let side = detail.world.size().x * main.scale;
        let frame = Rect { left, top, width: side, height: side };
        sheet.clipped(&main.area, |sheet| sheet.rect(&frame, Style::line(ACCENT, 2.2)));
        let radius = (0.2 * self.spacing * detail.scale).clamp(3.0, 11.0);
        sheet.clipped(&detail.area, |sheet| {
            self.model.draw_blocks(sheet, detail, true);
            self.model.draw_traces(sheet, detail, 2.6);
            for (position, covers) in self.stars_in(detail) {
                draw_star(sheet, detail.pixel(position), *covers, radius);
            }
        });
        detail.draw_axes(sheet);
        sheet.rect(&detail.area, Style::line(ACCENT, 2.2));
        let style = TextStyle::new(LABEL_SIZE).colour(ACCENT);
        sheet.text([detail.area.left, TOP - 10.0], "Detail: covers of each star", style);
    }

    fn entries(&self) -> Vec<Entry> {
        let names = ["1 cover", "2 covers", "3 covers", "4 or more"];
        let count = |class: usize| self.stars.iter().filter(|(_, covers)| cover_class(*covers) == class).count();
        let classes = names.iter().enumerate().map(|(class, name)| (class, name, count(class)));
        let entry = |(class, name, count)| Entry::new(Sign::Dot(COVERS[class]), format!("{name}: {count} stars"));
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
fn star_spacing(stars: &[(Point, u32)]) -> f64 {
    let nearest = |position: &Point| {
        let others = stars.iter().map(|(other, _)| (other - position).norm_squared());
        others.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min).sqrt()
    };
    // The lattice is regular: the nearest neighbour of any star tells its size.
    let first = stars.iter().map(|(position, _)| position).find(|p| is_drawable(p)).map_or(0.0, nearest);
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

fn draw_star(sheet: &mut Sheet, [x, y]: Pixel, covers: u32, radius: f64) {
    sheet.circle([x, y], radius, Style::fill(cover_colour(covers)).edged(WHITE, 1.2));
    if radius >= 8.0 {
        let size = 1.35 * radius;
        let style = TextStyle::new(size).anchor(Anchor::Middle).colour(WHITE);
        sheet.text([x, y + 0.36 * size], &covers.to_string(), style);
    }
}
