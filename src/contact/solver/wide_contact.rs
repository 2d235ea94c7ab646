//! Contacts side by side, one of each of eight block pairs, as the iteration solves them (Eqs. 14, 15, 17).

use enmm_lanes::{LANES, Lanes, Places, Values, prefetch};

use crate::contact::{Limits, Pair, SoftSpring, VertexEdge};
use crate::cover::{BlockId, CoverId};
use crate::geometry::Vector;

use super::anchor::lever_and_share;
use super::wide_block::{F64x8, WideBlock};
use super::{SolverOptions, SolverView};

/// Contacts from which on they are fetched ahead: fewer stay in the caches, where asking costs more than waiting.
const FAR: usize = 16_384;
/// Positions by which a contact is fetched ahead.
const AHEAD: usize = 8;

/// One material point of each contact. Numbers begin at lines of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
struct Points {
    /// w/√m.
    weights: [F64x8; 3],
    /// J90·(arm from the block's centroid) (m).
    lever: [F64x8; 2],
    /// z/M (m/kg).
    mass_share: F64x8,
    /// Covers, from the first one of the part of the order on.
    covers: [Places; 3],
    /// Lanes, a bit each, whose covers are held along one axis alone, by axis; no weight is on what is held along both.
    held: [[u8; 2]; 3],
    /// Whether one of them is.
    holds: bool,
}

/// Contacts of eight block pairs. A lane without one bears nothing and repeats the covers of the first lane.
#[doc(alias = "SIMD")]
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub struct WideContact {
    points: [Points; 2],
    normal: [F64x8; 2],
    answers: [SoftSpring<F64x8>; 2],
    /// Forces normal and shear (N/m).
    force: [F64x8; 2],
    friction: F64x8,
    cohesion: F64x8,
    /// Normal force (N/m) at or below which each is open.
    open: F64x8,
    /// First turn and the one after the last.
    turns: [u32; 2],
    /// Lanes, a bit each, that do not bear, and those that push when they are asked for a normal force.
    shut: u8,
    pressed: u8,
    /// Whether spring or strength of one of them follow a curve.
    curved: bool,
}

/// What a row is made from.
pub struct ContactView<'a> {
    /// Contacts of the step, and the one of each turn.
    pub contacts: &'a [VertexEdge],
    pub turns: &'a [u32],
    /// Masses.
    pub view: SolverView<'a>,
    /// Choices.
    pub options: &'a SolverOptions,
}

impl ContactView<'_> {
    /// Asks the memory for the contacts of the turns from the first to the one after the last.
    #[inline(always)]
    fn fetch(&self, [first, end]: [usize; 2]) {
        let count = self.turns.len();
        for &contact in &self.turns[first.min(count)..end.min(count)] {
            prefetch(&self.contacts[contact as usize..=contact as usize]);
        }
    }
}

