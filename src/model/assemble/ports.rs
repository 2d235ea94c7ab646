//! Ports and water of a case, found on the boundary of the blocks.

use crate::contact::{Boundary, EdgeId};
use crate::geometry::{Point, Vector, segment};
use crate::mechanics::LoadedFace;
use crate::model::case::{self, Case, Invalid, Load};
use crate::state::{Port, PortKind, QuietBoundary, Water, WaterSurface};

use super::locator::Locator;

/// Finds boundary edges by their position in the reference configuration.
pub(super) struct Faces<'a> {
    pub boundary: &'a Boundary,
    /// Distance (m) within which an edge counts as on a segment.
    pub tolerance: f64,
}

impl Faces<'_> {
    /// Whether both ends of an edge lie on a segment.
    pub fn lies_on(&self, edge: EdgeId, [a, b]: [[f64; 2]; 2]) -> bool {
        let ends = [edge, self.boundary.after(edge)].map(|k| self.boundary.reference[k]);
        ends.iter().all(|&p| segment::distance(p, Point::from(a), Point::from(b)) <= self.tolerance)
    }

    /// Faces on which a load of kind `joint` presses: joint faces or the parts of them that lie on its segment.
    pub fn loaded(&self, key: &str, load: &Load) -> Result<Vec<LoadedFace>, Invalid> {
        let segment = load.edge.unwrap_or_default();
        let joints = self.boundary.edges().filter(|&k| self.boundary.trace[k].is_some());
        let faces: Vec<LoadedFace> = joints.filter_map(|k| self.loaded_face(k, segment, load)).collect();
        if faces.is_empty() {
            return Err(nothing_on(&format!("{key}.edge"), segment, true));
        }
        Ok(faces)
    }

    /// The part of an edge on a segment with the pressure at both of its ends.
    fn loaded_face(&self, edge: EdgeId, segment: [[f64; 2]; 2], load: &Load) -> Option<LoadedFace> {
        let boundary = self.boundary;
        let [a, b] = segment.map(Point::from);
        let (length, along) = ((b - a).norm(), (b - a).normalize());
        let ends = [edge, boundary.after(edge)];
        let at = ends.map(|k| (boundary.reference[k] - a).dot(&along));
        let off = |k: EdgeId| (boundary.reference[k] - a).perp(&along).abs() > self.tolerance;
        let inside = at.map(|s| s.clamp(0.0, length));
        if ends.into_iter().any(off) || (inside[1] - inside[0]).abs() <= self.tolerance {
            return None;
        }
        let first = load.pressure.unwrap_or_default();
        let rise = load.pressure_end.unwrap_or(first) - first;
        Some(LoadedFace {
            covers: ends.map(|k| boundary.covers[k]),
            weights: ends.map(|k| boundary.weights[k]),
            span: inside.map(|s| (s - at[0]) / (at[1] - at[0])),
            pressure: inside.map(|s| first + rise * s / length),
        })
    }

    /// Edges on a segment, of joints or of the outer boundary.
    fn on(&self, key: &str, segment: [[f64; 2]; 2], joints: bool) -> Result<Vec<EdgeId>, Invalid> {
        let wanted = |k: &EdgeId| self.boundary.trace[*k].is_some() == joints && self.lies_on(*k, segment);
        let edges: Vec<EdgeId> = self.boundary.edges().filter(wanted).collect();
        if edges.is_empty() {
            return Err(nothing_on(key, segment, joints));
        }
        Ok(edges)
    }
}

/// No joint, or no outer boundary, lies on a segment.
fn nothing_on(key: &str, [[a, b], [c, d]]: [[f64; 2]; 2], joints: bool) -> Invalid {
    let (what, remedy) = if joints {
        ("joint", "give two points of one straight joint that cuts rock")
    } else {
        ("outer boundary of the rock", "give two points of one straight side of the outline")
    };
    Invalid { key: key.into(), message: format!("no {what} lies on the segment ({a}, {b})–({c}, {d}): {remedy}") }
}

