//! Rock that yields: plastic strain at the current displacements, before forces are taken from it.

use std::ops::Range;

use enmm_lanes::{First, LANES, Values};
use rayon::prelude::*;

use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::Vector;
use crate::mechanics::{
    self, Averages, Deformation, ElementRow, MassMatrix, PlasticStrain, RUN, Strained, YieldSurface, fill_runs,
};
use crate::state::{Flow, Grown, Model, State, YieldBuffers};

use super::lane_work::{LaneWork, in_lanes};
use super::{Substep, report};

/// Brings the plastic strain of all elements to the current displacements under the strength of this time, and books
/// what that takes (Eqs. 57, 58). Done twice at the same displacements it only comes nearer to the surface where
/// neighbours flow unlike each other (Eq. 58c).
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
    buffers.surfaces.extend(model.surfaces(factor));
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
        let row = ElementRow::new(&model.covers, &model.averaging, e.index()..e.index() + 1);
        let [to, _] = row.averaged(First, &averages.patch_mean, averages.mean[e]);
        Some(surface.taken_by_others(&grown.strain, grown.mean, to) * model.covers.element_area[e])
    };
    flows.iter().map(|flow| flow.grown.iter().filter_map(of_element).sum::<f64>()).sum()
}

/// Elastic volume changes of all elements that can yield, and what the last step brought of them.
fn volumes(model: &Model, state: &State, serial: bool, volume: &mut Vec<[f64; 2]>) {
    volume.resize(state.plastic.len(), [0.0; 2]);
    fill_runs(serial, volume, |first, volume| {
        in_lanes(model, first..first + volume.len(), Volumes { model, state, first, volume });
    });
}

/// Volume changes of a run of elements from `first` on.
struct Volumes<'a> {
    model: &'a Model,
    state: &'a State,
    first: usize,
    volume: &'a mut [[f64; 2]],
}

impl LaneWork for Volumes<'_> {
    #[inline(always)]
    fn elements<V: Values>(&mut self, values: V, row: &ElementRow, elements: Range<usize>) {
        let Self { model, state, first, .. } = *self;
        let Some(strength) = model.strength_of(ElementId::new(elements.start)) else { return };
        let at = row.deformation(values, &state.displacement, &model.covers.gradients);
        let (dt, [a, b, c]) = (values.splat(state.dt_last), row.of_covers(values, &state.velocity));
        let moved = [[a[0] * dt, a[1] * dt], [b[0] * dt, b[1] * dt], [c[0] * dt, c[1] * dt]];
        let brought = at.dilatation_by(&moved, &row.gradients(values, &model.covers.gradients));
        let plastic = ElementRow::plastic(values, &state.plastic[elements.clone()]);
        let own = strength.own_volume(&at, &plastic);
        store(values, [own, brought], &mut self.volume[elements.start - first..elements.end - first]);
    }
}

/// Writes pairs of values that elements have.
#[inline(always)]
fn store<V: Values>(values: V, [a, b]: [V::F; 2], out: &mut [[f64; 2]]) {
    let mut lanes = [[0.0; LANES]; 2];
    values.store(a, &mut lanes[0]);
    values.store(b, &mut lanes[1]);
    for (lane, out) in out.iter_mut().enumerate() {
        *out = [lanes[0][lane], lanes[1][lane]];
    }
}

/// Averages volume changes and mean stresses over patches (Eqs. 58a, 58b).
fn average(model: &Model, serial: bool, averages: &mut Averages) {
    averages.average_volume(&model.averaging, serial);
    let Averages { volume, mean, patch_volume, .. } = averages;
    mean.resize(volume.len(), [0.0; 2]);
    fill_runs(serial, mean, |first, mean| {
        in_lanes(model, first..first + mean.len(), Means { model, first, volume, patch_volume, mean });
    });
    averages.average_mean(&model.averaging, serial);
}

/// Mean stresses of a run of elements from `first` on.
struct Means<'a> {
    model: &'a Model,
    first: usize,
    volume: &'a [[f64; 2]],
    patch_volume: &'a [[f64; 2]],
    mean: &'a mut [[f64; 2]],
}

