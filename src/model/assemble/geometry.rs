//! Outline, joints, joint sets and mesh edges in one arrangement.

use crate::contact::LawId;
use crate::cover::{self, Crumb, CrumbRule, RegularMesh};
use crate::geometry::ends::EndDistances;
use crate::geometry::loops::{validate_holes, validate_loop};
use crate::geometry::{Arrangement, GeometryError, Label, Point, Segment, TraceId, arrange_within, polygon};
use crate::model::case::{Case, Invalid};

use super::cuts::Cut;
use super::ends::{self, TraceEnd};
use super::joints::{Joints, joints};
use super::memory::Demand;
use super::{BuildStage, points};

/// The arranged plane of a case.
pub(super) struct Plane {
    pub mesh: RegularMesh,
    pub arrangement: Arrangement,
    pub joints: Joints,
    /// Ends of joints near a line.
    pub ends: Vec<TraceEnd>,
    /// Distances within which they were joined and listed.
    pub distances: EndDistances,
    /// Blocks below the least area.
    pub crumbs: Vec<Crumb>,
}

fn invalid(key: &str) -> impl FnOnce(GeometryError) -> Invalid + '_ {
    move |error| Invalid { key: key.into(), message: error.to_string() }
}

/// Arranges outlines, joints, mesh and cuts of a case. Cuts come after all others, so that what was there before keeps
/// its place and its number.
pub(super) fn arrange_case(case: &Case, cuts: &[Cut], tell: &mut dyn FnMut(BuildStage)) -> Result<Plane, Invalid> {
    tell(BuildStage::Joints);
    let loops = Loops::read(case)?;
    let (low, high) = loops.bounds();
    let demand = Demand { case, low, high };
    demand.check_mesh()?;
    demand.check_sets()?;
    let mut joints = joints(case, low, high)?;
    demand.check_traces(&joints.traces)?;
    let tolerance = case.domain.snap_tolerance.unwrap_or(1e-6 * (high - low).norm());
    let angle = case.mesh.angle_deg.to_radians();
    let mesh = RegularMesh::new(case.mesh.size, angle, Point::from(case.mesh.origin), low, high);
    let arrange = |pieces: &mut dyn Iterator<Item = Segment>, cuts: &[Segment]| {
        let mut segments = loops.segments();
        segments.extend(pieces);
        segments.reserve(3 * RegularMesh::cell_estimate(case.mesh.size, low, high) as usize);
        segments.extend(mesh.segments(low, high));
        segments.extend(cuts);
        let arranged = arrange_within(&segments, tolerance, demand.edges_max());
        arranged.map_err(|error| demand.explain(&error))
    };
    // A fault of the cut itself is told of all pieces.
    if let Some(Ok(some)) = Demand::sample(&pieces(&joints.traces, 0)).map(|some| arrange(&mut some.copied(), &[])) {
        demand.check_sample(&some)?;
    }
    let distances = ends::distances(case, (high - low).norm(), tolerance);
    let ends = ends::join(case, &mut joints, &loops.sides(), &distances, |position| loops.hold(position));
    let ends = ends.map_err(|error| demand.explain(&error))?;
    let user_traces = joints.traces.len();
    let islands = loops.rock[1..].iter().map(|l| (l.iter().chain(&l[..1]).copied().collect(), joints.default_law));
    joints.traces.extend(islands);
    let uncut = pieces(&joints.traces, 0);
    let first_cut = joints.traces.len();
    joints.cracks.extend((first_cut..).zip(cuts).filter(|(_, cut)| cut.is_crack).map(|(trace, _)| trace));
    joints.traces.extend(cuts.iter().map(|cut| (cut.points.clone(), cut.law)));
    tell(BuildStage::Arrangement);
    let arrangement = arrange(&mut uncut.into_iter(), &pieces(&joints.traces[first_cut..], first_cut))?;
    Cut::check(cuts, &arrangement.report, first_cut)?;
    demand.check_edges(&arrangement)?;
    let joined = cover::join_crumbs(arrangement, CrumbRule::below(case.mesh.least_block()));
    let (mut arrangement, crumbs) = joined.map_err(|error| demand.explain(&error))?;
    let report = &mut arrangement.report;
    report.traces.truncate(user_traces);
    report.overlapping_traces.retain(|pair| pair.iter().all(|&t| t.index() < user_traces));
    Ok(Plane { mesh, arrangement, joints, ends, distances, crumbs })
}

/// The straight pieces of traces, of which the first has a number.
fn pieces(traces: &[(Vec<Point>, LawId)], first: usize) -> Vec<Segment> {
    let traces = TraceId::range(first..first + traces.len()).zip(traces);
    let of = |(trace, (points, _)): (TraceId, &(Vec<Point>, LawId))| -> Vec<Segment> {
        points.windows(2).map(|p| segment(p[0], p[1], 0, Some(trace))).collect()
    };
    traces.flat_map(of).collect()
}

fn segment(a: Point, b: Point, outline: i8, trace: Option<TraceId>) -> Segment {
    Segment { a, b, label: Label { outline, trace, mesh: None, mesh_reversed: false } }
}

/// Validated loops of rock (counter-clockwise) and holes.
pub(super) struct Loops {
    rock: Vec<Vec<Point>>,
    holes: Vec<Vec<Point>>,
}

impl Loops {
    pub fn read(case: &Case) -> Result<Self, Invalid> {
        let domain = &case.domain;
        let read = |key: &str, list: &[[f64; 2]]| validate_loop(&points(list), key).map_err(invalid(key));
        let outline = read("domain.outline", &domain.outline)?;
        let many = |name: &str, lists: &[Vec<[f64; 2]>]| -> Result<Vec<Vec<Point>>, Invalid> {
            lists.iter().enumerate().map(|(k, list)| read(&format!("domain.{name}[{k}]"), list)).collect()
        };
        let holes = many("holes", &domain.holes)?;
        let islands = many("islands", &domain.islands)?;
        validate_holes(&outline, &holes, &islands).map_err(invalid("domain"))?;
        Ok(Self { rock: std::iter::once(outline).chain(islands).collect(), holes })
    }

    fn bounds(&self) -> (Point, Point) {
        let all: Vec<Point> = self.rock.iter().flatten().copied().collect();
        polygon::bounds(&all)
    }

    /// Whether a point lies in the outline or beside it in an island, and in no hole.
    pub fn hold(&self, p: Point) -> bool {
        let within = |loops: &[Vec<Point>]| loops.iter().any(|l| polygon::contains(l, p));
        within(&self.rock) && !within(&self.holes)
    }

    /// The sides of all loops.
    pub fn sides(&self) -> Vec<[Point; 2]> {
        let loops = self.rock.iter().chain(&self.holes);
        loops.flat_map(|ring| polygon::sides(ring)).map(|(a, b)| [a, b]).collect()
    }

    fn segments(&self) -> Vec<Segment> {
        let directed = |loops: &[Vec<Point>], outline: i8| -> Vec<Segment> {
            loops.iter().flat_map(|l| polygon::sides(l).map(move |(a, b)| segment(a, b, outline, None))).collect()
        };
        let mut segments = directed(&self.rock, 1);
        segments.extend(directed(&self.holes, -1));
        segments
    }
}
