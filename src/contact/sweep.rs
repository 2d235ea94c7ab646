//! The open–close iteration: Gauss–Seidel sweeps over contacts and supports (Eqs. 14–17).

mod abreast;
mod body;
mod order;
mod part;
mod row;
mod support;

pub use body::BlockPush;

use enmm_lanes::LANES;
use rayon::prelude::*;

use crate::geometry::{NONE, Vector};
use crate::mechanics::Metric;

use self::body::{Body, Ground, Push};
use self::order::{Sequence, SweepOrder};
use self::part::{Part, Pass, Work};
use self::row::{Row, RowView};
use self::support::Bearings;
use super::{BoltRow, Boundary, NearPair, Support, SupportRow, VertexEdge};

/// Contacts whose forces one thread takes from the rows.
const CONTACTS: usize = 1024;
/// Share of the largest force below which a contact is light: its changes are measured against that force.
const LIGHT: f64 = 0.02;

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
    /// Whether the sweeps keep to the calling thread; the bits are the same.
    pub serial: bool,
}

/// What the iteration did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SweepReport {
    /// Sweeps done, those over what still moved included.
    pub sweeps: u32,
    /// Contacts judged, summed over the sweeps.
    pub judged: u64,
    /// Largest change of a force in the last sweep, which is one over all contacts, over the largest force.
    pub unsettled: f64,
}

/// Masses as the iteration sees them.
#[derive(Clone, Copy)]
struct SweepView<'a> {
    /// Masses.
    metric: &'a Metric,
    /// 1/√m of the covers along each axis, 0 where held.
    roots: &'a [Vector],
}

/// What is judged in a step besides contacts.
pub struct Others<'a> {
    /// Supports of this step.
    pub rows: &'a mut [SupportRow],
    /// Bolts of this step.
    pub bolts: &'a mut [BoltRow],
}

/// Buffers of the iteration.
#[derive(Debug, Clone, Default)]
pub struct OpenClose {
    order: SweepOrder,
    sequence: Sequence,
    rows: Vec<Row>,
    bearings: Bearings,
    bolts: Vec<[Body; 2]>,
    /// √m times the velocity increments of the covers by their own impulses.
    own: Vec<Vector>,
    /// Impulse sums of the blocks.
    push: Vec<Push>,
    /// First block and first cover of each run of blocks.
    cuts: Vec<[u32; 2]>,
    /// 1/√m of the covers along each axis.
    roots: Vec<Vector>,
}

