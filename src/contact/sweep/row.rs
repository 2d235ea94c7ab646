//! Contacts abreast, one of each of eight manifolds, as the iteration judges them (Eqs. 14, 15, 17).

use enmm_lanes::{LANES, Places, Values};

use crate::contact::{Limits, VertexEdge};
use crate::geometry::Vector;

use super::abreast::{Abreast, Side};
use super::body::Body;
use super::{SweepOptions, SweepView};

/// A number of each lane.
pub type Eight = [f64; LANES];

/// What the spring along one axis answers: `rest` − `rate`·v + `kept`·(its force so far), v being the velocity by all
/// impulses so far. For a curved spring it is the closure (m) that the force then follows from.
#[derive(Debug, Clone, Copy, Default)]
struct Answer<T> {
    rest: T,
    rate: T,
    kept: T,
}

/// One material point of each contact. Numbers begin at lines of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
struct Points {
    /// w/√m along each axis, 0 where held.
    weights: [[Eight; 2]; 3],
    /// J90·(arm from the block's centroid) (m).
    lever: [Eight; 2],
    /// z/M (m/kg).
    part: Eight,
    /// Covers, from the first one of the part of the order on.
    covers: [Places; 3],
}

/// Contacts of eight manifolds. A lane without one bears nothing and repeats the covers of the first lane.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub struct Row {
    points: [Points; 2],
    normal: [Eight; 2],
    answers: [Answer<Eight>; 2],
    /// Forces normal and shear (N/m).
    force: [Eight; 2],
    /// Normal forces that were asked for last (N/m).
    asked: Eight,
    friction: Eight,
    cohesion: Eight,
    /// Normal force (N/m) at or below which each is open.
    open: Eight,
    /// First turn and the one after the last.
    turns: [u32; 2],
    /// Whether spring or strength of one of them follow a curve.
    curved: bool,
}

/// What a row is made from.
pub struct RowView<'a> {
    /// Contacts of the step, and the one of each turn.
    pub contacts: &'a [VertexEdge],
    pub turns: &'a [u32],
    /// Masses.
    pub view: SweepView<'a>,
    /// Choices.
    pub options: &'a SweepOptions,
}

impl Row {
    /// Takes the contacts of the turns from the first to the one after the last, with the forces that are expected.
    #[inline(always)]
    pub fn load(&mut self, turns: [u32; 2], abreast: &Abreast, from: &RowView, first_cover: u32) {
        self.turns = turns;
        for points in &mut self.points {
            points.covers = [Places::default(); 3];
        }
        self.curved = false;
        let contacts = self.of(from.turns);
        for (lane, &contact) in contacts.iter().enumerate() {
            self.take(lane, &from.contacts[contact as usize], abreast, from, first_cover);
        }
        (contacts.len()..LANES).for_each(|lane| self.leave_out(lane));
        debug_assert!(self.is_apart(contacts.len()), "two manifolds of one colour share a cover");
    }

