//! Rules that keys of several tables share.

use super::unit::{DEGREE, DENSITY, METRE, NEWTON_PER_METRE, NUMBER, PASCAL, SECOND};
use super::{Range, Rule};
use crate::limits::{LEVEL_MAX, VALUE_MAX};

/// Coordinates of points.
pub const PLACE: Rule = HEIGHT.columns([("x", "m"), ("y", "m")]).hint("correct it or move the origin");
/// Rows of time and value.
pub const ROWS: Rule = Range::within(1e12)
    .of(SECOND)
    .columns([("time", "s"), ("value", "")])
    .hint("the first value of a row is a time, the second one a factor");
/// Heights in the section.
pub const HEIGHT: Rule = Range::within(LEVEL_MAX).of(METRE);
/// Lengths that are greater than 0.
pub const LENGTH: Rule = Range::above(0.0).to(LEVEL_MAX).of(METRE);
/// Deviations of lengths.
pub const DEVIATION: Rule = Range::from(0.0).to(LEVEL_MAX).of(METRE);
/// Friction and dilation angles.
pub const ANGLE: Rule = Range::from(0.0).below(90.0).of(DEGREE);
/// Directions in the section or on the map.
pub const DIRECTION: Rule = Range::within(360.0).of(DEGREE).usual([0.2, 360.0], "angles are in degrees, up to 360");
/// Dilation angles.
pub const DILATION: Rule = ANGLE.usual([0.5, 50.0], "rock and joints have 0 to 20°");
/// Density of rock.
pub const ROCK_DENSITY: Rule = Range::from(1e-3).to(1e6).of(DENSITY).usual([500.0, 1e4], "rock has 2000 to 3200 kg/m³");
/// Cohesion and tensile strength.
pub const STRENGTH: Rule = Range::from(0.0).to(1e12).of(PASCAL);
/// Stress and pressure of either sign.
pub const STRESS: Rule = Range::within(1e12).of(PASCAL);
/// Pressure on faces.
pub const PRESSURE: Rule = STRESS.usual([50.0, 1e9], "10 m of water press with 98.1e3 Pa");
/// Forces on the rock.
pub const FORCE: Rule = Range::within(VALUE_MAX).of(NEWTON_PER_METRE).usual([10.0, 1e10], "10 t weigh 98.1e3 N");
/// Shares that are greater than 0.
pub const SHARE: Rule = Range::above(0.0).to(1.0).of(NUMBER);
/// Times that are greater than 0.
pub const TIME: Rule = Range::above(0.0).to(1e9).of(SECOND);
/// Steps of time; in shorter ones rates are beyond the range of numbers.
pub const STEP: Rule = Range::from(1e-12).to(1e9).of(SECOND);
/// Factors on rows.
pub const FACTOR: Rule = Range::within(1e12).of(NUMBER).hint("1 is the default");
/// Seeds of random numbers.
pub const SEED: Rule = Range::from(0.0).to(u64::MAX as f64).of(NUMBER);
