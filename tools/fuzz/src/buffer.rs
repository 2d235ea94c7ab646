//! Memory that is handed out with watched words on either side.

use std::cell::Cell;

/// Watched words on either side.
const MARGIN: usize = 32;
/// Pattern of the watched words, and of memory before it is written to.
const MARK: u64 = 0xa5a5_5a5a_c3c3_3c3c;

/// Some words of memory.
pub struct Buffer {
    words: Vec<Cell<u64>>,
    before: Vec<u64>,
}

impl Buffer {
    /// So many words.
    pub fn new(count: usize) -> Self {
        let words = vec![Cell::new(MARK); count + 2 * MARGIN];
        Self { words, before: vec![MARK; count] }
    }

    /// Sets a word, as a host would before a call.
    pub fn set(&mut self, k: usize, word: u64) {
        if let Some(before) = self.before.get_mut(k) {
            *before = word;
            self.words[MARGIN + k].set(word);
        }
    }

    /// Where the memory begins.
    pub fn pointer<T>(&mut self) -> *mut T {
        self.words[MARGIN..].as_mut_ptr().cast()
    }

    /// The words now.
    pub fn words(&self) -> Vec<u64> {
        self.words[MARGIN..MARGIN + self.before.len()].iter().map(Cell::get).collect()
    }

    /// The first so many words as numbers.
    pub fn numbers(&self, count: usize) -> Vec<f64> {
        self.words().into_iter().take(count).map(f64::from_bits).collect()
    }

    /// Checks the watched words.
    ///
    /// # Errors
    /// When a watched word has changed; when the call has failed also when any word has.
    pub fn check(&self, name: &str, failed: bool) -> Result<(), String> {
        let ends = self.words[..MARGIN].iter().chain(&self.words[MARGIN + self.before.len()..]);
        if ends.into_iter().any(|word| word.get() != MARK) {
            return Err(format!("{name} wrote outside the buffer of {} words", self.before.len()));
        }
        if failed && self.words() != self.before {
            return Err(format!("{name} failed and wrote to the buffer of {} words", self.before.len()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_outside_or_by_a_failed_call_is_seen() {
        let mut buffer = Buffer::new(2);
        buffer.set(0, 7);
        assert_eq!((buffer.check("call", true), buffer.words()), (Ok(()), vec![7, MARK]));
        let at: *mut u64 = buffer.pointer();
        // SAFETY: the second of two words.
        unsafe { at.add(1).write(3) };
        assert!(buffer.check("call", false).is_ok() && buffer.check("call", true).is_err());
        // SAFETY: the first watched word behind them.
        unsafe { at.add(2).write(3) };
        assert!(buffer.check("call", false).is_err());
    }
}
