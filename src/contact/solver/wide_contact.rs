//! Contacts side by side, one of each of eight block pairs, as the iteration solves them (Eqs. 14, 15, 17).

use enmm_lanes::{Arithmetic, LANES, Values, prefetch};

use crate::contact::{Limits, Slide, SoftSpring, Spring, VertexEdge};
use crate::cover::CoverId;
use crate::geometry::Vector;

use super::wide_block::{F64x8, WideBlock};
use super::wide_point::{Bodies, Points};
use super::{Approach, SolverOptions, SolverView};

/// Contacts from which on they are fetched ahead: fewer stay in the caches, where prefetching costs more than waiting.
const FAR: usize = 16_384;
/// Positions by which a contact is fetched ahead.
const AHEAD: usize = 8;

/// Contacts of eight block pairs. A lane without one carries no force and repeats the covers of the first lane.
#[doc(alias = "SIMD")]
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub struct WideContact {
    points: [Points; 2],
    /// Positions of the nodes (m).
    at: [F64x8; 2],
    normal: [F64x8; 2],
    answers: [SoftSpring<F64x8>; 2],
    /// Forces normal and shear (N/m).
    force: [F64x8; 2],
    friction: F64x8,
    cohesion: F64x8,
    /// Shear force (N/m) that friction still feels where they are open.
    felt: F64x8,
    /// Normal force (N/m) at or below which each is open.
    open: F64x8,
    /// Where its contacts are in the order.
    range: [u32; 2],
    /// Bit masks of lanes: open contacts, and contacts in compression.
    open_lanes: u8,
    compressed: u8,
    /// Whether spring or strength of one of them follow a curve, or its joint dilates.
    curved: bool,
}

/// Contacts of a row at the start of a step.
#[derive(Debug, Default)]
#[repr(align(64))]
struct Start {
    /// Springs normal and shear (N/m per metre), and the forces (N/m) that they store, or the closure (m).
    stiffness: [F64x8; 2],
    stored: [F64x8; 2],
    /// Lanes, a bit each, whose spring is the joint's own in a dynamic stage, whose spring follows a curve (never the
    /// shear spring), whose joint is a bond that softens, and whose points lie in one block.
    own: [u8; 2],
    closing: [u8; 2],
    bonded: u8,
    joined: u8,
}

impl Start {
    #[inline(always)]
    fn take(&mut self, lane: usize, contact: &VertexEdge, approach: &Approach) {
        let VertexEdge { stiffness, gap, .. } = contact;
        let is_bond = contact.bond(&approach.setting).is_some();
        let closes_on_a_curve = is_bond || contact.closure(&approach.setting).is_curved();
        let stored = [if closes_on_a_curve { -gap } else { -stiffness[0] * gap }, contact.shear_stored()];
        for k in 0..2 {
            self.stiffness[k][lane] = stiffness[k];
            self.stored[k][lane] = stored[k];
        }
        self.closing[0] |= u8::from(closes_on_a_curve) << lane;
        self.bonded |= u8::from(is_bond) << lane;
        if approach.damping.is_some() && !is_bond {
            let penalty = approach.setting.laws[contact.law].penalty;
            (0..2).for_each(|k| self.own[k] |= u8::from(!penalty[k]) << lane);
        }
    }
}

/// Contacts and order from which a wide contact is made.
pub struct ContactView<'a> {
    /// Contacts of the step, and the order in which they are solved.
    pub contacts: &'a [VertexEdge],
    pub order: &'a [u32],
    /// Masses.
    pub view: SolverView<'a>,
    /// Choices.
    pub options: &'a SolverOptions,
    /// Motion at the start.
    pub approach: &'a Approach<'a>,
}

impl ContactView<'_> {
    /// Contacts that come `by` positions after those of a range.
    #[inline(always)]
    fn later(&self, range: [u32; 2], by: usize) -> impl Iterator<Item = usize> {
        let [first, end] = range.map(|at| (at as usize + by).min(self.order.len()));
        self.order[first..end].iter().map(|&contact| contact as usize)
    }

    /// Prefetches contacts that come later, and the points of those that are prefetched already.
    #[inline(always)]
    fn fetch(&self, range: [u32; 2]) {
        for contact in self.later(range, 2 * AHEAD) {
            prefetch(&self.contacts[contact..=contact]);
        }
        let setting = &self.approach.setting;
        for contact in self.later(range, AHEAD) {
            let point = self.contacts[contact].point;
            let this = point.index()..=point.index();
            prefetch(&setting.boundary.covers[this.clone()]);
            prefetch(&setting.boundary.weights[this.clone()]);
            prefetch(&setting.boundary.block[this]);
            setting.frames.fetch(point);
        }
    }
}

