//! A contact as the iteration judges it (Eqs. 14, 15, 17).

use std::hint::select_unpredictable;

use crate::contact::{Limits, Pair, VertexEdge};
use crate::geometry::{NONE, Vector};

use super::body::{Body, Ground};
use super::{SweepOptions, SweepView};

/// What the spring along one axis answers: `rest` − `rate`·v + `kept`·(its force so far), v being the velocity by all
/// impulses so far. For a curved spring it is the closure (m) that the force then follows from.
#[derive(Debug, Clone, Copy, Default)]
struct Answer {
    rest: f64,
    rate: f64,
    kept: f64,
}

/// A contact in the iteration: five cache lines.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub struct Row {
    bodies: [Body; 2],
    normal: Vector,
    answers: [Answer; 2],
    /// Forces normal and shear (N/m).
    force: [f64; 2],
    friction: f64,
    cohesion: f64,
    /// Normal force (N/m) at or below which it is open.
    open: f64,
    /// Index of the contact.
    contact: u32,
    /// Whether spring or strength follow a curve.
    curved: bool,
    /// Whether it bore when it was judged last.
    bears: bool,
    /// Whether it was asked then for more tension than the joint has.
    torn: bool,
}

/// What decides whether a row is judged in a sweep.
#[derive(Debug, Clone, Copy, Default)]
pub struct Watch {
    /// The free blocks of both bodies, one of them twice when the other is held; both held ones when none is free.
    pub blocks: [u32; 2],
    /// Turn after the one in which it was judged last; always 0 without a free block.
    due: u32,
    /// 1 with a free block, else 0.
    free: u32,
    /// The larger of its forces (N/m), since a cohesive joint may bear shear alone.
    pub force: f64,
}

impl Watch {
    /// Whether a body has moved since the row was judged; rows without a free block always have to be.
    #[inline(always)]
    pub fn is_due(&self, ground: &Ground) -> bool {
        let moved = self.blocks.map(|block| ground.moved[(block - ground.first_block) as usize]);
        moved[0].max(moved[1]) >= self.due
    }

    /// Notes the turn in which the row was judged, and its force (N/m) since.
    #[inline(always)]
    pub fn judged(&mut self, turn: u32, force: f64) {
        (self.due, self.force) = ((turn + 1) * self.free, force);
    }
}

impl Row {
    /// Takes a contact with its forces of the last step.
    #[inline(always)]
    pub fn load(&mut self, contact: &VertexEdge, index: u32, view: &SweepView, options: &SweepOptions) {
        let closes = contact.closure_max.is_finite();
        let pressed = -contact.stiffness[0] * contact.gap;
        self.answers[0] = if closes { closing(contact, options) } else { spring(contact, options, 0, pressed) };
        self.answers[1] = spring(contact, options, 1, contact.history.shear_stored);
        self.bodies[0].load(&contact.pair, 0, view);
        self.bodies[1].load(&contact.pair, 1, view);
        self.normal = contact.normal;
        self.force = [contact.history.normal_force, contact.history.shear_force];
        let Limits { friction, cohesion, tension, rough } = &contact.limits;
        (self.friction, self.cohesion) = (*friction, *cohesion);
        self.open = if *tension > 0.0 { (-tension).next_down() } else { 0.0 };
        self.contact = index;
        self.curved = closes || rough.is_some();
        (self.bears, self.torn) = (false, false);
    }

    /// Leaves force and state in its contact.
    #[inline(always)]
    pub fn finish(&self, contacts: &mut [VertexEdge]) {
        contacts[self.contact as usize].bear(self.force, self.bears, self.torn);
    }

    /// What decides whether it is judged.
    #[inline(always)]
    pub fn watch(&self, pair: &Pair) -> Watch {
        let [a, b] = [0, 1].map(|k| self.bodies[k].block());
        let free = u32::from(a != NONE || b != NONE);
        let [first, second] = if free == 1 { [a, b] } else { pair.blocks };
        let blocks = [if first == NONE { second } else { first }, if second == NONE { first } else { second }];
        Watch { blocks, due: free, free, force: self.largest() }
    }

    #[inline(always)]
    fn largest(&self) -> f64 {
        larger(self.force[0].abs(), self.force[1].abs())
    }

