//! The net of joints of a case in which water flows.

use enmm_seepage::Condition;

use crate::contact::{Boundary, EdgeId, Facings, LawId};
use crate::flow::{self, FlowNet, FlowPiece, HeldHead, Inlet, Outcrop, Outside, Parting, is_open};
use crate::geometry::{Point, segment};
use crate::model::case::{self, Case, Flow, Head, Invalid, JointLaw};
use crate::state::{Model, Water};

use super::joints::Joints;
use super::ports::Faces;

/// The net of joints, if water flows in them.
pub(super) fn net(
    case: &Case,
    joints: &Joints,
    faces: &Faces,
    water: Option<&Water>,
) -> Result<Option<FlowNet>, Invalid> {
    let (Some(keys), Some(range)) = (&case.flow, case.aperture_range()) else { return Ok(None) };
    let boundary = faces.boundary;
    let mut facings = Facings::of(boundary, &joints.traces);
    let lines = super::drains::lines(case);
    facings.pieces = flow::part(&facings.pieces, &lines, faces.tolerance);
    let law = |edge: EdgeId| boundary.trace[edge].map_or(joints.default_law, |trace| joints.traces[trace.index()].1);
    let mut net = FlowNet::new(boundary, &facings, law, outside(case, boundary, faces, water))
        .map_err(|error| invalid("flow", format!("the net of joints cannot be built: {error}; use fewer joints")))?;
    if net.pieces.is_empty() {
        return Err(invalid("flow", "has no effect: no joint parts blocks; add joints or remove [flow]".into()));
    }
    net.range = range;
    (net.viscosity, net.storage, net.coupled) = (keys.viscosity, keys.storage, keys.coupled);
    net.parting = case.parting().map(|[slip, opening]| Parting { slip, opening });
    net.density = water.map_or_else(|| case::Water::default().density, |water| water.density);
    net.apertures = apertures(case);
    let rough = |law: &JointLaw| law.mechanical().map(|mechanical| [mechanical, law.smoothness()]);
    net.mechanical = case.joint_laws.values().map(rough).collect();
    net.heads = heads(case, &net, faces.tolerance)?;
    net.rains = super::rain::rains(case, &net, faces.tolerance)?;
    net.drains = super::drains::drains(case, &net, &lines, faces.tolerance)?;
    refuse_tight(case, &net)?;
    Ok(Some(net))
}

fn invalid(key: &str, message: String) -> Invalid {
    Invalid { key: key.to_owned(), message }
}

/// Place beyond each edge of the outline.
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
        let levels = super::rain::by_stage(case, *level, |stage| stage.heads.get(name));
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

/// Share of the joints that may have no outlet before the user is told.
const ISOLATED_SHARE: f64 = 0.05;
/// Greatest over least transmissivity above which flows of tight joints are lost in the rounding of heads.
const CONTRAST_MAX: f64 = 1e12;
/// Difference of heads (m) that is none.
const EQUAL: f64 = 1e-9;

/// Warnings of a flow that looks unintended.
pub(super) fn warnings(case: &Case, model: &Model) -> Vec<String> {
    let Some(net) = &model.flow else { return Vec::new() };
    let stages: Vec<_> = (0..case.stages.len()).map(|stage| conditions(net, model, stage)).collect();
    let held = |(condition, _): &At| match condition {
        Condition::Held { head } => Some(*head),
        _ => None,
    };
    let rains = |(condition, _): &At| matches!(condition, Condition::Rain { rate } if *rate > 0.0);
    let mut warnings = Vec::new();
    // Hosts move what a stage follows.
    let is_held = case.stages.iter().all(|stage| stage.flow_steps().is_none());
    if is_held && stages.iter().flatten().all(|at| held(at).is_none() && !rains(at)) {
        warnings.push(
            "flow: no water enters, so that all joints are dry: no [[head]] is above the joints that it meets, none \
             crops out below [water], and no [[rain]] falls"
                .to_owned(),
        );
    } else if is_held && !digs(case) && stages.iter().all(|stage| is_still(net, stage)) {
        warnings.push(
            "flow: all heads are equal and no water flows; still water, [water] without [flow], gives the same \
             pressures"
                .to_owned(),
        );
    }
    warnings.extend(isolated(net, &stages[0]));
    warnings.extend(contrast(net));
    if model.water.as_ref().is_some_and(|water| water.in_rock) && model.strengths.iter().flatten().any(|s| s.is_porous)
    {
        warnings.push(
            "flow: the pressure in the pores of rock that yields is that of the surface of [water], not that of the \
             flow in the joints; give `rock = false` in [water] for none"
                .to_owned(),
        );
    }
    warnings
}

