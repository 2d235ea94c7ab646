//! Contents of an input, written on request while it happens, so that they survive the end of the process.

use std::fs::File;
use std::io::Write;

/// Where the steps of an input go, or nowhere.
pub struct Trace(pub Option<File>);

impl Trace {
    /// Writes a line; it is not made when nobody asks.
    pub fn say(&mut self, line: impl FnOnce() -> String) {
        if let Some(file) = &mut self.0 {
            // A trace that cannot be written is shorter; the find stays what it is.
            let _ = writeln!(file, "{}", line()).and_then(|()| file.flush());
        }
    }
}
