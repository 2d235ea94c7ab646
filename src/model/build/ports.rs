//! Ports and water of a case, found on the boundary of the blocks.

use crate::contact::Boundary;
use crate::geometry::{NONE, Point, Vector, segment};
use crate::model::case::{Case, Invalid};
use crate::state::{Port, PortKind, Water};

use super::place::Places;

/// Finds boundary edges by their place in the reference configuration.
pub(super) struct Faces<'a> {
    pub boundary: &'a Boundary,
    /// Distance (m) within which an edge counts as on a segment.
    pub tolerance: f64,
}

impl Faces<'_> {
    fn lies_on(&self, edge: usize, [a, b]: [[f64; 2]; 2]) -> bool {
        let ends = [edge, self.boundary.after(edge)].map(|k| self.boundary.reference[k]);
        ends.iter().all(|&p| segment::distance(p, Point::from(a), Point::from(b)) <= self.tolerance)
    }

    /// Edges on a segment, of joints or of the outer boundary.
    fn on(&self, key: &str, segment: [[f64; 2]; 2], joints: bool) -> Result<Vec<u32>, Invalid> {
        let wanted = |k: &usize| (self.boundary.trace[*k] != NONE) == joints && self.lies_on(*k, segment);
        let edges: Vec<u32> = (0..self.boundary.len()).filter(wanted).map(|k| k as u32).collect();
        if edges.is_empty() {
            let ([a, b], [c, d]) = (segment[0], segment[1]);
            let (what, remedy) = if joints {
                ("joint", "give two points of one straight joint that cuts rock")
            } else {
                ("outer boundary of the rock", "give two points of one straight side of the outline")
            };
            let message = format!("no {what} lies on the segment ({a}, {b})–({c}, {d}): {remedy}");
            return Err(Invalid { key: key.into(), message });
        }
        Ok(edges)
    }
}

/// The ports of a case.
pub(super) fn ports(case: &Case, places: &Places, faces: &Faces) -> Result<Vec<Port>, Invalid> {
    let mut ports = Vec::new();
    for (k, port) in case.ports.iter().enumerate() {
        let key = |name: &str| format!("port[{k}].{name}");
        let (kind, edges, force, scalar) = if let Some(segment) = port.boundary {
            (PortKind::Boundary, faces.on(&key("boundary"), segment, false)?, port.traction, port.pressure)
        } else if let Some(segment) = port.joint {
            (PortKind::Joint, faces.on(&key("joint"), segment, true)?, [0.0; 2], port.pressure)
        } else {
            (PortKind::Block, Vec::new(), port.force, port.moment)
        };
        let block = match edges.first() {
            Some(&edge) => faces.boundary.block[edge as usize],
            None => places.block(&key("block"), port.block.unwrap_or_default())? as u32,
        };
        ports.push(Port { name: port.name.clone(), kind, block, edges, force: Vector::from(force), scalar });
    }
    Ok(ports)
}

/// The water of a case with the edges that it reaches.
pub(super) fn water(case: &Case, faces: &Faces) -> Result<Option<Water>, Invalid> {
    let Some(water) = &case.water else { return Ok(None) };
    let mut wet = vec![false; faces.boundary.len()];
    match &water.faces {
        Some(segments) => {
            for (k, &segment) in segments.iter().enumerate() {
                let edges = faces.on(&format!("water.faces[{k}]"), segment, false)?;
                edges.into_iter().for_each(|edge| wet[edge as usize] = true);
            }
        }
        None => {
            let quiet = case.quiets.iter().map(|quiet| quiet.edge);
            let beside = case.free_fields.iter().map(|side| side.edge);
            let held: Vec<[[f64; 2]; 2]> =
                case.fixes.iter().filter_map(|fix| fix.edge).chain(quiet).chain(beside).collect();
            for (edge, wet) in wet.iter_mut().enumerate() {
                let outer = faces.boundary.trace[edge] == NONE;
                *wet = outer && !held.iter().any(|&segment| faces.lies_on(edge, segment));
            }
        }
    }
    for (edge, wet) in wet.iter_mut().enumerate() {
        *wet |= water.joints && faces.boundary.trace[edge] != NONE;
    }
    let edges = (0..wet.len()).filter(|&k| wet[k]).map(|k| k as u32).collect();
    Ok(Some(Water { density: water.density, level: water.start_level(), edges }))
}
