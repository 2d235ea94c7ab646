//! Helpers for pictures of a slope: polygons in a view, block outlines, titles, labels that keep clear of each other.

use super::axes::{Bounds, LABEL_SIZE, View, is_drawable, number_text};
use super::colour::{Colour, GREY, INK};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, fitted, text_width};
use enmm::geometry::Point;
use enmm_observe::{Boundary, Polygons, Snapshot};

/// Width (px) of every picture.
pub const WIDTH: f64 = 1600.0;
/// Left of every frame (px): room for numbers and the title of the axis.
pub const LEFT: f64 = 116.0;
/// Top of every frame (px): room for title and caption.
pub const TOP: f64 = 100.0;
/// Right and bottom margin (px).
pub const MARGIN: f64 = 32.0;
/// Distance (px) of the lines of a legend.
pub const LINE_HEIGHT: f64 = 26.0;
/// Height (px) below a frame for numbers and the title of the axis.
pub const BELOW_FRAME: f64 = 66.0;

/// Mean area (px²) of a block, about, below which outlines of blocks are left out.
const OUTLINE_AREA: f64 = 12.0;

/// How far (px) coordinates may be off when a picture is rasterised.
const ROUNDING: f64 = 0.1;

/// Draws the title and, below it, a caption.
pub fn draw_title(sheet: &mut Sheet, title: &str, caption: &str) {
    let width = WIDTH - LEFT - MARGIN;
    sheet.text([LEFT, 46.0], &fitted(title, 27.0, width), TextStyle::new(27.0));
    sheet.text([LEFT, 78.0], &fitted(caption, 20.0, width), TextStyle::new(20.0).colour(GREY));
}

/// Says so if there is no element.
pub fn draw_absence(sheet: &mut Sheet, view: &View, elements: &Polygons) {
    if elements.is_empty() {
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
        sheet.text(view.area.middle(), "no elements", style);
    }
}

/// `t = 1.5 s`.
pub fn time_text(time: f64) -> String {
    format!("t = {} s", number_text(time))
}

/// The corners of polygon `k`, if all of them can be drawn.
pub fn corners(polygons: &Polygons, k: usize) -> Option<&[Point]> {
    let (start, end) = (*polygons.start.get(k)? as usize, *polygons.start.get(k + 1)? as usize);
    let corners = polygons.points.get(start..end)?;
    (corners.len() >= 3 && corners.iter().all(is_drawable)).then_some(corners)
}

/// The polygons that a view shows some of: index and corners.
pub fn visible<'a>(polygons: &'a Polygons, view: &View) -> impl Iterator<Item = (usize, &'a [Point])> {
    let world = view.world;
    (0..polygons.len())
        .filter_map(|k| corners(polygons, k).map(|corners| (k, corners)))
        .filter(move |(_, corners)| Bounds::of(*corners).is_some_and(|bounds| bounds.overlaps(&world)))
}

/// Outlines of the polygons as one shape.
pub fn outlines(polygons: &Polygons, view: &View) -> Path {
    let mut path = Path::default();
    for (_, corners) in visible(polygons, view) {
        path.polygon(corners.iter().map(|corner| view.pixel(corner)));
    }
    path
}

/// Fills the polygons, those of one colour as one shape: `choice` gives the index into `colours`.
pub fn draw_filled(
    sheet: &mut Sheet,
    polygons: &Polygons,
    view: &View,
    colours: &[Colour],
    choice: impl Fn(usize) -> usize,
) {
    let mut paths = vec![Path::default(); colours.len()];
    for (k, corners) in visible(polygons, view) {
        let pixels = || corners.iter().map(|corner| view.pixel(corner));
        if holds_pixel(pixels()) {
            paths[choice(k) % colours.len()].polygon(pixels());
        }
    }
    for (path, &colour) in paths.into_iter().zip(colours) {
        sheet.path(path, Style::fill(colour).crisp());
    }
}

/// Whether the box of a polygon holds the centre of a pixel: one that holds none, as most of a very fine mesh, cannot
/// be seen without smoothing.
fn holds_pixel(mut corners: impl Iterator<Item = Pixel>) -> bool {
    let Some(first) = corners.next() else { return false };
    let (low, high) = corners
        .fold((first, first), |(low, high), [x, y]| ([low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]));
    (0..2).all(|axis| (high[axis] + ROUNDING - 0.5).floor() >= (low[axis] - ROUNDING - 0.5).ceil())
}

/// Outlines of the blocks that `chosen` accepts, as one shape.
pub fn block_outlines(snapshot: &Snapshot, view: &View, chosen: impl Fn(&Boundary) -> bool) -> Path {
    let mut path = Path::default();
    for boundary in snapshot.boundaries.iter().filter(|boundary| chosen(boundary)) {
        path.append(outlines(&boundary.loops, view));
    }
    path
}

/// Whether the blocks are large enough in a view for their outlines to be told apart.
pub fn outlines_show(snapshot: &Snapshot, view: &View) -> bool {
    let points = snapshot.boundaries.iter().flat_map(|boundary| &boundary.loops.points);
    let size = Bounds::of(points).map_or(Point::zeros(), |bounds| bounds.size()) * view.scale;
    size.x * size.y > OUTLINE_AREA * snapshot.boundaries.len() as f64
}

/// Draws the outlines of all blocks as thin dark lines, unless they would only blacken the picture.
pub fn draw_block_outlines(sheet: &mut Sheet, snapshot: &Snapshot, view: &View) {
    if !outlines_show(snapshot, view) {
        return;
    }
    let width = if snapshot.boundaries.len() > 3000 { 0.5 } else { 0.9 };
    sheet.path(block_outlines(snapshot, view, |_| true), Style::line(INK, width));
}

/// Texts placed so far, and where they may go.
#[derive(Debug)]
pub struct Labels {
    area: Rect,
    taken: Vec<Rect>,
}

impl Labels {
    /// Labels inside `area`.
    pub fn new(area: Rect) -> Self {
        Self { area, taken: Vec::new() }
    }

    /// Keeps labels off `rect`.
    pub fn avoid(&mut self, rect: Rect) {
        self.taken.push(rect);
    }

    /// Where a text about `mark` starts (base line) without touching another; none if all positions are taken.
    pub fn position(&mut self, [x, y]: Pixel, text: &str) -> Option<Pixel> {
        let (width, height) = (text_width(text, LABEL_SIZE), 1.2 * LABEL_SIZE);
        let distances = [12.0, 26.0, 44.0, 66.0, 92.0];
        let around = distances.iter().flat_map(|&d| {
            [
                [x + d, y - 0.5 * height],
                [x + 0.7 * d, y - 0.7 * d - height],
                [x - 0.5 * width, y - d - height],
                [x - 0.7 * d - width, y - 0.7 * d - height],
                [x - d - width, y - 0.5 * height],
                [x + 0.7 * d, y + 0.7 * d],
                [x - 0.5 * width, y + d],
                [x - 0.7 * d - width, y + 0.7 * d],
            ]
        });
        let rects = around.map(|[left, top]| Rect { left, top, width, height });
        let free = rects.into_iter().find(|rect| self.is_free(rect))?;
        self.taken.push(free);
        Some([free.left, free.top + 0.78 * height])
    }

    fn is_free(&self, rect: &Rect) -> bool {
        self.area.contains([rect.left, rect.top])
            && self.area.contains([rect.right(), rect.bottom()])
            && !self.taken.iter().any(|other| other.grown(2.0).overlaps(rect))
    }
}
