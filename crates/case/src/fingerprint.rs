//! A number by which equal cases are known.

use super::Case;
use super::Invalid;

/// Start and factor of the 64-bit FNV-1a hash.
const FNV: [u64; 2] = [0xcbf2_9ce4_8422_2325, 0x0000_0100_0000_01b3];

impl Case {
    /// Fingerprint of the case, 16 hexadecimal digits, equal for equal cases: the 64-bit FNV-1a hash of the case as
    /// JSON, whose fields and maps have a fixed order.
    ///
    /// # Errors
    /// A case that cannot be written as JSON.
    pub fn fingerprint(&self) -> Result<String, Invalid> {
        let bytes = serde_json::to_vec(self).map_err(|error| Invalid {
            key: String::new(),
            message: format!("the case cannot be written as JSON: {error}"),
        })?;
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(FNV[1]);
        Ok(format!("{:016x}", bytes.iter().fold(FNV[0], step)))
    }
}
