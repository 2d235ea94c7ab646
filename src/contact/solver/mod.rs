//! The open–close iteration: Gauss–Seidel sweeps over contacts and supports (Eqs. 14–17).

mod anchor;
mod order;
#[doc(hidden)]
pub mod reference;
mod subdomain;
mod support;
mod wide_block;
mod wide_contact;
mod wide_pairs;
mod wide_point;

pub use anchor::BlockImpulse;

use enmm_lanes::{LANES, Values};
use rayon::prelude::*;

use crate::cover::{BlockId, CoverId};
use crate::geometry::Vector;
use crate::mechanics::{BlockMotion, MassMatrix};

use self::anchor::{Accumulators, Anchor, PackedImpulse};
use self::order::{Sequence, SolverOrder};
use self::subdomain::{PassKind, Subdomain, SubdomainPass};
use self::support::SupportSystem;
use self::wide_contact::{ContactView, WideContact};
use super::{BoltRow, Boundary, ContactSetting, FoundContact, NearPair, NearSides, Support, SupportRow, VertexEdge};

/// Contacts whose forces one thread takes from the rows.
const CONTACTS: usize = 1024;
/// Share of the largest force below which a contact is light: its changes are measured against that force.
const LIGHT: f64 = 0.02;

/// Numerical choices of the iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverOptions {
    /// Step (s) over which positions move.
    pub dt: f64,
    /// Time (s) over which forces act: the mean of this step and the one before it (Eq. 10).
    pub kick: f64,
    /// θ of the contact springs.
    pub theta: f64,
    /// Settled when no force changes by more than this share of the largest.
    pub tolerance: f64,
    /// Most sweeps.
    pub sweeps_max: u32,
    /// Whether the sweeps keep to the calling thread; the bits are the same.
    pub serial: bool,
}

/// Report of the iteration.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SolverReport {
    /// Sweeps done, those over what still moved included.
    pub sweeps: u32,
    /// Contacts solved, summed over the sweeps.
    pub contacts_solved: u64,
    /// Largest change of a force in the last sweep, which is one over all contacts, over the largest force.
    pub unsettled: f64,
}

/// Masses as the iteration sees them.
#[derive(Clone, Copy)]
struct SolverView<'a> {
    /// Masses.
    mass_matrix: &'a MassMatrix,
    /// 1/√m of the covers, negative where held along one axis alone, and μ/m, 0 where held along x.
    masses: &'a [Vector],
}

/// Motion at the start of an explicit step: what the springs of contacts answer to.
pub struct Approach<'a> {
    /// Velocities of the covers without contact forces (m/s).
    pub predicted: &'a [Vector],
    /// Velocities of the last step (m/s).
    pub velocity: &'a [Vector],
    /// Last step (s).
    pub dt_last: f64,
    /// Forward weight of the solver's own springs: 1 and the dashpot.
    pub forward: f64,
    /// Damping ratio of a dynamic stage.
    pub damping: Option<f64>,
    /// Data that the contacts share.
    pub setting: ContactSetting<'a>,
    /// Centroids of the blocks.
    pub motion: &'a [BlockMotion],
}

impl Approach<'_> {
    /// Damping 2ξ·√M (kg½/m½) of two blocks that bounce against each other, by the sum of their 1/M (1/kg·m).
    #[inline(always)]
    fn bouncing<L: Values>(&self, lanes: L, inverse: L::F) -> L::F {
        let ratio = lanes.splat(2.0 * self.damping.unwrap_or(0.0));
        lanes.keep_above(ratio / lanes.sqrt(inverse), inverse, lanes.splat(0.0))
    }
}

/// Inputs of the solver in a step.
#[derive(Clone, Copy)]
struct SolverInputs<'a> {
    mass_matrix: &'a MassMatrix,
    options: &'a SolverOptions,
    approach: &'a Approach<'a>,
}

/// Constraints that are solved in a step besides contacts.
pub struct OtherConstraints<'a> {
    /// Supports of this step.
    pub rows: &'a mut [SupportRow],
    /// Bolts of this step.
    pub bolts: &'a mut [BoltRow],
}

/// Buffers of the iteration.
#[doc(alias = "constraint solver")]
#[doc(alias = "Gauss-Seidel")]
#[derive(Debug, Clone, Default)]
pub struct OpenClose {
    order: SolverOrder,
    sequence: Sequence,
    rows: Vec<WideContact>,
    supports: SupportSystem,
    bolts: Vec<[Anchor; 2]>,
    /// √m times the velocity increments of the covers by their own impulses.
    cover_impulse: Vec<Vector>,
    /// Impulse sums of the blocks.
    block_impulse: Vec<PackedImpulse>,
    /// First block and first cover of each run of blocks.
    cuts: Vec<(BlockId, CoverId)>,
    /// Inverse masses of the covers, as a [`SolverView`] holds them.
    masses: Vec<Vector>,
}