    /// Its contacts.
    #[inline(always)]
    fn of<'a>(&self, turns: &'a [u32]) -> &'a [u32] {
        &turns[self.turns[0] as usize..self.turns[1] as usize]
    }

    /// Whether no two of the first `count` lanes push the same cover.
    fn is_apart(&self, count: usize) -> bool {
        let covers = |lane: usize| {
            let covers = self.points.iter().flat_map(|points| points.covers.iter().zip(&points.weights));
            covers
                .filter(move |(_, weights)| weights[0][lane] != 0.0 || weights[1][lane] != 0.0)
                .map(move |(covers, _)| covers.index(lane))
        };
        (0..count).all(|a| (0..a).all(|b| covers(a).all(|i| covers(b).all(|j| i != j))))
    }

    #[inline(always)]
    fn take(&mut self, lane: usize, contact: &VertexEdge, abreast: &Abreast, from: &RowView, first_cover: u32) {
        let options = from.options;
        let closes = contact.closure_max.is_finite();
        let pressed = -contact.stiffness[0] * contact.gap;
        let normal = if closes { closing(contact, options) } else { spring(contact, options, 0, pressed) };
        let shear = spring(contact, options, 1, contact.history.shear_stored);
        self.answers[0].take(lane, normal);
        self.answers[1].take(lane, shear);
        let turned = abreast.is_turned(lane, contact.pair.blocks);
        let [first, second] = if turned { [1, 0] } else { [0, 1] };
        self.points[0].take(lane, &Body::new(&contact.pair, first, &from.view), first_cover);
        self.points[1].take(lane, &Body::new(&contact.pair, second, &from.view), first_cover);
        if contact.pair.blocks[0] == contact.pair.blocks[1] {
            self.join_points(lane);
        }
        let normal = if turned { -contact.normal } else { contact.normal };
        (self.normal[0][lane], self.normal[1][lane]) = (normal.x, normal.y);
        let force = contact.expected();
        (self.force[0][lane], self.force[1][lane], self.asked[lane]) = (force[0], force[1], 0.0);
        let Limits { friction, cohesion, tension, rough } = &contact.limits;
        (self.friction[lane], self.cohesion[lane]) = (*friction, *cohesion);
        self.open[lane] = if *tension > 0.0 { (-tension).next_down() } else { 0.0 };
        self.curved |= closes || rough.is_some();
    }

    /// Leaves a lane without contact.
    #[inline(always)]
    fn leave_out(&mut self, lane: usize) {
        for k in 0..2 {
            self.points[k].leave_out(lane);
            self.answers[k].take(lane, Answer { rest: 0.0, rate: 0.0, kept: 0.0 });
            (self.normal[k][lane], self.force[k][lane]) = (0.0, 0.0);
        }
        (self.asked[lane], self.open[lane], self.friction[lane], self.cohesion[lane]) = (0.0, 0.0, 0.0, 0.0);
    }

    /// Both points lie in one block: its motion as a whole is felt and pushed by their difference, and covers that they
    /// share once, by the first point.
    #[cold]
    #[inline(never)]
    fn join_points(&mut self, lane: usize) {
        let [a, b] = &mut self.points;
        for k in 0..2 {
            a.lever[k][lane] -= std::mem::take(&mut b.lever[k][lane]);
        }
        a.part[lane] -= std::mem::take(&mut b.part[lane]);
        for (i, j) in
            (0..9).map(|k| (k / 3, k % 3)).filter(|&(i, j)| a.covers[i].index(lane) == b.covers[j].index(lane))
        {
            for k in 0..2 {
                a.weights[i][k][lane] -= std::mem::take(&mut b.weights[j][k][lane]);
            }
        }
    }

    /// Leaves forces and states in the contacts.
    #[inline(always)]
    pub fn finish(&self, turns: &[u32], contacts: &mut [VertexEdge]) {
        for (lane, &contact) in self.of(turns).iter().enumerate() {
            let bears = self.asked[lane] > self.open[lane];
            let torn = !bears & (self.asked[lane] != 0.0);
            contacts[contact as usize].end([self.force[0][lane], self.force[1][lane]], bears, torn);
        }
    }

    /// Pushes with the forces so far; returns the larger of each contact's forces (N/m), since a cohesive joint may
    /// bear shear alone.
    #[inline(always)]
    pub fn warm<L: Values>(&self, lanes: L, kick: f64, sides: &mut [Side<L>; 2], own: &mut [Vector]) -> L::F {
        let force = [lanes.load(&self.force[0]), lanes.load(&self.force[1])];
        let [x, y] = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let impulse = turned(lanes, [x, y], force, kick);
        let velocities = [self.points[0].own(lanes, own), self.points[1].own(lanes, own)];
        self.push(lanes, impulse, &velocities, sides, own);
        larger_size(lanes, force)
    }

    /// Judges open, slip or lock; returns the changes of the forces and the forces (N/m), the larger of each contact's.
    #[inline(always)]
    pub fn judge<L: Values>(
        &mut self,
        lanes: L,
        from: &RowView,
        sides: &mut [Side<L>; 2],
        own: &mut [Vector],
    ) -> [L::F; 2] {
        let before = [self.points[0].own(lanes, own), self.points[1].own(lanes, own)];
        let a = self.points[0].velocity(lanes, &before[0], &sides[0]);
        let b = self.points[1].velocity(lanes, &before[1], &sides[1]);
        let velocity = [a[0] - b[0], a[1] - b[1]];
        let [x, y] = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let old = [lanes.load(&self.force[0]), lanes.load(&self.force[1])];
        let mut normal = self.answers[0].ask(lanes, velocity[0] * x + velocity[1] * y, old[0]);
        let shear = self.answers[1].ask(lanes, x * velocity[1] - y * velocity[0], old[1]);
        let zero = lanes.splat(0.0);
        let mut limit = lanes.max(normal * lanes.load(&self.friction) + lanes.load(&self.cohesion), zero);
        lanes.store(normal, &mut self.asked);
        if self.curved {
            let mut limits = [0.0; LANES];
            lanes.store(limit, &mut limits);
            self.follow(from, &mut limits);
            (normal, limit) = (lanes.load(&self.asked), lanes.load(&limits));
        }
        // No branch depends on what bears, slips or changes: it would be known too late.
        let open = lanes.load(&self.open);
        let limit = lanes.keep_above(limit, normal, open);
        let force = [lanes.keep_above(normal, normal, open), lanes.min(lanes.max(shear, -limit), limit)];
        let step = [force[0] - old[0], force[1] - old[1]];
        let impulse = turned(lanes, [x, y], step, from.options.kick);
        self.push(lanes, impulse, &before, sides, own);
        lanes.store(force[0], &mut self.force[0]);
        lanes.store(force[1], &mut self.force[1]);
        [larger_size(lanes, step), larger_size(lanes, force)]
    }

    /// Pushes with impulses what moved as `before` told. The second points go first, and lanes from the last on: where
    /// a cover stands twice it has no part in what is overwritten.
    #[inline(always)]
    fn push<L: Values>(
        &self,
        lanes: L,
        impulse: [L::F; 2],
        before: &[[[L::F; 2]; 3]; 2],
        sides: &mut [Side<L>; 2],
        own: &mut [Vector],
    ) {
        let [x, y] = impulse;
        self.points[1].push(lanes, [-x, -y], &before[1], &mut sides[1], own);
        self.points[0].push(lanes, impulse, &before[0], &mut sides[0], own);
    }

    /// Normal forces and shear limits (N/m) of joints whose spring or strength follows a curve.
    #[cold]
    #[inline(never)]
    fn follow(&mut self, from: &RowView, limits: &mut Eight) {
        for (lane, &contact) in self.of(from.turns).iter().enumerate() {
            let contact = &from.contacts[contact as usize];
            let closes = contact.closure_max.is_finite();
            if closes {
                self.asked[lane] = contact.closure().solve(self.asked[lane], self.answers[0].kept[lane]);
            }
            if closes || contact.limits.rough.is_some() {
                limits[lane] = contact.limits.shear(self.asked[lane]);
            }
        }
    }
}

