//! The deformed slope coloured by the size of its displacement.

use super::Picture;
use super::axes::{Bounds, LABEL_SIZE, Ticks, View, is_drawable, number_text, round_above, three_digits};
use super::bar::{BAR_ROOM, draw_bar};
use super::colour::{ACCENT, GREY, INK, SCALE_STEPS, scale, scale_step};
use super::sheet::{Rect, Sheet, Style, TextStyle, text_width};
use super::slope::{
    BELOW_FRAME, LEFT, Labels, TOP, WIDTH, corners, draw_absence, draw_block_outlines, draw_filled, draw_title,
    outlines, time_text,
};
use enmm::geometry::Vector;
use enmm_observe::{Polygons, Snapshot};

/// Height (px) of the frame at most.
const HEIGHT_MAX: f64 = 820.0;
/// Height (px) of the notes at the bottom.
const NOTES: f64 = 60.0;
/// Length (px) of the length bar at least.
const LENGTH_MIN: f64 = 80.0;
/// Deformation below this part of the size of the slope cannot be seen and is drawn larger.
const VISIBLE: f64 = 1e-3;
/// Part of the size of the slope to which such a deformation is drawn at least.
const EXAGGERATED: f64 = 0.008;

/// Draws the slope at its current position, each element coloured by the mean displacement of its points.
///
/// `reference_outline` (m) is the slope before it moved, drawn dashed. A displacement below a thousandth of the size of
/// the slope is drawn larger, and the picture says by how much.
pub fn displacement_picture(snapshot: &Snapshot, title: &str, reference_outline: &Polygons) -> Picture {
    let field = Field::new(snapshot);
    // 1, or the round factor that makes the displacement visible.
    let (size, moved) = (Bounds::of(&snapshot.elements.points).map_or(0.0, |b| b.diagonal()), field.largest_at_point);
    let is_hidden = moved > 1e-12 * size && moved < VISIBLE * size;
    let factor = if is_hidden { round_above(EXAGGERATED * size / moved) } else { 1.0 };
    let shown = if factor > 1.0 { &exaggerated(snapshot, factor) } else { snapshot };
    let bounds = Bounds::of(shown.elements.points.iter().chain(&reference_outline.points));
    let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - BAR_ROOM, height: HEIGHT_MAX };
    let view = View::fit(bounds, area);
    let mut sheet = Sheet::new(WIDTH, view.area.bottom() + BELOW_FRAME + NOTES);
    draw_title(&mut sheet, title, &time_text(snapshot.time));
    sheet.clipped(&view.area, |sheet| draw_slope(sheet, &view, shown, &field, reference_outline));
    view.draw_axes(&mut sheet);
    draw_colour_bar(&mut sheet, &view.area, &field);
    draw_notes(&mut sheet, &view, &field, factor);
    sheet.finish()
}

/// Sizes of displacement.
struct Field {
    /// Mean (m) of the points of each element; zero where it is not finite.
    of_elements: Vec<f64>,
    /// Largest (m) of `of_elements`.
    largest: f64,
    /// Largest (m) at any point.
    largest_at_point: f64,
    /// The element with the largest mean.
    largest_element: Option<usize>,
}

impl Field {
    fn new(snapshot: &Snapshot) -> Self {
        let sizes: Vec<f64> =
            snapshot.displacement.iter().map(|u| if is_drawable(u) { u.norm() } else { 0.0 }).collect();
        let mean = |k: usize| {
            let sizes = corners(&snapshot.elements, k).and_then(|_| sizes.get(snapshot.elements.range(k)));
            sizes.map_or(0.0, |sizes| sizes.iter().sum::<f64>() / sizes.len() as f64)
        };
        let of_elements: Vec<f64> = (0..snapshot.elements.len()).map(mean).collect();
        let largest_element = (0..of_elements.len()).max_by(|&a, &b| of_elements[a].total_cmp(&of_elements[b]));
        let largest = largest_element.map_or(0.0, |k| of_elements[k]);
        Self { largest, largest_element, of_elements, largest_at_point: sizes.into_iter().fold(0.0, f64::max) }
    }

    /// Name and size (m) of the unit in which the field reads well.
    fn unit(&self) -> (&'static str, f64) {
        match self.largest {
            largest if largest >= 0.1 => ("m", 1.0),
            largest if largest >= 1e-4 || largest == 0.0 => ("mm", 1e-3),
            _ => ("µm", 1e-6),
        }
    }
}

/// Elements and boundaries alone, with every point displaced `factor` times as far.
fn exaggerated(snapshot: &Snapshot, factor: f64) -> Snapshot {
    let (elements, boundaries) = (snapshot.elements.clone(), snapshot.boundaries.clone());
    let mut shown = Snapshot { elements, boundaries, ..Snapshot::default() };
    for (point, displacement) in shown.elements.points.iter_mut().zip(&snapshot.displacement) {
        *point += displacement * (factor - 1.0);
    }
    for boundary in &mut shown.boundaries {
        for (point, before) in boundary.loops.points.iter_mut().zip(&boundary.reference) {
            *point += (*point - before) * (factor - 1.0);
        }
    }
    shown
}