impl OpenClose {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let Sequence { wide_pairs, ends, row_start, contacts, slots } = &self.sequence;
        let sequence = size_of_val(wide_pairs.as_slice())
            + size_of_val(ends.as_slice())
            + size_of_val(row_start.as_slice())
            + size_of_val(contacts.as_slice())
            + size_of_val(slots.as_slice());
        let masses = size_of_val(self.masses.as_slice());
        let cover_impulse = size_of_val(self.cover_impulse.as_slice());
        let block_impulse = size_of_val(self.block_impulse.as_slice());
        size_of_val(self.rows.as_slice())
            + sequence
            + cover_impulse
            + masses
            + block_impulse
            + self.order.bytes()
            + self.supports.bytes()
    }

    /// Forgets the order, and takes the masses of a stage.
    pub fn prepare(&mut self, mass_matrix: &MassMatrix, supports: &[Support], rows: &[SupportRow]) {
        self.order.clear();
        let masses = mass_matrix.inverse.iter().zip(&mass_matrix.inertial).map(|(inverse, inertial)| {
            let sign = if inverse.x == inverse.y { 1.0 } else { -1.0 };
            Vector::new(sign * inverse.max().sqrt(), inertial * inverse.x)
        });
        self.masses.clear();
        self.masses.extend(masses);
        self.supports.prepare(supports, rows, &mass_matrix.inverse);
    }

    /// Makes the next step renew the order of the near pairs.
    pub fn forget_order(&mut self) {
        self.order.clear();
    }

    /// Orders the contacts of a step, and all near sides when they are new.
    pub fn arrange(
        &mut self,
        boundary: &Boundary,
        (near_pairs, near_sides): (&[NearPair], &NearSides),
        mass_matrix: &MassMatrix,
        block_covers: &[u32],
        contacts: &[FoundContact],
    ) {
        let view = SolverView { mass_matrix, masses: &self.masses };
        if self.order.is_empty() {
            self.order.order(boundary, near_pairs, near_sides, &view);
            self.cuts.clear();
            self.cuts.extend(
                self.order.leaf_block().iter().map(|&block| (block, CoverId::new(block_covers[block] as usize))),
            );
        }
        self.order.arrange(contacts, &view, &mut self.sequence);
    }

    /// Sweeps until forces settle, from those that are expected, over contacts that have been arranged.
    pub fn run(
        &mut self,
        mass_matrix: &MassMatrix,
        options: &SolverOptions,
        approach: &Approach,
        contacts: &mut [VertexEdge],
        others: &mut OtherConstraints,
    ) -> SolverReport {
        let inputs = SolverInputs { mass_matrix, options, approach };
        self.begin(inputs, others);
        self.pass(inputs, contacts, PassKind::Prepare);
        for (bolt, anchors) in others.bolts.iter().zip(&self.bolts) {
            let mut accumulators = all_blocks(&mut self.cover_impulse, &mut self.block_impulse);
            apply_to_bolt(anchors, bolt.direction * (-bolt.force * options.kick), &mut accumulators);
        }
        let report = self.sweeps(inputs, contacts, others);
        self.store_forces(contacts, approach, options.serial);
        self.supports.store_forces(others.rows);
        report
    }

    /// Nothing has moved but by supports.
    fn begin(&mut self, inputs: SolverInputs, others: &OtherConstraints) {
        let SolverInputs { mass_matrix, options, approach } = inputs;
        let view = SolverView { mass_matrix, masses: &self.masses };
        self.rows.resize(self.sequence.row_start.len() - 1, WideContact::default());
        self.cover_impulse.clear();
        self.cover_impulse.resize(self.masses.len(), Vector::zeros());
        let none = Vector::zeros();
        self.block_impulse.clear();
        self.block_impulse.extend(approach.motion.iter().map(|motion| [none, none, none, motion.centre]));
        self.bolts.clear();
        self.bolts.extend(others.bolts.iter().map(|b| [0, 1].map(|k| Anchor::new(&b.pair, k, b.arms[k], &view))));
        self.supports.warm_start(others.rows, options.kick, &mut self.cover_impulse);
    }

    /// One pass over the rows, part by part.
    fn pass(
        &mut self,
        SolverInputs { mass_matrix, options, approach }: SolverInputs,
        contacts: &[VertexEdge],
        kind: PassKind,
    ) -> subdomain::SweepOutcome {
        let from = ContactView {
            contacts,
            order: &self.sequence.contacts,
            view: SolverView { mass_matrix, masses: &self.masses },
            options,
            approach,
        };
        Subdomain {
            wide_pairs: &mut self.sequence.wide_pairs,
            rows: &mut self.rows,
            first: [0; 2],
            ends: &self.sequence.ends,
            cuts: &self.cuts,
            accumulators: all_blocks(&mut self.cover_impulse, &mut self.block_impulse),
        }
        .run(&SubdomainPass { from, row_start: &self.sequence.row_start, kind })
    }

    /// Sweeps over all contacts until they settle. Between full sweeps only pairs whose blocks moved are solved, until
    /// none has.
    fn sweeps(&mut self, inputs: SolverInputs, contacts: &[VertexEdge], others: &mut OtherConstraints) -> SolverReport {
        let SolverInputs { options, .. } = inputs;
        let mut report = SolverReport::default();
        let mut all = true;
        let any = !(self.rows.is_empty() && self.supports.is_empty() && self.bolts.is_empty());
        while any && report.sweeps < options.sweeps_max {
            all |= report.sweeps + 1 == options.sweeps_max;
            let block_pairs = self.sequence.wide_pairs.iter();
            let largest = block_pairs.map(|wide_pairs| wide_pairs.force).fold(f64::MIN_POSITIVE, f64::max);
            let numbers = subdomain::ROUNDS * self.sequence.wide_pairs.len() as u32;
            let number = report.sweeps * (numbers + 1) + 1;
            let outcome = self.pass(inputs, contacts, PassKind::Sweep { all, floor: LIGHT * largest, number });
            let support_change = self.supports.sweep(&mut self.cover_impulse);
            let bolt_change = self.sweep_bolts(options, others.bolts, LIGHT * largest, number + numbers);
            let change = outcome.change.max(support_change).max(bolt_change);
            report.sweeps += 1;
            report.contacts_solved += outcome.contacts_solved;
            if all {
                report.unsettled = change;
            }
            if all && change <= options.tolerance {
                break;
            }
            all = !all && change <= options.tolerance;
        }
        report
    }

    /// One sweep over the bolts; returns the largest change of a force over its own size, or over a floor for slack
    /// ones.
    fn sweep_bolts(&mut self, options: &SolverOptions, bolts: &mut [BoltRow], floor: f64, number: u32) -> f64 {
        let SolverOptions { dt, kick, theta, .. } = *options;
        let largest = bolts.iter().map(|b| b.force).fold(0.0, f64::max);
        let floor = floor.max(LIGHT * largest);
        let mut change = 0.0f64;
        let mut accumulators = all_blocks(&mut self.cover_impulse, &mut self.block_impulse);
        for (bolt, anchors) in bolts.iter_mut().zip(&self.bolts) {
            let [a, b] = [0, 1].map(|k| anchors[k].velocity(&accumulators));
            let force = bolt.answer(bolt.approach + (a - b).dot(&bolt.direction), dt, kick, theta);
            let step = force - bolt.force;
            if step != 0.0 {
                apply_to_bolt(anchors, bolt.direction * (-step * kick), &mut accumulators);
                for block in anchors.iter().filter_map(|anchor| anchor.block) {
                    accumulators.mark(block, number);
                }
                change = change.max(step.abs() / force.max(floor));
                bolt.force = force;
            }
        }
        change
    }

    /// Stores forces and states in all contacts.
    fn store_forces(&self, contacts: &mut [VertexEdge], approach: &Approach, serial: bool) {
        let store = |(contacts, slots): (&mut [VertexEdge], &[u32])| {
            for (contact, &slot) in contacts.iter_mut().zip(slots) {
                let slot = slot as usize;
                self.rows[slot / LANES].store_force(slot % LANES, contact, approach);
            }
        };
        let slots = &self.sequence.slots;
        if serial || contacts.len() <= CONTACTS {
            store((contacts, slots));
        } else {
            let parts = contacts.par_chunks_mut(CONTACTS).zip(slots.par_chunks(CONTACTS));
            parts.for_each(store);
        }
    }

    /// Writes the velocity increments (m/s) of the covers by their own impulses, and the impulse sums of the blocks.
    pub fn impulses(&self, mass_matrix: &MassMatrix, increment: &mut [Vector], block_impulse: &mut [BlockImpulse]) {
        let covers = self.cover_impulse.iter().zip(&self.masses).zip(&mass_matrix.inverse);
        for (increment, ((cover_impulse, masses), inverse)) in increment.iter_mut().zip(covers) {
            let root = if masses.x < 0.0 { inverse.map(f64::sqrt) } else { Vector::repeat(masses.x) };
            *increment = cover_impulse.component_mul(&root);
        }
        for ((block_impulse, sums), total) in block_impulse.iter_mut().zip(&self.block_impulse).zip(&mass_matrix.total)
        {
            let [impulse, weighted, moment, _] = *sums;
            *block_impulse = BlockImpulse { impulse, weighted: weighted * *total, moment: moment.x };
        }
    }
}

fn apply_to_bolt(anchors: &[Anchor; 2], impulse: Vector, accumulators: &mut Accumulators) {
    for (anchor, impulse) in anchors.iter().zip([impulse, -impulse]) {
        anchor.push(impulse, accumulators);
    }
}

/// All blocks.
fn all_blocks<'a>(cover_impulse: &'a mut [Vector], block_impulse: &'a mut [PackedImpulse]) -> Accumulators<'a> {
    Accumulators { cover_impulse, first_cover: CoverId::new(0), block_impulse, first_block: BlockId::new(0) }
}