impl LaneWork for Means<'_> {
    #[inline(always)]
    fn elements<V: Values>(&mut self, values: V, row: &ElementRow, elements: Range<usize>) {
        let Some(strength) = self.model.strength_of(ElementId::new(elements.start)) else { return };
        let own = ElementRow::own(values, &self.volume[elements.clone()]);
        let [volume, brought] = row.averaged(values, self.patch_volume, own);
        let stiffness = values.splat(strength.mean_stress(1.0));
        let out = &mut self.mean[elements.start - self.first..elements.end - self.first];
        store(values, [stiffness * volume, stiffness * brought], out);
    }
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
        flow.energy = 0.0;
        flow.grown.clear();
        let elements = first..first + plastic.len();
        in_lanes(self.model, elements, Flowing { pass: self, first, plastic, volume, flow, turn: None });
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

/// The flow of a run of elements from `first` on.
struct Flowing<'a> {
    pass: &'a Pass<'a>,
    first: usize,
    plastic: &'a mut [PlasticStrain],
    volume: &'a mut [[f64; 2]],
    flow: &'a mut Flow,
    /// Turn of the last block asked for.
    turn: Option<(BlockId, f64)>,
}

impl LaneWork for Flowing<'_> {
    #[inline(always)]
    fn elements<V: Values>(&mut self, values: V, row: &ElementRow, elements: Range<usize>) {
        let Pass { model, surfaces, averages, displacement, .. } = *self.pass;
        let Some(surface) = &surfaces[model.element_rock[elements.start] as usize] else { return };
        let own = ElementRow::own(values, &averages.mean[elements.clone()]);
        let averaged = row.averaged(values, &averages.patch_mean, own);
        let deformation = row.deformation(values, displacement, &model.covers.gradients);
        let here = elements.start - self.first..elements.end - self.first;
        let plastic = ElementRow::plastic(values, &self.plastic[here]);
        let pre = pre_stress(values, model, elements.clone());
        let trial = surface.trial(&Strained { deformation, mean: averaged[0] }, pre.as_ref(), &plastic);
        let inside = surface.inside(values, &trial);
        if inside == u8::MAX {
            return;
        }
        let mut out = [[0.0; LANES]; 6];
        let [xx, yy, xy, zz] = trial;
        for (value, out) in [xx, yy, xy, zz, averaged[0], averaged[1]].into_iter().zip(&mut out) {
            values.store(value, out);
        }
        for (lane, e) in ElementId::range(elements).enumerate() {
            if inside & 1 << lane == 0 && !self.pass.removed[model.covers.element_block[e]] {
                let [trial @ .., mean, brought] = out.map(|values| values[lane]);
                if let Some(growth) = model.flow(surface, e, trial) {
                    self.grow(surface, e, [mean, brought], &growth);
                }
            }
        }
    }
}

/// In-situ stress xx, yy, xy, zz (Pa) of some elements; none when the model has none.
#[inline(always)]
fn pre_stress<V: Values>(values: V, model: &Model, elements: Range<usize>) -> Option<[V::F; 4]> {
    if model.pre_stress.is_empty() {
        return None;
    }
    let mut pre = [[0.0; LANES]; 4];
    for (lane, e) in ElementId::range(elements).enumerate() {
        let of_element = model.pre_stress_and_out(e);
        (0..4).for_each(|k| pre[k][lane] = of_element[k]);
    }
    let [xx, yy, xy, zz] = &pre;
    Some([values.load(xx), values.load(yy), values.load(xy), values.load(zz)])
}

impl Flowing<'_> {
    /// Books the growth of an element under a mean stress of which the last step has brought a part.
    #[inline(never)]
    fn grow(&mut self, surface: &YieldSurface, element: ElementId, [mean, brought]: [f64; 2], growth: &PlasticStrain) {
        let Pass { model, displacement, .. } = self.pass;
        let plastic = &mut self.plastic[element.index() - self.first];
        let at = Strained { deformation: model.deformation(element, displacement), mean };
        let deformation = self.pass.before(element, &at.deformation, &mut self.turn);
        let from = Strained { deformation, mean: mean - brought };
        let pre = model.pre_stress_and_out(element);
        self.flow.energy += surface.taken(&from, &at, &pre, [plastic, growth]) * model.covers.element_area[element];
        (0..4).for_each(|k| plastic[k] += growth[k]);
        self.volume[element.index() - self.first][0] -= surface.volume(growth);
        self.flow.grown.push(Grown { element, strain: *growth, mean });
    }
}
