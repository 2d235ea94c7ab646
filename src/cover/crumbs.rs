//! Blocks too small to stand alone: each joins the neighbour across its shortest joint. Across a long one, such as the
//! fault on which a slope slides, it would stay behind as a lip that holds the rock above.

use std::collections::BTreeMap;

use crate::geometry::{Arrangement, FaceId, GeometryError, HalfEdgeId, Point, TraceId, polygon};

use super::outlines::mesh_only;
use super::union_find::UnionFind;

/// Which blocks are crumbs, and what they join.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrumbRule {
    /// Area (m²) below which a block is a crumb.
    pub least: f64,
    /// Share of the longest face of a crumb below which another face holds it too loosely.
    pub face_share: f64,
}

impl CrumbRule {
    /// The rule for a least area (m²).
    pub fn below(least: f64) -> Self {
        Self { least, face_share: 0.25 }
    }
}

/// A block below the least area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crumb {
    /// Its area (m²).
    pub area: f64,
    /// Its centroid (m).
    pub place: Point,
    /// Whether it has joined a neighbour; a crumb that touches no other rock cannot.
    pub joined: bool,
}

/// Lets blocks below the least area join a neighbour, the smallest first: the joint between them is no longer there.
/// All other joints stay as they are.
///
/// # Errors
/// Those of an arrangement.
pub fn join_crumbs(arrangement: Arrangement, rule: CrumbRule) -> Result<(Arrangement, Vec<Crumb>), GeometryError> {
    let blocks = Blocks::of(&arrangement);
    let small = blocks.below(rule.least);
    if small.is_empty() {
        return Ok((arrangement, Vec::new()));
    }
    let mut joined = Joined::new(&arrangement, &blocks);
    let mut crumbs = Vec::with_capacity(small.len());
    for block in small {
        let Block { area, first } = blocks.all[&block];
        crumbs.push(Crumb { area, place: first / area, joined: joined.grow(block, rule) });
    }
    let roots = joined.sets.roots();
    let parts_one_block =
        |edge: usize| blocks.beside(&arrangement, edge).is_some_and(|[a, b]| a != b && roots[a] == roots[b]);
    let dissolved: Vec<bool> = (0..arrangement.edges.len()).map(parts_one_block).collect();
    Ok((arrangement.without_traces(&dissolved)?, crumbs))
}

/// Area (m²) and first moment (m³) of a block.
#[derive(Clone, Copy)]
struct Block {
    area: f64,
    first: Point,
}

/// Blocks by the least of their faces.
struct Blocks {
    of_face: Vec<FaceId>,
    all: BTreeMap<FaceId, Block>,
}

impl Blocks {
    /// Faces of rock hang together across edges of the mesh.
    fn of(arrangement: &Arrangement) -> Self {
        let faces = || FaceId::all(arrangement.faces.len());
        let is_rock = |face: FaceId| arrangement.faces[face].winding == 1;
        let mut sets = UnionFind::new(faces());
        for (k, _) in arrangement.edges.iter().enumerate().filter(|(_, edge)| mesh_only(&edge.label)) {
            let [a, b] = HalfEdgeId::both(k).map(|h| arrangement.face[h]);
            if is_rock(a) && is_rock(b) {
                sets.join(a, b);
            }
        }
        let of_face = sets.roots();
        let mut all = BTreeMap::new();
        for face in faces().filter(|&face| is_rock(face)) {
            let loops = arrangement.face_loops(face).map(|h| arrangement.loop_points(h));
            let moments = loops.map(|points| polygon::Moments::of(&points, Point::zeros())).reduce(|a, b| a + b);
            let Some(moments) = moments else { continue };
            let block = all.entry(of_face[face]).or_insert(Block { area: 0.0, first: Point::zeros() });
            block.area += moments.area;
            block.first += moments.first;
        }
        Self { of_face, all }
    }

