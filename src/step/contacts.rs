//! Who touches whom: positions of the boundary, near pairs, and the contacts of a sub-step of either integrator.

use std::time::Instant;

use crate::contact::{self, EdgeId, NarrowPhase, SearchView, VertexRule};
use crate::geometry::Point;

use super::Step;

/// Contacts or points of the boundary below which a loop over them is not split between threads.
pub(super) const CONTACTS: usize = 2048;

impl Step<'_> {
    /// Current positions of boundary points, and edges and nodes at them.
    pub fn locate(&mut self) {
        let clock = Instant::now();
        let (model, workspace) = (self.model, &mut *self.workspace);
        let boundary = &model.boundary;
        let star = &model.covers.star_position;
        let displacement = &self.state.displacement;
        let position = |point: EdgeId| -> Point {
            let (covers, weights) = (&boundary.covers[point], &boundary.weights[point]);
            (0..3).map(|k| (star[covers[k]] + displacement[covers[k]]) * weights[k]).sum()
        };
        workspace.frames.update(boundary, position, workspace.serial);
        workspace.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// Near pairs, when nodes have moved.
    pub fn search(&mut self) {
        let clock = Instant::now();
        let (model, workspace) = (self.model, &mut *self.workspace);
        let boundary = &model.boundary;
        let size = model.covers.mesh.size;
        if self.state.neighbours.is_stale(boundary, &workspace.frames, model.entrance.skin() * size) {
            let view = SearchView {
                boundary,
                frames: &workspace.frames,
                cutoff: model.entrance.cutoff * size,
                removed: &self.state.removed,
                fixed: &workspace.mass_matrix.fixed,
                serial: workspace.serial,
            };
            workspace.search.search(&view, &mut self.state.neighbours);
            workspace.open_close.forget_order();
            workspace.near_sides.forget();
            self.state.counters.searches += 1;
        }
        workspace.seconds.search += clock.elapsed().as_secs_f64();
    }

    /// Contacts nearer than `reach` (m); an explicit sub-step is `dt` (s) long, and 0 stands for an implicit one.
    pub fn entrance(&mut self, reach: f64, dt: f64) {
        let clock = Instant::now();
        let (model, state, workspace) = (self.model, &*self.state, &mut *self.workspace);
        let size = model.covers.mesh.size;
        workspace.strength = state.drive.strength_factor(state.drive.share(self.time));
        workspace.near_sides.list(&state.neighbours.pairs);
        workspace.contact_cache.index(&state.contacts, model.boundary.node_count());
        workspace.penetrating.index(&model.boundary, &workspace.frames, &state.contacts);
        let rule = VertexRule {
            boundary: &model.boundary,
            frames: &workspace.frames,
            history: &state.contacts,
            cache: &workspace.contact_cache,
            penetrating: &workspace.penetrating,
            size,
            constants: model.entrance,
            flush_cosine: model.entrance.flush_cosine(),
            reach,
        };
        let narrow = NarrowPhase {
            rule,
            star: &model.covers.star_position,
            displacement: &state.displacement,
            laws: &state.laws,
            trace_law: &workspace.trace_law,
            default_law: state.law_switch[model.default_law],
            velocity: &state.velocity,
            dt,
            first: state.step == 0,
            in_situ: model.in_situ.as_ref(),
            serial: workspace.serial,
        };
        let (near_pairs, near_sides) = (&state.neighbours.pairs, &workspace.near_sides);
        contact::entrance_edges(&narrow, near_pairs, near_sides, &mut workspace.accepted, &mut workspace.contacts);
        workspace.seconds.entrance += clock.elapsed().as_secs_f64();
    }
}
