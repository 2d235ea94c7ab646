//! Rock bridges: which of them break as a whole, by the forces of their section, and which contact by contact (theory
//! §7).

use crate::contact::{EdgeId, JointLaw, Section, SectionId, Sections, Softening};
use crate::cover::BlockId;
use crate::geometry::{Point, TraceId, Vector, cross, segment};
use crate::mechanics::{Elasticity, bending_strength, crack_time};
use crate::model::case::{Breaks, Case, Integrator};
use crate::state::Model;

use super::joints::Joints;

/// Characteristic length of a bridge over its length up to which it breaks as a whole.
const BRITTLE: f64 = 4.0;
/// Round-off in places along a trace, over its length.
const ROUND_OFF: f64 = 1e-9;

/// How a rock bridge breaks, and why so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breaking {
    /// As a whole, by the forces of its section.
    BySection,
    /// Contact by contact: its law says so.
    Asked,
    /// Contact by contact: the law has no tensile strength.
    WithoutTension,
    /// Contact by contact: its characteristic length is more than four times its length.
    Soft,
    /// Contact by contact: rock beside it is less than half as deep as it is long, so that it is no section of a beam.
    Shallow,
    /// Contact by contact: its line turns back.
    TurnsBack,
}

/// The part of a rock bridge between two blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bridge {
    /// Its trace.
    pub trace: usize,
    /// Its middle (m).
    pub place: Point,
    /// Length (m).
    pub length: f64,
    /// Characteristic length E'·G_I/σt² (m); 0 of a brittle one.
    pub characteristic: f64,
    /// Strength in bending over tensile strength (Eq. 22g).
    pub bending: f64,
    /// How it breaks.
    pub breaking: Breaking,
}

/// A boundary edge on a bridge, from one place along the trace to another (m).
#[derive(Debug, Clone, Copy)]
struct Piece {
    edge: EdgeId,
    from: f64,
    to: f64,
}

/// Edges of both faces of a bridge, left and right, between two blocks.
#[derive(Debug, Clone)]
struct Run {
    blocks: [BlockId; 2],
    faces: [Vec<EdgeId>; 2],
    end: f64,
}

/// The rock bridges of a model. Sections of those that break as a whole and of rock that has broken go to the model.
pub(super) fn of_bridges(case: &Case, joints: &Joints, model: &mut Model) -> Vec<Bridge> {
    if joints.bridges.is_empty() && joints.cracks.is_empty() || case.solver.integrator == Integrator::Implicit {
        return Vec::new();
    }
    let beside = Beside::new(model, joints);
    let (mut bridges, mut sections) = (Vec::new(), Vec::new());
    let mut of_edge = vec![None; model.boundary.len()];
    for &trace in joints.bridges.iter().chain(&joints.cracks) {
        let is_crack = joints.cracks.binary_search(&trace).is_ok();
        let law = model.trace_law[trace];
        let (own, softening) = (&model.laws[law], model.laws[law].softening);
        let Some(softening) = softening else { continue };
        let asked = case.joint_laws.values().nth(law.index()).and_then(|law| law.breaks);
        for run in runs(model, TraceId::new(trace), &joints.traces[trace].0) {
            let line = run.line(model);
            let rock = beside.rock(run.blocks);
            let (bridge, crack_time) = bridge(trace, line, (own, softening), &rock);
            let breaking = match asked {
                _ if is_crack => Breaking::BySection,
                Some(Breaks::BySection) => Breaking::BySection,
                Some(Breaks::ByNode) => Breaking::Asked,
                None => breaking(own, &bridge, &run, line, model, &beside),
            };
            if breaking == Breaking::BySection {
                let id = SectionId::new(sections.len());
                run.faces.iter().flatten().for_each(|edge| of_edge[edge.index()] = Some(id));
                let (length, bending) = (bridge.length, bridge.bending);
                sections.push(Section { ends: run.ends(model), length, law, bending, crack_time });
            }
            if !is_crack {
                bridges.push(Bridge { breaking, ..bridge });
            }
        }
    }
    if !sections.is_empty() {
        model.sections = Sections { list: sections, of_edge };
    }
    bridges
}

/// A bridge along a line in a rock, and the time (s) that a crack takes across it.
fn bridge(
    trace: usize,
    [from, to]: [Point; 2],
    (law, softening): (&JointLaw, Softening),
    rock: &Elasticity,
) -> (Bridge, f64) {
    let length = (to - from).norm();
    let characteristic =
        if law.tension > 0.0 { 0.5 * rock.plane_modulus() * softening.opening / law.tension } else { 0.0 };
    let bending = bending_strength(length, characteristic);
    let place = from + (to - from) * 0.5;
    let bridge = Bridge { trace, place, length, characteristic, bending, breaking: Breaking::BySection };
    (bridge, crack_time(length, rock))
}

/// How a bridge breaks whose law does not say.
fn breaking(law: &JointLaw, bridge: &Bridge, run: &Run, line: [Point; 2], model: &Model, beside: &Beside) -> Breaking {
    let boundary = &model.boundary;
    let chord = line[1] - line[0];
    let way = |edge: EdgeId| boundary.reference[boundary.after(edge)] - boundary.reference[edge];
    if law.tension <= 0.0 {
        Breaking::WithoutTension
    } else if bridge.characteristic > BRITTLE * bridge.length {
        Breaking::Soft
    } else if run.faces[0].iter().any(|&edge| way(edge).dot(&chord) <= 0.0) {
        Breaking::TurnsBack
    } else if !beside.is_deep(model, run.blocks, bridge.place, chord) {
        Breaking::Shallow
    } else {
        Breaking::BySection
    }
}

