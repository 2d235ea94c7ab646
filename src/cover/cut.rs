//! Cuts mathematical covers into physical covers, manifold elements and blocks.

use crate::geometry::{Arrangement, FaceId, HalfEdgeId, Point, Vector, id, polygon};

use super::covers::{BlockRanges, Covers, Polygons};
use super::host::hosts;
use super::mesh::{RegularMesh, Triangle};
use super::order::{self, hilbert};
use super::outlines::{Outlines, mesh_only};
use super::union_find::UnionFind;
use super::{BlockId, CoverId, ElementId};

/// Cuts the covers of `mesh` by the outlines and joints that are arranged with its edges; the loops round the blocks
/// come with them.
pub fn cut(mesh: RegularMesh, arrangement: Arrangement) -> (Covers, Outlines) {
    let raw = RawElements::collect(&mesh, &arrangement);
    let joined = Joined::new(&arrangement, &raw);
    let blocks = order_blocks(&raw, &joined);
    let mut covers = lay_out_elements(mesh, &raw, &blocks);
    let slot_cover = lay_out_covers(&mut covers, &raw, &joined, &blocks);
    for (new, old) in blocks.order.iter().enumerate() {
        covers.element_covers[new] = [0, 1, 2].map(|k| slot_cover[old.slot(k)]);
    }
    let mut element_of_face = vec![None; arrangement.faces.len()];
    for (new, &old) in covers.elements().zip(&blocks.order) {
        element_of_face[raw.face[old]] = Some(new);
    }
    drop((raw, joined, blocks, slot_cover));
    let outlines = Outlines::trace(&arrangement, &element_of_face, &covers.element_block);
    drop((arrangement, element_of_face));
    covers.by_triangle = by_triangle(&covers);
    covers.host = hosts(&covers);
    (covers, outlines)
}

/// See [`Covers::by_triangle`].
fn by_triangle(covers: &Covers) -> Vec<ElementId> {
    let by_id = covers.elements().zip(&covers.element_triangle);
    let mut elements: Vec<_> = by_id.map(|(e, triangle)| (triangle.j, triangle.i, e)).collect();
    elements.sort_unstable();
    elements.into_iter().map(|(_, _, e)| e).collect()
}

id! {
    /// An element in the order of the arrangement's faces.
    RawId: optional
}
id! {
    /// A corner of such an element.
    SlotId: optional
}

impl RawId {
    /// Its slot for one of three corners.
    fn slot(self, corner: usize) -> SlotId {
        SlotId::new(3 * self.index() + corner)
    }
}

impl SlotId {
    fn element(self) -> RawId {
        RawId::new(self.index() / 3)
    }

    fn corner(self) -> usize {
        self.index() % 3
    }
}

/// Elements in the order of the arrangement's faces.
struct RawElements {
    face: Vec<FaceId>,
    of_face: Vec<Option<RawId>>,
    triangle: Vec<Triangle>,
    area: Vec<f64>,
    centroid: Vec<Point>,
    polar: Vec<f64>,
    polygons: Polygons,
}

impl RawElements {
    fn collect(mesh: &RegularMesh, arrangement: &Arrangement) -> Self {
        let triangles = triangles_of_faces(mesh, arrangement);
        let face: Vec<FaceId> =
            FaceId::all(arrangement.faces.len()).filter(|&f| arrangement.faces[f].winding == 1).collect();
        let mut of_face = vec![None; arrangement.faces.len()];
        let mut raw = Self {
            triangle: face.iter().map(|&f| triangles[f]).collect(),
            area: Vec::with_capacity(face.len()),
            centroid: Vec::with_capacity(face.len()),
            polar: Vec::with_capacity(face.len()),
            polygons: Polygons { start: Vec::with_capacity(face.len() + 1), points: Vec::new() },
            face: Vec::new(),
            of_face: Vec::new(),
        };
        for (raw_id, &f) in RawId::all(face.len()).zip(&face) {
            of_face[f] = Some(raw_id);
            raw.integrate(arrangement, f);
        }
        raw.polygons.close();
        raw.face = face;
        raw.of_face = of_face;
        raw
    }

