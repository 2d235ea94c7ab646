//! Hosts: which element carries what acts on the boundary of an element that a cut has left almost nothing of.

use super::cut::Covers;

/// Share of a full cover's area below which a cover is too light to carry forces of its own.
const LIGHT_COVER: f64 = 0.05;
/// Rings of neighbours that are searched for a host.
const RINGS: usize = 3;

/// For each element, itself or the best neighbour within its block.
///
/// A cover that only a sliver reaches has the mass and the stiffness of the sliver: a contact that loads it would throw
/// it away. The displacement of the sliver's boundary is taken from the heavier element beside it instead, extrapolated
/// by its weights, which are affine and thus move rigidly with the block.
pub(super) fn hosts(covers: &Covers) -> Vec<u32> {
    let quality = qualities(covers);
    let edges = MeshEdges::new(covers);
    let light = |e: usize| quality[e] < LIGHT_COVER;
    (0..covers.element_count())
        .map(|e| {
            let mut ring = vec![e as u32];
            for _ in 0..RINGS {
                if !light(best(&ring, &quality)) {
                    break;
                }
                let around: Vec<u32> = ring.iter().flat_map(|&f| edges.neighbours(covers, f)).collect();
                ring.extend(around);
                ring.sort_unstable();
                ring.dedup();
            }
            if light(e) { best(&ring, &quality) as u32 } else { e as u32 }
        })
        .collect()
}

/// The element of the highest quality, the first of equals.
fn best(elements: &[u32], quality: &[f64]) -> usize {
    let better = |a: usize, b: u32| if quality[b as usize] > quality[a] { b as usize } else { a };
    elements[1..].iter().fold(elements[0] as usize, |a, &b| better(a, b))
}

/// Area of the lightest cover of each element over that of a full cover.
fn qualities(covers: &Covers) -> Vec<f64> {
    let mut area = vec![0.0; covers.cover_count()];
    for (ids, a) in covers.element_covers.iter().zip(&covers.element_area) {
        ids.iter().for_each(|&i| area[i as usize] += a);
    }
    let full = 6.0 * 0.25 * 3f64.sqrt() * covers.mesh.size * covers.mesh.size;
    let lightest = |ids: &[u32; 3]| ids.iter().map(|&i| area[i as usize]).fold(f64::INFINITY, f64::min) / full;
    covers.element_covers.iter().map(lightest).collect()
}

/// Pairs of covers with the elements that have both, sorted.
struct MeshEdges(Vec<[u32; 3]>);

impl MeshEdges {
    fn new(covers: &Covers) -> Self {
        let mut edges: Vec<[u32; 3]> =
            (0..covers.element_count() as u32).flat_map(|e| cover_pairs(covers, e).map(|[i, j]| [i, j, e])).collect();
        edges.sort_unstable();
        Self(edges)
    }

    /// Elements that share two covers with an element, hence a mesh edge that no joint cuts; itself as well.
    fn neighbours(&self, covers: &Covers, element: u32) -> impl Iterator<Item = u32> {
        cover_pairs(covers, element).into_iter().flat_map(move |pair| {
            let first = self.0.partition_point(|edge| edge[..2] < pair[..]);
            self.0[first..].iter().take_while(move |edge| edge[..2] == pair[..]).map(|edge| edge[2])
        })
    }
}

/// The pairs of an element's covers, the lower one first.
fn cover_pairs(covers: &Covers, element: u32) -> [[u32; 2]; 3] {
    let ids = covers.element_covers[element as usize];
    [[0, 1], [1, 2], [2, 0]].map(|[k, l]| [ids[k].min(ids[l]), ids[k].max(ids[l])])
}