impl WideContact {
    /// Takes the contacts of the turns from the first to the one after the last, with the forces that are expected;
    /// `first_block` is the block of each lane that its first points lie in.
    #[inline(always)]
    pub fn load<L: Lanes>(
        &mut self,
        lanes: L,
        turns: [u32; 2],
        first_block: &[BlockId; LANES],
        from: &ContactView,
        first_cover: CoverId,
    ) {
        self.turns = turns;
        for points in &mut self.points {
            (points.covers, points.held, points.holds) = ([Places::default(); 3], [[0; 2]; 3], false);
        }
        self.curved = false;
        let contacts = self.of(from.turns);
        if from.turns.len() > FAR {
            from.fetch(turns.map(|turn| turn as usize + AHEAD));
        }
        for (lane, &contact) in contacts.iter().enumerate() {
            self.take(lane, &from.contacts[contact as usize], first_block, from, first_cover);
        }
        (contacts.len()..LANES).for_each(|lane| self.leave_out(lane));
        self.divide(lanes);
        if self.curved {
            self.take_curved(from);
        }
        debug_assert!(self.is_apart(contacts.len()), "two contacts of one row share a cover");
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
            covers.filter(move |(_, weights)| weights[lane] != 0.0).map(move |(covers, _)| covers.index(lane))
        };
        (0..count).all(|a| (0..a).all(|b| covers(a).all(|i| covers(b).all(|j| i != j))))
    }

    #[inline(always)]
    fn take(
        &mut self,
        lane: usize,
        contact: &VertexEdge,
        first_block: &[BlockId; LANES],
        from: &ContactView,
        first_cover: CoverId,
    ) {
        for (answers, answer) in self.answers.iter_mut().zip(&contact.answers) {
            answers.take(lane, answer);
        }
        let turned = contact.pair.blocks[0] != first_block[lane];
        let [first, second] = if turned { [1, 0] } else { [0, 1] };
        self.points[0].take(lane, &contact.pair, first, &from.view, first_cover);
        self.points[1].take(lane, &contact.pair, second, &from.view, first_cover);
        if contact.pair.blocks[0] == contact.pair.blocks[1] {
            self.join_points(lane);
        }
        let normal = if turned { -contact.normal } else { contact.normal };
        (self.normal[0][lane], self.normal[1][lane]) = (normal.x, normal.y);
        (self.force[0][lane], self.force[1][lane]) = (contact.expected[0], contact.expected[1]);
        let (friction, cohesion, tension) = match contact.limits {
            Limits::MohrCoulomb { friction, cohesion, tension } => (friction, cohesion, tension),
            Limits::BartonBandis { .. } => (0.0, 0.0, 0.0),
        };
        (self.friction[lane], self.cohesion[lane]) = (friction, cohesion);
        self.open[lane] = if tension > 0.0 { (-tension).next_down() } else { 0.0 };
        self.curved |= contact.is_curved();
    }

    /// Makes forces of what the springs ask for.
    #[inline(always)]
    fn divide<L: Lanes>(&mut self, lanes: L) {
        let one = lanes.splat(1.0);
        for SoftSpring { rest, rate, kept } in &mut self.answers {
            let share = one / (one + lanes.load(kept));
            lanes.store(lanes.load(rest) * share, rest);
            lanes.store(lanes.load(rate) * share, rate);
            lanes.store(lanes.load(kept) * share, kept);
        }
    }

    /// Takes again what curved springs ask for, which is no force.
    #[cold]
    #[inline(never)]
    fn take_curved(&mut self, from: &ContactView) {
        let contacts = self.of(from.turns).iter().map(|&contact| &from.contacts[contact as usize]);
        for (lane, contact) in contacts.enumerate().filter(|(_, contact)| contact.closes_on_a_curve()) {
            self.answers[0].take(lane, &contact.answers[0]);
        }
    }

    /// Leaves a lane without contact.
    #[inline(always)]
    fn leave_out(&mut self, lane: usize) {
        for k in 0..2 {
            self.points[k].leave_out(lane);
            self.answers[k].take(lane, &SoftSpring::default());
            (self.normal[k][lane], self.force[k][lane]) = (0.0, 0.0);
        }
        (self.open[lane], self.friction[lane], self.cohesion[lane]) = (0.0, 0.0, 0.0);
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
        a.mass_share[lane] -= std::mem::take(&mut b.mass_share[lane]);
        for (i, j) in
            (0..9).map(|k| (k / 3, k % 3)).filter(|&(i, j)| a.covers[i].index(lane) == b.covers[j].index(lane))
        {
            a.weights[i][lane] -= std::mem::take(&mut b.weights[j][lane]);
        }
    }

    /// Leaves force and state in the contact of a lane.
    #[inline(always)]
    pub fn finish(&self, lane: usize, contact: &mut VertexEdge) {
        let bears = self.shut >> lane & 1 == 0;
        let torn = !bears & (self.pressed >> lane & 1 == 0);
        contact.end([self.force[0][lane], self.force[1][lane]], bears, torn);
    }

    /// Pushes with the forces so far; returns the larger of each contact's forces (N/m), since a cohesive joint may
    /// bear shear alone.
    #[inline(always)]
    pub fn warm_start<L: Values>(
        &self,
        lanes: L,
        kick: f64,
        sides: &mut [WideBlock<L>; 2],
        cover_impulse: &mut [Vector],
    ) -> L::F {
        let force = [lanes.load(&self.force[0]), lanes.load(&self.force[1])];
        let [x, y] = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let impulse = turned(lanes, [x, y], force, kick);
        let velocities =
            [self.points[0].cover_impulse(lanes, cover_impulse), self.points[1].cover_impulse(lanes, cover_impulse)];
        self.push(lanes, impulse, &velocities, sides, cover_impulse);
        larger_size(lanes, force)
    }

    /// Solves open, slip or lock; returns the changes of the forces and the forces (N/m), the larger of each contact's.
    #[inline(always)]
    pub fn solve<L: Values>(
        &mut self,
        lanes: L,
        from: &ContactView,
        sides: &mut [WideBlock<L>; 2],
        cover_impulse: &mut [Vector],
    ) -> [L::F; 2] {
        let before =
            [self.points[0].cover_impulse(lanes, cover_impulse), self.points[1].cover_impulse(lanes, cover_impulse)];
        let a = self.points[0].velocity(lanes, &before[0], &sides[0]);
        let b = self.points[1].velocity(lanes, &before[1], &sides[1]);
        let velocity = [a[0] - b[0], a[1] - b[1]];
        let [x, y] = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let old = [lanes.load(&self.force[0]), lanes.load(&self.force[1])];
        let mut normal = self.answers[0].ask(lanes, velocity[0] * x + velocity[1] * y, old[0]);
        let shear = self.answers[1].ask(lanes, x * velocity[1] - y * velocity[0], old[1]);
        let zero = lanes.splat(0.0);
        let mut limit = lanes.max(normal * lanes.load(&self.friction) + lanes.load(&self.cohesion), zero);
        if self.curved {
            let (mut asked, mut limits) = ([0.0; LANES], [0.0; LANES]);
            lanes.store(normal, &mut asked);
            lanes.store(limit, &mut limits);
            self.follow(from, &mut asked, &mut limits);
            (normal, limit) = (lanes.load(&asked), lanes.load(&limits));
        }
        // No branch depends on what bears, slips or changes: it would be known too late.
        let open = lanes.load(&self.open);
        (self.shut, self.pressed) = (lanes.at_most(normal, open), lanes.at_most(zero, normal));
        let limit = lanes.keep_above(limit, normal, open);
        let force = [lanes.keep_above(normal, normal, open), lanes.min(lanes.max(shear, -limit), limit)];
        let step = [force[0] - old[0], force[1] - old[1]];
        let impulse = turned(lanes, [x, y], step, from.options.kick);
        self.push(lanes, impulse, &before, sides, cover_impulse);
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
        sides: &mut [WideBlock<L>; 2],
        cover_impulse: &mut [Vector],
    ) {
        let [x, y] = impulse;
        self.points[1].push(lanes, [-x, -y], &before[1], &mut sides[1], cover_impulse);
        self.points[0].push(lanes, impulse, &before[0], &mut sides[0], cover_impulse);
    }

    /// Normal forces and shear limits (N/m) of joints whose spring or strength follows a curve.
    #[cold]
    #[inline(never)]
    fn follow(&self, from: &ContactView, asked: &mut F64x8, limits: &mut F64x8) {
        for (lane, &contact) in self.of(from.turns).iter().enumerate() {
            let contact = &from.contacts[contact as usize];
            if contact.closes_on_a_curve() {
                asked[lane] = contact.closure().solve(asked[lane], self.answers[0].kept[lane]);
            }
            if contact.is_curved() {
                limits[lane] = contact.shear_limit(asked[lane]);
            }
        }
    }
}

