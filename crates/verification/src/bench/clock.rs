//! Figures of the system about this program: time that a thread had, and memory.

use std::fs;
use std::time::Instant;

/// Delay (s) of the processor's clock at most.
pub const PROCESSOR_TICK: f64 = 0.004;

/// Result of work on one thread and the seconds that it takes: wall time, or what the processor gave to this thread
/// where that is less, since other programs had it for the rest.
pub fn timed<R>(work: impl FnOnce() -> R) -> (R, f64) {
    let (wall, before) = (Instant::now(), processor_seconds());
    let result = work();
    let spent = processor_seconds().zip(before).map_or(f64::INFINITY, |(after, before)| after - before);
    (result, (spent + PROCESSOR_TICK).min(wall.elapsed().as_secs_f64()))
}

/// Processor time (s) that this thread has had; none where the system does not tell.
///
/// On a machine that is shared it is what wall time would be alone; its resolution is a tick of the scheduler.
pub fn processor_seconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// Most memory (bytes) that the program has held since [`forget_peak`]; none where the system does not tell.
pub fn memory_peak() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}

/// Lets [`memory_peak`] begin anew, where the system can.
pub fn forget_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}