impl WideContact {
    /// Prepares the contacts of a range of the order, with the forces that are expected;
    /// first and second points lie in the blocks of a lane in their order.
    #[inline(always)]
    pub fn prepare<L: Values>(
        &mut self,
        lanes: L,
        range: [u32; 2],
        blocks: &[Bodies; 2],
        from: &ContactView,
        first_cover: CoverId,
    ) {
        self.range = range;
        self.points.iter_mut().for_each(Points::begin);
        self.curved = false;
        let mut start = Start::default();
        let contacts = self.of(from.order);
        if from.order.len() > FAR {
            from.fetch(range);
        }
        for (lane, &contact) in contacts.iter().enumerate() {
            self.take(lane, &from.contacts[contact as usize], &mut start, blocks, from, first_cover);
        }
        (contacts.len()..LANES).for_each(|lane| self.leave_out(lane));
        self.answer(lanes, &start, blocks, from, first_cover);
        if start.joined != 0 {
            let [first, second] = &mut self.points;
            first.join(start.joined, second);
        }
        debug_assert!(self.is_apart(contacts.len()), "two contacts of one row share a cover");
    }

    /// Positions of the nodes (m).
    #[inline(always)]
    fn places<L: Values>(&self, lanes: L) -> [L::F; 2] {
        [lanes.load(&self.at[0]), lanes.load(&self.at[1])]
    }