    fn integrate(&mut self, arrangement: &Arrangement, face: FaceId) {
        let mut loops = arrangement.face_loops(face);
        let outer = loops.next().expect("a face of rock has an outer loop");
        let holes: Vec<Vec<Point>> = loops.map(|h| arrangement.loop_points(h)).collect();
        self.polygons.close();
        let points = &mut self.polygons.points;
        let first = points.len();
        points.extend(arrangement.cycle(outer).map(|h| arrangement.points[arrangement.origin(h)]));
        let base = points[first];
        let total = holes.iter().map(|hole| polygon::Moments::of(hole, base));
        let total = total.fold(polygon::Moments::of(&points[first..], base), |a, b| a + b);
        bridge(points, first, &holes);
        let centroid = total.first / total.area;
        self.area.push(total.area);
        self.centroid.push(base + centroid);
        self.polar.push(total.second[0] + total.second[1] - total.area * centroid.norm_squared());
    }

    fn polygon(&self, k: RawId) -> &[Point] {
        self.polygons.of(k.index())
    }
}

/// Joins the holes of a face to its outer loop, which begins at `first`, by bridges between nearest corners.
fn bridge(points: &mut Vec<Point>, first: usize, holes: &[Vec<Point>]) {
    for hole in holes {
        let pairs = (first..points.len()).flat_map(|i| (0..hole.len()).map(move |j| (i, j)));
        let nearest = pairs.min_by(|&(i, j), &(k, l)| {
            (points[i] - hole[j]).norm_squared().total_cmp(&(points[k] - hole[l]).norm_squared())
        });
        let Some((i, j)) = nearest else { continue };
        let mut way: Vec<Point> = hole[j..].iter().chain(&hole[..=j]).copied().collect();
        way.push(points[i]);
        points.splice(i + 1..i + 1, way);
    }
}

/// The lattice triangle in which each face lies, from the mesh edges on its loops or from its neighbours.
fn triangles_of_faces(mesh: &RegularMesh, arrangement: &Arrangement) -> Vec<Triangle> {
    let nowhere = Triangle { i: i32::MIN, j: i32::MIN, set: 0 };
    let mut triangles = vec![nowhere; arrangement.faces.len()];
    let mut open = Vec::new();
    for h in arrangement.half_edges() {
        let label = arrangement.label_of(h);
        let face = arrangement.face[h];
        if let Some(edge) = label.mesh
            && face != FaceId::UNBOUNDED
            && triangles[face] == nowhere
        {
            triangles[face] = mesh.triangle_beside(edge, label.mesh_reversed);
            open.push(face);
        }
    }
    while let Some(face) = open.pop() {
        let sides = arrangement.face_loops(face).flat_map(|h| arrangement.cycle(h));
        for h in sides.filter(|&h| arrangement.label_of(h).mesh.is_none()) {
            let neighbour = arrangement.face[h.twin()];
            if neighbour != FaceId::UNBOUNDED && triangles[neighbour] == nowhere {
                triangles[neighbour] = triangles[face];
                open.push(neighbour);
            }
        }
    }
    triangles
}

/// Which elements form a block, and which corners of elements share a physical cover.
struct Joined {
    block_root: Vec<RawId>,
    slot_root: Vec<SlotId>,
}

impl Joined {
    /// Joins across every edge that is a mesh edge and nothing else: it is a spoke of both its stars.
    fn new(arrangement: &Arrangement, raw: &RawElements) -> Self {
        let mut blocks = UnionFind::new(RawId::all(raw.face.len()));
        let mut slots = UnionFind::new(SlotId::all(3 * raw.face.len()));
        for (e, edge) in arrangement.edges.iter().enumerate() {
            let [a, b] = HalfEdgeId::both(e).map(|h| raw.of_face[arrangement.face[h]]);
            let (true, Some(a), Some(b)) = (mesh_only(&edge.label), a, b) else { continue };
            blocks.join(a, b);
            let [nodes_a, nodes_b] = [a, b].map(|e| raw.triangle[e].nodes());
            for (k, star) in nodes_a.iter().enumerate() {
                if let Some(l) = nodes_b.iter().position(|s| s == star) {
                    slots.join(a.slot(k), b.slot(l));
                }
            }
        }
        Self { block_root: blocks.roots(), slot_root: slots.roots() }
    }
}

/// Order of the elements: by block, blocks and elements along a Hilbert curve.
struct BlockOrder {
    order: Vec<RawId>,
    block: Vec<BlockId>,
    count: usize,
    low: Point,
    high: Point,
}

