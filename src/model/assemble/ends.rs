//! Ends of the joints of a case that almost meet a line, with names: which were joined to it, and which rock holds.

use crate::contact::LawId;
use crate::geometry::ends::{EndChange, EndDistances, EndLine, NearEnd, join_ends};
use crate::geometry::{GeometryError, Point, TraceId, polygon, segment};
use crate::model::case::{Case, JointSet};

use super::joints::Joints;
use super::{law_of, points};

/// Ends that one message names.
const NAMED: usize = 5;
/// Default of `domain.extend_ends` over the diagonal of the box of the rock: 0.85 mm, 1/30 inch, on a section that
/// fills a sheet A4 (diagonal 364 mm). Maps show well-defined points this exactly (United States National Map Accuracy
/// Standards, 1947).
const JOIN_RATIO: f64 = 2.335e-3;
/// Default of `domain.near_ends` over the diagonal.
const NEAR_RATIO: f64 = 0.02;

/// An end of a joint in the rock, near the outline or another joint.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceEnd {
    /// Its trace.
    pub trace: usize,
    /// The joint: `joint[3]`, or the name of its set.
    pub name: String,
    /// Where it was drawn to end (m).
    pub place: Point,
    /// Distance (m) to the line.
    pub gap: f64,
    /// The line: `the outline`, or a joint.
    pub line: String,
    /// Where the way from the end to the line meets it (m).
    pub meets: Point,
    /// What became of the end.
    pub change: EndChange,
}

/// The distances of a case for ends, where the box of its rock has a diagonal (m): of the drawing alone, so that they
/// are the same for every mesh.
pub(super) fn distances(case: &Case, diagonal: f64, tolerance: f64) -> EndDistances {
    let join = case.domain.extend_ends.unwrap_or(JOIN_RATIO * diagonal);
    EndDistances { tolerance, join, list: case.domain.near_ends.unwrap_or(NEAR_RATIO * diagonal).max(join) }
}

/// Joins the ends of joints that almost meet a line to it; the list has those with others near a line, but for the ends
/// of sets whose traces are meant to end in the rock.
///
/// # Errors
/// Too many joints near each other.
pub(super) fn join(
    case: &Case,
    joints: &mut Joints,
    outlines: &[[Point; 2]],
    distances: &EndDistances,
    is_rock: impl Fn(Point) -> bool,
) -> Result<Vec<TraceEnd>, GeometryError> {
    let mut lines: Vec<&mut Vec<Point>> = joints.traces.iter_mut().map(|(points, _)| points).collect();
    let mut ends = join_ends(outlines, &mut lines, distances, is_rock)?;
    let tolerance = distances.tolerance;
    let is_listed = |end: &&NearEnd| end.change != EndChange::Kept || !ends_on_purpose(case, joints, end, tolerance);
    ends.retain(|end| is_listed(&end));
    if let Some(law) = case.domain.bridge_law.as_ref().and_then(|name| law_of(case, name)) {
        ends.iter_mut().for_each(|end| bridge(end, law, joints));
    }
    Ok(ends.iter().map(|end| named(end, |trace| name_in(case, &joints.set_start, &joints.bridges, trace))).collect())
}

/// An end with the names of its trace and of its line.
pub(super) fn named(end: &NearEnd, name: impl Fn(TraceId) -> String) -> TraceEnd {
    TraceEnd {
        trace: end.trace.index(),
        name: name(end.trace),
        place: end.place,
        gap: end.gap,
        line: match end.line {
            EndLine::Outline => "the outline".to_owned(),
            EndLine::Trace(trace) => name(trace),
        },
        meets: end.meets,
        change: end.change,
    }
}

/// Leads a rock bridge of a law from an end that stays in the rock to its line.
fn bridge(end: &mut NearEnd, law: LawId, joints: &mut Joints) {
    if end.change != EndChange::Kept {
        return;
    }
    end.change = EndChange::Bridged;
    let back = [end.meets, end.place];
    // Of two ends that face each other the first one has it already.
    if joints.bridges.iter().all(|&bridge| joints.traces[bridge].0 != back) {
        joints.bridges.push(joints.traces.len());
        joints.traces.push((vec![end.place, end.meets], law));
    }
}

/// The set of a trace, unless it is a joint of the case or a piece that a region with another law has parted.
fn set_of(set_start: &[usize], trace: TraceId) -> Option<usize> {
    set_start.windows(2).position(|range| (range[0]..range[1]).contains(&trace.index()))
}