impl Points {
    #[inline(always)]
    fn take(&mut self, lane: usize, body: &Body, first_cover: u32) {
        for k in 0..3 {
            self.covers[k].set(lane, body.covers[k] - first_cover);
            (self.weights[k][0][lane], self.weights[k][1][lane]) = (body.weights[k].x, body.weights[k].y);
        }
        (self.lever[0][lane], self.lever[1][lane]) = (body.lever.x, body.lever.y);
        self.part[lane] = body.part;
    }

    #[inline(always)]
    fn leave_out(&mut self, lane: usize) {
        for k in 0..3 {
            self.covers[k].set(lane, self.covers[k].index(0));
            (self.weights[k][0][lane], self.weights[k][1][lane]) = (0.0, 0.0);
        }
        (self.lever[0][lane], self.lever[1][lane], self.part[lane]) = (0.0, 0.0, 0.0);
    }

    /// What their covers have of their own.
    #[inline(always)]
    fn own<L: Values>(&self, lanes: L, own: &[Vector]) -> [[L::F; 2]; 3] {
        [
            lanes.gather_from(own, &self.covers[0]),
            lanes.gather_from(own, &self.covers[1]),
            lanes.gather_from(own, &self.covers[2]),
        ]
    }

    #[inline(always)]
    fn weight<L: Values>(&self, lanes: L, k: usize) -> [L::F; 2] {
        [lanes.load(&self.weights[k][0]), lanes.load(&self.weights[k][1])]
    }

