//! How much memory a model will take: estimated from the case before anything is cut, and counted while it is.
//!
//! Each refusal names the key that needs the most, its value, the limit and the remedy.

use std::f64::consts::{FRAC_2_PI, PI};

use crate::contact::{DetectionRule, LawId};
use crate::cover::RegularMesh;
use crate::geometry::grid::CellGrid;
use crate::geometry::{Arrangement, GeometryError, Point, Segment, Vector, polygon};
use crate::model::case::{Case, Invalid, JointSet};

use super::points;

/// Bytes that one lattice cell with its share of elements, covers and contacts needs at the peak of a build.
const BYTES_PER_CELL: f64 = 4000.0;
/// Bytes of a trace that cuts nothing.
const BYTES_PER_TRACE: f64 = 200.0;
/// Bytes that a crossing of traces, or of a trace with a mesh edge, adds: one element with its boundary on both sides.
const BYTES_PER_CROSSING: f64 = 2000.0;
/// Edges that a crossing adds to the arrangement.
const EDGES_PER_CROSSING: f64 = 2.0;
/// Bytes of a pair of node and edge that are near each other while a model runs: in the copies of the state, in the
/// search, and its share of contacts. Measured: 75 where one set of joints cuts the rock, 150 where two sets cross.
const BYTES_PER_PAIR: f64 = 150.0;
/// Most cells of the lattice along one axis and in its whole parallelogram: edges have numbers of 32 bits.
const CELLS_MAX: [f64; 2] = [1e9, u32::MAX as f64 / 3.0];
/// Most pieces of traces that are cut for a first look.
const SAMPLE: usize = 1100;
/// How many times more than the limit a first look must find to refuse a case: where a bundle of joints is drawn into
/// one line, a part of it may have some more sides near each other than all (measured: 1.07 times).
const FLOOD: f64 = 1.25;
/// Limit over the estimate at a spacing that the remedy names, so that it suffices.
const ROOM: f64 = 2.0;
/// Step of the search for such a spacing.
const WIDER: f64 = 1.1;

/// Sizes that a case demands, and the box of its rock (m).
pub(super) struct Demand<'a> {
    pub case: &'a Case,
    pub low: Point,
    pub high: Point,
}

/// Traces of joints or joint sets, and how often they cross mesh edges and each other, about.
#[derive(Debug, Clone, Copy, Default)]
struct Crossings {
    traces: f64,
    mesh: f64,
    mutual: f64,
}

impl Crossings {
    /// The same at spacings that are wider by a factor.
    fn at(&self, wider: f64) -> Self {
        Self { traces: self.traces / wider, mesh: self.mesh / wider, mutual: self.mutual / (wider * wider) }
    }

    fn count(&self) -> f64 {
        self.mesh + self.mutual
    }

    /// Pieces of the traces: a crossing with another trace cuts both.
    fn pieces(&self) -> f64 {
        self.mesh + 2.0 * self.mutual
    }
}

/// Sides of blocks near each other.
#[derive(Debug, Clone, Copy, Default)]
struct Near {
    /// Pairs of a side and one near it.
    pairs: f64,
    /// Most sides near one position, and the position (m).
    densest: (f64, Point),
}

/// A joint set before its traces are made.
struct SetDemand {
    /// Box of its region within that of the rock (m).
    low: Point,
    high: Point,
    /// Area that it cuts (m²).
    area: f64,
    /// Length of traces per area (1/m).
    density: f64,
    dip: f64,
    traces: f64,
}

