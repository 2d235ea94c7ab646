//! The open–close iteration: Gauss–Seidel sweeps over contacts and supports (Eqs. 14–17).

use crate::cover;
use crate::geometry::Vector;
use crate::mechanics::Metric;

use super::{BoltRow, ContactState, Pair, Support, SupportRow, VertexEdge};

/// Share of the largest force below which a contact is light: its changes are measured against that force.
const LIGHT: f64 = 0.02;
/// Most sweeps over the supports within one sweep over the contacts.
const SUPPORT_SWEEPS_MAX: u32 = 10;
/// Change of a support's force, relative to the largest, at which the supports have settled.
const SUPPORT_TOLERANCE: f64 = 1e-4;

/// Impulse sums of a block: what turns one contact's impulse into everybody's velocity in constant time (Eq. 17).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockPush {
    /// P = Σ impulses (N·s/m).
    pub impulse: Vector,
    /// Z = Σ z·impulse (N·s/m).
    pub weighted: Vector,
    /// L = Σ arm × impulse (N·m·s/m).
    pub moment: f64,
}

/// Numerical choices of the iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepOptions {
    /// Step (s) over which places move.
    pub dt: f64,
    /// Time (s) over which forces act: the mean of this step and the one before it (Eq. 10).
    pub kick: f64,
    /// θ of the contact springs.
    pub theta: f64,
    /// Settled when no force changes by more than this share of the largest.
    pub tolerance: f64,
    /// Most sweeps.
    pub sweeps_max: u32,
}

/// What the iteration did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SweepReport {
    /// Sweeps done.
    pub sweeps: u32,
    /// Largest change of a force in the last sweep over the largest force.
    pub unsettled: f64,
}

/// State of the iteration: velocity increments of covers and impulse sums of blocks.
pub struct OpenClose<'a> {
    /// Masses.
    pub metric: &'a Metric,
    /// Numerical choices.
    pub options: SweepOptions,
    /// Velocity increments p/m of the covers by their own impulses (m/s).
    pub increment: &'a mut [Vector],
    /// Impulse sums of the blocks.
    pub push: &'a mut [BlockPush],
}

/// The force (N/m) against which changes are measured: the larger of both, since a cohesive joint may bear shear alone.
fn force_of(contact: &VertexEdge) -> f64 {
    contact.history.normal_force.abs().max(contact.history.shear_force.abs())
}

/// Sweeps until forces settle, warm-started from the last step's forces.
pub fn open_close(
    mut iteration: OpenClose,
    contacts: &mut [VertexEdge],
    supports: &[Support],
    rows: &mut [SupportRow],
    bolts: &mut [BoltRow],
) -> SweepReport {
    iteration.warm_start(contacts, supports, rows);
    bolts.iter().for_each(|bolt| iteration.push(&bolt.pair, bolt.direction * (-bolt.force * iteration.options.kick)));
    let mut report = SweepReport::default();
    while report.sweeps < iteration.options.sweeps_max && !(contacts.is_empty() && rows.is_empty() && bolts.is_empty())
    {
        let largest = contacts.iter().map(force_of).fold(f64::MIN_POSITIVE, f64::max);
        let change = iteration.sweep_contacts(contacts, LIGHT * largest);
        let support_change = iteration.sweep_supports(supports, rows);
        let bolt_change = iteration.sweep_bolts(bolts, LIGHT * largest);
        report.sweeps += 1;
        report.unsettled = change.max(support_change).max(bolt_change);
        if report.unsettled <= iteration.options.tolerance {
            break;
        }
    }
    report
}

