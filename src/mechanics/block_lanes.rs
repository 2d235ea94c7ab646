//! Loops over the covers of a block, eight at once: sums for its rigid motion, kick, and end of the step (Eqs. 3, 5,
//! 10–12).
//!
//! Positions and velocities are relative to one cover of the block. So one pass gives all sums without loss of digits,
//! far from the origin and at high speed too.

use std::ops::{AddAssign, Range};

use enmm_lanes::{Arithmetic, LANES, Lanes};

use crate::geometry::{Point, Vector};

/// J90·v: turned by +90°.
fn turned(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// The sums over the lanes of each.
#[inline(always)]
fn totals<L: Lanes, const N: usize>(lanes: L, sums: &[L::F; N]) -> [f64; N] {
    let mut totals = [0.0; N];
    for (total, sum) in totals.iter_mut().zip(sums) {
        *total = lanes.sum(*sum);
    }
    totals
}

/// Origin of positions and velocities in sums.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reference {
    /// Position (m).
    pub position: Point,
    /// Velocity (m/s).
    pub velocity: Vector,
}

/// Sums over covers of a block: position q and velocity w are relative to a reference.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockSums {
    /// Σμq (kg).
    pub inertial_place: Vector,
    /// Σmq (kg).
    pub first: Vector,
    /// Σm|q|² (kg·m).
    pub polar: f64,
    /// Σμw (kg/s).
    pub inertial_velocity: Vector,
    /// Σmw (kg/s).
    pub momentum: Vector,
    /// Σm q×w (kg·m/s).
    pub moment: f64,
    /// ΣF (N/m).
    pub force: Vector,
    /// Σq×F (N).
    pub torque: f64,
    /// Σ(μ/m)F (N/m).
    pub weighted: Vector,
}

impl AddAssign for BlockSums {
    fn add_assign(&mut self, other: Self) {
        self.inertial_place += other.inertial_place;
        self.first += other.first;
        self.polar += other.polar;
        self.inertial_velocity += other.inertial_velocity;
        self.momentum += other.momentum;
        self.moment += other.moment;
        self.force += other.force;
        self.torque += other.torque;
        self.weighted += other.weighted;
    }
}

/// Covers of a block, or of the part of it in one chunk: slices of equal length.
#[derive(Clone, Copy)]
pub struct Span<'a> {
    /// Star positions (m).
    pub star: &'a [Point],
    /// Displacements (m).
    pub displacement: &'a [Vector],
    /// Velocities (m/s).
    pub velocity: &'a [Vector],
    /// Lumped masses m (kg/m).
    pub mass: &'a [f64],
    /// Masses μ in the centroid (kg/m).
    pub inertial: &'a [f64],
}

/// Arithmetic covers of a span.
struct Chunk<F> {
    q: [F; 2],
    w: [F; 2],
    mass: F,
    inertial: F,
}

#[inline(always)]
fn splat<L: Lanes>(lanes: L, v: Vector) -> [L::F; 2] {
    [lanes.splat(v.x), lanes.splat(v.y)]
}

impl<F: Arithmetic> Chunk<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(lanes: L, from: &Reference, [star, u, v]: [[F; 2]; 3], [mass, inertial]: [F; 2]) -> Self {
        let (at, with) = (splat(lanes, from.position), splat(lanes, from.velocity));
        let q = [star[0] + u[0] - at[0], star[1] + u[1] - at[1]];
        Self { q, w: [v[0] - with[0], v[1] - with[1]], mass, inertial }
    }
}

