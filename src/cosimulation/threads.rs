//! Threads of steps. Those of a process are not in the ones that it forks, where waiting for them would never end.

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::CosimulationError;

/// Threads of the process that made them.
#[derive(Debug)]
pub(super) struct Pool {
    process: u32,
    threads: Option<ThreadPool>,
    count: usize,
}

impl Pool {
    /// Starts so many threads.
    pub(super) fn new(count: usize) -> Result<Self, CosimulationError> {
        let threads = ThreadPoolBuilder::new().num_threads(count).build().map_err(|error| {
            let limit = format!("a number that the system grants ({error})");
            CosimulationError::value("threads", count, &limit, "1 suits all small models")
        })?;
        Ok(Self { process: std::process::id(), threads: Some(threads), count })
    }

    /// The threads, when they are of this process.
    pub(super) fn here(&self) -> Option<&ThreadPool> {
        self.threads.as_ref().filter(|_| self.process == std::process::id())
    }

    /// Their number.
    pub(super) fn threads(&self) -> usize {
        self.count
    }
}

impl Drop for Pool {
    /// Threads of another process cannot be ended from here; what they left in this one stays as it is.
    fn drop(&mut self) {
        if self.here().is_none() {
            std::mem::forget(self.threads.take());
        }
    }
}