impl Points {
    #[inline(always)]
    fn take(&mut self, lane: usize, pair: &Pair, k: usize, view: &SolverView, first_cover: CoverId) {
        for (j, &cover) in pair.covers[k].iter().enumerate() {
            let root = view.roots[cover];
            self.covers[j].set(lane, cover.number() - first_cover.number());
            self.weights[j][lane] = pair.weights[k][j] * root.x.max(root.y);
            if root.x != root.y {
                let axis = usize::from(root.y == 0.0);
                self.held[j][axis] |= 1 << lane;
                self.holds = true;
            }
        }
        let (lever, mass_share) = lever_and_share(pair, k, view);
        (self.lever[0][lane], self.lever[1][lane], self.mass_share[lane]) = (lever.x, lever.y, mass_share);
    }

    #[inline(always)]
    fn leave_out(&mut self, lane: usize) {
        for k in 0..3 {
            self.covers[k].set(lane, self.covers[k].index(0));
            self.weights[k][lane] = 0.0;
        }
        (self.lever[0][lane], self.lever[1][lane], self.mass_share[lane]) = (0.0, 0.0, 0.0);
    }

    /// What their covers have of their own: nothing where they are held, whatever was pushed there.
    #[inline(always)]
    fn cover_impulse<L: Values>(&self, lanes: L, cover_impulse: &[Vector]) -> [[L::F; 2]; 3] {
        let mut found = [
            lanes.gather_from(cover_impulse, &self.covers[0]),
            lanes.gather_from(cover_impulse, &self.covers[1]),
            lanes.gather_from(cover_impulse, &self.covers[2]),
        ];
        if self.holds {
            for (found, held) in found.iter_mut().zip(&self.held) {
                for (found, &held) in found.iter_mut().zip(held) {
                    let mut values = [0.0; LANES];
                    lanes.store(*found, &mut values);
                    hold(&mut values, held);
                    *found = lanes.load(&values);
                }
            }
        }
        found
    }

