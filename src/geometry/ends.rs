//! Ends of traces that almost meet a line: the outline of the rock or another trace.
//!
//! Knows polylines and distances (m); nothing of laws, blocks or the case. Rock that an end leaves uncut cannot break,
//! so that an end a millimetre short of a face holds a slope. Ends are treated in the order of the traces, each against
//! the lines as the ends before it have left them.

use std::collections::BTreeMap;

use super::grid::{CellGrid, Groups};
use super::work::Work;
use super::{GeometryError, Point, TraceId, Vector, cross, polygon, segment};

/// Lines that run back along a trace, by the cosine of their angle, are copies of it: they hold none of its ends.
const COPY_COSINE: f64 = 1.0 - 1e-6;

/// Comparisons of points that sorting a stretch near an end and measuring its distances take the time of.
const COMPARISONS: usize = 12;

/// Short stretches in a cell of the grid about the ends, where they lie evenly.
const STRETCHES_PER_CELL: f64 = 2.0;

/// Distances that decide what becomes of an end (m).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EndDistances {
    /// An end this near to a line is on it.
    pub tolerance: f64,
    /// An end nearer than this is extended or trimmed to the line.
    pub join: f64,
    /// An end nearer than this is listed.
    pub list: f64,
}

/// The line that an end almost meets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EndLine {
    /// Outline, hole or island.
    Outline,
    /// A trace.
    Trace(TraceId),
}

/// What became of an end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EndChange {
    /// The trace goes on to the line.
    Extended,
    /// The trace ends on the line that it crossed.
    Trimmed,
    /// The end stays in the rock.
    Kept,
    /// The end stays, and a rock bridge leads from it to the line.
    Bridged,
}

/// An end in the rock, near a line.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct NearEnd {
    /// The trace.
    pub trace: TraceId,
    /// Where the end was drawn (m).
    pub place: Point,
    /// Its distance (m) to the line: along the trace where that meets the line, else the shortest.
    pub gap: f64,
    /// The line.
    pub line: EndLine,
    /// Where the way to the line meets it (m).
    pub meets: Point,
    /// What became of it.
    pub change: EndChange,
}

/// Extends or trims the ends of traces that almost meet a line, and lists them with those that come near one; `is_rock`
/// judges places of ends.
///
/// # Errors
/// Too many lines near each other.
pub fn join_ends(
    outlines: &[[Point; 2]],
    traces: &mut [&mut Vec<Point>],
    distances: &EndDistances,
    is_rock: impl Fn(Point) -> bool,
) -> Result<Vec<NearEnd>, GeometryError> {
    traces.iter_mut().for_each(|points| part_ends(points, distances.tolerance));
    let mut lines = Lines::new(outlines, traces, distances);
    let mut ends = Vec::new();
    for trace in TraceId::all(traces.len()) {
        for last in [false, true] {
            let points = &mut *traces[trace.index()];
            let Some(end) = End::of(points, trace, last).filter(|end| is_rock(end.place)) else { continue };
            let Some((near, way)) = lines.look(&end, points)? else { continue };
            if near.change != EndChange::Kept {
                lines.replace(&end, &way);
                replace(points, last, &way);
            }
            ends.push(near);
        }
    }
    Ok(ends)
}

/// Takes out the points beside the ends of a trace that lie on them, within a tolerance (m): they give no direction.
fn part_ends(points: &mut Vec<Point>, tolerance: f64) {
    for _ in 0..2 {
        let Some((&end, others)) = points.split_first() else { return };
        let on_it = others.iter().take_while(|&other| (other - end).norm() <= tolerance).count();
        points.drain(1..1 + on_it.min(points.len().saturating_sub(2)));
        points.reverse();
    }
}

/// Replaces the first or the last point by those of a way that leads there.
fn replace(points: &mut Vec<Point>, last: bool, way: &[Point]) {
    if last {
        points.pop();
        points.extend(way);
    } else {
        points.splice(..1, way.iter().rev().copied());
    }
}

/// An end of a trace with its last straight stretch.
struct End {
    trace: TraceId,
    last: bool,
    place: Point,
    /// Start of the stretch.
    from: Point,
    /// Unit vector from there to the end.
    direction: Vector,
    /// Length of the stretch (m).
    length: f64,
    /// Length of the trace (m).
    whole: f64,
}

