//! Rock that yields: plastic strain at the current displacements, before forces are taken from it.

use rayon::prelude::*;

use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::Vector;
use crate::mechanics::{self, Averages, Deformation, MassMatrix, PlasticStrain, Strained, YieldSurface, list};
use crate::state::{Flow, Grown, Model, State, YieldBuffers};

use super::{Substep, report};

/// Elements that are summed and shared between threads as one run: fixed, so that sums do not depend on the threads.
const RUN: usize = 1024;

/// Brings the plastic strain of all elements to the current displacements under the strength of this time, and books
/// what that takes (Eqs. 57, 58). Done twice at the same displacements
/// it only comes nearer to the surface where neighbours flow unlike each other (Eq. 58c).
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
    volumes(model, state, step.serial, &mut buffers.averages.volume);
    average(model, step.serial, &mut buffers.averages);
    flow(model, state, step.serial, mass_matrix, buffers);
    state.ledger.yielding += buffers.flows.iter().map(|flow| flow.energy).sum::<f64>();
    if buffers.flows.iter().any(|flow| !flow.grown.is_empty()) {
        average(model, step.serial, &mut buffers.averages);
        state.ledger.yielding += taken_by_others(model, buffers);
    }
}

/// Energy (J/m) that all growth takes beyond that of each element alone.
fn taken_by_others(model: &Model, YieldBuffers { surfaces, flows, averages }: &YieldBuffers) -> f64 {
    let of_element = |grown: &Grown| {
        let e = grown.element;
        let surface = surfaces[model.element_rock[e] as usize].as_ref()?;
        let [_, [to, _]] = averages.felt(&model.averaging, e, averages.volume[e]);
        Some(surface.taken_by_others(&grown.strain, grown.mean, to) * model.covers.element_area[e])
    };
    flows.iter().map(|flow| flow.grown.iter().filter_map(of_element).sum::<f64>()).sum()
}

/// Elastic volume changes of all elements that can yield, and what the last step brought of them.
fn volumes(model: &Model, state: &State, serial: bool, volume: &mut Vec<[f64; 2]>) {
    let State { displacement, velocity, dt_last, plastic, .. } = state;
    list(serial, plastic.len(), volume, |k| {
        let e = ElementId::new(k);
        let Some(strength) = model.strength_of(e) else { return [0.0; 2] };
        let at = model.deformation(e, displacement);
        let brought = at.dilatation_by(moved(model, e, velocity, *dt_last), gradients(model, e));
        [strength.own_volume(&at, &plastic[e]), brought]
    });
}

/// Averages volume changes and mean stresses over patches (Eqs. 58a, 58b).
fn average(model: &Model, serial: bool, averages: &mut Averages) {
    averages.average(&model.averaging, serial, |e, [volume, brought]| match model.strength_of(e) {
        Some(strength) => [volume, brought].map(|volume| strength.mean_stress(volume)),
        None => [0.0; 2],
    });
}

/// Brings the plastic strain of all elements to the current displacements, and notes what grows.
fn flow(model: &Model, state: &mut State, serial: bool, mass_matrix: &MassMatrix, buffers: &mut YieldBuffers) {
    let YieldBuffers { surfaces, flows, averages } = buffers;
    let State { plastic, displacement, velocity, dt_last, removed, .. } = state;
    flows.resize_with(plastic.len().div_ceil(RUN), Flow::default);
    // Each run changes the volumes of its own elements; those of patches stay as they were.
    let mut volume = std::mem::take(&mut averages.volume);
    let dt_last = *dt_last;
    let pass = Pass { model, surfaces, averages, mass_matrix, displacement, velocity, dt_last, removed };
    let run = |(k, ((flow, plastic), volume)): (usize, Run)| pass.run(k * RUN, plastic, volume, flow);
    if serial {
        flows.iter_mut().zip(plastic.chunks_mut(RUN)).zip(volume.chunks_mut(RUN)).enumerate().for_each(run);
    } else {
        let runs = flows.par_iter_mut().zip(plastic.par_chunks_mut(RUN)).zip(volume.par_chunks_mut(RUN));
        runs.enumerate().for_each(run);
    }
    averages.volume = volume;
}

/// How a run of elements flows, with its plastic strains and volume changes.
type Run<'a> = ((&'a mut Flow, &'a mut [PlasticStrain]), &'a mut [[f64; 2]]);

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
    averages: &'a Averages,
    mass_matrix: &'a MassMatrix,
    displacement: &'a [Vector],
    velocity: &'a [Vector],
    dt_last: f64,
    removed: &'a [bool],
}

impl Pass<'_> {
    /// Updates the elements from `first` on.
    fn run(&self, first: usize, plastic: &mut [PlasticStrain], volume: &mut [[f64; 2]], flow: &mut Flow) {
        let covers = &self.model.covers;
        let mut turn = None;
        flow.energy = 0.0;
        flow.grown.clear();
        let elements = ElementId::range(first..first + plastic.len());
        for (element, (plastic, own)) in elements.zip(plastic.iter_mut().zip(volume)) {
            let Some(surface) = &self.surfaces[self.model.element_rock[element] as usize] else { continue };
            if self.removed[covers.element_block[element]] {
                continue;
            }
            let [_, [mean, brought]] = self.averages.felt(&self.model.averaging, element, *own);
            let at = Strained { deformation: self.model.deformation(element, self.displacement), mean };
            let pre = self.model.pre_stress_and_out(element);
            if let Some(growth) = surface.growth(&at, &pre, plastic) {
                let deformation = self.before(element, &at.deformation, &mut turn);
                let from = Strained { deformation, mean: mean - brought };
                flow.energy += surface.taken(&from, &at, &pre, [plastic, &growth]) * covers.element_area[element];
                (0..4).for_each(|k| plastic[k] += growth[k]);
                own[0] -= surface.volume(&growth);
                flow.grown.push(Grown { element, strain: growth, mean });
            }
        }
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