/// The parts of a bridge between two blocks each, in the order of its line.
fn runs(model: &Model, trace: TraceId, line: &[Point]) -> Vec<Run> {
    let boundary = &model.boundary;
    let faces = faces(model, trace, line);
    let round_off = ROUND_OFF * line.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>();
    let (mut left, mut right) = (faces[0].iter().peekable(), faces[1].iter().peekable());
    let mut runs: Vec<Run> = Vec::new();
    while let (Some(&a), Some(&b)) = (left.peek().copied(), right.peek().copied()) {
        let (from, to) = (a.from.max(b.from), a.to.min(b.to));
        if to - from > round_off {
            let blocks = [a, b].map(|piece| boundary.block[piece.edge]);
            if runs.last().is_none_or(|run| run.blocks != blocks || from > run.end + round_off) {
                runs.push(Run { blocks, faces: Default::default(), end: to });
            }
            if let Some(run) = runs.last_mut() {
                run.end = to;
                for (face, piece) in run.faces.iter_mut().zip([a, b]) {
                    if face.last() != Some(&piece.edge) {
                        face.push(piece.edge);
                    }
                }
            }
        }
        if a.to <= to + round_off {
            left.next();
        }
        if b.to <= to + round_off {
            right.next();
        }
    }
    runs
}

/// Boundary edges on a trace by their places along it: those of rock to its left, which run along it, and those of rock
/// to its right.
fn faces(model: &Model, trace: TraceId, line: &[Point]) -> [Vec<Piece>; 2] {
    let boundary = &model.boundary;
    let mut faces: [Vec<Piece>; 2] = Default::default();
    for edge in boundary.edges().filter(|&edge| boundary.trace[edge] == Some(trace)) {
        let ends = [edge, boundary.after(edge)].map(|point| boundary.reference[point]);
        let middle = ends[0] + (ends[1] - ends[0]) * 0.5;
        let mut start = 0.0;
        let mut nearest = (f64::INFINITY, 0.0, Vector::zeros(), line[0]);
        for leg in line.windows(2).filter(|leg| leg[0] != leg[1]) {
            let distance = segment::distance(middle, leg[0], leg[1]);
            let way = leg[1] - leg[0];
            if distance < nearest.0 {
                nearest = (distance, start, way.normalize(), leg[0]);
            }
            start += way.norm();
        }
        let (_, start, along, at) = nearest;
        let [from, to] = ends.map(|end| start + (end - at).dot(&along));
        let face = usize::from(from > to);
        faces[face].push(Piece { edge, from: from.min(to), to: from.max(to) });
    }
    faces.iter_mut().for_each(|face| face.sort_by(|a, b| a.from.total_cmp(&b.from)));
    faces
}

impl Run {
    /// Boundary points of its ends.
    fn ends(&self, model: &Model) -> [EdgeId; 2] {
        let face = &self.faces[0];
        [face[0], model.boundary.after(face[face.len() - 1])]
    }

    fn line(&self, model: &Model) -> [Point; 2] {
        self.ends(model).map(|end| model.boundary.reference[end])
    }
}

/// Rock beside bridges.
struct Beside {
    /// The softest rock of each block.
    rock: Vec<Elasticity>,
    /// Edges of each block that are on no bridge.
    edges: Vec<Vec<EdgeId>>,
}

impl Beside {
    fn new(model: &Model, joints: &Joints) -> Self {
        let (covers, boundary) = (&model.covers, &model.boundary);
        let softest = |block: BlockId| {
            let rocks = covers.elements_of(block).map(|e| model.rocks[model.element_rock[e] as usize]);
            rocks.min_by(|a, b| a.mu.total_cmp(&b.mu))
        };
        let rock = covers.blocks().map(|block| softest(block).unwrap_or(model.rocks[0])).collect();
        let mut is_bridge = vec![false; model.trace_law.len()];
        joints.bridges.iter().for_each(|&trace| is_bridge[trace] = true);
        let mut edges = vec![Vec::new(); covers.block_count()];
        let is_open = |edge: &EdgeId| boundary.trace[*edge].is_none_or(|trace| !is_bridge[trace.index()]);
        for edge in boundary.edges().filter(is_open) {
            edges[boundary.block[edge].index()].push(edge);
        }
        Self { rock, edges }
    }

    /// The softer rock of two blocks.
    fn rock(&self, [a, b]: [BlockId; 2]) -> Elasticity {
        let [a, b] = [a, b].map(|block| self.rock[block.index()]);
        if a.mu <= b.mu { a } else { b }
    }

    /// Whether the rock on both sides of a chord is at its middle at least half as deep as it is long.
    fn is_deep(&self, model: &Model, blocks: [BlockId; 2], middle: Point, chord: Vector) -> bool {
        let left = Vector::new(-chord.y, chord.x) * 0.5;
        blocks.iter().zip([left, -left]).all(|(block, way)| {
            let boundary = &model.boundary;
            let is_met = |&edge: &EdgeId| {
                let [a, b] = [edge, boundary.after(edge)].map(|point| boundary.reference[point]);
                let is_left = |p: Point| cross(way, p - middle) > 0.0;
                let is_above = |p: Point| cross(b - a, p - a) > 0.0;
                is_left(a) != is_left(b) && is_above(middle) != is_above(middle + way)
            };
            !self.edges[block.index()].iter().any(is_met)
        })
    }
}
