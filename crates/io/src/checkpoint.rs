//! Checkpoint files: saved states that are written whole or not at all, and looked at before they are read.

use std::io::{self, Read};
use std::path::Path;

use serde::Serialize;

use super::files::{open_input, write_atomic};
use enmm::model::bytes::{BytesError, HEAD_MAX, Keeper, encode, head};

/// Why a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be read.
    #[error("cannot read the checkpoint ({0}); check its path and permissions")]
    Unreadable(io::Error),
    /// Its bytes are no state of this case.
    #[error(transparent)]
    Bytes(#[from] BytesError),
}

/// Writes a checkpoint, whole or not at all.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn save<T: Serialize>(path: &Path, payload: &T, case_hash: &str) -> io::Result<()> {
    write_atomic(path, &encode(Keeper::Run, payload, case_hash).map_err(io::Error::other)?)
}

/// Reads the bytes of a state that a run can take; what is no regular file, or has the wrong head or size, is refused
/// before it is read.
///
/// # Errors
/// When the file cannot be read, or is no whole checkpoint of this engine and case.
pub fn read(path: &Path, case_hash: &str) -> Result<(Keeper, Vec<u8>), CheckpointError> {
    let mut file = open_input(path).map_err(CheckpointError::Unreadable)?;
    let length = file.metadata().map_err(CheckpointError::Unreadable)?.len();
    let mut bytes = Vec::new();
    file.by_ref().take(HEAD_MAX as u64).read_to_end(&mut bytes).map_err(CheckpointError::Unreadable)?;
    let head = head(Keeper::Run, &bytes, case_hash)?;
    head.check_size(length)?;
    bytes
        .try_reserve_exact((length as usize).saturating_sub(bytes.len()))
        .map_err(|error| CheckpointError::Unreadable(io::Error::new(io::ErrorKind::OutOfMemory, error.to_string())))?;
    file.take(length).read_to_end(&mut bytes).map_err(CheckpointError::Unreadable)?;
    Ok((head.keeper, bytes))
}