fn draw_slope(sheet: &mut Sheet, view: &View, shown: &Snapshot, field: &Field, reference_outline: &Polygons) {
    let colours: Vec<_> = (0..SCALE_STEPS).map(scale).collect();
    let step = |k: usize| scale_step(field.of_elements[k] / field.largest);
    draw_filled(sheet, &shown.elements, view, &colours, step);
    draw_block_outlines(sheet, shown, view);
    draw_absence(sheet, view, &shown.elements);
    sheet.path(outlines(reference_outline, view), Style::line(GREY, 1.8).dashed());
    let largest = field.largest_element.filter(|_| field.largest > 0.0);
    if let Some(corners) = largest.and_then(|k| corners(&shown.elements, k)) {
        let centre = view.pixel(&(corners.iter().sum::<Vector>() / corners.len() as f64));
        sheet.circle(centre, 8.0, Style::line(ACCENT, 2.5));
        if let Some(position) = Labels::new(view.area).position(centre, "max") {
            sheet.text(position, "max", TextStyle::new(LABEL_SIZE).colour(ACCENT).halo());
        }
    }
}

fn draw_colour_bar(sheet: &mut Sheet, frame: &Rect, field: &Field) {
    let (unit, size) = field.unit();
    let largest = field.largest / size;
    let ticks = Ticks::new(0.0, largest, (frame.height / 60.0).max(2.0));
    // Without a displacement the bar says zero.
    let values = if ticks.values.is_empty() { &[0.0] } else { &ticks.values[..] };
    let fraction = |value: f64| if largest > 0.0 { value / largest } else { 0.0 };
    let ticks: Vec<_> = values.iter().map(|&value| (fraction(value), ticks.label(value))).collect();
    draw_bar(sheet, frame, &format!("displacement [{unit}]"), &ticks);
}

/// Below the frame: a length, the dashed line explained, the largest value, the factor of deformation.
fn draw_notes(sheet: &mut Sheet, view: &View, field: &Field, factor: f64) {
    let y = view.area.bottom() + BELOW_FRAME + 24.0;
    let style = TextStyle::new(LABEL_SIZE);
    let mut x = draw_length(sheet, view, y);
    sheet.line([x, y - 5.0], [x + 50.0, y - 5.0], Style::line(GREY, 1.8).dashed());
    sheet.text([x + 60.0, y], "outline before", style);
    x += 60.0 + text_width("outline before", LABEL_SIZE) + 50.0;
    let (unit, size) = field.unit();
    let largest = format!("largest displacement {} {unit}", three_digits(field.largest_at_point / size));
    sheet.text([x, y], &largest, style);
    x += text_width(&largest, LABEL_SIZE) + 50.0;
    let deformation = if factor > 1.0 {
        format!("deformation drawn {} × larger", number_text(factor))
    } else {
        "deformation true to scale".to_owned()
    };
    sheet.text([x, y], &deformation, style);
}

/// Draws a bar of a round length; returns where the next note starts.
pub fn draw_length(sheet: &mut Sheet, view: &View, y: f64) -> f64 {
    let length = round_above(LENGTH_MIN / view.scale);
    let (left, right) = (LEFT, LEFT + length * view.scale);
    let style = Style::line(INK, 2.5);
    sheet.line([left, y - 5.0], [right, y - 5.0], style);
    for x in [left, right] {
        sheet.line([x, y - 12.0], [x, y + 2.0], style);
    }
    let label = format!("{} m", number_text(length));
    sheet.text([right + 12.0, y], &label, TextStyle::new(LABEL_SIZE));
    right + 12.0 + text_width(&label, LABEL_SIZE) + 50.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use enmm::geometry::Point;

    /// Distance (m) of a point to the segment from `a` to `b`.
    fn distance(point: &Point, a: &Point, b: &Point) -> f64 {
        let along = b - a;
        let t = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (point - a - along * t).norm()
    }

    /// Magnified outlines of blocks once had teeth off the rock, where a joint ends between corners of the elements.
    #[test]
    fn magnified_outlines_run_along_the_edges_of_magnified_elements() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/cases/plane_slide.toml");
        let case = enmm_io::load_case(path.as_ref()).expect("a case").case;
        let mut simulation = enmm::model::Simulation::new(case).expect("a model");
        for _ in 0..40 {
            simulation.advance(false).expect("a step");
        }
        let shown = exaggerated(&Snapshot::of(&simulation), 1e4);
        let block_of = &Snapshot::of(&simulation).block;
        let edges_of = |block: u32| {
            let of_block = (0..shown.elements.len()).filter(move |&k| block_of[k] == block);
            of_block.flat_map(|k| {
                let corners = shown.elements.get(k);
                (0..corners.len()).map(move |i| (corners[i], corners[(i + 1) % corners.len()]))
            })
        };
        for boundary in &shown.boundaries {
            let edges: Vec<(Point, Point)> = edges_of(boundary.block).collect();
            for point in &boundary.loops.points {
                let nearest = edges.iter().map(|(a, b)| distance(point, a, b)).fold(f64::INFINITY, f64::min);
                // A pixel of the picture is 30 mm.
                assert!(nearest < 1e-3, "block {}: {nearest} m off at {point:?}", boundary.block);
            }
        }
    }
}
