//! Contours at the end of a stage: bands of a field between round levels, and the lines between them.
//!
//! A field has a value at each corner of the elements. Between corners it is linear along the sides, so that a contour
//! runs on from one element of a block to the next; joints interrupt it.

use std::collections::BTreeMap;

use super::Picture;
use super::axes::{Ticks, View, is_drawable, number_text, si_text, three_digits};
use super::bar::{BAR_ROOM, draw_bands};
use super::colour::{Colour, INK, SCALE_STEPS, scale};
use super::sheet::{Path, Pixel, Style};
use super::slope::{corners, draw_filled, visible};
use super::stage::{FEW, MOST, StageEnd, StageSheet, decades, quantile, unit_of};
use enmm::geometry::{Point, Vector, polygon};
use enmm_observe::Snapshot;

/// Levels at most.
const LEVELS: f64 = 12.0;

/// Values at the corners of the elements, and the levels between bands.
struct Field {
    values: Vec<f64>,
    levels: Vec<f64>,
    /// Labels of the bar beside each level.
    labels: Vec<String>,
}

/// Draws contours of the size of the displacement (m) of each point of the elements since the start of the stage.
pub fn displacement_contours(stage: &StageEnd, since: &[Vector]) -> Picture {
    let values: Vec<f64> = since.iter().map(|u| if is_drawable(u) { u.norm() } else { 0.0 }).collect();
    let largest = values.iter().copied().fold(0.0, f64::max);
    let (unit, size) = unit_of(largest, &[("m", 1.0, 0.1), ("mm", 1e-3, 1e-4), ("µm", 1e-6, 0.0)]);
    let logarithmic = largest > 0.0 && quantile(&values, 0.75) < FEW * largest;
    let (levels, labels) = if logarithmic {
        decades(largest / size).map(|value| (value * size, number_text(value))).unzip()
    } else {
        round_levels([0.0, largest], size)
    };
    let scale = if logarithmic { "; logarithmic levels" } else { "" };
    let note = format!("largest displacement {} {unit}{scale}; slope true to scale", three_digits(largest / size));
    let title = format!("displacement [{unit}]");
    draw(
        stage,
        "contours of displacement since the start of the stage",
        &title,
        &note,
        &Field { values, levels, labels },
    )
}

/// Draws contours of the mean stress in the plane, (xx + yy)/2 with tension positive.
///
/// The stress of an element is constant. A point has the mean, by area, of the elements of its block that meet there;
/// `reference` are the points of the elements before they moved (m), of which those of one place are equal.
pub fn mean_stress_contours(stage: &StageEnd, reference: &[Point]) -> Picture {
    let values = at_points(stage.snapshot, reference, |[xx, yy, _]| 0.5 * (xx + yy));
    let range = [quantile(&values, 1.0 - MOST), quantile(&values, MOST)];
    let greatest = range[0].abs().max(range[1].abs());
    let (unit, size) = unit_of(greatest, &[("MPa", 1e6, 1e5), ("kPa", 1e3, 1e2), ("Pa", 1.0, 0.0)]);
    let (levels, labels) = round_levels(range, size);
    let [least, most] = [quantile(&values, 0.0), quantile(&values, 1.0)].map(|value| si_text(value, "Pa"));
    let note = format!("tension positive; from {least} to {most}; smoothed within blocks");
    draw(stage, "contours of mean stress", &format!("mean stress [{unit}]"), &note, &Field { values, levels, labels })
}

/// Round levels within a range of values, and their labels in units of `size`; without those at its ends.
pub(super) fn round_levels([low, high]: [f64; 2], size: f64) -> (Vec<f64>, Vec<String>) {
    let ticks = Ticks::new(low / size, high / size, LEVELS);
    let inside = ticks.values.iter().filter(|&&value| low < value * size && value * size < high);
    inside.map(|&value| (value * size, ticks.label(value))).unzip()
}

/// A quantity of the stress of the elements (Pa) at each of their points.
fn at_points(snapshot: &Snapshot, reference: &[Point], of: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    let elements = &snapshot.elements;
    // Adding zero turns -0 into 0.
    let key = |block: u32, p: &Point| (block, (p.x + 0.0).to_bits(), (p.y + 0.0).to_bits());
    let known = || {
        let all = (0..elements.len()).filter(|&k| corners(elements, k).is_some());
        all.filter_map(|k| {
            Some((k, *snapshot.block.get(k)?, *snapshot.stress.get(k)?, reference.get(elements.range(k))?))
        })
    };
    let mut sums: BTreeMap<_, [f64; 2]> = BTreeMap::new();
    for (k, block, stress, places) in known() {
        let (area, value) = (polygon::area(elements.get(k)), of(stress));
        for place in places {
            let sum = sums.entry(key(block, place)).or_default();
            *sum = [sum[0] + area * value, sum[1] + area];
        }
    }
    let mut values = vec![f64::NAN; elements.points.len()];
    for (k, block, _, places) in known() {
        for (value, place) in values[elements.range(k)].iter_mut().zip(places) {
            let [sum, area] = sums.get(&key(block, place)).copied().unwrap_or_default();
            *value = sum / area;
        }
    }
    values
}

