//! Free faces of blocks: the parts of their edges that lay on no edge of a block before the blocks moved. The states of
//! contacts do not say it, since blocks come to touch free faces, and excavated ones leave them.

/// Distance of places that are one, over the size of the slope: places of a film have single precision.
const NEAR: f64 = 1e-6;

/// A box of places.
type Extent = [[f64; 2]; 2];

/// A free face: a line now, or a whole loop of its block.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Its points (m), rock on the left.
    pub points: Vec<[f64; 2]>,
    /// The loop that is free all round, by its place among those of the block.
    pub loop_of: Option<usize>,
}

/// Loops of a block.
type Loops = [Vec<[f64; 2]>];

/// Free faces of blocks by their loops before they moved and now.
pub fn free_faces(blocks: &[(&Loops, &Loops)]) -> Vec<Vec<Face>> {
    let boxes: Vec<Extent> = blocks.iter().map(|(before, _)| extent(before)).collect();
    let all = boxes.iter().copied().reduce(join).unwrap_or_default();
    let near = NEAR * (all[1][0] - all[0][0]).max(all[1][1] - all[0][1]);
    let meet =
        |a: &Extent, b: &Extent| (0..2).all(|axis| a[0][axis] <= b[1][axis] + near && b[0][axis] <= a[1][axis] + near);
    let of_block = |(own, (before, now)): (&Extent, &(&Loops, &Loops))| -> Vec<Face> {
        let others = boxes.iter().zip(blocks).filter(|(other, _)| meet(own, other));
        let others: Vec<&Loops> = others.map(|(_, (before, _))| *before).collect();
        let loops = before.iter().zip(*now).enumerate();
        loops.flat_map(|(k, (before, now))| faces(k, before, now, &others, near)).collect()
    };
    boxes.iter().zip(blocks).map(of_block).collect()
}

fn extent(loops: &Loops) -> Extent {
    let points = loops.iter().flatten().map(|point| [*point, *point]);
    points.reduce(join).unwrap_or_default()
}

fn join(a: Extent, b: Extent) -> Extent {
    [[0, 1].map(|axis| a[0][axis].min(b[0][axis])), [0, 1].map(|axis| a[1][axis].max(b[1][axis]))]
}

fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
}

/// Free faces of a loop: its parts that are free before the move, where they are now.
fn faces(number: usize, before: &[[f64; 2]], now: &[[f64; 2]], others: &[&Loops], near: f64) -> Vec<Face> {
    let mut faces: Vec<Face> = Vec::new();
    let mut goes_on = false;
    for (edge, [from, to]) in edges(before).zip(edges(now)) {
        let at = |share: f64| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let parts = free_parts(edge, others, near);
        for [start, end] in &parts {
            match faces.last_mut().filter(|_| goes_on && *start == 0.0) {
                Some(face) => face.points.push(at(*end)),
                None => faces.push(Face { points: vec![at(*start), at(*end)], loop_of: None }),
            }
            goes_on = *end == 1.0;
        }
        goes_on &= !parts.is_empty();
    }
    // The last face runs on into the first one over the corner at which the loop begins.
    let begins = faces.first().is_some_and(|face| Some(&face.points[0]) == now.first());
    if goes_on && begins {
        if faces.len() == 1 {
            faces[0].points.pop();
            faces[0].loop_of = Some(number);
        } else if let Some(mut last) = faces.pop() {
            last.points.pop();
            last.points.append(&mut faces[0].points);
            faces[0] = last;
        }
    }
    faces
}

/// Parts of an edge, as shares of it, on which no edge lies that runs the other way, as that of rock on its other side.
fn free_parts(edge: [[f64; 2]; 2], others: &[&Loops], near: f64) -> Vec<[f64; 2]> {
    let along = [edge[1][0] - edge[0][0], edge[1][1] - edge[0][1]];
    let length = libm::hypot(along[0], along[1]);
    if length <= near {
        return Vec::new();
    }
    let place = |point: &[f64; 2]| {
        let arm = [point[0] - edge[0][0], point[1] - edge[0][1]];
        let [at, off] = [along[0] * arm[0] + along[1] * arm[1], along[0] * arm[1] - along[1] * arm[0]];
        (at / (length * length), (off / length).abs())
    };
    let covered = |[from, to]: [[f64; 2]; 2]| {
        let ((start, off), (end, other)) = (place(&from), place(&to));
        (start > end && off <= near && other <= near && start > 0.0 && end < 1.0).then_some([end, start])
    };
    let loops = others.iter().flat_map(|other| other.iter());
    let mut covers: Vec<[f64; 2]> = loops.flat_map(|points| edges(points).filter_map(covered)).collect();
    covers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let least = near / length;
    let (mut parts, mut at) = (Vec::new(), 0.0);
    for [start, end] in covers.into_iter().chain([[1.0, 1.0]]) {
        if start - at > least {
            parts.push([at, start]);
        }
        at = end.max(at);
    }
    parts
}
