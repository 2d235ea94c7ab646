//! Works of the contacts in a sub-step, and their histories for the next one.

use enmm_lanes::{Kernel, Lanes, dispatch};
use rayon::prelude::*;

use crate::contact::{ContactHistory, ContactSetting, Crushed, SupportRow, VertexEdge};
use crate::geometry::Vector;
use crate::state::{ContactOutcome, Counters};

use super::contacts::CONTACTS;
use super::{Regime, Substep};

/// Time (s) in which the allowance of a contact that was first seen deep fades to 1/e.
const OFFSET_FADE: f64 = 0.5;

/// A run of contacts at the end of a sub-step of `dt` (s) in which their forces act for `kick` (s): compiled for every
/// kind of lanes.
struct Settle<'a> {
    contacts: &'a [VertexEdge],
    histories: &'a mut [ContactHistory],
    outcome: &'a mut ContactOutcome,
    setting: ContactSetting<'a>,
    /// Velocities (m/s) of the covers before and after the forces.
    velocities: [&'a [Vector]; 2],
    dt: f64,
    kick: f64,
    /// Share of an allowance that the sub-step leaves.
    fade: f64,
    /// Whether the stage is static, so that faces in touch have rested on each other.
    rests: bool,
}

impl Kernel for Settle<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let Self { outcome, setting, velocities, dt, kick, fade, rests, .. } = self;
        *outcome = ContactOutcome::default();
        for (contact, history) in self.contacts.iter().zip(self.histories) {
            // Not by `map` of an array, for which the contact would be written to memory.
            let relative = |velocity: &[Vector]| contact.relative(setting.boundary, velocity);
            let [before, after] = [relative(velocities[0]), relative(velocities[1])];
            let opening = contact.gap + after[0] * dt;
            let normal = contact.normal_after(opening, !rests, &setting);
            let (stored, slipped) = contact.shear_after(after[1] * dt, (opening, normal), &setting);
            let moved = [0, 1].map(|k| 0.5 * (before[k] + after[k]) * kick);
            let heat = (stored * slipped).abs();
            add_works(outcome, contact, moved, heat);
            let load = contact.lift_load(after[0] * dt);
            let lifted = setting.laws[contact.law].dilate(contact.history.way, slipped, heat, &load);
            outcome.dilation += lifted.work;
            add_depths(outcome, contact);
            *history = history_of(contact, stored, slipped, &setting);
            let crushed = contact.crush(&setting);
            add_crush(outcome, &crushed);
            (history.way, history.unloaded.rest) = (lifted.way, history.unloaded.rest + lifted.raised - crushed.closes);
            history.unloaded.offset *= fade;
            history.filtered_normal = contact.filtered_normal(&setting);
            if rests {
                history.meeting.age = f32::INFINITY;
            }
        }
    }
}

/// Adds the works of a contact that has moved by `moved` (m), normal and shear, with the heat (J/m) of its slip: the
/// part of the work that the spring gave up, and never negative.
#[inline(always)]
fn add_works(outcome: &mut ContactOutcome, contact: &VertexEdge, [normal, shear]: [f64; 2], heat: f64) {
    let history = &contact.history;
    outcome.work += history.normal_force * normal + history.shear_force * shear;
    outcome.friction += heat;
}

/// Adds the energy that crushed rock takes.
#[inline(always)]
fn add_crush(outcome: &mut ContactOutcome, crushed: &Crushed) {
    outcome.crushing.energy += crushed.loss;
    outcome.crushing.times += u64::from(crushed.begins);
}

/// Adds how deep a contact is, and was when it was seen for the first time.
#[inline(always)]
fn add_depths(outcome: &mut ContactOutcome, contact: &VertexEdge) {
    outcome.penetration = outcome.penetration.max(contact.loaded_penetration());
    if contact.fresh && contact.history.unloaded.offset > 0.0 {
        outcome.deep += 1;
        outcome.deepest = outcome.deepest.max(contact.history.unloaded.offset);
    }
}

/// History of a contact that stores a shear force (N/m) and has slipped (m).
#[inline(always)]
fn history_of(contact: &VertexEdge, stored: f64, slipped: f64, setting: &ContactSetting) -> ContactHistory {
    let mut history = contact.history;
    history.sheared = stored / contact.stiffness[1];
    history.slip += slipped.abs();
    history.intact &= !contact.torn && slipped == 0.0 || contact.bond(setting).is_some();
    history
}

/// Histories and outcomes of the contacts of a sub-step, from the velocities (m/s) of the covers before and after it.
pub fn settle_contacts(
    setting: ContactSetting,
    step: &Substep,
    velocities: [&[Vector]; 2],
    contacts: &[VertexEdge],
    histories: &mut Vec<ContactHistory>,
    outcomes: &mut Vec<ContactOutcome>,
    counters: &mut Counters,
) {
    let Substep { regime, dt, kick, serial, .. } = *step;
    let rests = matches!(regime, Regime::Static { .. });
    histories.resize(contacts.len(), ContactHistory::default());
    outcomes.resize(contacts.len().div_ceil(CONTACTS), ContactOutcome::default());
    let fade = libm::exp(-dt / OFFSET_FADE);
    let settle = |((contacts, histories), outcome)| {
        dispatch(Settle { contacts, histories, outcome, setting, velocities, dt, kick, fade, rests });
    };
    if serial || contacts.len() <= CONTACTS {
        let runs = contacts.chunks(CONTACTS).zip(histories.chunks_mut(CONTACTS));
        runs.zip(outcomes.iter_mut()).for_each(settle);
    } else {
        let runs = contacts.par_chunks(CONTACTS).zip(histories.par_chunks_mut(CONTACTS));
        runs.zip(outcomes.par_iter_mut()).for_each(settle);
    }
    for outcome in outcomes {
        counters.crushing.times += outcome.crushing.times;
        counters.crushing.energy += outcome.crushing.energy;
        counters.deep_contacts += outcome.deep;
        counters.deepest_contact = counters.deepest_contact.max(outcome.deepest);
        counters.penetration_max = counters.penetration_max.max(outcome.penetration);
    }
}

/// Keeps the forces (N/m) of the supports of a sub-step.
pub fn settle_supports(rows: &[SupportRow], support_force: &mut [f64]) {
    rows.iter().for_each(|row| support_force[row.support as usize] = row.force);
}
