//! Outline, joints, joint sets and mesh edges in one arrangement.

use crate::contact::LawId;
use crate::cover::RegularMesh;
use crate::geometry::joint_set::{JointSetParameters, Spread, Turn, generate};
use crate::geometry::loops::{validate_holes, validate_loop};
use crate::geometry::trace::Stops;
use crate::geometry::{Arrangement, GeometryError, Label, Point, Segment, TraceId, arrange_within, polygon, trace};
use crate::model::case::{AngleDistribution, CUT_LAW, Case, Distribution, Invalid, JointSet, LawRegion};

use super::memory::Demand;
use super::{BuildStage, law_of, points};

/// The arranged plane of a case.
pub(super) struct Plane {
    pub mesh: RegularMesh,
    pub arrangement: Arrangement,
    pub joints: Joints,
}

/// The joints of a case.
pub(super) struct Joints {
    /// Joint traces with their laws: those of the case first, then the loops of islands, so that rock that touches
    /// stays apart.
    pub traces: Vec<(Vec<Point>, LawId)>,
    /// First trace of each joint set, and one past the last.
    pub set_start: Vec<usize>,
    pub default_law: LawId,
}

fn invalid(key: &str) -> impl FnOnce(GeometryError) -> Invalid + '_ {
    move |error| Invalid { key: key.into(), message: error.to_string() }
}

/// Arranges outlines, joints and mesh of a case.
pub(super) fn arrange_case(case: &Case, tell: &mut dyn FnMut(BuildStage)) -> Result<Plane, Invalid> {
    tell(BuildStage::Joints);
    let loops = Loops::read(case)?;
    let (low, high) = loops.bounds();
    let demand = Demand { case, low, high };
    demand.check_mesh()?;
    demand.check_sets()?;
    let default_law = case.default_joint_law().and_then(|name| law_of(case, name)).unwrap_or_default();
    let (mut traces, set_start) = traces(case, low, high, default_law)?;
    demand.check_traces(&traces)?;
    let user_traces = traces.len();
    let tolerance = case.domain.snap_tolerance.unwrap_or(1e-6 * (high - low).norm());
    let is_rock = |position| loops.hold(position);
    demand.check_dense(&traces, tolerance, is_rock)?;
    demand.check_crossings(&traces, tolerance, is_rock)?;
    let angle = case.mesh.angle_deg.to_radians();
    let mesh = RegularMesh::new(case.mesh.size, angle, Point::from(case.mesh.origin), low, high);
    let islands = loops.rock[1..].iter().map(|l| (l.iter().chain(&l[..1]).copied().collect(), default_law));
    traces.extend(islands);
    let mut segments = loops.segments();
    for (trace, (points, _)) in TraceId::all(traces.len()).zip(&traces) {
        segments.extend(points.windows(2).map(|p| segment(p[0], p[1], 0, Some(trace))));
    }
    segments.extend(mesh.segments(low, high));
    tell(BuildStage::Arrangement);
    let arranged = arrange_within(&segments, tolerance, demand.edges_max());
    let mut arrangement = arranged.map_err(|error| demand.explain(&error))?;
    demand.check_edges(&arrangement)?;
    let report = &mut arrangement.report;
    report.traces.truncate(user_traces);
    report.overlapping_traces.retain(|pair| pair.iter().all(|&t| t.index() < user_traces));
    Ok(Plane { mesh, arrangement, joints: Joints { traces, set_start, default_law } })
}

fn segment(a: Point, b: Point, outline: i8, trace: Option<TraceId>) -> Segment {
    Segment { a, b, label: Label { outline, trace, mesh: None, mesh_reversed: false } }
}

/// Validated loops of rock (counter-clockwise) and holes.
struct Loops {
    rock: Vec<Vec<Point>>,
    holes: Vec<Vec<Point>>,
}