impl End {
    /// None where a trace has no length or returns to its start.
    fn of(points: &[Point], trace: TraceId, last: bool) -> Option<Self> {
        let n = points.len();
        let (place, from) =
            if last { (*points.last()?, *points.get(n.checked_sub(2)?)?) } else { (points[0], *points.get(1)?) };
        let along = place - from;
        let length = along.norm();
        let is_open = points[0] != points[n - 1];
        let whole = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        (is_open && length > 0.0).then(|| Self { trace, last, place, from, direction: along / length, length, whole })
    }

    /// Distance (m) from the end along its direction, negative backwards, at which its line meets a segment; the ends
    /// of the segment reach as far as the tolerance.
    fn meeting(&self, [c, d]: [Point; 2], tolerance: f64) -> Option<f64> {
        let along = d - c;
        let across = cross(self.direction, along);
        let share = cross(self.place - c, self.direction) / -across;
        let spare = tolerance / along.norm();
        let at = cross(c - self.place, along) / across;
        (share >= -spare && share <= 1.0 + spare && at.is_finite()).then_some(at)
    }

    /// Whether its last stretch crosses another.
    fn crosses(&self, other: &Stretch, tolerance: f64) -> bool {
        self.meeting(other.ends, tolerance).is_some_and(|at| at <= 0.0 && -at <= self.length)
    }
}

/// A straight stretch of a line.
#[derive(Clone, Copy)]
struct Stretch {
    ends: [Point; 2],
    line: EndLine,
}

/// All lines in a grid, as the ends before have left them.
struct Lines {
    stretches: Vec<Stretch>,
    /// First and last stretch of each trace.
    outermost: Vec<[u32; 2]>,
    grid: CellGrid,
    near: Groups,
    /// Stretches that came later, by cells.
    added: BTreeMap<usize, Vec<u32>>,
    distances: EndDistances,
    work: Work,
}

/// The nearest meetings of the line of an end with others, ahead and behind, and what lies nearest to it.
#[derive(Default)]
struct Found {
    ahead: Option<(f64, EndLine)>,
    behind: Option<(f64, EndLine)>,
    beside: Option<(f64, EndLine, Point)>,
    /// The nearest corner of the outline within the distance that ends are joined over, where the outline lies beside.
    corner: Option<(f64, Point)>,
}

impl Lines {
    fn new(outlines: &[[Point; 2]], traces: &[&mut Vec<Point>], distances: &EndDistances) -> Self {
        let mut stretches: Vec<Stretch> =
            outlines.iter().map(|&ends| Stretch { ends, line: EndLine::Outline }).collect();
        let mut outermost = Vec::with_capacity(traces.len());
        for (trace, points) in TraceId::all(traces.len()).zip(traces) {
            let first = stretches.len() as u32;
            let line = EndLine::Trace(trace);
            stretches.extend(points.windows(2).map(|pair| Stretch { ends: [pair[0], pair[1]], line }));
            outermost.push([first, (stretches.len() as u32).saturating_sub(1)]);
        }
        let ends = stretches.iter().map(|stretch| (stretch.ends[0], stretch.ends[1]));
        let (low, high) = polygon::bounds(outlines.as_flattened());
        let area = (high - low).product().max(distances.tolerance.powi(2));
        let grid = CellGrid::new(low, high, (STRETCHES_PER_CELL * area / stretches.len() as f64).sqrt());
        let near = Groups::of_edges(&grid, ends, distances.tolerance);
        let work = Work::for_lines(stretches.len());
        Self { stretches, outermost, grid, near, added: BTreeMap::new(), distances: *distances, work }
    }

    /// What becomes of an end of a trace through some points, and those that take its place; nothing where it is on a
    /// line, or far from all.
    ///
    /// # Errors
    /// Too many lines near each other.
    fn look(&mut self, end: &End, points: &[Point]) -> Result<Option<(NearEnd, Vec<Point>)>, GeometryError> {
        Ok(self.find(end, points)?.and_then(|found| self.judge(end, found)))
    }