    /// Velocities (m/s) that all impulses so far give them.
    #[inline(always)]
    fn velocity<L: Values>(&self, lanes: L, cover_impulse: &[[L::F; 2]; 3], side: &WideBlock<L>) -> [L::F; 2] {
        let [w, u, v] = [lanes.load(&self.weights[0]), lanes.load(&self.weights[1]), lanes.load(&self.weights[2])];
        let share = side.common - lanes.load(&self.mass_share);
        let turn = side.spin * side.moment;
        let lever = [lanes.load(&self.lever[0]), lanes.load(&self.lever[1])];
        let x = (w * cover_impulse[0][0] + u * cover_impulse[1][0]) + v * cover_impulse[2][0];
        let y = (w * cover_impulse[0][1] + u * cover_impulse[1][1]) + v * cover_impulse[2][1];
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
        side: &mut WideBlock<L>,
        cover_impulse: &mut [Vector],
    ) {
        for (k, before) in before.iter().enumerate() {
            let w = lanes.load(&self.weights[k]);
            lanes.scatter_to([before[0] + w * x, before[1] + w * y], cover_impulse, &self.covers[k]);
        }
        let mass_share = lanes.load(&self.mass_share);
        let lever = [lanes.load(&self.lever[0]), lanes.load(&self.lever[1])];
        side.impulse = [side.impulse[0] + side.unit * x, side.impulse[1] + side.unit * y];
        side.weighted = [side.weighted[0] + mass_share * x, side.weighted[1] + mass_share * y];
        side.moment = side.moment + (lever[0] * x + lever[1] * y);
    }
}

impl SoftSpring<F64x8> {
    #[inline(always)]
    fn take(&mut self, lane: usize, answer: &SoftSpring) {
        (self.rest[lane], self.rate[lane], self.kept[lane]) = (answer.rest, answer.rate, answer.kept);
    }

    /// What springs ask for at velocities (m/s) by all impulses so far.
    #[inline(always)]
    fn ask<L: Values>(&self, lanes: L, velocity: L::F, force: L::F) -> L::F {
        lanes.load(&self.rest) - lanes.load(&self.rate) * velocity + lanes.load(&self.kept) * force
    }
}

/// Leaves nothing in lanes with a bit.
#[cold]
#[inline(never)]
fn hold(values: &mut F64x8, held: u8) {
    for lane in (0..LANES).filter(|lane| held >> lane & 1 == 1) {
        values[lane] = 0.0;
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
