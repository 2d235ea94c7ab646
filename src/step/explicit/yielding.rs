//! Rock that yields: plastic strain at the current displacements, before forces are taken from it.

use rayon::prelude::*;

use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::Vector;
use crate::mechanics::{self, Deformation, MassMatrix, PlasticStrain, YieldSurface};
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
    YieldBuffers { surfaces, energy: taken }: &mut YieldBuffers,
) {
    if state.plastic.is_empty() {
        return;
    }
    let factor = state.drive.strength_factor(state.drive.share(step.time));
    surfaces.clear();
    surfaces.extend(model.strengths.iter().map(|s| s.map(|strength| strength.surface(factor))));
    taken.clear();
    taken.resize(state.plastic.len().div_ceil(RUN), 0.0);
    let State { plastic, displacement, velocity, dt_last, removed, .. } = state;
    let pass = Pass { model, surfaces, mass_matrix, displacement, velocity, dt_last: *dt_last, removed };
    let run = |(k, (energy, plastic)): (usize, (&mut f64, &mut [PlasticStrain]))| *energy = pass.run(k * RUN, plastic);
    if step.serial {
        taken.iter_mut().zip(plastic.chunks_mut(RUN)).enumerate().for_each(run);
    } else {
        taken.par_iter_mut().zip(plastic.par_chunks_mut(RUN)).enumerate().for_each(run);
    }
    state.ledger.yielding += taken.iter().sum::<f64>();
}

/// Data that all runs share.
struct Pass<'a> {
    model: &'a Model,
    surfaces: &'a [Option<YieldSurface>],
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
            let (at, pre) =
                (self.model.deformation(element, self.displacement), self.model.pre_stress_and_out(element));
            if let Some(growth) = surface.growth(&at, &pre, plastic) {
                let taken = surface.taken(&self.before(element, &at, &mut turn), &at, &pre, [plastic, &growth]);
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
        let moved = covers.element_covers[element].map(|i: CoverId| self.velocity[i] * self.dt_last);
        now.before(moved, angle, &covers.gradients[covers.element_triangle[element].set as usize])
    }

    /// Angle (rad) by which the last step turned a block.
    fn turn(&self, block: BlockId) -> f64 {
        let covers = report::block_covers(self.model, self.mass_matrix, self.displacement, self.velocity, block);
        mechanics::turning(&covers) * self.dt_last
    }
}