    fn judge(&self, end: &End, Found { ahead, behind, beside, corner }: Found) -> Option<(NearEnd, Vec<Point>)> {
        let EndDistances { join, list, .. } = self.distances;
        let join = join.min(0.5 * end.whole);
        let near = |gap, line, meets, change| NearEnd { trace: end.trace, place: end.place, gap, line, meets, change };
        let along = |gap: f64| end.place + end.direction * gap;
        let gap = |found: Option<(f64, EndLine)>| found.map_or(f64::INFINITY, |(gap, _)| gap);
        let is_overshoot = gap(behind) <= gap(ahead);
        if let Some((gap, line)) = behind.filter(|(gap, _)| *gap < join && is_overshoot) {
            return Some((near(gap, line, along(-gap), EndChange::Trimmed), vec![along(-gap)]));
        }
        // A plane that daylights at the toe ends there, on whichever side of it the drawing has its end.
        let corner = corner.filter(|(distance, _)| *distance < join.min(gap(ahead)));
        let at_corner = corner.map(|(distance, place)| (distance, EndLine::Outline, place));
        let beside = at_corner.or(beside).filter(|(beside, ..)| *beside < list);
        let is_near = beside.is_some_and(|(beside, ..)| beside < join);
        let goes_there = |line: EndLine| is_near && beside.is_some_and(|(_, other, _)| other == line);
        let is_ahead = |(gap, line): &(f64, EndLine)| *gap < join || *gap < list && goes_there(*line);
        if let Some((gap, line)) = ahead.filter(|ahead| at_corner.is_none() && is_ahead(ahead)) {
            return Some((near(gap, line, along(gap), EndChange::Extended), vec![along(gap)]));
        }
        if let Some((beside, line, foot)) = beside.filter(|_| is_near) {
            // The stretch bends behind its last meeting, so that all its meetings stay where they are.
            let free = gap(behind).min(list);
            let bend = (free < end.length).then(|| end.place - end.direction * free);
            return Some((near(beside, line, foot, EndChange::Extended), bend.into_iter().chain([foot]).collect()));
        }
        let ahead = ahead.map(|(gap, line)| (gap, line, along(gap)));
        let nearest = ahead.or(beside).filter(|(gap, ..)| *gap < list);
        nearest.map(|(gap, line, meets)| (near(gap, line, meets, EndChange::Kept), Vec::new()))
    }

    /// The lines about an end of a trace through some points; nothing where it is on one.
    fn find(&self, end: &End, points: &[Point]) -> Result<Option<Found>, GeometryError> {
        let EndDistances { tolerance, list, .. } = self.distances;
        let mut found = Found::default();
        let mut crossed = Vec::new();
        for stretch in &self.on_the_way(end, points)? {
            let Some(at) = end.meeting(stretch.ends, tolerance) else { continue };
            if at > 0.0 {
                found.ahead = nearer(found.ahead, (at, stretch.line));
            } else if -at <= end.length.min(list) {
                found.behind = nearer(found.behind, (-at, stretch.line));
                crossed.push(stretch.line);
            }
        }
        // Twice as far until the nearest line is certain: the work hangs on how close lines lie, not on the distances.
        let mut reach = self.grid.area().sqrt().clamp(tolerance, list.max(tolerance));
        loop {
            let mut about = self.about(end, points, reach)?;
            if about.iter().any(|stretch| stretch.distance(end.place) <= tolerance) {
                return Ok(None);
            }
            // A line that the trace has crossed there holds it already, however near it runs to the end.
            about.retain(|stretch| !crossed.contains(&stretch.line) && !end.crosses(stretch, tolerance));
            found.beside = beside(end, &about);
            if reach >= list || found.beside.is_some_and(|(distance, ..)| distance <= reach) {
                if let Some((_, EndLine::Outline, _)) = found.beside {
                    found.corner = self.corner(end, points)?;
                }
                return Ok(Some(found));
            }
            reach = (2.0 * reach).min(list);
        }
    }

    /// The corner of the outline nearest to an end of a trace through some points, with its distance (m).
    fn corner(&self, end: &End, points: &[Point]) -> Result<Option<(f64, Point)>, GeometryError> {
        let about = self.about(end, points, self.distances.join)?;
        let outlines = about.iter().filter(|stretch| stretch.line == EndLine::Outline);
        let corners = outlines.flat_map(|stretch| stretch.ends).map(|corner| ((corner - end.place).norm(), corner));
        Ok(corners.min_by(|a, b| a.0.total_cmp(&b.0)))
    }

