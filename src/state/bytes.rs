//! Bytes of saved states: a payload in a container that says of which case it is and whether it is whole.
//!
//! Layout, little-endian: magic `ENMMCKPT`; format version u32; [`Keeper`] u32; engine version and case hash, each as
//! u32 length and text; payload length u64; CRC-32 u32 of all before the length and of the payload; payload. The
//! payload is postcard. Every keeper begins it with the state from which the model goes on, so that others can take
//! that alone.

use std::cmp::Ordering;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::State;

const MAGIC: &[u8; 8] = b"ENMMCKPT";
const FORMAT: u32 = 18;
const TEXT_MAX: usize = 256;
/// Bytes of length and checksum.
const SUMMARY: usize = 12;
/// Most bytes before the payload.
pub const HEAD_MAX: usize = MAGIC.len() + 8 + 2 * (4 + TEXT_MAX) + SUMMARY;

/// Who saved a state: each keeps more than the state itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keeper {
    /// `enmm run`, with the progress of its stages and outputs.
    Run,
    /// A host of a model, by C, C++, Python or Rust, with its communication steps.
    Model,
    /// An FMU, with its clock and values.
    Fmu,
}

impl Keeper {
    const ALL: [Self; 3] = [Self::Run, Self::Model, Self::Fmu];

    /// Whether it can take the state of another: values of an FMU are known to that FMU alone.
    fn takes(self, other: Self) -> bool {
        (self == Self::Fmu) == (other == Self::Fmu)
    }

    /// Its word in messages, and how its states are continued.
    fn told(self) -> [&'static str; 2] {
        match self {
            Self::Run => ["a run", "`enmm run --resume` and models of the library continue it"],
            Self::Model => ["a library model", "models of the library and `enmm run --resume` continue it"],
            Self::Fmu => ["an FMU", "an instance of the same FMU continues it"],
        }
    }
}

/// Why bytes are no saved state that can be used.
#[derive(Debug, thiserror::Error)]
pub enum BytesError {
    /// It is something else.
    #[error(
        "this is no saved state of enmm: give the checkpoint.enmm of a run, or bytes of a state that a model has saved"
    )]
    Foreign,
    /// It ends too early.
    #[error("the checkpoint is truncated after {0} bytes: use an older one, or start a new run")]
    Truncated(usize),
    /// Another format or engine wrote it.
    #[error("the checkpoint is of {found}, this is {own}: continue with that version, or start a new run")]
    Version {
        /// Version that wrote it.
        found: String,
        /// Version that reads it.
        own: String,
    },
    /// It was saved by something else.
    #[error("this is the state of {}, not of {}: {}", found.told()[0], own.told()[0], found.told()[1])]
    OtherKeeper {
        /// Who saved it.
        found: Keeper,
        /// Who reads it.
        own: Keeper,
    },
    /// It belongs to another case.
    #[error("the checkpoint is of case {found}, this case is {own}: use the case file that made it")]
    OtherCase {
        /// Hash in the checkpoint.
        found: String,
        /// Hash of this case.
        own: String,
    },
    /// Its bytes have changed.
    #[error("the checkpoint is damaged ({0}): use an older one, or start a new run")]
    Damaged(String),
}

/// Version of the engine that writes checkpoints and results.
pub const fn engine_version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Returns the bytes of a checkpoint of `payload` for the case with this hash.
///
/// # Errors
/// When the payload cannot be serialised.
pub fn encode<T: Serialize>(keeper: Keeper, payload: &T, case_hash: &str) -> Result<Vec<u8>, BytesError> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend([FORMAT, keeper as u32].map(u32::to_le_bytes).concat());
    for text in [engine_version(), case_hash] {
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
    }
    // Length and checksum are known when the payload is there, which is too large to be copied behind them.
    let summary = bytes.len();
    bytes.extend([0; SUMMARY]);
    let mut bytes = postcard::to_extend(payload, bytes).map_err(|error| BytesError::Damaged(error.to_string()))?;
    let (head, payload) = bytes.split_at_mut(summary + SUMMARY);
    head[summary..summary + 8].copy_from_slice(&(payload.len() as u64).to_le_bytes());
    let checksum = checksum(&head[..summary], payload);
    head[summary + 8..].copy_from_slice(&checksum.to_le_bytes());
    Ok(bytes)
}

/// Returns the payload of a checkpoint of the case with this hash.
///
/// # Errors
/// When the bytes are no whole checkpoint of this engine, keeper and case.
pub fn decode<T: DeserializeOwned>(keeper: Keeper, bytes: &[u8], case_hash: &str) -> Result<T, BytesError> {
    let (found, payload) = open(keeper, bytes, case_hash)?;
    if found != keeper {
        return Err(BytesError::OtherKeeper { found, own: keeper });
    }
    match taken(payload)? {
        (value, []) => Ok(value),
        _ => Err(BytesError::Damaged("it holds something else".to_owned())),
    }
}

