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
    let neighbours = neighbours(covers);
    let light = |e: usize| quality[e] < LIGHT_COVER;
    (0..covers.element_count())
        .map(|e| {
            let mut ring = vec![e as u32];
            for _ in 0..RINGS {
                if !light(best(&ring, &quality)) {
                    break;
                }
                let around: Vec<u32> = ring.iter().flat_map(|&f| &neighbours[f as usize]).copied().collect();
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

/// Elements that share two covers, hence a mesh edge that no joint cuts.
fn neighbours(covers: &Covers) -> Vec<Vec<u32>> {
    let pairs = |e: u32| {
        let ids = covers.element_covers[e as usize];
        [[0, 1], [1, 2], [2, 0]].map(|[k, l]| (ids[k].min(ids[l]), ids[k].max(ids[l]), e))
    };
    let mut edges: Vec<(u32, u32, u32)> = (0..covers.element_count() as u32).flat_map(pairs).collect();
    edges.sort_unstable();
    let mut neighbours = vec![Vec::new(); covers.element_count()];
    for shared in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        for a in shared {
            neighbours[a.2 as usize].extend(shared.iter().filter(|b| b.2 != a.2).map(|b| b.2));
        }
    }
    neighbours
}