/// The ports of a case.
pub(super) fn ports(
    case: &Case,
    positions: &Locator,
    faces: &Faces,
    quiets: &[QuietBoundary],
) -> Result<Vec<Port>, Invalid> {
    let mut ports = Vec::new();
    for (k, port) in case.ports.iter().enumerate() {
        let key = |name: &str| format!("port[{k}].{name}");
        let held = port.fix.as_ref().and_then(|name| case.fixes.iter().position(|fix| fix.name.as_ref() == Some(name)));
        let absorbing = port.quiet.and_then(|edge| case.quiet_of(edge));
        let fixities = match (held, absorbing) {
            (Some(fix), _) => vec![fix as u32],
            (_, Some(quiet)) => vec![quiets[quiet].springs, quiets[quiet].dashpots],
            (None, None) => Vec::new(),
        };
        let (kind, edges, force, scalar) = if let Some(segment) = port.boundary {
            (PortKind::Boundary, faces.on(&key("boundary"), segment, false)?, port.traction, port.pressure)
        } else if let Some(segment) = port.joint {
            (PortKind::Joint, faces.on(&key("joint"), segment, true)?, [0.0; 2], port.pressure)
        } else if let Some(edge) = port.quiet {
            (PortKind::Quiet, faces.on(&key("quiet"), edge, false)?, [0.0; 2], 0.0)
        } else if let Some(fix) = held.map(|fix| &case.fixes[fix]) {
            let edges = fix.edge.map_or(Ok(Vec::new()), |edge| faces.on(&key("fix"), edge, false))?;
            (PortKind::Fix, edges, [0.0; 2], 0.0)
        } else {
            (PortKind::Block, Vec::new(), port.force, port.moment)
        };
        let block = match edges.first() {
            Some(&edge) => faces.boundary.block[edge],
            None => {
                let point = held.and_then(|fix| case.fixes[fix].point).or(port.block);
                positions.block(&key("block"), point.unwrap_or_default())?
            }
        };
        ports.push(Port { name: port.name.clone(), kind, block, edges, fixities, force: Vector::from(force), scalar });
    }
    Ok(ports)
}

/// Segments of the outline beyond which there is rock: those that fixities, quiet boundaries and columns hold.
pub(super) fn held_edges(case: &Case) -> Vec<[[f64; 2]; 2]> {
    let quiet = case.quiets.iter().map(|quiet| quiet.edge);
    let beside = case.free_fields.iter().map(|side| side.edge);
    case.fixes.iter().filter_map(|fix| fix.edge).chain(quiet).chain(beside).collect()
}

/// The water of a case with the edges that it reaches.
pub(super) fn water(case: &Case, faces: &Faces) -> Result<Option<Water>, Invalid> {
    let Some(water) = &case.water else { return Ok(None) };
    let mut wet = vec![false; faces.boundary.len()];
    match &water.faces {
        Some(segments) => {
            for (k, &segment) in segments.iter().enumerate() {
                let edges = faces.on(&format!("water.faces[{k}]"), segment, false)?;
                edges.into_iter().for_each(|edge| wet[edge] = true);
            }
        }
        None => {
            let held = held_edges(case);
            for (edge, wet) in faces.boundary.edges().zip(&mut wet) {
                let outer = faces.boundary.trace[edge].is_none();
                *wet = outer && !held.iter().any(|&segment| faces.lies_on(edge, segment));
            }
        }
    }
    for (edge, wet) in faces.boundary.edges().zip(&mut wet) {
        *wet |= water.joints && faces.boundary.trace[edge].is_some();
    }
    let edges = faces.boundary.edges().filter(|&k| wet[k]).collect();
    Ok(Some(Water { density: water.density, surfaces: surfaces(case, water), edges, in_rock: water.rock }))
}

/// The surface of the water at the start of each stage: what none brings is as before.
fn surfaces(case: &Case, water: &case::Water) -> Vec<WaterSurface> {
    let mut now = water.surface();
    let of_stage = |stage: &case::Stage| {
        if let Some(next) = &stage.water {
            now.clone_from(next);
        }
        WaterSurface { level: now.highest(), table: super::points(now.table.as_deref().unwrap_or_default()) }
    };
    case.stages.iter().map(of_stage).collect()
}
