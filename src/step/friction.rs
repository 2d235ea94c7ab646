//! Friction that follows the pressure of the last milliseconds (theory §21, Eq. 84): how long a dynamic stage delays
//! it, and which contacts of a step it delays. Coulomb friction at once lets sliding blocks flutter on any fine mesh.

use crate::contact::VertexEdge;
use crate::cover::{BlockId, UnionFind};
use crate::mechanics::MassMatrix;
use crate::state::{Face, FaceBuffers, FrictionDelay, Model, SelectionBuffers, State};

use super::{Regime, Substep};

/// Longest delay (s) that a stage takes by itself.
const DELAY_MAX: f64 = 0.02;
/// Delays for which faces must have been in touch before friction is delayed; an impact has its friction at once.
const YOUNG: f64 = 4.0;
/// Height (m) of the asperities that faces hop over without parting, and the same over the penetration at rest.
const ASPERITY: f64 = 1e-3;
const HOPS: f64 = 10.0;

/// Finds the mean stress of the faces, on which the friction of rough joints depends. In dynamic stages it delays
/// friction on faces in lasting contact; the delay is set in the first step of a stage.
pub fn delay_friction(
    model: &Model,
    state: &mut State,
    step: &Substep,
    mass_matrix: &MassMatrix,
    selection: &mut SelectionBuffers,
    contacts: &mut [VertexEdge],
) {
    if let (Regime::Dynamic { .. }, None) = (step.regime, state.friction_delay) {
        state.friction_delay = Some(delay_of(model, mass_matrix, contacts));
    }
    let delay = state.friction_delay;
    selection.filter_share = delay.map_or(1.0, |delay| step.dt / (delay.time + step.dt));
    if delay.is_none() && state.laws.iter().all(|law| law.roughness.is_none()) {
        return;
    }
    let boundary = &model.boundary;
    let block = |contact: &VertexEdge| boundary.block[contact.point];
    selection.faces.of_side.resize(boundary.sides.ends.len(), 0);
    for contacts in contacts.chunk_by_mut(|a, b| block(a) == block(b)) {
        find_faces(contacts, delay, &mut selection.faces);
        for contact in contacts {
            let is_rough = state.laws[contact.law].roughness.is_some();
            follow_face(contact, &selection.faces, (delay, is_rough), step.dt);
        }
    }
}

/// Gathers the faces that the contacts of one block's nodes are.
fn find_faces(contacts: &[VertexEdge], delay: Option<FrictionDelay>, FaceBuffers { faces, of_side }: &mut FaceBuffers) {
    let hop = delay.map_or(f64::INFINITY, |delay| delay.hop);
    faces.clear();
    for contact in contacts {
        let history = &contact.history;
        let slot = &mut of_side[history.side];
        if faces.get(*slot as usize).is_none_or(|face| face.side != history.side) {
            *slot = faces.len() as u32;
            faces.push(Face { side: history.side, ..Face::default() });
        }
        let face = &mut faces[*slot as usize];
        face.age = face.age.max(history.meeting.age);
        face.touches |= contact.gap < hop;
        face.in_impact |= !contact.fresh && history.meeting.kept_stiffness > 0.0;
        face.filtered_normal += history.filtered_normal;
        face.length += if history.filtered_normal > 0.0 { contact.length } else { 0.0 };
    }
}

/// Makes a contact as old as its face, and delays its friction when that is old.
fn follow_face(
    contact: &mut VertexEdge,
    FaceBuffers { faces, of_side }: &FaceBuffers,
    (delay, is_rough): (Option<FrictionDelay>, bool),
    dt: f64,
) {
    let face = &faces[of_side[contact.history.side] as usize];
    if !face.touches {
        (contact.history.meeting.age, contact.history.filtered_normal, contact.history.meeting.kept_stiffness) =
            (0.0, 0.0, 0.0);
        return;
    }
    if is_rough {
        contact.past = if face.length > 0.0 { face.filtered_normal / face.length } else { 0.0 };
    }
    let is_old = |time: f64| time > 0.0 && f64::from(face.age) >= YOUNG * time;
    contact.delayed = !face.in_impact && delay.is_some_and(|delay| is_old(delay.time));
    contact.history.meeting.age = face.age + dt as f32;
}

/// Delay of friction in a stage that begins with these contacts: as the case gives it, or the time in which a shear
/// wave crosses the largest group of free blocks that are in touch with each other.
pub fn delay_of(model: &Model, mass_matrix: &MassMatrix, contacts: &[VertexEdge]) -> FrictionDelay {
    let pressed = |contact: &VertexEdge| contact.history.normal_force.max(0.0);
    let force: f64 = contacts.iter().map(pressed).sum();
    let closures: f64 = contacts.iter().map(|contact| pressed(contact) * (-contact.gap).max(0.0)).sum();
    let closure = if force > 0.0 { closures / force } else { 0.0 };
    let hop = ASPERITY.max(HOPS * closure).min(model.detection.reach * model.covers.mesh.size);
    let touching = contacts.iter().filter(|contact| contact.gap < hop).map(|contact| contact.blocks(&model.boundary));
    let time = model.friction_delay.unwrap_or_else(|| wave_time(model, mass_matrix, touching).min(DELAY_MAX));
    FrictionDelay { time, hop }
}

/// √A/c_s (s) of the largest group of free blocks that are in touch: A is its area, c_s the mean of its shear wave
/// speeds by area.
fn wave_time(model: &Model, mass_matrix: &MassMatrix, touching: impl Iterator<Item = [BlockId; 2]>) -> f64 {
    let mut groups = UnionFind::new(model.covers.blocks());
    for [a, b] in touching.filter(|pair| pair.iter().all(|&block| mass_matrix.is_free(block))) {
        groups.join(a, b);
    }
    let mut sums = vec![[0.0; 2]; model.covers.block_count()];
    for block in model.covers.blocks().filter(|&block| mass_matrix.is_free(block)) {
        let area = model.covers.block_area(block);
        let size = area.sqrt().max(model.covers.mesh.size);
        let speed = model.block_frequency[block] * size / std::f64::consts::TAU;
        let [areas, speeds] = &mut sums[groups.root(block)];
        *areas += area;
        *speeds += area * speed;
    }
    let time = |[area, speeds]: &[f64; 2]| if *area > 0.0 { area * area.sqrt() / speeds } else { 0.0 };
    sums.iter().map(time).fold(0.0, f64::max)
}