/// Whether the set of a trace is meant to end in the rock, by its lengths or at its own region.
fn ends_on_purpose(case: &Case, joints: &Joints, end: &NearEnd, tolerance: f64) -> bool {
    let at_region = |set: &JointSet| {
        let region = points(set.region.as_deref().unwrap_or_default());
        polygon::sides(&region).any(|(a, b)| segment::distance(end.place, a, b) <= tolerance)
    };
    let is_short = |set: &JointSet| set.trace_length.is_some() || set.gap > 0.0 || at_region(set);
    set_of(&joints.set_start, end.trace).is_some_and(|set| is_short(&case.joint_sets[set]))
}

/// The name of a trace, where sets begin with some traces and bridges are others.
pub(super) fn name_in(case: &Case, set_start: &[usize], bridges: &[usize], trace: TraceId) -> String {
    if let Ok(bridge) = bridges.binary_search(&trace.index()) {
        return format!("rock bridge {bridge}");
    }
    set_of(set_start, trace).map_or_else(|| format!("joint[{}]", trace.index()), |set| case.joint_set_name(set))
}

/// The ends that were joined to a line, and those that rock holds, in a line of text each.
pub(super) fn notes(ends: &[TraceEnd], distances: &EndDistances) -> impl Iterator<Item = String> {
    joined(ends, distances.join).into_iter().chain(bridged(ends)).chain(kept(ends, distances.join))
}

fn joined(ends: &[TraceEnd], within: f64) -> Option<String> {
    let is_joined = |end: &&TraceEnd| matches!(end.change, EndChange::Extended | EndChange::Trimmed);
    let joined: Vec<&TraceEnd> = ends.iter().filter(is_joined).collect();
    let tell = |end: &&TraceEnd| {
        let verb = if end.change == EndChange::Extended { "extended" } else { "trimmed" };
        let TraceEnd { name, place, gap, line, .. } = end;
        format!("{name} at ({:.6}, {:.6}) m by {:.3} mm to {line} ({verb})", place.x, place.y, 1e3 * gap)
    };
    let ends = if joined.len() == 1 {
        "trace end that almost meets a line was"
    } else {
        "trace ends that almost meet a line were"
    };
    (!joined.is_empty()).then(|| {
        format!(
            "{} {ends} joined to it: {}; they lie within domain.extend_ends = {} m, and 0 keeps what is drawn",
            joined.len(),
            list(&joined, tell),
            metres(within)
        )
    })
}

fn bridged(ends: &[TraceEnd]) -> Option<String> {
    let bridged: Vec<&TraceEnd> = ends.iter().filter(|end| end.change == EndChange::Bridged).collect();
    let place = |end: &&TraceEnd| {
        let TraceEnd { name, place, gap, line, .. } = end;
        format!("{name} at ({:.6}, {:.6}) m by {gap:.3} m to {line}", place.x, place.y)
    };
    let ends = if bridged.len() == 1 {
        "trace end that stops in the rock has"
    } else {
        "trace ends that stop in the rock have"
    };
    (!bridged.is_empty()).then(|| {
        let places = list(&bridged, place);
        format!("{} {ends} a rock bridge of domain.bridge_law ahead: {places}", bridged.len())
    })
}

fn kept(ends: &[TraceEnd], within: f64) -> Option<String> {
    let kept: Vec<&TraceEnd> = ends.iter().filter(|end| end.change == EndChange::Kept).collect();
    let tell = |end: &&TraceEnd| {
        let TraceEnd { name, place, gap, line, .. } = end;
        let side = if line.starts_with("the") { "inside" } else { "before" };
        format!("{name} ends {gap:.3} m {side} {line} at ({:.6}, {:.6})", place.x, place.y)
    };
    let it = if kept.len() == 1 { "it" } else { "each" };
    (!kept.is_empty()).then(|| {
        format!(
            "{}: intact rock holds {it}, and the model cannot break it; draw joints that are to part the rock up to \
             the line, raise domain.extend_ends, here {} m, or give domain.bridge_law for rock that can break there",
            list(&kept, tell),
            metres(within)
        )
    })
}

/// A distance (m) to three digits.
fn metres(distance: f64) -> String {
    let decimals = if distance > 0.0 { (2.0 - libm::log10(distance).floor()).clamp(0.0, 9.0) } else { 0.0 };
    format!("{distance:.*}", decimals as usize)
}

fn list(ends: &[&TraceEnd], tell: impl Fn(&&TraceEnd) -> String) -> String {
    let named: Vec<String> = ends.iter().take(NAMED).map(tell).collect();
    let more = ends.len().saturating_sub(NAMED);
    named.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}
