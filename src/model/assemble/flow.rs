//! The net of joints of a case in which water flows.

use crate::contact::{Boundary, EdgeId, Facings, LawId};
use crate::flow::{FlowNet, HeldHead, Outcrop};
use crate::geometry::{Point, segment};
use crate::model::case::{self, Case, Flow, Head, Invalid};
use crate::state::Water;

use super::joints::Joints;
use super::ports::Faces;

/// The net of joints, if water flows in them.
pub(super) fn net(
    case: &Case,
    joints: &Joints,
    faces: &Faces,
    water: Option<&Water>,
) -> Result<Option<FlowNet>, Invalid> {
    let (Some(flow), Some(range)) = (&case.flow, case.aperture_range()) else { return Ok(None) };
    let boundary = faces.boundary;
    let facings = Facings::of(boundary, &joints.traces);
    let law = |edge: EdgeId| boundary.trace[edge].map_or(joints.default_law, |trace| joints.traces[trace.index()].1);
    let mut net = FlowNet::new(boundary, &facings, law, outside(case, boundary, faces, water))
        .map_err(|error| invalid("flow", format!("the net of joints cannot be built: {error}; use fewer joints")))?;
    if net.pieces.is_empty() {
        return Err(invalid("flow", "has no effect: no joint parts blocks; add joints or remove [flow]".into()));
    }
    net.range = range;
    net.viscosity = flow.viscosity;
    net.density = water.map_or_else(|| case::Water::default().density, |water| water.density);
    net.apertures = apertures(case);
    net.heads = heads(case, &net, faces.tolerance)?;
    refuse_tight(case, &net)?;
    Ok(Some(net))
}

fn invalid(key: &str, message: String) -> Invalid {
    Invalid { key: key.to_owned(), message }
}

/// What each edge of the outline meets.
fn outside<'a>(
    case: &Case,
    boundary: &Boundary,
    faces: &'a Faces,
    water: Option<&Water>,
) -> impl Fn(EdgeId) -> Outcrop + use<'a> {
    let held = super::ports::held_edges(case);
    let mut wet = vec![false; boundary.len()];
    water.iter().flat_map(|water| &water.edges).for_each(|&edge| wet[edge] = true);
    move |edge| match wet[edge] {
        true => Outcrop::Reservoir,
        false if held.iter().any(|&segment| faces.lies_on(edge, segment)) => Outcrop::None,
        false => Outcrop::Air,
    }
}

/// Apertures (m) at the start by law: laws that the build has added are those of cracks and do not conduct.
fn apertures(case: &Case) -> Vec<f64> {
    case.joint_laws.iter().map(|(name, law)| case.aperture(name, law).unwrap_or_default()).collect()
}

/// The heads with their nodes and their levels in each stage.
fn heads(case: &Case, net: &FlowNet, tolerance: f64) -> Result<Vec<HeldHead>, Invalid> {
    let mut owner: Vec<Option<usize>> = vec![None; net.places.len()];
    let mut heads = Vec::new();
    for (k, head) in case.heads.iter().enumerate() {
        let Head { name, edge, level } = head;
        let key = format!("head[{k}].edge");
        let [a, b] = edge.map(Point::from);
        let on = |node: &u32| segment::distance(net.places[*node as usize], a, b) <= tolerance;
        let nodes: Vec<u32> = (0..net.places.len() as u32).filter(on).collect();
        if nodes.is_empty() {
            let message = format!(
                "no end and no crossing of a joint lies on the segment ({}, {})–({}, {}), so that no water comes from \
                 there: give two points of one straight side of the outline that joints meet, or of one straight joint",
                a.x, a.y, b.x, b.y
            );
            return Err(invalid(&key, message));
        }
        for &node in &nodes {
            if let Some(other) = owner[node as usize].replace(k) {
                let at = net.places[node as usize];
                let message = format!(
                    "meets the joint at ({:.6}, {:.6}) m that head {:?} holds too, and it can have one head only: \
                     shorten one of both segments",
                    at.x, at.y, case.heads[other].name
                );
                return Err(invalid(&key, message));
            }
        }
        let mut now = *level;
        let of_stage = |stage: &case::Stage| {
            now = stage.heads.get(name).copied().unwrap_or(now);
            now
        };
        let levels = case.stages.iter().map(of_stage).collect();
        heads.push(HeldHead { name: name.clone(), nodes, levels });
    }
    Ok(heads)
}

/// Refuses a case none of whose joints conducts.
fn refuse_tight(case: &Case, net: &FlowNet) -> Result<(), Invalid> {
    let conducts = |law: LawId| net.apertures.get(law.index()).is_some_and(|aperture| *aperture > 0.0);
    let switched = |law: LawId| {
        let name = case.joint_laws.keys().nth(law.index());
        case.stages.iter().flat_map(|stage| &stage.law_switches).any(|switch| Some(&switch.from) == name)
    };
    if net.pieces.iter().any(|piece| conducts(piece.law) || switched(piece.law)) {
        return Ok(());
    }
    let Flow { aperture, .. } = case.flow.clone().unwrap_or_default();
    let own = aperture.map_or("in each law that joints have".to_owned(), |e| format!("{e} m here, 0 in their laws"));
    Err(invalid("flow", format!("has no effect: no joint conducts, with apertures of {own}; correct the laws")))
}
