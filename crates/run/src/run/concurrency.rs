//! Whether steps are taken on all threads or on one. On a machine that others use as well, a step that is divided waits
//! for the thread that got no processor, and can take longer than on a single thread. So a run times both kinds now and
//! then. The results do not depend on it.

use std::time::{Duration, Instant};

use enmm::model::{Simulation, StepError, StepReport};

/// Steps of a round. The first steps of a run fill buffers, so a round ends with the trial for the next one.
const ROUND: u32 = 256;
/// Steps of a trial: one half on all threads, then the other on one.
const TRIAL: u32 = 20;

/// Times of both kinds of steps in the trial, and the kind that the steps of the round are of.
#[derive(Debug)]
pub struct Concurrency {
    /// Whether there is anything to choose.
    is_free: bool,
    /// Steps of this round that are done.
    done: u32,
    /// Times of the steps of the trial, on all threads and on one.
    spent: [Duration; 2],
    is_serial: bool,
}

impl Concurrency {
    /// Of a run on as many `threads` as were asked for, or on those that prove useful.
    pub fn new(threads: Option<usize>) -> Self {
        let is_free = threads.is_none() && rayon::current_num_threads() > 1;
        Self { is_free, done: 0, spent: [Duration::ZERO; 2], is_serial: false }
    }

    /// Takes a step of the kind that is due. One with a report is dearer and has no part in a trial.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance(&mut self, simulation: &mut Simulation, report: bool) -> Result<StepReport, StepError> {
        if !self.is_free || report {
            return simulation.advance(report);
        }
        let is_serial = self.is_serial_now();
        simulation.set_serial(is_serial);
        let clock = Instant::now();
        let made = simulation.advance(report);
        self.note(is_serial, clock.elapsed());
        made
    }

    /// Whether the next step is taken on one thread.
    fn is_serial_now(&self) -> bool {
        if self.done < ROUND - TRIAL { self.is_serial } else { self.done >= ROUND - TRIAL / 2 }
    }

    /// Takes note of what a step took.
    fn note(&mut self, is_serial: bool, time: Duration) {
        if self.done >= ROUND - TRIAL {
            self.spent[usize::from(is_serial)] += time;
        }
        self.done += 1;
        if self.done == ROUND {
            let [all, one] = self.spent;
            *self = Self { is_serial: one < all, done: 0, spent: [Duration::ZERO; 2], ..*self };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kinds of the steps of some rounds, of which those on all threads and on one take so many milliseconds.
    fn rounds(concurrency: &mut Concurrency, count: u32, milliseconds: [u64; 2]) -> u32 {
        (0..count * ROUND)
            .map(|_| {
                let is_serial = concurrency.is_serial_now();
                concurrency.note(is_serial, Duration::from_millis(milliseconds[usize::from(is_serial)]));
                u32::from(is_serial)
            })
            .sum()
    }

    #[test]
    fn steps_go_where_they_take_less_and_come_back() {
        let mut concurrency = Concurrency::new(None);
        let tried = TRIAL / 2;
        assert_eq!(rounds(&mut concurrency, 3, [6, 10]), 3 * tried, "on all threads where that is quicker");
        assert_eq!(rounds(&mut concurrency, 2, [12, 10]), ROUND, "on one where others use the machine");
        assert_eq!(rounds(&mut concurrency, 1, [6, 10]), ROUND - tried, "to the end of a round");
        assert_eq!(rounds(&mut concurrency, 1, [6, 10]), tried, "and back");
    }
}
