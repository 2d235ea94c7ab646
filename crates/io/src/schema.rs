//! JSON Schema of the case file.

use enmm_case::Case;

/// Returns the JSON Schema of the case file; titles and descriptions are the doc comments of [`Case`].
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Case).to_value()
}
