//! The driver: gives samples to workers, as many at a time as asked for.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// How often a sample is given out whose worker was lost.
const TRIES: usize = 3;

/// Samples whose workers were lost again and again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lost {
    /// How many.
    pub count: usize,
    /// Why the first of them was.
    pub message: String,
}

/// Works out the samples `wanted` on `jobs` threads. `ask` works out one; where it fails, the worker was lost, and the
/// sample is given out again, three times at most. `keep` gets each answer as soon as it is there, on the thread of the
/// caller; where it fails, nothing more is given out. Setting `stop` ends with the samples that are under way.
///
/// # Errors
/// The first failure of `keep`.
pub fn work<T: Send, E>(
    wanted: &[usize],
    jobs: usize,
    stop: &AtomicBool,
    ask: impl Fn(usize) -> Result<T, String> + Sync,
    mut keep: impl FnMut(usize, T) -> Result<(), E>,
) -> Result<Lost, E> {
    let (next, full) = (AtomicUsize::new(0), AtomicBool::new(false));
    let ended = || stop.load(Ordering::Relaxed) || full.load(Ordering::Relaxed);
    let (sender, answers) = mpsc::channel();
    let worker = |sender: mpsc::Sender<(usize, Result<T, String>)>| {
        while let Some(&k) = wanted.get(next.fetch_add(1, Ordering::Relaxed)).filter(|_| !ended()) {
            let mut answer = ask(k);
            for _ in 1..TRIES {
                if answer.is_ok() || ended() {
                    break;
                }
                answer = ask(k);
            }
            if sender.send((k, answer)).is_err() {
                return;
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs.min(wanted.len()) {
            let sender = sender.clone();
            scope.spawn(|| worker(sender));
        }
        drop(sender);
        let (mut lost, mut failure) = (Lost::default(), None);
        for (k, answer) in answers {
            match answer {
                Ok(answer) if failure.is_none() => failure = keep(k, answer).err(),
                Ok(_) => {}
                Err(message) => {
                    if lost.count == 0 {
                        lost.message = message;
                    }
                    lost.count += 1;
                }
            }
            if failure.is_some() {
                full.store(true, Ordering::Relaxed);
            }
        }
        failure.map_or(Ok(lost), Err)
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn every_sample_is_worked_out_once_and_a_lost_worker_ends_no_other() {
        let asked = Mutex::new(Vec::new());
        let mut kept = BTreeSet::new();
        let wanted: Vec<usize> = (0..40).collect();
        let ask = |k: usize| {
            asked.lock().unwrap().push(k);
            let times = asked.lock().unwrap().iter().filter(|&&other| other == k).count();
            // Sample 7 succeeds at its third time, sample 9 never.
            if k == 9 || (k == 7 && times < 3) { Err(format!("lost {k}")) } else { Ok(k * k) }
        };
        let keep = |k: usize, square: usize| {
            assert_eq!(square, k * k);
            assert!(kept.insert(k));
            Ok::<(), String>(())
        };
        let lost = work(&wanted, 4, &AtomicBool::new(false), ask, keep).unwrap();
        assert_eq!(lost, Lost { count: 1, message: "lost 9".to_owned() });
        assert_eq!(kept, wanted.into_iter().filter(|&k| k != 9).collect());
        assert_eq!(asked.lock().unwrap().len(), 38 + 3 + 3);
    }

    #[test]
    fn a_store_that_fails_ends_the_work() {
        let wanted: Vec<usize> = (0..1000).collect();
        let mut count = 0;
        let keep = |_, ()| {
            count += 1;
            if count == 3 { Err("full") } else { Ok(()) }
        };
        let ask = |_| {
            thread::sleep(std::time::Duration::from_micros(100));
            Ok(())
        };
        assert_eq!(work(&wanted, 2, &AtomicBool::new(false), ask, keep), Err("full"));
        assert_eq!(count, 3);
    }
}
