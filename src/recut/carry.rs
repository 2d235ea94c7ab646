//! The state of a model as it goes on after a cut.

use crate::contact::{BoltState, Release};
use crate::cover::{BlockId, CoverId};
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::{Cut, Drive, Events, Inputs, Model, State, WorstSection};
use crate::step;

use super::contacts::carry_contacts;
use super::lineage::Lineage;

/// The state after a cut of a model between two stages, whose blocks were free by `masses`. Displacements and
/// velocities of all points stay, but for a spin that keeps the angular momentum of a block that has come apart.
pub fn carry(lineage: &Lineage, before: (&Model, &State), masses: &MassMatrix, new: &Model) -> State {
    carry_over(lineage, before, masses, new, None)
}

/// The state after a cut of a stage or a section that has broken.
fn carry_over(
    lineage: &Lineage,
    (old, was): (&Model, &State),
    masses: &MassMatrix,
    new: &Model,
    broken: Option<&Cut>,
) -> State {
    let parents = &lineage.parents;
    let mut state = was.clone();
    state.displacement = part_of(&was.displacement, parents.covers.iter().map(|c| c.index()));
    state.velocity = part_of(&was.velocity, parents.covers.iter().map(|c| c.index()));
    if !was.since.is_empty() {
        state.since = part_of(&was.since, parents.covers.iter().map(|c| c.index()));
    }
    state.removed = part_of(&was.removed, parents.blocks.iter().map(|b| b.index()));
    state.support_force = part_of(&was.support_force, lineage.supports.iter().copied());
    state.support_rest = part_of(&was.support_rest, lineage.supports.iter().copied());
    if !was.plastic.is_empty() {
        state.plastic = part_of(&was.plastic, parents.elements.iter().map(|e| e.index()));
    }
    if !was.worst_sections.is_empty() {
        state.worst_sections = worst_sections(lineage, was);
    }
    state.sections = lineage.sections.iter().map(|section| section.and_then(|k| was.sections[k])).collect();
    state.cuts.extend(broken);
    // The stage that begins takes its own.
    state.stage_displacement.clear();
    state.stage_force.clear();
    state.neighbours.forget();
    state.found.forget();
    carry_events(lineage, &mut state.events, new);
    carry_inputs(lineage, &mut state.drive);
    carry_bolts(lineage, (old, was), new, &mut state);
    keep_spin(lineage, (old, was), masses, new, &mut state);
    carry_contacts(lineage, (old, was), new, broken, &mut state);
    state
}

/// The state after a section of rock has broken in the middle of a stage.
pub fn carry_break(
    lineage: &Lineage,
    before: (&Model, &State),
    masses: &MassMatrix,
    new: &Model,
    broken: &Cut,
) -> State {
    let (old, was) = before;
    let mut state = carry_over(lineage, before, masses, new, Some(broken));
    if !was.stage_displacement.is_empty() {
        let covers = || lineage.parents.covers.iter();
        state.stage_displacement = part_of(&was.stage_displacement, covers().map(|c| c.index()));
        let mass = |k: usize, parent: usize| new.mass_matrix.row_sum[k] / old.mass_matrix.row_sum[parent];
        let share = |(k, parent): (usize, &CoverId)| was.stage_force[parent.index()] * mass(k, parent.index());
        state.stage_force = covers().enumerate().map(share).collect();
    }
    release(lineage, new, &mut state, broken.time);
    state
}

/// Begins to let go of sections that have just broken: of what their bonds carry.
fn release(lineage: &Lineage, new: &Model, state: &mut State, time: f64) {
    let strength = state.drive.strength_factor_now(time);
    let mut carried = vec![[0.0_f64; 2]; new.sections.list.len()];
    for (contact, bond) in state.contacts.iter().zip(&state.bonds) {
        let Some(section) = bond.section.filter(|section| lineage.sections[section.index()].is_none()) else {
            continue;
        };
        let law = &state.laws[bond.law];
        let own = law.section_bond([0.0; 2], bond.lengths[1], strength, [f64::INFINITY; 2]);
        let used = own.used([contact.normal_force, contact.shear_force]);
        carried[section.index()] = [0, 1].map(|k| carried[section.index()][k].max(used[k]));
    }
    for (k, _) in lineage.sections.iter().enumerate().filter(|(_, parent)| parent.is_none()) {
        state.sections[k] = Some(Release { carried: carried[k], left: 1.0 });
    }
}

/// The worst sections of the blocks that stay whole; those of parts are yet to be looked for.
fn worst_sections(lineage: &Lineage, was: &State) -> Vec<WorstSection> {
    let mut parts = vec![0; was.worst_sections.len()];
    lineage.parents.blocks.iter().for_each(|parent| parts[parent.index()] += 1);
    let of = |parent: &BlockId| match parts[parent.index()] {
        1 => was.worst_sections[*parent],
        _ => WorstSection::default(),
    };
    lineage.parents.blocks.iter().map(of).collect()
}

/// What parts have of the whole that they were.
fn part_of<T: Copy>(whole: &[T], parents: impl Iterator<Item = usize>) -> Vec<T> {
    parents.map(|parent| whole[parent]).collect()
}

