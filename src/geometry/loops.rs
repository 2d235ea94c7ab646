//! Checks of outlines, holes and islands before anything is built from them.
//!
//! Knows loops by the names that the user gave them, so that an error points to the input.

use super::grid::{CellGrid, Groups};
use super::polygon::{area, bounds, contains, overlap_area, sides};
use super::{GeometryError, Point, orientation};

/// A loop with less than this part of the squared size of its box has no area.
const AREA_RATIO_MIN: f64 = 1e-12;
/// Overlap of an island with rock, over the area of the island, that is taken as mere contact.
const OVERLAP_RATIO_MAX: f64 = 1e-9;

/// Returns a loop counter-clockwise and without repeated points, or says why it is none.
///
/// # Errors
/// A coordinate that is not finite, fewer than three points, no area, or a loop that crosses or touches itself.
pub fn validate_loop(points: &[Point], name: &str) -> Result<Vec<Point>, GeometryError> {
    if let Some(index) = points.iter().position(|p| !(p.x.is_finite() && p.y.is_finite())) {
        let p = points[index];
        return Err(GeometryError::NotFinite { what: format!("{name}: point"), index, x: p.x, y: p.y });
    }
    let mut corners = points.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 {
        return Err(GeometryError::TooFewPoints { name: name.into(), found: corners.len() });
    }
    let (low, high) = bounds(&corners);
    let (found, limit) = (area(&corners), AREA_RATIO_MIN * (high - low).norm_squared());
    if let Some(meeting) = meetings(&[&corners]).next() {
        return Err(GeometryError::SelfIntersection {
            name: name.into(),
            first: meeting.sides[0].1,
            second: meeting.sides[1].1,
            x: meeting.place.x,
            y: meeting.place.y,
        });
    }
    if found.abs() <= limit {
        return Err(GeometryError::NoArea { name: name.into(), area: found, limit });
    }
    if found < 0.0 {
        corners.reverse();
    }
    Ok(corners)
}

/// Checks valid loops against each other: holes lie inside the outline, apart from it and from each other; islands lie
/// inside holes or outside the outline. Islands may touch the outline, a hole or each other, but not overlap rock.
///
/// # Errors
/// A hole that meets another loop, lies outside the outline or inside another hole, or an island on rock.
pub fn validate_holes(outline: &[Point], holes: &[Vec<Point>], islands: &[Vec<Point>]) -> Result<(), GeometryError> {
    let rims: Vec<&[Point]> = std::iter::once(outline).chain(holes.iter().map(Vec::as_slice)).collect();
    let name = |k: usize| if k == 0 { "outline".to_string() } else { format!("hole {}", k - 1) };
    if let Some(meeting) = meetings(&rims).next() {
        let [first, second] = meeting.sides.map(|(rim, _)| name(rim));
        return Err(GeometryError::LoopsMeet { first, second, x: meeting.place.x, y: meeting.place.y });
    }
    for (k, hole) in holes.iter().enumerate() {
        let inside = |other: &[Point]| contains(other, hole[0]);
        let enclosing = (0..holes.len()).find(|&other| other != k && inside(&holes[other]));
        if !inside(outline) || enclosing.is_some() {
            let place = enclosing.map_or("outside the outline".into(), |other| format!("inside hole {other}"));
            return Err(GeometryError::HoleMisplaced { hole: k, place, x: hole[0].x, y: hole[0].y });
        }
    }
    islands.iter().enumerate().try_for_each(|(k, _)| check_island(outline, holes, islands, k))
}

