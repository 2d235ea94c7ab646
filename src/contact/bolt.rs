//! Rock bolts: elastic–plastic bars between two material points, judged in the open–close iteration.

/// What a bar segment remembers from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BoltState {
    /// Whether it is installed.
    pub active: bool,
    /// Whether it has broken.
    pub broken: bool,
    /// Length (m) at which it bears no force: grows when the bar yields.
    pub rest: f64,
    /// Tension at the end of the last step (N/m).
    pub force: f64,
}
