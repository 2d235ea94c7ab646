//! The second half of a step: who touches whom, and what contacts, supports and bolts answer.

use std::time::Instant;

use rayon::prelude::*;

use crate::contact::{
    self, Approach, BoltView, NarrowPhase, OtherConstraints, SearchView, SolverOptions, SolverReport,
};
use crate::cover::Weights;
use crate::geometry::Point;
use crate::state::Scratch;

use super::{Regime, Step};

/// Distance beyond the search cutoff, relative to the mesh size, that nodes may move before the next search.
const SKIN: f64 = 0.1;
/// Distance, relative to the mesh size, within which pairs are kept.
pub(crate) const CUTOFF: f64 = 0.25;
/// Gap, relative to the mesh size, within which a resting contact takes part in the iteration.
pub(super) const REACH: f64 = 0.005;

/// Contacts or points of the boundary below which a loop over them is not split between threads.
pub(super) const CONTACTS: usize = 2048;

impl Step<'_> {
    /// Current places of boundary points, and edges and nodes at them.
    pub(super) fn locate(&mut self) {
        let clock = Instant::now();
        let (model, scratch) = (self.model, &mut *self.scratch);
        let boundary = &model.boundary;
        let star = &model.covers.star_position;
        let displacement = &self.state.displacement;
        let place = |(covers, weights): (&[u32; 3], &Weights)| -> Point {
            (0..3).map(|k| (star[covers[k] as usize] + displacement[covers[k] as usize]) * weights[k]).sum()
        };
        if scratch.serial {
            scratch.place.clear();
            scratch.place.extend(boundary.covers.iter().zip(&boundary.weights).map(place));
        } else {
            let points = boundary.covers.par_iter().zip(&boundary.weights).with_min_len(CONTACTS);
            points.map(place).collect_into_vec(&mut scratch.place);
        }
        scratch.frames.update(boundary, &scratch.place, model.entrance.flush_sine, scratch.serial);
        scratch.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// Near pairs, when nodes have moved.
    pub(super) fn search(&mut self) {
        let clock = Instant::now();
        let (model, scratch) = (self.model, &mut *self.scratch);
        let boundary = &model.boundary;
        let size = model.covers.mesh.size;
        if self.state.neighbours.is_stale(boundary, &scratch.place, SKIN * size) {
            let view = SearchView {
                boundary,
                place: &scratch.place,
                cutoff: CUTOFF * size,
                removed: &self.state.removed,
                fixed: &scratch.mass_matrix.fixed,
                serial: scratch.serial,
            };
            scratch.search.search(&view, &mut self.state.neighbours);
            scratch.open_close.forget_order();
            self.state.counters.searches += 1;
        }
        scratch.seconds.search += clock.elapsed().as_secs_f64();
    }

    /// Gap (m) below which a contact takes part in an explicit step of `dt` (s).
    pub(super) fn reach(&self, dt: f64) -> f64 {
        REACH * self.model.covers.mesh.size + 8.0 * dt * self.scratch.speed_max
    }

    /// Contacts that take part in an explicit step of `dt` (s), and how they answer.
    pub(super) fn touch(&mut self, dt: f64) {
        self.entrance(self.reach(dt), self.state.dt_last, Some(dt));
    }

    /// Contacts nearer than `reach` (m), in an explicit step of `dt` (s) with how they answer; covers have moved for
    /// `dt_last` (s) with the velocities of the state.
    pub(super) fn entrance(&mut self, reach: f64, dt_last: f64, dt: Option<f64>) {
        let clock = Instant::now();
        let damping = match self.regime {
            Regime::Dynamic { damping } => Some(damping),
            Regime::Static { .. } => None,
        };
        let (model, state, scratch) = (self.model, &*self.state, &mut *self.scratch);
        let size = model.covers.mesh.size;
        scratch.contact_cache.index(&state.contacts, model.boundary.node_count());
        scratch.penetrating.index(&model.boundary, &scratch.frames, &state.contacts);
        let approach = |dt| Approach { predicted: &scratch.predicted, dt, kick: 0.5 * (dt_last + dt), damping };
        let narrow = NarrowPhase {
            boundary: &model.boundary,
            place: &scratch.place,
            frames: &scratch.frames,
            star: &model.covers.star_position,
            displacement: &state.displacement,
            mass_matrix: &scratch.mass_matrix,
            motion: &scratch.motion,
            laws: &state.laws,
            trace_law: &scratch.trace_law,
            strength: state.drive.strength_factor(state.drive.share(self.time)),
            default_law: state.law_switch.get(model.default_law as usize).copied().unwrap_or_default(),
            velocity: &state.velocity,
            dt_last,
            history: &state.contacts,
            cache: &scratch.contact_cache,
            penetrating: &scratch.penetrating,
            approach: dt.map(approach),
            size,
            rule: model.entrance,
            flush_cosine: model.entrance.flush_cosine(),
            reach,
            theta: model.theta,
            first: state.step == 0,
            in_situ: model.in_situ.as_ref(),
            serial: scratch.serial,
        };
        let near_pairs = &state.neighbours.pairs;
        contact::entrance_edges(&narrow, near_pairs, &mut scratch.accepted, &mut scratch.contacts);
        scratch.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// How supports and bolts answer in a step of `dt` (s).
    pub(super) fn answer(&mut self, dt: f64) {
        let clock = Instant::now();
        self.load_supports(dt);
        self.load_bolts();
        self.scratch.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// Bolts that bear in this step.
    pub(super) fn load_bolts(&mut self) {
        let (model, state, scratch) = (self.model, &*self.state, &mut *self.scratch);
        let view = BoltView {
            star: &model.covers.star_position,
            displacement: &state.displacement,
            predicted: &scratch.predicted,
            mass_matrix: &scratch.mass_matrix,
            motion: &scratch.motion,
        };
        let rows = model.bolts.iter().zip(&state.bolts).enumerate();
        let bearing = rows.filter(|(_, (_, bolt))| bolt.active && !bolt.broken);
        scratch.bolts.clear();
        scratch.bolts.extend(bearing.map(|(k, (segment, bolt))| segment.row(k as u32, bolt, &view)));
    }

    /// Open–close iteration on the predicted velocities.
    pub(super) fn open_close(&mut self, dt: f64) -> SolverReport {
        let clock = Instant::now();
        let kick = 0.5 * (self.state.dt_last + dt);
        let (model, scratch) = (self.model, &mut *self.scratch);
        let Scratch { open_close, contacts, rows, bolts, increment, push, mass_matrix, serial, .. } = scratch;
        let (theta, tolerance, sweeps_max) = (model.theta, model.tolerance, model.sweeps_max);
        let options = SolverOptions { dt, kick, theta, tolerance, sweeps_max, serial: *serial };
        let (near_pairs, block_covers) = (&self.state.neighbours.pairs, &model.covers.block_covers);
        open_close.arrange(&model.boundary, near_pairs, mass_matrix, block_covers, contacts);
        let swept = open_close.run(mass_matrix, &options, contacts, &mut OtherConstraints { rows, bolts });
        open_close.impulses(mass_matrix, increment, push);
        scratch.seconds.sweep += clock.elapsed().as_secs_f64();
        swept
    }
}
