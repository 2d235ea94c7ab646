//! Greatest values of what acts on a model, far beyond all physics, so that sums of them stay finite. Cases, hosts and
//! FMUs share them.

/// Magnitude of an acceleration (m/s²).
pub const ACCELERATION_MAX: f64 = 1e4;
/// Magnitude of the velocity of a base or a wave (m/s).
pub const VELOCITY_MAX: f64 = 1e4;
/// Magnitude of a height or another coordinate (m): beyond it a double resolves less than a tenth of a micrometre.
pub const LEVEL_MAX: f64 = 1e9;
/// Rate of rain (m/s).
pub const RAIN_MAX: f64 = 1e-3;
/// Factor on the strength of joints.
pub const FACTOR_MAX: f64 = 1e6;
/// Magnitude of a force (N/m), a moment (N·m/m), a traction or a pressure (Pa).
pub const VALUE_MAX: f64 = 1e15;
/// Letters of a name; layers of drawings have as many.
pub const NAME_MAX: usize = 255;
/// Letters of a title.
pub const TITLE_MAX: usize = 10_000;
/// Threads of a model.
pub const THREADS_MAX: usize = 1024;
