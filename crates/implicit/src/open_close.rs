//! The open–close iteration: repeats solution, contact states and refactorisation until no state changes and the
//! forces out of balance are below the tolerance. Each solution is a step of Newton's method for the rotations as well.

use std::time::Instant;

use enmm::geometry::Vector;
use enmm::internals::contact::ContactState;

use super::choices::{Implicit, Rule};
use super::step::{CUT, ImplicitStep, Inertia};

/// Forces out of balance over the largest part at which a dynamic sub-step has settled.
const BALANCED: f64 = 1e-5;
/// The same of a static one, of which the next takes up what is left.
const BALANCED_STATIC: f64 = 1e-4;
/// Forces out of balance with which a dynamic sub-step is taken when its iterations are used up: what is left goes into
/// the next.
const ENOUGH: f64 = 1e-3;
/// Forces out of balance with which a static sub-step is taken when its iterations are used up.
const ENOUGH_STATIC: f64 = 3e-3;
/// Forces out of balance from which a static sub-step was easy: the next has less inertia.
const EASY_STATIC: f64 = 1e-3;
/// Solutions up to which contacts hardly change in a static sub-step.
const FEW: u32 = 3;
/// Longest time for which inertia counts in a static sub-step, over its length, while contacts hardly change.
const STRETCH_FREE: f64 = 1000.0;
/// The same while contacts slip, whose order should be that of a slow loading.
const STRETCH_SLIPPING: f64 = 3.0;
/// Iterations of a static sub-step for every one of a dynamic one: what is taken unsettled slips joints falsely, and no
/// motion brings them back.
const STATIC_ITERATIONS: u32 = 5;
/// Solutions with an old factor for every one with a new one.
const CORRECTIONS: u32 = 3;
/// Decrease of the forces out of balance in a correction below which a new factor is worth its price.
const SLOW: f64 = 0.7;

/// Gap, relative to the mesh size, within which two faces touch.
const TOUCHING: f64 = 1e-6;
/// Share of the forces out of balance along a solution that may be left after it.
const OVERSHOOT: f64 = 0.5;
/// Most positions tried along a solution.
const SEARCHES_MAX: u32 = 8;

/// How far forces are from balance.
#[derive(Debug, Clone, Copy)]
struct Balance {
    /// Whether a contact is not as the factor holds it.
    changed: bool,
    /// Norm of the forces out of balance (N/m).
    residual: f64,
    /// Norm of the largest part of the forces (N/m).
    scale: f64,
}