impl OpenClose {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let Sequence { abreast, ends, first_turn, contacts, places } = &self.sequence;
        let sequence = size_of_val(abreast.as_slice())
            + size_of_val(ends.as_slice())
            + size_of_val(first_turn.as_slice())
            + size_of_val(contacts.as_slice())
            + size_of_val(places.as_slice());
        let own = size_of_val(self.own.as_slice()) + size_of_val(self.roots.as_slice());
        let push = size_of_val(self.push.as_slice());
        size_of_val(self.rows.as_slice()) + sequence + own + push + self.order.bytes() + self.bearings.bytes()
    }

    /// Forgets the order, and takes the masses of a stage.
    pub fn prepare(&mut self, metric: &Metric, supports: &[Support], rows: &[SupportRow]) {
        self.order.clear();
        self.roots.clear();
        self.roots.extend(metric.inverse.iter().map(|inverse| inverse.map(f64::sqrt)));
        self.bearings.prepare(supports, rows, &self.roots);
    }

    /// Makes the next step order the near pairs anew.
    pub fn forget_order(&mut self) {
        self.order.clear();
    }

    /// Orders the contacts of a step, and the near pairs when they are new.
    pub fn arrange(
        &mut self,
        boundary: &Boundary,
        near_pairs: &[NearPair],
        metric: &Metric,
        block_covers: &[u32],
        contacts: &[VertexEdge],
    ) {
        let view = SweepView { metric, roots: &self.roots };
        if self.order.is_empty() {
            self.order.order(boundary, near_pairs, &view);
            self.cuts.clear();
            self.cuts.extend(self.order.leaf_block().iter().map(|&block| [block, block_covers[block as usize]]));
        }
        self.order.arrange(contacts, &view, &mut self.sequence);
    }

    /// Sweeps until forces settle, from those that are expected, over contacts that have been arranged.
    pub fn run(
        &mut self,
        metric: &Metric,
        options: &SweepOptions,
        contacts: &mut [VertexEdge],
        others: &mut Others,
    ) -> SweepReport {
        self.begin(metric, options, others);
        self.pass(metric, contacts, options, Work::Load);
        for (bolt, bodies) in others.bolts.iter().zip(&self.bolts) {
            let mut ground = whole(&mut self.own, &mut self.push);
            push_bolt(bodies, bolt.direction * (-bolt.force * options.kick), &mut ground);
        }
        let report = self.sweeps(metric, options, contacts, others);
        self.finish(contacts, options.serial);
        self.bearings.finish(others.rows);
        report
    }

    /// Nothing has moved but by supports.
    fn begin(&mut self, metric: &Metric, options: &SweepOptions, others: &Others) {
        let view = SweepView { metric, roots: &self.roots };
        self.rows.resize(self.sequence.first_turn.len() - 1, Row::default());
        self.own.clear();
        self.own.resize(self.roots.len(), Vector::zeros());
        self.push.clear();
        self.push.resize(metric.total.len(), Push::default());
        self.bolts.clear();
        self.bolts.extend(others.bolts.iter().map(|b| [0, 1].map(|k| Body::new(&b.pair, k, &view))));
        self.bearings.load(others.rows, options.kick, &mut self.own);
    }

    /// One pass over the rows, part by part.
    fn pass(&mut self, metric: &Metric, contacts: &[VertexEdge], options: &SweepOptions, work: Work) -> part::Swept {
        let from = RowView {
            contacts,
            turns: &self.sequence.contacts,
            view: SweepView { metric, roots: &self.roots },
            options,
        };
        Part {
            abreast: &mut self.sequence.abreast,
            rows: &mut self.rows,
            first: [0; 2],
            ends: &self.sequence.ends,
            cuts: &self.cuts,
            ground: whole(&mut self.own, &mut self.push),
        }
        .run(&Pass { from, first_turn: &self.sequence.first_turn, work })
    }

    /// Sweeps over all contacts until they settle; between two such sweeps only those are judged that have something to
    /// answer, until none has.
    fn sweeps(
        &mut self,
        metric: &Metric,
        options: &SweepOptions,
        contacts: &[VertexEdge],
        others: &mut Others,
    ) -> SweepReport {
        let mut report = SweepReport::default();
        let mut all = true;
        let any = !(self.rows.is_empty() && self.bearings.is_empty() && self.bolts.is_empty());
        while any && report.sweeps < options.sweeps_max {
            all |= report.sweeps + 1 == options.sweeps_max;
            let manifolds = self.sequence.abreast.iter();
            let largest = manifolds.map(|abreast| abreast.force).fold(f64::MIN_POSITIVE, f64::max);
            let turns = part::ROUNDS * self.sequence.abreast.len() as u32;
            let turn = report.sweeps * (turns + 1) + 1;
            let swept = self.pass(metric, contacts, options, Work::Sweep { all, floor: LIGHT * largest, turn });
            let support_change = self.bearings.sweep(&mut self.own);
            let bolt_change = self.sweep_bolts(options, others.bolts, LIGHT * largest, turn + turns);
            let change = swept.change.max(support_change).max(bolt_change);
            report.sweeps += 1;
            report.judged += swept.judged;
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
    fn sweep_bolts(&mut self, options: &SweepOptions, bolts: &mut [BoltRow], floor: f64, turn: u32) -> f64 {
        let SweepOptions { dt, kick, theta, .. } = *options;
        let largest = bolts.iter().map(|b| b.force).fold(0.0, f64::max);
        let floor = floor.max(LIGHT * largest);
        let mut change = 0.0f64;
        let mut ground = whole(&mut self.own, &mut self.push);
        for (bolt, bodies) in bolts.iter_mut().zip(&self.bolts) {
            let [a, b] = [0, 1].map(|k| bodies[k].velocity(&ground));
            let force = bolt.answer(bolt.approach + (a - b).dot(&bolt.direction), dt, kick, theta);
            let step = force - bolt.force;
            if step != 0.0 {
                push_bolt(bodies, bolt.direction * (-step * kick), &mut ground);
                for block in bodies.iter().map(|body| body.block).filter(|&block| block != NONE) {
                    ground.mark(block, turn);
                }
                change = change.max(step.abs() / force.max(floor));
                bolt.force = force;
            }
        }
        change
    }

    /// Forces and states of all contacts.
    fn finish(&self, contacts: &mut [VertexEdge], serial: bool) {
        let finish = |(contacts, places): (&mut [VertexEdge], &[u32])| {
            for (contact, &place) in contacts.iter_mut().zip(places) {
                let place = place as usize;
                self.rows[place / LANES].finish(place % LANES, contact);
            }
        };
        let places = &self.sequence.places;
        if serial || contacts.len() <= CONTACTS {
            finish((contacts, places));
        } else {
            contacts.par_chunks_mut(CONTACTS).zip(places.par_chunks(CONTACTS)).for_each(finish);
        }
    }

    /// Writes the velocity increments (m/s) of the covers by their own impulses, and the impulse sums of the blocks.
    pub fn impulses(&self, metric: &Metric, increment: &mut [Vector], push: &mut [BlockPush]) {
        for ((increment, own), root) in increment.iter_mut().zip(&self.own).zip(&self.roots) {
            *increment = own.component_mul(root);
        }
        for ((push, sums), total) in push.iter_mut().zip(&self.push).zip(&metric.total) {
            let [impulse, weighted, moment] = *sums;
            *push = BlockPush { impulse, weighted: weighted * *total, moment: moment.x };
        }
    }
}

fn push_bolt(bodies: &[Body; 2], impulse: Vector, ground: &mut Ground) {
    for (body, impulse) in bodies.iter().zip([impulse, -impulse]) {
        body.push(impulse, ground);
    }
}

/// All blocks.
fn whole<'a>(own: &'a mut [Vector], push: &'a mut [Push]) -> Ground<'a> {
    Ground { own, first_cover: 0, push, first_block: 0 }
}
