//! A film as a file: a magic word, then chunks that are only ever appended.
//!
//! A chunk is its kind (4 letters), the length of its body (u32), its time (f64) and its body, a zlib stream; numbers
//! are little-endian. A program that is killed leaves at most its last chunk torn, and readers leave that one out.

use std::io::{self, Read};

use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::decompress_to_vec_zlib;

/// First bytes of a film; the last of them counts the versions of the format.
pub const MAGIC: [u8; 8] = *b"enmmfil6";

/// Bytes before the body of a chunk.
pub const HEADER: usize = 16;
/// Effort of the compression, 0 to 10: more costs time and gains little on the noise of mantissas.
const EFFORT: u8 = 5;

/// Kind of a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The head as JSON.
    Head,
    /// Outlines of the blocks.
    Outlines,
    /// Elements of the blocks of the outlines before.
    Mesh,
    /// One frame.
    Frame,
    /// Numbers of the elements and joints of the frame before.
    Elements,
    /// Rows of the histories.
    Rows,
    /// A note as JSON.
    Note,
}

impl Kind {
    const ALL: [Self; 7] =
        [Self::Head, Self::Outlines, Self::Mesh, Self::Frame, Self::Elements, Self::Rows, Self::Note];

    fn letters(self) -> [u8; 4] {
        *match self {
            Self::Head => b"HEAD",
            Self::Outlines => b"OUTL",
            Self::Mesh => b"MESH",
            Self::Frame => b"FRAM",
            Self::Elements => b"ELEM",
            Self::Rows => b"ROWS",
            Self::Note => b"NOTE",
        }
    }
}

/// Length of a body once it is packed.
pub fn packed_length(body: &[u8]) -> usize {
    compress_to_vec_zlib(body, EFFORT).len()
}

/// The bytes of a chunk.
///
/// # Errors
/// `InvalidInput` for a body that does not fit the format, of 4 GiB or more.
pub fn pack(kind: Kind, time: f64, body: &[u8]) -> io::Result<Vec<u8>> {
    let packed = compress_to_vec_zlib(body, EFFORT);
    let too_long = || io::Error::new(io::ErrorKind::InvalidInput, "a chunk of 4 GiB or more: use fewer blocks");
    let length = u32::try_from(packed.len()).map_err(|_| too_long())?;
    let mut bytes = Vec::with_capacity(HEADER + packed.len());
    bytes.extend(kind.letters());
    bytes.extend(length.to_le_bytes());
    bytes.extend(time.to_le_bytes());
    bytes.extend(packed);
    Ok(bytes)
}

/// A whole chunk as it stands in a film.
#[derive(Debug)]
pub struct Chunk {
    /// Its kind.
    pub kind: Kind,
    /// Its time (s).
    pub time: f64,
    /// All its bytes, the header included.
    pub bytes: Vec<u8>,
}

impl Chunk {
    /// Its content, inflated.
    ///
    /// # Errors
    /// `InvalidData` when it is damaged.
    pub fn body(&self) -> io::Result<Vec<u8>> {
        decompress_to_vec_zlib(&self.bytes[HEADER..]).map_err(|_| invalid("holds a chunk that is damaged"))
    }
}

/// Reads the whole chunks of a film, one by one, and ends at a torn one.
pub struct Chunks<R> {
    film: R,
}

impl<R: Read> Chunks<R> {
    /// Reads the magic word.
    ///
    /// # Errors
    /// `InvalidData` if it is another; else what `film` refuses.
    pub fn new(mut film: R) -> io::Result<Self> {
        let mut magic = Vec::new();
        film.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if magic != MAGIC {
            return Err(invalid("is no film of this version of enmm: run the case again"));
        }
        Ok(Self { film })
    }

    /// The next whole chunk; none at the end and before a torn one.
    ///
    /// # Errors
    /// `InvalidData` for a chunk of unknown kind; else what the film refuses.
    pub fn next(&mut self) -> io::Result<Option<Chunk>> {
        let mut bytes = Vec::new();
        self.film.by_ref().take(HEADER as u64).read_to_end(&mut bytes)?;
        let Some((letters, rest)) = bytes.split_first_chunk::<4>() else { return Ok(None) };
        let Some((length, rest)) = rest.split_first_chunk::<4>() else { return Ok(None) };
        let Some((time, _)) = rest.split_first_chunk::<8>() else { return Ok(None) };
        let known = Kind::ALL.into_iter().find(|kind| kind.letters() == *letters);
        let kind = known.ok_or_else(|| invalid("holds a chunk of unknown kind: it is damaged"))?;
        let (length, time) = (u64::from(u32::from_le_bytes(*length)), f64::from_le_bytes(*time));
        let whole = HEADER as u64 + length;
        self.film.by_ref().take(length).read_to_end(&mut bytes)?;
        Ok((bytes.len() as u64 == whole).then_some(Chunk { kind, time, bytes }))
    }
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}