impl Span<'_> {
    /// The same with lengths that the compiler sees to be equal, so that a loop checks them once.
    #[inline(always)]
    fn even(&self) -> Self {
        let count = self.star.len();
        Self {
            star: self.star,
            displacement: &self.displacement[..count],
            velocity: &self.velocity[..count],
            mass: &self.mass[..count],
            inertial: &self.inertial[..count],
        }
    }

    /// Ranges of up to eight covers.
    #[inline(always)]
    fn chunks(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let count = self.star.len();
        (0..count).step_by(LANES).map(move |k| k..(k + LANES).min(count))
    }

    /// Covers beyond the end are at the reference and have no inertial mass.
    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, range: Range<usize>, from: &Reference) -> Chunk<L::F> {
        let star = lanes.load_some_pairs(&self.star[range.clone()], from.position);
        let u = lanes.load_some_pairs(&self.displacement[range.clone()], Vector::zeros());
        let v = lanes.load_some_pairs(&self.velocity[range.clone()], from.velocity);
        let (mass, inertial) = (&self.mass[range.clone()], &self.inertial[range]);
        Chunk::new(lanes, from, [star, u, v], [lanes.load_some(mass, 1.0), lanes.load_some(inertial, 0.0)])
    }

    /// Reference of the sums of a block that begins with this span.
    pub fn reference(&self) -> Reference {
        Reference { position: self.star[0] + self.displacement[0], velocity: self.velocity[0] }
    }

    /// Sums over the span, with those of `force` (N/m) if given.
    #[inline(always)]
    pub fn sums<L: Lanes>(&self, lanes: L, from: &Reference, force: Option<&[Vector]>) -> BlockSums {
        let mut tally = Tally::new(lanes);
        for range in self.chunks() {
            let chunk = self.chunk(lanes, range.clone(), from);
            tally.add(&chunk);
            if let Some(force) = force {
                tally.add_pushed(&chunk, lanes.load_some_pairs(&force[range], Vector::zeros()));
            }
        }
        tally.total(lanes)
    }
}

/// Sums of a block in the making, and those with forces.
struct Tally<F> {
    sums: [F; 10],
    pushed: [F; 5],
}

impl<F: Arithmetic> Tally<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(lanes: L) -> Self {
        Self { sums: [lanes.splat(0.0); 10], pushed: [lanes.splat(0.0); 5] }
    }

    #[inline(always)]
    fn add(&mut self, chunk: &Chunk<F>) {
        let Chunk { q, w, mass, inertial } = *chunk;
        let mq = [mass * q[0], mass * q[1]];
        let terms = [
            inertial * q[0],
            inertial * q[1],
            mq[0],
            mq[1],
            mq[0] * q[0] + mq[1] * q[1],
            inertial * w[0],
            inertial * w[1],
            mass * w[0],
            mass * w[1],
            mq[0] * w[1] - mq[1] * w[0],
        ];
        for (sum, term) in self.sums.iter_mut().zip(&terms) {
            *sum = *sum + *term;
        }
    }

    #[inline(always)]
    fn add_pushed(&mut self, chunk: &Chunk<F>, f: [F; 2]) {
        let (q, ratio) = (chunk.q, chunk.inertial / chunk.mass);
        let terms = [f[0], f[1], q[0] * f[1] - q[1] * f[0], ratio * f[0], ratio * f[1]];
        for (sum, term) in self.pushed.iter_mut().zip(&terms) {
            *sum = *sum + *term;
        }
    }

    #[inline(always)]
    fn total<L: Lanes<F = F>>(&self, lanes: L) -> BlockSums {
        let [a, b, c, d, polar, e, f, g, h, moment] = totals(lanes, &self.sums);
        let [i, j, torque, k, l] = totals(lanes, &self.pushed);
        BlockSums {
            inertial_place: Vector::new(a, b),
            first: Vector::new(c, d),
            polar,
            inertial_velocity: Vector::new(e, f),
            momentum: Vector::new(g, h),
            moment,
            force: Vector::new(i, j),
            torque,
            weighted: Vector::new(k, l),
        }
    }
}

/// Common velocity of all covers of a block, which depends only on their position and mass:
/// a + (μ/m)·b + spin·J90·q + widening·q.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RigidVelocity {
    /// a (m/s).
    pub velocity: Vector,
    /// b (m/s).
    pub weighted: Vector,
    /// Spin (rad/s) about the reference.
    pub spin: f64,
    /// Radial velocity over the distance from the reference (1/s).
    pub widening: f64,
}