/// Returns the state with which a checkpoint of the case with this hash begins, which a keeper takes from another.
///
/// # Errors
/// When the bytes are no whole checkpoint of this engine and case that the keeper takes.
pub fn decode_state(keeper: Keeper, bytes: &[u8], case_hash: &str) -> Result<State, BytesError> {
    Ok(taken(open(keeper, bytes, case_hash)?.1)?.0)
}

/// Keeper and payload of a checkpoint of the case with this hash.
fn open<'a>(own: Keeper, bytes: &'a [u8], case_hash: &str) -> Result<(Keeper, &'a [u8]), BytesError> {
    let head = head(own, bytes, case_hash)?;
    head.check_size(bytes.len() as u64)?;
    let payload = &bytes[head.size..];
    if checksum(&bytes[..head.size - SUMMARY], payload) != head.checksum {
        return Err(BytesError::Damaged("its checksum does not match".to_owned()));
    }
    Ok((head.keeper, payload))
}

/// CRC-32 of a head up to the length of its payload, and of the payload.
pub fn checksum(head: &[u8], payload: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(head);
    hasher.update(payload);
    hasher.finalize()
}

fn taken<T: DeserializeOwned>(payload: &[u8]) -> Result<(T, &[u8]), BytesError> {
    postcard::take_from_bytes(payload).map_err(|error| BytesError::Damaged(error.to_string()))
}

/// Header in front of a payload.
pub struct Head {
    /// Who saved the state.
    pub keeper: Keeper,
    /// Bytes of the head itself.
    size: usize,
    /// Bytes of the payload.
    length: u64,
    /// CRC-32 of head and payload.
    checksum: u32,
}

impl Head {
    /// Refuses `found` bytes that are not head and payload, neither more nor less.
    ///
    /// # Errors
    /// Whether the size is that of head and payload: an error when the bytes are too short or too long.
    pub fn check_size(&self, found: u64) -> Result<(), BytesError> {
        match found.cmp(&self.length.saturating_add(self.size as u64)) {
            Ordering::Less => Err(BytesError::Truncated(found as usize)),
            Ordering::Equal => Ok(()),
            Ordering::Greater => Err(BytesError::Damaged("bytes follow its end".to_owned())),
        }
    }
}

/// Reads the head at the beginning of some bytes, of which the first [`HEAD_MAX`] are enough.
///
/// # Errors
/// When they do not begin a checkpoint of this engine and of the case with this hash, whose state `own` can take.
pub fn head(own: Keeper, bytes: &[u8], case_hash: &str) -> Result<Head, BytesError> {
    let mut reader = Reader { bytes, at: 0 };
    if reader.take(MAGIC.len()).map_err(|_| BytesError::Foreign)? != MAGIC {
        return Err(BytesError::Foreign);
    }
    let format = reader.number()?;
    if format != FORMAT {
        return Err(version(format!("format {format}"), format!("format {FORMAT}")));
    }
    let found = reader.number()?;
    let engine = reader.text()?;
    if engine != engine_version() {
        return Err(version(format!("enmm {engine}"), format!("enmm {}", engine_version())));
    }
    let keeper = Keeper::ALL.get(found as usize).copied();
    let keeper = keeper.ok_or_else(|| BytesError::Damaged("it was saved by nothing that is known".to_owned()))?;
    if !own.takes(keeper) {
        return Err(BytesError::OtherKeeper { found: keeper, own });
    }
    let found = reader.text()?;
    if found != case_hash {
        return Err(BytesError::OtherCase { found, own: case_hash.to_owned() });
    }
    let length = u64::from_le_bytes(reader.array()?);
    let checksum = reader.number()?;
    Ok(Head { keeper, size: reader.at, length, checksum })
}

/// The case hash that the head of some bytes has.
///
/// # Errors
/// As [`head`], but for the hash itself.
pub fn case_hash(keeper: Keeper, bytes: &[u8]) -> Result<String, BytesError> {
    match head(keeper, bytes, "") {
        Err(BytesError::OtherCase { found, .. }) => Ok(found),
        Err(error) => Err(error),
        Ok(_) => Ok(String::new()),
    }
}

fn version(found: String, own: String) -> BytesError {
    BytesError::Version { found, own }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], BytesError> {
        let part = self.bytes[self.at..].get(..length).ok_or(BytesError::Truncated(self.bytes.len()))?;
        self.at += length;
        Ok(part)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], BytesError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    fn number(&mut self) -> Result<u32, BytesError> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    fn text(&mut self) -> Result<String, BytesError> {
        let length = self.number()? as usize;
        if length > TEXT_MAX {
            return Err(BytesError::Damaged(format!("a text of {length} bytes")));
        }
        String::from_utf8(self.take(length)?.to_vec()).map_err(|_| BytesError::Damaged("no text".to_owned()))
    }
}
