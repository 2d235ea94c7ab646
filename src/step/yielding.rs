//! Rock that yields: plastic strain at the current displacements, before forces are taken from it.

use rayon::prelude::*;

use crate::mechanics::{PlasticStrain, YieldSurface};
use crate::state::{Scratch, Slope, State};

/// Elements that are summed and shared between threads as one run: fixed, so that sums do not depend on the threads.
const RUN: usize = 1024;

/// Brings the plastic strain of all elements to the current displacements under the strength of time `time` (s), and
/// books what that takes (Eqs. Y4, Y5). Done twice at the same displacements it changes nothing.
pub fn update(slope: &Slope, state: &mut State, scratch: &mut Scratch, time: f64) {
    if state.plastic.is_empty() {
        return;
    }
    let factor = state.drive.strength_factor(state.drive.share(time));
    scratch.surfaces.clear();
    scratch.surfaces.extend(slope.strengths.iter().map(|s| s.map(|strength| strength.surface(factor))));
    scratch.yielded.clear();
    scratch.yielded.resize(state.plastic.len().div_ceil(RUN), 0.0);
    let State { plastic, displacement, removed, .. } = state;
    let pass = Pass { slope, surfaces: &scratch.surfaces, displacement, removed };
    let runs = scratch.yielded.iter_mut().zip(plastic.chunks_mut(RUN)).enumerate();
    if scratch.serial {
        runs.for_each(|(k, (energy, plastic))| *energy = pass.run(k * RUN, plastic));
    } else {
        let runs = scratch.yielded.par_iter_mut().zip(plastic.par_chunks_mut(RUN)).enumerate();
        runs.for_each(|(k, (energy, plastic))| *energy = pass.run(k * RUN, plastic));
    }
    state.ledger.yielding += scratch.yielded.iter().sum::<f64>();
}

/// What all runs share.
struct Pass<'a> {
    slope: &'a Slope,
    surfaces: &'a [Option<YieldSurface>],
    displacement: &'a [crate::geometry::Vector],
    removed: &'a [bool],
}

impl Pass<'_> {
    /// Updates the elements from `first` on; returns the energy (J/m) that it takes.
    fn run(&self, first: usize, plastic: &mut [PlasticStrain]) -> f64 {
        let covers = &self.slope.covers;
        let mut energy = 0.0;
        for (element, plastic) in (first..).zip(plastic) {
            let Some(surface) = &self.surfaces[self.slope.element_rock[element] as usize] else { continue };
            if self.removed[covers.element_block[element] as usize] {
                continue;
            }
            if let Some((after, taken)) = self.slope.yielded(element, surface, self.displacement, plastic) {
                *plastic = after;
                energy += taken * covers.element_area[element];
            }
        }
        energy
    }
}
