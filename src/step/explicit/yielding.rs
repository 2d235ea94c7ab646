//! Rock that yields: plastic strain at the current displacements, before forces are taken from it.

use rayon::prelude::*;

use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::Vector;
use crate::mechanics::{self, Deformation, MassMatrix, PlasticStrain, Strained, YieldSurface};
use crate::state::{Model, State, YieldBuffers};

use super::{Substep, report};

/// Elements that are summed and shared between threads as one run: fixed, so that sums do not depend on the threads.
const RUN: usize = 1024;

/// Brings the plastic strain of all elements to the current displacements under the strength of this time, and books
/// what that takes (Eqs. 57, 58). Done twice at the same displacements it changes nothing.
pub(super) fn yield_rock(
    model: &Model,
    state: &mut State,
    step: &Substep,
    mass_matrix: &MassMatrix,
    buffers: &mut YieldBuffers,
) {
    if state.plastic.is_empty() {
        return;
    }
    let factor = state.drive.strength_factor(state.drive.share(step.time));
    buffers.surfaces.clear();
    buffers.surfaces.extend(model.strengths.iter().map(|s| s.map(|strength| strength.surface(factor))));
    average_dilatation(model, state, step.serial, buffers);
    state.ledger.yielding += flow(model, state, step.serial, mass_matrix, buffers);
    average_stress(model, state, step.serial, buffers);
}

/// Makes a list of what `value` gives for each of `count` indices.
fn list<T: Send + Default>(serial: bool, count: usize, list: &mut Vec<T>, value: impl Fn(usize) -> T + Sync) {
    list.resize_with(count, T::default);
    let fill = |(run, values): (usize, &mut [T])| {
        values.iter_mut().enumerate().for_each(|(k, place)| *place = value(run * RUN + k));
    };
    if serial {
        list.chunks_mut(RUN).enumerate().for_each(fill);
    } else {
        list.par_chunks_mut(RUN).enumerate().for_each(fill);
    }
}

/// Volume changes of all elements that can yield, and their means over patches (Eq. 58a).
fn average_dilatation(model: &Model, state: &State, serial: bool, buffers: &mut YieldBuffers) {
    let YieldBuffers { surfaces, dilatation, averaged, .. } = buffers;
    let State { displacement, velocity, dt_last, .. } = state;
    list(serial, state.plastic.len(), dilatation, |k| {
        let e = ElementId::new(k);
        if surfaces[model.element_rock[e] as usize].is_none() {
            return [0.0; 2];
        }
        let at = model.deformation(e, displacement);
        [at.dilatation(), at.dilatation_by(moved(model, e, velocity, *dt_last), gradients(model, e))]
    });
    list(serial, model.averaging.len(), averaged, |k| model.averaging.of_patch(k, |e| dilatation[e]));
}

/// Brings the plastic strain of all elements to the current displacements; returns the energy (J/m) that it takes.
fn flow(model: &Model, state: &mut State, serial: bool, mass_matrix: &MassMatrix, buffers: &mut YieldBuffers) -> f64 {
    let YieldBuffers { surfaces, energy: taken, dilatation, averaged, .. } = buffers;
    taken.clear();
    taken.resize(state.plastic.len().div_ceil(RUN), 0.0);
    let State { plastic, displacement, velocity, dt_last, removed, .. } = state;
    let dt_last = *dt_last;
    let pass = Pass { model, surfaces, dilatation, averaged, mass_matrix, displacement, velocity, dt_last, removed };
    let run = |(k, (energy, plastic)): (usize, (&mut f64, &mut [PlasticStrain]))| *energy = pass.run(k * RUN, plastic);
    if serial {
        taken.iter_mut().zip(plastic.chunks_mut(RUN)).enumerate().for_each(run);
    } else {
        taken.par_iter_mut().zip(plastic.par_chunks_mut(RUN)).enumerate().for_each(run);
    }
    taken.iter().sum()
}

/// Mean stresses after yielding, and their means over patches (Eq. 58c).
fn average_stress(model: &Model, state: &State, serial: bool, buffers: &mut YieldBuffers) {
    let YieldBuffers { averaged, mean_stress, averaged_stress, .. } = buffers;
    list(serial, state.plastic.len(), mean_stress, |k| {
        let e = ElementId::new(k);
        let felt = model.averaging.of_element(e, averaged).zip(model.strength_of(e));
        [felt.map_or(0.0, |([volume, _], strength)| strength.mean_stress(volume, &state.plastic[e]))]
    });
    list(serial, model.averaging.len(), averaged_stress, |k| model.averaging.of_patch(k, |e| mean_stress[e]));
}

/// How far (m) the covers of an element moved in the last step.
fn moved(model: &Model, element: ElementId, velocity: &[Vector], dt_last: f64) -> [Vector; 3] {
    model.covers.element_covers[element].map(|i: CoverId| velocity[i] * dt_last)
}

fn gradients(model: &Model, element: ElementId) -> &[Vector; 3] {
    &model.covers.gradients[model.covers.element_triangle[element].set as usize]
}

/// Data that all runs share.
struct Pass<'a> {
    model: &'a Model,
    surfaces: &'a [Option<YieldSurface>],
    dilatation: &'a [[f64; 2]],
    averaged: &'a [[f64; 2]],
    mass_matrix: &'a MassMatrix,
    displacement: &'a [Vector],
    velocity: &'a [Vector],
    dt_last: f64,
    removed: &'a [bool],
}

impl Pass<'_> {
    /// Updates the elements from `first` on; returns the energy (J/m) that it takes.
    fn run(&self, first: usize, plastic: &mut [PlasticStrain]) -> f64 {
        let covers = &self.model.covers;
        let (mut energy, mut turn) = (0.0, None);
        for (element, plastic) in ElementId::range(first..first + plastic.len()).zip(plastic) {
            let Some(surface) = &self.surfaces[self.model.element_rock[element] as usize] else { continue };
            if self.removed[covers.element_block[element]] {
                continue;
            }
            let felt = self.model.averaging.of_element(element, self.averaged);
            let [dilatation, more] = felt.unwrap_or(self.dilatation[element]);
            let at = Strained { deformation: self.model.deformation(element, self.displacement), dilatation };
            let pre = self.model.pre_stress_and_out(element);
            if let Some(growth) = surface.growth(&at, &pre, plastic) {
                let deformation = self.before(element, &at.deformation, &mut turn);
                let from = Strained { deformation, dilatation: dilatation - more };
                let taken = surface.taken(&from, &at, &pre, [plastic, &growth]);
                (0..4).for_each(|k| plastic[k] += growth[k]);
                energy += taken * covers.element_area[element];
            }
        }
        energy
    }

    /// Deformation of an element one step ago, in the frame of its block; `turn` is that of the last block asked for.
    fn before(&self, element: ElementId, now: &Deformation, turn: &mut Option<(BlockId, f64)>) -> Deformation {
        let covers = &self.model.covers;
        let block = covers.element_block[element];
        let known = turn.filter(|known| known.0 == block);
        let (_, angle) = *turn.insert(known.unwrap_or_else(|| (block, self.turn(block))));
        now.before(moved(self.model, element, self.velocity, self.dt_last), angle, gradients(self.model, element))
    }

    /// Angle (rad) by which the last step turned a block.
    fn turn(&self, block: BlockId) -> f64 {
        let covers = report::block_covers(self.model, self.mass_matrix, self.displacement, self.velocity, block);
        mechanics::turning(&covers) * self.dt_last
    }
}