impl ImplicitStep<'_> {
    /// Iterates to the end of a sub-step; returns whether it has settled within the limits.
    pub(super) fn implicit_open_close(&mut self, implicit: &Implicit, inertia: &Inertia) -> bool {
        self.set_offset(implicit, inertia);
        self.buffers.factored.clear();
        let (mut factors, mut solutions, mut last) = (0, 0, f64::INFINITY);
        let most = implicit.iterations_max * if inertia.rests { STATIC_ITERATIONS } else { 1 };
        let tolerance = if inertia.rests { BALANCED_STATIC } else { BALANCED };
        self.buffers.cautious = false;
        let mut balance = self.evaluate(inertia);
        self.presume_closed();
        let settled = loop {
            if solutions > 0 && balance.residual <= (tolerance * balance.scale).max(f64::MIN_POSITIVE) {
                break true;
            }
            let factor_due = balance.changed || solutions == 0 || balance.residual > SLOW * last;
            let spent = solutions >= (CORRECTIONS + 1) * most;
            if !balance.residual.is_finite() || spent || factor_due && factors >= most {
                break false;
            }
            if factor_due {
                let clock = Instant::now();
                self.singular = self.implicit_factorise(inertia).is_err();
                self.workspace.seconds.sweep += clock.elapsed().as_secs_f64();
                if self.singular {
                    break false;
                }
                factors += 1;
            }
            last = balance.residual;
            self.solve();
            balance = self.search_line(inertia);
            solutions += 1;
        };
        let enough = if inertia.rests { ENOUGH_STATIC } else { ENOUGH };
        let taken = settled || balance.residual <= enough * balance.scale;
        self.state.counters.unsettled += u64::from(taken && !settled);
        self.count_implicit(inertia.dt, solutions);
        if inertia.rests {
            let balanced = balance.residual <= EASY_STATIC * balance.scale;
            self.renew_stretch(taken, solutions, balanced);
        }
        let farthest = self.buffers.moved.iter().map(|u| u.norm_squared()).fold(0.0, f64::max).sqrt();
        taken && farthest <= implicit.displacement_max
    }

    /// The time for which inertia counts in the next static sub-step: cut when this one has not settled, longer when it
    /// was easy, without a limit that matters when it took but a few solutions.
    fn renew_stretch(&mut self, settled: bool, solutions: u32, balanced: bool) {
        let stretch = &mut self.state.static_stretch;
        if !settled {
            *stretch *= CUT;
        } else if solutions <= FEW {
            *stretch = (2.0 * *stretch).min(STRETCH_FREE);
        } else if balanced {
            *stretch = stretch.max((1.5 * *stretch).min(STRETCH_SLIPPING));
        }
    }

    /// Forces at the positions reached, and how far they are from balance.
    fn evaluate(&mut self, inertia: &Inertia) -> Balance {
        let clock = Instant::now();
        self.implicit_internal();
        let changed = self.update_contacts();
        let [residual, scale] = self.implicit_residual(inertia);
        self.workspace.seconds.elements += clock.elapsed().as_secs_f64();
        Balance { changed, residual, scale }
    }

    /// New contacts that touch count as locked in the first factor: whether they open is then decided.
    fn presume_closed(&mut self) {
        let touching = TOUCHING * self.model.covers.mesh.size;
        for contact in self.workspace.contacts.iter_mut().filter(|c| c.fresh && c.gap.abs() < touching) {
            contact.history.state = ContactState::Lock;
        }
    }

    /// Moves along the solution: all the way, or less when contacts that close or slip stop it before.
    ///
    /// Springs that only press and friction under a given pressure derive from a convex energy, of which the forces
    /// out of balance are the descent: a way after which they point back by more than half was too long.
    fn search_line(&mut self, inertia: &Inertia) -> Balance {
        let buffers = &mut self.buffers;
        buffers.pressing.clear();
        buffers.pressing.extend(self.workspace.contacts.iter().map(|c| c.history.normal_force));
        let start = self.along();
        let (mut low, mut high) = ([0.0, start], None);
        let (mut share, mut reached) = (1.0, 0.0);
        for _ in 0..SEARCHES_MAX {
            self.go(share - reached);
            reached = share;
            let here = self.probe(inertia);
            if here.abs() <= OVERSHOOT * start.abs() || (share == 1.0 && here > 0.0) || !here.is_finite() {
                break;
            }
            if here > 0.0 {
                low = [share, here];
            } else {
                high = Some([share, here]);
            }
            let Some(far) = high else { break };
            self.buffers.cautious = true;
            share = (low[0] * far[1] - far[0] * low[1]) / (far[1] - low[1]);
            share = share.clamp(low[0] + 0.05 * (far[0] - low[0]), far[0] - 0.05 * (far[0] - low[0]));
        }
        let changed = self.update_contacts();
        let [residual, scale] = self.implicit_residual(inertia);
        Balance { changed, residual, scale }
    }

    /// Forces at the positions reached under the pressure of before, and how far they push along the solution.
    fn probe(&mut self, inertia: &Inertia) -> f64 {
        let clock = Instant::now();
        self.implicit_internal();
        self.implicit_probe();
        self.implicit_residual(inertia);
        self.workspace.seconds.elements += clock.elapsed().as_secs_f64();
        self.along()
    }

    /// Product of the forces out of balance and the solution.
    fn along(&self) -> f64 {
        let buffers = &self.buffers;
        buffers.residual.iter().zip(buffers.unknowns.chunks_exact(2)).map(|(f, d)| f.x * d[0] + f.y * d[1]).sum()
    }

    /// Adds a share of the solution to what has moved.
    fn go(&mut self, share: f64) {
        let buffers = &mut self.buffers;
        for (moved, d) in buffers.moved.iter_mut().zip(buffers.unknowns.chunks_exact(2)) {
            *moved += Vector::new(d[0], d[1]) * share;
        }
    }

    /// Inertia besides that of the displacement: −c·dt·v₀ and, by the trapezoidal rule, −a₀ (Eq. 67).
    fn set_offset(&mut self, implicit: &Implicit, inertia: &Inertia) {
        let state = &*self.state;
        let buffers = &mut self.buffers;
        if inertia.rests {
            buffers.offset.fill(Vector::zeros());
            return;
        }
        for (offset, v) in buffers.offset.iter_mut().zip(&state.velocity) {
            *offset = v * (-inertia.factor * inertia.dt);
        }
        if implicit.rule == Rule::Trapezoidal {
            buffers.offset.iter_mut().zip(&state.acceleration).for_each(|(offset, a)| *offset -= a);
        }
    }

    /// Solves for the forces out of balance.
    pub(super) fn solve(&mut self) {
        let clock = Instant::now();
        let buffers = &mut self.buffers;
        for (i, force) in buffers.residual.iter().enumerate() {
            (buffers.unknowns[2 * i], buffers.unknowns[2 * i + 1]) = (force.x, force.y);
        }
        buffers.matrix.solve(&mut buffers.unknowns);
        self.workspace.seconds.sweep += clock.elapsed().as_secs_f64();
    }

    fn count_implicit(&mut self, dt: f64, solutions: u32) {
        let contacts = self.workspace.contacts.len() as u64;
        let counters = &mut self.state.counters;
        counters.substeps += 1;
        counters.sweeps += u64::from(solutions);
        counters.sweeps_max = counters.sweeps_max.max(solutions);
        counters.contacts_solved += u64::from(solutions + 1) * contacts;
        counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
        counters.dt_max = counters.dt_max.max(dt);
    }

    /// Contacts that carry force, for the report.
    pub(super) fn count_contacts(&self, which: ContactState) -> u32 {
        self.workspace.contacts.iter().filter(|c| c.history.state == which).count() as u32
    }
}
