//! Actions on the rock from outside: gravity, loads of the case, and inputs of a host.

use crate::cover::{self, BlockId, CoverId};
use crate::geometry::{Point, Vector};
use crate::mechanics::{self, Forces, LoadAction};
use crate::state::{Drive, Model, State};

use super::faces::Faces;
use super::joint_water::JointWater;
use super::{Regime, Substep, quiet};

/// Acceleration (m/s²) of all rock at time `t` (s), relative to the base: gravity, body loads, what a host moves the
/// base by (Eq. 31).
pub fn acceleration(model: &Model, state: &State, t: f64) -> Vector {
    let body: Vector = model.loads.iter().map(|load| load.body(t)).sum();
    let share = state.drive.share(t);
    state.drive.gravity(share) + body - state.drive.base_acceleration(share)
}

/// Forces (N/m per cover) of loads and inputs while a sub-step acts; none when nothing pushes.
pub(super) fn load(model: &Model, state: &State, step: &Substep, force: &mut Vec<Vector>) {
    force.clear();
    if pushes(model, state) {
        force.resize(model.covers.cover_count(), Vector::zeros());
        push_forces(model, state, step.regime, step.time, &mut force[..]);
    }
}

/// Whether [`push_forces`] may add anything but zero.
fn pushes(model: &Model, state: &State) -> bool {
    let Drive { from, to, .. } = &state.drive;
    let any = |values: &[Vector]| values.iter().any(|v| *v != Vector::zeros());
    let any_scalar = |values: &[f64]| values.iter().any(|v| *v != 0.0);
    model.loads.iter().any(|load| !matches!(load.action, LoadAction::Body(_)))
        || model.water.is_some()
        || model.flow.is_some()
        || quiet::frozen(model, state).next().is_some()
        || [from, to].into_iter().any(|inputs| {
            any(&inputs.port_traction)
                || any_scalar(&inputs.port_pressure)
                || any(&inputs.block_force)
                || any_scalar(&inputs.block_moment)
        })
}

/// Gives what loads and inputs push with at time `t` (s); inputs and water act by the ramp of a static stage, as
/// gravity does.
pub fn push_forces(model: &Model, state: &State, regime: Regime, t: f64, force: &mut (impl Forces + ?Sized)) {
    let ramp = super::ramp(regime, t - state.stage_start);
    for load in &model.loads {
        let position = |i: CoverId| model.covers.star_position[i] + state.displacement[i];
        let covers = |b: BlockId| model.covers.covers_of(b);
        load.push(t, position, covers, &model.mass_matrix, force);
    }
    let faces = Faces { model, state };
    let share = state.drive.share(t);
    let level = state.drive.water_level(share);
    let weight = state.water_density * state.drive.gravity(share).norm() * ramp;
    if let Some(water) = &model.water {
        faces.push_water(water, level, weight, force);
        if model.strengths.iter().flatten().any(|strength| strength.is_porous) {
            push_pores(model, state, |at| weight * water.surfaces[state.stage as usize].depth(level, at), force);
        }
    }
    if let (Some(net), Some(seepage)) = (&model.flow, &state.seepage) {
        let reservoir = model.water.as_ref().map(|water| (water, level));
        let parting = net.parting.filter(|_| matches!(regime, Regime::Dynamic { .. }));
        JointWater { net, seepage, reservoir, weight, parting }.push(&faces, force);
    }
    for (k, port) in model.ports.iter().enumerate() {
        let (traction, pressure) = state.drive.port(k, share);
        faces.push_port(port, traction * ramp, pressure * ramp, force);
    }
    push_blocks(model, state, share, ramp, force);
    for (k, support) in quiet::frozen(model, state) {
        force.at_point(&support.covers, &support.weights, support.direction * state.support_force[k]);
    }
}

fn push_blocks(model: &Model, state: &State, share: f64, ramp: f64, force: &mut (impl Forces + ?Sized)) {
    for block in model.covers.blocks().filter(|&b| !state.removed[b]) {
        let (f, moment) = state.drive.block(block, share);
        if f != Vector::zeros() || moment != 0.0 {
            let position = |i: CoverId| model.covers.star_position[i] + state.displacement[i];
            let covers = model.covers.covers_of(block);
            mechanics::push_block(covers, &position, &model.mass_matrix, f * ramp, moment * ramp, force);
        }
    }
}

/// The pressure (Pa, where positive) in the pores of rock pushes the covers of its elements apart; the skeleton carries
/// the rest (Eq. 39a).
fn push_pores(model: &Model, state: &State, pressure: impl Fn(Point) -> f64, force: &mut (impl Forces + ?Sized)) {
    let covers = &model.covers;
    for e in covers.elements().filter(|&e| !state.removed[covers.element_block[e]] && model.is_porous(e)) {
        let centroid = covers.element_centroid[e];
        let moved = cover::sample(&covers.element_covers[e], &covers.weights(e, centroid), &state.displacement);
        let push = pressure(centroid + moved) * covers.element_area[e];
        if push > 0.0 {
            let at = model.deformation(e, &state.displacement);
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            for (&cover, &gradient) in covers.element_covers[e].iter().zip(gradients) {
                force.on_rock(cover, at.carry_normal(gradient) * push);
            }
        }
    }
}