/// Joints of very different transmissivity.
fn contrast(net: &FlowNet) -> Option<String> {
    let apertures = net.pieces.iter().map(|piece| net.apertures[piece.law.index()]).filter(|aperture| *aperture > 0.0);
    let (low, high) = apertures.fold((f64::INFINITY, 0.0_f64), |(low, high), e| (low.min(e), high.max(e)));
    let contrast = (high / low).powi(3);
    (contrast > CONTRAST_MAX).then(|| {
        format!(
            "flow: apertures from {low:e} to {high:e} m give transmissivities that differ by a factor of \
             {contrast:.1e}, more than {CONTRAST_MAX:e}, so that flows of the tight joints are lost in the rounding of \
             heads: give them aperture = 0, which closes them to water, or raise the least aperture"
        )
    })
}

/// Condition at a node.
type At = (Condition, Option<Inlet>);

fn digs(case: &Case) -> bool {
    case.stages.iter().any(|stage| !stage.excavate.is_empty() || stage.excavate_region.is_some())
}

/// Conditions at the nodes at the start of a stage if nothing is dug.
fn conditions(net: &FlowNet, model: &Model, stage: usize) -> Vec<At> {
    let depth = |at: &Point| {
        let surface = model.water.as_ref().map(|water| &water.surfaces[stage]);
        surface.map_or(-1.0, |surface| surface.depth(surface.level, *at))
    };
    let depths: Vec<f64> = net.places.iter().map(depth).collect();
    let conducts = net.conducting(&at_start(net));
    let heads: Vec<f64> = net.heads.iter().map(|head| head.levels[stage]).collect();
    let rains: Vec<f64> = net.rains.iter().map(|rain| rain.rates[stage]).collect();
    let drains: Vec<bool> = net.drains.iter().map(|drain| drain.active[stage]).collect();
    let dug = vec![Outcrop::None; depths.len()];
    net.conditions(Outside {
        heads: &heads,
        rains: &rains,
        drains: &drains,
        dug: &dug,
        depths: &depths,
        conducts: &conducts,
    })
}

/// A conductance of 1 of each piece that conducts at the start, else 0.
fn at_start(net: &FlowNet) -> Vec<f64> {
    let of = |piece: &FlowPiece| if net.apertures[piece.law.index()] > 0.0 { 1.0 } else { 0.0 };
    net.pieces.iter().map(of).collect()
}

/// Whether all heads are equal, and no outcrop is below them.
fn is_still(net: &FlowNet, conditions: &[At]) -> bool {
    let (mut low, mut high, mut lowest) = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
    for ((condition, _), place) in conditions.iter().zip(&net.places) {
        match condition {
            Condition::Held { head } => (low, high) = (low.min(*head), high.max(*head)),
            Condition::Rain { rate } if *rate > 0.0 => return false,
            Condition::Air | Condition::Rain { .. } => lowest = lowest.min(place.y),
            Condition::Free { source } if *source < 0.0 => return false,
            Condition::Free { .. } => {}
        }
    }
    high - low <= EQUAL && lowest >= high - EQUAL
}

/// Joints from which no water leaves and to which none comes.
fn isolated(net: &FlowNet, conditions: &[At]) -> Option<String> {
    let open = |piece: &FlowPiece| net.apertures[piece.law.index()] > 0.0;
    let labels = net.net.pieces(&at_start(net));
    let mut fed = vec![false; labels.len()];
    for (label, _) in labels.iter().zip(conditions).filter(|(_, at)| is_open(&at.0)) {
        fed[*label as usize] = true;
    }
    let length = |is: &dyn Fn(&FlowPiece) -> bool| -> f64 {
        net.pieces.iter().filter(|piece| open(piece) && is(piece)).map(|piece| piece.length).sum()
    };
    let (all, alone) = (length(&|_| true), length(&|piece| !fed[labels[piece.nodes[0] as usize] as usize]));
    (alone > ISOLATED_SHARE * all).then(|| {
        format!(
            "flow: {alone:.3} m of {all:.3} m of joints meet neither a head nor an outcrop, and are dry: lead them to \
             others, or hold a [[head]] where they end"
        )
    })
}