fn carry_events(lineage: &Lineage, events: &mut Events, new: &Model) {
    let blocks = || lineage.parents.blocks.iter().map(|b| b.index());
    for list in [&mut events.touching, &mut events.detached, &mut events.failed] {
        *list = part_of(list, blocks());
    }
    let new_traces = new.trace_law.len() - lineage.traces;
    let joints = lineage.traces..lineage.traces;
    events.slipped.splice(joints, std::iter::repeat_n(false, new_traces));
    if !events.bonded.is_empty() {
        events.bonded.resize(new.trace_law.len(), false);
    }
    for pair in &mut events.overlapped {
        *pair = pair.map(|block| lineage.heirs[block]);
        pair.sort_unstable();
    }
    events.overlapped.sort_unstable();
}

/// Forces on a block go on to act on the part that keeps its number.
fn carry_inputs(lineage: &Lineage, drive: &mut Drive) {
    let blocks = lineage.parents.blocks.len();
    let carry = |inputs: &mut Inputs| {
        let mut force = vec![Vector::zeros(); blocks];
        let mut moment = vec![0.0; blocks];
        for (old, &heir) in lineage.heirs.iter().enumerate() {
            (force[heir.index()], moment[heir.index()]) = (inputs.block_force[old], inputs.block_moment[old]);
        }
        (inputs.block_force, inputs.block_moment) = (force, moment);
    };
    carry(&mut drive.from);
    carry(&mut drive.to);
}

/// A bar that a cut crosses begins to be stretched there.
fn carry_bolts(lineage: &Lineage, (old, was): (&Model, &State), new: &Model, state: &mut State) {
    let is_there = |bolt: u32| old.bolts.iter().zip(&was.bolts).any(|(of, bar)| of.bolt == bolt && bar.active);
    let segments = new.bolts.iter().zip(&lineage.bolts);
    state.bolts = segments
        .map(|(segment, parent)| match parent {
            Some(k) => was.bolts[*k],
            None if is_there(segment.bolt) => {
                let length = segment.span(&new.covers.star_position, &state.displacement).norm();
                BoltState { active: true, rest: length, natural: length, ..BoltState::default() }
            }
            None => BoltState::default(),
        })
        .collect();
}

/// Centroid (m), its velocity (m/s), spin (rad/s) and kinetic energy (J/m) of a block.
fn motion(model: &Model, state: &State, block: BlockId) -> (Vector, Vector, f64, f64) {
    step::block_motion(model, state, &model.mass_matrix, block)
}

/// Angular momentum (kg·m²/s per metre) of blocks about the origin.
fn angular(model: &Model, state: &State, blocks: &[BlockId]) -> f64 {
    let of = |&block: &BlockId| {
        let (centre, velocity, spin, _) = motion(model, state, block);
        model.mass_matrix.total[block] * centre.perp(&velocity) + model.mass_matrix.polar[block] * spin
    };
    blocks.iter().map(of).sum()
}

/// Kinetic energy (J/m) of blocks.
fn kinetic(model: &Model, state: &State, blocks: &[BlockId]) -> f64 {
    blocks.iter().map(|&block| motion(model, state, block).3).sum()
}

/// Gives the parts of each free block that has come apart one spin by which they have its angular momentum, and takes
/// what they would have more of its kinetic energy.
fn keep_spin(lineage: &Lineage, (old, was): (&Model, &State), masses: &MassMatrix, new: &Model, state: &mut State) {
    let mut parts = vec![Vec::new(); old.covers.block_count()];
    for (block, &parent) in new.covers.blocks().zip(&lineage.parents.blocks) {
        parts[parent.index()].push(block);
    }
    for (parent, parts) in old.covers.blocks().zip(&parts) {
        if parts.len() < 2 || !masses.is_free(parent) {
            continue;
        }
        let without = angular(new, state, parts);
        turn(new, state, parts, 1.0);
        let of_unit = angular(new, state, parts) - without;
        turn(new, state, parts, (angular(old, was, &[parent]) - without) / of_unit - 1.0);
        calm(new, state, parts, kinetic(old, was, &[parent]));
    }
}

/// Adds a spin (rad/s) to the velocities of blocks, of each about its own centroid.
fn turn(model: &Model, state: &mut State, blocks: &[BlockId], spin: f64) {
    for &block in blocks {
        let centre = motion(model, state, block).0;
        for i in CoverId::range(model.covers.covers_of(block)) {
            let arm = model.covers.star_position[i] + state.displacement[i] - centre;
            state.velocity[i] += Vector::new(-arm.y, arm.x) * spin;
        }
    }
}

/// Slows the motion of blocks within themselves so that they have no more kinetic energy than `most` (J/m), and keeps
/// their momentum and angular momentum.
fn calm(model: &Model, state: &mut State, blocks: &[BlockId], most: f64) {
    let all = kinetic(model, state, blocks);
    if all <= most {
        return;
    }
    let moved = state.velocity.clone();
    for &block in blocks {
        let (_, velocity, spin, _) = motion(model, state, block);
        state.velocity[model.covers.covers_of(block)].fill(velocity);
        turn(model, state, &[block], 1.0);
        let of_unit = motion(model, state, block).2;
        turn(model, state, &[block], spin / of_unit - 1.0);
    }
    let within = all - kinetic(model, state, blocks);
    let share = (1.0 - (all - most) / within).max(0.0).sqrt();
    for i in blocks.iter().flat_map(|&block| CoverId::range(model.covers.covers_of(block))) {
        let within = (moved[i] - state.velocity[i]) * share;
        state.velocity[i] += within;
    }
}
