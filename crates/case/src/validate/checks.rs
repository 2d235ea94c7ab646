//! The family of checks that validation is written with. Every message says what, the value, the limit and the remedy.

use std::collections::BTreeMap;
use std::fmt;

use super::Invalid;
use crate::key::{Key, list, nearest};
use crate::plausible;
use crate::{Case, StageKind, TimeTable};

/// Outcome of a check.
pub type Check = Result<(), Invalid>;

/// Largest coordinate (m): beyond it a double resolves less than a tenth of a micrometre.
pub const COORDINATE_MAX: f64 = 1e9;
/// Limits of a count of sweeps.
pub const ONE_TO_THOUSAND: (u64, u64) = (1, 1000);

/// Limits of the values of joint laws.
pub struct Law;

impl Law {
    /// Friction and dilation angles (degrees).
    pub const ANGLE: Range = Range::from(0.0).below(90.0);
    /// Cohesion and tensile strength (Pa).
    pub const STRENGTH: Range = Range::from(0.0).to(Self::STRENGTH_MAX);
    /// Largest cohesion and tensile strength (Pa).
    pub const STRENGTH_MAX: f64 = 1e12;
    /// Stiffness (Pa/m).
    pub const STIFFNESS: Range = Range::above(0.0).to(1e18);
}

/// An interval with open or closed ends.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    low: f64,
    low_open: bool,
    high: f64,
    high_open: bool,
}

impl Range {
    /// Returns the values greater than `low`.
    pub const fn above(low: f64) -> Self {
        Self { low, low_open: true, high: f64::MAX, high_open: false }
    }

    /// Returns the values that are at least `low`.
    pub const fn from(low: f64) -> Self {
        Self { low, low_open: false, high: f64::MAX, high_open: false }
    }

    /// Returns the values whose magnitude is at most `size`.
    pub const fn within(size: f64) -> Self {
        Self { low: -size, low_open: false, high: size, high_open: false }
    }

    /// Adds an upper end that belongs to the range.
    pub const fn to(self, high: f64) -> Self {
        Self { high, high_open: false, ..self }
    }

    /// Adds an upper end that does not belong to the range.
    pub const fn below(self, high: f64) -> Self {
        Self { high, high_open: true, ..self }
    }

    fn holds(&self, value: f64) -> bool {
        let above = if self.low_open { value > self.low } else { value >= self.low };
        let below = if self.high_open { value < self.high } else { value <= self.high };
        above && below
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low_open { "greater than" } else { "at least" };
        let high = if self.high_open { "less than" } else { "at most" };
        write!(f, "{low} {} and {high} {}", Plain(self.low), Plain(self.high))
    }
}