impl Demand<'_> {
    fn limit(&self) -> f64 {
        self.case.solver.memory_limit as f64
    }

    fn size(&self) -> f64 {
        self.case.mesh.size
    }

    /// Most edges that an arrangement may have.
    pub fn edges_max(&self) -> usize {
        (self.limit() * EDGES_PER_CROSSING / BYTES_PER_CROSSING) as usize
    }

    /// Refuses a mesh that is too fine for the memory, or whose nodes have numbers beyond all counting.
    pub fn check_mesh(&self) -> Result<(), Invalid> {
        let mesh = &self.case.mesh;
        let (bytes, limit) = (self.lattice_bytes(), self.limit());
        if bytes > limit {
            let size = mesh.size * (bytes / limit).sqrt();
            let message = format!(
                "{} m makes a model of about {:.1} GB, above the limit of {:.1} GB: use a size above {size:.3} m or \
                 raise solver.memory_limit",
                mesh.size,
                bytes / 1e9,
                limit / 1e9
            );
            return Err(Invalid { key: "mesh.size".into(), message });
        }
        let angle = mesh.angle_deg.to_radians();
        let [farthest, cells] = RegularMesh::numbers(mesh.size, angle, Point::from(mesh.origin), self.low, self.high);
        if farthest > CELLS_MAX[0] {
            let message = format!(
                "({}, {}) m lies {farthest:.1e} mesh sizes away from the rock, at most {:.0e} can be counted: use an \
                 origin near the rock",
                mesh.origin[0], mesh.origin[1], CELLS_MAX[0]
            );
            return Err(Invalid { key: "mesh.origin".into(), message });
        }
        if cells > CELLS_MAX[1] {
            let message = format!(
                "{}° across so long a model makes a lattice of {cells:.1e} cells, at most {:.1e} can be counted: turn \
                 it along the model, or raise mesh.size",
                mesh.angle_deg, CELLS_MAX[1]
            );
            return Err(Invalid { key: "mesh.angle_deg".into(), message });
        }
        Ok(())
    }

    fn lattice_bytes(&self) -> f64 {
        RegularMesh::cell_estimate(self.size(), self.low, self.high) * BYTES_PER_CELL
    }

    /// Bytes of a model whose traces cut an area (m²) evenly.
    fn bytes(&self, crossings: &Crossings, area: f64) -> f64 {
        let pairs = self.pairs(2.0 * crossings.pieces(), area);
        let cut = crossings.traces * BYTES_PER_TRACE + crossings.count() * BYTES_PER_CROSSING;
        self.lattice_bytes() + cut + pairs * BYTES_PER_PAIR
    }

    /// Pairs of nodes and edges near each other, among as many spread evenly over an area (m²).
    fn pairs(&self, pieces: f64, area: f64) -> f64 {
        let cutoff = DetectionRule::default().cutoff * self.size();
        pieces * pieces / area.max(cutoff * cutoff) * PI * cutoff * cutoff
    }

    /// Refuses joint sets that are too dense, before their traces are made.
    pub fn check_sets(&self) -> Result<(), Invalid> {
        let sets: Vec<SetDemand> = self.case.joint_sets.iter().map(|set| self.set(set)).collect();
        let Some((most, of_most)) = sets.iter().enumerate().max_by(|a, b| a.1.cutting().total_cmp(&b.1.cutting()))
        else {
            return Ok(());
        };
        let (crossings, area) = self.crossings(&sets);
        let bytes = |wider: f64| self.bytes(&crossings.at(wider), area);
        if bytes(1.0) <= self.limit() {
            return Ok(());
        }
        let spacing = self.case.joint_sets[most].spacing;
        let wide = (of_most.area.sqrt() / spacing).max(1.0);
        let wider = std::iter::successors(Some(WIDER), |wider| Some(wider * WIDER)).take_while(|&wider| wider < wide);
        let remedy = wider.into_iter().find(|&wider| ROOM * bytes(wider) <= self.limit()).map_or_else(
            || "raise all spacings, or mesh.size,".to_owned(),
            |wider| format!("raise the spacings of all sets by {wider:.3}, here to {:.3e} m,", wider * spacing),
        );
        let message = format!(
            "{spacing:e} m makes about {:.1e} traces{}, a model of about {:.1e} GB, above the limit of {:.3} GB: \
             {remedy} or raise solver.memory_limit",
            of_most.traces,
            if sets.len() > 1 { " here, with the other sets" } else { "" },
            bytes(1.0) / 1e9,
            self.limit() / 1e9
        );
        Err(Invalid { key: format!("joint_set[{most}].spacing"), message })
    }

    fn set(&self, set: &JointSet) -> SetDemand {
        let box_points =
            vec![self.low, Point::new(self.high.x, self.low.y), self.high, Point::new(self.low.x, self.high.y)];
        let ring = set.region.as_ref().map_or(box_points, |ring| points(ring));
        let (low, high) = polygon::bounds(&ring);
        let whole = extent(low, high);
        let (low, high) = (low.sup(&self.low), high.inf(&self.high));
        let share = if whole > 0.0 { extent(low, high) / whole } else { 0.0 };
        let area = if set.region.is_some() { polygon::area(&ring).abs() } else { whole };
        let dip = set.angle();
        let across = |axis: Vector| {
            let positions = || ring.iter().map(move |p| p.dot(&axis));
            positions().fold(f64::NEG_INFINITY, f64::max) - positions().fold(f64::INFINITY, f64::min)
        };
        let in_line = set
            .trace_length
            .map_or(1.0, |length| (across(Vector::new(libm::cos(dip), libm::sin(dip))) / (length + set.gap)).max(1.0));
        let filled = set.trace_length.map_or(1.0, |length| length / (length + set.gap));
        let traces = across(Vector::new(-libm::sin(dip), libm::cos(dip))) / set.spacing * in_line;
        SetDemand { low, high, area: area * share, density: filled / set.spacing, dip, traces }
    }

    /// Crossings of all sets, and the area (m²) that they cut.
    fn crossings(&self, sets: &[SetDemand]) -> (Crossings, f64) {
        let mut sum = Crossings::default();
        for (k, set) in sets.iter().enumerate() {
            sum.traces += set.traces;
            sum.mesh += set.area * set.density * self.mesh_crossings();
            for other in &sets[..k] {
                let common = extent(set.low.sup(&other.low), set.high.inf(&other.high));
                let common = common.min(set.area).min(other.area);
                sum.mutual += common * set.density * other.density * libm::sin(set.dip - other.dip).abs();
            }
        }
        (sum, sets.iter().map(|set| set.area).sum::<f64>().min(extent(self.low, self.high)))
    }

    /// Mesh edges that a metre of a trace crosses: 2/π of the length of mesh edges per area.
    fn mesh_crossings(&self) -> f64 {
        FRAC_2_PI * 12f64.sqrt() / self.size()
    }

    /// The part of a piece of a trace in the box of the rock.
    fn within(&self, a: Point, b: Point) -> Option<[Point; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let along = b[axis] - a[axis];
            let [enters, leaves] = [self.low[axis] - a[axis], self.high[axis] - a[axis]].map(|to| to / along);
            if along != 0.0 {
                (from, to) = (from.max(enters.min(leaves)), to.min(enters.max(leaves)));
            } else if a[axis] < self.low[axis] || a[axis] > self.high[axis] {
                return None;
            }
        }
        (from < to && a != b).then(|| [from, to].map(|share| a + (b - a) * share))
    }

    /// Refuses traces that cross too many mesh edges.
    pub fn check_traces(&self, traces: &[(Vec<Point>, LawId)]) -> Result<(), Invalid> {
        let length = |points: &Vec<Point>| -> f64 {
            let pieces = points.windows(2).filter_map(|pair| self.within(pair[0], pair[1]));
            pieces.map(|[a, b]| (b - a).norm()).sum()
        };
        let length: f64 = traces.iter().map(|(points, _)| length(points)).sum();
        let crossings = Crossings { traces: traces.len() as f64, mesh: length * self.mesh_crossings(), mutual: 0.0 };
        let bytes = self.bytes(&Crossings { mesh: 0.0, ..crossings }, 1.0) + crossings.mesh * BYTES_PER_CROSSING;
        if bytes <= self.limit() {
            return Ok(());
        }
        Err(self.refuse(&format!(
            "{} traces of {length:.1e} m together make a model of about {:.1} GB",
            traces.len(),
            bytes / 1e9
        )))
    }

    /// A refusal by the key that has most of the length of traces: a joint set, the joints, or else the mesh.
    fn refuse(&self, what: &str) -> Invalid {
        let length = |list: &[[f64; 2]]| points(list).windows(2).map(|p| (p[1] - p[0]).norm()).sum::<f64>();
        let of_joints: f64 = self.case.joints.iter().map(|joint| length(&joint.points)).sum();
        let joints = ("joint".to_owned(), of_joints);
        let sets = self.case.joint_sets.iter().enumerate();
        let sets = sets.map(|(k, set)| (format!("joint_set[{k}].spacing"), self.set(set).cutting()));
        let most = sets.chain([joints]).max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, length)| *length > 0.0);
        let key = most.map_or_else(|| "mesh.size".to_owned(), |(key, _)| key);
        let remedy = match key.as_str() {
            "joint" => "take out traces, or raise mesh.size",
            "mesh.size" => "raise it",
            _ => "raise the spacing, or mesh.size",
        };
        let limit = self.limit() / 1e9;
        Invalid {
            key,
            message: format!("{what}, above the limit of {limit:.3} GB: {remedy}, or raise solver.memory_limit"),
        }
    }

    /// Message for an arrangement that fails.
    pub fn explain(&self, error: &GeometryError) -> Invalid {
        if matches!(error, GeometryError::TooManyPieces { .. }) {
            return self.refuse(&error.to_string());
        }
        // The numbers of the case are finite, so that another one is made here.
        let fault = if matches!(error, GeometryError::NotFinite { .. }) {
            ", though all that the case gives is finite: this is a fault of enmm, please report it with the case"
        } else {
            ""
        };
        Invalid { key: "domain".into(), message: format!("{error}{fault}") }
    }

    /// Of many pieces of traces some for a first look: when they alone are too close to each other, the others need not
    /// be cut.
    pub fn sample(pieces: &[Segment]) -> Option<impl Iterator<Item = &Segment>> {
        (pieces.len() > SAMPLE).then(|| pieces.iter().step_by(pieces.len().div_ceil(SAMPLE)))
    }

    /// Refuses an arrangement with blocks that are so small beside the mesh size that too many of their sides are near
    /// each other.
    pub fn check_edges(&self, arrangement: &Arrangement) -> Result<(), Invalid> {
        self.check_near(arrangement, 1.0)
    }

    /// The same of some pieces for a first look.
    pub fn check_sample(&self, arrangement: &Arrangement) -> Result<(), Invalid> {
        self.check_near(arrangement, FLOOD)
    }

    fn check_near(&self, arrangement: &Arrangement, limits: f64) -> Result<(), Invalid> {
        let Near { pairs, densest: (near, position) } = self.near(arrangement);
        let bytes = self.lattice_bytes() + pairs * BYTES_PER_PAIR;
        if bytes <= limits * self.limit() {
            return Ok(());
        }
        let message = format!(
            "{} m is so large beside the blocks that {near:.0} of their sides lie within a quarter of it round \
             ({:.6}, {:.6}) m: {pairs:.1e} pairs, a model of about {:.1} GB, above the limit of {:.3} GB: use a mesh \
             size like that of the blocks there, or fewer joints, or raise solver.memory_limit",
            self.size(),
            position.x,
            position.y,
            bytes / 1e9,
            self.limit() / 1e9
        );
        Err(Invalid { key: "mesh.size".into(), message })
    }

    /// How many sides of blocks lie near each other: two at the middle of each edge, with rock and nodes on both sides.
    fn near(&self, arrangement: &Arrangement) -> Near {
        let edges = arrangement.edges.iter().enumerate();
        let edges = edges
            .filter(|(k, edge)| edge.label.outline != 0 || edge.label.trace.is_some() && arrangement.in_rock(*k))
            .map(|(_, edge)| (arrangement.points[edge.a] + arrangement.points[edge.b]) * 0.5);
        let (positions, cutoff): (Vec<Point>, _) = (edges.collect(), DetectionRule::default().cutoff * self.size());
        let grid = CellGrid::new(self.low, self.high, cutoff);
        let mut counts = vec![0u32; grid.len()];
        positions.iter().for_each(|&p| counts[grid.cell_of(p)] += 1);
        let mut near = Near::default();
        for p in positions {
            let mut around = 0.0;
            grid.visit_square(p, cutoff, |cell| around += 2.0 * f64::from(counts[cell]));
            let here = around * PI * cutoff * cutoff / (9.0 * grid.area());
            near.pairs += 2.0 * here;
            near.densest = if here > near.densest.0 { (here, p) } else { near.densest };
        }
        near
    }
}

impl SetDemand {
    /// Length of its traces (m).
    fn cutting(&self) -> f64 {
        self.area * self.density
    }
}

/// Area of a box (m²); none when its ends have changed positions.
fn extent(low: Point, high: Point) -> f64 {
    let span = (high - low).sup(&Vector::zeros());
    span.x * span.y
}

#[cfg(test)]
mod tests;