impl Loops {
    fn read(case: &Case) -> Result<Self, Invalid> {
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
    fn hold(&self, p: Point) -> bool {
        let within = |loops: &[Vec<Point>]| loops.iter().any(|l| polygon::contains(l, p));
        within(&self.rock) && !within(&self.holes)
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

/// Joint traces with their laws.
type Traces = Vec<(Vec<Point>, LawId)>;

/// Joint traces of the case, then those of its sets, and where each set begins and the last ends.
fn traces(case: &Case, low: Point, high: Point, default_law: LawId) -> Result<(Traces, Vec<usize>), Invalid> {
    let law = |name: &Option<String>| name.as_ref().and_then(|name| law_of(case, name)).unwrap_or(default_law);
    let mut traces: Traces = case.joints.iter().map(|joint| (points(&joint.points), law(&joint.law))).collect();
    let box_points = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
    let mut set_start = vec![traces.len()];
    for (k, set) in case.joint_sets.iter().enumerate() {
        let region = set.region.as_ref().map_or(box_points.to_vec(), |r| points(r));
        let mut made = generate(&parameters(set), &region).map_err(invalid(&format!("joint_set[{k}]")))?;
        if let Some(end) = &set.ends_on {
            let range = case.joint_sets[..k].iter().position(|set| set.name.as_ref() == Some(end));
            let others = match range {
                Some(other) => &traces[set_start[other]..set_start[other + 1]],
                None => &traces[..],
            };
            let stopping = law_of(case, end).filter(|_| range.is_none());
            let lines = others.iter().filter(|(_, law)| stopping.is_none_or(|stopping| stopping == *law));
            let stops = Stops::new(lines.map(|(line, _)| line.as_slice()));
            made.iter_mut().for_each(|t| *t = stops.end(*t));
        }
        traces.extend(made.into_iter().map(|t| (t.to_vec(), law(&set.law))));
        set_start.push(traces.len());
    }
    for change in &case.law_regions {
        change_laws(case, change, &mut traces);
    }
    Ok((traces, set_start))
}

/// Gives joints in a region their other law; a joint that leaves the region is divided at its border, and all but its
/// first piece come after all others.
fn change_laws(case: &Case, change: &LawRegion, traces: &mut Traces) {
    let (region, Some(to)) = (points(&change.region), law_of(case, &change.to)) else { return };
    let from = change.from.as_ref().and_then(|name| law_of(case, name));
    let cut = law_of(case, CUT_LAW);
    let changes = |law: LawId| from.map_or(Some(law) != cut, |from| law == from);
    let mut more = Vec::new();
    for (line, law) in traces.iter_mut().filter(|(_, law)| changes(*law)) {
        let pieces = trace::divide(line, &region);
        if pieces.iter().all(|(_, inside)| !inside) {
            continue;
        }
        let of = |inside| if inside { to } else { *law };
        let mut pieces =
            pieces.into_iter().map(|(points, inside)| (points, of(inside))).collect::<Vec<_>>().into_iter();
        if let Some(first) = pieces.next() {
            (*line, *law) = first;
        }
        more.extend(pieces);
    }
    traces.extend(more);
}

fn parameters(set: &JointSet) -> JointSetParameters {
    JointSetParameters {
        dip: set.angle(),
        dip_sd: set.dip_sd_deg.to_radians(),
        turn: match set.angle_distribution {
            AngleDistribution::Normal => Turn::Normal,
            AngleDistribution::Uniform => Turn::Uniform,
            AngleDistribution::Fisher => Turn::Fisher {
                concentration: set.fisher_k.unwrap_or_default(),
                out_of_plane: set.out_of_section_deg.to_radians(),
            },
        },
        spacing: set.spacing,
        spacing_sd: set.spacing_sd,
        spacing_spread: spread(set.spacing_distribution),
        trace_length: set.trace_length,
        trace_length_sd: set.trace_length_sd,
        length_spread: spread(set.trace_length_distribution),
        gap: set.gap,
        seed: set.seed,
        origin: set.origin.map(Point::from),
    }
}

fn spread(distribution: Distribution) -> Spread {
    match distribution {
        Distribution::Normal => Spread::Normal,
        Distribution::Lognormal => Spread::Lognormal,
        Distribution::Exponential => Spread::Exponential,
        Distribution::Uniform => Spread::Uniform,
    }
}
