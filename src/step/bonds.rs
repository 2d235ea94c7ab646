//! Bonds that soften or break with their section (theory §7): their damage at the end of a sub-step, and the energy of
//! fracture.

use crate::contact::{
    BondHistory, ContactHistory, ContactSetting, ContactState, Damaged, Failure, Hold, Release, SectionBond,
    SectionForces, SectionId, Sections, VertexEdge,
};
use crate::geometry::Vector;
use crate::state::{Counters, Ledger, Model, State};

use super::Substep;

/// Steps in which a section lets go at least, so that its neighbours feel no jump.
const RELEASE_STEPS: f64 = 10.0;

/// Whether joints soften, so that the state keeps the damage of their bonds: by a law of the case, or as the cracks of
/// rock that has broken, whose laws come after all others.
pub fn has_bonds(model: &Model, state: &State) -> bool {
    let of_cracks = model.breaking.as_ref().map_or(0, |breaking| breaking.rocks.iter().flatten().count());
    let of_case = &state.laws[..state.laws.len() - of_cracks];
    !state.cuts.is_empty() || of_case.iter().any(|law| law.softening.is_some())
}

/// Contacts of a sub-step whose bonds are damaged, with what they leave for the next one.
pub struct Bonds<'a> {
    /// What the contacts share.
    pub setting: ContactSetting<'a>,
    /// The sub-step.
    pub step: &'a Substep,
    /// Velocities (m/s) of the covers before and after it.
    pub velocities: [&'a [Vector]; 2],
    /// The contacts.
    pub contacts: &'a [VertexEdge],
    /// Their histories.
    pub histories: &'a mut [ContactHistory],
    /// Their bonds.
    pub bonds: &'a mut Vec<BondHistory>,
    /// Counters of the run.
    pub counters: &'a mut Counters,
}

impl Bonds<'_> {
    /// Damages the bonds by opening and slip, and adds up what sections carry; returns the energy of fracture, which is
    /// no heat of friction.
    pub fn settle(&mut self, forces: &mut [SectionForces]) -> Ledger {
        let mut works = Ledger::default();
        self.bonds.clear();
        for (contact, history) in self.contacts.iter().zip(&mut *self.histories) {
            let Some(hold) = contact.bond(&self.setting) else {
                self.bonds.push(BondHistory::default());
                continue;
            };
            let opening = contact.gap + opens(contact, &self.setting, self.velocities[1]) * self.step.dt;
            let slipped = history.slip - contact.history.slip;
            let pair = [contact.history.normal_force, contact.history.shear_force];
            history.state = if slipped > 0.0 { ContactState::Slip } else { ContactState::Lock };
            let Damaged { damage, loss, of_slip } = match hold {
                Hold::Alone(bond) => bond.after(opening, slipped, pair),
                Hold::InSection(section, bond) => {
                    let at = self.setting.frames.position(contact.point);
                    let on_node = contact.normal * pair[0] + contact.tangent() * pair[1];
                    forces[section].add(at, contact.normal, on_node, pair[0] * bond.shear[0][0]);
                    forces[section].note(&bond, opening, pair);
                    bond.slip_loss(slipped, pair)
                }
            };
            history.intact = damage < 1.0;
            self.counters.broken += if history.intact { 0.0 } else { contact.bonded };
            works.fracture += loss;
            works.friction -= of_slip;
            let lengths = [contact.length, contact.bonded];
            self.bonds.push(BondHistory { damage, lengths, law: contact.law, section: contact.section() });
        }
        works
    }

    /// Breaks sections that have their strength, and lets those that have broken go; returns the energy of fracture.
    pub fn break_sections(&mut self, model: &Model, forces: &[SectionForces], releases: &mut [Option<Release>]) -> f64 {
        let mut slides = false;
        for ((section, forces), release) in model.sections.list.iter().zip(forces).zip(&mut *releases) {
            let law = &self.setting.laws[section.law];
            let failure = if release.is_none() { forces.failure(section, law, self.setting.strength) } else { None };
            let Some(softening) = law.softening else { continue };
            if let Some(Release { left, .. }) = release {
                let time = section.crack_time.max(RELEASE_STEPS * model.dt);
                *left = (*left - self.step.dt / time).max(0.0);
                if softening.opening > 0.0 {
                    *left = left.min((1.0 - forces.crack / softening.opening).max(0.0));
                }
            } else if failure == Some(Failure::Slides) && softening.shear_energy > 0.0 {
                slides = true;
            } else if failure.is_some() {
                *release = Some(Release { carried: forces.carried, left: 1.0 });
            }
        }
        if slides {
            self.part_sliding(model, forces, releases);
        }
        if releases.iter().all(Option::is_none) { 0.0 } else { self.let_go(releases) }
    }

    /// Lets the bonds of sections that slide soften by themselves, by the energy that their law has for it.
    fn part_sliding(&mut self, model: &Model, forces: &[SectionForces], releases: &[Option<Release>]) {
        let list = &model.sections.list;
        let slides = |section: SectionId| {
            let (section, forces, whole) = (&list[section], &forces[section], releases[section].is_none());
            let law = &self.setting.laws[section.law];
            whole && forces.failure(section, law, self.setting.strength) == Some(Failure::Slides)
        };
        for bond in self.bonds.iter_mut().filter(|bond| bond.section.is_some_and(slides)) {
            bond.section = None;
        }
    }

    /// Damages the bonds of sections that have broken as far as these have let go; returns the energy of fracture
    /// (J/m): what their opening has taken in the sub-step, less what they store more.
    fn let_go(&mut self, releases: &[Option<Release>]) -> f64 {
        let mut loss = 0.0;
        let bonds = self.bonds.iter_mut().zip(&mut *self.histories);
        for (contact, (bond, history)) in self.contacts.iter().zip(bonds) {
            let Some(Hold::InSection(section, hold)) = contact.bond(&self.setting) else { continue };
            let Some(release) = &releases[section] else { continue };
            let [before, after] = self.velocities.map(|velocity| opens(contact, &self.setting, velocity));
            let (opening, moved) = (contact.gap + after * self.step.dt, 0.5 * (before + after) * self.step.kick);
            let next = SectionBond { share: Release::shares(&releases[section]), ..hold };
            if opening > 0.0 {
                let stored = next.stored(opening) - hold.stored(contact.gap);
                loss -= contact.history.normal_force * moved + stored;
            }
            bond.damage = 1.0 - release.left;
            history.intact = release.left > 0.0;
            self.counters.broken += if history.intact { 0.0 } else { contact.bonded };
        }
        loss
    }
}

/// Speed (m/s) at which a contact opens.
fn opens(contact: &VertexEdge, setting: &ContactSetting, velocity: &[Vector]) -> f64 {
    contact.relative(setting.boundary, velocity)[0]
}

/// Begins the sums over the sections of a sub-step.
pub fn begin_sections(sections: &Sections, setting: &ContactSetting, forces: &mut Vec<SectionForces>) {
    forces.clear();
    let ends = sections.list.iter().map(|section| section.ends.map(|end| setting.frames.position(end)));
    forces.extend(ends.map(SectionForces::none));
}