    /// Blocks with less than an area (m²), the smallest first.
    fn below(&self, least: f64) -> Vec<FaceId> {
        let mut small: Vec<FaceId> = self.all.keys().copied().filter(|block| self.all[block].area < least).collect();
        small.sort_by(|a, b| self.all[a].area.total_cmp(&self.all[b].area).then(a.cmp(b)));
        small
    }

    /// The blocks on both sides of an edge of a trace in the rock.
    fn beside(&self, arrangement: &Arrangement, edge: usize) -> Option<[FaceId; 2]> {
        let label = &arrangement.edges[edge].label;
        let is_joint = label.trace.is_some() && label.outline == 0;
        let blocks = HalfEdgeId::both(edge).map(|h| self.of_face[arrangement.face[h]]);
        (is_joint && blocks.iter().all(|block| self.all.contains_key(block))).then_some(blocks)
    }
}

/// Blocks that have joined, by the least face of each.
struct Joined {
    sets: UnionFind<FaceId>,
    area: BTreeMap<FaceId, f64>,
    /// Neighbours of each, with a face that they share.
    faces: BTreeMap<FaceId, Vec<(FaceId, Face)>>,
}

/// A face between two blocks.
#[derive(Clone, Copy, Default)]
struct Face {
    /// Its length (m).
    length: f64,
    /// Length (m) of the joint that it is a part of, the longest of them.
    joint: f64,
}

impl Face {
    fn and(self, other: Self) -> Self {
        Self { length: self.length + other.length, joint: self.joint.max(other.joint) }
    }
}

impl Joined {
    fn new(arrangement: &Arrangement, blocks: &Blocks) -> Self {
        let mut joints: BTreeMap<Option<TraceId>, f64> = BTreeMap::new();
        let mut parting = Vec::new();
        for (k, edge) in arrangement.edges.iter().enumerate() {
            let Some(beside) = blocks.beside(arrangement, k).filter(|[a, b]| a != b) else { continue };
            let length = (arrangement.points[edge.b] - arrangement.points[edge.a]).norm();
            *joints.entry(edge.label.trace).or_default() += length;
            parting.push((beside, length, edge.label.trace));
        }
        let mut faces: BTreeMap<FaceId, Vec<(FaceId, Face)>> = BTreeMap::new();
        for ([a, b], length, trace) in parting {
            let face = Face { length, joint: joints[&trace] };
            faces.entry(a).or_default().push((b, face));
            faces.entry(b).or_default().push((a, face));
        }
        Self {
            sets: UnionFind::new(FaceId::all(arrangement.faces.len())),
            area: blocks.all.iter().map(|(&block, found)| (block, found.area)).collect(),
            faces,
        }
    }

    /// Lets a block join the neighbour across the shortest joint, of equal ones along the longest face, unless it has
    /// the least area, alone or by what has joined it; returns whether it is part of a larger block now.
    fn grow(&mut self, block: FaceId, rule: CrumbRule) -> bool {
        let own = self.sets.root(block);
        if self.area[&own] >= rule.least {
            return true;
        }
        let mut shared: BTreeMap<FaceId, Face> = BTreeMap::new();
        for (neighbour, face) in self.faces.get(&own).cloned().unwrap_or_default() {
            let neighbour = self.sets.root(neighbour);
            if neighbour != own {
                let all = shared.entry(neighbour).or_default();
                *all = all.and(face);
            }
        }
        let longest = shared.values().map(|face| face.length).fold(0.0, f64::max);
        shared.retain(|_, face| face.length >= rule.face_share * longest);
        let shorter = |a: &Face, b: &Face| a.joint.total_cmp(&b.joint).then(b.length.total_cmp(&a.length));
        let Some((&other, _)) = shared.iter().min_by(|a, b| shorter(a.1, b.1).then(a.0.cmp(b.0))) else {
            return false;
        };
        let area = self.area[&own] + self.area[&other];
        let faces = [own, other].map(|block| self.faces.remove(&block).unwrap_or_default()).concat();
        self.sets.join(own, other);
        let root = self.sets.root(own);
        self.area.insert(root, area);
        self.faces.insert(root, faces);
        true
    }
}
