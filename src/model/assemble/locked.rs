//! Ends of joints before which rock that yields is too short for the mesh.

use crate::geometry::ends::{EndDistances, EndLine, NearEnd, join_ends};
use crate::geometry::{Point, segment};
use crate::model::case::{Case, Invalid};

use super::Built;
use super::ends::{TraceEnd, name_in, named};
use super::geometry::Loops;

/// Elements over rock that yields between the end of a joint and another joint, below which it locks: no band of shear
/// forms in fewer.
const LOCKS: f64 = 2.0;

/// Ends of joints that stop so near to another joint that fewer than two elements of rock that yields lie between: the
/// rock would break there, and the mesh cannot follow it. Rock bridges ahead of an end part such rock; before the
/// outline it is open on one side.
///
/// # Errors
/// Too many joints near each other.
pub fn locked_ends(case: &Case, built: &Built) -> Result<Vec<TraceEnd>, Invalid> {
    if !case.yields() {
        return Ok(Vec::new());
    }
    let (model, mut traces) = (&built.model, built.traces.clone());
    let loops = Loops::read(case)?;
    let distances = EndDistances { tolerance: built.noding.tolerance, join: 0.0, list: LOCKS * case.mesh.size };
    let mut lines: Vec<&mut Vec<Point>> = traces.iter_mut().map(|(points, _)| points).collect();
    let ends = join_ends(&loops.sides(), &mut lines, &distances, |place| loops.hold(place));
    let ends = ends.map_err(|error| Invalid { key: "joint".to_owned(), message: error.to_string() })?;
    let yields = |end: &NearEnd| {
        let element = model.covers.element_at(end.place + (end.meets - end.place) * 0.5);
        element.is_some_and(|element| model.strength_of(element).is_some())
    };
    let shortest = |end: NearEnd| {
        let EndLine::Trace(trace) = end.line else { return None };
        let pairs = built.traces[trace.index()].0.windows(2).map(|pair| segment::foot(end.place, pair[0], pair[1]));
        let meets = pairs.min_by(|a, b| (a - end.place).norm().total_cmp(&(b - end.place).norm()))?;
        let gap = (meets - end.place).norm();
        (gap < distances.list).then_some(NearEnd { gap, meets, ..end })
    };
    let ends: Vec<NearEnd> = ends.into_iter().filter_map(shortest).filter(yields).collect();
    let bridges: Vec<usize> = built.bridges.iter().map(|bridge| bridge.trace).collect();
    Ok(ends.iter().map(|end| named(end, |trace| name_in(case, &built.set_start, &bridges, trace))).collect())
}