fn order_blocks(raw: &RawElements, joined: &Joined) -> BlockOrder {
    let low = raw.centroid.iter().fold(Point::repeat(f64::INFINITY), |a, p| a.inf(p));
    let high = raw.centroid.iter().fold(Point::repeat(f64::NEG_INFINITY), |a, p| a.sup(p));
    let n = raw.face.len();
    let mut first = vec![Vector::zeros(); n];
    let mut area = vec![0.0; n];
    for e in RawId::all(n) {
        let root = joined.block_root[e];
        first[root] += raw.centroid[e] * raw.area[e];
        area[root] += raw.area[e];
    }
    let mut roots: Vec<RawId> = RawId::all(n).filter(|&e| joined.block_root[e] == e).collect();
    roots.sort_by_cached_key(|&r| (hilbert(first[r] / area[r], low, high), r));
    let mut block_of_root = vec![BlockId::default(); n];
    for (block, &r) in BlockId::all(roots.len()).zip(&roots) {
        block_of_root[r] = block;
    }
    let block: Vec<BlockId> = joined.block_root.iter().map(|&r| block_of_root[r]).collect();
    let mut order: Vec<RawId> = RawId::all(n).collect();
    order.sort_by_cached_key(|&e| (block[e], hilbert(raw.centroid[e], low, high), e));
    BlockOrder { order, block, count: roots.len(), low, high }
}

fn lay_out_elements(mesh: RegularMesh, raw: &RawElements, blocks: &BlockOrder) -> Covers {
    let (start, points) = (Vec::with_capacity(blocks.order.len() + 1), Vec::with_capacity(raw.polygons.points.len()));
    let mut polygons = Polygons { start, points };
    polygons.close();
    for &k in &blocks.order {
        polygons.points.extend_from_slice(raw.polygon(k));
        polygons.close();
    }
    let element_block: Vec<BlockId> = blocks.order.iter().map(|&k| blocks.block[k]).collect();
    Covers {
        gradients: mesh.gradients(),
        mesh,
        element_covers: vec![[CoverId::default(); 3]; blocks.order.len()],
        element_triangle: blocks.order.iter().map(|&k| raw.triangle[k]).collect(),
        element_area: blocks.order.iter().map(|&k| raw.area[k]).collect(),
        element_centroid: blocks.order.iter().map(|&k| raw.centroid[k]).collect(),
        element_polar: blocks.order.iter().map(|&k| raw.polar[k]).collect(),
        block_ranges: BlockRanges { elements: starts(&element_block, blocks.count), covers: Vec::new() },
        element_block,
        polygons,
        star: Vec::new(),
        star_position: Vec::new(),
        cover_block: Vec::new(),
        host: Vec::new(),
        by_triangle: Vec::new(),
    }
}

/// Creates the physical covers and returns the cover of each slot.
fn lay_out_covers(covers: &mut Covers, raw: &RawElements, joined: &Joined, blocks: &BlockOrder) -> Vec<CoverId> {
    let star_of = |slot: SlotId| raw.triangle[slot.element()].nodes()[slot.corner()];
    let mut roots: Vec<SlotId> = SlotId::all(joined.slot_root.len()).filter(|&s| joined.slot_root[s] == s).collect();
    let mut counts = vec![0; blocks.count];
    roots.iter().for_each(|&s| counts[blocks.block[s.element()]] += 1);
    roots.sort_by_cached_key(|&s| {
        let (block, [i, j]) = (blocks.block[s.element()], star_of(s));
        let tile = (counts[block] >= order::TILED).then(|| order::tile([i, j]));
        let node = tile.map_or([i, j], order::tile_centre);
        let position = hilbert(covers.mesh.node(node), blocks.low, blocks.high);
        (block, position, tile, [j, i], s)
    });
    let mut cover_of_root = vec![CoverId::default(); joined.slot_root.len()];
    for (cover, &s) in CoverId::all(roots.len()).zip(&roots) {
        cover_of_root[s] = cover;
        covers.star.push(star_of(s));
        covers.star_position.push(covers.mesh.node(star_of(s)));
        covers.cover_block.push(blocks.block[s.element()]);
    }
    covers.block_ranges.covers = starts(&covers.cover_block, blocks.count);
    joined.slot_root.iter().map(|&r| cover_of_root[r]).collect()
}

/// First index of each block in a sorted list of blocks, and the length at the end.
fn starts(blocks: &[BlockId], count: usize) -> Vec<u32> {
    (0..=count).map(|end| blocks.partition_point(|block| block.index() < end) as u32).collect()
}