/// Draws bands, lines, outlines of blocks and the bar.
fn draw(stage: &StageEnd, what: &str, title: &str, note: &str, field: &Field) -> Picture {
    let mut sheet = StageSheet::new(stage, BAR_ROOM, what);
    let (view, count) = (sheet.view, field.levels.len());
    let colour = |band: usize| scale((SCALE_STEPS - 1) * band / count.max(1));
    let colours: Vec<Colour> = (0..=count).map(colour).collect();
    let elements = &stage.snapshot.elements;
    let values = |k: usize| {
        let own = field.values.get(elements.range(k)).filter(|own| own.iter().all(|value| value.is_finite()));
        own.unwrap_or_default()
    };
    let least = |k: usize| values(k).iter().copied().fold(f64::INFINITY, f64::min);
    let base =
        |k: usize| if values(k).is_empty() { 0 } else { field.levels.partition_point(|&level| level <= least(k)) };
    let (mut bands, mut lines) = (vec![Path::default(); count], Path::default());
    for (k, places) in visible(elements, &view).filter(|(k, _)| !values(*k).is_empty()) {
        let most = values(k).iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let within = (base(k)..count).take_while(|&level| field.levels[level] <= most);
        for level in within {
            let (above, line) = cut(places, values(k), field.levels[level], &view);
            bands[level].polygon(above);
            line.chunks_exact(2).for_each(|ends| lines.line(ends.iter().copied()));
        }
    }
    sheet.sheet.clipped(&view.area, |sheet| {
        draw_filled(sheet, elements, &view, &colours, base);
        for (band, colour) in bands.into_iter().zip(&colours[1..]) {
            sheet.path(band, Style::fill(*colour).crisp());
        }
        sheet.path(lines, Style::line(INK, 1.1).opacity(0.75));
    });
    sheet.draw_outlines();
    sheet.decorate();
    draw_bands(&mut sheet.sheet, &view.area, title, &colours, &field.labels);
    sheet.close(note)
}

/// The part of a polygon in which the field is not below a level (px), and the ends of the pieces of its contour.
pub(super) fn cut(places: &[Point], values: &[f64], level: f64, view: &View) -> (Vec<Pixel>, Vec<Pixel>) {
    let (mut above, mut line) = (Vec::new(), Vec::new());
    for (k, (place, &value)) in places.iter().zip(values).enumerate() {
        let next = (k + 1) % places.len();
        if value >= level {
            above.push(view.pixel(place));
        }
        if (value >= level) != (values[next] >= level) {
            let share = (level - value) / (values[next] - value);
            let crossing = view.pixel(&(place + (places[next] - place) * share));
            above.push(crossing);
            line.push(crossing);
        }
    }
    // A polygon that is not convex may cross a contour more than twice: pieces follow each other along the contour.
    if line.len() > 2 {
        let apart = |from: &Pixel, to: &Pixel| libm::hypot(to[0] - from[0], to[1] - from[1]);
        let first = line[0];
        let end = line.iter().copied().max_by(|a, b| apart(&first, a).total_cmp(&apart(&first, b))).unwrap_or(first);
        let along = |p: &Pixel| (p[0] - end[0]) * (first[0] - end[0]) + (p[1] - end[1]) * (first[1] - end[1]);
        line.sort_by(|a, b| along(a).total_cmp(&along(b)));
    }
    (above, line)
}

#[cfg(test)]
mod tests {
    use super::super::axes::Bounds;
    use super::super::sheet::Rect;
    use super::*;

    const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];

    fn area(corners: &[Pixel]) -> f64 {
        polygon::area(&corners.iter().map(|&[x, y]| Point::new(x, y)).collect::<Vec<_>>()).abs()
    }

    /// The field x on a rectangle: the contour at 1 is upright, and three quarters lie above it.
    #[test]
    fn a_contour_of_a_linear_field_is_straight_and_at_its_level() {
        let places = PLACES.map(Point::from);
        let view = View::fit(Bounds::of(&places), Rect { left: 0.0, top: 0.0, width: 800.0, height: 600.0 });
        let (above, line) = cut(&places, &places.map(|p| p.x), 1.0, &view);
        assert_eq!(line.len(), 2);
        for end in &line {
            assert!((end[0] - view.pixel(&Point::new(1.0, 0.0))[0]).abs() < 1e-9, "{line:?}");
        }
        let whole = area(&places.map(|p| view.pixel(&p)));
        assert!((area(&above) / whole - 0.75).abs() < 1e-12);
    }

    /// The letter U: the contour of y at mid height has two pieces, one in each arm.
    #[test]
    fn a_contour_through_two_arms_has_two_pieces() {
        let places = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 0.5], [1.0, 0.5], [1.0, 2.0], [0.0, 2.0]];
        let places = places.map(Point::from);
        let view = View::fit(Bounds::of(&places), Rect { left: 0.0, top: 0.0, width: 800.0, height: 600.0 });
        let (_, line) = cut(&places, &places.map(|p| p.y), 1.0, &view);
        let mut ends: Vec<f64> = line.chunks_exact(2).map(|ends| (ends[0][0] - ends[1][0]).abs()).collect();
        ends.iter_mut().for_each(|length| *length /= view.scale);
        assert!(ends.len() == 2 && ends.iter().all(|length| (length - 1.0).abs() < 1e-9), "{ends:?}");
    }

    /// Two elements of one block and one of another: points that they share have the mean by area within a block.
    #[test]
    fn stress_is_smoothed_within_blocks_alone() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [4.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let mut points: Vec<Point> = points.map(Point::from).to_vec();
        points.push(Point::new(-1.0, -1.0));
        let elements = enmm_observe::Polygons { start: vec![0, 3, 6, 9], points: points.clone() };
        let stress = vec![[1.0, 1.0, 9.0], [5.0, 5.0, 9.0], [-7.0, -7.0, 9.0]];
        let snapshot = Snapshot { elements, stress, block: vec![0, 0, 1], ..Snapshot::default() };
        let values = at_points(&snapshot, &points, |[xx, yy, _]| 0.5 * (xx + yy));
        // Areas 0.5 and 1.5: (0.5·1 + 1.5·5)/2 = 4.
        assert_eq!(values, [1.0, 4.0, 4.0, 4.0, 5.0, 4.0, -7.0, -7.0, -7.0]);
    }
}
