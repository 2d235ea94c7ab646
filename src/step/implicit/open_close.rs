//! The open–close iteration: solve, judge every contact open, slip or lock, factorise anew where a state has changed,
//! until nothing changes and the forces balance. Each solution is a step of Newton's method for the rotations as well.

use std::time::Instant;

use crate::contact::ContactState;
use crate::state::{Implicit, Rule};

use super::{Inertia, Step};

/// Forces out of balance over the largest part at which a sub-step has settled.
const BALANCED: f64 = 1e-6;
/// Solutions with an old factor for every one with a new one.
const CORRECTIONS: u32 = 3;
/// Decrease of the forces out of balance in a correction below which a new factor is worth its price.
const SLOW: f64 = 0.3;

impl Step<'_> {
    /// Iterates to the end of a sub-step; returns whether it has settled within the limits.
    pub(super) fn implicit_open_close(&mut self, implicit: &Implicit, inertia: &Inertia) -> bool {
        self.set_offset(implicit, inertia);
        self.scratch.implicit.factored.clear();
        let (mut factors, mut solutions, mut last) = (0, 0, f64::INFINITY);
        let settled = loop {
            let clock = Instant::now();
            if solutions > 0 {
                self.implicit_internal();
            }
            let changed = self.implicit_judge();
            let [residual, scale] = self.implicit_residual(inertia);
            self.scratch.seconds.elements += clock.elapsed().as_secs_f64();
            let floor = f64::MIN_POSITIVE;
            if solutions > 0 && residual <= (BALANCED * scale).max(floor) {
                break true;
            }
            let (most, factor_due) = (implicit.iterations_max, changed || residual > SLOW * last);
            if !residual.is_finite() || solutions >= (CORRECTIONS + 1) * most || factor_due && factors >= most {
                break false;
            }
            if factor_due {
                if !self.refactor(inertia) {
                    break false;
                }
                factors += 1;
            }
            last = residual;
            self.solve();
            solutions += 1;
        };
        self.count_implicit(inertia.dt, solutions);
        settled && self.largest_move() <= implicit.displacement_max
    }

    /// What inertia sees besides the displacement: −c·dt·v₀ and, by the trapezoidal rule, −a₀ (Eq. I1).
    fn set_offset(&mut self, implicit: &Implicit, inertia: &Inertia) {
        let state = &*self.state;
        let buffers = &mut self.scratch.implicit;
        if inertia.rests {
            buffers.offset.fill(crate::geometry::Vector::zeros());
            return;
        }
        for (offset, v) in buffers.offset.iter_mut().zip(&state.velocity) {
            *offset = v * (-inertia.factor * inertia.dt);
        }
        if implicit.rule == Rule::Trapezoidal {
            buffers.offset.iter_mut().zip(&state.acceleration).for_each(|(offset, a)| *offset -= a);
        }
    }

    /// A new factor for the contacts as judged; false when the matrix is not positive definite.
    fn refactor(&mut self, inertia: &Inertia) -> bool {
        let clock = Instant::now();
        let done = self.implicit_factorise(inertia).is_ok();
        self.scratch.seconds.sweep += clock.elapsed().as_secs_f64();
        self.singular = !done;
        done
    }

    /// Adds the solution for the forces out of balance to what has moved.
    pub(super) fn solve(&mut self) {
        let clock = Instant::now();
        let buffers = &mut self.scratch.implicit;
        for (i, force) in buffers.residual.iter().enumerate() {
            (buffers.unknowns[2 * i], buffers.unknowns[2 * i + 1]) = (force.x, force.y);
        }
        buffers.matrix.solve(&mut buffers.unknowns);
        for (i, moved) in buffers.moved.iter_mut().enumerate() {
            moved.x += buffers.unknowns[2 * i];
            moved.y += buffers.unknowns[2 * i + 1];
        }
        self.scratch.seconds.sweep += clock.elapsed().as_secs_f64();
    }

    fn largest_move(&self) -> f64 {
        self.scratch.implicit.moved.iter().map(|u| u.norm_squared()).fold(0.0, f64::max).sqrt()
    }

    fn count_implicit(&mut self, dt: f64, solutions: u32) {
        let contacts = self.scratch.contacts.len() as u64;
        let counters = &mut self.state.counters;
        counters.substeps += 1;
        counters.sweeps += u64::from(solutions);
        counters.sweeps_max = counters.sweeps_max.max(solutions);
        counters.judged += u64::from(solutions + 1) * contacts;
        counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
        counters.dt_max = counters.dt_max.max(dt);
    }

    /// Contacts that carry force, for the report.
    pub(super) fn count_contacts(&self, which: ContactState) -> u32 {
        self.scratch.contacts.iter().filter(|c| c.history.state == which).count() as u32
    }
}
