//! Who touches whom: positions of the boundary, near pairs, and the contacts of a sub-step of either integrator.

use crate::contact::{
    self, BondHistory, EdgeId, Frames, NarrowPhase, NearPair, OpenClose, Release, SearchView, VertexEdge, VertexRule,
};
use crate::geometry::{Point, Vector};
use crate::state::{Model, SelectionBuffers, State};

use super::bonds::has_bonds;
use super::{Regime, Substep};

/// Contacts or points of the boundary below which a loop over them is not split between threads.
pub(super) const CONTACTS: usize = 2048;

/// Which near pairs become contacts.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    /// Gap (m) below which a contact takes part.
    pub gap: f64,
    /// Step (s) for which the default stiffness looks ahead; 0 in an implicit step.
    pub ahead: f64,
}

/// Current positions of boundary points, and edges and nodes at them.
pub fn locate(model: &Model, displacement: &[Vector], frames: &mut Frames, serial: bool) {
    let boundary = &model.boundary;
    let star = &model.covers.star_position;
    let position = |point: EdgeId| -> Point {
        let (covers, weights) = (&boundary.covers[point], &boundary.weights[point]);
        (0..3).map(|k| (star[covers[k]] + displacement[covers[k]]) * weights[k]).sum()
    };
    frames.update(boundary, position, serial);
}

/// Near pairs, when nodes have moved; the order of the sweep is then forgotten.
pub fn search(
    model: &Model,
    state: &mut State,
    fixed: &[bool],
    frames: &Frames,
    selection: &mut SelectionBuffers,
    open_close: &mut OpenClose,
    serial: bool,
) {
    if has_kept(selection) {
        return;
    }
    let boundary = &model.boundary;
    let size = model.covers.mesh.size;
    if state.neighbours.is_stale(frames, model.detection.skin() * size) {
        let cutoff = model.detection.cutoff * size;
        let view = SearchView { boundary, frames, cutoff, removed: &state.removed, fixed, serial };
        selection.grid.search(&view, &mut state.neighbours);
        if !selection.left_out.is_empty() {
            let block = |pair: &NearPair| boundary.block[boundary.nodes.point[pair.node]];
            state.neighbours.pairs.retain(|pair| selection.left_out.binary_search(&(block(pair), pair.side)).is_err());
        }
        selection.near_sides.forget();
        state.found.forget();
        open_close.forget_order();
        state.counters.searches += 1;
    }
}

/// Contacts within reach.
pub fn find_contacts(
    model: &Model,
    state: &State,
    step: &Substep,
    reach: Reach,
    frames: &Frames,
    selection: &mut SelectionBuffers,
    contacts: &mut Vec<VertexEdge>,
) {
    selection.strength = state.drive.strength_factor(state.drive.share(step.time));
    selection.section_share.clear();
    selection.section_share.extend(state.sections.iter().map(Release::shares));
    if has_kept(selection) {
        return keep(model, state, selection, contacts);
    }
    let SelectionBuffers { near_sides, accepted, cache, penetrating, trace_law, .. } = selection;
    near_sides.list(&model.boundary, &state.neighbours.pairs);
    cache.index(&state.contacts, model.boundary.node_count());
    penetrating.index(&model.boundary, frames, &state.contacts);
    let rule = VertexRule {
        boundary: &model.boundary,
        frames,
        history: &state.contacts,
        cache,
        penetrating,
        size: model.covers.mesh.size,
        constants: model.detection,
        flush_cosine: model.detection.flush_cosine(),
        reach: reach.gap,
    };
    let has_impacts = matches!(step.regime, Regime::Dynamic { .. }) && reach.ahead > 0.0;
    let narrow = NarrowPhase {
        rule,
        last: &state.found.contacts,
        found_at: state.found.kept_from(state.step, &model.detection),
        star: &model.covers.star_position,
        displacement: &state.displacement,
        laws: &state.laws,
        trace_law,
        default_law: state.law_switch[model.default_law],
        velocity: &state.velocity,
        dt: reach.ahead,
        impacts: has_impacts.then(|| &model.mass_matrix.inverse_total[..]),
        first: state.step == 0,
        softens: has_bonds(model, state),
        bonds: &state.bonds,
        sections: &model.sections,
        in_situ: model.in_situ.as_ref(),
        serial: step.serial,
    };
    contact::find_contacts(&narrow, &state.neighbours.pairs, near_sides, accepted, contacts);
    if let Some(gaps) = &mut selection.kept_gaps {
        gaps.extend(contacts.iter().map(|contact| -contact.penetration() - opened(model, state, contact)));
    }
}

/// Whether the contacts of an earlier step are those of this one.
fn has_kept(selection: &SelectionBuffers) -> bool {
    selection.kept_gaps.as_ref().is_some_and(|gaps| !gaps.is_empty())
}

/// Contacts of small displacements: normals, lengths and places are those of the step that found them, and gaps follow
/// the displacements to first order.
fn keep(model: &Model, state: &State, selection: &SelectionBuffers, contacts: &mut [VertexEdge]) {
    let gaps = selection.kept_gaps.iter().flatten();
    for (k, (contact, gap)) in contacts.iter_mut().zip(gaps).enumerate() {
        let history = state.contacts[k];
        let past = state.bonds.get(k).map_or(0.0, BondHistory::past);
        let gap = gap + opened(model, state, contact) - history.unloaded.gap();
        *contact = VertexEdge { history, gap, past, torn: false, fresh: false, delayed: false, ..*contact };
    }
}

/// How far (m) all displacements so far have opened a contact.
fn opened(model: &Model, state: &State, contact: &VertexEdge) -> f64 {
    contact.relative(&model.boundary, &state.displacement)[0]
}
