//! The case inside an FMU: everything that the model needs, in one file of resources.

use std::path::Path;

use enmm::model::Case;
use enmm_io::LoadedCase;
use serde::{Deserialize, Serialize};

/// Name of the file in the folder of resources.
pub const FILE: &str = "case.json";
/// Version of its layout.
const FORMAT: u32 = 1;

/// Why a resource cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResourceError {
    /// The file is not there or cannot be read.
    #[error("cannot read {path} ({problem}): unpack the FMU again, with its folder `resources`")]
    Unreadable {
        /// Path of the file.
        path: String,
        /// Message of the system.
        problem: String,
    },
    /// The file is something else, damaged or of another version.
    #[error("{path} is damaged or of another version ({problem}): pack the FMU again with `enmm fmu`")]
    Damaged {
        /// Path of the file.
        path: String,
        /// The fault.
        problem: String,
    },
}

#[derive(Serialize, Deserialize)]
struct Resource {
    format: u32,
    engine: String,
    name: String,
    hash: String,
    case: Case,
}

/// Returns the bytes of the resource of a case; `name` stands in its messages.
///
/// # Errors
/// When the case cannot be written as JSON.
pub fn encode(loaded: &LoadedCase, name: &str) -> Result<Vec<u8>, serde_json::Error> {
    let engine = enmm::engine_version().to_owned();
    let resource = Resource {
        format: FORMAT,
        engine,
        name: name.to_owned(),
        hash: loaded.hash.clone(),
        case: loaded.case.clone(),
    };
    serde_json::to_vec_pretty(&resource)
}

/// Reads the case in a folder of resources.
///
/// # Errors
/// When the file is missing, damaged or of another version.
pub fn load(folder: &Path) -> Result<LoadedCase, ResourceError> {
    let path = folder.join(FILE);
    let named = path.display().to_string();
    let damaged = |problem: String| ResourceError::Damaged { path: named.clone(), problem };
    let bytes = enmm_io::files::read_input(&path)
        .map_err(|error| ResourceError::Unreadable { path: named.clone(), problem: error.to_string() })?;
    let resource: Resource = serde_json::from_slice(&bytes).map_err(|error| damaged(error.to_string()))?;
    if resource.format != FORMAT || resource.engine != enmm::engine_version() {
        return Err(damaged(format!("format {} of enmm {}", resource.format, resource.engine)));
    }
    let loaded = LoadedCase::of(resource.case, &resource.name).map_err(|error| damaged(error.to_string()))?;
    if loaded.hash != resource.hash {
        return Err(damaged("its hash does not match".to_owned()));
    }
    Ok(loaded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_survives_the_resource_to_the_bit_and_damage_is_refused() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for name in ["block_on_incline", "fractured_slope"] {
            let loaded = enmm_io::load_case(&root.join(format!("examples/cases/{name}.toml"))).unwrap();
            let folder = tempfile::tempdir().unwrap();
            assert!(matches!(load(folder.path()), Err(ResourceError::Unreadable { .. })));
            let mut bytes = encode(&loaded, name).unwrap();
            std::fs::write(folder.path().join(FILE), &bytes).unwrap();
            let again = load(folder.path()).unwrap();
            assert_eq!((&again.case, &again.hash), (&loaded.case, &loaded.hash));
            let digit = bytes.iter().rposition(|b| b.is_ascii_digit()).unwrap();
            bytes[digit] = if bytes[digit] == b'1' { b'2' } else { b'1' };
            std::fs::write(folder.path().join(FILE), &bytes).unwrap();
            assert!(matches!(load(folder.path()), Err(ResourceError::Damaged { .. })));
        }
    }
}