    /// Stretches of other lines along the last stretch of a trace and ahead of it.
    fn on_the_way(&self, end: &End, points: &[Point]) -> Result<Vec<Stretch>, GeometryError> {
        let EndDistances { tolerance, list, .. } = self.distances;
        let at = |distance: f64| end.place + end.direction * distance;
        let mut near = Vec::new();
        let visit = |cell| self.put(cell, &mut near);
        self.grid.visit_edge(at(-end.length.min(list)), at(list), tolerance, visit);
        self.others(near, end, points)
    }

    /// Stretches of other lines in the cells within a distance (m) of an end.
    fn about(&self, end: &End, points: &[Point], reach: f64) -> Result<Vec<Stretch>, GeometryError> {
        let mut near = Vec::new();
        self.grid.visit_square(end.place, reach, |cell| self.put(cell, &mut near));
        self.others(near, end, points)
    }

    /// Adds the stretches of a cell to a list.
    fn put(&self, cell: usize, near: &mut Vec<u32>) {
        near.extend(self.near.get(cell));
        near.extend(self.added.get(&cell).into_iter().flatten());
    }

    /// Those of some stretches that are of other lines near an end, once each.
    fn others(&self, mut near: Vec<u32>, end: &End, points: &[Point]) -> Result<Vec<Stretch>, GeometryError> {
        let EndDistances { tolerance, list, .. } = self.distances;
        self.work.take(COMPARISONS * near.len(), end.place)?;
        near.sort_unstable();
        near.dedup();
        let is_other = |stretch: &Stretch| match stretch.line {
            EndLine::Trace(trace) if trace == end.trace => stretch.is_far_along(end, points, list),
            _ => stretch.distance(end.place) < list && !stretch.is_copy(end, tolerance),
        };
        Ok(near.iter().map(|&k| self.stretches[k as usize]).filter(is_other).collect())
    }

    /// Lets the trace of an end go the way instead.
    fn replace(&mut self, end: &End, way: &[Point]) {
        let line = EndLine::Trace(end.trace);
        let old = self.outermost[end.trace][usize::from(end.last)];
        let mut from = end.from;
        for (k, &to) in way.iter().enumerate() {
            let new = if k == 0 { old } else { self.stretches.len() as u32 };
            if k > 0 {
                self.stretches.push(Stretch { ends: [from, to], line });
            }
            self.stretches[new as usize].ends = [from, to];
            self.outermost[end.trace][usize::from(end.last)] = new;
            let added = &mut self.added;
            self.grid.visit_edge(from, to, self.distances.tolerance, |cell| added.entry(cell).or_default().push(new));
            from = to;
        }
    }
}

impl Stretch {
    fn distance(&self, p: Point) -> f64 {
        segment::distance(p, self.ends[0], self.ends[1])
    }

    /// The point of it nearest to another.
    fn foot(&self, p: Point) -> Point {
        segment::foot(p, self.ends[0], self.ends[1])
    }

    /// Whether it is part of the trace of an end, near the end, and farther than that from it along the trace.
    fn is_far_along(&self, end: &End, points: &[Point], list: f64) -> bool {
        let mut back = 0.0;
        let mut farther = |pair: [Point; 2]| {
            let is_it = pair == self.ends || [pair[1], pair[0]] == self.ends;
            let starts = back;
            back += (pair[1] - pair[0]).norm();
            is_it && starts > list
        };
        if self.distance(end.place) >= list {
            return false;
        }
        let mut pairs = points.windows(2).map(|pair| [pair[0], pair[1]]);
        if end.last { pairs.rev().any(&mut farther) } else { pairs.any(&mut farther) }
    }

    /// Whether it ends where the end lies and runs back along its trace.
    fn is_copy(&self, end: &End, tolerance: f64) -> bool {
        let [a, b] = self.ends;
        let back = |from: Point, to: Point| {
            (from - end.place).norm() <= tolerance
                && (to - from).dot(&end.direction) < -COPY_COSINE * (to - from).norm()
        };
        self.line != EndLine::Outline && (back(a, b) || back(b, a))
    }
}

/// The nearest of some stretches to an end, the first of equal ones.
fn beside(end: &End, about: &[Stretch]) -> Option<(f64, EndLine, Point)> {
    let nearest = about.iter().map(|stretch| (stretch.distance(end.place), stretch));
    let (distance, stretch) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((distance, stretch.line, stretch.foot(end.place)))
}

fn nearer(found: Option<(f64, EndLine)>, other: (f64, EndLine)) -> Option<(f64, EndLine)> {
    Some(found.filter(|found| found.0 <= other.0).unwrap_or(other))
}