    /// Its contacts.
    #[inline(always)]
    fn of<'a>(&self, order: &'a [u32]) -> &'a [u32] {
        &order[self.range[0] as usize..self.range[1] as usize]
    }

    /// Whether no two of the first `count` lanes push the same cover.
    fn is_apart(&self, count: usize) -> bool {
        let covers = |lane: usize| self.points.iter().flat_map(move |points| points.moved(lane));
        (0..count).all(|a| (0..a).all(|b| covers(a).all(|i| covers(b).all(|j| i != j))))
    }

    #[inline(always)]
    fn take(
        &mut self,
        lane: usize,
        contact: &VertexEdge,
        start: &mut Start,
        blocks: &[Bodies; 2],
        from: &ContactView,
        first_cover: CoverId,
    ) {
        let setting = &from.approach.setting;
        let (boundary, point) = (setting.boundary, contact.point);
        let mut points = [(&boundary.covers[point], &boundary.weights[point]), (&contact.covers, &contact.weights)];
        let mut normal = contact.normal;
        if boundary.block[point] != blocks[0].blocks[lane] {
            points.swap(0, 1);
            normal = -normal;
        }
        self.points[0].take(lane, points[0], first_cover);
        self.points[1].take(lane, points[1], first_cover);
        (self.normal[0][lane], self.normal[1][lane]) = (normal.x, normal.y);
        let limits = contact.limits(setting);
        [self.force[0][lane], self.force[1][lane]] = contact.expected(&limits);
        let at = setting.frames.position(point);
        (self.at[0][lane], self.at[1][lane]) = (at.x, at.y);
        start.take(lane, contact, from.approach);
        start.joined |= u8::from(blocks[0].blocks[lane] == blocks[1].blocks[lane]) << lane;
        let (friction, cohesion, tension, felt) = match limits {
            Limits::MohrCoulomb { friction, cohesion, tension, felt } => (friction, cohesion, tension, felt),
            Limits::BartonBandis { .. } => (0.0, 0.0, 0.0, 0.0),
        };
        (self.friction[lane], self.cohesion[lane], self.felt[lane]) = (friction, cohesion, felt);
        self.open[lane] = match (start.bonded >> lane & 1 != 0, tension > 0.0) {
            (true, _) => f64::NEG_INFINITY,
            (false, true) => (-tension).next_down(),
            (false, false) => 0.0,
        };
        self.curved |= limits.is_curved() | (start.closing[0] != 0) | contact.dilates(setting);
    }

    /// Leaves a lane without contact.
    #[inline(always)]
    fn leave_out(&mut self, lane: usize) {
        for k in 0..2 {
            self.points[k].leave_out(lane);
            (self.at[k][lane], self.normal[k][lane], self.force[k][lane]) = (0.0, 0.0, 0.0);
        }
        (self.open[lane], self.friction[lane], self.cohesion[lane], self.felt[lane]) = (0.0, 0.0, 0.0, 0.0);
    }

    /// Makes of what has been taken what the springs answer with in this step (Eqs. 14, 15).
    #[inline(always)]
    fn answer<L: Values>(
        &mut self,
        lanes: L,
        start: &Start,
        blocks: &[Bodies; 2],
        from: &ContactView,
        first_cover: CoverId,
    ) {
        let normal = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let ContactView { view, options, approach: motion, .. } = *from;
        let part = first_cover.index()..;
        let approach = self.relative(lanes, normal, &motion.predicted[part.clone()]);
        let mut last = [lanes.splat(0.0); 2];
        if start.own != [0; 2] {
            last = self.relative(lanes, normal, &motion.velocity[part.clone()]);
        }
        let at = self.places(lanes);
        let tables = [&view.mass_matrix.inverse[part.clone()], &view.masses[part]];
        let a = self.points[0].weigh(lanes, at, normal, &blocks[0], tables);
        let b = self.points[1].weigh(lanes, at, normal, &blocks[1], tables);
        let (dt, kick, one) = (lanes.splat(options.dt), lanes.splat(options.kick), lanes.splat(1.0));
        for k in 0..2 {
            let (stiffness, compliance) = (lanes.load(&start.stiffness[k]), a[k] + b[k]);
            let (approach, forward, lag) = (approach[k], lanes.splat(motion.forward), lanes.splat(0.0));
            let mut spring = Spring { stiffness, compliance, approach, forward, lag, dt, kick };
            if start.own[k] != 0 {
                let inverse = lanes.load(&blocks[0].share) + lanes.load(&blocks[1].share);
                let bouncing = motion.bouncing(lanes, inverse);
                let centred = spring.centred(lanes, last[k] * lanes.splat(motion.dt_last), bouncing);
                spring.forward = lanes.select(start.own[k], centred.forward, forward);
                spring.lag = lanes.select(start.own[k], centred.lag, lag);
            }
            if start.bonded != 0 {
                // A bond has its force at the end of the step, and no dashpot, which would outlast its strength.
                spring.forward = lanes.select(start.bonded, one, spring.forward);
            }
            let closing = start.closing[k];
            spring.stiffness = lanes.select(closing, one, stiffness);
            let SoftSpring { rest, rate, kept } = spring.response(lanes.load(&start.stored[k]));
            // Forces at once, but for a closure, of which a curve makes the force.
            let share = lanes.select(closing, one, one / (one + kept));
            lanes.store(rest * share, &mut self.answers[k].rest);
            lanes.store(rate * share, &mut self.answers[k].rate);
            lanes.store(kept * share, &mut self.answers[k].kept);
        }
    }

    /// Normal and tangential velocities (m/s) of the first points relative to the second ones, in a field of the covers
    /// of the part, while weights are those of positions.
    #[inline(always)]
    fn relative<L: Values>(&self, lanes: L, normal: [L::F; 2], field: &[Vector]) -> [L::F; 2] {
        let (a, b) = (self.points[0].sample(lanes, field), self.points[1].sample(lanes, field));
        along(normal, [a[0] - b[0], a[1] - b[1]])
    }

    /// Leaves force and state in the contact of a lane.
    #[inline(always)]
    pub fn store_force(&self, lane: usize, contact: &mut VertexEdge, approach: &Approach) {
        let bears = self.open_lanes >> lane & 1 == 0;
        let torn = !bears & (self.compressed >> lane & 1 == 0);
        let rests = approach.damping.is_none();
        contact.end([self.force[0][lane], self.force[1][lane]], bears, torn, rests, &approach.setting);
    }

    /// Applies the forces so far; returns the larger of each contact's forces (N/m), since a cohesive joint may
    /// carry shear alone.
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
        let at = self.places(lanes);
        let a = self.points[0].velocity(lanes, at, &before[0], &sides[0]);
        let b = self.points[1].velocity(lanes, at, &before[1], &sides[1]);
        let [x, y] = [lanes.load(&self.normal[0]), lanes.load(&self.normal[1])];
        let velocity = along([x, y], [a[0] - b[0], a[1] - b[1]]);
        let old = [lanes.load(&self.force[0]), lanes.load(&self.force[1])];
        let mut normal = self.answers[0].ask(lanes, velocity[0], old[0]);
        let shear = self.answers[1].ask(lanes, velocity[1], old[1]);
        let zero = lanes.splat(0.0);
        let mut limit = lanes.max(normal * lanes.load(&self.friction) + lanes.load(&self.cohesion), zero);
        if self.curved {
            let (mut asked, mut limits, mut speed) = ([[0.0; LANES]; 2], [0.0; LANES], [0.0; LANES]);
            lanes.store(normal, &mut asked[0]);
            lanes.store(shear, &mut asked[1]);
            lanes.store(limit, &mut limits);
            lanes.store(velocity[1], &mut speed);
            self.follow(from, &mut asked, &speed, &mut limits);
            (normal, limit) = (lanes.load(&asked[0]), lanes.load(&limits));
        }
        // No branch depends on which contacts are closed, slip or change: it would be known too late.
        let open = lanes.load(&self.open);
        (self.open_lanes, self.compressed) = (lanes.at_most(normal, open), lanes.at_most(zero, normal));
        let fades = lanes.max(lanes.load(&self.felt), lanes.load(&self.cohesion) + normal);
        let limit = lanes.select(self.open_lanes, fades, limit);
        let force = [lanes.keep_above(normal, normal, open), lanes.min(lanes.max(shear, -limit), limit)];
        let step = [force[0] - old[0], force[1] - old[1]];
        let impulse = turned(lanes, [x, y], step, from.options.kick);
        self.push(lanes, impulse, &before, sides, cover_impulse);
        lanes.store(force[0], &mut self.force[0]);
        lanes.store(force[1], &mut self.force[1]);
        [larger_size(lanes, step), larger_size(lanes, force)]
    }

    /// Applies impulses to the points; `before` holds the values as gathered. The second points go first, and lanes
    /// from the last on: duplicate covers have zero weight, so that overwriting them is harmless.
    #[inline(always)]
    fn push<L: Values>(
        &self,
        lanes: L,
        impulse: [L::F; 2],
        before: &[[[L::F; 2]; 3]; 2],
        sides: &mut [WideBlock<L>; 2],
        cover_impulse: &mut [Vector],
    ) {
        let ([x, y], at) = (impulse, self.places(lanes));
        self.points[1].push(lanes, at, [-x, -y], &before[1], &mut sides[1], cover_impulse);
        self.points[0].push(lanes, at, impulse, &before[0], &mut sides[0], cover_impulse);
    }

    /// Normal forces and shear limits (N/m) of joints whose spring or strength follows a curve, or that dilate, at the
    /// velocities (m/s) along the edges by all impulses so far.
    #[cold]
    #[inline(never)]
    fn follow(&self, from: &ContactView, [asked, shear]: &mut [F64x8; 2], speed: &F64x8, limits: &mut F64x8) {
        for (lane, &contact) in self.of(from.order).iter().enumerate() {
            let (contact, setting) = (&from.contacts[contact as usize], &from.approach.setting);
            if let Some(bond) = contact.bond(setting) {
                let (closes, takes) = (asked[lane], self.answers[0].kept[lane]);
                asked[lane] = bond.normal(closes, takes);
                // Of the shear spring the answer is the force, of which `kept` is the share that it takes from itself.
                let ease = 1.0 / (contact.stiffness[1] * (1.0 - self.answers[1].kept[lane]));
                let opening = takes * asked[lane] - closes;
                limits[lane] = bond.shear(asked[lane], shear[lane].abs(), ease, opening);
                continue;
            }
            let (closure, law) = (contact.closure(setting), contact.limits(setting));
            let kept = self.answers[0].kept[lane];
            let dilates = contact.dilates(setting);
            let slips = |limit: f64| shear[lane].abs().max(contact.shear_stored().abs()) > limit;
            if dilates && slips(law.shear(asked[lane], contact.length)) {
                let slide = self.slide(lane, contact, from, [asked[lane], shear[lane]], speed);
                asked[lane] = contact.climb(&slide, &law, setting);
            }
            asked[lane] = closure.force(asked[lane], kept);
            if closure.is_curved() || law.is_curved() || dilates {
                limits[lane] = law.shear(asked[lane], contact.length);
            }
        }
    }

    /// The contact of a lane, which climbs while it slips.
    fn slide(
        &self,
        lane: usize,
        contact: &VertexEdge,
        from: &ContactView,
        [normal, stick]: [f64; 2],
        speed: &F64x8,
    ) -> Slide {
        let [spring, shear] = &self.answers;
        let fixed = contact.relative(from.approach.setting.boundary, from.approach.predicted)[1];
        Slide {
            normal,
            rate: spring.rate[lane],
            stick,
            shear: self.force[1][lane],
            speed: fixed + speed[lane],
            eased: shear.kept[lane] / shear.rate[lane],
            dt: from.options.dt,
        }
    }
}

/// Normal and tangential components of vectors.
#[inline(always)]
fn along<T: Arithmetic>([x, y]: [T; 2], vector: [T; 2]) -> [T; 2] {
    [vector[0] * x + vector[1] * y, x * vector[1] - y * vector[0]]
}

impl SoftSpring<F64x8> {
    /// Force of the springs at velocities (m/s) by all impulses so far.
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