    /// Velocities (m/s) that all impulses so far give them.
    #[inline(always)]
    fn velocity<L: Values>(&self, lanes: L, own: &[[L::F; 2]; 3], side: &Side<L>) -> [L::F; 2] {
        let [w, u, v] = [self.weight(lanes, 0), self.weight(lanes, 1), self.weight(lanes, 2)];
        let share = side.common - lanes.load(&self.part);
        let turn = side.spin * side.moment;
        let lever = [lanes.load(&self.lever[0]), lanes.load(&self.lever[1])];
        let x = (w[0] * own[0][0] + u[0] * own[1][0]) + v[0] * own[2][0];
        let y = (w[1] * own[0][1] + u[1] * own[1][1]) + v[1] * own[2][1];
        let common = [
            side.impulse[0] * share - side.unit * side.weighted[0] + lever[0] * turn,
            side.impulse[1] * share - side.unit * side.weighted[1] + lever[1] * turn,
        ];
        [x + common[0], y + common[1]]
    }

    /// They take impulses (N·s/m).
    #[inline(always)]
    fn push<L: Values>(
        &self,
        lanes: L,
        [x, y]: [L::F; 2],
        before: &[[L::F; 2]; 3],
        side: &mut Side<L>,
        own: &mut [Vector],
    ) {
        for (k, before) in before.iter().enumerate() {
            let [u, v] = self.weight(lanes, k);
            lanes.scatter_to([before[0] + u * x, before[1] + v * y], own, &self.covers[k]);
        }
        let part = lanes.load(&self.part);
        let lever = [lanes.load(&self.lever[0]), lanes.load(&self.lever[1])];
        side.impulse = [side.impulse[0] + side.unit * x, side.impulse[1] + side.unit * y];
        side.weighted = [side.weighted[0] + part * x, side.weighted[1] + part * y];
        side.moment = side.moment + (lever[0] * x + lever[1] * y);
    }
}

impl Answer<Eight> {
    #[inline(always)]
    fn take(&mut self, lane: usize, answer: Answer<f64>) {
        (self.rest[lane], self.rate[lane], self.kept[lane]) = (answer.rest, answer.rate, answer.kept);
    }

    /// What springs ask for at velocities (m/s) by all impulses so far.
    #[inline(always)]
    fn ask<L: Values>(&self, lanes: L, velocity: L::F, force: L::F) -> L::F {
        lanes.load(&self.rest) - lanes.load(&self.rate) * velocity + lanes.load(&self.kept) * force
    }
}

/// Impulses (N·s/m) from forces normal and shear (N/m).
#[inline(always)]
fn turned<L: Values>(lanes: L, [x, y]: [L::F; 2], along: [L::F; 2], kick: f64) -> [L::F; 2] {
    let kick = lanes.splat(kick);
    [(x * along[0] - y * along[1]) * kick, (y * along[0] + x * along[1]) * kick]
}

/// The larger size of two numbers of each lane.
#[inline(always)]
fn larger_size<L: Values>(lanes: L, [a, b]: [L::F; 2]) -> L::F {
    lanes.max(lanes.max(a, -a), lanes.max(b, -b))
}

/// The linear spring along axis `k` that bears `stored` (N/m) at the step's start.
#[inline(always)]
fn spring(contact: &VertexEdge, options: &SweepOptions, k: usize, stored: f64) -> Answer<f64> {
    let a = contact.stiffness[k] * contact.forward[k] * options.dt;
    let aw = a * contact.compliance[k] * options.kick;
    let asked = stored - contact.stiffness[k] * contact.lag[k] - a * contact.approach[k];
    let share = 1.0 / (1.0 + aw);
    Answer { rest: asked * share, rate: a * share, kept: aw * share }
}

/// A curved normal spring.
#[inline(always)]
fn closing(contact: &VertexEdge, options: &SweepOptions) -> Answer<f64> {
    let reach = contact.forward[0] * options.dt;
    let rest = -contact.gap - contact.lag[0] - reach * contact.approach[0];
    Answer { rest, rate: reach, kept: reach * contact.compliance[0] * options.kick }
}