/// A number in the shorter of the two notations.
struct Plain(f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || !size.is_finite() || (1e-4..1e6).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// Returns the error at `key`.
pub fn invalid(key: &Key, message: impl Into<String>) -> Invalid {
    Invalid { key: key.to_string(), message: message.into() }
}

/// Fails at `key`.
///
/// # Errors
/// Always.
pub fn fail(key: &Key, message: impl Into<String>) -> Check {
    Err(invalid(key, message))
}

/// Checks the number `name` of the table `key` (or the element `key` itself, if `name` is empty). Without a hint it
/// is that of the table of usual ranges.
///
/// # Errors
/// The value is not finite or outside the range.
pub fn number(key: &Key, name: &str, value: f64, range: Range, unit: &str, hint: &str) -> Check {
    if value.is_finite() && range.holds(value) {
        return Ok(());
    }
    let key = if name.is_empty() { key.clone() } else { key.field(name) };
    let space = if unit.is_empty() { "" } else { " " };
    let limit = if value.is_finite() { range.to_string() } else { format!("a finite number, {range}") };
    let hint = if hint.is_empty() { plausible::usual(key.as_str()).unwrap_or_default() } else { hint };
    fail(&key, format!("is {}{space}{unit}, must be {limit}; {hint}", Plain(value)))
}

/// Checks a number that may be left out, see [`number`].
///
/// # Errors
/// The value is there and not finite or outside the range.
pub fn optional(key: &Key, name: &str, value: Option<f64>, range: Range, unit: &str, hint: &str) -> Check {
    value.map_or(Ok(()), |value| number(key, name, value, range, unit, hint))
}

/// Checks a whole number.
///
/// # Errors
/// The value is outside the limits, which belong to the range.
pub fn whole(key: &Key, name: &str, value: u64, (low, high): (u64, u64), hint: &str) -> Check {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    fail(&key.field(name), format!("is {value}, must be at least {low} and at most {high}; {hint}"))
}

/// Checks the coordinates of a point.
///
/// # Errors
/// A coordinate is not finite or beyond [`COORDINATE_MAX`].
pub fn point(key: &Key, [x, y]: &[f64; 2]) -> Check {
    for (name, value) in [("x", *x), ("y", *y)] {
        if value.is_finite() && value.abs() <= COORDINATE_MAX {
            continue;
        }
        let message = format!(
            "{name} is {} m, must be a finite number of at most {} m in magnitude; correct it or move the origin",
            Plain(value),
            Plain(COORDINATE_MAX)
        );
        return fail(key, message);
    }
    Ok(())
}

/// Checks the number of points of a list and their coordinates.
///
/// # Errors
/// There are fewer points than `least`, or one is unusable.
pub fn points(key: &Key, list: &[[f64; 2]], least: usize, what: &str) -> Check {
    if list.len() < least {
        let message = format!("has {} points, {what} needs at least {least}; add points or remove it", list.len());
        return fail(key, message);
    }
    // The key of a point is written for the first that is unusable.
    let unusable = list.iter().position(|place| point(key, place).is_err());
    unusable.map_or(Ok(()), |i| point(&key.index(i), &list[i]))
}

/// Checks a loop, whose crossings are the builder's to judge.
///
/// # Errors
/// There are fewer than three points, one is unusable, or all lie on one line.
pub fn polygon(key: &Key, ring: &[[f64; 2]]) -> Check {
    points(key, ring, 3, "a loop")?;
    let [x0, y0] = ring[0];
    let off = |p: &[f64; 2]| libm::hypot(p[0] - x0, p[1] - y0);
    let far = ring.iter().max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&ring[0]);
    let (size, [dx, dy]) = (off(far), [far[0] - x0, far[1] - y0]);
    let on_line = |&[x, y]: &[f64; 2]| ((x - x0) * dy - (y - y0) * dx).abs() <= 1e-12 * size * size;
    if ring.iter().all(on_line) {
        return fail(
            key,
            format!("its {} points lie on one line, a loop has an area; add a point beside it", ring.len()),
        );
    }
    Ok(())
}

/// Checks a polygon that selects parts of the rock.
///
/// # Errors
/// There are fewer than three points, one is unusable, or the polygon has no area.
pub fn region(key: &Key, ring: &[[f64; 2]]) -> Check {
    polygon(key, ring)?;
    let [x0, y0] = ring[0];
    let (mut doubled, mut size) = (0.0, 0.0_f64);
    for (i, &[x, y]) in ring.iter().enumerate() {
        let [xn, yn] = ring[(i + 1) % ring.len()];
        doubled += (x - x0) * (yn - y0) - (xn - x0) * (y - y0);
        size = size.max((x - x0).abs()).max((y - y0).abs());
    }
    if doubled.abs() <= 1e-12 * size * size {
        return fail(key, "the polygon has no area; give at least 3 points that are not on one line");
    }
    Ok(())
}

/// Checks a segment.
///
/// # Errors
/// An end is unusable, or both ends are the same point.
pub fn segment(key: &Key, edge: &[[f64; 2]; 2]) -> Check {
    points(key, edge, 2, "a segment")?;
    if edge[0] == edge[1] {
        return fail(key, format!("both ends are {:?}, a segment needs two different points; move one", edge[0]));
    }
    Ok(())
}

/// Checks a table of times (s) and factors.
///
/// # Errors
/// There is no row, a value is unusable, or the times do not increase.
pub fn table(key: &Key, rows: &TimeTable) -> Check {
    if rows.is_empty() {
        return fail(key, "has no rows, at least 1 is needed; add `[time, factor]` or leave the table out");
    }
    for (i, &[time, factor]) in rows.iter().enumerate() {
        let key = key.index(i);
        number(&key, "", time, Range::from(0.0).to(1e9), "s", "the first value of a row is a time")?;
        number(&key, "", factor, Range::within(1e12), "", "the second value of a row is a factor")?;
        if i > 0 && time <= rows[i - 1][0] {
            let message = format!(
                "time is {} s, must be greater than {} s of the row before; sort the rows by time",
                Plain(time),
                Plain(rows[i - 1][0])
            );
            return fail(&key, message);
        }
    }
    Ok(())
}