/// Refuses an island that overlaps the rock of the outline or of an earlier island.
fn check_island(
    outline: &[Point],
    holes: &[Vec<Point>],
    islands: &[Vec<Point>],
    island: usize,
) -> Result<(), GeometryError> {
    let shape = &islands[island];
    let limit = OVERLAP_RATIO_MAX * area(shape).abs();
    let in_holes: f64 = holes.iter().map(|hole| overlap_area(hole, shape)).sum();
    let on_rock = std::iter::once(("the outline".to_string(), overlap_area(outline, shape) - in_holes));
    let earlier = islands[..island].iter().enumerate();
    let on_islands = earlier.map(|(k, other)| (format!("island {k}"), overlap_area(other, shape)));
    match on_rock.chain(on_islands).find(|(_, overlap)| *overlap > limit) {
        None => Ok(()),
        Some((other, overlap)) => {
            Err(GeometryError::IslandOnRock { island, other, overlap, limit, x: shape[0].x, y: shape[0].y })
        }
    }
}

/// Two sides that cross or touch where they should not.
struct Meeting {
    /// Loop and index of both sides.
    sides: [(usize, usize); 2],
    place: Point,
}

/// Side of a loop: loop, index, number of sides of that loop, ends.
#[derive(Clone, Copy)]
struct Side {
    rim: usize,
    index: usize,
    count: usize,
    a: Point,
    b: Point,
}

/// Lists where sides meet, common ends of neighbours apart; the work is about linear in the number of sides.
fn meetings(rims: &[&[Point]]) -> impl Iterator<Item = Meeting> {
    let number = |(rim, points): (usize, &&[Point])| {
        let count = points.len();
        sides(points).enumerate().map(move |(index, (a, b))| Side { rim, index, count, a, b }).collect::<Vec<_>>()
    };
    let all: Vec<Side> = rims.iter().enumerate().flat_map(number).collect();
    let extent = all.iter().map(|side| side.a.amax()).fold(0.0, f64::max);
    let radius = 1e-12 * extent.max(f64::MIN_POSITIVE * 1e20); // above round-off, far below a cell
    let ends = all.iter().map(|side| (side.a, side.b));
    let grid = CellGrid::for_edges(ends.clone(), 8.0 * radius);
    let cells = Groups::of_edges(&grid, ends, radius);
    (0..grid.len()).flat_map(move |cell| {
        let members = cells.get(cell);
        let pairs = members.iter().enumerate().flat_map(|(k, &i)| members[..k].iter().map(move |&j| (j, i)));
        let found = pairs.filter_map(|(i, j)| meeting(&all[i as usize], &all[j as usize]));
        found.collect::<Vec<_>>()
    })
}

fn meeting(e: &Side, f: &Side) -> Option<Meeting> {
    let follows = |p: &Side, q: &Side| p.rim == q.rim && (p.index + 1) % p.count == q.index;
    let place = if follows(e, f) {
        fold(e, f)
    } else if follows(f, e) {
        fold(f, e)
    } else {
        common_point(e, f)
    }?;
    Some(Meeting { sides: [(e.rim, e.index), (f.rim, f.index)], place })
}

/// Returns the common corner of two successive sides when the second runs back over the first.
fn fold(e: &Side, f: &Side) -> Option<Point> {
    (orientation(e.a, e.b, f.b) == 0.0 && (e.b - e.a).dot(&(f.b - f.a)) < 0.0).then_some(e.b)
}

/// Returns a point common to two sides, ends included, decided by exact signs.
fn common_point(e: &Side, f: &Side) -> Option<Point> {
    let on = |s: &Side, side: f64, p: Point| {
        let (low, high) = (s.a.inf(&s.b), s.a.sup(&s.b));
        side == 0.0 && p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y
    };
    let (fa, fb) = (orientation(e.a, e.b, f.a), orientation(e.a, e.b, f.b));
    let (ea, eb) = (orientation(f.a, f.b, e.a), orientation(f.a, f.b, e.b));
    let touching = [(on(e, fa, f.a), f.a), (on(e, fb, f.b), f.b), (on(f, ea, e.a), e.a), (on(f, eb, e.b), e.b)];
    if let Some((_, place)) = touching.iter().find(|(touches, _)| *touches) {
        return Some(*place);
    }
    let opposite = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
    (opposite(fa, fb) && opposite(ea, eb)).then(|| e.a + (e.b - e.a) * (ea / (ea - eb)))
}
