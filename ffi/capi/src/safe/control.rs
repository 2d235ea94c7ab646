//! Calls that a host looks at and stops.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use engine::cosimulation::{Pace, Watch};

use crate::types::enmm_progress;

/// Where the progress of calls goes; true ends the call.
pub type Progress = Box<dyn Fn(&enmm_progress) -> bool + Send + Sync>;

/// Least time between two looks of a host.
const PAUSE: Duration = Duration::from_millis(50);

/// The wish of any thread that the call in progress ends.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Ends the call in progress.
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Forgets wishes that came before a call.
    pub fn clear(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// The watch that obeys it and, now and then, shows the host how far a call has come.
    pub fn watch(&self, progress: Option<Progress>) -> Watch {
        let Self(is_raised) = self.clone();
        let mut next = Instant::now();
        Box::new(move |pace| {
            let is_over = is_raised.load(Ordering::Relaxed)
                || progress.as_ref().is_some_and(|progress| {
                    let now = Instant::now();
                    let is_due = now >= next;
                    is_due && {
                        next = now + PAUSE;
                        progress(&enmm_progress::from(pace))
                    }
                });
            if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }
}

impl From<&Pace> for enmm_progress {
    fn from(pace: &Pace) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            time: pace.time,
            end: pace.end,
            unbalanced: pace.unbalanced.unwrap_or(-1.0),
            is_equilibrium: u32::from(pace.is_equilibrium),
            reserved: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use super::*;

    const PACE: Pace = Pace { time: 1.0, end: 2.0, unbalanced: None, is_equilibrium: false };

    #[test]
    fn a_watch_obeys_any_thread_and_the_host() {
        let interrupt = Interrupt::default();
        let mut watch = interrupt.watch(None);
        assert!(watch(&PACE).is_continue());
        let other = interrupt.clone();
        std::thread::spawn(move || other.raise()).join().expect("a thread");
        assert!(watch(&PACE).is_break());
        interrupt.clear();
        assert!(watch(&PACE).is_continue());
        assert!(interrupt.watch(Some(Box::new(|_| true)))(&PACE).is_break());
    }

    #[test]
    fn a_host_looks_no_more_often_than_it_has_been_told() {
        let looks = Arc::new(AtomicUsize::new(0));
        let own = Arc::clone(&looks);
        let count = move |progress: &enmm_progress| {
            assert_eq!((progress.time, progress.end, progress.unbalanced), (1.0, 2.0, -1.0));
            own.fetch_add(1, Ordering::Relaxed);
            false
        };
        let mut watch = Interrupt::default().watch(Some(Box::new(count)));
        let begin = Instant::now();
        while begin.elapsed() < 3 * PAUSE {
            assert!(watch(&PACE).is_continue());
        }
        let most = begin.elapsed().as_millis() / PAUSE.as_millis() + 1;
        assert!((2..=most).contains(&(looks.load(Ordering::Relaxed) as u128)));
    }
}
