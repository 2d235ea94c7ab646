//! The open–close iteration: Gauss–Seidel sweeps over contacts and supports (Eqs. 14–17).

mod body;
mod order;
mod part;
mod row;
mod support;

pub use body::BlockPush;

use enmm_lanes::{Kernel, Lanes, dispatch};
use rayon::prelude::*;

use crate::geometry::{NONE, Vector};
use crate::mechanics::Metric;

use self::body::{Body, Ground};
use self::order::SweepOrder;
use self::part::{Part, Pass, Work};
use self::row::{Row, Watch};
use self::support::Bearings;
use super::{BoltRow, Boundary, Candidate, Support, SupportRow, VertexEdge};

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

/// What the rows of a step are made from.
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
    /// Contacts in the order in which they are judged, and the number of them up to the end of each part of the order.
    sequence: Vec<u32>,
    ends: Vec<u32>,
    rows: Vec<Row>,
    watch: Vec<Watch>,
    /// Turns of the rows that are judged in a sweep, part by part.
    list: Vec<u32>,
    bearings: Bearings,
    bolts: Vec<[Body; 2]>,
    /// √m times the velocity increments of the covers by their own impulses.
    own: Vec<Vector>,
    /// Impulse sums of the blocks.
    push: Vec<BlockPush>,
    /// Turn in which each block moved last.
    moved: Vec<u32>,
    /// First block and first cover of each run of blocks.
    cuts: Vec<[u32; 2]>,
    /// 1/√m of the covers along each axis.
    roots: Vec<Vector>,
}

/// Rows of some contacts are made: compiled for every kind of lanes.
struct Load<'a> {
    rows: &'a mut [Row],
    watch: &'a mut [Watch],
    sequence: &'a [u32],
    contacts: &'a [VertexEdge],
    view: &'a SweepView<'a>,
    options: &'a SweepOptions,
}

impl Kernel for Load<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        for ((row, watch), &k) in self.rows.iter_mut().zip(self.watch).zip(self.sequence) {
            row.load(&self.contacts[k as usize], k, self.view, self.options);
            *watch = row.watch(&self.contacts[k as usize].pair);
        }
    }
}

