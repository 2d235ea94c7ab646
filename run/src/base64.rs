//! Bytes as base64 text (RFC 4648, padded), piece by piece. Knows nothing of what the bytes mean.

use std::io::{self, Write};

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Bytes that are gathered before they are written: a multiple of three, so that only the last piece is padded.
const PIECE: usize = 3 << 12;

/// Turns bytes into base64 on their way to `out`.
pub struct Base64<'a> {
    out: &'a mut dyn Write,
    bytes: Vec<u8>,
    text: Vec<u8>,
}

impl<'a> Base64<'a> {
    /// Begins a text.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self { out, bytes: Vec::with_capacity(PIECE), text: Vec::with_capacity(PIECE / 3 * 4) }
    }

    /// Appends bytes.
    ///
    /// # Errors
    /// Whatever `out` refuses.
    pub fn push(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while self.bytes.len() + bytes.len() >= PIECE {
            let (now, later) = bytes.split_at(PIECE - self.bytes.len());
            self.bytes.extend_from_slice(now);
            self.flush()?;
            bytes = later;
        }
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    /// Ends the text.
    ///
    /// # Errors
    /// Whatever `out` refuses.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()
    }

    fn flush(&mut self) -> io::Result<()> {
        self.text.clear();
        for group in self.bytes.chunks(3) {
            let byte = |k: usize| u32::from(group.get(k).copied().unwrap_or(0));
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            let digits = [18, 12, 6, 0].map(|shift| DIGITS[(bits >> shift & 63) as usize]);
            let padded = |k: usize| if k > group.len() { b'=' } else { digits[k] };
            self.text.extend([digits[0], digits[1], padded(2), padded(3)]);
        }
        self.bytes.clear();
        self.out.write_all(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coded(pieces: &[&[u8]]) -> String {
        let mut text = Vec::new();
        let mut base64 = Base64::new(&mut text);
        pieces.iter().for_each(|piece| base64.push(piece).unwrap());
        base64.finish().unwrap();
        String::from_utf8(text).unwrap()
    }

    /// RFC 4648, section 10.
    #[test]
    fn base64_matches_the_vectors_of_the_standard() {
        for (plain, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(coded(&[plain.as_bytes()]), text);
        }
    }

    #[test]
    fn pieces_make_the_text_of_the_whole() {
        let bytes: Vec<u8> = (0..3 * PIECE + 1).map(|k| (k * k % 251) as u8).collect();
        for size in [1, 7, 8, PIECE, PIECE + 5] {
            assert_eq!(coded(&bytes.chunks(size).collect::<Vec<_>>()), coded(&[&bytes]));
        }
    }
}
