//! A number by which equal cases are known.

use super::{Case, Invalid, Output};

/// Start and factor of the 64-bit FNV-1a hash.
const FNV: [u64; 2] = [0xcbf2_9ce4_8422_2325, 0x0000_0100_0000_01b3];

impl Case {
    /// Fingerprint of the case, 16 hexadecimal digits, equal for equal models: the 64-bit FNV-1a hash of the case as
    /// JSON, whose fields and maps have a fixed order. What does not act on the model is left out: the title, the files
    /// to write, and notes.
    ///
    /// # Errors
    /// A case that cannot be written as JSON.
    pub fn fingerprint(&self) -> Result<String, Invalid> {
        // From when displacements count is part of the state.
        let output = Output { since: self.output.since.clone(), ..Output::default() };
        let acting = Self { title: String::new(), output, fmu: None, ..self.clone() };
        let bytes = serde_json::to_vec(&acting).map_err(|error| Invalid {
            key: String::new(),
            message: format!("the case cannot be written as JSON: {error}"),
        })?;
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(FNV[1]);
        Ok(format!("{:016x}", bytes.iter().fold(FNV[0], step)))
    }
}