impl RigidVelocity {
    /// A spin about a position q, and a translation.
    pub fn about(velocity: Vector, spin: f64, centre: Vector) -> Self {
        Self { velocity: velocity - turned(centre) * spin, spin, ..Self::default() }
    }

    /// The same in all lanes, for a loop over covers.
    #[inline(always)]
    fn shared<L: Lanes>(&self, lanes: L) -> RigidLanes<L::F> {
        let (velocity, weighted) = (splat(lanes, self.velocity), splat(lanes, self.weighted));
        let (spin, widening) = (lanes.splat(self.spin), lanes.splat(self.widening));
        if self.weighted == Vector::zeros() {
            let velocity = [velocity[0] + weighted[0], velocity[1] + weighted[1]];
            return RigidLanes { velocity, weighted: None, spin, widening };
        }
        RigidLanes { velocity, weighted: Some(weighted), spin, widening }
    }
}

/// A [`RigidVelocity`] in all lanes; without b where that is zero.
struct RigidLanes<F> {
    velocity: [F; 2],
    weighted: Option<[F; 2]>,
    spin: F,
    widening: F,
}

impl<F: Arithmetic> RigidLanes<F> {
    /// Its value at some covers.
    #[inline(always)]
    fn at(&self, chunk: &Chunk<F>) -> [F; 2] {
        let [mut x, mut y] = self.velocity;
        if let Some(weighted) = self.weighted {
            let ratio = chunk.inertial / chunk.mass;
            (x, y) = (x + ratio * weighted[0], y + ratio * weighted[1]);
        }
        let [q, r] = chunk.q;
        [x - self.spin * r + self.widening * q, y + self.spin * q + self.widening * r]
    }
}

/// Common velocity of a large block for the covers of one of its chunks. Covers that contacts, supports or bolts may
/// read get it before the sweep, the others at the end of the step.
#[derive(Clone, Copy)]
pub struct RigidScatter<'a> {
    /// Common velocity of the block.
    pub common: &'a RigidVelocity,
    /// 1/m along x and y unless all covers can move.
    pub inverse: Option<&'a [Vector]>,
    /// Whether contacts, supports or bolts may read each cover.
    pub exposed: &'a [bool],
}

impl RigidScatter<'_> {
    /// Whether any of some covers may be read.
    #[inline(always)]
    fn is_exposed(&self, range: Range<usize>) -> bool {
        let exposed = &self.exposed[range];
        exposed.first_chunk::<LANES>().map_or_else(|| exposed.contains(&true), |eight| *eight != [false; LANES])
    }

    /// The part of `add` (m/s) for some covers: 0 where they cannot move.
    #[inline(always)]
    fn given<L: Lanes>(&self, lanes: L, range: Range<usize>, add: [L::F; 2]) -> [L::F; 2] {
        let Some(inverse) = self.inverse else { return add };
        let inverse = lanes.load_some_pairs(&inverse[range], Vector::zeros());
        [add[0] * mask(lanes, inverse[0]), add[1] * mask(lanes, inverse[1])]
    }
}

/// Terms of the predicted velocity that each cover has by itself, beside the common velocity of its block.
#[derive(Clone, Copy)]
pub struct CoverKick<'a> {
    /// Factor on the velocity.
    pub factor: f64,
    /// Time (s) for which forces act.
    pub kick: f64,
    /// Body loads (m/s²) on a fixed block.
    pub acceleration: Vector,
    /// Row-sum masses and 1/m along x and y of the covers of a fixed block, the latter unless all can move; `None` for
    /// a free block.
    pub held: Option<(&'a [f64], Option<&'a [Vector]>)>,
    /// Whether damping sets fixed axes to rest.
    pub masked: bool,
}

/// 1 where a cover can move along the axis, 0 where it is fixed: the lesser of 1 and many times 1/m.
#[inline(always)]
fn mask<L: Lanes>(lanes: L, inverse: L::F) -> L::F {
    -lanes.max(inverse * lanes.splat(-f64::MAX), lanes.splat(-1.0))
}