impl OpenClose<'_> {
    fn warm_start(&mut self, contacts: &mut [VertexEdge], supports: &[Support], rows: &mut [SupportRow]) {
        for contact in contacts {
            let force = contact.normal * contact.history.normal_force + contact.tangent() * contact.history.shear_force;
            self.push(&contact.pair, force * self.options.kick);
        }
        for row in rows {
            supports[row.support as usize].push(row.force * self.options.kick, self.metric, self.increment);
        }
    }

    /// One sweep in order; returns the largest change of a force over its own size, or over a floor for light contacts.
    fn sweep_contacts(&mut self, contacts: &mut [VertexEdge], floor: f64) -> f64 {
        let mut change = 0.0f64;
        for contact in contacts {
            change = change.max(self.judge(contact) / force_of(contact).max(floor));
        }
        change
    }

    /// Sweeps the supports to and fro until they settle; returns the first sweep's change over the largest force.
    /// Springs and dashpots settle by themselves: waves are small beside weights.
    fn sweep_supports(&mut self, supports: &[Support], rows: &mut [SupportRow]) -> f64 {
        let mut first = None;
        for _ in 0..SUPPORT_SWEEPS_MAX {
            let (mut change, mut largest) = ([0.0f64; 2], [f64::MIN_POSITIVE; 2]);
            for row in rows.iter_mut() {
                let support = &supports[row.support as usize];
                let kind = usize::from(support.is_dashpot());
                change[kind] = change[kind].max(self.bear(support, row));
            }
            for row in rows.iter_mut().rev() {
                let support = &supports[row.support as usize];
                let kind = usize::from(support.is_dashpot());
                change[kind] = change[kind].max(self.bear(support, row));
                largest[kind] = largest[kind].max(row.force.abs());
            }
            first.get_or_insert(change[0].max(change[1]) / largest[0].max(largest[1]));
            if (0..2).all(|kind| change[kind] <= SUPPORT_TOLERANCE * largest[kind]) {
                break;
            }
        }
        first.unwrap_or(0.0)
    }

    /// One sweep over the bolts; returns the largest change of a force over its own size, or over a floor for slack
    /// ones.
    fn sweep_bolts(&mut self, bolts: &mut [BoltRow], floor: f64) -> f64 {
        let largest = bolts.iter().map(|b| b.force).fold(0.0, f64::max);
        let floor = floor.max(LIGHT * largest);
        let mut change = 0.0f64;
        for bolt in bolts {
            let relative = self.increment_at(&bolt.pair, 0) - self.increment_at(&bolt.pair, 1);
            let rate = bolt.approach + relative.dot(&bolt.direction);
            let SweepOptions { dt, kick, theta, .. } = self.options;
            let force = bolt.answer(rate, dt, kick, theta);
            let step = force - bolt.force;
            if step != 0.0 {
                self.push(&bolt.pair, bolt.direction * (-step * kick));
                change = change.max(step.abs() / force.max(floor));
                bolt.force = force;
            }
        }
        change
    }

    /// Updates the force of one support; returns its change (N/m).
    fn bear(&mut self, support: &Support, row: &mut SupportRow) -> f64 {
        let kick = self.options.kick;
        let velocity = row.approach + support.sample(self.increment);
        let a = row.viscosity;
        let force =
            (row.target - a * velocity + a * kick * row.compliance * row.force) / (1.0 + a * kick * row.compliance);
        let change = force - row.force;
        support.push(change * kick, self.metric, self.increment);
        row.force = force;
        change.abs()
    }

    /// Judges one contact open, slip or lock; returns the change of its force (N/m).
    fn judge(&mut self, contact: &mut VertexEdge) -> f64 {
        let SweepOptions { dt, kick, .. } = self.options;
        let relative = self.increment_at(&contact.pair, 0) - self.increment_at(&contact.pair, 1);
        let tangent = contact.tangent();
        let normal_velocity = contact.approach[0] + relative.dot(&contact.normal);
        let shear_velocity = contact.approach[1] + relative.dot(&tangent);
        let (old_normal, old_shear) = (contact.history.normal_force, contact.history.shear_force);
        let [a, b] = [0, 1].map(|k| contact.stiffness[k] * contact.forward[k] * dt);
        let gap = contact.gap + contact.lag[0];
        let stored = contact.history.shear_stored - contact.stiffness[1] * contact.lag[1];
        let [wa, wb] = [0, 1].map(|k| contact.compliance[k] * kick);
        let normal = if contact.closure_max.is_infinite() {
            (-contact.stiffness[0] * gap - a * normal_velocity + a * wa * old_normal) / (1.0 + a * wa)
        } else {
            let reach = contact.forward[0] * dt;
            contact.closure().solve(-gap - reach * (normal_velocity - wa * old_normal), reach * wa)
        };
        let shear = (stored - b * shear_velocity + b * wb * old_shear) / (1.0 + b * wb);
        contact.decide(normal, shear);
        let step = [contact.history.normal_force - old_normal, contact.history.shear_force - old_shear];
        if step != [0.0; 2] {
            self.push(&contact.pair, (contact.normal * step[0] + tangent * step[1]) * kick);
        }
        step[0].abs().max(step[1].abs())
    }

    /// Velocity (m/s) that all impulses so far give to body `k` of a pair at its point (Eq. 17).
    fn increment_at(&self, pair: &Pair, k: usize) -> Vector {
        let block = pair.blocks[k] as usize;
        let (metric, push) = (self.metric, &self.push[block]);
        let own = cover::sample(&pair.covers[k], &pair.weights[k], self.increment);
        let share = metric.inverse_total[block];
        let common = (push.impulse * (1.0 + metric.square[block] * share - pair.z[k]) - push.weighted) * share;
        let spin = metric.spin[block] * push.moment;
        own + common + Vector::new(-pair.arms[k].y, pair.arms[k].x) * spin
    }

    /// Adds an impulse (N·s/m) on the first point and its reaction on the second.
    fn push(&mut self, pair: &Pair, impulse: Vector) {
        for (k, impulse) in [impulse, -impulse].into_iter().enumerate() {
            for (&i, w) in pair.covers[k].iter().zip(pair.weights[k]) {
                self.increment[i as usize] += self.metric.inverse[i as usize].component_mul(&impulse) * w;
            }
            let push = &mut self.push[pair.blocks[k] as usize];
            push.impulse += impulse;
            push.weighted += impulse * pair.z[k];
            push.moment += pair.arms[k].perp(&impulse);
        }
    }
}

impl VertexEdge {
    /// Clamps the forces that the springs ask for to what the joint can carry.
    pub fn decide(&mut self, normal: f64, shear: f64) {
        let history = &mut self.history;
        self.torn = normal < -self.limits.tension;
        if self.torn || (normal <= 0.0 && self.limits.tension == 0.0) {
            (history.normal_force, history.shear_force, history.state) = (0.0, 0.0, ContactState::Open);
            return;
        }
        let limit = self.limits.shear(normal);
        history.normal_force = normal;
        history.shear_force = shear.clamp(-limit, limit);
        history.state = if shear.abs() >= limit { ContactState::Slip } else { ContactState::Lock };
    }
}
