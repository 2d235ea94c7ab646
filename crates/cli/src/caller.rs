//! Ends the program with the process that called it: a host, or `enmm sample` for each of its samples.

use std::io::Read;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use crate::INTERRUPTED;
use crate::interrupt::INTERRUPT;

/// Option of a caller that holds the other end of standard input as long as it lives.
pub const OPTION: &str = "--with-caller";
/// How long a run may take to write its checkpoint once the caller has gone.
const LEAVE: Duration = Duration::from_secs(2);

/// From now on the end of standard input is an interrupt, and after a short time the end of the program.
pub fn watch() {
    thread::spawn(|| {
        let mut input = std::io::stdin().lock();
        let mut bytes = [0; 64];
        while input.read(&mut bytes).is_ok_and(|count| count > 0) {}
        INTERRUPT.store(true, Ordering::Relaxed);
        thread::sleep(LEAVE);
        std::process::exit(i32::from(INTERRUPTED));
    });
}