impl CoverKick<'_> {
    /// Velocities v (m/s) of some covers after damping, with `add` (m/s) and the kick of the forces f (N/m).
    #[inline(always)]
    fn kicked<L: Lanes>(
        &self,
        lanes: L,
        range: Range<usize>,
        (v, add): ([L::F; 2], [L::F; 2]),
        (f, mass): ([L::F; 2], L::F),
    ) -> [L::F; 2] {
        let (factor, kick) = (lanes.splat(self.factor), lanes.splat(self.kick));
        let mut out = [factor * v[0] + add[0], factor * v[1] + add[1]];
        let Some((row_sum, inverse)) = self.held else {
            let share = kick / mass;
            return [out[0] + f[0] * share, out[1] + f[1] * share];
        };
        let row_sum = lanes.load_some(&row_sum[range.clone()], 0.0);
        let inverse = match inverse {
            None => [lanes.splat(1.0) / mass; 2],
            Some(inverse) => {
                let inverse = lanes.load_some_pairs(&inverse[range], Vector::zeros());
                if self.masked {
                    out = [out[0] * mask(lanes, inverse[0]), out[1] * mask(lanes, inverse[1])];
                }
                inverse
            }
        };
        let body = splat(lanes, self.acceleration);
        let pushed = [f[0] + body[0] * row_sum, f[1] + body[1] * row_sum];
        [out[0] + pushed[0] * inverse[0] * kick, out[1] + pushed[1] * inverse[1] * kick]
    }
}

impl Span<'_> {
    /// Writes the velocities after damping and forces (N/m), with the common velocity of the block; returns the square
    /// of the largest speed before.
    #[inline(always)]
    pub fn kick<L: Lanes>(
        &self,
        lanes: L,
        from: &Reference,
        own: &CoverKick,
        common: &RigidVelocity,
        (force, predicted): (&[Vector], &mut [Vector]),
    ) -> f64 {
        let mut speed = lanes.splat(0.0);
        let (shared, any) = (common.shared(lanes), *common != RigidVelocity::default());
        for range in self.chunks() {
            let v = lanes.load_some_pairs(&self.velocity[range.clone()], from.velocity);
            let f = lanes.load_some_pairs(&force[range.clone()], Vector::zeros());
            let mut add = [lanes.splat(0.0); 2];
            if any {
                add = shared.at(&self.chunk(lanes, range.clone(), from));
            }
            speed = lanes.max(v[0] * v[0] + v[1] * v[1], speed);
            let mass = lanes.load_some(&self.mass[range.clone()], 1.0);
            let out = own.kicked(lanes, range.clone(), (v, add), (f, mass));
            lanes.store_some_pairs(out, &mut predicted[range]);
        }
        lanes.greatest(speed)
    }

    /// The sums, those with forces for a free block, and the kick without the common velocity of the block, which
    /// follows from them.
    #[inline(always)]
    pub fn sum_and_kick<L: Lanes>(
        &self,
        lanes: L,
        from: &Reference,
        own: &CoverKick,
        (force, predicted): (&[Vector], &mut [Vector]),
    ) -> (BlockSums, f64) {
        let (span, count) = (self.even(), self.star.len());
        let (force, predicted) = (&force[..count], &mut predicted[..count]);
        let (mut tally, mut speed, zero) = (Tally::new(lanes), lanes.splat(0.0), lanes.splat(0.0));
        for range in span.chunks() {
            let v = lanes.load_some_pairs(&span.velocity[range.clone()], from.velocity);
            let f = lanes.load_some_pairs(&force[range.clone()], Vector::zeros());
            let chunk = span.chunk(lanes, range.clone(), from);
            tally.add(&chunk);
            if own.held.is_none() {
                tally.add_pushed(&chunk, f);
            }
            speed = lanes.max(v[0] * v[0] + v[1] * v[1], speed);
            let out = own.kicked(lanes, range.clone(), (v, [zero; 2]), (f, chunk.mass));
            lanes.store_some_pairs(out, &mut predicted[range]);
        }
        (tally.total(lanes), lanes.greatest(speed))
    }

    /// Adds the common velocity of the block to covers that may be read before the end of the step.
    #[inline(always)]
    pub fn scatter<L: Lanes>(&self, lanes: L, from: &Reference, scatter: &RigidScatter, predicted: &mut [Vector]) {
        let common = scatter.common.shared(lanes);
        for range in self.chunks().filter(|range| scatter.is_exposed(range.clone())) {
            let chunk = self.chunk(lanes, range.clone(), from);
            let add = scatter.given(lanes, range.clone(), common.at(&chunk));
            let out = lanes.load_some_pairs(&predicted[range.clone()], Vector::zeros());
            lanes.store_some_pairs([out[0] + add[0], out[1] + add[1]], &mut predicted[range]);
        }
    }
}