/// Characters without a sign of their own, which turn or hide a text.
const HIDDEN: [std::ops::RangeInclusive<char>; 4] =
    ['\u{200b}'..='\u{200f}', '\u{202a}'..='\u{202e}', '\u{2060}'..='\u{2069}', '\u{feff}'..='\u{feff}'];

/// Checks that a name does no harm where it is shown: terminals obey control characters, and spreadsheets take a text
/// that begins with `=`, `+`, `-` or `@` for a formula.
///
/// # Errors
/// It has one of these.
pub fn harmless(key: &Key, name: &str) -> Check {
    let is_hidden = |c: &char| c.is_control() || HIDDEN.iter().any(|range| range.contains(c));
    if let Some(sign) = name.chars().find(is_hidden) {
        return fail(key, format!("{name:?} has the control character {sign:?}, which no name must have; remove it"));
    }
    match name.trim_start().chars().next().filter(|c| "=+-@".contains(*c)) {
        Some(sign) => {
            let message = format!(
                "{name:?} begins with `{sign}`, from which spreadsheets make a formula; begin with a letter or a digit"
            );
            fail(key, message)
        }
        None => Ok(()),
    }
}

/// Checks that names are not empty and that no two are equal; a thing without a name is skipped.
///
/// # Errors
/// A name is empty or taken.
pub fn unique<'a>(key: &Key, what: &str, names: impl Iterator<Item = Option<&'a str>>) -> Check {
    let mut seen = BTreeMap::new();
    for (i, name) in names.enumerate().filter_map(|(i, name)| Some((i, name?))) {
        let place = key.index(i).field("name");
        if name.trim().is_empty() {
            return fail(&place, format!("is {name:?}, a {what} needs at least one letter; give it a name"));
        }
        harmless(&place, name)?;
        if let Some(first) = seen.insert(name, i) {
            let message =
                format!("{name:?} is already the name of {}, names must differ; rename one", key.index(first));
            return fail(&place, message);
        }
    }
    Ok(())
}

/// The names that a reference may use.
pub struct Names<'a> {
    what: &'static str,
    remedy: &'static str,
    known: Vec<&'a str>,
}

impl<'a> Names<'a> {
    /// Returns the joint laws of a case.
    pub fn of_laws(case: &'a Case) -> Self {
        let known = case.joint_laws.keys().map(String::as_str).collect();
        Self { what: "joint law", remedy: "add [joint_law.NAME]", known }
    }

    /// Returns the named fixities of a case.
    pub fn of_fixes(case: &'a Case) -> Self {
        let known = case.fixes.iter().filter_map(|fix| fix.name.as_deref()).collect();
        Self { what: "fixity", remedy: "add [[fix]] with this `name`", known }
    }

    /// Returns the dynamic stages of a case.
    pub fn of_dynamic_stages(case: &'a Case) -> Self {
        let dynamic = case.stages.iter().filter(|stage| stage.kind == StageKind::Dynamic);
        let known = dynamic.map(|stage| stage.name.as_str()).collect();
        Self { what: "dynamic stage", remedy: "add [[stage]] with this `name` and `kind = \"dynamic\"`", known }
    }

    /// Returns the named bolts of a case.
    pub fn of_bolts(case: &'a Case) -> Self {
        let known = case.bolts.iter().filter_map(|bolt| bolt.name.as_deref()).collect();
        Self { what: "bolt", remedy: "add [[bolt]] with this `name`", known }
    }

    /// Checks that `name` is known.
    ///
    /// # Errors
    /// It is not; the message gives the nearest name.
    pub fn must_hold(&self, key: &Key, name: &str) -> Check {
        if self.known.contains(&name) {
            return Ok(());
        }
        let (what, remedy) = (self.what, self.remedy);
        let message = match nearest(name, self.known.iter().copied()) {
            Some(near) => format!("no {what} is named {name:?}, did you mean {near:?}? Known: {self}; or {remedy}"),
            None => format!("no {what} is named {name:?}, and the case has none with a name; {remedy}"),
        };
        fail(key, message)
    }
}

impl fmt::Display for Names<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&list(self.known.iter().copied()))
    }
}