impl OpenClose {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let rows = size_of_val(self.rows.as_slice()) + size_of_val(self.watch.as_slice());
        let turns = [&self.sequence, &self.ends, &self.list, &self.moved].map(|list| size_of_val(list.as_slice()));
        let own = size_of_val(self.own.as_slice()) + size_of_val(self.roots.as_slice());
        let push = size_of_val(self.push.as_slice());
        rows + turns.iter().sum::<usize>() + own + push + self.order.bytes() + self.bearings.bytes()
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
        candidates: &[Candidate],
        metric: &Metric,
        block_covers: &[u32],
        contacts: &[VertexEdge],
    ) {
        if self.order.is_empty() {
            self.order.order(boundary, candidates, metric);
            self.cuts.clear();
            self.cuts.extend(self.order.leaf_block().iter().map(|&block| [block, block_covers[block as usize]]));
        }
        self.order.arrange(contacts, &mut self.sequence, &mut self.ends);
    }

    /// Sweeps until forces settle, warm-started from the last step's forces, over contacts that have been arranged.
    pub fn run(
        &mut self,
        metric: &Metric,
        options: &SweepOptions,
        contacts: &mut [VertexEdge],
        others: &mut Others,
    ) -> SweepReport {
        self.load(metric, options, contacts, others);
        self.part(contacts, options, Work::Warm);
        for (bolt, bodies) in others.bolts.iter().zip(&self.bolts) {
            let mut ground = whole(&mut self.own, &mut self.push, &mut self.moved);
            push_bolt(bodies, bolt.direction * (-bolt.force * options.kick), &mut ground);
        }
        let report = self.sweeps(options, contacts, others);
        self.finish(contacts, others);
        report
    }

    /// Rows of all that is judged; nothing has moved.
    fn load(&mut self, metric: &Metric, options: &SweepOptions, contacts: &[VertexEdge], others: &Others) {
        let view = SweepView { metric, roots: &self.roots };
        let count = self.sequence.len();
        self.rows.resize(count, Row::default());
        self.watch.resize(count, Watch::default());
        self.list.resize(count, 0);
        let load = |((rows, watch), sequence): ((&mut [Row], &mut [Watch]), &[u32])| {
            dispatch(Load { rows, watch, sequence, contacts, view: &view, options });
        };
        if options.serial || count < part::GRAIN {
            load(((&mut self.rows, &mut self.watch), &self.sequence));
        } else {
            let (rows, grain) = (&mut self.rows, part::GRAIN / 2);
            let rows = rows.par_chunks_mut(grain).zip(self.watch.par_chunks_mut(grain));
            rows.zip(self.sequence.par_chunks(grain)).for_each(load);
        }
        self.own.clear();
        self.own.resize(self.roots.len(), Vector::zeros());
        self.push.clear();
        self.push.resize(metric.total.len(), BlockPush::default());
        self.moved.clear();
        self.moved.resize(metric.total.len(), 0);
        self.bolts.clear();
        self.bolts.extend(others.bolts.iter().map(|b| [0, 1].map(|k| Body::new(&b.pair, k, &view))));
        self.bearings.load(others.rows, options.kick, &mut self.own);
    }

    /// One pass over the rows, part by part.
    fn part(&mut self, contacts: &[VertexEdge], options: &SweepOptions, work: Work) -> part::Swept {
        let pass = Pass { contacts, kick: options.kick, tolerance: options.tolerance, serial: options.serial, work };
        Part {
            rows: &mut self.rows,
            watch: &mut self.watch,
            list: &mut self.list,
            first_row: 0,
            ends: &self.ends,
            cuts: &self.cuts,
            ground: whole(&mut self.own, &mut self.push, &mut self.moved),
        }
        .run(&pass)
    }

    /// Sweeps over all contacts until they settle; between two such sweeps only those are judged that have something to
    /// answer, until none has.
    fn sweeps(&mut self, options: &SweepOptions, contacts: &[VertexEdge], others: &mut Others) -> SweepReport {
        let mut report = SweepReport::default();
        let mut all = true;
        let any = !(self.rows.is_empty() && self.bearings.is_empty() && self.bolts.is_empty());
        while any && report.sweeps < options.sweeps_max {
            all |= report.sweeps + 1 == options.sweeps_max;
            let largest = row::largest(&self.watch);
            let turn = report.sweeps * (self.rows.len() as u32 + 1) + 1;
            let swept = self.part(contacts, options, Work::Sweep { all, floor: LIGHT * largest, turn });
            let support_change = self.bearings.sweep(&mut self.own);
            let bolt_change = self.sweep_bolts(options, others.bolts, LIGHT * largest, turn + self.rows.len() as u32);
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
        let mut ground = whole(&mut self.own, &mut self.push, &mut self.moved);
        for (bolt, bodies) in bolts.iter_mut().zip(&self.bolts) {
            let [a, b] = [0, 1].map(|k| bodies[k].velocity(&bodies[k].places(&ground), &ground));
            let force = bolt.answer(bolt.approach + (a - b).dot(&bolt.direction), dt, kick, theta);
            let step = force - bolt.force;
            if step != 0.0 {
                push_bolt(bodies, bolt.direction * (-step * kick), &mut ground);
                for block in bodies.iter().map(Body::block).filter(|&block| block != NONE) {
                    ground.mark([block; 2], turn);
                }
                change = change.max(step.abs() / force.max(floor));
                bolt.force = force;
            }
        }
        change
    }

    /// Forces and states of all that was judged.
    fn finish(&self, contacts: &mut [VertexEdge], others: &mut Others) {
        self.rows.iter().for_each(|row| row.finish(contacts));
        self.bearings.finish(others.rows);
    }

    /// Writes the velocity increments (m/s) of the covers by their own impulses, and the impulse sums of the blocks.
    pub fn impulses(&self, metric: &Metric, increment: &mut [Vector], push: &mut [BlockPush]) {
        for ((increment, own), root) in increment.iter_mut().zip(&self.own).zip(&self.roots) {
            *increment = own.component_mul(root);
        }
        for ((push, sums), total) in push.iter_mut().zip(&self.push).zip(&metric.total) {
            *push = BlockPush { weighted: sums.weighted * *total, ..*sums };
        }
    }
}

fn push_bolt(bodies: &[Body; 2], impulse: Vector, ground: &mut Ground) {
    for (body, impulse) in bodies.iter().zip([impulse, -impulse]) {
        body.push(impulse, &body.places(ground), ground);
    }
}

/// All blocks.
fn whole<'a>(own: &'a mut [Vector], push: &'a mut [BlockPush], moved: &'a mut [u32]) -> Ground<'a> {
    Ground { own, first_cover: 0, push, moved, first_block: 0 }
}