/// Sums over covers of a block at the end of a step: s is the velocity before plus that after it, s' = s − 2w₀ counts
/// from twice the reference velocity w₀.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WorkSums {
    /// Σms' (kg/s).
    pub momentum: Vector,
    /// Σμs' (kg/s).
    pub inertial: Vector,
    /// Σm q×s' (kg·m/s).
    pub moment: f64,
    /// Σm w·s' (J/m).
    pub product: f64,
    /// Σ(∫ρw)s (kg/s).
    pub row_sum: Vector,
}

impl WorkSums {
    /// From those in lanes: momentum, inertial, moment, product; those with row-sum masses.
    #[inline(always)]
    fn total<L: Lanes>(lanes: L, sums: &[L::F; 6], row: &[L::F; 2]) -> Self {
        let [a, b, c, d, moment, product] = totals(lanes, sums);
        let [x, y] = totals(lanes, row);
        let (momentum, inertial) = (Vector::new(a, b), Vector::new(c, d));
        Self { momentum, inertial, moment, product, row_sum: Vector::new(x, y) }
    }
}

impl AddAssign for WorkSums {
    fn add_assign(&mut self, other: Self) {
        self.momentum += other.momentum;
        self.inertial += other.inertial;
        self.moment += other.moment;
        self.product += other.product;
        self.row_sum += other.row_sum;
    }
}

/// Covers of a block, or of the part of it in one chunk, at the end of a step: slices of equal length.
pub struct FinishSlices<'a> {
    /// Star positions (m).
    pub star: &'a [Point],
    /// Lumped masses m (kg/m).
    pub mass: &'a [f64],
    /// Masses μ in the centroid (kg/m).
    pub inertial: &'a [f64],
    /// Row-sum masses ∫ρw (kg/m).
    pub row_sum: &'a [f64],
    /// Velocities before the step (m/s).
    pub before: &'a [Vector],
    /// Velocities: predicted ones, final ones afterwards (m/s).
    pub velocity: &'a mut [Vector],
    /// Increments by contacts and supports (m/s).
    pub increment: &'a [Vector],
    /// Displacements (m): before, after the step afterwards.
    pub displacement: &'a mut [Vector],
    /// Common velocity for the covers that have not got it yet.
    pub scatter: Option<RigidScatter<'a>>,
}

/// Which parts of the end of a step are needed.
#[derive(Debug, Clone, Copy)]
pub struct FinishFlags {
    /// Time (s) for which covers move.
    pub moves_for: f64,
    /// Whether contacts push the block.
    pub is_pushed: bool,
    /// Whether any increment is not zero.
    pub is_touched: bool,
    /// Whether the work of damping is needed.
    pub is_damped: bool,
    /// Whether the work of body loads is needed.
    pub is_loaded: bool,
}

