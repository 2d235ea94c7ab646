//! Open lines that meet end to end, as the loops that they make.

use enmm::model::case::PointList;

/// Most open lines of a kind of loop.
pub const PIECES_MAX: usize = 10_000;

/// An open line.
#[derive(Debug)]
pub struct Piece {
    /// Its points (m).
    pub points: PointList,
    /// Its key in the file.
    pub key: String,
    /// Its line in the file.
    pub line: usize,
    /// Its type and layer, for messages.
    pub kind: String,
}

/// A line whose end meets no other.
#[derive(Debug)]
pub struct Dangling {
    /// The line with which the chain began.
    pub piece: Piece,
    /// End of the chain (m).
    pub end: [f64; 2],
    /// Distance (m) to the nearest end of another line, if there is one.
    pub gap: Option<f64>,
}

/// Joins lines whose ends lie within `tolerance` (m); returns loops, each with the line with which it began.
///
/// # Errors
/// The first chain that does not close.
pub fn loops(pieces: Vec<Piece>, tolerance: f64) -> Result<Vec<(PointList, Piece)>, Box<Dangling>> {
    let mut found = Vec::new();
    let mut rest: Vec<Option<Piece>> = pieces.into_iter().map(Some).collect();
    for k in 0..rest.len() {
        let Some(first) = rest[k].take() else { continue };
        let mut ring = first.points.clone();
        while ring.len() < 3 || away(&ring[0], &ring[ring.len() - 1]) > tolerance {
            let end = ring[ring.len() - 1];
            let ends = rest.iter().enumerate().filter_map(|(j, piece)| Some((j, piece.as_ref()?)));
            let distances = ends.flat_map(|(j, Piece { points, .. })| {
                [(j, false, away(&points[0], &end)), (j, true, away(&points[points.len() - 1], &end))]
            });
            let nearest = distances.min_by(|a, b| a.2.total_cmp(&b.2));
            let next = nearest.filter(|(.., gap)| *gap <= tolerance);
            let Some((piece, backwards)) = next.and_then(|(j, backwards, _)| Some((rest[j].take()?, backwards))) else {
                return Err(Box::new(Dangling { piece: first, end, gap: nearest.map(|(.., gap)| gap) }));
            };
            let mut points = piece.points;
            if backwards {
                points.reverse();
            }
            ring.extend(points.into_iter().skip(1));
        }
        ring.pop();
        found.push((ring, first));
    }
    Ok(found)
}

fn away(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}
