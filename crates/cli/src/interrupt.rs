//! Signals that ask the program to end: a run then leaves a checkpoint and a message.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::{FAILED, Failure, INTERRUPTED, OrFail};

/// Set by the first interrupt.
pub static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// A second interrupt of the user ends the program at once.
fn interrupt() {
    if INTERRUPT.swap(true, Ordering::Relaxed) {
        std::process::exit(i32::from(INTERRUPTED));
    }
}

/// From now on an interrupt requests an end with a checkpoint, as do the signals by which batch systems warn of theirs:
/// the limit of processor time, which comes again each second, and two that have no meaning of their own.
#[cfg(unix)]
pub fn listen() -> Result<(), Failure> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2};
    let answer = |signal| match signal {
        SIGINT | SIGTERM | SIGHUP => interrupt(),
        _ => INTERRUPT.store(true, Ordering::Relaxed),
    };
    let hangup = Some(SIGHUP).filter(|signal| !is_ignored(*signal));
    let signals = [SIGINT, SIGTERM, SIGUSR1, SIGUSR2, libc::SIGXCPU].into_iter().chain(hangup);
    let heard = signal_hook::iterator::Signals::new(signals).and_then(|mut signals| {
        let listener = std::thread::Builder::new().name("signals".to_owned());
        listener.spawn(move || signals.forever().for_each(answer)).map(drop)
    });
    heard.map_err(unheard).or_fail(FAILED)
}

/// Whether the caller has switched a signal off, as `nohup` does; no where the system does not say so.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}

/// From now on an interrupt requests an end with a checkpoint.
#[cfg(not(unix))]
pub fn listen() -> Result<(), Failure> {
    ctrlc::set_handler(interrupt).map_err(unheard).or_fail(FAILED)
}

fn unheard(error: impl std::fmt::Display) -> String {
    format!("cannot listen for interrupts ({error})")
}

/// Makes a file that grows beyond the limit of the system an error of its write, which names it, and not the end of the
/// program.
#[cfg(unix)]
pub fn outlive_full_files() {
    // Where no handler can be set the system ends the program, as without one.
    let _ = signal_hook::flag::register(libc::SIGXFSZ, std::sync::Arc::default());
}

#[cfg(not(unix))]
pub fn outlive_full_files() {}