impl FinishSlices<'_> {
    /// Adds the impulses of contacts, moves the covers; returns sums for the works, the largest and the sum of all
    /// squares of speeds (m²/s²), and the largest square of a displacement (m²).
    #[inline(always)]
    pub fn finish<L: Lanes>(
        &mut self,
        lanes: L,
        from: &Reference,
        push: &RigidVelocity,
        flags: FinishFlags,
    ) -> (WorkSums, [f64; 2], f64) {
        let (zero, still, moves_for) = (lanes.splat(0.0), Vector::zeros(), lanes.splat(flags.moves_for));
        let (mut sums, mut row, mut fastest, mut squares, mut farthest) = ([zero; 6], [zero; 2], zero, zero, zero);
        let (push, with) = (push.shared(lanes), splat(lanes, from.velocity));
        let common = self.scatter.map_or(RigidVelocity::default(), |scatter| *scatter.common).shared(lanes);
        let count = self.star.len();
        let (velocity, displacement) = (&mut self.velocity[..count], &mut self.displacement[..count]);
        let (before, increment) = (&self.before[..count], &self.increment[..count]);
        let (mass, inertial) = (&self.mass[..count], &self.inertial[..count]);
        for start in (0..count).step_by(LANES) {
            let range = start..(start + LANES).min(count);
            let u = lanes.load_some_pairs(&displacement[range.clone()], still);
            let mut v = lanes.load_some_pairs(&velocity[range.clone()], still);
            // Covers beyond the end are at the reference; a mass of 1 keeps their ratio μ/m a number.
            let star = lanes.load_some_pairs(&self.star[range.clone()], from.position);
            let old = lanes.load_some_pairs(&before[range.clone()], from.velocity);
            let m = [lanes.load_some(&mass[range.clone()], 1.0), lanes.load_some(&inertial[range.clone()], 0.0)];
            let chunk = Chunk::new(lanes, from, [star, u, old], m);
            if let Some(scatter) = &self.scatter
                && !scatter.is_exposed(range.clone())
            {
                let add = scatter.given(lanes, range.clone(), common.at(&chunk));
                v = [v[0] + add[0], v[1] + add[1]];
            }
            if flags.is_touched {
                let increment = lanes.load_some_pairs(&increment[range.clone()], still);
                v = [v[0] + increment[0], v[1] + increment[1]];
            }
            if flags.is_pushed {
                let add = push.at(&chunk);
                v = [v[0] + add[0], v[1] + add[1]];
            }
            if flags.is_damped {
                let s = [chunk.w[0] + (v[0] - with[0]), chunk.w[1] + (v[1] - with[1])];
                add_works(&chunk, lanes.load_some(&mass[range.clone()], 0.0), s, &mut sums);
            }
            if flags.is_loaded {
                let before = lanes.load_some_pairs(&before[range.clone()], still);
                let row_sum = lanes.load_some(&self.row_sum[range.clone()], 0.0);
                row = [row[0] + row_sum * (before[0] + v[0]), row[1] + row_sum * (before[1] + v[1])];
            }
            let square = v[0] * v[0] + v[1] * v[1];
            (fastest, squares) = (lanes.max(square, fastest), squares + square);
            lanes.store_some_pairs(v, &mut velocity[range.clone()]);
            let u = [u[0] + v[0] * moves_for, u[1] + v[1] * moves_for];
            farthest = lanes.max(u[0] * u[0] + u[1] * u[1], farthest);
            lanes.store_some_pairs(u, &mut displacement[range]);
        }
        let works = WorkSums::total(lanes, &sums, &row);
        (works, [lanes.greatest(fastest), lanes.sum(squares)], lanes.greatest(farthest))
    }
}

#[inline(always)]
fn add_works<F: Arithmetic>(chunk: &Chunk<F>, mass: F, s: [F; 2], sums: &mut [F; 6]) {
    let Chunk { q, w, inertial, .. } = chunk;
    let ms = [mass * s[0], mass * s[1]];
    let terms =
        [ms[0], ms[1], *inertial * s[0], *inertial * s[1], q[0] * ms[1] - q[1] * ms[0], w[0] * ms[0] + w[1] * ms[1]];
    for (sum, term) in sums.iter_mut().zip(&terms) {
        *sum = *sum + *term;
    }
}