    /// Pushes with the forces so far.
    #[inline(always)]
    pub fn warm(&self, kick: f64, ground: &mut Ground) {
        let impulse = self.turned(self.force) * kick;
        for (body, impulse) in self.bodies.iter().zip([impulse, -impulse]) {
            body.push(impulse, &body.places(ground), ground);
        }
    }

    /// Judges open, slip or lock; returns the change of its force and the force (N/m).
    #[inline(always)]
    pub fn judge(&mut self, kick: f64, contacts: &[VertexEdge], ground: &mut Ground) -> [f64; 2] {
        let places = [self.bodies[0].places(ground), self.bodies[1].places(ground)];
        let velocity = self.bodies[0].velocity(&places[0], ground) - self.bodies[1].velocity(&places[1], ground);
        let [mut normal, shear] = self.ask([velocity.dot(&self.normal), self.normal.perp(&velocity)]);
        let mut limit = larger(normal * self.friction + self.cohesion, 0.0);
        if self.curved {
            (normal, limit) = self.follow(normal, &contacts[self.contact as usize]);
        }
        self.bears = normal > self.open;
        self.torn = !self.bears & (normal != 0.0);
        let [normal, limit] = [normal, limit].map(|force| select_unpredictable(self.bears, force, 0.0));
        let force = [normal, smaller(larger(shear, -limit), limit)];
        let step = [force[0] - self.force[0], force[1] - self.force[1]];
        // Nor does a branch depend on whether the force changes: it would be known too late.
        let impulse = self.turned(step) * kick;
        self.bodies[0].push(impulse, &places[0], ground);
        self.bodies[1].push(-impulse, &places[1], ground);
        self.force = force;
        [larger(step[0].abs(), step[1].abs()), self.largest()]
    }

    /// What the springs ask for at a velocity normal and shear (m/s) by all impulses so far.
    #[inline(always)]
    fn ask(&self, velocity: [f64; 2]) -> [f64; 2] {
        let answer = |k: usize, Answer { rest, rate, kept }: Answer| rest - rate * velocity[k] + kept * self.force[k];
        [answer(0, self.answers[0]), answer(1, self.answers[1])]
    }

    /// A vector from its components normal and shear.
    #[inline(always)]
    fn turned(&self, along: [f64; 2]) -> Vector {
        self.normal * along[0] + Vector::new(-self.normal.y, self.normal.x) * along[1]
    }

    /// Normal force and shear limit (N/m) of a joint whose spring or strength follows a curve.
    #[cold]
    #[inline(never)]
    fn follow(&self, asked: f64, contact: &VertexEdge) -> (f64, f64) {
        let linear = contact.closure_max.is_infinite();
        let normal = if linear { asked } else { contact.closure().solve(asked, self.answers[0].kept) };
        (normal, contact.limits.shear(normal))
    }
}

/// The linear spring along axis `k` that bears `stored` (N/m) at the step's start.
#[inline(always)]
fn spring(contact: &VertexEdge, options: &SweepOptions, k: usize, stored: f64) -> Answer {
    let a = contact.stiffness[k] * contact.forward[k] * options.dt;
    let aw = a * contact.compliance[k] * options.kick;
    let asked = stored - contact.stiffness[k] * contact.lag[k] - a * contact.approach[k];
    let share = 1.0 / (1.0 + aw);
    Answer { rest: asked * share, rate: a * share, kept: aw * share }
}

/// A curved normal spring.
#[inline(always)]
fn closing(contact: &VertexEdge, options: &SweepOptions) -> Answer {
    let reach = contact.forward[0] * options.dt;
    let rest = -contact.gap - contact.lag[0] - reach * contact.approach[0];
    Answer { rest, rate: reach, kept: reach * contact.compliance[0] * options.kick }
}

/// The largest force (N/m) of some rows, or the least positive number: a few abreast, since none waits for another.
pub fn largest(watch: &[Watch]) -> f64 {
    let mut largest = [f64::MIN_POSITIVE; 8];
    let mut eights = watch.chunks_exact(8);
    for eight in &mut eights {
        for (largest, watch) in largest.iter_mut().zip(eight) {
            *largest = larger(watch.force, *largest);
        }
    }
    largest.into_iter().chain(eights.remainder().iter().map(|w| w.force)).fold(f64::MIN_POSITIVE, larger)
}

/// The smaller of two numbers.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
